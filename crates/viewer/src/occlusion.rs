//! How much of the sky and of the key light each visible place sees, by ray casting.
//!
//! Every pixel casts a few rays of one common low-discrepancy set; neighbours in 4 x 4 blocks take disjoint parts of
//! it (A. Keller, W. Heidrich, "Interleaved sampling", 2001), and a 4 x 4 average over like surfaces gives each pixel
//! the whole set: smooth shadows from few rays, without noise that differs from run to run.

use glam::{DVec3, Vec3, Vec3A};
use obvhs::BvhBuildParams;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::builder::build_cwbvh_from_tris;
use obvhs::ray::Ray;
use obvhs::triangle::Triangle;
use rayon::prelude::*;

use crate::render::Occlusion;

/// Side of the blocks of pixels that share one set of rays.
const BLOCK: usize = 4;
/// Half angle of the key light as seen from the model, in radians: soft shadow edges.
const LIGHT_RADIUS: f32 = 0.11;

/// A place in the picture that receives light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    /// Relative to the scene's centre.
    pub(crate) position: Vec3,
    /// The face's own normal, towards the eye.
    pub(crate) normal: Vec3,
    /// Millimetres a pixel there.
    pub(crate) pixel: f32,
}

/// What light reaches a place: 1 all, 0 none.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Light {
    pub(crate) ambient: f32,
    pub(crate) key: f32,
}

impl Light {
    pub(crate) const FULL: Self = Self { ambient: 1.0, key: 1.0 };
}

/// The scene's faces, ready for rays.
pub(crate) struct Blockers {
    triangles: Vec<Triangle>,
    bvh: CwBvh,
    /// Rays start this far off the surface, in millimetres.
    offset: f32,
}

impl Blockers {
    /// Builds the tree; `faces` are relative to `centre` afterwards. O(n log n).
    pub(crate) fn new(faces: &[[DVec3; 3]], centre: DVec3, diagonal: f64) -> Option<Self> {
        if faces.is_empty() {
            return None;
        }
        let local: Vec<Triangle> = faces
            .par_iter()
            .map(|f| {
                let [v0, v1, v2] = f.map(|p| (p - centre).as_vec3().into());
                Triangle { v0, v1, v2 }
            })
            .collect();
        let bvh = build_cwbvh_from_tris(&local, BvhBuildParams::fast_build(), &mut Default::default());
        // In the tree's order: neighbours in space lie side by side in memory.
        let triangles = bvh.primitive_indices.iter().map(|i| local[*i as usize]).collect();
        Some(Self { triangles, bvh, offset: (2e-4 * diagonal) as f32 })
    }

    fn blocked(&self, from: Vec3, direction: Vec3, reach: f32) -> bool {
        let ray = Ray::new(Vec3A::from(from), Vec3A::from(direction), 0.0, reach);
        !self.bvh.ray_traverse_miss(ray, |ray, id| self.triangles[id].intersect(ray))
    }
}

impl Place {
    /// Whether another place lies on the same stretch of surface.
    fn alike(&self, other: &Self) -> bool {
        let away = other.position - self.position;
        self.normal.dot(other.normal) > 0.7
            && away.dot(self.normal).abs() < 3.0 * self.pixel
            && away.dot(other.normal).abs() < 3.0 * self.pixel
    }
}

/// Light at one place a pixel.
pub(crate) struct LightMap {
    places: Vec<Option<Place>>,
    light: Vec<Light>,
    width: usize,
}

