//! Short edges beside what was cut, which close as long as nothing changes by it.

use std::collections::{BTreeMap, BTreeSet};

use mesh_kernel::TriMesh;
use mesh_kernel::query::Adjacency;

use super::assemble::{Sheet, Source};
use super::places::Places;

/// Rounds of closing.
const ROUNDS: usize = 12;
/// Faces do not turn by more than the angle of this cosine when an edge closes, and those flatter than this, over their longest side, have no
/// direction to turn from.
const TURNED: f64 = 0.9;
const FLAT: f64 = 0.02;
/// A face hardly gets flatter if it keeps this share of its height.
const HARDLY: f64 = 0.9;
/// Joints are straight up to the angle of this cosine.
const STRAIGHT: f64 = 0.97;

/// Closes short edges between some places, as long as nothing changes by it: inside of pieces, and along joints and borders that go straight on.
pub(super) fn close_short(sheet: &mut Sheet, short: f64, places: &Places) {
    for _ in 0..ROUNDS {
        let near: Vec<bool> = sheet.positions.iter().map(|p| places.has(*p)).collect();
        let adjacency = Adjacency::new(&TriMesh::new(sheet.positions.clone(), sheet.faces.clone()));
        // Plane pieces stay in their planes.
        let is_crease = |half_edges: &[u32]| {
            let of = half_edges.iter().map(|h| sheet.sources[*h as usize / 3]);
            of.clone().any(|s| matches!(s, Source::Plane(_)))
                && of.clone().any(|s| Some(s) != of.clone().next())
        };
        // Beyond which nodes, and how many faces there are at the edge to them.
        let mut lines: BTreeMap<u32, Vec<(u32, usize)>> = BTreeMap::new();
        let mut about: BTreeMap<u32, BTreeSet<u32>> = BTreeMap::new();
        let mut edges: Vec<(f64, [u32; 2])> = Vec::new();
        for (e, &[a, b]) in (0u32..).zip(adjacency.edges()) {
            let half_edges = adjacency.half_edges(e);
            for [v, w] in [[a, b], [b, a]] {
                if near[v as usize] {
                    about.entry(v).or_default().insert(w);
                    if half_edges.len() != 2 || is_crease(half_edges) {
                        lines.entry(v).or_default().push((w, half_edges.len()));
                    }
                }
            }
            let length = sheet.positions[a as usize].distance(sheet.positions[b as usize]);
            if near[a as usize] && near[b as usize] && length < short {
                edges.push((length, [a, b]));
            }
        }
        let mut star: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for (f, face) in (0u32..).zip(&sheet.faces) {
            face.iter().filter(|v| near[**v as usize]).for_each(|v| star.entry(*v).or_default().push(f));
        }
        edges.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut touched: BTreeSet<u32> = BTreeSet::new();
        let mut closed: BTreeMap<u32, u32> = BTreeMap::new();
        for (_, [a, b]) in edges {
            for [gone, stays] in [[a, b], [b, a]] {
                let free = about[&gone].iter().chain(&about[&stays]).all(|v| !touched.contains(v));
                let on_line = lines.get(&gone).map(Vec::as_slice).unwrap_or_default();
                if free
                    && goes_on(sheet, on_line, gone, stays)
                    && keeps_shape(sheet, &star[&gone], &about, gone, stays)
                {
                    touched.extend(about[&gone].iter().chain(&about[&stays]));
                    closed.insert(gone, stays);
                    break;
                }
            }
        }
        if closed.is_empty() {
            return;
        }
        let (faces, sources) = (std::mem::take(&mut sheet.faces), std::mem::take(&mut sheet.sources));
        for (face, source) in faces.into_iter().zip(sources) {
            let face = face.map(|v| closed.get(&v).copied().unwrap_or(v));
            if face[0] != face[1] && face[1] != face[2] && face[2] != face[0] {
                sheet.faces.push(face);
                sheet.sources.push(source);
            }
        }
    }
}

/// Whether a node is inside of a piece, or on a joint or border that goes straight on from another node over it.
fn goes_on(sheet: &Sheet, lines: &[(u32, usize)], gone: u32, stays: u32) -> bool {
    let at = |v: u32| sheet.positions[v as usize];
    match *lines {
        [] => true,
        [(v, m), (w, n)] => {
            let turn = (at(gone) - at(v)).normalize_or_zero().dot((at(w) - at(gone)).normalize_or_zero());
            m == n && (v == stays || w == stays) && turn > STRAIGHT
        }
        _ => false,
    }
}

/// Whether the faces about a node turn hardly when it goes to another, and no two become one.
fn keeps_shape(
    sheet: &Sheet,
    star: &[u32],
    about: &BTreeMap<u32, BTreeSet<u32>>,
    gone: u32,
    stays: u32,
) -> bool {
    let faces = || star.iter().map(|f| sheet.faces[*f as usize]);
    let opposite: BTreeSet<u32> =
        faces().filter(|f| f.contains(&stays)).flatten().filter(|v| *v != gone && *v != stays).collect();
    let common: BTreeSet<u32> = about[&gone].intersection(&about[&stays]).copied().collect();
    common == opposite
        && faces().filter(|f| !f.contains(&stays)).all(|face| {
            let area = |face: [u32; 3]| {
                let [a, b, c] = face.map(|v| sheet.positions[v as usize]);
                let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
                let area = (b - a).cross(c - a);
                (area.normalize_or_zero(), area.length() / (longest * longest).max(f64::MIN_POSITIVE))
            };
            let (was, is) = (area(face), area(face.map(|v| if v == gone { stays } else { v })));
            was.0.dot(is.0) > TURNED && is.1 > FLAT.min(HARDLY * was.1) || was.1 < FLAT && is.1 > was.1
        })
}
