//! Arm plates of dress forms: flat ends where arms would be.

use std::collections::BTreeMap;

use mesh_kernel::TriMesh;
use mesh_kernel::glam::DVec3;

use super::figure::Side;

/// Faces tried as part of the plate.
const SEEDS: usize = 120;

/// The upper and lower end of a plate.
pub(crate) struct ArmPlate {
    pub(crate) top: DVec3,
    pub(crate) bottom: DVec3,
}

struct Facet {
    centre: DVec3,
    normal: DVec3,
    area: f64,
    face: u32,
}

/// The largest flat patch that faces sideways between two heights, if it has the size of an armhole. O(faces).
pub(crate) fn arm_plate(mesh: &TriMesh, side: Side, low: f64, high: f64, stature: f64) -> Option<ArmPlate> {
    let s = side.sign();
    let mut facets: Vec<Facet> = (0..mesh.faces.len() as u32)
        .filter_map(|face| {
            let [a, b, c] = mesh.corners(face);
            let centre = (a + b + c) / 3.0;
            let twice = mesh.area_normal(face);
            let area = twice.length() / 2.0;
            let normal = twice / (2.0 * area);
            let candidate =
                centre.x * s > 0.03 * stature && normal.x * s > 0.75 && (low..high).contains(&centre.y);
            candidate.then_some(Facet { centre, normal, area, face })
        })
        .collect();
    facets.sort_by(|a, b| b.area.total_cmp(&a.area).then(a.face.cmp(&b.face)));
    let gather = |normal: DVec3, point: DVec3, cosine: f64, gap: f64| {
        facets
            .iter()
            .filter(|f| f.normal.dot(normal) > cosine && (f.centre - point).dot(normal).abs() < gap)
            .collect::<Vec<_>>()
    };
    let stride = facets.len().div_ceil(SEEDS).max(1);
    let seed = facets
        .iter()
        .step_by(stride)
        .map(|f| (gather(f.normal, f.centre, 0.998, 1.5).iter().map(|g| g.area).sum::<f64>(), f))
        .max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.face.cmp(&a.1.face)))?
        .1;
    let first = gather(seed.normal, seed.centre, 0.998, 1.5);
    let normal = first.iter().map(|f| f.normal * f.area).sum::<DVec3>().normalize();
    let area: f64 = first.iter().map(|f| f.area).sum();
    let point = first.iter().map(|f| f.centre * f.area).sum::<DVec3>() / area;
    let patch = connected(mesh, gather(normal, point, 0.995, 2.0));
    if patch.iter().map(|f| f.area).sum::<f64>() < 0.0009 * stature * stature {
        return None;
    }
    let nodes: Vec<DVec3> = patch.iter().flat_map(|f| mesh.corners(f.face)).collect();
    // Averaged over the outermost 3 mm, so that one node does not decide about the depth.
    let end = |sign: f64| {
        let far = nodes.iter().map(|p| p.y * sign).fold(f64::NEG_INFINITY, f64::max);
        let near: Vec<DVec3> = nodes.iter().copied().filter(|p| p.y * sign > far - 3.0).collect();
        let mean = near.iter().sum::<DVec3>() / near.len() as f64;
        DVec3::new(mean.x, far * sign, mean.z)
    };
    let (top, bottom) = (end(1.0), end(-1.0));
    let depth = nodes.iter().map(|p| p.z).fold(f64::NEG_INFINITY, f64::max)
        - nodes.iter().map(|p| p.z).fold(f64::INFINITY, f64::min);
    // An armhole is about as deep as it is high; a strip of a flank is not.
    let tall = top.y - bottom.y;
    (tall > 0.035 * stature && depth > 0.4 * tall).then_some(ArmPlate { top, bottom })
}

/// The largest part of a patch that hangs together by nodes.
fn connected<'a>(mesh: &TriMesh, patch: Vec<&'a Facet>) -> Vec<&'a Facet> {
    let mut at_node: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (i, f) in patch.iter().enumerate() {
        for v in mesh.faces[f.face as usize] {
            at_node.entry(v).or_default().push(i);
        }
    }
    let mut part = vec![usize::MAX; patch.len()];
    let mut best = (0.0, 0);
    for start in 0..patch.len() {
        if part[start] != usize::MAX {
            continue;
        }
        part[start] = start;
        let mut stack = vec![start];
        let mut area = 0.0;
        while let Some(i) = stack.pop() {
            area += patch[i].area;
            for v in mesh.faces[patch[i].face as usize] {
                for &j in &at_node[&v] {
                    if part[j] == usize::MAX {
                        part[j] = start;
                        stack.push(j);
                    }
                }
            }
        }
        if area > best.0 {
            best = (area, start);
        }
    }
    patch.into_iter().zip(part).filter(|(_, p)| *p == best.1).map(|(f, _)| f).collect()
}
