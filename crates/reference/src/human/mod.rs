//! Features of human bodies from geometry alone.

mod error;
mod export;
mod facing;
mod figure;
mod girths;
mod heading;
mod joins;
mod limbs;
mod marks;
mod normals;
mod plates;
mod ring;
mod tied;
mod upright;
mod verticals;

use std::collections::BTreeMap;

use mesh_kernel::TriMesh;
use mesh_kernel::glam::{DMat3, DVec3};

pub use error::HumanError;
pub use export::{ExportedCurve, ExportedFeatures};
pub use tied::TiedFeatures;

use crate::model::Features;

/// Length unit of a mesh file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Unit {
    /// 1000 mm.
    Metre,
    /// 10 mm.
    Centimetre,
    /// 1 mm.
    Millimetre,
    /// 25.4 mm; never told from a height, only said.
    Inch,
}

impl Unit {
    /// How many millimetres one unit has.
    pub fn millimetres(self) -> f64 {
        match self {
            Self::Metre => 1000.0,
            Self::Centimetre => 10.0,
            Self::Millimetre => 1.0,
            Self::Inch => 25.4,
        }
    }

    /// `m`, `cm`, `mm` or `in`.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Metre => "m",
            Self::Centimetre => "cm",
            Self::Millimetre => "mm",
            Self::Inch => "in",
        }
    }

    /// Its name for people, of more than one.
    pub fn plural(self) -> &'static str {
        match self {
            Self::Metre => "metres",
            Self::Centimetre => "centimetres",
            Self::Millimetre => "millimetres",
            Self::Inch => "inches",
        }
    }
}

/// What the caller knows about the mesh. Everything left `None` is found from the geometry.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HumanOptions {
    /// Unit of the coordinates; default: told from the height.
    pub unit: Option<Unit>,
    /// Direction of the head, in the mesh's frame; default: one of the six axis directions, told from the sections.
    pub up: Option<DVec3>,
    /// Direction the body faces, in the mesh's frame, roughly (only front or back is taken from it).
    pub facing: Option<DVec3>,
}

/// Similarity between the canonical frame (millimetres, y up, facing +z, left = +x) and a file's own frame:
/// `file = translation + scale * rotation * canonical`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// File units in a millimetre.
    pub scale: f64,
    /// Proper rotation from canonical to file directions.
    pub rotation: DMat3,
    /// Where the canonical origin lies in the file, file units.
    pub translation: DVec3,
}

impl Placement {
    /// The placement of a file that is in the canonical frame already.
    pub const IDENTITY: Self = Self { scale: 1.0, rotation: DMat3::IDENTITY, translation: DVec3::ZERO };

    /// A canonical point in the file's frame and unit.
    pub fn to_file(&self, p: DVec3) -> DVec3 {
        self.translation + self.rotation * p * self.scale
    }

    /// A point of the file in the canonical frame.
    pub fn from_file(&self, p: DVec3) -> DVec3 {
        self.rotation.transpose() * (p - self.translation) / self.scale
    }

    /// A canonical direction in the file's frame.
    pub fn direction_to_file(&self, d: DVec3) -> DVec3 {
        self.rotation * d
    }
}

/// A body with its features.
#[derive(Clone, Debug)]
pub struct HumanBody {
    /// The input in the canonical frame: same nodes and faces in the same order; faces turned over if the input was
    /// inside out.
    pub mesh: TriMesh,
    /// The way back to the file.
    pub placement: Placement,
    /// Unit of the file.
    pub unit: Unit,
    /// Curves and points in the canonical frame.
    pub features: Features,
    /// Tape measures in millimetres by curve name: `bust`, `waist`, `hip`, `neck`, `left_thigh`, ...
    pub girths: BTreeMap<String, f64>,
}

/// Length of a taut tape around points of a plane: the perimeter of their convex hull.
pub(crate) fn taut_length(points: &[mesh_kernel::glam::DVec2]) -> f64 {
    ring::perimeter(&ring::hull(points))
}

/// Least number of triangles that features are looked for on.
const LEAST_FACES: usize = 200;

