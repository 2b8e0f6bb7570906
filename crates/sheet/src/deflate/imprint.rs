//! Walls that end on round ones which know nothing of them.
//!
//! Of the two sides of a round wall one is kept, with the edges of what stands on it. Webs on the other side end on its middle all the same, up
//! to the chords of both: they are drawn out a little, merged with it, and what sticks out beyond is cut off.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;
use mesh_kernel::TriMesh;
use mesh_kernel::merge::{MergeOptions, merge};
use mesh_kernel::query::RayCaster;
use rayon::prelude::*;

use super::assemble::{Sheet, Source};
use super::seams::Merged;

/// How far beside a border the face may be that it should be on, over the thickness of walls.
const BESIDE: f64 = 0.35;
/// Borders are drawn out by so many times this.
const DRAWN_OUT: f64 = 2.0;
/// What is farther out than so many times this is cut off.
const BEYOND: f64 = 1.5;
/// Looks along a face begin this share of the way beside it, and no farther back than this share of the face; those for the skin begin this
/// share of the way back.
const ASIDE: f64 = 1e-3;
const WITHIN: f64 = 0.5;
const ASIDE_SKIN: f64 = 0.02;
/// Borders end on faces that they run into at a sine of more than this.
const STEEP: f64 = 0.5;
/// What sticks out is less than this share of what borders were drawn out.
const STICKS_OUT: f64 = 0.75;
/// Edges that cutting left and that are shorter than this share of the wanted length close; without one, than this share of the thickness.
const SHORT: f64 = 0.4;
const SHORT_ANYWAY: f64 = 0.15;
/// Rounds of closing.
const ROUNDS: usize = 12;
/// Faces do not turn by more than the angle of this cosine when an edge closes, and those flatter than this, over their longest side, have no
/// direction to turn from.
const TURNED: f64 = 0.9;
const FLAT: f64 = 0.02;
/// Joints are straight up to the angle of this cosine.
const STRAIGHT: f64 = 0.97;
/// What was in one place before is so to this share of the way after.
const SAME: f64 = 1e-6;

/// A free edge that ends beside a face.
#[derive(Clone, Copy, Debug)]
struct Loose {
    /// As its face goes along it.
    ends: [u32; 2],
    face: u32,
    /// In the face, away from it.
    away: DVec3,
}

/// The sheet with its loose borders on the faces beside them; `None` if there are none, or if more than these would change. O(n log n).
pub(super) fn imprinted(sheet: &Sheet, beside: &Beside, edge_length: Option<f64>) -> Option<Sheet> {
    let reach = BESIDE * beside.thickness;
    let short = edge_length.map_or(SHORT_ANYWAY * beside.thickness, |length| SHORT * length);
    let mesh = TriMesh::new(sheet.positions.clone(), sheet.faces.clone());
    let uses = Uses::new(&sheet.faces);
    let loose = beside.loose_edges(&mesh, &uses);
    if loose.is_empty() {
        return None;
    }
    let (mesh, flaps) = with_flaps(mesh, &uses, &loose, DRAWN_OUT * reach);
    let old = sheet.faces.len() as u32;
    let merged = merge(&[&mesh], &MergeOptions::default()).ok()?;
    // Nothing else may have been cut.
    let segments: Vec<[DVec3; 2]> =
        loose.iter().map(|l| l.ends.map(|v| mesh.positions[v as usize])).collect();
    let known = Places::new(&mesh.positions, SAME * reach);
    let near = Places::along(&segments, DRAWN_OUT * reach);
    if !merged.positions.iter().all(|p| known.has(*p) || near.has(*p)) {
        return None;
    }
    let parent = |f: u32| merged.parents(f).first().map(|parent| (parent.face, parent.reversed));
    // Pieces between joints; those that reach the far ends of flaps are cut off.
    let uses = Uses::new(&merged.faces);
    let mut pieces = Merged::new(merged.faces.len());
    for edge in uses.edges() {
        if let [(_, f), (_, g)] = *edge {
            pieces.join(f, g);
        }
    }
    let mut cut_off = BTreeSet::new();
    for edge in uses.edges() {
        let [([a, b], f)] = *edge else { continue };
        let Some(flap) = parent(f).and_then(|(f, _)| flaps.get(f.checked_sub(old)? as usize)) else {
            continue;
        };
        let out =
            |v: u32| (merged.positions[v as usize] - mesh.positions[flap.ends[0] as usize]).dot(flap.away);
        if out(a).max(out(b)) > BEYOND * reach {
            cut_off.insert(pieces.find(f));
        }
    }
    let mut made = Sheet { positions: merged.positions.clone(), ..sheet.clone() };
    made.faces.clear();
    made.sources.clear();
    let (mut lost, mut lost_flaps) = (0.0, 0.0);
    for (f, &face) in (0u32..).zip(&merged.faces) {
        let (of, reversed) = parent(f)?;
        let flap = of.checked_sub(old).and_then(|k| flaps.get(k as usize));
        if cut_off.contains(&pieces.find(f)) {
            let [a, b, c] = face.map(|v| merged.positions[v as usize]);
            let area = (b - a).cross(c - a).length();
            *(if flap.is_some() { &mut lost_flaps } else { &mut lost }) += area;
            continue;
        }
        made.faces.push(if reversed { [face[0], face[2], face[1]] } else { face });
        made.sources.push(sheet.sources[flap.map_or(of, |flap| flap.face) as usize]);
    }
    // Only ends stick out.
    if lost > STICKS_OUT * lost_flaps {
        return None;
    }
    close_short(&mut made, short, &Places::along(&segments, short / SHORT));
    Some(made.without_unused_nodes())
}

