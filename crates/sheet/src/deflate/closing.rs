//! Edges of curved pieces that close: short ones, and those of faces that came to lie upside down.

use std::collections::BTreeSet;

use glam::DVec3;
use rayon::prelude::*;

use super::assemble::Sheet;
use super::remesh::{FLATTEST, Nodes, Remesh, flatness};

/// Faces beside one that was turned over are not made flatter than this.
const FLATTEST_BESIDE: f64 = 0.01;
/// Rounds of turning faces back.
const ROUNDS: usize = 16;

/// An edge that may close.
struct Closing {
    /// The lower the sooner: its length in mm.
    length: f64,
    edge: u32,
    /// The end that goes, inside of a curved piece; the end that stays, and where.
    gone: u32,
    stays: u32,
    to: DVec3,
}

impl Remesh<'_> {
    /// Closes edges inside of curved pieces that are shorter than `least` says for their middles; whether there were any.
    pub(super) fn close(&self, sheet: &mut Sheet, least: &(dyn Fn(u32) -> f64 + Sync)) -> bool {
        let nodes = self.nodes(sheet);
        let at = |v: u32| nodes.mesh.positions[v as usize];
        let short = |edge: u32| -> Option<Closing> {
            let [h, k] = nodes.adjacency.half_edges(edge) else { return None };
            let [a, b] = nodes.adjacency.ends(*h);
            let length = at(a).distance(at(b));
            let curved = [h, k].iter().all(|h| self.normal(sheet, **h / 3).is_some());
            let (gone, stays) = if nodes.inside[a as usize] { (a, b) } else { (b, a) };
            let to = if nodes.inside[stays as usize] { at(a).midpoint(at(b)) } else { at(stays) };
            let is_short = curved && nodes.inside[gone as usize] && length < least(h / 3);
            is_short.then_some(Closing { length, edge, gone, stays, to })
        };
        let edges = nodes.adjacency.edges().len() as u32;
        let found = (0..edges).into_par_iter().filter_map(short).collect();
        let sound = |closing: &Closing| {
            [closing.gone, closing.stays].into_iter().flat_map(|v| closing.left(&nodes, v)).all(
                |(f, corners)| {
                    let flat = flatness(corners);
                    let was = flatness(nodes.mesh.corners(f));
                    !self.leans(sheet, f, corners) && (flat > FLATTEST || flat > was)
                },
            )
        };
        let closings = chosen(&nodes, found, &sound);
        close_all(sheet, &nodes, &closings);
        !closings.is_empty()
    }

    /// Turns curved faces that lie upside down back: edges of theirs close, and where none can, their nodes go to the middle of those
    /// about them. Where a wall ends aslant, its border stays on that end while what is beside it goes straight to the middle of
    /// the wall, and past the border if it is finely meshed. O(n log n).
    pub(super) fn turn_back(&self, sheet: &mut Sheet) {
        for _ in 0..ROUNDS {
            let corners = |f: u32| sheet.faces[f as usize].map(|v| sheet.positions[v as usize]);
            let faces = (0..sheet.faces.len() as u32).into_par_iter();
            let turned: Vec<u32> = faces.filter(|f| self.is_turned(sheet, *f, corners(*f))).collect();
            if turned.is_empty() {
                return;
            }
            let nodes = self.nodes(sheet);
            let closings = self.closings_of(sheet, &nodes, &turned);
            if closings.is_empty() && !self.eased(sheet, &nodes, &turned) {
                return;
            }
            close_all(sheet, &nodes, &closings);
        }
    }

    /// Edges of some faces that lie upside down, after whose closing fewer do so.
    fn closings_of(&self, sheet: &Sheet, nodes: &Nodes, turned: &[u32]) -> Vec<Closing> {
        let mut found = Vec::new();
        for h in turned.iter().flat_map(|f| 3 * f..3 * f + 3) {
            let Some(edge) = nodes.adjacency.edge_of(h) else { continue };
            let [a, b] = nodes.adjacency.ends(h);
            let inside = [(a, b), (b, a)].into_iter().filter(|(gone, _)| nodes.inside[*gone as usize]);
            found.extend(inside.map(|(gone, stays)| {
                let [from, to] = [gone, stays].map(|v| nodes.mesh.positions[v as usize]);
                Closing { length: from.distance(to), edge, gone, stays, to }
            }));
        }
        chosen(nodes, found, &|closing| {
            self.turns_back(sheet, nodes, closing.gone, &closing.left(nodes, closing.gone))
        })
    }

    /// Puts nodes of some faces that lie upside down into the middle of those about them, if fewer do so then; whether there were any.
    fn eased(&self, sheet: &mut Sheet, nodes: &Nodes, turned: &[u32]) -> bool {
        let of_turned = turned.iter().flat_map(|f| nodes.mesh.faces[*f as usize]);
        let of_turned: BTreeSet<u32> = of_turned.filter(|v| nodes.inside[*v as usize]).collect();
        let mut touched = BTreeSet::new();
        for v in of_turned {
            let about: BTreeSet<u32> = nodes.about(v).collect();
            let at = |w: u32| nodes.mesh.positions[w as usize];
            let to = about.iter().map(|w| at(*w)).sum::<DVec3>() / about.len().max(1) as f64;
            let moved = |f: u32| (f, nodes.mesh.faces[f as usize].map(|w| if w == v { to } else { at(w) }));
            let star: Vec<(u32, [DVec3; 3])> = nodes.faces(v).map(moved).collect();
            let is_free = star.iter().all(|(f, _)| !touched.contains(f));
            if is_free && self.turns_back(sheet, nodes, v, &star) {
                touched.extend(star.iter().map(|(f, _)| *f));
                sheet.positions[v as usize] = to;
            }
        }
        !touched.is_empty()
    }

    /// Whether fewer faces about a node lie upside down, when those that are left are as they will be, and none of them
    /// comes to lean or flattens.
    fn turns_back(&self, sheet: &Sheet, nodes: &Nodes, v: u32, left: &[(u32, [DVec3; 3])]) -> bool {
        let was = |f: u32| nodes.mesh.corners(f);
        let before = nodes.faces(v).filter(|f| self.is_turned(sheet, *f, was(*f))).count();
        let after = left.iter().filter(|(f, corners)| self.is_turned(sheet, *f, *corners)).count();
        let is_worse = |(f, corners): &(u32, [DVec3; 3])| {
            let flat = flatness(*corners);
            let flattens =
                flat < FLATTEST_BESIDE && flat < flatness(was(*f)) && !self.is_turned(sheet, *f, was(*f));
            let leans = self.leans(sheet, *f, *corners) && !self.leans(sheet, *f, was(*f));
            flattens || leans && !self.is_turned(sheet, *f, *corners)
        };
        after < before && !left.iter().any(is_worse)
    }

    /// Whether a curved face with some corners faces away from where it faced on the solid.
    fn is_turned(&self, sheet: &Sheet, f: u32, [a, b, c]: [DVec3; 3]) -> bool {
        self.normal(sheet, f).is_some_and(|normal| (b - a).cross(c - a).dot(normal) < 0.0)
    }
}

