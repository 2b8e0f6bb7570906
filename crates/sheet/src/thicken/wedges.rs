//! Offsets of wedges: strips between the paths at both ends of an edge.
//!
//! A convex wedge becomes a tube, a concave one the side walls of both faces, a sharp one a ruled face: all are strips of
//! triangles between the two paths, however different these are.

use glam::DVec3;

/// Triangles between the path `near` at one end of an edge-use and the path `far` at its other end, both from the
/// edge-use's own offset point to that of its mate; outward when the offset of the edge-use's face is `near[0]` to
/// `far[0]`. Points below `nodes` are nodes of the sheet. Appends them to `out`. O(n).
pub(super) fn push_strip(
    positions: &[DVec3],
    nodes: u32,
    near: &[u32],
    far: &[u32],
    out: &mut Vec<[u32; 3]>,
) {
    let (n, m) = (near.len() - 1, far.len() - 1);
    let at = |id: u32| positions[id as usize];
    let (mut i, mut j) = (0, 0);
    while i < n || j < m {
        let along_near = if j == m {
            true
        } else if i == n {
            false
        } else if (i + 1) * m == (j + 1) * n {
            // A quadrangle. Side walls on the two sides of a joint, which may coincide, are cut alike so that they cancel:
            // from the smaller node. Others are cut along the shorter diagonal.
            match [near[i], near[i + 1], far[j], far[j + 1]].map(|id| id < nodes) {
                [true, false, true, false] => near[i] > far[j],
                [false, true, false, true] => near[i + 1] < far[j + 1],
                _ => {
                    at(near[i + 1]).distance_squared(at(far[j]))
                        <= at(near[i]).distance_squared(at(far[j + 1]))
                }
            }
        } else {
            (i + 1) * m < (j + 1) * n
        };
        let triangle = if along_near {
            i += 1;
            [far[j], near[i - 1], near[i]]
        } else {
            j += 1;
            [far[j - 1], near[i], far[j]]
        };
        let [a, b, c] = triangle;
        if a != b && b != c && c != a {
            out.push(triangle);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_have_the_paths_and_the_edges_between_as_their_boundary() {
        let positions: Vec<DVec3> =
            (0..9).map(|i| DVec3::new(f64::from(i % 5), f64::from(i / 5), 0.0)).collect();
        for (near, far) in [
            (&[0, 1, 2, 3, 4][..], &[5, 6, 7, 8][..]),
            (&[0, 1, 2], &[5]),
            (&[0], &[5, 6, 7]),
            (&[0, 1], &[5, 6]),
        ] {
            let mut triangles = Vec::new();
            push_strip(&positions, 0, near, far, &mut triangles);
            assert_eq!(triangles.len(), near.len() + far.len() - 2);
            let mut edges: Vec<[u32; 2]> =
                triangles.iter().flat_map(|t| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]]).collect();
            let mut wanted: Vec<[u32; 2]> = vec![[far[0], near[0]]];
            wanted.extend(near.windows(2).map(|w| [w[0], w[1]]));
            wanted.push([near[near.len() - 1], far[far.len() - 1]]);
            wanted.extend(far.windows(2).map(|w| [w[1], w[0]]));
            for edge in wanted {
                let at = edges.iter().position(|e| *e == edge).expect("a boundary edge");
                edges.swap_remove(at);
            }
            assert!(edges.iter().all(|e| edges.contains(&[e[1], e[0]])));
        }
    }
}