/// The edges with their faces, in order.
struct Uses(Vec<([u32; 2], u32)>);

impl Uses {
    /// O(n log n).
    fn new(faces: &[[u32; 3]]) -> Self {
        let of_face = |f: u32| {
            let [a, b, c] = faces[f as usize];
            [[a, b], [b, c], [c, a]].map(|[p, q]| ([p.min(q), p.max(q)], f))
        };
        let mut uses: Vec<([u32; 2], u32)> = (0..faces.len() as u32).flat_map(of_face).collect();
        uses.par_sort_unstable();
        Self(uses)
    }

    /// The faces of every edge, one edge after the other.
    fn edges(&self) -> impl Iterator<Item = &[([u32; 2], u32)]> {
        self.0.chunk_by(|a, b| a.0 == b.0)
    }
}

/// What tells whether borders end beside faces.
pub(super) struct Beside<'a> {
    /// Rays that the faces of the sheet stop.
    pub(super) sheet: &'a RayCaster,
    /// And those of the solid's skin.
    pub(super) skin: &'a RayCaster,
    /// How thick walls are, in mm.
    pub(super) thickness: f64,
}

impl Beside<'_> {
    /// How long the borders are that end beside a face, in mm. O(n log n).
    pub(super) fn loose_length(&self, sheet: &Sheet) -> f64 {
        let mesh = TriMesh::new(sheet.positions.clone(), sheet.faces.clone());
        let loose = self.loose_edges(&mesh, &Uses::new(&sheet.faces));
        let length = |l: &Loose| {
            let [p, q] = l.ends.map(|v| mesh.positions[v as usize]);
            p.distance(q)
        };
        loose.iter().map(length).sum()
    }

    /// Free edges from the middles of which another face is met within some way through the material, on or off the own one.
    fn loose_edges(&self, mesh: &TriMesh, uses: &Uses) -> Vec<Loose> {
        let reach = BESIDE * self.thickness;
        let mut loose = Vec::new();
        for edge in uses.edges() {
            let [([a, b], face)] = *edge else { continue };
            let nodes = mesh.faces[face as usize];
            let forward = (0..3).any(|k| [nodes[k], nodes[(k + 1) % 3]] == [a, b]);
            let ends = if forward { [a, b] } else { [b, a] };
            let [p, q] = ends.map(|v| mesh.positions[v as usize]);
            let across = mesh.area_normal(face);
            let Some(normal) = across.try_normalize() else { continue };
            let Some(away) = (q - p).cross(normal).try_normalize() else { continue };
            // Not from behind the face: a low web stands on what is there.
            let back = reach.min(WITHIN * across.length() / p.distance(q));
            let middle = p.midpoint(q);
            let from = middle - away * back + normal * (ASIDE * reach);
            let Some(hit) = self.sheet.first(from, away, 0.0, back + reach) else { continue };
            let common = mesh.faces[hit.face as usize].iter().filter(|v| nodes.contains(v)).count();
            // What is as good as parallel is a wall beside it, not one that it ends on; nor is one beyond a gap.
            let other = mesh.area_normal(hit.face).normalize_or_zero();
            let start = back.min(ASIDE_SKIN * reach);
            let to = hit.distance - back;
            let inside = |from: f64, to: f64| {
                self.skin
                    .first(middle + away * from, away * (to - from).signum(), 0.0, (to - from).abs())
                    .is_none()
            };
            if common < 2 && other.dot(away).abs() > STEEP && inside(-start, to) {
                loose.push(Loose { ends, face, away });
            }
        }
        loose
    }
}

