//! Sectors: the wedges of space between sheets that follow each other about an edge.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::DVec3;

use super::Body;
use super::ids::{DirectedEdge, EdgeId, FaceId, JointId, NONE, SurfaceId};
use super::joint::{Sheet, Side};
use super::radial::{Quarter, quarter};
use super::regions::{FaceSide, FaceUse};

/// What one meets on the way round a joint, where faces bound material that lies behind them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Crossing {
    /// Into material.
    Enters,
    /// Out of it.
    Leaves,
}

impl Sheet {
    /// What one who goes clockwise about the joint's direction does at the sheet: a face that runs along the joint has its
    /// normal onwards, and so its material behind.
    pub fn crossing(&self) -> Crossing {
        match self.side {
            Side::Left => Crossing::Leaves,
            Side::Right => Crossing::Enters,
        }
    }

    /// The side of the sheet's face that looks onwards in the radial order, and the one that looks back.
    fn sides(&self) -> [FaceSide; 2] {
        match self.side {
            Side::Left => [FaceSide::Front, FaceSide::Back],
            Side::Right => [FaceSide::Back, FaceSide::Front],
        }
    }
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

/// The wedge between two face-uses about any edge: on a joint, within a surface, on its boundary, or a wire.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeSector {
    /// The face-use that looks into it where it begins, clockwise for one who looks along the edge (along the joint where
    /// it is on one); `None` about a wire.
    pub from: Option<FaceUse>,
    /// The face-use that looks into it where it ends.
    pub to: Option<FaceUse>,
    /// Angle, in radians, 0 to 2π.
    pub angle: f64,
}

impl Body {
    /// What one who goes clockwise round a joint crosses, if faces bound material behind them. In a sound solid the two
    /// alternate; two [`Crossing::Enters`] in a row are material within material (Stroud & Nagy, fig. 6.5).
    pub fn crossings_about(&self, joint: JointId) -> Vec<Crossing> {
        self.joint(joint).radial().iter().map(Sheet::crossing).collect()
    }

    /// Whether entering and leaving material alternate round a joint.
    pub fn alternates(&self, joint: JointId) -> bool {
        let all = self.crossings_about(joint);
        all.iter().zip(all.iter().cycle().skip(1)).all(|(a, b)| a != b)
    }

    /// The sheets before and after a sheet in the joint's radial order: the sheet itself where it is alone, `None` where it
    /// is not the joint's. O(sheets).
    pub fn radial_neighbours(&self, joint: JointId, sheet: Sheet) -> Option<[Sheet; 2]> {
        let radial = self.joint(joint).radial();
        let (at, n) = (radial.iter().position(|s| *s == sheet)?, radial.len());
        Some([radial[(at + n - 1) % n], radial[(at + 1) % n]])
    }

    /// The face of a sheet at edge `k` of its joint. `None` where the sheet is not the joint's.
    pub fn sheet_face(&self, joint: JointId, sheet: Sheet, k: usize) -> Option<(SurfaceId, FaceId)> {
        let u = self.joint(joint).uses().get(sheet.use_index as usize)?;
        let d = self.joint_edge(joint, sheet.use_index as usize, k);
        let d = if sheet.side == Side::Left { d } else { d.flipped() };
        let face = self.surface(u.surface).face_left(d);
        (face != NONE).then_some((u.surface, FaceId(face)))
    }

    /// The wedges about a joint in clockwise order, with their angles at its edge `k`. A single sheet has one wedge of a
    /// full turn. Sheets that leave in exactly the same direction have a wedge of angle 0 between them. O(sheets).
    pub fn sectors(&self, joint: JointId, k: usize) -> Vec<Sector> {
        let Some(first) = self.joint(joint).uses().first() else { return Vec::new() };
        let ends = self.surface(first.surface).ends(self.joint_edge(joint, 0, k));
        let [a, b] = ends.map(|v| self.surface(first.surface).positions[v.index()]);
        let (mut sheets, mut apexes) = (Vec::new(), Vec::new());
        for &sheet in self.joint(joint).radial() {
            if let Some((s, face)) = self.sheet_face(joint, sheet, k) {
                let edge = self.joint_edge(joint, sheet.use_index as usize, k).edge();
                let surface = self.surface(s);
                sheets.push(sheet);
                apexes.push(surface.positions[surface.apex(face.0, edge.0) as usize]);
            }
        }
        let next = sheets.iter().cycle().skip(1);
        let angles = angles(a, b, &apexes);
        sheets.iter().zip(next).zip(angles).map(|((&from, &to), angle)| Sector { from, to, angle }).collect()
    }

