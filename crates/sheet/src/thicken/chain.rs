//! The closed chain of a sheet: the offsets of all its entities, oriented, in one list of triangles.

use mesh_kernel::TriMesh;

use super::arcs::ArcRule;
use super::clean_sheet::CleanSheet;
use super::disks::{Disks, Path};
use super::entities::{Entities, corner_of_face, face_of, next, use_of};
use super::offsets::Offsets;
use super::orientation::turned_faces;
use super::wedges::push_strip;
use super::{Corners, Origin, Role, Side, ThickenError, ThickenOptions};

/// A wedge that bends by less than this, in radians, between unequal depths is a step of the thickness (30°).
const STEP: f64 = super::runs::SMOOTH;

/// The offsets of all entities of a sheet: a closed oriented 2-chain, whose winding number is 1 and more in the material.
///
/// Closed: every two nodes are joined by as many edges in one direction as in the other. Faces may cross and overlap;
/// [`mesh_kernel::merge::solid_of_chain`] makes a solid of them.
#[derive(Clone, Debug, Default)]
pub struct OffsetChain {
    /// Its triangles, oriented outward; positions are the sheet's nodes, then offset points.
    pub mesh: TriMesh,
    /// What each face came from; faces count in the input sheet.
    pub origins: Vec<Origin>,
    /// Holes between thickness faces that were filled.
    pub holes_filled: usize,
    /// Faces of the sheet where it bends more tightly than its depth, ascending.
    pub tight: Vec<u32>,
    /// Faces of the sheet at nodes where a mitre was longer than the limit, ascending.
    pub long_mitres: Vec<u32>,
    /// Patches with faces that were turned so that one side of the sheet became its front; ascending.
    pub turned: Vec<u32>,
}

/// Offsets all face-uses, wedges and disks of a sheet (Lee & Kim 2001, sections 5.1, 5.2, 5.4 and 6).
///
/// Groups are patches; their windings matter for one-sided thickening only.
///
/// # Errors
/// [`ThickenError`], but for its [`Merge`](ThickenError::Merge) and [`Cancelled`](ThickenError::Cancelled).
///
/// O(n log n); nodes are handled on all threads with the same result on any number of them.
pub fn offset_chain(sheet: &TriMesh, options: &ThickenOptions) -> Result<OffsetChain, ThickenError> {
    check_options(options)?;
    let sheet = CleanSheet::new(sheet, options)?;
    let entities = Entities::new(&sheet);
    Ok(Offsetting::new(&sheet, &entities, options)?.chain(options))
}

pub(super) fn check_options(options: &ThickenOptions) -> Result<(), ThickenError> {
    let check = |option, value: f64, above| {
        let fine = value.is_finite() && value > above;
        if fine { Ok(()) } else { Err(ThickenError::OptionRange { option, value, above }) }
    };
    check("chord", options.chord.unwrap_or(1.0), 0.0)?;
    check("mitre_limit", options.mitre_limit, 1.0)
}

/// A sheet whose sides are told apart and have their depths.
pub(super) struct Offsetting<'a> {
    sheet: &'a CleanSheet,
    entities: &'a Entities,
    /// Depth of every corner, in millimetres.
    depth: Vec<f64>,
    /// Whether a face's back is the sheet's front.
    turned: Vec<bool>,
}

impl<'a> Offsetting<'a> {
    /// Tells front from back where one side is wanted. Errors of [`turned_faces`].
    pub(super) fn new(
        sheet: &'a CleanSheet,
        entities: &'a Entities,
        options: &ThickenOptions,
    ) -> Result<Self, ThickenError> {
        let turned = match options.side {
            Side::Both => vec![false; sheet.faces.len()],
            Side::Front | Side::Back => turned_faces(sheet, entities)?,
        };
        let depth = (0..entities.node.len() as u32)
            .map(|corner| {
                let f = face_of(corner);
                let thickness = sheet.thickness[f][corner_of_face(corner)];
                let front = use_of(corner).is_multiple_of(2) != turned[f];
                match options.side {
                    Side::Both => 0.5 * thickness,
                    Side::Front if front => thickness,
                    Side::Back if !front => thickness,
                    Side::Front | Side::Back => 0.0,
                }
            })
            .collect();
        Ok(Self { sheet, entities, depth, turned })
    }

