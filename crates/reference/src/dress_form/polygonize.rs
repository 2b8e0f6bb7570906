//! The left half of the zero set as triangles: marching tetrahedra on a grid with a layer of nodes in x = 0.
//!
//! Six tetrahedra about each cell's diagonal (Kuhn): no ambiguous case, always a manifold.

use mesh_kernel::glam::DVec3;
use rayon::prelude::*;

/// Triangles of half a surface; the open boundary lies in x = 0.
pub(super) struct HalfSurface {
    pub(super) positions: Vec<DVec3>,
    pub(super) faces: Vec<[u32; 3]>,
}

/// Box that holds the surface: x from 0 to `half_width`, y and z between the pairs.
pub(super) struct Bounds {
    pub(super) half_width: f64,
    pub(super) y: [f64; 2],
    pub(super) z: [f64; 2],
}

/// Marches through `bounds` with cells of `cell` mm. O(cells).
pub(super) fn polygonize(field: impl Fn(DVec3) -> f64 + Sync, bounds: &Bounds, cell: f64) -> HalfSurface {
    let count = |length: f64| (length / cell).ceil() as usize + 2;
    let size = [
        count(bounds.half_width),
        count(bounds.y[1] - bounds.y[0]) + 1,
        count(bounds.z[1] - bounds.z[0]) + 1,
    ];
    // Layers by height: y is the slowest index.
    let strides = [1, size[0] * size[2], size[0]];
    let place = |i: usize, j: usize, k: usize| {
        DVec3::new(
            i as f64 * cell,
            bounds.y[0] + (j as f64 - 0.5) * cell,
            bounds.z[0] + (k as f64 - 0.5) * cell,
        )
    };
    let mut values = vec![0.0; size[0] * size[1] * size[2]];
    values.par_chunks_mut(strides[1]).enumerate().for_each(|(j, layer)| {
        for (k, row) in layer.chunks_mut(size[0]).enumerate() {
            for (i, value) in row.iter_mut().enumerate() {
                let f = field(place(i, j, k));
                *value = if f == 0.0 { 1e-9 } else { f };
            }
        }
    });
    // The edges of the six tetrahedra run along seven directions; a node is found by its lower end and direction.
    let mut node_of = vec![[u32::MAX; 7]; values.len()];
    let mut surface = HalfSurface { positions: Vec::new(), faces: Vec::new() };
    let steps: [usize; 8] =
        std::array::from_fn(|b| (b & 1) * strides[0] + (b >> 1 & 1) * strides[1] + (b >> 2 & 1) * strides[2]);
    for j in 0..size[1] - 1 {
        for k in 0..size[2] - 1 {
            for i in 0..size[0] - 1 {
                let base = i * strides[0] + j * strides[1] + k * strides[2];
                let inside = steps.map(|s| values[base + s] < 0.0);
                if inside.iter().all(|&b| b) || inside.iter().all(|&b| !b) {
                    continue;
                }
                let corner = |b: usize| place(i + (b & 1), j + (b >> 1 & 1), k + (b >> 2 & 1));
                let mut node = |a: usize, b: usize| {
                    let (a, b) = if a < b { (a, b) } else { (b, a) };
                    let slot = &mut node_of[base + steps[a]][(a ^ b) - 1];
                    if *slot == u32::MAX {
                        let (fa, fb) = (values[base + steps[a]], values[base + steps[b]]);
                        *slot = surface.positions.len() as u32;
                        surface.positions.push(corner(a).lerp(corner(b), fa / (fa - fb)));
                    }
                    *slot
                };
                for (tet, even) in TETRAHEDRA {
                    let (ins, outs): (Vec<usize>, Vec<usize>) = (0..4).partition(|&c| inside[tet[c]]);
                    let polygon: Vec<u32> = match (&ins[..], &outs[..]) {
                        (&[a], &[b, c, d]) | (&[b, c, d], &[a]) => {
                            [b, c, d].map(|x| node(tet[a], tet[x])).to_vec()
                        }
                        (&[a, b], &[c, d]) => {
                            [(a, c), (a, d), (b, d), (b, c)].map(|(p, q)| node(tet[p], tet[q])).to_vec()
                        }
                        _ => continue,
                    };
                    // The side that the corner order faces: out of a positive tetrahedron's first corner.
                    let single_outside = ins.len() == 3;
                    let order =
                        if single_outside { [&outs[..], &ins].concat() } else { [&ins[..], &outs].concat() };
                    let flip = (odd(&order) == even) != single_outside;
                    let (n, p) = (polygon.len(), &polygon);
                    for t in 1..n - 1 {
                        let face = if flip { [p[0], p[t + 1], p[t]] } else { [p[0], p[t], p[t + 1]] };
                        surface.faces.push(face);
                    }
                }
            }
        }
    }
    surface
}

/// The paths 0 → 7 along the three axes in all orders, and whether the order is even.
const TETRAHEDRA: [([usize; 4], bool); 6] = [
    ([0, 1, 3, 7], true),
    ([0, 2, 6, 7], true),
    ([0, 4, 5, 7], true),
    ([0, 2, 3, 7], false),
    ([0, 4, 6, 7], false),
    ([0, 1, 5, 7], false),
];

/// Whether a permutation of 0..n is odd.
fn odd(order: &[usize]) -> bool {
    let mut odd = false;
    for i in 0..order.len() {
        for j in i + 1..order.len() {
            odd ^= order[i] > order[j];
        }
    }
    odd
}