    /// The wedges about an edge of a surface, and the face-uses that bound them, in clockwise order: those of its joint
    /// where it is on one; two within a surface; one on its boundary; one without face-uses about a wire;
    /// none where there is no such edge.
    ///
    /// O(sheets), and O(length of the chain) on a joint.
    pub fn edge_sectors(&self, surface: SurfaceId, edge: EdgeId) -> Vec<EdgeSector> {
        let wire = vec![EdgeSector { from: None, to: None, angle: TAU }];
        if let Some((joint, k)) = self.place_on_joint(surface, edge) {
            let face_use = |sheet: Sheet, onwards: bool| {
                let (surface, face) = self.sheet_face(joint, sheet, k)?;
                Some(FaceUse { surface, face, side: sheet.sides()[usize::from(!onwards)] })
            };
            let sectors: Vec<EdgeSector> = self
                .sectors(joint, k)
                .into_iter()
                .map(|s| EdgeSector {
                    from: face_use(s.from, true),
                    to: face_use(s.to, false),
                    angle: s.angle,
                })
                .collect();
            return if sectors.is_empty() { wire } else { sectors };
        }
        let s = self.surface(surface);
        if !s.is_edge(edge) {
            return Vec::new();
        }
        let [a, b] = s.edges()[edge.index()].map(|v| s.positions[v as usize]);
        let faces: Vec<(Side, u32)> = [Side::Left, Side::Right]
            .into_iter()
            .zip(s.edge_faces()[edge.index()])
            .filter(|(_, f)| *f != NONE)
            .collect();
        if faces.is_empty() {
            return wire;
        }
        let apexes: Vec<DVec3> =
            faces.iter().map(|(_, f)| s.positions[s.apex(*f, edge.0) as usize]).collect();
        let face_use = |(side, face): (Side, u32), onwards: bool| {
            let side = Sheet { use_index: 0, side }.sides()[usize::from(!onwards)];
            Some(FaceUse { surface, face: FaceId(face), side })
        };
        let next = faces.iter().cycle().skip(1);
        faces
            .iter()
            .zip(next)
            .zip(angles(a, b, &apexes))
            .map(|((&from, &to), angle)| EdgeSector {
                from: face_use(from, true),
                to: face_use(to, false),
                angle,
            })
            .collect()
    }

    /// The joint that an edge is on, and which of the joint's edges it is.
    fn place_on_joint(&self, surface: SurfaceId, edge: EdgeId) -> Option<(JointId, usize)> {
        let s = self.surface(surface);
        let id = s.is_edge(edge).then(|| s.edge_chain(edge)).flatten()?;
        let chain = s.chain(id);
        let joint = chain.joint()?;
        let at = chain.edges().iter().map(|d: &DirectedEdge| d.edge()).position(|e| e == edge)?;
        let own = self.joint(joint).uses().iter().find(|u| (u.surface, u.chain) == (surface, id))?;
        Some((joint, if own.reversed { chain.edges().len() - 1 - at } else { at }))
    }
}

/// Angles from each sheet to the next about the axis `a` → `b`, clockwise. Rounded as arcs are, but never across half or a
/// full turn: on which side of these an angle lies is decided exactly.
fn angles(a: DVec3, b: DVec3, apexes: &[DVec3]) -> Vec<f64> {
    let axis = b - a;
    let direction = axis.normalize_or_zero();
    // Across the axis. One rounding a step, so that slivers along the axis keep their digits.
    let out = |apex: DVec3| {
        (0..2).fold(apex - a, |p, _| {
            let along = -p.dot(axis) / axis.length_squared();
            DVec3::splat(along).mul_add(axis, p)
        })
    };
    let mut angles: Vec<f64> = apexes
        .iter()
        .zip(apexes.iter().cycle().skip(1))
        .map(|(&from, &to)| {
            let (p, q) = (out(from), out(to));
            let angle = direction.dot(p.cross(q)).atan2(p.dot(q)).rem_euclid(TAU);
            match quarter(a, b, from, to) {
                Quarter::Same | Quarter::Nowhere => 0.0,
                Quarter::Opposite => PI,
                Quarter::First if angle > PI => {
                    if angle > PI + FRAC_PI_2 {
                        0.0
                    } else {
                        PI
                    }
                }
                Quarter::Second if angle < PI => {
                    if angle < FRAC_PI_2 {
                        TAU
                    } else {
                        PI
                    }
                }
                Quarter::First | Quarter::Second => angle,
            }
        })
        .collect();
    // All in one direction: what is left of the turn comes after the last.
    if angles.iter().all(|x| *x == 0.0)
        && let Some(last) = angles.last_mut()
    {
        *last = TAU;
    }
    angles
}
