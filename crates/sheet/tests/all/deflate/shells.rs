//! Smooth shells whose two sides are finely meshed, each in its own way.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::deflate::solid_models::revolved;
use mesh_kernel::TriMesh;
use mesh_kernel::glam::DVec3;
use sheet::deflate::{DeflateOptions, Nobody, deflate};

const WIDTH: f64 = 60.0;
const CELLS: u32 = 48;
const THICKNESS: f64 = 2.5;

/// A bulged patch at a place of the unit square, and its normal.
fn patch(u: f64, v: f64) -> (DVec3, DVec3) {
    let [x, y] = [u, v].map(|w| WIDTH * (w - 0.5));
    let p = DVec3::new(x, y, 12.0 - (x * x + 0.6 * y * y) / 90.0 + x * y / 200.0);
    let [along_x, along_y] = [-x / 45.0 + y / 200.0, -y / 75.0 + x / 200.0];
    (p, DVec3::new(-along_x, -along_y, 1.0).normalize())
}

/// Nodes of one side of a shell about the patch, `off` from it; `place` says where in the unit square each of the grid is.
fn side(off: f64, place: impl Fn(f64, f64) -> [f64; 2]) -> Vec<DVec3> {
    let steps = || (0..=CELLS).map(|k| f64::from(k) / f64::from(CELLS));
    let node = |u: f64, v: f64| {
        let [u, v] = place(u, v);
        let (p, normal) = patch(u, v);
        p + normal * off
    };
    steps().flat_map(|u| steps().map(move |v| [u, v])).map(|[u, v]| node(u, v)).collect()
}

/// A shell of even thickness whose inner grid drifts by up to `drift` cells away from the outer one, and back again to the rim.
fn shell(drift: f64) -> TriMesh {
    let cell = 1.0 / f64::from(CELLS);
    let bump = |u: f64| (std::f64::consts::PI * u).sin().powi(2);
    let mut positions = side(THICKNESS / 2.0, |u, v| [u, v]);
    let n = positions.len() as u32;
    let aside = |u: f64, v: f64| drift * cell * bump(u) * bump(v);
    positions.extend(side(-THICKNESS / 2.0, |u, v| [u + aside(u, v), v + 0.7 * aside(u, v)]));
    let at = |i: u32, j: u32| i * (CELLS + 1) + j;
    let mut faces = Vec::new();
    for i in 0..CELLS {
        for j in 0..CELLS {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            faces.extend([[a, b, c], [a, c, d], [n + a, n + c, n + b], [n + a, n + d, n + c]]);
        }
    }
    let corners = [(0, 0), (1, 0), (1, 1), (0, 1)];
    for k in 0..4 {
        let (from, to) = (corners[k], corners[(k + 1) % 4]);
        let node = |s: u32| {
            let part = |a: u32, b: u32| a * (CELLS - s) + b * s;
            at(part(from.0, to.0), part(from.1, to.1))
        };
        for s in 0..CELLS {
            let (a, b) = (node(s), node(s + 1));
            faces.extend([[a, n + a, n + b], [a, n + b, b]]);
        }
    }
    TriMesh::new(positions, faces)
}

#[test]
fn sides_that_are_meshed_nearly_alike_are_not_taken_for_offsets() {
    let area: f64 = {
        let steps = || (0..200).map(|k| (f64::from(k) + 0.5) / 200.0);
        let slope = |u: f64, v: f64| 1.0 / patch(u, v).1.z;
        steps().flat_map(|u| steps().map(move |v| slope(u, v))).sum::<f64>() * (WIDTH / 200.0).powi(2)
    };
    for drift in [0.0, 0.4, 0.9, 1.6, 3.0] {
        let thin = deflate(&shell(drift), &DeflateOptions::default(), &Nobody).unwrap();
        let r = &thin.report;
        assert_eq!((r.self_intersections, r.lost_edges), (0, 0), "drift {drift}");
        assert_eq!([r.patches, r.joints, r.free_loops, r.components], [1, 0, 1, 1], "drift {drift}");
        assert!((r.area / area - 1.0).abs() < 5e-3, "drift {drift}: {} mm² instead of {area}", r.area);
        let off = |p: &DVec3| {
            let middle = patch(p.x / WIDTH + 0.5, p.y / WIDTH + 0.5);
            (middle.0 - *p).dot(middle.1).abs() / THICKNESS
        };
        let farthest = thin.sheet.positions.iter().map(off).fold(0.0, f64::max);
        assert!(farthest < 0.02, "drift {drift}: {farthest} of the thickness off the middle");
    }
}

