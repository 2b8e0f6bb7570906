//! Even triangles: split, collapse, flip, relax (Botsch and Kobbelt 2004), with the rims of the plates and the plane of
//! symmetry kept.

use mesh_kernel::glam::DVec3;
use rayon::prelude::*;

use super::field::Field;
use super::patch::{NONE, Patch, previous};

/// What holds a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Hold {
    /// Moves in its surface.
    Free,
    /// Moves along its rim or the centre line.
    Line,
    /// Stays.
    Corner,
}

/// Brings all edges near `length` mm; the skin stays on the field's zero set.
pub(super) fn remesh(patch: &mut Patch, field: &Field, length: f64, rounds: usize) {
    for round in 0..rounds {
        collapse_short(patch, 0.78 * length, 1.30 * length);
        patch.connect();
        split_long(patch, 1.36 * length);
        flip_to_regular(patch);
        let steps = if round + 1 == rounds { 4 } else { 2 };
        for _ in 0..steps {
            relax(patch, field, 1);
        }
    }
    flip_to_regular(patch);
    relax(patch, field, 3);
    patch.connect();
}

fn holds(patch: &Patch) -> Vec<Hold> {
    let mut count = vec![0u8; patch.positions.len()];
    for e in 0..patch.twin.len() as u32 {
        if patch.is_dead(e / 3) {
            continue;
        }
        let t = patch.twin[e as usize];
        if (t == NONE || e < t) && patch.is_feature(e) {
            count[patch.from(e) as usize] += 1;
            count[patch.to(e) as usize] += 1;
        }
    }
    count
        .into_iter()
        .map(|n| match n {
            0 => Hold::Free,
            2 => Hold::Line,
            _ => Hold::Corner,
        })
        .collect()
}

fn collapse_short(patch: &mut Patch, short: f64, long: f64) {
    let mut hold = holds(patch);
    let (mut fan, mut ring, mut other) = (Vec::new(), Vec::new(), Vec::new());
    // Twice: a merge may leave another short edge behind.
    for _ in 0..2 {
        for e in 0..patch.twin.len() as u32 {
            if patch.is_dead(e / 3) || patch.length(e) >= short {
                continue;
            }
            let (v, w) = (patch.from(e), patch.to(e));
            let (hv, hw) = (hold[v as usize], hold[w as usize]);
            let feature = patch.is_feature(e);
            let allowed = match (hv, hw) {
                (Hold::Corner, _) => false,
                (Hold::Free, _) => true,
                (Hold::Line, _) => feature,
            };
            if !allowed || !patch.may_collapse(e, &mut ring, &mut other) {
                continue;
            }
            let middle = hv == hw && hv != Hold::Corner;
            let goal = if middle {
                0.5 * (patch.positions[v as usize] + patch.positions[w as usize])
            } else {
                patch.positions[w as usize]
            };
            let fits = |u: u32, skip: u32, fan: &[u32]| {
                fan.iter().all(|&g| {
                    let (p, q) = (patch.to(g), patch.from(previous(g)));
                    if p == skip || q == skip {
                        return true;
                    }
                    let [a, b, c] = [
                        patch.positions[u as usize],
                        patch.positions[p as usize],
                        patch.positions[q as usize],
                    ];
                    let (old, new) = ((b - a).cross(c - a), (b - goal).cross(c - goal));
                    goal.distance(b) < long
                        && goal.distance(c) < long
                        && (new.dot(old) > 0.5 * new.length() * old.length() || old.length_squared() < 1e-9)
                        && new.length() > 1e-3 * short * short
                })
            };
            patch.fan(w, &mut fan);
            let w_fits = !middle || fits(w, v, &fan);
            patch.fan(v, &mut fan);
            if !w_fits || !fits(v, w, &fan) {
                continue;
            }
            patch.collapse(e, &fan);
            patch.positions[w as usize] = goal;
            hold[v as usize] = Hold::Corner;
        }
    }
}

/// Longest first, so that fans become rings before they become slivers.
fn split_long(patch: &mut Patch, long: f64) {
    let edges = |patch: &Patch| (0..patch.twin.len() as u32).map(|e| patch.length(e)).fold(0.0, f64::max);
    let mut limit = edges(patch);
    while limit > long {
        limit = (0.7 * limit).max(long);
        for e in 0..patch.twin.len() as u32 {
            let t = patch.twin[e as usize];
            if (t == NONE || e < t) && patch.length(e) > limit {
                let middle =
                    0.5 * (patch.positions[patch.from(e) as usize] + patch.positions[patch.to(e) as usize]);
                patch.split(e, middle);
            }
        }
        limit = edges(patch).min(limit);
    }
}

