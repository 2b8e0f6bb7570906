//! Which faces each pixel sees, and how much of each.
//!
//! Visibility is found by scan conversion on snapped (1/256 pixel) corners with exact integer edge tests: watertight,
//! and the same on any number of threads. Pictures are cut into tiles; a tile's faces are tried in order of their
//! index, so ties of depth go to the earlier face.

use std::ops::{Add, BitOr, Mul};

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use crate::camera::{OnScreen, Projector};

/// Side of a tile in pixels.
const TILE: usize = 32;
/// Snapped units a pixel.
const SNAP: f64 = 256.0;
/// Corners farther than this from the picture's origin (pixels) are clipped, so that products of snapped
/// coordinates fit 64 bits.
const GUARD: f64 = 1_000_000.0;

/// One face's part of a pixel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fragment {
    /// Face number over all meshes.
    pub(crate) face: u32,
    /// Number of the pixel's samples that see the face.
    pub(crate) samples: u16,
    /// Mean place of those samples, in pixels from the pixel's top left corner.
    pub(crate) at: [f32; 2],
}

/// What the pixels see.
pub(crate) struct Visible {
    pub(crate) fragments: Vec<Fragment>,
    /// First fragment of each pixel, and one past the last of the last.
    pub(crate) starts: Vec<u32>,
    /// Nearness of each pixel's farthest sample; negative infinity where one sees the background.
    pub(crate) nearness: Vec<f32>,
}

impl Visible {
    pub(crate) fn of_pixel(&self, pixel: usize) -> &[Fragment] {
        &self.fragments[self.starts[pixel] as usize..self.starts[pixel + 1] as usize]
    }
}

/// A face in the picture: snapped corners, anticlockwise or clockwise, and its plane of nearness.
struct ScreenFace {
    face: u32,
    corners: [[i64; 2]; 3],
    /// Nearness at the picture's origin and its change a pixel along x and y.
    plane: [f64; 3],
    /// Nearness of the nearest and farthest corner: bounds against the plane's extrapolation on slivers.
    range: [f64; 2],
}

/// `n` places in a pixel, in columns and rows all different (a rank-1 lattice): good edges at any slope.
pub(crate) fn sample_pattern(n: u32) -> Vec<[f32; 2]> {
    let step = golden_step(n);
    (0..n).map(|i| [(i as f32 + 0.5) / n as f32, ((i * step % n) as f32 + 0.5) / n as f32]).collect()
}

/// The number without common divisor with `n` that is nearest to `n` over the golden ratio: a step that spreads
/// points of a lattice well.
pub(crate) fn golden_step(n: u32) -> u32 {
    fn gcd(a: u32, b: u32) -> u32 {
        if b == 0 { a } else { gcd(b, a % b) }
    }
    let wanted = f64::from(n) / 1.618_033_988_749_895;
    (1..=n)
        .filter(|k| gcd(*k, n) == 1)
        .min_by(|a, b| (f64::from(*a) - wanted).abs().total_cmp(&(f64::from(*b) - wanted).abs()))
        .unwrap_or(1)
}

/// Finds what every pixel sees. `faces` are corner positions by face number. O(faces + covered samples).
pub(crate) fn visible(
    projector: &Projector,
    faces: &[[DVec3; 3]],
    width: usize,
    height: usize,
    samples: &[[f32; 2]],
) -> Visible {
    let limits = [width as f64, height as f64];
    let chunks: Vec<Vec<ScreenFace>> = faces
        .par_chunks(4096)
        .enumerate()
        .map(|(chunk, part)| {
            let mut out = Vec::with_capacity(part.len());
            for (i, corners) in part.iter().enumerate() {
                screen_faces(projector, (chunk * 4096 + i) as u32, corners, limits, &mut out);
            }
            out
        })
        .collect();
    let screen: Vec<ScreenFace> = chunks.into_iter().flatten().collect();

    let (columns, rows) = (width.div_ceil(TILE), height.div_ceil(TILE));
    let bins = bin(&screen, columns, rows);
    let tiles: Vec<Tile> = bins
        .par_iter()
        .enumerate()
        .map(|(t, bin)| {
            let origin = [(t % columns) * TILE, (t / columns) * TILE];
            let size = [TILE.min(width - origin[0]), TILE.min(height - origin[1])];
            tile(&screen, bin, origin, size, samples)
        })
        .collect();
    gather(&tiles, columns, width, height)
}

