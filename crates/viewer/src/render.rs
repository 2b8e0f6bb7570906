//! From a scene to a picture.

use glam::{DVec2, DVec3, Vec3};
use rayon::prelude::*;

use crate::camera::{Camera, Projector};
use crate::color::{Color, Encoder};
use crate::error::{RenderError, check_size};
use crate::image::Image;
use crate::normals::{CornerNormals, corner_normals};
use crate::occlusion::{Blockers, Light, LightMap, Place};
use crate::raster::{self, Fragment, Visible};
use crate::scene::{Paint, Reverse, Scene};
use crate::shade::{Finish, Lights};
use crate::{labels, legend, lines};

/// How a picture is made.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderOptions {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Background.
    pub background: Color,
    /// Samples a pixel, 1 to 64: smoothness of edges.
    pub samples: u32,
    /// Soft shadows of the sky and of the key light; `None`: plain shading, faster.
    pub occlusion: Option<Occlusion>,
    /// A floor under the lowest point that shows the model's soft shadow (with `occlusion`, seen from above).
    pub floor: bool,
    /// Lines and points up to this many millimetres behind a surface still count as on it; `None`: 1/4000 of the
    /// scene's diagonal.
    pub line_bias: Option<f64>,
    /// Enlarges text, lines and points.
    pub scale: f64,
}

impl Default for RenderOptions {
    /// 1024 x 1024, light background, 8 samples, soft shadows, no floor.
    fn default() -> Self {
        Self {
            width: 1024,
            height: 1024,
            background: Color::PAPER,
            samples: 8,
            occlusion: Some(Occlusion::default()),
            floor: false,
            line_bias: None,
            scale: 1.0,
        }
    }
}

impl RenderOptions {
    /// The default at another size.
    pub fn sized(width: u32, height: u32) -> Self {
        Self { width, height, ..Self::default() }
    }

    /// The same without ray-cast shadows: fast.
    pub fn plain(self) -> Self {
        Self { occlusion: None, ..self }
    }

    /// Pixels for one unit of line widths and text sizes.
    pub(crate) fn unit(&self) -> f64 {
        let size = (f64::from(self.width) * f64::from(self.height)).sqrt() / 1024.0;
        size.max(0.45) * self.scale
    }
}

/// Soft shadows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Occlusion {
    /// Rays to the sky a casting pixel, 1 to 256; sixteen pixels share theirs.
    pub rays: u32,
    /// Rays to the key light a casting pixel, 0 to 64 (0: no cast shadows).
    pub shadow_rays: u32,
    /// How far neighbours darken each other, as a part of the scene's diagonal.
    pub reach: f64,
    /// Rays are cast at every so-many-th pixel of every so-many-th row, 1 to 8, and interpolated between.
    pub spacing: u32,
}

impl Default for Occlusion {
    fn default() -> Self {
        Self { rays: 8, shadow_rays: 3, reach: 0.2, spacing: 2 }
    }
}

