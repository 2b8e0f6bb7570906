//! Flats of a skin: the facets that a curved group was made of before anybody divided them where they lie.
//!
//! Of what lies in one plane only the corners, where three planes and more meet, are nodes of the true surface for sure; what lies on a
//! fold between two is on a chord. In a group that is not divided every triangle is a flat, and every node a corner.

use glam::DVec3;
use rayon::prelude::*;

use super::segments::Segments;
use super::solid::Solid;

/// A group is divided if it has so many times more triangles than planes: two make a facet of a round face.
const DIVIDED: usize = 3;

const NONE: u32 = u32::MAX;

/// The flats of all curved groups, those of one group next to each other.
#[derive(Debug)]
pub(super) struct Flats {
    /// Flat of every triangle; those of plane groups have none.
    of: Vec<u32>,
    /// The first triangle of every flat in the list below.
    starts: Vec<u32>,
    triangles: Vec<u32>,
    /// The first flat of every group.
    of_group: Vec<u32>,
    /// Area in mm², unit normal, middle.
    measures: Vec<(f64, DVec3, DVec3)>,
    /// Of every flat, what it is if it is divided.
    divided: Vec<Option<Divided>>,
}

/// A flat of many triangles.
#[derive(Debug)]
struct Divided {
    /// Its corners; all its nodes if there are less than three: groups may have been cut across it.
    corners: Vec<u32>,
    /// The flats behind its edges.
    beside: Vec<u32>,
}

impl Flats {
    /// O(n log n).
    pub(super) fn new(solid: &Solid, segments: &Segments) -> Self {
        let mut of = vec![NONE; solid.len() as usize];
        let mut of_group = vec![0];
        let mut starts: Vec<u32> = vec![0];
        let mut is_divided = Vec::new();
        // Of every plane part of the skin the last flat that it got.
        let parts = segments.plane_part.iter().max().map_or(0, |p| *p as usize + 1);
        let mut last = vec![NONE; parts];
        for group in &segments.groups {
            let first = starts.len() as u32 - 1;
            let own = || group.faces.iter().filter(|_| group.plane.is_none());
            let mut count = 0;
            for f in own() {
                let part = &mut last[segments.plane_part[*f as usize] as usize];
                if *part == NONE || *part < first {
                    *part = first + count;
                    count += 1;
                }
                of[*f as usize] = *part;
            }
            let divided = group.faces.len() > DIVIDED * count as usize;
            if !divided {
                (first..).zip(own()).for_each(|(flat, f)| of[*f as usize] = flat);
                count = own().count() as u32;
            }
            is_divided.resize((first + count) as usize, divided);
            starts.resize((first + count) as usize + 1, 0);
            own().for_each(|f| starts[of[*f as usize] as usize + 1] += 1);
            of_group.push(first + count);
        }
        for k in 1..starts.len() {
            starts[k] += starts[k - 1];
        }
        let mut fill = starts.clone();
        let mut triangles = vec![0; starts.last().map_or(0, |n| *n as usize)];
        for (f, flat) in (0u32..).zip(&of).filter(|(_, flat)| **flat != NONE) {
            let at = &mut fill[*flat as usize];
            triangles[*at as usize] = f;
            *at += 1;
        }
        let mut flats = Self { of, starts, triangles, of_group, measures: Vec::new(), divided: Vec::new() };
        let count = flats.starts.len() as u32 - 1;
        let is_corner = corners(solid, &segments.plane_part);
        let divided = |k: u32| is_divided[k as usize].then(|| flats.divided(solid, &is_corner, k));
        flats.divided = (0..count).into_par_iter().map(divided).collect();
        flats.measures = (0..count).into_par_iter().map(|k| measures(solid, flats.triangles(k))).collect();
        flats
    }

    /// The flats of a group.
    pub(super) fn of_group(&self, g: u32) -> std::ops::Range<u32> {
        self.of_group[g as usize]..self.of_group[g as usize + 1]
    }