/// Projects a face, clipping it when it reaches behind the eye or far out of the picture.
fn screen_faces(
    projector: &Projector,
    face: u32,
    corners: &[DVec3; 3],
    limits: [f64; 2],
    out: &mut Vec<ScreenFace>,
) {
    let camera = corners.map(|p| projector.to_camera(p));
    let near = projector.near_limit();
    if camera.iter().all(|c| c.z < near) {
        let on_screen = camera.map(|c| projector.camera_to_screen(c));
        if on_screen.iter().all(|s| s.at.abs().max_element() < GUARD) {
            out.extend(screen_face(face, on_screen, limits));
            return;
        }
    }
    // Rare: cut by the near plane, then by the guard band's sides in the picture.
    let mut polygon = clip(&camera, |c| near - c.z, DVec3::lerp);
    polygon.retain(|c| c.z <= near);
    let mut flat: Vec<OnScreen> = polygon.into_iter().map(|c| projector.camera_to_screen(c)).collect();
    let between = |a: OnScreen, b: OnScreen, t: f64| OnScreen {
        at: a.at.lerp(b.at, t),
        nearness: a.nearness + (b.nearness - a.nearness) * t,
    };
    for side in 0..4 {
        let (axis, sign) = (side / 2, if side % 2 == 0 { 1.0 } else { -1.0 });
        flat = clip(&flat, |s| 0.5 * GUARD - sign * s.at[axis], between);
    }
    for i in 2..flat.len() {
        out.extend(screen_face(face, [flat[0], flat[i - 1], flat[i]], limits));
    }
}

/// Keeps the part of a convex polygon where `inside` is not negative (Sutherland and Hodgman, 1974).
fn clip<P: Copy>(polygon: &[P], inside: impl Fn(&P) -> f64, between: impl Fn(P, P, f64) -> P) -> Vec<P> {
    let mut out = Vec::with_capacity(polygon.len() + 1);
    for i in 0..polygon.len() {
        let (p, q) = (polygon[i], polygon[(i + 1) % polygon.len()]);
        let (a, b) = (inside(&p), inside(&q));
        if a >= 0.0 {
            out.push(p);
        }
        if (a >= 0.0) != (b >= 0.0) {
            out.push(between(p, q, a / (a - b)));
        }
    }
    out
}

/// A face outside the picture, without area in it, or with a broken plane has nothing to show.
fn screen_face(face: u32, s: [OnScreen; 3], limits: [f64; 2]) -> Option<ScreenFace> {
    for (axis, limit) in limits.into_iter().enumerate() {
        let values = s.map(|p| p.at[axis]);
        let (lo, hi) = (values[0].min(values[1]).min(values[2]), values[0].max(values[1]).max(values[2]));
        if !(hi >= 0.0 && lo <= limit) {
            return None;
        }
    }
    let corners = s.map(|p| [(p.at.x * SNAP).round() as i64, (p.at.y * SNAP).round() as i64]);
    let [a, b, c] = corners;
    let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    if area == 0 {
        return None;
    }
    // Plane of nearness through the snapped corners, so that it agrees with the edge tests.
    let at = |p: [i64; 2]| DVec2::new(p[0] as f64 / SNAP, p[1] as f64 / SNAP);
    let (u, v) = (at(b) - at(a), at(c) - at(a));
    let det = u.perp_dot(v);
    let (du, dv) = (s[1].nearness - s[0].nearness, s[2].nearness - s[0].nearness);
    let gx = (du * v.y - dv * u.y) / det;
    let gy = (dv * u.x - du * v.x) / det;
    let base = s[0].nearness - gx * at(a).x - gy * at(a).y;
    if !(gx.is_finite() && gy.is_finite() && base.is_finite()) {
        return None;
    }
    let n = s.map(|p| p.nearness);
    let range = [n[0].min(n[1]).min(n[2]), n[0].max(n[1]).max(n[2])];
    let corners = if area > 0 { corners } else { [a, c, b] };
    Some(ScreenFace { face, corners, plane: [base, gx, gy], range })
}

/// Pixel columns (axis 0) or rows (axis 1) that a face can touch, from and to inclusive, possibly outside.
fn pixel_range(face: &ScreenFace, axis: usize) -> (i64, i64) {
    let values = face.corners.map(|c| c[axis]);
    let (lo, hi) = (values[0].min(values[1]).min(values[2]), values[0].max(values[1]).max(values[2]));
    (lo.div_euclid(SNAP as i64), hi.div_euclid(SNAP as i64))
}

/// The faces that may touch each tile, in face order.
fn bin(screen: &[ScreenFace], columns: usize, rows: usize) -> Vec<Vec<u32>> {
    let mut bins = vec![Vec::new(); columns * rows];
    let tile = TILE as i64;
    for (i, face) in screen.iter().enumerate() {
        let (x0, x1) = pixel_range(face, 0);
        let (y0, y1) = pixel_range(face, 1);
        let (x0, x1) = (x0.div_euclid(tile).max(0), x1.div_euclid(tile).min(columns as i64 - 1));
        let (y0, y1) = (y0.div_euclid(tile).max(0), y1.div_euclid(tile).min(rows as i64 - 1));
        for y in y0..=y1 {
            for x in x0..=x1 {
                bins[y as usize * columns + x as usize].push(i as u32);
            }
        }
    }
    bins
}

