//! Which faces use which edges.

/// A face's use of an edge: the smaller node, the larger one, the face, and whether it runs from small to large.
pub(super) type Use = ([u32; 2], u32, bool);

/// Items in order of a small number of each, those with the same number as they came. O(items + numbers).
pub(super) fn by_number<T: Copy>(
    items: impl Iterator<Item = T> + Clone,
    numbers: usize,
    number: impl Fn(&T) -> u32,
) -> Vec<T> {
    let mut next = vec![0u32; numbers + 1];
    let mut some = None;
    for item in items.clone() {
        next[number(&item) as usize + 1] += 1;
        some = Some(item);
    }
    let Some(some) = some else { return Vec::new() };
    for k in 0..numbers {
        next[k + 1] += next[k];
    }
    let mut ordered = vec![some; next[numbers] as usize];
    for item in items {
        let place = &mut next[number(&item) as usize];
        ordered[*place as usize] = item;
        *place += 1;
    }
    ordered
}

/// All uses of edges of some faces over nodes below `nodes`, sorted, so that those of one edge are in a row. O(faces) where
/// no node is on very many.
pub(super) fn edge_uses(faces: &[[u32; 3]], nodes: usize) -> Vec<Use> {
    let uses = (0..)
        .zip(faces)
        .flat_map(|(f, &[a, b, c])| [(a, b), (b, c), (c, a)].map(|(p, q)| ([p.min(q), p.max(q)], f, p < q)));
    let mut uses = by_number(uses, nodes, |u| u.0[0]);
    uses.chunk_by_mut(|a, b| a.0[0] == b.0[0]).for_each(<[Use]>::sort_unstable);
    uses
}