/// Draws a scene.
///
/// The same scene, camera and options give the same bytes, on any number of threads. O(faces + pixels x samples), and
/// with occlusion O(log faces) a ray.
///
/// # Errors
/// [`RenderError`]: an impossible size or option, an empty scene, coordinates that are no numbers, indices or colour
/// counts that do not fit.
pub fn render(scene: &Scene, camera: &Camera, options: &RenderOptions) -> Result<Image, RenderError> {
    check_size(options.width, options.height)?;
    check_options(options)?;
    scene.check()?;
    camera.check()?;
    let (width, height) = (options.width as usize, options.height as usize);
    let projector = Projector::new(camera, options.width, options.height);
    let surfaces = Surfaces::new(scene);
    let pattern = raster::sample_pattern(options.samples);
    let visible = raster::visible(&projector, &surfaces.corners, width, height, &pattern);

    let [lo, hi] = scene.bounds().unwrap_or([DVec3::ZERO; 2]);
    let diagonal = (hi - lo).length();
    let lights = Lights::new(&projector);
    let frame = Frame { projector: &projector, width, centre: 0.5 * (lo + hi) };
    let blockers = options
        .occlusion
        .as_ref()
        .and_then(|occlusion| Some((occlusion, Blockers::new(&surfaces.corners, frame.centre, diagonal)?)));
    let reached = |places: Vec<Option<Place>>, (occlusion, blockers): &(&Occlusion, Blockers)| {
        let reach = (occlusion.reach * diagonal) as f32;
        LightMap::new(blockers, places, width, occlusion, reach, lights.key)
    };
    let light = blockers.as_ref().map(|b| reached(frame.places(&visible, &surfaces.corners), b));
    let floor = blockers.as_ref().filter(|_| options.floor).map(|b| Floor {
        map: reached(frame.floor_places(&visible, &pattern, lo, hi), b),
        radius: FLOOR_RADIUS * diagonal as f32,
    });

    let encoder = Encoder::new();
    let background = options.background.linear();
    let samples = options.samples as f32;
    let mut rgb = vec![0u8; width * height * 3];
    rgb.par_chunks_mut(width * 3).enumerate().for_each(|(y, row)| {
        for x in 0..width {
            let pixel = y * width + x;
            let fragments = visible.of_pixel(pixel);
            let mut sum = [0.0f32; 3];
            let mut open = samples;
            // Parts that would get the same light are lit once.
            let mut lit = 0u64;
            for (i, fragment) in fragments.iter().enumerate() {
                if lit >> i & 1 == 1 {
                    continue;
                }
                let mut weight = f32::from(fragment.samples);
                for (j, other) in fragments.iter().enumerate().skip(i + 1) {
                    if lit >> j & 1 == 0 && surfaces.alike(fragment.face, other.face) {
                        weight += f32::from(other.samples);
                        lit |= 1 << j;
                    }
                }
                let own = match &light {
                    None => Light::FULL,
                    Some(map) if fragments.len() == 1 => map.of_pixel(pixel),
                    Some(map) => map.near(pixel, frame.place_of(fragment, pixel, &surfaces.corners)),
                };
                let at =
                    DVec2::new(x as f64 + f64::from(fragment.at[0]), y as f64 + f64::from(fragment.at[1]));
                let color = surfaces.color(&projector, &lights, fragment.face, at, own);
                open -= weight;
                for k in 0..3 {
                    sum[k] += color[k].clamp(0.0, 1.0) * weight;
                }
            }
            if open > 0.0 {
                let shadow = floor.as_ref().map_or(1.0, |f| f.shade(pixel));
                for k in 0..3 {
                    sum[k] += background[k] * shadow * open;
                }
            }
            for k in 0..3 {
                row[3 * x + k] = encoder.byte(sum[k] / samples);
            }
        }
    });
    let mut image = Image::from_rgb(options.width, options.height, rgb);
    let bias = options.line_bias.unwrap_or(diagonal / 4000.0);
    let depth = lines::Depth { nearness: &visible.nearness, width, height, projector: &projector, bias };
    lines::draw(&mut image, scene, &depth, options);
    labels::draw(&mut image, scene, &depth, options);
    legend::draw(&mut image, scene, options);
    Ok(image)
}

fn check_options(options: &RenderOptions) -> Result<(), RenderError> {
    let within = |option, value: f64, lo: f64, hi: f64, range| {
        if value >= lo && value <= hi { Ok(()) } else { Err(RenderError::Option { option, value, range }) }
    };
    within("samples", f64::from(options.samples), 1.0, 64.0, "it must be 1 to 64")?;
    within("scale", options.scale, 0.05, 50.0, "it must be 0.05 to 50")?;
    within("line bias", options.line_bias.unwrap_or(0.0), 0.0, 1e9, "it must be 0 or more millimetres")?;
    if let Some(occlusion) = &options.occlusion {
        within("rays", f64::from(occlusion.rays), 1.0, 256.0, "it must be 1 to 256")?;
        within("shadow rays", f64::from(occlusion.shadow_rays), 0.0, 64.0, "it must be 0 to 64")?;
        within("spacing", f64::from(occlusion.spacing), 1.0, 8.0, "it must be 1 to 8")?;
        within("reach", occlusion.reach, 0.0, 10.0, "it must be 0 to 10 diagonals")?;
    }
    Ok(())
}

/// All faces of a scene in one row, with what shading needs.
struct Surfaces<'a> {
    scene: &'a Scene,
    corners: Vec<[DVec3; 3]>,
    normals: Vec<CornerNormals>,
    /// First face of each mesh.
    firsts: Vec<usize>,
    /// Each mesh's colours: what its numbers are looked up in, or its solid colour.
    tables: Vec<Vec<[f32; 3]>>,
}

