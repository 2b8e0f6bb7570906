//! Regions of space that a body separates, the shells that bound them, and sectors about joints.

use std::f64::consts::TAU;

use glam::DVec3;

use super::Body;
use super::ids::{FaceId, JointId, SurfaceId};
use super::joint::{Sheet, Side};
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
}

/// What one meets on the way round a joint, where faces bound material that lies behind them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Crossing {
    /// Into material.
    Enters,
    /// Out of it.
    Leaves,
}

/// The wedge between two sheets that follow each other about a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sector {
    /// Where it begins, clockwise.
    pub from: Sheet,
    /// Where it ends.
    pub to: Sheet,
    /// Angle at the edge asked for, in radians, 0 to 2π.
    pub angle: f64,
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

    /// What one who goes clockwise round a joint crosses, if faces bound material behind them. In a sound solid the two
    /// alternate; two [`Crossing::Enters`] in a row are material within material (Stroud & Nagy, fig. 6.5).
    pub fn crossings_about(&self, joint: JointId) -> Vec<Crossing> {
        let crossing = |s: &Sheet| match s.side {
            Side::Left => Crossing::Leaves,
            Side::Right => Crossing::Enters,
        };
        self.joint(joint).radial().iter().map(crossing).collect()
    }

    /// Whether entering and leaving material alternate round a joint.
    pub fn alternates(&self, joint: JointId) -> bool {
        let all = self.crossings_about(joint);
        all.iter().zip(all.iter().cycle().skip(1)).all(|(a, b)| a != b)
    }

    /// The wedges about a joint in clockwise order, with their angles at its edge `k`. A single sheet has one wedge of a
    /// full turn. O(sheets).
    pub fn sectors(&self, joint: JointId, k: usize) -> Vec<Sector> {
        let j = self.joint(joint);
        let sheets = self.sheets_at(joint, k);
        let axis = self.joint_edge(joint, 0, k);
        let Some(first) = j.uses().first() else { return Vec::new() };
        let surface = self.surface(first.surface);
        let [a, b] = surface.ends(axis).map(|v| surface.positions[v.index()]);
        let direction = (b - a).normalize_or_zero();
        let out = |sheet: &Sheet| {
            let face = sheets.iter().find(|(s, _)| s == sheet).map(|(_, f)| *f)?;
            let s = self.surface(j.uses()[sheet.use_index as usize].surface);
            let edge = self.joint_edge(joint, sheet.use_index as usize, k).edge().0;
            let p = s.positions[s.apex(face, edge) as usize] - a;
            Some(p - direction * p.dot(direction))
        };
        let next = j.radial().iter().cycle().skip(1);
        j.radial()
            .iter()
            .zip(next)
            .filter_map(|(from, to)| {
                let (p, q) = (out(from)?, out(to)?);
                let angle = direction.dot(p.cross(q)).atan2(p.dot(q)).rem_euclid(TAU);
                let angle = if from == to { TAU } else { angle };
                Some(Sector { from: *from, to: *to, angle })
            })
            .collect()
    }
}

/// Solid angle of a triangle seen from the origin, positive seen from behind (van Oosterom & Strackee 1983).
fn solid_angle(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    let (x, y, z) = (a.length(), b.length(), c.length());
    let below = x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y;
    2.0 * a.dot(b.cross(c)).atan2(below)
}