/// A ring of nodes about the z axis.
struct Ring {
    radius: f64,
    height: f64,
    nodes: u32,
}

/// A solid of rings, each meshed to the next and the last to the first; their numbers of nodes may differ.
fn of_rings(rings: &[Ring]) -> TriMesh {
    let mut positions = Vec::new();
    let mut starts = Vec::new();
    for ring in rings {
        starts.push(positions.len() as u32);
        for k in 0..ring.nodes {
            let a = std::f64::consts::TAU * f64::from(k) / f64::from(ring.nodes);
            positions.push(DVec3::new(ring.radius * a.cos(), ring.radius * a.sin(), ring.height));
        }
    }
    let mut faces = Vec::new();
    for (r, ring) in rings.iter().enumerate() {
        let s = (r + 1) % rings.len();
        let node = |r: usize, k: u32| starts[r] + k % rings[r].nodes;
        let (n, m) = (ring.nodes, rings[s].nodes);
        let (mut i, mut j) = (0, 0);
        while i < n || j < m {
            // The one that is behind goes on.
            if j == m || (i < n && (i + 1) * m <= (j + 1) * n) {
                faces.push([node(r, i), node(r, i + 1), node(s, j)]);
                i += 1;
            } else {
                faces.push([node(r, i), node(s, j + 1), node(s, j)]);
                j += 1;
            }
        }
    }
    TriMesh::new(positions, faces)
}

#[test]
fn a_round_rim_is_found_however_it_is_meshed() {
    const CHORDS: u32 = 16;
    let (radius, height, half) = (30.0, 40.0, 1.0);
    for (outer, inner) in [(96, 80), (120, 78), (150, 61)] {
        let side = |r: f64, nodes: u32| {
            (0..=20).map(move |k| Ring { radius: r, height: height * f64::from(k) / 20.0, nodes })
        };
        let rim = (1..CHORDS).map(|k| {
            let a = std::f64::consts::PI * f64::from(k) / f64::from(CHORDS);
            let nodes = if k < 5 { outer } else { inner };
            Ring { radius: radius + half * a.cos(), height: height + half * a.sin(), nodes }
        });
        let inside: Vec<Ring> = side(radius - half, inner).collect();
        let rings: Vec<Ring> =
            side(radius + half, outer).chain(rim).chain(inside.into_iter().rev()).collect();
        let mut solid = of_rings(&rings);
        // Facets of the round fold unevenly.
        for (k, p) in solid.positions.iter_mut().enumerate().filter(|(_, p)| p.z > height + 1e-6) {
            let shift = |n: usize| 0.35 * ((k * n % 17) as f64 / 8.0 - 1.0);
            let (rho, phi) =
                (p.truncate().length(), p.y.atan2(p.x) + shift(7) * std::f64::consts::TAU / f64::from(outer));
            let a = (p.z - height).atan2(rho - radius) + shift(5) * std::f64::consts::PI / f64::from(CHORDS);
            let rho = radius + half * a.cos();
            *p = DVec3::new(rho * phi.cos(), rho * phi.sin(), height + half * a.sin());
        }
        let thin = deflate(&solid, &DeflateOptions::default(), &Nobody).unwrap();
        let r = &thin.report;
        let what = format!("{outer} nodes outside, {inner} inside");
        assert_eq!((r.self_intersections, r.lost_edges), (0, 0), "{what}");
        assert_eq!([r.patches, r.joints, r.free_loops, r.components], [1, 0, 2, 1], "{what}");
        let edges = mesh_kernel::query::Adjacency::new(&thin.sheet);
        let tops = edges.edges().iter().enumerate().filter(|(e, _)| edges.half_edges(*e as u32).len() == 1);
        let heights = tops.map(|(_, ends)| thin.sheet.positions[ends[0] as usize].z);
        let ragged = heights.map(|z| z.abs().min((z - height - half).abs())).fold(0.0, f64::max);
        eprintln!("{what}: ragged {ragged}");
        assert!(ragged < 0.1, "{what}: the rim is ragged by {ragged} mm");
    }
}

