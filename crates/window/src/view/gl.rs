//! The scene by OpenGL: a paint callback inside the interface's own picture.
//!
//! The window's buffer has a depth buffer, which the interface does not use: it is cleared here, and all state that the
//! interface relies on is put back.

use std::sync::{Arc, Mutex, PoisonError};

use eframe::egui;
use eframe::egui_glow::{self, ShaderVersion};
use eframe::glow::{self, HasContext};
use glam::DMat4;
use sketch::Camera;
use viewer::{Hidden, MeshBuffer, Scene, SceneMesh};

use super::shaders::{LINE_FRAGMENT, LINE_VERTEX, MESH_FRAGMENT, MESH_VERTEX};
use super::{Part, SEEN_THROUGH};

/// Bytes of a vertex of a line: both ends (six `f32`), which end and side (two `f32`), half the width (`f32`), colour.
const LINE_STRIDE: i32 = 40;

/// What has changed since the last picture.
#[derive(Default)]
struct Upload {
    /// By part.
    meshes: [Option<Surface>; Part::COUNT],
    lines: Option<Vec<u8>>,
}

/// A surface on its way to the processor that draws.
struct Surface {
    buffer: MeshBuffer,
    /// Nobody outside sees its reverse.
    is_closed: bool,
}

/// A picture's camera in the terms of the shaders.
#[derive(Clone, Copy, Default)]
struct Uniforms {
    clip: [f32; 16],
    eye: [f32; 3],
    /// Towards the eye for parallel sight; zero with perspective.
    sight: [f32; 3],
    key: [f32; 3],
    fill: [f32; 3],
    up: [f32; 3],
    /// The garment is seen through.
    x_ray: bool,
    /// The eye is before everything, so that it sees no closed surface from within.
    is_outside: bool,
}

struct Programs {
    /// For surfaces whose both sides are seen.
    open: glow::Program,
    /// For those of which only the front is.
    closed: glow::Program,
    line: glow::Program,
    /// By part.
    meshes: [Resident; Part::COUNT],
    line_array: glow::VertexArray,
    line_buffer: glow::Buffer,
    /// Vertices of lines that are drawn faint where hidden, then of those that show through, then of those that do not.
    line_runs: [i32; 3],
}

/// A surface where it is drawn.
struct Resident {
    array: glow::VertexArray,
    corners: glow::Buffer,
    indices: glow::Buffer,
    count: i32,
    is_closed: bool,
}

#[derive(Default)]
struct Shared {
    programs: Option<Programs>,
    upload: Upload,
    line_runs: [i32; 3],
    problem: Option<String>,
}

/// Draws scenes by OpenGL.
#[derive(Clone, Default)]
pub(crate) struct GlPainter {
    shared: Arc<Mutex<Shared>>,
}

impl GlPainter {
    /// A painter for this context; `None` where its shaders are too old.
    pub(crate) fn new(gl: &glow::Context) -> Option<Self> {
        ShaderVersion::get(gl).is_new_shader_interface().then(Self::default)
    }

