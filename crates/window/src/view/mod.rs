//! The 3D view: the eye, the scene, and its two painters.

mod eye;
mod gl;
pub(crate) mod pick;
pub(crate) mod scene;
mod shaders;
mod solids;

use eframe::egui::{self, Color32, ColorImage, Pos2, Rect, TextureHandle, TextureOptions, pos2, vec2};
use eframe::glow;
use glam::{DVec2, DVec3};
use sketch::Camera;
use viewer::{Color, Lens, RenderOptions, Scene, SceneMesh};

pub(crate) use eye::Eye;
pub(crate) use gl::GlPainter;
pub(crate) use solids::{Seen, Solids};

/// A surface that is seen. The garment first: what it hides need not be drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Part {
    Garment,
    Body,
}

impl Part {
    const COUNT: usize = 2;
    const ALL: [Self; Self::COUNT] = [Self::Garment, Self::Body];
}

/// What is seen, and from where.
pub(crate) struct View {
    pub(crate) eye: Eye,
    pub(crate) solids: Solids,
    /// Where the view was last on the screen.
    pub(crate) rect: Rect,
    scene: Scene,
    /// What the scene's surfaces are, and whether they are closed.
    parts: Vec<(Part, bool)>,
    /// The garment is seen through.
    x_ray: bool,
    bounds: Option<[DVec3; 2]>,
    revision: u64,
    picture: Option<Picture>,
    gl: Option<GlPainter>,
}

/// A picture by the processor, and of what it is.
struct Picture {
    of: (Camera, u64, Color32, f32),
    texture: Option<TextureHandle>,
}

/// How much of a surface that the eye goes through is seen.
const SEEN_THROUGH: f32 = 0.5;

/// Lets what is behind through.
fn mix(pixels: &mut [u8], behind: &[u8]) {
    for (own, other) in pixels.iter_mut().zip(behind) {
        let mixed = f32::from(*own) * SEEN_THROUGH + f32::from(*other) * (1.0 - SEEN_THROUGH);
        *own = mixed.round() as u8;
    }
}

impl View {
    /// A view that draws by OpenGL where there is a painter, else by the processor.
    pub(crate) fn new(gl: Option<GlPainter>) -> Self {
        Self {
            eye: Eye::new(),
            solids: Solids::default(),
            rect: Rect::NOTHING,
            scene: Scene::default(),
            parts: Vec::new(),
            x_ray: false,
            bounds: None,
            revision: 0,
            picture: None,
            gl,
        }
    }

    /// Shows another surface, or none, in place of a part. Of a closed one whose faces look outward the reverse is not drawn.
    pub(crate) fn set_mesh(&mut self, part: Part, mesh: Option<SceneMesh>, is_closed: bool) {
        let at = self.parts.iter().position(|(p, _)| *p == part);
        match (at, mesh) {
            (Some(k), Some(mesh)) => {
                self.scene.meshes[k] = mesh;
                self.parts[k].1 = is_closed;
            }
            (Some(k), None) => {
                self.scene.meshes.remove(k);
                self.parts.remove(k);
            }
            (None, Some(mesh)) => {
                self.scene.meshes.push(mesh);
                self.parts.push((part, is_closed));
            }
            (None, None) => return,
        }
        self.bounds = self.scene.bounds();
        self.revision += 1;
        self.send(part);
    }

    /// Shows the garment so that the body is seen through it, or not.
    pub(crate) fn set_x_ray(&mut self, x_ray: bool) {
        if std::mem::replace(&mut self.x_ray, x_ray) != x_ray {
            self.revision += 1;
        }
    }

    /// Gives a part to the painter.
    fn send(&self, part: Part) {
        let Some(gl) = &self.gl else { return };
        let shown = self.parts.iter().zip(&self.scene.meshes).find(|((p, _), _)| *p == part);
        gl.set_mesh(part, shown.map(|(_, mesh)| mesh), shown.is_some_and(|((_, is_closed), _)| *is_closed));
    }

    /// Shows other lines and points about the same surfaces.
    pub(crate) fn set_lines(&mut self, lines: Vec<viewer::SceneLine>, points: Vec<viewer::ScenePoint>) {
        (self.scene.lines, self.scene.points) = (lines, points);
        self.revision += 1;
        if let Some(gl) = &self.gl {
            gl.set_lines(&self.scene);
        }
    }

    /// Whether a graphics processor (or what stands in for one) draws.
    pub(crate) fn is_by_gl(&self) -> bool {
        self.gl.is_some()
    }

    /// Draws by OpenGL from now on, or by the processor.
    pub(crate) fn set_painter(&mut self, gl: Option<GlPainter>) {
        self.gl = gl;
        Part::ALL.into_iter().for_each(|part| self.send(part));
        if let Some(gl) = &self.gl {
            gl.set_lines(&self.scene);
        }
    }