struct Tile {
    fragments: Vec<Fragment>,
    /// Fragments of each pixel, row by row.
    counts: Vec<u16>,
    nearness: Vec<f32>,
}

fn tile(
    screen: &[ScreenFace],
    bin: &[u32],
    origin: [usize; 2],
    size: [usize; 2],
    samples: &[[f32; 2]],
) -> Tile {
    let n = samples.len();
    let lanes = n.div_ceil(LANES);
    let pixels = size[0] * size[1];
    let mut near = vec![[f32::NEG_INFINITY; LANES]; pixels * lanes];
    let mut seen = vec![[u32::MAX; LANES]; pixels * lanes];
    if bin.is_empty() {
        return Tile {
            fragments: Vec::new(),
            counts: vec![0; pixels],
            nearness: vec![f32::NEG_INFINITY; pixels],
        };
    }
    let snapped: Vec<[i64; 2]> =
        samples.iter().map(|s| s.map(|x| (f64::from(x) * SNAP).round() as i64)).collect();
    let mut buffer = Buffer { origin, size, samples, snapped: &snapped, near: &mut near, seen: &mut seen };
    let mut narrow = Offsets::new(n);
    let mut wide = Offsets::new(n);
    for i in bin {
        let face = &screen[*i as usize];
        let within = |axis: usize| {
            let at = (origin[axis] * SNAP as usize) as i64;
            face.corners.iter().all(|c| (c[axis] - at).abs() <= NARROW)
        };
        if within(0) && within(1) {
            scan::<i32>(face, &mut buffer, &mut narrow);
        } else {
            scan::<i64>(face, &mut buffer, &mut wide);
        }
    }

    let mut out = Tile {
        fragments: Vec::new(),
        counts: Vec::with_capacity(pixels),
        nearness: Vec::with_capacity(pixels),
    };
    let middle = {
        let sum = samples.iter().fold([0.0; 2], |m, s| [m[0] + s[0], m[1] + s[1]]);
        sum.map(|x| x / n as f32)
    };
    for (seen, near) in seen.chunks_exact(lanes).zip(near.chunks_exact(lanes)) {
        let (seen, near) = (&seen.as_flattened()[..n], &near.as_flattened()[..n]);
        let first = out.fragments.len();
        // Most pixels see one thing.
        if seen.iter().all(|face| *face == seen[0]) {
            if seen[0] != u32::MAX {
                out.fragments.push(Fragment { face: seen[0], samples: n as u16, at: middle });
            }
        } else {
            for (face, at) in seen.iter().zip(samples) {
                if *face == u32::MAX {
                    continue;
                }
                match out.fragments[first..].iter_mut().find(|f| f.face == *face) {
                    Some(f) => {
                        f.samples += 1;
                        f.at = [f.at[0] + at[0], f.at[1] + at[1]];
                    }
                    None => out.fragments.push(Fragment { face: *face, samples: 1, at: *at }),
                }
            }
            for f in &mut out.fragments[first..] {
                f.at = f.at.map(|x| x / f32::from(f.samples));
            }
        }
        out.counts.push((out.fragments.len() - first) as u16);
        out.nearness.push(near.iter().copied().fold(f32::INFINITY, f32::min));
    }
    out
}

/// Faces whose corners are this near to the tile's origin (snapped units) are scanned in 32 bits: edge functions stay
/// below 2 x 2^15 x 2^14 = 2^30.
const NARROW: i64 = 1 << 14;

/// Integers of edge functions.
trait EdgeInt: Copy + Default + Ord + Add<Output = Self> + Mul<Output = Self> + BitOr<Output = Self> {
    fn of(x: i64) -> Self;
}

impl EdgeInt for i32 {
    fn of(x: i64) -> Self {
        x as i32
    }
}

impl EdgeInt for i64 {
    fn of(x: i64) -> Self {
        x
    }
}

/// A tile's samples while faces are written into it.
struct Buffer<'a> {
    origin: [usize; 2],
    size: [usize; 2],
    samples: &'a [[f32; 2]],
    snapped: &'a [[i64; 2]],
    near: &'a mut [[f32; LANES]],
    seen: &'a mut [[u32; LANES]],
}

/// Samples that are tried at once.
const LANES: usize = 4;

/// What a face's edge functions and nearness add at each sample of a pixel. Lanes beyond the last sample repeat it.
struct Offsets<T> {
    lanes: Vec<Lane<T>>,
}

#[derive(Clone, Copy)]
struct Lane<T> {
    edges: [[T; LANES]; 3],
    nearness: [f32; LANES],
}

