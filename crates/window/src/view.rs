//! The 3D view: camera, picture, and what is near the pointer.

use std::collections::BTreeMap;

use eframe::egui::{self, Color32, ColorImage, Pos2, Rect, TextureHandle, TextureOptions, pos2, vec2};
use glam::{DQuat, DVec2, DVec3};
use mesh_kernel::TriMesh;
use sketch::{Camera, Projection, Ray, Sight};
use viewer::{Lens, RenderOptions, Scene};

/// Angle of sight, radians.
const FOV: f64 = 0.384;

/// What is seen, and from where.
pub(crate) struct View {
    pub(crate) camera: Camera,
    pub(crate) places: BTreeMap<String, DVec3>,
    scene: Scene,
    drawn: Option<(Camera, u64)>,
    revision: u64,
    texture: Option<TextureHandle>,
}

impl View {
    pub(crate) fn new() -> Self {
        let projection = Projection::Perspective { fov: FOV };
        let target = DVec3::new(0.0, 1050.0, 0.0);
        let camera =
            Camera { target, back: DVec3::Z, up: DVec3::Y, height: 1500.0, projection, size: DVec2::ONE };
        Self {
            camera,
            places: BTreeMap::new(),
            scene: Scene::default(),
            drawn: None,
            revision: 0,
            texture: None,
        }
    }

    pub(crate) fn show_scene(&mut self, scene: Scene) {
        self.scene = scene;
        self.revision += 1;
    }

    /// Turns about the target: up stays the world's.
    pub(crate) fn orbit(&mut self, pixels: egui::Vec2) {
        let c = &mut self.camera;
        let turn = DQuat::from_rotation_y(-0.008 * f64::from(pixels.x));
        let tilt = DQuat::from_axis_angle(turn * c.right(), -0.008 * f64::from(pixels.y));
        let (back, up) = (tilt * turn * c.back, tilt * turn * c.up);
        // Not over the head: left and right would change places.
        if up.y > 0.05 {
            c.back = back.normalize();
            c.up = (up - c.back * up.dot(c.back)).normalize();
        }
    }

    pub(crate) fn pan(&mut self, pixels: egui::Vec2) {
        let c = &mut self.camera;
        let step = c.height / c.size.y;
        c.target += step * (f64::from(pixels.y) * c.up - f64::from(pixels.x) * c.right());
    }

    /// Zooms so that what is under the pointer stays there.
    pub(crate) fn zoom(&mut self, factor: f64, at: DVec2) {
        let c = &mut self.camera;
        let height = (c.height / factor).clamp(20.0, 20_000.0);
        let off = (at - 0.5 * c.size) * ((c.height - height) / c.size.y);
        c.target += c.right() * off.x - c.up * off.y;
        c.height = height;
    }

    pub(crate) fn look(&mut self, view: viewer::View) {
        (self.camera.back, self.camera.up) = view.axes();
    }

    /// Draws the scene into `rect`; the picture is made anew only when camera, size or scene changed.
    pub(crate) fn paint(&mut self, ui: &egui::Ui, rect: Rect) {
        self.camera.size = DVec2::new(f64::from(rect.width().max(1.0)), f64::from(rect.height().max(1.0)));
        let key = (self.camera, self.revision);
        if self.drawn != Some(key) {
            let c = &self.camera;
            let lens = Lens::Perspective { fov: FOV };
            let (target, back, up, height) = (c.target, c.back, c.up, c.height);
            let camera = viewer::Camera { target, back, up, lens, height, shift: DVec2::ZERO };
            let scale = f64::from(ui.ctx().pixels_per_point());
            let (w, h) = ((c.size.x * scale) as u32, (c.size.y * scale) as u32);
            let options = RenderOptions { samples: 2, ..RenderOptions::sized(w.max(1), h.max(1)).plain() };
            self.drawn = Some(key);
            // An empty scene has no picture; the background stays.
            self.texture = viewer::render(&self.scene, &camera, &options).ok().map(|image| {
                let size = [image.width() as usize, image.height() as usize];
                ui.ctx().load_texture(
                    "3D view",
                    ColorImage::from_rgb(size, image.rgb()),
                    TextureOptions::LINEAR,
                )
            });
        }
        if let Some(texture) = &self.texture {
            let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            ui.painter().image(texture.id(), rect, whole, Color32::WHITE);
        }
    }

    /// Where a place is on the screen.
    pub(crate) fn screen(&self, rect: Rect, p: DVec3) -> Option<Pos2> {
        self.camera.project(p).map(|at| rect.min + vec2(at.x as f32, at.y as f32))
    }

    /// What hides things: the meshes of the scene.
    pub(crate) fn sight(&self) -> MeshSight {
        let mesh = |m: &viewer::SceneMesh| TriMesh::new(m.positions.clone(), m.faces.clone());
        MeshSight { meshes: self.scene.meshes.iter().map(mesh).collect() }
    }
}

/// Meshes that hide what is behind them. O(faces) a ray: it is asked a few times a stroke.
pub(crate) struct MeshSight {
    meshes: Vec<TriMesh>,
}

impl Sight for MeshSight {
    fn hides(&self, ray: &Ray, p: DVec3, slack: f64) -> bool {
        let reach = (p - ray.origin).dot(ray.direction) - slack;
        self.meshes
            .iter()
            .any(|m| (0..m.faces.len() as u32).any(|f| hit(ray, m.corners(f)).is_some_and(|t| t < reach)))
    }
}

/// Distance along a ray to a triangle (Möller & Trumbore 1997).
fn hit(ray: &Ray, [a, b, c]: [DVec3; 3]) -> Option<f64> {
    let (ab, ac) = (b - a, c - a);
    let p = ray.direction.cross(ac);
    let determinant = ab.dot(p);
    if determinant == 0.0 {
        return None;
    }
    let s = ray.origin - a;
    let u = s.dot(p) / determinant;
    let q = s.cross(ab);
    let v = ray.direction.dot(q) / determinant;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0).then(|| ac.dot(q) / determinant).filter(|t| *t > 0.0)
}
