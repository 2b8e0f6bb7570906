//! The garment on the body, from the front and from the back.

use mesh_kernel::TriMesh;
use mesh_kernel::glam::DVec3;
use viewer::{
    Camera, Color, Hidden, Image, KeySign, LegendKey, Lens, Occlusion, RenderError, RenderOptions, Scene,
    SceneLine, SceneMesh, ScenePoint, View, render,
};

use super::legend;

/// Width and height of the pictures, in pixels.
const SIZE: (u32, u32) = (768, 1024);
/// Lines are lifted off the cloth by this much, in millimetres, so that they do not drown in it.
const LIFT: f64 = 0.8;

/// Air about the garment, as a part of its largest side.
const AIR: f64 = 0.09;

/// Front and back.
#[derive(Clone, Debug)]
pub struct GarmentPictures {
    /// Seen from the front.
    pub front: Image,
    /// Seen from the back.
    pub back: Image,
}

/// Draws the garment on the body with its seams and profile lines; each surface in a colour of its own.
///
/// `seams` and `lines` are polylines in millimetres, in the frame of the meshes (y up, facing +z).
///
/// # Errors
/// [`RenderError`] when coordinates are no numbers.
pub fn garment_pictures(
    title: &str,
    body: &TriMesh,
    garment: &TriMesh,
    seams: &[Vec<DVec3>],
    lines: &[Vec<DVec3>],
) -> Result<GarmentPictures, RenderError> {
    let seam_color = Color::SEAM;
    let line_color = Color::ACCENT;
    let drawn = |points: &Vec<DVec3>, color, width| SceneLine::new(lifted(points), color, width);
    let mut scene = Scene {
        meshes: vec![SceneMesh::body(body), SceneMesh::garment(garment)],
        lines: seams.iter().map(|l| drawn(l, seam_color, 2.2)).collect(),
        title: Some(title.to_owned()),
        ..Scene::default()
    };
    scene.lines.extend(lines.iter().map(|l| drawn(l, line_color, 1.6)));
    let key = |text: &str, color| LegendKey { text: text.to_owned(), color, sign: KeySign::Line };
    scene.legend = legend(None, vec![key("seam", seam_color), key("profile", line_color)]);
    // Two pictures come with every garment: light shadows, as soft as the eye needs.
    let occlusion = Some(Occlusion { rays: 5, shadow_rays: 2, spacing: 3, ..Occlusion::default() });
    let options = RenderOptions { occlusion, samples: 6, ..RenderOptions::sized(SIZE.0, SIZE.1) };
    let framed = Scene { points: frame(garment), legend: scene.legend.clone(), ..Scene::default() };
    let look = |view| -> Result<Image, RenderError> {
        let camera = Camera::new(view, Lens::PORTRAIT).fit(&framed, &options)?;
        render(&scene, &camera, &options)
    };
    let (front, back) = rayon::join(|| look(View::Front), || look(View::Back));
    Ok(GarmentPictures { front: front?, back: back? })
}

/// What the picture must hold: the garment and some air about it; of the body only what is near.
fn frame(garment: &TriMesh) -> Vec<ScenePoint> {
    let Some([low, high]) = garment.bounds() else { return Vec::new() };
    let air = DVec3::splat(AIR * (high - low).max_element());
    let ends = [low - air, high + air];
    let corner = |i: usize| DVec3::new(ends[i & 1].x, ends[i >> 1 & 1].y, ends[i >> 2].z);
    let point =
        |i| ScenePoint { position: corner(i), color: Color::INK, diameter: 1.0, hidden: Hidden::Omitted };
    (0..8).map(point).collect()
}

/// The line, a little outward from the body's axis.
fn lifted(points: &[DVec3]) -> Vec<DVec3> {
    points.iter().map(|p| *p + DVec3::new(p.x, 0.0, p.z).normalize_or_zero() * LIFT).collect()
}