/// Finds unit, axes, heading, landmarks, curves and girths of an upright body.
///
/// Works on the shape alone: level sections, their branching and outlines, the mirror symmetry of both halves. The mesh
/// may be open, noisy, non-manifold, with repeated nodes, in any of three units, and with any of the six axis
/// directions up.
///
/// # Errors
/// A [`HumanError`] says why the mesh is no usable upright body; nothing is guessed then.
///
/// # Complexity
/// O(n log n) for n triangles, plus O(n^0.5) for each of some 500 sections.
pub fn extract(raw: &TriMesh, options: &HumanOptions) -> Result<HumanBody, HumanError> {
    let mut surface = sound_surface(raw)?;
    let upright = upright::find(&surface, options)?;
    let unit = upright.unit;
    let (left, front) = upright::level_directions(upright.up);
    let scale = 1.0 / unit.millimetres();

    // To millimetres, y up, about the middle, floor at 0.
    let basis = DMat3::from_cols(left, upright.up, front);
    let mut placement = Placement { scale, rotation: basis, translation: DVec3::ZERO };
    transform(&mut surface, &placement);
    let [lo, hi] = surface.bounds().ok_or(HumanError::Empty)?;
    placement = shifted(&placement, DVec3::new((lo.x + hi.x) / 2.0, lo.y, (lo.z + hi.z) / 2.0), &mut surface);
    let height = hi.y - lo.y;
    if inside_out(&surface) {
        turn_over(&mut surface);
    }

    // Symmetry plane to x = 0.
    let mirror = heading::mirror_plane(&surface)
        .ok_or(HumanError::NotUpright { reason: "its surface has no area".to_owned() })?;
    if mirror.residual > WORST_SYMMETRY * height {
        return Err(HumanError::NotSymmetric { residual: mirror.residual });
    }
    let normal = mirror.normal();
    placement = shifted(&placement, normal * mirror.offset, &mut surface);
    placement = turned(&placement, normal, &mut surface);

    let mut warnings = Vec::new();
    let mut figure = figure::Figure::new(&surface, height);
    let stature = joins::stature_guess(&figure);
    if options.unit.is_none() && stature < SMALLEST {
        warnings.push(format!(
            "in {} the body is {stature:.0} mm tall, less than any that garments are made for: say its unit if it is another \
             one, such as inches ({:.0} mm)",
            unit.plural(),
            stature * Unit::Inch.millimetres() / unit.millimetres()
        ));
    }
    let mut votes = facing::votes(&figure, &joins::Proportions::of(&figure));
    if let Some(wanted) = options.facing {
        votes = placement.rotation.transpose().mul_vec3(wanted).z;
    } else if votes.abs() < 0.6 {
        warnings.push("front and back are hard to tell apart on this shape: check the facing".to_owned());
    }
    let half_turned;
    if votes < 0.0 {
        placement = Placement {
            rotation: placement.rotation * DMat3::from_diagonal(DVec3::new(-1.0, 1.0, -1.0)),
            ..placement
        };
        half_turned = TriMesh::new(
            surface.positions.iter().map(|p| DVec3::new(-p.x, p.y, -p.z)).collect(),
            surface.faces.clone(),
        );
        figure = figure.half_turned(&half_turned);
    }

    let refuse = |reason: String| HumanError::NotUpright { reason };
    let marks = marks::find(&figure, &mut warnings).map_err(refuse)?;
    let features = features_of(&figure, &marks, warnings).map_err(refuse)?;
    let girths = export::girths(&features);
    let mut mesh = TriMesh {
        positions: raw.positions.iter().map(|p| placement.from_file(*p)).collect(),
        faces: raw.faces.clone(),
        groups: raw.groups.clone(),
        corner_uvs: raw.corner_uvs.clone(),
    };
    if inside_out(&mesh) {
        turn_over(&mut mesh);
    }
    Ok(HumanBody { mesh, placement, unit, features, girths })
}

fn features_of(
    figure: &figure::Figure<'_>,
    marks: &marks::Marks,
    warnings: Vec<String>,
) -> Result<Features, String> {
    let field = normals::NormalField::new(figure.mesh);
    let mut features = Features {
        facing: DVec3::Z,
        up: DVec3::Y,
        height: joins::stature_guess(figure),
        warnings,
        ..Features::default()
    };
    let trunk = girths::add(figure, marks, &field, &mut features)?;
    verticals::add(figure, marks, &trunk, &field, &mut features)?;
    limbs::add(figure, marks, &field, &mut features);
    for (name, p) in [
        ("crotch", marks.crotch),
        ("left_armpit", marks.armpit[0]),
        ("right_armpit", marks.armpit[1]),
        ("left_shoulder", marks.shoulder[0]),
        ("right_shoulder", marks.shoulder[1]),
        ("left_neck_side", marks.neck_side[0]),
        ("right_neck_side", marks.neck_side[1]),
        ("nape", marks.nape),
        ("front_neck", marks.front_neck),
        ("left_bust", marks.bust[0]),
        ("right_bust", marks.bust[1]),
        ("navel", marks.navel),
    ] {
        features.points.insert(name.to_owned(), field.point(p, normals::hint(name, p)));
    }
    if let Some(p) = marks.crown {
        features.points.insert("crown".to_owned(), field.point(p, DVec3::Y));
    }
    Ok(features)
}

/// Stature below which a body is smaller than what garments are made for, in millimetres: that of the smallest dress form,
/// less what telling it from a form without a head may be off by.
const SMALLEST: f64 = 0.95 * 10.0 * crate::dress_form::HEIGHT_RANGE[0];

/// Residual of the mirror plane over the height above which the two sides do not belong to one person. Models and
/// scans of people lie below 0.001, coarse meshes below 0.004.
const WORST_SYMMETRY: f64 = 0.008;

