//! How often models wind about the regions between merged faces.
//!
//! From one region to the next the number changes by what the face between them counts. Where it starts, for every part
//! that hangs together, is told by a ray from a face of the part: exact, and moved aside by less than any number where it
//! would graze an edge (Edelsbrunner & Mücke 1990).

use glam::DVec3;
use rayon::prelude::*;
use robust::{Coord, Coord3D, orient2d, orient3d};

use super::Merged;
use super::box_tree::BoxTree;
use super::exact::flat_area;
use crate::body::weld::UnionFind;

impl Merged {
    /// For every region, how often each model winds about it. O(n log n).
    pub(super) fn windings_of(&self, sides: &[[u32; 2]], regions: usize) -> Vec<i32> {
        let models = self.models();
        let mut windings = vec![0; regions * models];
        let (first, across) = neighbours(sides, regions);
        let mut parts = UnionFind::new(regions);
        sides.iter().for_each(|[front, back]| {
            parts.union(*front, *back);
        });
        let (part_of, count) = parts.number();
        // A face of every part that a ray along x can leave.
        let mut seeds = vec![u32::MAX; count];
        for (f, [front, _]) in sides.iter().enumerate() {
            let seed = &mut seeds[part_of[*front as usize] as usize];
            if *seed == u32::MAX && self.facing(f as u32) != 0 {
                *seed = f as u32;
            }
        }
        let all: Vec<u32> = (0..self.faces.len() as u32).collect();
        let tree = BoxTree::new(&all, |f| self.faces[f as usize].map(|v| self.nodes[v as usize]), 0.0);
        let starts: Vec<Vec<i32>> = seeds.par_iter().map(|&f| self.about(f, &tree)).collect();
        let mut known = vec![false; regions];
        let mut pending = Vec::new();
        for (&f, start) in seeds.iter().zip(starts).filter(|(f, _)| **f != u32::MAX) {
            let side = usize::from(self.facing(f) < 0);
            let region = sides[f as usize][side] as usize;
            windings[region * models..][..models].copy_from_slice(&start);
            known[region] = true;
            pending.push(region);
            while let Some(region) = pending.pop() {
                for &f in &across[first[region] as usize..first[region + 1] as usize] {
                    let [front, back] = sides[f as usize].map(|r| r as usize);
                    let (next, sign) = if front == region { (back, 1) } else { (front, -1) };
                    if known[next] {
                        continue;
                    }
                    known[next] = true;
                    windings.copy_within(region * models..(region + 1) * models, next * models);
                    self.count(f, sign, &mut windings[next * models..][..models]);
                    pending.push(next);
                }
            }
        }
        windings
    }

    /// Adds what it makes to pass a face from front to back, times `sign`.
    fn count(&self, face: u32, sign: i32, windings: &mut [i32]) {
        for parent in self.parents(face) {
            let step = if parent.reversed { -sign } else { sign };
            windings[self.model_of(parent.face) as usize] += step;
        }
    }

    /// Sign of the x coordinate of a face's normal.
    fn facing(&self, face: u32) -> i32 {
        let [a, b, c] = self.faces[face as usize].map(|v| self.nodes[v as usize]);
        flat_area(0, a, b, c).signum() as i32
    }

    /// How often each model winds about the side of a face that looks along x.
    fn about(&self, face: u32, tree: &BoxTree) -> Vec<i32> {
        let mut windings = vec![0; self.models()];
        if face == u32::MAX {
            return windings;
        }
        // Three times the middle, a whole number.
        let corners = self.faces[face as usize].map(|v| self.nodes[v as usize]);
        let start: DVec3 = corners.into_iter().sum();
        let (from, to) = (start / 3.0, DVec3::new(f64::from(f32::MAX), start.y / 3.0, start.z / 3.0));
        tree.faces_near([from, from, to], |other| {
            let corners = self.faces[other as usize].map(|v| self.nodes[v as usize] * 3.0);
            if other != face && ahead(start, corners) {
                self.count(other, self.facing(other), &mut windings);
            }
        });
        windings
    }
}

/// Whether a ray along x from a point off a triangle meets it.
fn ahead(p: DVec3, [a, b, c]: [DVec3; 3]) -> bool {
    let turn = |a: DVec3, b: DVec3| {
        let at = |p: DVec3| Coord { x: p.y, y: p.z };
        let area = orient2d(at(a), at(b), at(p));
        // On the edge's line the ray is moved along y, and by far less along z.
        [area, a.z - b.z, b.y - a.y].into_iter().find(|x| *x != 0.0).unwrap_or(0.0) > 0.0
    };
    let turns = [turn(a, b), turn(b, c), turn(c, a)];
    if turns[0] != turns[1] || turns[1] != turns[2] {
        return false;
    }
    let at = |p: DVec3| Coord3D { x: p.x, y: p.y, z: p.z };
    // Anticlockwise seen from along x: the point is behind the plane if it is ahead.
    (orient3d(at(a), at(b), at(c), at(p)) > 0.0) == turns[0]
}

/// The faces of every region: where they begin, and all of them.
fn neighbours(sides: &[[u32; 2]], regions: usize) -> (Vec<u32>, Vec<u32>) {
    let mut first = vec![0u32; regions + 1];
    let apart = || sides.iter().enumerate().filter(|(_, [front, back])| front != back);
    apart().for_each(|(_, s)| s.iter().for_each(|r| first[*r as usize + 1] += 1));
    for r in 0..regions {
        first[r + 1] += first[r];
    }
    let mut next = first.clone();
    let mut across = vec![0u32; first[regions] as usize];
    for (f, s) in apart() {
        for r in s {
            across[next[*r as usize] as usize] = f as u32;
            next[*r as usize] += 1;
        }
    }
    (first, across)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ray_through_an_edge_meets_one_of_its_two_faces() {
        let [a, b, c, d] =
            [[5.0, 0.0, 0.0], [5.0, 4.0, 0.0], [5.0, 4.0, 4.0], [5.0, 0.0, 4.0]].map(DVec3::from_array);
        for p in [DVec3::new(0.0, 2.0, 2.0), DVec3::new(0.0, 1.0, 1.0), DVec3::new(0.0, 1.0, 3.0)] {
            let hits = [[a, b, c], [a, c, d], [a, c, b], [a, d, c]].map(|t| ahead(p, t));
            assert_eq!(hits.iter().filter(|h| **h).count(), 2, "{p}");
            assert_eq!((hits[0], hits[1]), (hits[2], hits[3]));
            assert!(![[a, b, c], [a, c, d]].iter().any(|t| ahead(p + DVec3::X * 9.0, *t)));
        }
    }
}