/// Steps of a scale's table: finer than eight bits show.
const TABLE: usize = 1024;

impl<'a> Surfaces<'a> {
    fn new(scene: &'a Scene) -> Self {
        let mut out =
            Self { scene, corners: Vec::new(), normals: Vec::new(), firsts: Vec::new(), tables: Vec::new() };
        for mesh in &scene.meshes {
            out.firsts.push(out.corners.len());
            out.corners.par_extend(mesh.faces.par_iter().map(|f| f.map(|v| mesh.positions[v as usize])));
            out.normals.extend(corner_normals(&mesh.positions, &mesh.faces, mesh.shading));
            out.tables.push(match &mesh.paint {
                Paint::Solid(color) => vec![color.linear()],
                Paint::Faces(colors) => colors.iter().map(|c| c.linear()).collect(),
                Paint::FaceValues { scale, .. } | Paint::NodeValues { scale, .. } => {
                    scale.map.table(TABLE).into_iter().map(Color::linear).collect()
                }
            });
        }
        out
    }

    /// The mesh of a face.
    fn mesh_of(&self, face: usize) -> usize {
        self.firsts.partition_point(|first| *first <= face) - 1
    }

    /// Whether two faces look the same where they meet in one pixel: one mesh, one colour, one direction within 10°.
    fn alike(&self, a: u32, b: u32) -> bool {
        let (a, b) = (a as usize, b as usize);
        let m = self.mesh_of(a);
        if self.normals[a].flat.dot(self.normals[b].flat) < 0.985 || self.mesh_of(b) != m {
            return false;
        }
        let (i, j) = (a - self.firsts[m], b - self.firsts[m]);
        match &self.scene.meshes[m].paint {
            Paint::Solid(_) | Paint::NodeValues { .. } => true,
            Paint::Faces(colors) => colors[i] == colors[j],
            Paint::FaceValues { values, .. } => values[i] == values[j],
        }
    }

    /// Light from a face towards the eye at a pixel position.
    fn color(&self, projector: &Projector, lights: &Lights, face: u32, at: DVec2, light: Light) -> [f32; 3] {
        let face = face as usize;
        let m = self.mesh_of(face);
        let mesh = &self.scene.meshes[m];
        let local = face - self.firsts[m];
        let corners = &self.corners[face];
        let (origin, direction) = projector.ray(at);
        let weights = barycentric(corners, origin, direction);
        let [u, v, w] = weights.map(|x| x as f32);

        let CornerNormals { flat, corners: n } = self.normals[face];
        let reversed = flat.as_dvec3().dot(direction) > 0.0;
        let mut normal = (n[0] * u + n[1] * v + n[2] * w).normalize_or_zero();
        if reversed {
            normal = -normal;
        }
        let to_eye = -direction.as_vec3();
        // A smoothed normal may lean behind the outline: bring it back to the edge of sight.
        let lean = normal.dot(to_eye);
        if lean < 0.0 {
            normal = (normal - to_eye * lean).normalize_or_zero();
        }

        let table = &self.tables[m];
        let value = |value: f64, scale: &crate::Scale| {
            let t = scale.position(value);
            if t.is_nan() {
                Color::NO_VALUE.linear()
            } else {
                table[(t.clamp(0.0, 1.0) * (TABLE - 1) as f64).round() as usize]
            }
        };
        let (albedo, finish) = match &mesh.paint {
            Paint::Solid(_) => (table[0], Finish::Matte),
            Paint::Faces(_) => (table[local], Finish::Matte),
            Paint::FaceValues { values, scale } => (value(values[local], scale), Finish::Data),
            Paint::NodeValues { values, scale } => {
                let at = mesh.faces[local].map(|v| values[v as usize]);
                let mean = at[0] * weights[0] + at[1] * weights[1] + at[2] * weights[2];
                (value(mean, scale), Finish::Data)
            }
        };
        let albedo = match (reversed, mesh.reverse) {
            (false, _) | (true, Reverse::Same) => albedo,
            (true, Reverse::Darker) => albedo.map(|c| 0.52 * c),
            (true, Reverse::Colored(color)) => color.linear(),
        };
        lights.shade(albedo, normal, to_eye, light, finish)
    }
}