/// The mesh with a strip along every loose edge; strips run out where borders end on something else.
fn with_flaps(mut mesh: TriMesh, uses: &Uses, loose: &[Loose], width: f64) -> (TriMesh, Vec<Loose>) {
    let joints = uses.edges().filter(|edge| edge.len() > 2);
    let joined: BTreeSet<u32> = joints.flat_map(|edge| edge[0].0).collect();
    let mut away: BTreeMap<u32, DVec3> = BTreeMap::new();
    for edge in loose {
        edge.ends.iter().for_each(|v| *away.entry(*v).or_default() += edge.away);
    }
    let mut outer: BTreeMap<u32, u32> = BTreeMap::new();
    for (v, away) in away {
        if !joined.contains(&v) {
            outer.insert(v, mesh.positions.len() as u32);
            mesh.positions.push(mesh.positions[v as usize] + away.normalize_or_zero() * width);
        }
    }
    let mut flaps = Vec::new();
    for edge in loose {
        let [a, b] = edge.ends;
        let faces = match (outer.get(&a), outer.get(&b)) {
            (Some(&p), Some(&q)) => vec![[b, a, p], [b, p, q]],
            (Some(&p), None) => vec![[b, a, p]],
            (None, Some(&q)) => vec![[b, a, q]],
            (None, None) => continue,
        };
        flaps.extend(faces.iter().map(|_| *edge));
        mesh.faces.extend(faces);
    }
    (mesh, flaps)
}

/// Closes short edges between some places, as long as nothing changes by it: inside of pieces, and along joints and borders that go straight on.
fn close_short(sheet: &mut Sheet, short: f64, places: &Places) {
    for _ in 0..ROUNDS {
        let near: Vec<bool> = sheet.positions.iter().map(|p| places.has(*p)).collect();
        let uses = Uses::new(&sheet.faces);
        // Plane pieces stay in their planes.
        let is_crease = |edge: &[([u32; 2], u32)]| {
            let of = edge.iter().map(|(_, f)| sheet.sources[*f as usize]);
            of.clone().any(|s| matches!(s, Source::Plane(_)))
                && of.clone().any(|s| Some(s) != of.clone().next())
        };
        // Beyond which nodes, and how many faces there are at the edge to them.
        let mut lines: BTreeMap<u32, Vec<(u32, usize)>> = BTreeMap::new();
        let mut about: BTreeMap<u32, BTreeSet<u32>> = BTreeMap::new();
        let mut edges: Vec<(f64, [u32; 2])> = Vec::new();
        for edge in uses.edges() {
            let [a, b] = edge[0].0;
            for [v, w] in [[a, b], [b, a]] {
                if near[v as usize] {
                    about.entry(v).or_default().insert(w);
                    if edge.len() != 2 || is_crease(edge) {
                        lines.entry(v).or_default().push((w, edge.len()));
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
            was.0.dot(is.0) > TURNED && is.1 > FLAT.min(was.1) || was.1 < FLAT && is.1 > was.1
        })
}

/// Places, to be found from near by.
struct Places {
    cells: BTreeSet<[i64; 3]>,
    size: f64,
}

impl Places {
    fn new(positions: &[DVec3], size: f64) -> Self {
        let cell = |p: &DVec3| (*p / size).round().to_array().map(|x| x as i64);
        Self { cells: positions.iter().map(cell).collect(), size }
    }

    /// All along some segments.
    fn along(segments: &[[DVec3; 2]], size: f64) -> Self {
        let points = |[a, b]: &[DVec3; 2]| {
            let count = (a.distance(*b) / size).ceil().max(1.0);
            let (a, b) = (*a, *b);
            (0..=count as u32).map(move |k| a.lerp(b, f64::from(k) / count))
        };
        Self::new(&segments.iter().flat_map(points).collect::<Vec<_>>(), size)
    }

    /// Whether one is nearer than the size, or not much farther.
    fn has(&self, p: DVec3) -> bool {
        let [x, y, z] = (p / self.size).round().to_array().map(|x| x as i64);
        let near = [-1, 0, 1];
        near.iter()
            .any(|i| near.iter().any(|j| near.iter().any(|k| self.cells.contains(&[x + i, y + j, z + k]))))
    }
}