/// Flips edges while that brings valences nearer to six (four in the plane of symmetry).
fn flip_to_regular(patch: &mut Patch) {
    let mut valence = vec![0i32; patch.positions.len()];
    for e in 0..patch.twin.len() as u32 {
        let t = patch.twin[e as usize];
        if t == NONE || e < t {
            valence[patch.from(e) as usize] += 1;
            valence[patch.to(e) as usize] += 1;
        }
    }
    let hold = holds(patch);
    let best: Vec<i32> = (0..patch.positions.len() as u32)
        .map(|v| if patch.on_border(v) { if hold[v as usize] == Hold::Corner { 3 } else { 4 } } else { 6 })
        .collect();
    let mut ring = Vec::new();
    for _ in 0..3 {
        let mut flips = 0;
        for e in 0..patch.twin.len() as u32 {
            let t = patch.twin[e as usize];
            if t == NONE || e > t || patch.is_feature(e) {
                continue;
            }
            let [a, b, c, d] = [patch.from(e), patch.to(e), patch.from(previous(e)), patch.from(previous(t))];
            let off = |v: u32, change: i32| {
                let x = valence[v as usize] + change - best[v as usize];
                x * x
            };
            let now = off(a, 0) + off(b, 0) + off(c, 0) + off(d, 0);
            let then = off(a, -1) + off(b, -1) + off(c, 1) + off(d, 1);
            let worst = |t: [[u32; 3]; 2]| t.map(|t| patch.quality(t)).into_iter().fold(f64::MAX, f64::min);
            let (old, new) = (worst([[a, b, c], [b, a, d]]), worst([[a, d, c], [d, b, c]]));
            // Fewer odd valences, but no sliver for it; and slivers go whatever the valence.
            let better = (then < now && new > (0.5 * old).min(0.3))
                || (then <= now + 4 && old < 0.3 && new > 1.5 * old);
            if !better {
                continue;
            }
            let side = patch.normal(e / 3) + patch.normal(t / 3);
            let area = |t: [u32; 3]| {
                let [p, q, r] = t.map(|v| patch.positions[v as usize]);
                (q - p).cross(r - p)
            };
            let (one, two) = (area([a, d, c]), area([d, b, c]));
            let upright = |n: DVec3| n.dot(side) > 0.3 * n.length() * side.length();
            if !upright(one) || !upright(two) {
                continue;
            }
            patch.ring(c, &mut ring);
            if ring.contains(&d) || valence[a as usize] <= 3 || valence[b as usize] <= 3 {
                continue;
            }
            patch.flip(e);
            for (v, change) in [(a, -1), (b, -1), (c, 1), (d, 1)] {
                valence[v as usize] += change;
            }
            flips += 1;
        }
        if flips == 0 {
            return;
        }
    }
}

/// One step of every node towards the middle of its neighbours, within what holds it, then back to the surface.
fn relax(patch: &mut Patch, field: &Field, projections: usize) {
    let hold = holds(patch);
    step(patch, field, projections, &hold);
}

/// Moves every node to the surface by so many steps, within the planes that hold it.
pub(super) fn onto(patch: &mut Patch, field: &Field, projections: usize) {
    let hold = vec![Hold::Corner; patch.positions.len()];
    step(patch, field, projections, &hold);
}

fn step(patch: &mut Patch, field: &Field, projections: usize, hold: &[Hold]) {
    let moved: Vec<DVec3> = (0..patch.positions.len() as u32)
        .into_par_iter()
        .with_min_len(256)
        .map_init(
            || (Vec::new(), Vec::new()),
            |(fan, ring), v| {
                let p = patch.positions[v as usize];
                patch.fan(v, fan);
                let closing = patch.closing(fan);
                let (mut normal, mut skin, mut plate) = (DVec3::ZERO, false, None);
                for &e in fan.iter() {
                    match patch.label[(e / 3) as usize] {
                        0 => {
                            skin = true;
                            normal += patch.normal(e / 3);
                        }
                        l => plate = Some(l as usize - 1),
                    }
                }
                let normal = normal.normalize_or_zero();
                let mut q = p;
                match hold[v as usize] {
                    Hold::Corner => {}
                    Hold::Line => {
                        let (mut sum, mut n) = (DVec3::ZERO, 0);
                        for &e in fan.iter() {
                            if patch.is_feature(e) {
                                sum += patch.positions[patch.to(e) as usize];
                                n += 1;
                            }
                        }
                        if let Some(e) = closing {
                            sum += patch.positions[patch.from(e) as usize];
                            n += 1;
                        }
                        if n == 2 {
                            q = p.lerp(0.5 * sum, 0.5);
                        }
                    }
                    Hold::Free => {
                        patch.ring(v, ring);
                        let mean = ring.iter().map(|&u| patch.positions[u as usize]).sum::<DVec3>()
                            / ring.len() as f64;
                        let mut d = mean - p;
                        if skin {
                            d -= normal * d.dot(normal);
                        }
                        q = p + 0.6 * d;
                    }
                }
                project(field, q, normal, skin, plate, closing.is_some(), projections)
            },
        )
        .collect();
    patch.positions = moved;
}

/// Onto the skin, the plate and the plane of symmetry, as far as they hold the node.
fn project(
    field: &Field,
    mut q: DVec3,
    normal: DVec3,
    skin: bool,
    plate: Option<usize>,
    middle: bool,
    times: usize,
) -> DVec3 {
    let cut = plate.map(|i| field.cuts[i]);
    for _ in 0..times {
        if skin {
            // Along the normal, within the plane(s) that the node may move in.
            let mut along = normal;
            if let Some(cut) = cut {
                along -= cut.normal * along.dot(cut.normal);
            }
            if middle {
                along.x = 0.0;
                if let Some(cut) = cut {
                    // Both at once: the line that the planes share.
                    let line = DVec3::X.cross(cut.normal).normalize_or_zero();
                    along = line * normal.dot(line);
                }
            }
            let grip = along.dot(normal);
            if grip > 1e-3 {
                let step = field.bare(q) / grip;
                q -= along * step.clamp(-6.0, 6.0);
            }
        }
        if let Some(cut) = cut {
            q -= cut.normal * cut.over(q);
        }
        if middle {
            q.x = 0.0;
        } else {
            q.x = q.x.max(1e-3);
        }
    }
    q
}

/// Total area, mm².
pub(super) fn area(patch: &Patch) -> f64 {
    (0..patch.faces.len() as u32).map(|f| 0.5 * patch.normal(f).length()).sum()
}