impl Closing {
    /// The faces about one of its ends that are left, with where their corners are then.
    fn left(&self, nodes: &Nodes, v: u32) -> Vec<(u32, [DVec3; 3])> {
        let moves = |w: u32| w == self.gone || w == self.stays;
        let faces = nodes.faces(v).map(|f| (f, nodes.mesh.faces[f as usize]));
        let left = faces.filter(|(_, face)| face.iter().filter(|w| moves(**w)).count() == 1);
        let at = |w: u32| if moves(w) { self.to } else { nodes.mesh.positions[w as usize] };
        left.map(|(f, face)| (f, face.map(at))).collect()
    }
}

/// Those that are sound and have nothing to do with each other, the shortest first.
fn chosen(nodes: &Nodes, mut found: Vec<Closing>, sound: &dyn Fn(&Closing) -> bool) -> Vec<Closing> {
    found.sort_by(|a, b| a.length.total_cmp(&b.length).then((a.edge, a.gone).cmp(&(b.edge, b.gone))));
    let mut touched = vec![false; nodes.mesh.faces.len()];
    let mut is_chosen = |closing: &Closing| {
        let faces = || [closing.gone, closing.stays].into_iter().flat_map(|v| nodes.faces(v));
        if faces().any(|f| touched[f as usize]) {
            return false;
        }
        let [gone, stays] = [closing.gone, closing.stays].map(|v| nodes.about(v).collect::<BTreeSet<u32>>());
        let closes = gone.intersection(&stays).count() == 2 && sound(closing);
        if closes {
            faces().for_each(|f| touched[f as usize] = true);
        }
        closes
    };
    found.retain(|closing| is_chosen(closing));
    found
}

