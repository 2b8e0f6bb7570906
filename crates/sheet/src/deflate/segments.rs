//! Segmentation of a skin into face groups: planes, and smooth pieces between sharp edges.

use std::collections::BTreeSet;

use super::plane::Plane;
use super::regions::{COPLANAR, Regions, mean_plane};
use super::solid::{SHARP, Solid};

const NONE: u32 = u32::MAX;

/// A face group of the skin.
#[derive(Clone, Debug)]
pub(super) struct Group {
    /// Its faces, ascending.
    pub(super) faces: Vec<u32>,
    /// Its plane, if it has one; the normal points outward.
    pub(super) plane: Option<Plane>,
    /// Area in mm².
    pub(super) area: f64,
}

/// The skin cut into groups.
#[derive(Debug)]
pub(super) struct Segments {
    pub(super) groups: Vec<Group>,
    /// Group of every face.
    pub(super) of_face: Vec<u32>,
    /// Of every face, which of the skin's largest parts in one plane it is in.
    pub(super) plane_part: Vec<u32>,
}

impl Segments {
    /// Cuts a skin into groups. O(n log n).
    pub(super) fn new(solid: &Solid) -> Self {
        let regions = Regions::new(solid, COPLANAR * solid.size, false);
        let is_plane = regions.planes(solid);
        let mut of_face = vec![NONE; solid.len() as usize];
        let mut groups = Vec::new();
        let mut stack = Vec::new();
        for seed in 0..solid.len() {
            if of_face[seed as usize] != NONE {
                continue;
            }
            let number = groups.len() as u32;
            let region = regions.of_face[seed as usize];
            let plane = is_plane[region as usize];
            let mut faces = Vec::new();
            of_face[seed as usize] = number;
            stack.push(seed);
            while let Some(f) = stack.pop() {
                faces.push(f);
                for h in 3 * f..3 * f + 3 {
                    let g = solid.across(h);
                    let other = regions.of_face[g as usize];
                    let together = if plane {
                        other == region
                    } else {
                        !is_plane[other as usize] && solid.fold_cosine(h) > SHARP.cos()
                    };
                    if of_face[g as usize] == NONE && together {
                        of_face[g as usize] = number;
                        stack.push(g);
                    }
                }
            }
            faces.sort_unstable();
            let area = faces.iter().map(|f| solid.areas[*f as usize]).sum();
            let plane = plane.then(|| mean_plane(solid, &faces));
            groups.push(Group { faces, plane, area });
        }
        Self { groups, of_face, plane_part: regions.of_face }
    }

    /// Hands faces over to other groups that they touch. What this leaves in several pieces is parted.
    pub(super) fn hand_over(&mut self, rows: &[(u32, Vec<u32>)], solid: &Solid) {
        for (to, faces) in rows {
            faces.iter().for_each(|f| self.of_face[*f as usize] = *to);
            let group = &mut self.groups[*to as usize];
            group.faces.extend(faces);
            group.faces.sort_unstable();
            group.faces.dedup();
        }
        self.part_left(solid);
        for (to, _) in rows {
            let group = &mut self.groups[*to as usize];
            group.area = group.faces.iter().map(|f| solid.areas[*f as usize]).sum();
        }
    }

    /// Makes groups of their own of sets of faces, and of what these leave in several pieces.
    pub(super) fn split_off(&mut self, parts: &[Vec<u32>], solid: &Solid) {
        for part in parts {
            let number = self.groups.len() as u32;
            let area = part.iter().map(|f| solid.areas[*f as usize]).sum();
            for &f in part {
                self.of_face[f as usize] = number;
            }
            self.groups.push(Group { faces: part.clone(), plane: None, area });
        }
        self.part_left(solid);
    }

    /// Takes faces that are others' now from groups.
    fn part_left(&mut self, solid: &Solid) {
        let mut parted: Vec<u32> = Vec::new();
        for (g, group) in (0u32..).zip(&mut self.groups) {
            let before = group.faces.len();
            group.faces.retain(|f| self.of_face[*f as usize] == g);
            if group.faces.len() < before {
                parted.push(g);
            }
        }
        for g in parted {
            self.part(g, solid);
        }
    }

    /// Makes groups of the pieces of one; the first keeps its number.
    fn part(&mut self, g: u32, solid: &Solid) {
        let plane = self.groups[g as usize].plane;
        let faces = std::mem::take(&mut self.groups[g as usize].faces);
        let mut seen = BTreeSet::new();
        let mut pieces: Vec<Vec<u32>> = Vec::new();
        for seed in faces {
            if !seen.insert(seed) {
                continue;
            }
            let (mut piece, mut at) = (vec![seed], 0);
            while at < piece.len() {
                for h in 3 * piece[at]..3 * piece[at] + 3 {
                    let other = solid.across(h);
                    let together = plane.is_some() || solid.fold_cosine(h) > SHARP.cos();
                    if self.of_face[other as usize] == g && together && seen.insert(other) {
                        piece.push(other);
                    }
                }
                at += 1;
            }
            piece.sort_unstable();
            pieces.push(piece);
        }
        self.groups[g as usize].area = 0.0;
        for (k, faces) in pieces.into_iter().enumerate() {
            let number = if k == 0 { g } else { self.groups.len() as u32 };
            let area = faces.iter().map(|f| solid.areas[*f as usize]).sum();
            faces.iter().for_each(|f| self.of_face[*f as usize] = number);
            let group = Group { faces, plane, area };
            if k == 0 {
                self.groups[g as usize] = group;
            } else {
                self.groups.push(group);
            }
        }
    }

    /// The group of a face.
    pub(super) fn of(&self, f: u32) -> u32 {
        self.of_face[f as usize]
    }

    /// A group by its number.
    pub(super) fn group(&self, g: u32) -> &Group {
        &self.groups[g as usize]
    }
}
