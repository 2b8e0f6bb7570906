//! The body of a draft: a dress form from measurements, or a mesh.

use mesh_kernel::TriMesh;
use mesh_kernel::glam::DVec3;
use mesh_kernel::query::RayCaster;
use reference::dress_form::{DressForm, FormOptions, Measurements, Pliable};
use reference::human::{self, HumanBody, HumanOptions, TiedFeatures};
use serde::{Deserialize, Serialize};
use template::Prepared;

use super::{BuildError, EditError};

/// Where a body comes from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum BodySource {
    /// A dress form from tape measurements.
    Form(Measurements),
    /// A mesh, in its file's own units and axes.
    Mesh(Mesh),
}

/// A mesh as it stands in a draft.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mesh {
    /// Name of the file that it came from.
    pub file: String,
    /// Node positions.
    pub positions: Vec<[f64; 3]>,
    /// Node indices of the triangles.
    pub faces: Vec<[u32; 3]>,
}

impl Default for BodySource {
    fn default() -> Self {
        Self::Form(Measurements::default())
    }
}

/// A body ready to be worked on, in the canonical frame.
#[derive(Clone, Debug)]
pub struct OnBody {
    /// Its name.
    pub name: String,
    /// Mesh and features.
    pub body: HumanBody,
    /// Search structures on the mesh.
    pub prepared: Prepared,
}

/// Measurements that a form has, by the names of `toile form`.
pub const MEASURES: [&str; 14] = [
    "height",
    "bust",
    "underbust",
    "waist",
    "high_hip",
    "hip",
    "neck",
    "shoulder_width",
    "back_length",
    "upper_arm",
    "thigh",
    "knee",
    "calf",
    "ankle",
];

fn field<'a>(m: &'a mut Measurements, name: &str) -> Option<&'a mut Option<f64>> {
    Some(match name {
        "height" => &mut m.height,
        "bust" => &mut m.bust,
        "underbust" => &mut m.underbust,
        "waist" => &mut m.waist,
        "high_hip" => &mut m.high_hip,
        "hip" => &mut m.hip,
        "neck" => &mut m.neck,
        "shoulder_width" => &mut m.shoulder_width,
        "back_length" => &mut m.back_length,
        "upper_arm" => &mut m.upper_arm,
        "thigh" => &mut m.thigh,
        "knee" => &mut m.knee,
        "calf" => &mut m.calf,
        "ankle" => &mut m.ankle,
        _ => return None,
    })
}

/// A measurement of a form, given or derived, cm; `None` for an unknown name or measurements of nobody.
pub fn measure(measurements: &Measurements, name: &str) -> Option<f64> {
    measurements.resolve().ok()?.get(name)
}

/// Gives a measurement (cm) or leaves it to be derived.
///
/// # Errors
/// [`EditError`]: an unknown name, or measurements that nobody has.
pub fn set_measure(m: &mut Measurements, name: &str, value: Option<f64>) -> Result<(), EditError> {
    let missing = || EditError::Missing { kind: "measurement", name: name.to_owned() };
    *field(m, name).ok_or_else(missing)? = value;
    let refused = |e: reference::dress_form::FormError| EditError::Value {
        what: name.replace('_', " "),
        why: e.to_string(),
    };
    m.resolve().map(|_| ()).map_err(refused)
}

impl BodySource {
    /// Checks that it can be a body's data; whether features are found only building tells.
    pub(crate) fn check(&self) -> Result<(), EditError> {
        let bad = |why: String| Err(EditError::Value { what: "body".to_owned(), why });
        match self {
            Self::Form(m) => match m.resolve() {
                Ok(_) => Ok(()),
                Err(e) => bad(e.to_string()),
            },
            Self::Mesh(mesh) => {
                if mesh.faces.is_empty() {
                    return bad("its mesh has no faces".to_owned());
                }
                if mesh.positions.iter().flatten().any(|v| !v.is_finite()) {
                    return bad("its mesh has coordinates that are no finite numbers".to_owned());
                }
                let nodes = mesh.positions.len() as u32;
                match mesh.faces.iter().flatten().find(|v| **v >= nodes) {
                    Some(v) => bad(format!("a face refers to node {v}, but there are only {nodes}")),
                    None => Ok(()),
                }
            }
        }
    }

    /// A short name for people.
    pub fn name(&self) -> String {
        match self {
            Self::Form(_) => "dress form".to_owned(),
            Self::Mesh(mesh) => mesh.file.clone(),
        }
    }

    /// The body with its features and search structures; `triangles` is about the size of a form. 0.2 s for the usual 22 000
    /// triangles.
    ///
    /// # Errors
    /// As [`Self::human`].
    pub fn load(&self, triangles: Option<usize>) -> Result<OnBody, BuildError> {
        let body = self.human(triangles)?;
        let prepared = Prepared::new(&body.mesh);
        Ok(OnBody { name: self.name(), body, prepared })
    }

    /// The body with its features.
    ///
    /// # Errors
    /// [`BuildError`]: measurements of nobody, a mesh that is no upright body.
    pub fn human(&self, triangles: Option<usize>) -> Result<HumanBody, BuildError> {
        let mesh = match self {
            Self::Form(m) => {
                let mut options = FormOptions::default();
                options.triangles = triangles.unwrap_or(options.triangles);
                DressForm::build(m, &options)?.mesh
            }
            Self::Mesh(mesh) => TriMesh::new(
                mesh.positions.iter().map(|p| DVec3::from_array(*p)).collect(),
                mesh.faces.clone(),
            ),
        };
        Ok(human::extract(&mesh, &HumanOptions::default())?)
    }
}

/// A dress form whose measurements are being dragged: its nodes move and its features with them, nothing is looked for anew.
pub struct DraggedForm {
    form: Pliable,
    features: TiedFeatures,
    prepared: Prepared,
    caster: RayCaster,
    /// Stature of the person it was made for, cm.
    stature: f64,
}

impl DraggedForm {
    /// A form of about so many triangles for these measurements, with the features of `body`, which is a form of the same
    /// measurements. 0.1 s for 6000 triangles.
    ///
    /// # Errors
    /// [`BuildError::Form`].
    pub fn new(
        measurements: &Measurements,
        body: &HumanBody,
        triangles: usize,
    ) -> Result<Option<Self>, BuildError> {
        let form = Pliable::build(measurements, &FormOptions { triangles, ..FormOptions::default() })?;
        let stature = measurements.resolve()?.height;
        let Some(features) = TiedFeatures::new(body, &form.mesh()) else { return Ok(None) };
        let mesh = features.moved(form.mesh(), 1.0).mesh;
        let (prepared, caster) = rayon::join(|| Prepared::new(&mesh), || RayCaster::new(&mesh));
        Ok(Some(Self { form, features, prepared, caster, stature }))
    }

    /// The form at other measurements, near to what is built of them, and its mesh for rays.
    ///
    /// # Errors
    /// [`BuildError::Form`]: measurements of nobody, or too far off for this form to follow.
    pub fn at(&self, measurements: &Measurements) -> Result<(OnBody, RayCaster), BuildError> {
        let mesh = self.form.at(measurements)?;
        let body = self.features.moved(mesh, measurements.resolve()?.height / self.stature);
        let (prepared, caster) =
            rayon::join(|| self.prepared.moved(&body.mesh), || self.caster.moved(&body.mesh));
        let prepared = prepared.unwrap_or_else(|| Prepared::new(&body.mesh));
        Ok((OnBody { name: BodySource::Form(measurements.clone()).name(), body, prepared }, caster))
    }
}
