//! Regions of space that a body separates, and the shells that bound them.

use std::f64::consts::TAU;

use glam::DVec3;

use super::Body;
use super::ids::{FaceId, SurfaceId};
use super::shells::Shells;
use super::welded::{FaceNumbers, Welded};

/// Which side of a face: the one where its normal looks, or the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum FaceSide {
    /// Where the normal looks.
    Front,
    /// Behind.
    Back,
}

/// A side of a face (Lee & Kim: FACE-USE).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FaceUse {
    /// Surface.
    pub surface: SurfaceId,
    /// Face.
    pub face: FaceId,
    /// Its side.
    pub side: FaceSide,
}

/// One connected region of the space around and within a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    /// Shells that bound it, by number.
    pub shells: Vec<u32>,
    /// Volume, in mm³, what floats in it taken off; `None` for the region outside.
    pub volume: Option<f64>,
}

/// The regions of space, and which side of which face bounds which.
#[derive(Clone, Debug, PartialEq)]
pub struct Regions {
    regions: Vec<Region>,
    shell_of_side: Vec<u32>,
    region_of_shell: Vec<u32>,
    faces: FaceNumbers,
}

impl Regions {
    /// The regions; the first is the one outside.
    pub fn regions(&self) -> &[Region] {
        &self.regions
    }

    /// The shell that a side of a face belongs to: sides that one can walk to round edges.
    pub fn shell(&self, surface: SurfaceId, face: FaceId, side: FaceSide) -> u32 {
        let f = self.faces.number(surface, face.0);
        self.shell_of_side[2 * f as usize + usize::from(side == FaceSide::Back)]
    }

    /// Index of the region that a side of a face bounds.
    pub fn region(&self, surface: SurfaceId, face: FaceId, side: FaceSide) -> u32 {
        self.region_of_shell[self.shell(surface, face, side) as usize]
    }

    /// Number of shells.
    pub fn shell_count(&self) -> usize {
        self.region_of_shell.len()
    }

    /// The face-uses that bound a region, in order of surfaces and faces, front before back; a face that stands within the
    /// region has both. Empty where there is no such region. O(faces).
    pub fn faces_of(&self, region: u32) -> Vec<FaceUse> {
        self.uses_where(|shell| self.region_of_shell[shell as usize] == region)
    }

    /// The face-uses of a shell, in order of surfaces and faces, front before back. O(faces).
    pub fn faces_of_shell(&self, shell: u32) -> Vec<FaceUse> {
        self.uses_where(|s| s == shell)
    }

    fn uses_where(&self, wanted: impl Fn(u32) -> bool) -> Vec<FaceUse> {
        let mut uses = Vec::new();
        for f in 0..self.faces.count() {
            let (surface, face) = self.faces.face(f);
            for (k, side) in [FaceSide::Front, FaceSide::Back].into_iter().enumerate() {
                if wanted(self.shell_of_side[2 * f as usize + k]) {
                    uses.push(FaceUse { surface, face, side });
                }
            }
        }
        uses
    }
}

impl Body {
    /// Finds the regions: shells by the radial order of sheets, parts that float in a void by winding numbers.
    ///
    /// O(faces), and O(floating parts · faces) where there are voids and several parts.
    pub fn regions(&self) -> Regions {
        let complex = Welded::new(self);
        let shells = Shells::new(&complex);
        let volumes = shells.volumes(self);
        let outer = shells.outer(&volumes);
        let mut looks_outside = vec![false; shells.count];
        outer.iter().for_each(|&s| looks_outside[s] = true);
        // Numbers of regions: outside, then the voids in order of their shells.
        let mut region_of_shell = vec![0; shells.count];
        let mut regions = vec![Region { shells: Vec::new(), volume: None }];
        for (shell, &volume) in volumes.iter().enumerate() {
            if !looks_outside[shell] {
                region_of_shell[shell] = regions.len() as u32;
                regions.push(Region { shells: Vec::new(), volume: Some(volume) });
            }
        }
        if regions.len() > 1 && outer.len() > 1 {
            let voids: Vec<usize> = (0..shells.count).filter(|&s| !looks_outside[s]).collect();
            self.place_parts(&shells, &volumes, (&outer, &voids), &mut region_of_shell);
        }
        for (shell, &region) in region_of_shell.iter().enumerate() {
            let region = &mut regions[region as usize];
            region.shells.push(shell as u32);
            if looks_outside[shell]
                && let Some(volume) = &mut region.volume
            {
                // The shell that looks outside has its part's volume, negative.
                *volume += volumes[shell];
            }
        }
        Regions { regions, shell_of_side: shells.of_side, region_of_shell, faces: complex.faces }
    }

    /// Puts every part that floats in a void into the smallest void around it.
    fn place_parts(
        &self,
        shells: &Shells,
        volumes: &[f64],
        (outer, voids): (&[usize], &[usize]),
        region_of_shell: &mut [u32],
    ) {
        let triangles: Vec<[DVec3; 3]> =
            self.surfaces().flat_map(|(_, s)| s.live_faces().map(move |f| s.corners(f))).collect();
        // A point of every part: the middle of its first face.
        let mut points = vec![DVec3::ZERO; shells.sheets];
        for (f, &part) in shells.sheet_of_face.iter().enumerate().rev() {
            points[part as usize] = triangles[f].iter().sum::<DVec3>() / 3.0;
        }
        for (part, &point) in points.iter().enumerate() {
            let mut turns = vec![0.0; volumes.len()];
            for (f, &[a, b, c]) in triangles.iter().enumerate() {
                if shells.sheet_of_face[f] as usize != part {
                    let angle = solid_angle(a - point, b - point, c - point);
                    turns[shells.of_side[2 * f] as usize] -= angle;
                    turns[shells.of_side[2 * f + 1] as usize] += angle;
                }
            }
            let around = voids.iter().filter(|s| turns[**s] > TAU);
            if let Some(&shell) = around.min_by(|a, b| volumes[**a].total_cmp(&volumes[**b])) {
                region_of_shell[outer[part]] = region_of_shell[shell];
            }
        }
    }
}

/// Solid angle of a triangle seen from the origin, positive seen from behind (van Oosterom & Strackee 1983).
fn solid_angle(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    let (x, y, z) = (a.length(), b.length(), c.length());
    let below = x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y;
    2.0 * a.dot(b.cross(c)).atan2(below)
}