    /// Why the last picture could not be drawn.
    pub(crate) fn problem(&self) -> Option<String> {
        self.lock().problem.clone()
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, Shared> {
        self.shared.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Another surface, or none, in place of a part.
    pub(crate) fn set_mesh(&self, part: Part, mesh: Option<&SceneMesh>, is_closed: bool) {
        let buffer = MeshBuffer::of(mesh.map_or(&[], std::slice::from_ref));
        self.lock().upload.meshes[part as usize] = Some(Surface { buffer, is_closed });
    }

    pub(crate) fn set_lines(&self, scene: &Scene) {
        let (bytes, runs) = line_bytes(scene);
        let mut shared = self.lock();
        shared.upload.lines = Some(bytes);
        shared.line_runs = runs;
    }

    /// The picture as a shape of the interface.
    pub(crate) fn shape(
        &self,
        rect: egui::Rect,
        camera: &Camera,
        bounds: Option<[glam::DVec3; 2]>,
        x_ray: bool,
    ) -> egui::Shape {
        let uniforms = Uniforms { x_ray, ..uniforms(camera, bounds) };
        let painter = self.clone();
        let callback = egui_glow::CallbackFn::new(move |info, glow| {
            let viewport = info.viewport_in_pixels();
            let size = [viewport.width_px as f32, viewport.height_px as f32];
            painter.paint(glow.gl(), &uniforms, size, info.pixels_per_point);
        });
        egui::Shape::Callback(egui::PaintCallback { rect, callback: Arc::new(callback) })
    }

    fn paint(&self, gl: &glow::Context, uniforms: &Uniforms, size: [f32; 2], scale: f32) {
        let mut shared = self.lock();
        if shared.problem.is_some() {
            return;
        }
        if shared.programs.is_none() {
            match Programs::new(gl) {
                Ok(programs) => shared.programs = Some(programs),
                Err(e) => {
                    shared.problem = Some(e);
                    return;
                }
            }
        }
        let upload = std::mem::take(&mut shared.upload);
        let runs = shared.line_runs;
        if let Some(programs) = &mut shared.programs {
            programs.line_runs = runs;
            programs.load(gl, upload);
            programs.draw(gl, uniforms, size, scale);
        }
    }

    /// Gives the context back what was taken from it.
    pub(crate) fn destroy(&self, gl: &glow::Context) {
        if let Some(p) = self.lock().programs.take() {
            // SAFETY: all names were made by this context, which is current when the window closes.
            unsafe {
                for program in [p.open, p.closed, p.line] {
                    gl.delete_program(program);
                }
                for mesh in p.meshes {
                    gl.delete_vertex_array(mesh.array);
                    gl.delete_buffer(mesh.corners);
                    gl.delete_buffer(mesh.indices);
                }
                gl.delete_vertex_array(p.line_array);
                gl.delete_buffer(p.line_buffer);
            }
        }
    }
}

impl Programs {
    fn new(gl: &glow::Context) -> Result<Self, String> {
        let vertex = format!("{}{MESH_VERTEX}", MeshBuffer::LIGHT);
        let corner = ["position", "normal", "front", "reverse"];
        let open = link(gl, &vertex, MESH_FRAGMENT, corner)?;
        let only_front = |source: &str| format!("#define ONLY_FRONT\n{source}");
        let closed = link(gl, &only_front(&vertex), &only_front(MESH_FRAGMENT), corner)?;
        let line = link(gl, LINE_VERTEX, LINE_FRAGMENT, ["a", "b", "corner", "color"])?;
        // SAFETY: the context is current inside a paint callback, and every name below was made by it.
        unsafe {
            let attribute = |place, count, kind, normalised, stride, offset| {
                gl.enable_vertex_attrib_array(place);
                gl.vertex_attrib_pointer_f32(place, count, kind, normalised, stride, offset);
            };
            let resident = || -> Result<Resident, String> {
                let (array, corners, indices) =
                    (gl.create_vertex_array()?, gl.create_buffer()?, gl.create_buffer()?);
                gl.bind_vertex_array(Some(array));
                gl.bind_buffer(glow::ARRAY_BUFFER, Some(corners));
                // The array remembers its indices.
                gl.bind_buffer(glow::ELEMENT_ARRAY_BUFFER, Some(indices));
                let stride = MeshBuffer::STRIDE as i32;
                attribute(0, 3, glow::FLOAT, false, stride, 0);
                attribute(1, 3, glow::FLOAT, false, stride, 12);
                attribute(2, 4, glow::UNSIGNED_BYTE, true, stride, 24);
                attribute(3, 4, glow::UNSIGNED_BYTE, true, stride, 28);
                Ok(Resident { array, corners, indices, count: 0, is_closed: false })
            };
            let meshes = [resident()?, resident()?];
            let (line_array, line_buffer) = (gl.create_vertex_array()?, gl.create_buffer()?);
            gl.bind_vertex_array(Some(line_array));
            gl.bind_buffer(glow::ARRAY_BUFFER, Some(line_buffer));
            attribute(0, 3, glow::FLOAT, false, LINE_STRIDE, 0);
            attribute(1, 3, glow::FLOAT, false, LINE_STRIDE, 12);
            attribute(2, 3, glow::FLOAT, false, LINE_STRIDE, 24);
            attribute(3, 4, glow::UNSIGNED_BYTE, true, LINE_STRIDE, 36);
            gl.bind_vertex_array(None);
            Ok(Self { open, closed, line, meshes, line_array, line_buffer, line_runs: [0; 3] })
        }
    }

    fn load(&mut self, gl: &glow::Context, upload: Upload) {
        let fill = |buffer, bytes: &[u8]| {
            // SAFETY: the buffer was made by this context, which is current.
            unsafe {
                gl.bind_buffer(glow::ARRAY_BUFFER, Some(buffer));
                gl.buffer_data_u8_slice(glow::ARRAY_BUFFER, bytes, glow::DYNAMIC_DRAW);
                gl.bind_buffer(glow::ARRAY_BUFFER, None);
            }
        };
        for (resident, surface) in self.meshes.iter_mut().zip(upload.meshes) {
            let Some(Surface { buffer, is_closed }) = surface else { continue };
            fill(resident.corners, &buffer.bytes);
            let indices: Vec<u8> = buffer.indices.iter().flat_map(|k| k.to_ne_bytes()).collect();
            fill(resident.indices, &indices);
            resident.count = i32::try_from(buffer.indices.len()).unwrap_or(0);
            resident.is_closed = is_closed;
        }
        if let Some(lines) = upload.lines {
            fill(self.line_buffer, &lines);
        }
    }

    fn draw(&self, gl: &glow::Context, u: &Uniforms, size: [f32; 2], scale: f32) {
        // SAFETY: the context is current inside a paint callback, and every name was made by it.
        unsafe {
            gl.enable(glow::DEPTH_TEST);
            gl.depth_mask(true);
            gl.depth_func(glow::LESS);
            gl.clear_depth_f32(1.0);
            gl.clear(glow::DEPTH_BUFFER_BIT);
            gl.disable(glow::BLEND);

            gl.cull_face(glow::BACK);
            let order = if u.x_ray { [Part::Body, Part::Garment] } else { Part::ALL };
            for part in order {
                let mesh = &self.meshes[part as usize];
                if mesh.count == 0 {
                    continue;
                }
                let only_front = mesh.is_closed && u.is_outside;
                let program = if only_front { self.closed } else { self.open };
                if only_front {
                    gl.enable(glow::CULL_FACE);
                } else {
                    gl.disable(glow::CULL_FACE);
                }
                gl.use_program(Some(program));
                let at = |name| gl.get_uniform_location(program, name);
                gl.uniform_matrix_4_f32_slice(at("clip").as_ref(), false, &u.clip);
                for (name, v) in
                    [("eye", u.eye), ("sight", u.sight), ("key", u.key), ("fill", u.fill), ("up", u.up)]
                {
                    gl.uniform_3_f32_slice(at(name).as_ref(), &v);
                }
                gl.bind_vertex_array(Some(mesh.array));
                let draw = |strength: f32| {
                    gl.uniform_1_f32(at("strength").as_ref(), strength);
                    gl.draw_elements(glow::TRIANGLES, mesh.count, glow::UNSIGNED_INT, 0);
                };
                if u.x_ray && part == Part::Garment {
                    // The nearest layer alone is blended: first its depth, then its colour.
                    gl.color_mask(false, false, false, false);
                    draw(1.0);
                    gl.color_mask(true, true, true, true);
                    gl.depth_func(glow::LEQUAL);
                    gl.enable(glow::BLEND);
                    draw(SEEN_THROUGH);
                } else {
                    draw(1.0);
                }
            }
            gl.disable(glow::CULL_FACE);

            gl.enable(glow::BLEND);
            gl.depth_mask(false);
            gl.use_program(Some(self.line));
            let at = |name| gl.get_uniform_location(self.line, name);
            gl.uniform_matrix_4_f32_slice(at("clip").as_ref(), false, &u.clip);
            gl.uniform_2_f32(at("size").as_ref(), size[0], size[1]);
            gl.uniform_1_f32(at("bias").as_ref(), 0.0008);
            gl.uniform_1_f32(at("scale").as_ref(), scale);
            gl.bind_vertex_array(Some(self.line_array));
            let strength = at("strength");
            let draw = |first: i32, count: i32, alpha: f32| {
                gl.uniform_1_f32(strength.as_ref(), alpha);
                gl.draw_arrays(glow::TRIANGLES, first, count);
            };
            let [faint, shown, omitted] = self.line_runs;
            gl.depth_func(glow::GREATER);
            draw(0, faint, 0.28);
            gl.depth_func(glow::LEQUAL);
            draw(0, faint, 1.0);
            draw(faint + shown, omitted, 1.0);
            gl.disable(glow::DEPTH_TEST);
            draw(faint, shown, 1.0);

            // What the interface takes for granted.
            gl.depth_mask(true);
            gl.depth_func(glow::LESS);
            gl.bind_vertex_array(None);
            gl.use_program(None);
        }
    }
}

/// A program whose attributes have these names, in the order of their places.
fn link(
    gl: &glow::Context,
    vertex: &str,
    fragment: &str,
    attributes: [&str; 4],
) -> Result<glow::Program, String> {
    let version = ShaderVersion::get(gl);
    let head = format!("{}\n{}", version.version_declaration(), "precision highp float;\n");
    // SAFETY: the context is current; shaders are deleted when the program holds them.
    unsafe {
        let program = gl.create_program()?;
        let mut shaders = Vec::new();
        for (kind, source) in [(glow::VERTEX_SHADER, vertex), (glow::FRAGMENT_SHADER, fragment)] {
            let shader = gl.create_shader(kind)?;
            gl.shader_source(shader, &format!("{head}{source}"));
            gl.compile_shader(shader);
            if !gl.get_shader_compile_status(shader) {
                return Err(gl.get_shader_info_log(shader));
            }
            gl.attach_shader(program, shader);
            shaders.push(shader);
        }
        for (place, name) in (0..).zip(attributes) {
            gl.bind_attrib_location(program, place, name);
        }
        gl.link_program(program);
        if !gl.get_program_link_status(program) {
            return Err(gl.get_program_info_log(program));
        }
        for shader in shaders {
            gl.detach_shader(program, shader);
            gl.delete_shader(shader);
        }
        Ok(program)
    }
}

/// Lines and points as quads: those faint where hidden, those that show through, those left out where hidden.
fn line_bytes(scene: &Scene) -> (Vec<u8>, [i32; 3]) {
    let mut runs: [Vec<u8>; 3] = Default::default();
    let run = |hidden: Hidden| match hidden {
        Hidden::Faint | Hidden::Dashed => 0,
        Hidden::Shown => 1,
        Hidden::Omitted => 2,
    };
    let mut quad = |hidden, [a, b]: [glam::DVec3; 2], color: viewer::Color, width: f64| {
        let ends = [a.as_vec3().to_array(), b.as_vec3().to_array()];
        for [end, side] in [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, -1.0], [1.0, 1.0], [-1.0, 1.0f32]] {
            let out = &mut runs[run(hidden)];
            let half = 0.5 * width as f32;
            out.extend(ends.iter().flatten().chain(&[end, side, half]).flat_map(|x| x.to_ne_bytes()));
            out.extend([color.0[0], color.0[1], color.0[2], (2.0 * half).round().clamp(1.0, 255.0) as u8]);
        }
    };
    for line in &scene.lines {
        for w in line.points.windows(2) {
            if w[0] != w[1] {
                quad(line.hidden, [w[0], w[1]], line.color, line.width);
            }
        }
    }
    for point in &scene.points {
        quad(point.hidden, [point.position; 2], point.color, point.diameter);
    }
    let counts = runs.each_ref().map(|r| (r.len() / LINE_STRIDE as usize) as i32);
    (runs.concat(), counts)
}

fn uniforms(c: &Camera, bounds: Option<[glam::DVec3; 2]>) -> Uniforms {
    let (right, up, back) = (c.right(), c.up, c.back);
    let toward = |x: f64, y: f64, z: f64| (right * x + up * y + back * z).normalize().as_vec3().to_array();
    let is_within = |[low, high]: [glam::DVec3; 2]| {
        c.eye().is_some_and(|eye| eye.cmpge(low).all() && eye.cmple(high).all())
    };
    let sky = if glam::DVec3::Y.dot(back).abs() > 0.9 { up } else { glam::DVec3::Y };
    Uniforms {
        clip: clip_matrix(c, bounds).to_cols_array().map(|x| x as f32),
        eye: c.eye().unwrap_or_default().as_vec3().to_array(),
        sight: if c.eye().is_none() { back.as_vec3().to_array() } else { [0.0; 3] },
        // The lights of the viewer's own pictures.
        key: toward(-0.52, 0.66, 0.62),
        fill: toward(0.75, 0.05, 0.55),
        up: sky.as_vec3().to_array(),
        x_ray: false,
        is_outside: !bounds.is_some_and(is_within),
    }
}

/// From millimetres to clip space. The depth range holds the scene and no more, for 24 bits to tell cloth from skin.
fn clip_matrix(c: &Camera, bounds: Option<[glam::DVec3; 2]>) -> DMat4 {
    let [low, high] = bounds.unwrap_or([c.target - 1000.0, c.target + 1000.0]);
    let (middle, radius) = (0.5 * (low + high), 0.5 * (high - low).length() + 50.0);
    // Distances ahead of the target's plane, towards the eye positive.
    let depth = (middle - c.target).dot(c.back);
    let (near, far) = (depth + radius, depth - radius);
    let (sx, sy) = (2.0 * c.size.y / (c.height * c.size.x), 2.0 / c.height);
    let (right, up, back) = (c.right(), c.up, c.back);
    let row = |v: glam::DVec3, scale: f64| {
        glam::DVec4::new(v.x * scale, v.y * scale, v.z * scale, -v.dot(c.target) * scale)
    };
    let ahead = row(back, 1.0);
    let distance = c.distance();
    let (z, w) = if distance.is_infinite() {
        let scale = -2.0 / (near - far);
        (ahead * scale + glam::DVec4::W * (-1.0 - near * scale), glam::DVec4::W)
    } else {
        // Ahead of the eye; the near plane never comes nearer than a thousandth of the way to the far one.
        let f = (distance - far).max(1.0);
        let n = (distance - near).max(f / 1000.0);
        let from_eye = glam::DVec4::W * distance - ahead;
        let (p, q) = ((f + n) / (f - n), 2.0 * f * n / (f - n));
        ((from_eye * p - glam::DVec4::W * q) / distance, from_eye / distance)
    };
    DMat4::from_cols(row(right, sx), row(up, sy), z, w).transpose()
}

#[cfg(test)]
mod tests {
    use glam::{DVec2, DVec3};