    /// Gives the context back what was taken from it.
    pub(crate) fn destroy(&mut self, gl: &glow::Context) {
        if let Some(painter) = self.gl.take() {
            painter.destroy(gl);
        }
    }

    /// Draws the scene into `rect`. Says why OpenGL could not, once; the processor draws from then on.
    pub(crate) fn paint(&mut self, ui: &egui::Ui, rect: Rect) -> Option<String> {
        self.rect = rect;
        self.eye.camera.size =
            DVec2::new(f64::from(rect.width().max(1.0)), f64::from(rect.height().max(1.0)));
        if let Some(gl) = &self.gl {
            let problem = gl.problem();
            if problem.is_none() {
                // The ground is the window's own: it is cleared to the panels' colour.
                ui.painter().add(gl.shape(rect, &self.eye.camera, self.bounds, self.x_ray));
                return None;
            }
            self.gl = None;
            self.paint_by_processor(ui, rect);
            return problem;
        }
        self.paint_by_processor(ui, rect);
        None
    }

    /// The picture is made anew only when the camera, its size or the scene changed.
    fn paint_by_processor(&mut self, ui: &egui::Ui, rect: Rect) {
        let scale = ui.ctx().pixels_per_point();
        let background = ui.ctx().global_style().visuals.panel_fill;
        let of = (self.eye.camera, self.revision, background, scale);
        if self.picture.as_ref().is_none_or(|p| p.of != of) {
            let c = &self.eye.camera;
            let lens = match c.projection {
                sketch::Projection::Orthographic => Lens::Orthographic,
                sketch::Projection::Perspective { fov } => Lens::Perspective { fov },
            };
            let (target, back, up, height) = (c.target, c.back, c.up, c.height);
            let camera = viewer::Camera { target, back, up, lens, height, shift: DVec2::ZERO };
            let (w, h) = ((c.size.x * f64::from(scale)) as u32, (c.size.y * f64::from(scale)) as u32);
            let background = Color([background.r(), background.g(), background.b()]);
            let options =
                RenderOptions { samples: 2, background, ..RenderOptions::sized(w.max(1), h.max(1)).plain() };
            // Lines are as wide as the scene says, whatever the picture's size.
            let unit = ((f64::from(w) * f64::from(h)).sqrt() / 1024.0).max(0.45);
            let options = RenderOptions { scale: (f64::from(scale) / unit).clamp(0.05, 50.0), ..options };
            // An empty scene has no picture; the background stays.
            let texture = viewer::render(&self.scene, &camera, &options).ok().map(|image| {
                let size = [image.width() as usize, image.height() as usize];
                let mut pixels = image.rgb().to_vec();
                if let Some(behind) = self.behind(&camera, &options) {
                    mix(&mut pixels, &behind);
                }
                let image = ColorImage::from_rgb(size, &pixels);
                ui.ctx().load_texture("3D view", image, TextureOptions::LINEAR)
            });
            self.picture = Some(Picture { of, texture });
        }
        if let Some(texture) = self.picture.as_ref().and_then(|p| p.texture.as_ref()) {
            let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            ui.painter().image(texture.id(), rect, whole, Color32::WHITE);
        }
    }

    /// The picture without the garment, where that is seen through.
    fn behind(&self, camera: &viewer::Camera, options: &RenderOptions) -> Option<Vec<u8>> {
        let garment = self.parts.iter().position(|(p, _)| *p == Part::Garment).filter(|_| self.x_ray)?;
        let mut scene = self.scene.clone();
        scene.meshes.remove(garment);
        let pixels = 3 * options.width as usize * options.height as usize;
        let plain = || options.background.0.iter().copied().cycle().take(pixels).collect();
        Some(viewer::render(&scene, camera, options).map_or_else(|_| plain(), |image| image.rgb().to_vec()))
    }

    /// Where a place is on the screen.
    pub(crate) fn screen(&self, p: DVec3) -> Option<Pos2> {
        self.eye.camera.project(p).map(|at| self.on_screen(at))
    }

    /// A pixel of the view on the screen.
    pub(crate) fn on_screen(&self, at: DVec2) -> Pos2 {
        self.rect.min + vec2(at.x as f32, at.y as f32)
    }

    /// A place of the screen in the view's pixels.
    pub(crate) fn local(&self, at: Pos2) -> DVec2 {
        let off = at - self.rect.min;
        DVec2::new(f64::from(off.x), f64::from(off.y))
    }

    /// The place under a pixel, for the eye to turn about: what is seen there, else what lies before the target.
    pub(crate) fn pivot(&self, at: DVec2) -> DVec3 {
        match self.solids.first(&self.eye.ray(at)) {
            Some(Seen { place, .. }) => place,
            None => self.eye.camera.target,
        }
    }
}
