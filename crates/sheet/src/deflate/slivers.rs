//! What is left of pieces that closed by moving goes, without leaving slits between their neighbours.

use std::collections::BTreeMap;

use glam::DVec3;

use super::assemble::Sheet;
use super::seams::Merged;

/// A sliver's height is less than this share of its longest side.
const SLIT: f64 = 0.1;

/// Makes one of the ends of very short edges at the borders of curved pieces; those inside close later, and with more care.
pub(super) fn contract(sheet: &mut Sheet, first: usize, on_border: &[bool], short: f64) {
    let mut merged = Merged::new(sheet.positions.len());
    for &[a, b, c] in &sheet.faces[first..] {
        for [p, q] in [[a, b], [b, c], [c, a]] {
            let is_at_border = on_border[p as usize] || on_border[q as usize];
            if is_at_border && sheet.positions[p as usize].distance(sheet.positions[q as usize]) < short {
                merged.join(p, q);
            }
        }
    }
    let mut stays = Vec::with_capacity(sheet.faces.len());
    for face in &mut sheet.faces {
        *face = face.map(|v| merged.find(v));
        let [a, b, c] = *face;
        stays.push(a != b && b != c && c != a);
    }
    let mut keep = stays.iter();
    sheet.faces.retain(|_| keep.next().copied().unwrap_or(true));
    let mut keep = stays.iter();
    sheet.sources.retain(|_| keep.next().copied().unwrap_or(true));
}

/// Two faces on the same nodes, left where slivers closed or a strip had no width, cancel each other if they face opposite ways; else one stays.
pub(super) fn cancel_doubles(sheet: &mut Sheet) {
    let sorted = |face: &[u32; 3]| {
        let mut nodes = *face;
        nodes.sort_unstable();
        nodes
    };
    let mut order: Vec<usize> = (0..sheet.faces.len()).collect();
    order.sort_by_key(|f| (sorted(&sheet.faces[*f]), *f));
    let mut gone = vec![false; sheet.faces.len()];
    let mut cancelled = Vec::new();
    for run in order.chunk_by(|f, g| sorted(&sheet.faces[*f]) == sorted(&sheet.faces[*g])) {
        let is_even = |f: &usize| {
            let [a, b, c] = sheet.faces[*f];
            [[a, b, c], [b, c, a], [c, a, b]].contains(&sorted(&sheet.faces[*f]))
        };
        let even: Vec<usize> = run.iter().copied().filter(is_even).collect();
        let odd: Vec<usize> = run.iter().copied().filter(|f| !is_even(f)).collect();
        let pairs = even.len().min(odd.len());
        let left = usize::from(even.len() != odd.len());
        if pairs > 0 && left == 0 {
            cancelled.push(sheet.faces[run[0]]);
        }
        for list in [even, odd] {
            let keep = if list.len() > pairs { left } else { 0 };
            list.iter().skip(keep).for_each(|f| gone[*f] = true);
        }
    }
    let mut stays = gone.iter().map(|g| !g);
    sheet.faces.retain(|_| stays.next().unwrap_or(true));
    let mut stays = gone.iter().map(|g| !g);
    sheet.sources.retain(|_| stays.next().unwrap_or(true));
    close_slits(sheet, cancelled);
}

/// Where slivers went that lay on a joint, the faces beyond them have an edge where others have a node as well: they are cut there.
fn close_slits(sheet: &mut Sheet, cancelled: Vec<[u32; 3]>) {
    if cancelled.is_empty() {
        return;
    }
    let key = |a: u32, b: u32| [a.min(b), a.max(b)];
    let sides = |[a, b, c]: [u32; 3]| [[a, b, c], [b, c, a], [c, a, b]];
    let mut faces_at: BTreeMap<[u32; 2], Vec<usize>> = BTreeMap::new();
    for [a, b, _] in cancelled.iter().flat_map(|face| sides(*face)) {
        faces_at.insert(key(a, b), Vec::new());
    }
    for (f, face) in sheet.faces.iter().enumerate() {
        for [a, b, _] in sides(*face) {
            if let Some(list) = faces_at.get_mut(&key(a, b)) {
                list.push(f);
            }
        }
    }
    let length = |positions: &[DVec3], a: u32, b: u32| positions[a as usize].distance(positions[b as usize]);
    let mut slits: Vec<(f64, [u32; 3])> = cancelled
        .into_iter()
        .filter_map(|face| {
            let longest =
                sides(face).into_iter().map(|side| (length(&sheet.positions, side[0], side[1]), side));
            let (long, [a, b, c]) = longest.max_by(|x, y| x.0.total_cmp(&y.0))?;
            let [p, q, r] = [a, b, c].map(|v| sheet.positions[v as usize]);
            ((q - p).cross(r - p).length() < SLIT * long * long).then_some((long, [a, b, c]))
        })
        .collect();
    slits.sort_by(|x, y| y.0.total_cmp(&x.0).then(x.1.cmp(&y.1)));
    for (_, [a, b, c]) in slits {
        let has = |a: u32, b: u32| faces_at.get(&key(a, b)).is_some_and(|list| !list.is_empty());
        if !(has(a, c) && has(c, b)) {
            continue;
        }
        for f in faces_at.insert(key(a, b), Vec::new()).unwrap_or_default() {
            let Some([p, q, r]) = sides(sheet.faces[f]).into_iter().find(|s| key(s[0], s[1]) == key(a, b))
            else {
                continue;
            };
            if r == c {
                continue;
            }
            let added = sheet.faces.len();
            sheet.faces[f] = [p, c, r];
            sheet.faces.push([c, q, r]);
            sheet.sources.push(sheet.sources[f]);
            for (edge, face) in [([p, c], f), ([c, q], added), ([c, r], f), ([c, r], added)] {
                if let Some(list) = faces_at.get_mut(&key(edge[0], edge[1])) {
                    list.push(face);
                }
            }
            if let Some(list) = faces_at.get_mut(&key(q, r)) {
                list.iter_mut().filter(|g| **g == f).for_each(|g| *g = added);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::assemble::Source;
    use super::*;

    /// Two sheets with a sliver each on a third one's border, on the same nodes: what goes with the slivers leaves the three joined.
    #[test]
    fn slivers_that_cancel_leave_no_slit() {
        let nodes = [
            [0.0, 0.0, 0.0],
            [1.0, 0.01, 0.0],
            [2.0, 0.0, 0.0],
            [1.0, 2.0, 0.0],
            [1.0, -1.0, 2.0],
            [1.0, -1.0, -2.0],
        ];
        let faces = vec![
            // The third sheet, with all nodes of its border.
            [1, 0, 3],
            [2, 1, 3],
            // The others, each beyond its sliver.
            [0, 1, 2],
            [0, 2, 4],
            [2, 1, 0],
            [2, 0, 5],
        ];
        let sources = (0..6).map(Source::Facet).collect();
        let mut sheet =
            Sheet { positions: nodes.map(DVec3::from).to_vec(), faces, sources, ..Sheet::default() };
        cancel_doubles(&mut sheet);
        assert_eq!(sheet.faces.len(), 6);
        assert_eq!(sheet.sources[4..], [Source::Facet(3), Source::Facet(5)]);
        for edge in [[0, 1], [1, 2]] {
            let at_edge = |face: &&[u32; 3]| edge.iter().all(|v| face.contains(v));
            assert_eq!(sheet.faces.iter().filter(at_edge).count(), 3, "{edge:?}: {:?}", sheet.faces);
        }
    }
}