impl<T: EdgeInt> Offsets<T> {
    fn new(samples: usize) -> Self {
        let lane = Lane { edges: [[T::default(); LANES]; 3], nearness: [0.0; LANES] };
        Self { lanes: vec![lane; samples.div_ceil(LANES)] }
    }
}

/// Writes one face into a tile's samples.
fn scan<T: EdgeInt>(face: &ScreenFace, tile: &mut Buffer, offsets: &mut Offsets<T>) {
    let unit = SNAP as i64;
    let n = tile.samples.len();
    let origin = tile.origin.map(|x| x as i64);
    let rows = |axis: usize| {
        let (lo, hi) = pixel_range(face, axis);
        ((lo - origin[axis]).max(0), (hi - origin[axis]).min(tile.size[axis] as i64 - 1))
    };
    let ((x0, x1), (y0, y1)) = (rows(0), rows(1));
    // Edge k at (x, y), not negative inside: ax * (x - px) + ay * (y - py).
    let (mut ax, mut ay, mut base) = ([0i64; 3], [0i64; 3], [T::default(); 3]);
    for k in 0..3 {
        let (p, q) = (face.corners[k], face.corners[(k + 1) % 3]);
        ax[k] = -(q[1] - p[1]);
        ay[k] = q[0] - p[0];
        let at = ax[k] * ((origin[0] + x0) * unit - p[0]) + ay[k] * ((origin[1] + y0) * unit - p[1]);
        base[k] = T::of(at);
    }
    let [z0, gx, gy] = face.plane;
    for (l, lane) in offsets.lanes.iter_mut().enumerate() {
        for i in 0..LANES {
            let s = (l * LANES + i).min(n - 1);
            let at = tile.snapped[s];
            for k in 0..3 {
                lane.edges[k][i] = T::of(ax[k] * at[0] + ay[k] * at[1]);
            }
            lane.nearness[i] =
                (gx * f64::from(tile.samples[s][0]) + gy * f64::from(tile.samples[s][1])) as f32;
        }
    }
    let (lo, hi) = (face.range[0] as f32, face.range[1] as f32);
    let step_x = ax.map(|a| T::of(a * unit));
    let step_y = ay.map(|a| T::of(a * unit));
    // Most that an edge function grows inside a pixel: tells pixels wholly outside.
    let growth = [0, 1, 2].map(|k| T::of((ax[k].max(0) + ay[k].max(0)) * unit));
    let zero = T::default();
    let lanes = &offsets.lanes[..];
    for y in y0..=y1 {
        let mut e = base;
        for x in x0..=x1 {
            let outside = (0..3).any(|k| e[k] + growth[k] < zero);
            if !outside {
                let corner = (z0 + gx * (origin[0] + x) as f64 + gy * (origin[1] + y) as f64) as f32;
                let first = (y as usize * tile.size[0] + x as usize) * lanes.len();
                let near = &mut tile.near[first..first + lanes.len()];
                let seen = &mut tile.seen[first..first + lanes.len()];
                for ((lane, near), seen) in lanes.iter().zip(near).zip(seen) {
                    // Without branches, so that all lanes are tried at once.
                    for i in 0..LANES {
                        let inside =
                            (e[0] + lane.edges[0][i]) | (e[1] + lane.edges[1][i]) | (e[2] + lane.edges[2][i]);
                        let z = corner + lane.nearness[i];
                        let z = if z > lo { z } else { lo };
                        let z = if z < hi { z } else { hi };
                        let wins = (inside >= zero) & (z > near[i]);
                        near[i] = if wins { z } else { near[i] };
                        seen[i] = if wins { face.face } else { seen[i] };
                    }
                }
            }
            for k in 0..3 {
                e[k] = e[k] + step_x[k];
            }
        }
        for k in 0..3 {
            base[k] = base[k] + step_y[k];
        }
    }
}

/// Puts the tiles together by pixel rows.
fn gather(tiles: &[Tile], columns: usize, width: usize, height: usize) -> Visible {
    let total = tiles.iter().map(|t| t.fragments.len()).sum();
    let mut out = Visible {
        fragments: Vec::with_capacity(total),
        starts: Vec::with_capacity(width * height + 1),
        nearness: Vec::with_capacity(width * height),
    };
    out.starts.push(0);
    let mut read = vec![0usize; tiles.len()];
    for y in 0..height {
        for column in 0..columns {
            let t = (y / TILE) * columns + column;
            let tile = &tiles[t];
            let w = TILE.min(width - column * TILE);
            for x in 0..w {
                let pixel = (y % TILE) * w + x;
                let count = tile.counts[pixel] as usize;
                out.fragments.extend_from_slice(&tile.fragments[read[t]..read[t] + count]);
                read[t] += count;
                out.starts.push(out.fragments.len() as u32);
                out.nearness.push(tile.nearness[pixel]);
            }
        }
    }
    out
}