    use super::*;
    use crate::view::Eye;

    #[test]
    fn clip_space_agrees_with_the_camera() {
        let mut eye = Eye::new();
        eye.camera.size = DVec2::new(900.0, 700.0);
        eye.orbit(egui::vec2(70.0, 30.0), DVec3::new(10.0, 900.0, 0.0));
        let bounds = Some([DVec3::new(-300.0, 0.0, -200.0), DVec3::new(300.0, 1700.0, 200.0)]);
        for _ in 0..2 {
            eye.toggle_projection();
            let clip = clip_matrix(&eye.camera, bounds);
            let mut depths = Vec::new();
            for p in [DVec3::new(-300.0, 0.0, 200.0), DVec3::new(250.0, 1600.0, -190.0), DVec3::Y * 1000.0] {
                let at = clip * p.extend(1.0);
                let ndc = at.truncate() / at.w;
                assert!(ndc.z.abs() < 1.0, "{ndc}");
                let pixel = DVec2::new(0.5 + 0.5 * ndc.x, 0.5 - 0.5 * ndc.y) * eye.camera.size;
                assert!(pixel.distance(eye.camera.project(p).unwrap()) < 1e-6);
                depths.push((eye.camera.depth(p), ndc.z));
            }
            depths.sort_by(|a, b| a.0.total_cmp(&b.0));
            assert!(depths.windows(2).all(|w| w[0].1 > w[1].1), "nearer is smaller: {depths:?}");
        }
    }
}