    /// Offsets everything.
    pub(super) fn chain(&self, options: &ThickenOptions) -> OffsetChain {
        let limit = (options.corners == Corners::Mitre).then_some(options.mitre_limit);
        let rule = ArcRule { chord: options.chord };
        let mut offsets = Offsets::new(self.sheet, self.entities, &self.depth, limit);
        let disks = Disks::new(self.sheet, self.entities, &self.depth, rule, &mut offsets);
        let mut chain = OffsetChain::default();
        self.push_tops(&offsets, &mut chain);
        self.push_wedges(&offsets, &disks, &mut chain);
        for closing in &disks.closings {
            let role = if closing.fill { Role::Fill } else { Role::Corner };
            chain.mesh.faces.push(closing.corners);
            chain.origins.push(self.origin(role, closing.corner));
        }
        chain.holes_filled = disks.holes_filled;
        let source = |f: u32| self.sheet.sources[f as usize];
        chain.tight = (0..self.sheet.faces.len() as u32)
            .filter(|&f| offsets.tight[2 * f as usize] || offsets.tight[2 * f as usize + 1])
            .map(source)
            .collect();
        let is_long = |v: &u32| offsets.long_mitres.binary_search(v).is_ok();
        if !offsets.long_mitres.is_empty() {
            let faces = self.sheet.faces.iter().zip(&self.sheet.sources);
            chain.long_mitres =
                faces.filter(|(corners, _)| corners.iter().any(is_long)).map(|(_, &f)| f).collect();
        }
        chain.turned = self.sheet.patches_of((0..self.turned.len()).filter(|&f| self.turned[f]));
        chain.mesh.positions = offsets.positions;
        chain
    }

    fn origin(&self, role: Role, corner: u32) -> Origin {
        let f = face_of(corner);
        Origin { role, patch: self.sheet.patches[f], face: self.sheet.sources[f] }
    }

    fn push_tops(&self, offsets: &Offsets, chain: &mut OffsetChain) {
        for u in 0..2 * self.sheet.faces.len() as u32 {
            let front = u.is_multiple_of(2) != self.turned[u as usize / 2];
            let [a, b, c] = offsets.top(u);
            if a == b || b == c || c == a {
                continue;
            }
            chain.mesh.faces.push([a, b, c]);
            let role = if front { Role::FrontWall } else { Role::BackWall };
            chain.origins.push(self.origin(role, 3 * u));
        }
    }

    fn push_wedges(&self, offsets: &Offsets, disks: &Disks, chain: &mut OffsetChain) {
        let entities = self.entities;
        let (mut near, mut far) = (Vec::new(), Vec::new());
        for edge_use in 0..entities.mate.len() as u32 {
            let mate = entities.mate[edge_use as usize];
            if mate < edge_use {
                continue;
            }
            // The paths at both ends, as disks have them: from the mate's corner at the near end, to it at the far.
            let ends = [(next(mate), edge_use), (next(edge_use), mate)];
            let places = ends.map(|(corner, _)| entities.place[corner as usize] as usize);
            if places.iter().all(|&place| disks.paths[place] == Path::Same) {
                continue;
            }
            for ((corner, following), (place, path)) in
                ends.into_iter().zip(places.into_iter().zip([&mut near, &mut far]))
            {
                path.clear();
                path.push(offsets.point[corner as usize]);
                let to = offsets.point[following as usize];
                disks.push_path(place, entities.node[corner as usize], to, path);
            }
            near.reverse();
            let before = chain.mesh.faces.len();
            push_strip(
                &offsets.positions,
                self.sheet.positions.len() as u32,
                &near,
                &far,
                &mut chain.mesh.faces,
            );
            let through = places.iter().any(|&place| disks.paths[place] == Path::ThroughNode);
            let turn = entities.turn[edge_use as usize].abs();
            let step = turn < STEP && self.depth[edge_use as usize] != self.depth[next(mate) as usize];
            let role = if entities.is_sharp(edge_use) || through || step {
                Role::ThicknessFace
            } else {
                Role::Corner
            };
            let origin = self.origin(role, edge_use);
            chain.origins.extend((before..chain.mesh.faces.len()).map(|_| origin));
        }
    }
}