#[test]
fn poles_that_are_meshed_roughly_are_one_sheet() {
    for (nodes, rough, most) in [(120, 0.002, 0.06), (200, 0.004, 0.06), (400, 0.003, 0.5)] {
        let (outer, inner) = (60.0, 58.4);
        // Rings draw together at the pole, where they are thinner than they are true.
        let steps = [0.05, 0.09, 0.15, 0.24, 0.4, 0.6, 0.9, 1.4, 2.2, 3.5, 6.0, 10.0, 16.0, 24.0, 34.0, 45.0];
        let side = |r: f64, share: u32| {
            let pole = Ring { radius: 0.0, height: r, nodes: 1 };
            let rest = steps.iter().map(move |a| {
                let a = a * std::f64::consts::PI / 180.0;
                Ring { radius: r * a.sin(), height: r * a.cos(), nodes: nodes * share / 4 }
            });
            std::iter::once(pole).chain(rest)
        };
        let inside: Vec<Ring> = side(inner, 3).collect();
        let rings: Vec<Ring> = side(outer, 4).chain(inside.into_iter().rev()).collect();
        let mut solid = of_rings(&rings);
        for (k, p) in solid.positions.iter_mut().enumerate() {
            if p.truncate().length() < 3.0 {
                p.z += rough * ((k * 7 % 17) as f64 / 8.0 - 1.0);
            }
        }
        let thin = deflate(&solid, &DeflateOptions::default(), &Nobody).unwrap();
        let r = &thin.report;
        let what = format!("{nodes} nodes, {rough} mm rough");
        assert_eq!((r.self_intersections, r.lost_edges), (0, 0), "{what}");
        assert_eq!([r.patches, r.joints, r.free_loops, r.components], [1, 0, 1, 1], "{what}");
        let radius = (outer + inner) / 2.0;
        // Facets that are finer than they are true face anywhere; what is made of them is at least within the wall.
        let beside = thin.sheet.positions.iter().filter(|p| p.truncate().length() > 0.25);
        let farthest = beside.map(|p| (p.length() - radius).abs()).fold(0.0, f64::max);
        assert!(farthest < most, "{what}: {farthest} mm off the middle");
    }
}

/// A bent strip whose ends are upright on it: along a bulged one of them, the outer face has a row of nodes more than the inner one, so that
/// what looks like the node opposite to the inner border lies beside the outer one.
#[test]
fn a_border_stays_on_its_end_where_only_one_side_has_another_row() {
    let (rows, columns) = (30u32, 40u32);
    let reach = |angle: f64| 40.0 - 20.0 * angle * angle;
    let at = |u: f64, v: f64, off: f64| {
        let angle = u - 0.5;
        DVec3::new((60.0 + off) * angle.sin(), reach(angle) * v, (60.0 + off) * angle.cos())
    };
    for before in [0.3, 0.5, 0.7] {
        let cell = 1.0 / f64::from(rows);
        let inner: Vec<f64> = (0..=rows).map(|k| f64::from(k) * cell).collect();
        // The row that belongs to the border of the inner side lies this part of a cell before that of the outer one.
        let mut outer: Vec<f64> = inner.clone();
        outer[rows as usize] -= before * cell;
        outer.push(1.0);
        let nodes = columns + 1;
        let mut mesh = TriMesh::default();
        for (rows, off) in [(&inner, -1.0), (&outer, 1.0)] {
            for v in rows {
                mesh.positions.extend((0..nodes).map(|k| at(f64::from(k) / f64::from(columns), *v, off)));
            }
        }
        let n = inner.len() as u32 * nodes;
        for (start, rows, flip) in [(0, rows, true), (n, rows + 1, false)] {
            for (i, j) in (0..rows).flat_map(|i| (0..columns).map(move |j| (i, j))) {
                let [a, b, c, d] =
                    [(i, j), (i, j + 1), (i + 1, j + 1), (i + 1, j)].map(|(i, j)| start + i * nodes + j);
                let quad = [[a, b, c], [a, c, d]];
                mesh.faces.extend(quad.map(|[a, b, c]| if flip { [a, c, b] } else { [a, b, c] }));
            }
        }
        let (last_inner, last_outer) = (rows * nodes, n + (rows + 1) * nodes);
        for k in 0..columns {
            mesh.faces.extend([[k, k + 1, n + k + 1], [k, n + k + 1, n + k]]);
            let (a, b) = (last_inner + k, last_outer + k);
            mesh.faces.extend([[a + 1, a, b], [a + 1, b, b + 1]]);
        }
        for (column, flip) in [(0, true), (columns, false)] {
            let mut add = |[a, b, c]: [u32; 3]| mesh.faces.push(if flip { [a, c, b] } else { [a, b, c] });
            for i in 0..rows {
                let (a, b) = (i * nodes + column, n + i * nodes + column);
                add([a, a + nodes, b + nodes]);
                add([a, b + nodes, b]);
            }
            add([last_inner + column, last_outer + column, last_outer - nodes + column]);
        }
        let thin = deflate(&mesh, &DeflateOptions::default(), &Nobody).unwrap();
        let r = &thin.report;
        assert_eq!([r.patches, r.joints, r.free_loops, r.components], [1, 0, 1, 1], "{before}");
        // How far to the border every node is, as a share of the strip's reach there.
        let places = thin.sheet.positions.iter().map(|p| p.y / reach(p.x.atan2(p.z)));
        let astray = |v: &f64| *v > 1.0 - 0.9 * before * cell && (v - 1.0).abs() > 0.05 * cell;
        assert_eq!(places.filter(astray).count(), 0, "{before}");
    }
}

