//! Feature curves and points on a body.

use mesh_kernel::TriMesh;
use mesh_kernel::glam::DVec3;
use reference::Features;
use viewer::{
    Camera, Color, Hidden, Image, KeySign, Label, LegendKey, Lens, MontageOptions, RenderError,
    RenderOptions, Scene, SceneLine, SceneMesh, ScenePoint, View, montage, render,
};

const TAPE: Color = Color([40, 110, 190]);
const SKIN_CURVE: Color = Color([30, 130, 80]);

/// Draws the features over the body: front, left side and back in one picture.
///
/// `body` and `features` are in the canonical frame (millimetres, y up, facing +z).
///
/// # Errors
/// [`RenderError`] when coordinates are no numbers.
pub fn features_picture(title: &str, body: &TriMesh, features: &Features) -> Result<Image, RenderError> {
    let mut scene = Scene { meshes: vec![SceneMesh::body(body)], ..Scene::default() };
    for (name, curve) in &features.curves {
        let mut points: Vec<DVec3> =
            curve.points.iter().zip(&curve.normals).map(|(p, n)| *p + *n * 1.5).collect();
        if curve.closed {
            points.extend(points.first().copied());
        }
        let color = match (name.ends_with("_tape"), curve.closed) {
            (true, _) => TAPE,
            (false, true) => SKIN_CURVE,
            (false, false) => Color::ACCENT,
        };
        scene.lines.push(SceneLine::new(points, color, if name.ends_with("_tape") { 1.2 } else { 2.0 }));
    }
    for (name, point) in &features.points {
        let position = point.position + point.normal * 2.0;
        let color = Color::INK;
        scene.points.push(ScenePoint { position, color, diameter: 8.0, hidden: Hidden::Omitted });
        let text = name.replace('_', " ");
        scene.labels.push(Label {
            position: point.position + point.normal * 6.0,
            text,
            color,
            hidden: Hidden::Omitted,
        });
    }
    let key = |text: &str, color| LegendKey { text: text.to_owned(), color, sign: KeySign::Line };
    scene.legend = super::legend(
        None,
        vec![
            key("girth, on the skin", SKIN_CURVE),
            key("girth, as taped", TAPE),
            key("seam line", Color::ACCENT),
        ],
    );
    three_views(title, scene)
}

/// Front, left side and back, side by side; the legend in the first.
fn three_views(title: &str, mut scene: Scene) -> Result<Image, RenderError> {
    let options = RenderOptions { scale: 0.8, ..RenderOptions::sized(760, 1300) };
    let legend = scene.legend.take();
    let views = [("front", View::Front), ("left", View::Left), ("back", View::Back)];
    let mut cameras = Vec::new();
    for (_, view) in views {
        cameras.push(Camera::new(view, Lens::Orthographic).fit(&scene, &options)?);
    }
    // One scale for all, so that heights can be compared across.
    let height = cameras.iter().map(|c| c.height).fold(0.0, f64::max);
    let mut parts = Vec::new();
    for ((name, view), camera) in views.into_iter().zip(cameras) {
        // Beside the slender side view there is room for the legend.
        scene.legend = legend.clone().filter(|_| view == View::Left);
        parts.push((name, render(&scene, &Camera { height, ..camera }, &options)?));
    }
    let named: Vec<(String, &Image)> =
        parts.iter().map(|(name, image)| (format!("{title}: {name}"), image)).collect();
    let cells: Vec<(&str, &Image)> = named.iter().map(|(name, image)| (name.as_str(), *image)).collect();
    montage(&cells, &MontageOptions::default())
}

/// Draws a body alone: front, left side and back in one picture.
///
/// # Errors
/// [`RenderError`] when coordinates are no numbers.
pub fn body_picture(title: &str, body: &TriMesh) -> Result<Image, RenderError> {
    three_views(title, Scene { meshes: vec![SceneMesh::body(body)], ..Scene::default() })
}