impl LightMap {
    /// Light at all places (`None`: background): rays are cast at every `spacing`-th pixel of every `spacing`-th row,
    /// smoothed there and interpolated between; places that find nobody on their own surface cast their own. `key`
    /// points to the key light, `reach` is in millimetres.
    pub(crate) fn new(
        blockers: &Blockers,
        places: Vec<Option<Place>>,
        width: usize,
        options: &Occlusion,
        reach: f32,
        key: Vec3,
    ) -> Self {
        let rays = Rays {
            blockers,
            sky: hemisphere(options.rays.max(1) as usize),
            lamp: lamp(options.shadow_rays as usize, key),
            reach,
            key,
        };
        let spacing = options.spacing.max(1) as usize;
        if spacing == 1 {
            return Self::cast(&rays, places, width);
        }
        let columns = width.div_ceil(spacing);
        let rows = (places.len() / width).div_ceil(spacing);
        let chosen =
            (0..columns * rows).map(|i| places[i / columns * spacing * width + i % columns * spacing]);
        let coarse = Self::cast(&rays, chosen.collect(), columns);
        let light = places
            .par_iter()
            .enumerate()
            .with_min_len(256)
            .map(|(i, place)| {
                let Some(place) = place else { return Light::FULL };
                let at = [i % width, i / width];
                coarse.between(at, spacing, place).unwrap_or_else(|| rays.cast(place, at))
            })
            .collect();
        Self { places, light, width }
    }

    /// Casts rays at all places and smooths.
    fn cast(rays: &Rays, places: Vec<Option<Place>>, width: usize) -> Self {
        let rough: Vec<Light> = places
            .par_iter()
            .enumerate()
            .with_min_len(64)
            .map(|(i, place)| place.as_ref().map_or(Light::FULL, |p| rays.cast(p, [i % width, i / width])))
            .collect();
        let mut map = Self { places, light: rough, width };
        map.light = map.smoothed();
        map
    }

    /// Light at a pixel between this coarser map's pixels, from those of the four around it that see the same
    /// surface, by nearness.
    fn between(&self, at: [usize; 2], spacing: usize, place: &Place) -> Option<Light> {
        let height = self.light.len() / self.width;
        let (mut ambient, mut key, mut weight) = (0.0, 0.0, 0.0);
        for v in at[1] / spacing..(at[1] / spacing + 2).min(height) {
            for u in at[0] / spacing..(at[0] / spacing + 2).min(self.width) {
                let j = v * self.width + u;
                if self.places[j].is_some_and(|other| place.alike(&other)) {
                    let near =
                        |a: usize, b: usize| 1.0 - (a as f32 - (b * spacing) as f32).abs() / spacing as f32;
                    let w = near(at[0], u) * near(at[1], v) + 1e-3;
                    ambient += w * self.light[j].ambient;
                    key += w * self.light[j].key;
                    weight += w;
                }
            }
        }
        (weight > 0.0).then(|| Light { ambient: ambient / weight, key: key / weight })
    }

    /// The place that stands for a pixel.
    pub(crate) fn place(&self, pixel: usize) -> Option<&Place> {
        self.places[pixel].as_ref()
    }

    /// Light at the place that stands for a pixel.
    pub(crate) fn of_pixel(&self, pixel: usize) -> Light {
        self.light[pixel]
    }

    /// Light at a place seen in a part of a pixel: the pixel's own when they lie on the same surface, else that of
    /// neighbours on it; else the pixel's own.
    pub(crate) fn near(&self, pixel: usize, place: Option<Place>) -> Light {
        let Some(place) = place else { return self.light[pixel] };
        if self.places[pixel].is_none_or(|own| own.alike(&place)) {
            return self.light[pixel];
        }
        self.average(&self.light, pixel, &place, [1, 1]).unwrap_or(self.light[pixel])
    }

    /// Averages each 4 x 4 block of neighbours over those that lie on the same surface.
    fn smoothed(&self) -> Vec<Light> {
        (0..self.light.len())
            .into_par_iter()
            .with_min_len(256)
            .map(|i| match &self.places[i] {
                Some(own) => self.average(&self.light, i, own, [1, 2]).unwrap_or(self.light[i]),
                None => Light::FULL,
            })
            .collect()
    }