/// Where a line of sight meets a face's plane, as weights of its corners, held inside the face.
fn barycentric(corners: &[DVec3; 3], origin: DVec3, direction: DVec3) -> [f64; 3] {
    let (e1, e2) = (corners[1] - corners[0], corners[2] - corners[0]);
    let p = direction.cross(e2);
    let det = e1.dot(p);
    let t = origin - corners[0];
    let q = t.cross(e1);
    let v = t.dot(p) / det;
    let w = direction.dot(q) / det;
    if !(v.is_finite() && w.is_finite()) {
        return [1.0 / 3.0; 3];
    }
    let clamped = [1.0 - v - w, v, w].map(|x| x.clamp(0.0, 1.0));
    let sum: f64 = clamped.iter().sum();
    clamped.map(|x| x / sum)
}

/// The floor's shadow reaches this far from the model's middle, in diagonals.
const FLOOR_RADIUS: f32 = 0.62;

/// The shadow under the model.
struct Floor {
    map: LightMap,
    radius: f32,
}

impl Floor {
    /// What the shadow leaves of the background's light: fades out evenly with the distance from the middle.
    fn shade(&self, pixel: usize) -> f32 {
        let Some(place) = self.map.place(pixel) else { return 1.0 };
        let away = (Vec3::new(place.position.x, 0.0, place.position.z).length() / self.radius).min(1.0);
        let fade = (1.0 - away * away).powi(2);
        let light = self.map.of_pixel(pixel);
        1.0 - fade * (0.55 * (1.0 - light.ambient) + 0.22 * (1.0 - light.key))
    }
}

/// What turns pixels into places.
struct Frame<'a> {
    projector: &'a Projector,
    width: usize,
    centre: DVec3,
}

impl Frame<'_> {
    /// The place that most of each pixel sees.
    fn places(&self, visible: &Visible, corners: &[[DVec3; 3]]) -> Vec<Option<Place>> {
        (0..visible.starts.len() - 1)
            .into_par_iter()
            .with_min_len(256)
            .map(|pixel| {
                let most = visible.of_pixel(pixel).iter().max_by_key(|f| (f.samples, u32::MAX - f.face))?;
                self.place_of(most, pixel, corners)
            })
            .collect()
    }

    /// The place that a part of a pixel sees; `None` on a face without area.
    fn place_of(&self, fragment: &Fragment, pixel: usize, corners: &[[DVec3; 3]]) -> Option<Place> {
        let at = DVec2::new(
            (pixel % self.width) as f64 + f64::from(fragment.at[0]),
            (pixel / self.width) as f64 + f64::from(fragment.at[1]),
        );
        let face = &corners[fragment.face as usize];
        let (origin, direction) = self.projector.ray(at);
        let [u, v, w] = barycentric(face, origin, direction);
        let position = face[0] * u + face[1] * v + face[2] * w;
        let normal = (face[1] - face[0]).cross(face[2] - face[0]).try_normalize()?;
        Some(self.place(position, if normal.dot(direction) > 0.0 { -normal } else { normal }))
    }

    /// The floor's places behind pixels that the model does not fill, near the model.
    fn floor_places(
        &self,
        visible: &Visible,
        pattern: &[[f32; 2]],
        lo: DVec3,
        hi: DVec3,
    ) -> Vec<Option<Place>> {
        let reach = f64::from(FLOOR_RADIUS) * (hi - lo).length();
        (0..visible.starts.len() - 1)
            .into_par_iter()
            .with_min_len(256)
            .map(|pixel| {
                let covered: usize = visible.of_pixel(pixel).iter().map(|f| f.samples as usize).sum();
                if covered == pattern.len() {
                    return None;
                }
                let at = DVec2::new((pixel % self.width) as f64 + 0.5, (pixel / self.width) as f64 + 0.5);
                let (origin, direction) = self.projector.ray(at);
                // Seen from above, not along itself.
                if direction.y > -0.02 {
                    return None;
                }
                let position = origin + direction * ((lo.y - origin.y) / direction.y);
                let away = position - self.centre;
                let inside = away.x.hypot(away.z) < reach;
                inside.then(|| self.place(position, DVec3::Y))
            })
            .collect()
    }

    fn place(&self, position: DVec3, normal: DVec3) -> Place {
        Place {
            position: (position - self.centre).as_vec3(),
            normal: normal.as_vec3(),
            pixel: self.projector.pixel_size(position) as f32,
        }
    }
}
