//! Cutting the half surface flat at the plates.

use std::collections::BTreeMap;

use mesh_kernel::glam::DVec3;

use super::field::Cut;
use super::patch::Patch;
use super::polygonize::HalfSurface;

/// Removes what lies over each plane within its window and closes the cut with a fan, labelled 1 + its index.
pub(super) fn clip(surface: HalfSurface, cuts: &[Cut]) -> Patch {
    let HalfSurface { mut positions, mut faces } = surface;
    let mut label = vec![0u8; faces.len()];
    for (i, cut) in cuts.iter().enumerate() {
        let over: Vec<bool> = positions.iter().map(|&p| cut.over(p) > 0.0).collect();
        let within: Vec<bool> =
            positions.iter().map(|p| (cut.window[0]..=cut.window[1]).contains(&p.y)).collect();
        let mut middle: BTreeMap<(u32, u32), u32> = BTreeMap::new();
        let (mut kept, mut kept_label) = (Vec::with_capacity(faces.len()), Vec::with_capacity(faces.len()));
        let mut rim: Vec<[u32; 2]> = Vec::new();
        for (face, &l) in faces.iter().zip(&label) {
            let outside = face.map(|v| over[v as usize]);
            let count = outside.iter().filter(|&&o| o).count();
            if count == 0 || !face.iter().all(|&v| within[v as usize]) {
                kept.push(*face);
                kept_label.push(l);
                continue;
            }
            if count == 3 {
                continue;
            }
            // Turn the odd corner to the front.
            let odd = (0..3).find(|&c| outside[c] == (count == 1)).unwrap_or(0);
            let [a, b, c] = [0, 1, 2].map(|k| face[(odd + k) % 3]);
            let mut cross = |p: u32, q: u32| {
                *middle.entry((p.min(q), p.max(q))).or_insert_with(|| {
                    let (lo, hi) = (positions[p.min(q) as usize], positions[p.max(q) as usize]);
                    let (f, g) = (cut.over(lo), cut.over(hi));
                    positions.push(lo.lerp(hi, f / (f - g)));
                    positions.len() as u32 - 1
                })
            };
            let (ab, ca) = (cross(a, b), cross(c, a));
            if count == 1 {
                kept.extend([[ab, b, c], [ab, c, ca]]);
                kept_label.extend([l, l]);
                rim.push([ca, ab]);
            } else {
                kept.push([a, ab, ca]);
                kept_label.push(l);
                rim.push([ab, ca]);
            }
        }
        if !rim.is_empty() {
            // The middle of the opening; a half opening has its middle in the plane of symmetry.
            let open = rim.iter().flatten().any(|&v| positions[v as usize].x == 0.0);
            let (mut sum, mut weight) = (DVec3::ZERO, 0.0);
            for [a, b] in &rim {
                let (a, b) = (positions[*a as usize], positions[*b as usize]);
                sum += 0.5 * (a + b) * a.distance(b);
                weight += a.distance(b);
            }
            let mut centre = sum / weight;
            if open {
                centre.x = 0.0;
            }
            centre -= cut.normal * cut.over(centre);
            let hub = positions.len() as u32;
            positions.push(centre);
            for [a, b] in rim {
                kept.push([b, a, hub]);
                kept_label.push(1 + i as u8);
            }
        }
        faces = kept;
        label = kept_label;
    }
    Patch::new(positions, faces, label)
}
