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
use viewer::{Hidden, MeshBuffer, Scene};

use super::SEEN_THROUGH;
use super::shaders::{LINE_FRAGMENT, LINE_VERTEX, MESH_FRAGMENT, MESH_VERTEX};

/// Bytes of a vertex of a line: both ends (six `f32`), which end and side (two `f32`), half the width (`f32`), colour.
const LINE_STRIDE: i32 = 40;

/// What the callback needs, made anew when the scene changes.
#[derive(Default)]
struct Upload {
    mesh: Option<MeshBuffer>,
    opaque: i32,
    lines: Option<Vec<u8>>,
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
}

struct Programs {
    mesh: glow::Program,
    line: glow::Program,
    mesh_array: glow::VertexArray,
    mesh_buffer: glow::Buffer,
    index_buffer: glow::Buffer,
    line_array: glow::VertexArray,
    line_buffer: glow::Buffer,
    /// Corners of faces, and how many of them, the first, are not seen through.
    mesh_indices: [i32; 2],
    /// Vertices of lines that are drawn faint where hidden, then of those that show through, then of those that do not.
    line_runs: [i32; 3],
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

    /// Draws these surfaces; the eye goes through those after the first `opaque`.
    pub(crate) fn set_meshes(&self, scene: &Scene, opaque: usize) {
        let corners: usize = scene.meshes.iter().take(opaque).map(|m| 3 * m.faces.len()).sum();
        let mut shared = self.lock();
        shared.upload.mesh = Some(MeshBuffer::of(&scene.meshes));
        shared.upload.opaque = i32::try_from(corners).unwrap_or(i32::MAX);
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
    ) -> egui::Shape {
        let uniforms = uniforms(camera, bounds);
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
                gl.delete_program(p.mesh);
                gl.delete_program(p.line);
                gl.delete_vertex_array(p.mesh_array);
                gl.delete_vertex_array(p.line_array);
                gl.delete_buffer(p.mesh_buffer);
                gl.delete_buffer(p.index_buffer);
                gl.delete_buffer(p.line_buffer);
            }
        }
    }
}

impl Programs {
    fn new(gl: &glow::Context) -> Result<Self, String> {
        let mesh_fragment = format!("{}{MESH_FRAGMENT}", MeshBuffer::LIGHT);
        let mesh = link(gl, MESH_VERTEX, &mesh_fragment)?;
        let line = link(gl, LINE_VERTEX, LINE_FRAGMENT)?;
        // SAFETY: the context is current inside a paint callback, and every name below was made by it.
        unsafe {
            let (mesh_array, mesh_buffer) = (gl.create_vertex_array()?, gl.create_buffer()?);
            gl.bind_vertex_array(Some(mesh_array));
            gl.bind_buffer(glow::ARRAY_BUFFER, Some(mesh_buffer));
            let index_buffer = gl.create_buffer()?;
            // The array remembers its indices.
            gl.bind_buffer(glow::ELEMENT_ARRAY_BUFFER, Some(index_buffer));
            let attribute = |program, name: &str, count, kind, normalised, stride, offset| {
                if let Some(place) = gl.get_attrib_location(program, name) {
                    gl.enable_vertex_attrib_array(place);
                    gl.vertex_attrib_pointer_f32(place, count, kind, normalised, stride, offset);
                }
            };
            let stride = MeshBuffer::STRIDE as i32;
            attribute(mesh, "position", 3, glow::FLOAT, false, stride, 0);
            attribute(mesh, "normal", 3, glow::FLOAT, false, stride, 12);
            attribute(mesh, "front", 4, glow::UNSIGNED_BYTE, true, stride, 24);
            attribute(mesh, "reverse", 4, glow::UNSIGNED_BYTE, true, stride, 28);
            let (line_array, line_buffer) = (gl.create_vertex_array()?, gl.create_buffer()?);
            gl.bind_vertex_array(Some(line_array));
            gl.bind_buffer(glow::ARRAY_BUFFER, Some(line_buffer));
            attribute(line, "a", 3, glow::FLOAT, false, LINE_STRIDE, 0);
            attribute(line, "b", 3, glow::FLOAT, false, LINE_STRIDE, 12);
            attribute(line, "corner", 3, glow::FLOAT, false, LINE_STRIDE, 24);
            attribute(line, "color", 4, glow::UNSIGNED_BYTE, true, LINE_STRIDE, 36);
            gl.bind_vertex_array(None);
            Ok(Self {
                mesh,
                line,
                mesh_array,
                mesh_buffer,
                index_buffer,
                line_array,
                line_buffer,
                mesh_indices: [0; 2],
                line_runs: [0; 3],
            })
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
        if let Some(mesh) = upload.mesh {
            fill(self.mesh_buffer, &mesh.bytes);
            let indices: Vec<u8> = mesh.indices.iter().flat_map(|k| k.to_ne_bytes()).collect();
            fill(self.index_buffer, &indices);
            let count = i32::try_from(mesh.indices.len()).unwrap_or(0);
            self.mesh_indices = [count, upload.opaque.min(count)];
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
            gl.disable(glow::CULL_FACE);

            gl.use_program(Some(self.mesh));
            let at = |name| gl.get_uniform_location(self.mesh, name);
            gl.uniform_matrix_4_f32_slice(at("clip").as_ref(), false, &u.clip);
            for (name, v) in
                [("eye", u.eye), ("sight", u.sight), ("key", u.key), ("fill", u.fill), ("up", u.up)]
            {
                gl.uniform_3_f32_slice(at(name).as_ref(), &v);
            }
            gl.bind_vertex_array(Some(self.mesh_array));
            let [count, opaque] = self.mesh_indices;
            let strength = at("strength");
            gl.uniform_1_f32(strength.as_ref(), 1.0);
            gl.draw_elements(glow::TRIANGLES, opaque, glow::UNSIGNED_INT, 0);
            if count > opaque {
                // The nearest layer alone is blended: first its depth, then its colour.
                let rest =
                    || gl.draw_elements(glow::TRIANGLES, count - opaque, glow::UNSIGNED_INT, 4 * opaque);
                gl.color_mask(false, false, false, false);
                rest();
                gl.color_mask(true, true, true, true);
                gl.depth_func(glow::LEQUAL);
                gl.enable(glow::BLEND);
                gl.uniform_1_f32(strength.as_ref(), SEEN_THROUGH);
                rest();
            }

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

fn link(gl: &glow::Context, vertex: &str, fragment: &str) -> Result<glow::Program, String> {
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
    let sky = if glam::DVec3::Y.dot(back).abs() > 0.9 { up } else { glam::DVec3::Y };
    Uniforms {
        clip: clip_matrix(c, bounds).to_cols_array().map(|x| x as f32),
        eye: c.eye().unwrap_or_default().as_vec3().to_array(),
        sight: if c.eye().is_none() { back.as_vec3().to_array() } else { [0.0; 3] },
        // The lights of the viewer's own pictures.
        key: toward(-0.52, 0.66, 0.62),
        fill: toward(0.75, 0.05, 0.55),
        up: sky.as_vec3().to_array(),
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