    /// The triangles of a flat, ascending.
    pub(super) fn triangles(&self, flat: u32) -> &[u32] {
        &self.triangles[self.starts[flat as usize] as usize..self.starts[flat as usize + 1] as usize]
    }

    fn divided(&self, solid: &Solid, is_corner: &[bool], flat: u32) -> Divided {
        let mut nodes: Vec<u32> =
            self.triangles(flat).iter().flat_map(|f| solid.mesh.faces[*f as usize]).collect();
        nodes.sort_unstable();
        nodes.dedup();
        let corners: Vec<u32> = nodes.iter().copied().filter(|v| is_corner[*v as usize]).collect();
        let mut beside: Vec<u32> = self.behind_edges(solid, flat).collect();
        beside.sort_unstable();
        beside.dedup();
        Divided { corners: if corners.len() < 3 { nodes } else { corners }, beside }
    }

    fn behind_edges(&self, solid: &Solid, flat: u32) -> impl Iterator<Item = u32> {
        let sides = self.triangles(flat).iter().flat_map(|f| 3 * f..3 * f + 3);
        let others = sides.map(|h| self.of[solid.across(h) as usize]);
        others.filter(move |other| *other != flat && *other != NONE)
    }

    /// The flats behind the edges of one, those of plane groups left out.
    pub(super) fn beside(&self, solid: &Solid, flat: u32) -> impl Iterator<Item = u32> {
        let divided = self.divided[flat as usize].as_ref();
        let known = divided.map(|divided| divided.beside.iter().copied());
        let own = divided.is_none().then(|| self.behind_edges(solid, flat));
        known.into_iter().flatten().chain(own.into_iter().flatten())
    }

    /// The corners of a flat.
    pub(super) fn corners(&self, solid: &Solid, flat: u32) -> impl Iterator<Item = u32> {
        let divided = self.divided[flat as usize].as_ref();
        let known = divided.map(|divided| divided.corners.iter().copied());
        let own = divided.is_none().then(|| solid.mesh.faces[self.triangles(flat)[0] as usize]);
        known.into_iter().flatten().chain(own.into_iter().flatten())
    }

    /// Area in mm².
    pub(super) fn area(&self, flat: u32) -> f64 {
        self.measures[flat as usize].0
    }

    /// The unit normal, outward.
    pub(super) fn normal(&self, flat: u32) -> DVec3 {
        self.measures[flat as usize].1
    }

    /// The middle of its area.
    pub(super) fn middle(&self, flat: u32) -> DVec3 {
        self.measures[flat as usize].2
    }
}

fn measures(solid: &Solid, triangles: &[u32]) -> (f64, DVec3, DVec3) {
    let (mut area, mut normal, mut moment) = (0.0, DVec3::ZERO, DVec3::ZERO);
    for f in triangles {
        let own = solid.areas[*f as usize];
        area += own;
        normal += solid.normals[*f as usize] * own;
        moment += solid.centroid(*f) * own;
    }
    let first = triangles.first().copied().unwrap_or_default();
    let middle = if area > 0.0 { moment / area } else { solid.centroid(first) };
    let unit = normal.normalize_or_zero();
    (area, if unit == DVec3::ZERO { solid.normals[first as usize] } else { unit }, middle)
}

/// Of every node, whether three plane parts and more meet there.
fn corners(solid: &Solid, plane_part: &[u32]) -> Vec<bool> {
    let nodes = solid.mesh.positions.len();
    let mut known = vec![[NONE; 2]; nodes];
    let mut is_corner = vec![false; nodes];
    for (face, part) in solid.mesh.faces.iter().zip(plane_part) {
        for &v in face {
            match &mut known[v as usize] {
                [a, b] if a == part || b == part => {}
                [a, _] if *a == NONE => *a = *part,
                [_, b] if *b == NONE => *b = *part,
                _ => is_corner[v as usize] = true,
            }
        }
    }
    is_corner
}