/// Closes edges that have nothing to do with each other.
fn close_all(sheet: &mut Sheet, nodes: &Nodes, closings: &[Closing]) {
    let mut stays = vec![true; sheet.faces.len()];
    for closing in closings {
        for c in nodes.star.of(closing.gone) {
            sheet.faces[*c as usize / 3][*c as usize % 3] = closing.stays;
        }
        nodes.adjacency.half_edges(closing.edge).iter().for_each(|h| stays[*h as usize / 3] = false);
        sheet.positions[closing.stays as usize] = closing.to;
    }
    let mut keep = stays.iter();
    sheet.faces.retain(|_| keep.next().copied().unwrap_or(true));
    let mut keep = stays.iter();
    sheet.sources.retain(|_| keep.next().copied().unwrap_or(true));
}

#[cfg(test)]
mod tests {
    use mesh_kernel::TriMesh;

    use super::super::assemble::Source;
    use super::super::solid::Solid;
    use super::*;

    /// A plate between two copies of a sheet of rows of nodes; the first row is its rim. The sheet comes first.
    fn plate(rows: &[(f64, u32)]) -> (Solid, usize) {
        let mut positions = Vec::new();
        let mut faces: Vec<[u32; 3]> = Vec::new();
        let mut starts = Vec::new();
        for (y, nodes) in rows {
            starts.push(positions.len() as u32);
            positions
                .extend((0..*nodes).map(|k| DVec3::new(10.0 * f64::from(k) / f64::from(nodes - 1), *y, 0.0)));
        }
        for r in 1..rows.len() {
            let (a, b) = (starts[r - 1], starts[r]);
            let (n, m) = (rows[r - 1].1 - 1, rows[r].1 - 1);
            let (mut i, mut j) = (0, 0);
            while i < n || j < m {
                if j == m || (i < n && (i + 1) * m <= (j + 1) * n) {
                    faces.push([a + i, a + i + 1, b + j]);
                    i += 1;
                } else {
                    faces.push([a + i, b + j + 1, b + j]);
                    j += 1;
                }
            }
        }
        let (top, n) = (faces.len(), positions.len() as u32);
        let sheet = TriMesh::new(positions.clone(), faces.clone());
        let adjacency = mesh_kernel::query::Adjacency::new(&sheet);
        positions.extend(sheet.positions.iter().map(|p| *p - DVec3::Z));
        faces.extend(sheet.faces.iter().map(|[a, b, c]| [n + a, n + c, n + b]));
        for h in 0..3 * top as u32 {
            let [a, b] = adjacency.ends(h);
            if adjacency.partner(h).is_none() {
                faces.extend([[b, a, n + a], [b, n + a, n + b]]);
            }
        }
        (Solid::new(&TriMesh::new(positions, faces)).unwrap(), top)
    }

    #[test]
    fn what_passed_a_finely_meshed_rim_is_turned_back() {
        let rows = [(0.0, 81), (0.4, 11), (1.0, 11), (2.0, 11), (3.0, 11)];
        let (solid, top) = plate(&rows);
        for passed in [0.5, 0.9, 1.4] {
            let mut sheet = Sheet {
                positions: solid.mesh.positions.clone(),
                faces: solid.mesh.faces[..top].to_vec(),
                sources: (0..top as u32).map(Source::Facet).collect(),
                ..Sheet::default()
            };
            // All but the borders move past the rim.
            let inside = |p: &DVec3| p.x > 1e-9 && p.x < 10.0 - 1e-9 && p.y > 1e-9 && p.y < 3.0 - 1e-9;
            sheet.positions.iter_mut().filter(|p| inside(p)).for_each(|p| p.y -= passed);
            let remesh = Remesh { solid: &solid, held: &[] };
            let turned = |sheet: &Sheet| {
                let corners = |f: u32| sheet.faces[f as usize].map(|v| sheet.positions[v as usize]);
                (0..sheet.faces.len() as u32).filter(|f| remesh.is_turned(sheet, *f, corners(*f))).count()
            };
            assert!(turned(&sheet) > 60);
            remesh.turn_back(&mut sheet);
            assert_eq!(turned(&sheet), 0, "passed by {passed}");
            let area: f64 = (sheet.faces.iter())
                .map(|face| face.map(|v| sheet.positions[v as usize]))
                .map(|[a, b, c]| (b - a).cross(c - a).length() / 2.0)
                .sum();
            assert!((area - 30.0).abs() < 1e-9, "passed by {passed}: {area} mm² of 30");
        }
    }
}