/// A dome in so few facets that it could be a sheet of flat ones: with an edge length its nodes are on the sphere all the same.
#[test]
fn a_coarse_dome_meshed_anew_is_round() {
    let arc = |radius: f64| {
        (0..=4).map(move |k| {
            let angle = FRAC_PI_2 * f64::from(k) / 4.0;
            [radius * angle.cos(), radius * angle.sin()]
        })
    };
    let inside: Vec<[f64; 2]> = arc(39.0).collect();
    let profile: Vec<[f64; 2]> = arc(41.0).chain(inside.into_iter().rev()).collect();
    let options = DeflateOptions { edge_length: Some(3.0), ..DeflateOptions::default() };
    let thin = deflate(&revolved(&profile, 14, false), &options, &Nobody).unwrap();
    assert_eq!(thin.report.self_intersections, 0);
    let area = thin.report.area / (2.0 * PI * 40.0 * 40.0);
    assert!((area - 1.0).abs() < 5e-3, "{area} of the half of a sphere");
    assert!(thin.thickness.iter().all(|t| (t - 2.0).abs() < 1e-6));
}

/// A bowl whose lip is round, in so many chords that all of its skin is smooth: its middle goes on to the end of the material.
#[test]
fn a_bowl_goes_on_to_the_end_of_its_round_lip() {
    let arc = |centre: f64, radius: f64, from: f64, to: f64, chords: i32| {
        (0..=chords).map(move |k| {
            let angle = from + (to - from) * f64::from(k) / f64::from(chords);
            [centre + radius * angle.cos(), radius * angle.sin()]
        })
    };
    for (chords, steps, off) in [(8, 32, 0.2), (32, 128, 0.02), (40, 160, 0.02)] {
        let round = (chords / 4).max(4);
        let lip = arc(40.0, 1.0, 0.0, PI, round).take(round as usize).skip(1);
        let profile: Vec<[f64; 2]> = arc(0.0, 41.0, -FRAC_PI_2, 0.0, chords)
            .chain(lip)
            .chain(arc(0.0, 39.0, 0.0, -FRAC_PI_2, chords))
            .collect();
        let thin = deflate(&revolved(&profile, steps, false), &DeflateOptions::default(), &Nobody).unwrap();
        assert_eq!((thin.report.free_loops, thin.report.self_intersections), (1, 0));
        assert!(thin.report.unpaired.is_empty());
        let top = thin.sheet.positions.iter().map(|p| p.z).fold(0.0, f64::max);
        assert!((top - 1.0).abs() < off, "{top}");
    }
}