/// Checks the input and welds repeated nodes; drops faces without area and crumbs.
fn sound_surface(raw: &TriMesh) -> Result<TriMesh, HumanError> {
    if raw.faces.is_empty() || raw.positions.is_empty() {
        return Err(HumanError::Empty);
    }
    if let Some(node) = raw.positions.iter().position(|p| !p.is_finite()) {
        return Err(HumanError::NotFinite { node: node as u32 });
    }
    let count = raw.positions.len();
    if let Some(face) = raw.faces.iter().position(|f| f.iter().any(|v| *v as usize >= count)) {
        return Err(HumanError::BadIndex { face: face as u32 });
    }
    let key = |p: DVec3| (p + DVec3::ZERO).to_array().map(|c| if c == 0.0 { 0 } else { c.to_bits() });
    let mut order: Vec<u32> = (0..count as u32).collect();
    order.sort_unstable_by_key(|v| (key(raw.positions[*v as usize]), *v));
    let mut target: Vec<u32> = (0..count as u32).collect();
    for w in 1..order.len() {
        let (a, b) = (order[w - 1] as usize, order[w] as usize);
        if key(raw.positions[a]) == key(raw.positions[b]) {
            target[b] = target[a];
        }
    }
    let faces: Vec<[u32; 3]> = raw
        .faces
        .iter()
        .map(|f| f.map(|v| target[v as usize]))
        .filter(|f| f[0] != f[1] && f[1] != f[2] && f[2] != f[0])
        .collect();
    let mut surface = TriMesh::new(raw.positions.clone(), faces);
    drop_crumbs(&mut surface);
    if surface.faces.len() < LEAST_FACES {
        return Err(HumanError::TooCoarse { faces: surface.faces.len(), needed: LEAST_FACES });
    }
    let [lo, hi] = surface.bounds().ok_or(HumanError::Empty)?;
    let (thin, long) = ((hi - lo).min_element(), (hi - lo).max_element());
    if thin < 0.03 * long {
        return Err(HumanError::Flat { thin, long });
    }
    Ok(surface)
}

/// Removes connected pieces below a thousandth of the surface (scan crumbs) and then unused nodes.
fn drop_crumbs(surface: &mut TriMesh) {
    let mut parent: Vec<u32> = (0..surface.positions.len() as u32).collect();
    fn root(parent: &mut [u32], mut v: u32) -> u32 {
        while parent[v as usize] != v {
            parent[v as usize] = parent[parent[v as usize] as usize];
            v = parent[v as usize];
        }
        v
    }
    for f in &surface.faces {
        let a = root(&mut parent, f[0]);
        for v in &f[1..] {
            let b = root(&mut parent, *v);
            parent[b as usize] = a;
        }
    }
    let mut area = vec![0.0; surface.positions.len()];
    let mut total = 0.0;
    let owner: Vec<u32> = surface.faces.iter().map(|f| root(&mut parent, f[0])).collect();
    for (f, o) in owner.iter().enumerate() {
        let a = surface.area_normal(f as u32).length();
        area[*o as usize] += a;
        total += a;
    }
    let mut index = 0;
    surface.faces.retain(|_| {
        index += 1;
        area[owner[index - 1] as usize] > 1e-3 * total
    });
    let mut new = vec![u32::MAX; surface.positions.len()];
    let mut kept = Vec::with_capacity(surface.positions.len());
    for f in &mut surface.faces {
        for v in f {
            if new[*v as usize] == u32::MAX {
                new[*v as usize] = kept.len() as u32;
                kept.push(surface.positions[*v as usize]);
            }
            *v = new[*v as usize];
        }
    }
    surface.positions = kept;
}

fn transform(surface: &mut TriMesh, placement: &Placement) {
    for p in &mut surface.positions {
        *p = placement.from_file(*p);
    }
}

/// Makes `origin` (canonical so far) the new origin.
fn shifted(placement: &Placement, origin: DVec3, surface: &mut TriMesh) -> Placement {
    for p in &mut surface.positions {
        *p -= origin;
    }
    Placement { translation: placement.to_file(origin), ..*placement }
}

/// Turns about the vertical so that `left` becomes +x.
fn turned(placement: &Placement, left: DVec3, surface: &mut TriMesh) -> Placement {
    let turn = DMat3::from_cols(left, DVec3::Y, left.cross(DVec3::Y));
    let back = turn.transpose();
    for p in &mut surface.positions {
        *p = back * *p;
    }
    Placement { rotation: placement.rotation * turn, ..*placement }
}

fn inside_out(mesh: &TriMesh) -> bool {
    let Some([lo, hi]) = mesh.bounds() else { return false };
    let middle = (lo + hi) / 2.0;
    let six: f64 = mesh
        .faces
        .iter()
        .map(|f| {
            let [a, b, c] = f.map(|v| mesh.positions[v as usize] - middle);
            a.dot(b.cross(c))
        })
        .sum();
    six < 0.0
}

fn turn_over(mesh: &mut TriMesh) {
    for f in &mut mesh.faces {
        f.swap(1, 2);
    }
    if let Some(uvs) = &mut mesh.corner_uvs {
        for c in uvs {
            c.swap(1, 2);
        }
    }
}