    /// Mean light of the pixels from `before` left and above to `after` right and below that see the same surface.
    fn average(&self, light: &[Light], i: usize, own: &Place, [before, after]: [usize; 2]) -> Option<Light> {
        let (x, y) = (i % self.width, i / self.width);
        let height = light.len() / self.width;
        let (mut ambient, mut key, mut weight) = (0.0, 0.0, 0.0);
        for v in y.saturating_sub(before)..(y + after + 1).min(height) {
            for u in x.saturating_sub(before)..(x + after + 1).min(self.width) {
                let j = v * self.width + u;
                if self.places[j].is_some_and(|other| own.alike(&other)) {
                    ambient += light[j].ambient;
                    key += light[j].key;
                    weight += 1.0;
                }
            }
        }
        (weight > 0.0).then(|| Light { ambient: ambient / weight, key: key / weight })
    }
}

/// Directions over the hemisphere around +z, denser at the pole by the cosine, with the part of the reach that each
/// looks: members of block pixel p are entries p, p + 16, p + 32 …
fn hemisphere(rays: usize) -> Vec<(Vec3, f32)> {
    let n = rays * BLOCK * BLOCK;
    lattice(n)
        .into_iter()
        .enumerate()
        .map(|(i, [u, v])| {
            let (sin, cos) = (v * std::f32::consts::TAU).sin_cos();
            let r = u.sqrt();
            // Looks 15 % to 100 % of the reach: near things count fully, far ones fade out.
            let part = (i as f32 * 0.618_034 + 0.37).fract();
            (Vec3::new(r * cos, r * sin, (1.0 - u).sqrt()), 0.15 + 0.85 * part * part)
        })
        .collect()
}

/// Directions to points of the key light's disc.
fn lamp(rays: usize, key: Vec3) -> Vec<Vec3> {
    let (a, b) = key.any_orthonormal_pair();
    lattice(rays * BLOCK * BLOCK)
        .into_iter()
        .map(|[u, v]| {
            let (sin, cos) = (v * std::f32::consts::TAU).sin_cos();
            let r = u.sqrt() * LIGHT_RADIUS;
            (key + (a * cos + b * sin) * r).normalize()
        })
        .collect()
}

/// A rank-1 lattice of `n` points whose every 16th points are a lattice again.
fn lattice(n: usize) -> Vec<[f32; 2]> {
    let step = crate::raster::golden_step(n as u32) as usize;
    (0..n).map(|i| [(i as f32 + 0.5) / n as f32, (i * step % n.max(1)) as f32 / n as f32]).collect()
}

/// The rays of a picture.
struct Rays<'a> {
    blockers: &'a Blockers,
    sky: Vec<(Vec3, f32)>,
    lamp: Vec<Vec3>,
    reach: f32,
    key: Vec3,
}

impl Rays<'_> {
    /// Light at a place, from the share of the rays that falls to its pixel.
    fn cast(&self, place: &Place, at: [usize; 2]) -> Light {
        let member = (at[1] % BLOCK) * BLOCK + at[0] % BLOCK;
        let share = BLOCK * BLOCK;
        let from = place.position + place.normal * self.blockers.offset;
        let (a, b) = place.normal.any_orthonormal_pair();
        let open = |blocked: &mut dyn Iterator<Item = bool>| {
            let (mut all, mut free) = (0u32, 0u32);
            for blocked in blocked {
                all += 1;
                free += u32::from(!blocked);
            }
            if all == 0 { 1.0 } else { free as f32 / all as f32 }
        };
        let ambient = open(&mut self.sky.iter().skip(member).step_by(share).map(|(d, part)| {
            let direction = a * d.x + b * d.y + place.normal * d.z;
            self.blockers.blocked(from, direction, self.reach * part)
        }));
        let key = if place.normal.dot(self.key) <= -LIGHT_RADIUS {
            0.0
        } else {
            let lamp = self.lamp.iter().skip(member).step_by(share);
            open(&mut lamp.map(|d| self.blockers.blocked(from, *d, f32::MAX)))
        };
        // No gap is quite black: light comes back from its walls.
        Light { ambient: 0.12 + 0.88 * ambient, key }
    }
}
