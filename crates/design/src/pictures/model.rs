//! A picture of any model, for `toile render`.

use mesh_kernel::TriMesh;
use mesh_kernel::query::SignedDistance;
use rayon::prelude::*;
use viewer::{
    Camera, Color, ColorBar, ColorMap, Image, Lens, Paint, RenderError, RenderOptions, Scale, Scene,
    SceneMesh, View, render,
};

use super::{legend, stretch_bar, stretch_percent, stretch_scale};

/// What colours show.
#[derive(Clone, Debug, PartialEq)]
pub enum ModelColor {
    /// Groups in colours of their own.
    Groups,
    /// Flat pattern (texture coordinates) against the surface.
    Stretch,
    /// Distance to the body beside it.
    Distance,
    /// Thickness, a number a face, in millimetres.
    Thickness(Vec<f64>),
}

/// What is drawn and how.
#[derive(Clone, Debug)]
pub struct ModelPicture<'a> {
    /// The model.
    pub model: &'a TriMesh,
    /// A body beside it, in the same frame and unit.
    pub body: Option<&'a TriMesh>,
    /// Millimetres in one unit of the coordinates.
    pub unit: f64,
    /// What colours show.
    pub color: ModelColor,
    /// From where.
    pub view: View,
    /// Pixels.
    pub width: u32,
    /// Pixels.
    pub height: u32,
}

/// Why no picture was made.
#[derive(Debug, thiserror::Error)]
pub enum ModelPictureError {
    /// Colours need what the model does not have.
    #[error("the model has no flat pattern (texture coordinates), so there is no stretch to show")]
    NoFlatPattern,
    /// Distance to what?
    #[error("there is no body to measure the distance to; name one with --with")]
    NoBody,
    /// One number a face is wanted.
    #[error("there are {numbers} thicknesses for {faces} triangles")]
    ThicknessCount {
        /// Numbers given.
        numbers: usize,
        /// Triangles of the model.
        faces: usize,
    },
    /// The picture itself.
    #[error(transparent)]
    Render(#[from] RenderError),
}

/// Draws a model.
///
/// # Errors
/// [`ModelPictureError`].
pub fn model_picture(what: &ModelPicture<'_>) -> Result<Image, ModelPictureError> {
    let model = in_millimetres(what.model, what.unit);
    let body = what.body.map(|b| in_millimetres(b, what.unit));
    let mut bar = None;
    let mesh = match &what.color {
        ModelColor::Groups => SceneMesh::garment(&model),
        ModelColor::Stretch => {
            let values = stretch_of(&model).ok_or(ModelPictureError::NoFlatPattern)?;
            bar = Some(stretch_bar());
            SceneMesh::of_mesh(&model, Color::WHITE)
                .painted(Paint::FaceValues { values, scale: stretch_scale() })
        }
        ModelColor::Distance => {
            let body = body.as_ref().ok_or(ModelPictureError::NoBody)?;
            let field = SignedDistance::new(body);
            let values: Vec<f64> = model.positions.par_iter().map(|p| field.signed(*p).distance).collect();
            let scale = Scale::of(ColorMap::Sequential, &values);
            bar = Some(ColorBar { title: "distance".to_owned(), unit: "mm".to_owned(), scale });
            SceneMesh::of_mesh(&model, Color::WHITE).painted(Paint::NodeValues { values, scale })
        }
        ModelColor::Thickness(values) => {
            let (numbers, faces) = (values.len(), model.faces.len());
            if numbers != faces {
                return Err(ModelPictureError::ThicknessCount { numbers, faces });
            }
            let scale = Scale::of(ColorMap::Sequential, values);
            bar = Some(ColorBar { title: "thickness".to_owned(), unit: "mm".to_owned(), scale });
            let paint = Paint::FaceValues { values: values.clone(), scale };
            SceneMesh::of_mesh(&model, Color::WHITE).painted(paint)
        }
    };
    let mut scene = Scene { meshes: vec![mesh], ..Scene::default() };
    scene.meshes.extend(body.as_ref().map(SceneMesh::body));
    scene.legend = bar.and_then(|bar| legend(Some(bar), Vec::new()));
    let options = RenderOptions::sized(what.width, what.height);
    let camera = Camera::new(what.view, Lens::PORTRAIT).fit(&scene, &options)?;
    Ok(render(&scene, &camera, &options)?)
}

fn in_millimetres(mesh: &TriMesh, unit: f64) -> TriMesh {
    let mut mesh = mesh.clone();
    for p in &mut mesh.positions {
        *p *= unit;
    }
    mesh
}

/// Stretch of every face in percent, from the flat pattern; the pattern's unit is found so that the areas agree.
fn stretch_of(model: &TriMesh) -> Option<Vec<f64>> {
    let uvs = model.corner_uvs.as_ref()?;
    let area_3d: f64 = (0..model.faces.len() as u32).map(|f| model.area_normal(f).length()).sum();
    let area_2d: f64 = uvs.iter().map(|[a, b, c]| (*b - *a).perp_dot(*c - *a).abs()).sum();
    if !(area_2d > 0.0 && area_3d.is_finite()) {
        return None;
    }
    let scale = (area_3d / area_2d).sqrt();
    let singular = |(f, [a, b, c]): (usize, &[mesh_kernel::glam::DVec2; 3])| {
        let [p, q, r] = model.corners(f as u32);
        let (e1, e2) = (q - p, r - p);
        let along = e1.normalize_or_zero();
        let height = (e2 - along * along.dot(e2)).length();
        let (d1, d2) = ((*b - *a) * scale, (*c - *a) * scale);
        // Columns of the map from the face's plane (along, across) to the flat one.
        let u = d1 / e1.length();
        let v = (d2 - u * along.dot(e2)) / height;
        let (sum, det) = (u.length_squared() + v.length_squared(), u.perp_dot(v).abs());
        let (plus, minus) = ((sum + 2.0 * det).sqrt(), (sum - 2.0 * det).max(0.0).sqrt());
        stretch_percent([0.5 * (plus + minus), 0.5 * (plus - minus)])
    };
    Some(uvs.iter().enumerate().map(singular).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use mesh_kernel::glam::{DVec2, DVec3};

    #[test]
    fn stretch_of_a_sheared_pair_is_that_of_the_map() {
        // A square whose flat pattern is 4 % wider and 4 % lower: the areas agree, so the unit is found as 1.
        let positions = vec![DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
        let mut mesh = TriMesh::new(positions.clone(), vec![[0, 1, 2], [0, 2, 3]]);
        assert!(stretch_of(&mesh).is_none());
        let flat = |v: u32| {
            let p = positions[v as usize];
            DVec2::new(p.x * 1.04, p.y / 1.04)
        };
        mesh.corner_uvs = Some(mesh.faces.iter().map(|f| f.map(flat)).collect());
        for value in stretch_of(&mesh).unwrap() {
            assert!((value - 4.0).abs() < 1e-9, "{value}");
        }
    }
}
