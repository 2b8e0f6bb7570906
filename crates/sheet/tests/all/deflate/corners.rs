//! Boxes whose rounds outside and fillets inside have centres of their own: the corners are thicker or thinner than the walls.

use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_4;

use crate::deflate::solid_models::{block, prism, turned, united};
use crate::deflate::support::{deflated, has_topology, near};
use mesh_kernel::TriMesh;
use mesh_kernel::glam::DVec3;
use mesh_kernel::query::Adjacency;
use sheet::deflate::{DeflateOptions, Nobody, Shape, deflate};

const HALF: DVec3 = DVec3::new(40.0, 30.0, 15.0);
const WALL: f64 = 2.0;

/// Where grids are cut along one axis: half a round in `chords` at the low end, and at the high end unless it is `open`.
fn cuts(half: f64, radius: f64, chords: u32, open: bool) -> Vec<f64> {
    let round = |k: u32| half - radius + radius * (FRAC_PI_4 * f64::from(k) / f64::from(chords)).tan();
    let low = (0..=chords).rev().map(|k| -round(k));
    let high = if open { vec![half] } else { (0..=chords).map(round).collect() };
    low.chain(high).collect()
}

/// The skin of a box about the origin without its top, with round edges; and the nodes of its rim in a row.
fn skin(half: DVec3, radius: f64, chords: u32) -> (TriMesh, Vec<u32>) {
    let [x, y, z] =
        [(half.x, false), (half.y, false), (half.z, true)].map(|(h, open)| cuts(h, radius, chords, open));
    let mut mesh = TriMesh::new(Vec::new(), Vec::new());
    let mut numbers: BTreeMap<[i64; 3], u32> = BTreeMap::new();
    let mut node = |mesh: &mut TriMesh, q: DVec3| {
        let straight = half - radius;
        let core = q.clamp(-straight, DVec3::new(straight.x, straight.y, half.z));
        let p = core + (q - core).normalize() * radius;
        *numbers.entry(p.to_array().map(|c| (c * 1e7).round() as i64)).or_insert_with(|| {
            mesh.positions.push(p);
            mesh.positions.len() as u32 - 1
        })
    };
    let mut grid = |mesh: &mut TriMesh, u: &[f64], v: &[f64], at: &dyn Fn(f64, f64) -> DVec3| {
        for i in 1..u.len() {
            for j in 1..v.len() {
                let corners = [(i - 1, j - 1), (i, j - 1), (i, j), (i - 1, j)];
                let [a, b, c, d] = corners.map(|(i, j)| node(mesh, at(u[i], v[j])));
                mesh.faces.extend([[a, b, c], [a, c, d]]);
            }
        }
    };
    grid(&mut mesh, &y, &z, &|y, z| DVec3::new(half.x, y, z));
    grid(&mut mesh, &y, &z, &|y, z| DVec3::new(-half.x, -y, z));
    grid(&mut mesh, &x, &z, &|x, z| DVec3::new(x, -half.y, z));
    grid(&mut mesh, &x, &z, &|x, z| DVec3::new(-x, half.y, z));
    grid(&mut mesh, &x, &y, &|x, y| DVec3::new(-x, y, -half.z));
    let sides = [
        y.iter().map(|y| DVec3::new(half.x, *y, half.z)).collect::<Vec<_>>(),
        x.iter().rev().map(|x| DVec3::new(*x, half.y, half.z)).collect(),
        y.iter().rev().map(|y| DVec3::new(-half.x, *y, half.z)).collect(),
        x.iter().map(|x| DVec3::new(*x, -half.y, half.z)).collect(),
    ];
    let mut rim: Vec<u32> = sides.concat().into_iter().map(|q| node(&mut mesh, q)).collect();
    rim.dedup();
    rim.pop();
    (mesh, rim)
}

/// An open box with rounds outside and fillets inside.
fn rounded_box(outer: f64, inner: f64, chords: u32) -> TriMesh {
    let (mut mesh, rim) = skin(HALF, outer, chords);
    let up = DVec3::Z * (WALL / 2.0);
    let (within, inner_rim) = skin(HALF - DVec3::new(WALL, WALL, WALL / 2.0), inner, chords);
    let n = mesh.positions.len() as u32;
    mesh.positions.extend(within.positions.iter().map(|p| *p + up));
    mesh.faces.extend(within.faces.iter().map(|[a, b, c]| [n + a, n + c, n + b]));
    for k in 0..rim.len() {
        let next = (k + 1) % rim.len();
        let [a, b, c, d] = [rim[k], rim[next], n + inner_rim[next], n + inner_rim[k]];
        mesh.faces.extend([[a, b, c], [a, c, d]]);
    }
    mesh
}

const SIGNS: [[f64; 2]; 4] = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]];

/// The skin of a box about the z axis without its top, seen from inside: rings of nodes from the rim down to the floor, with a quarter of a
/// circle in each of the four corners. The rim is the first ring.
fn tub(half: DVec3, floor: f64, [upright, about_floor]: [f64; 2], [chords, down]: [u32; 2]) -> TriMesh {
    let mut mesh = TriMesh::new(Vec::new(), Vec::new());
    let quarter = |k: u32, chords: u32| std::f64::consts::FRAC_PI_2 * f64::from(k) / f64::from(chords);
    let down = (0..=down)
        .map(|k| quarter(k, down))
        .map(|a| (about_floor * (1.0 - a.cos()), floor + about_floor * (1.0 - a.sin())));
    let levels: Vec<(f64, f64)> = std::iter::once((0.0, half.z)).chain(down).collect();
    let per_ring = 4 * (chords + 1);
    for (inset, z) in &levels {
        for side in 0..4 {
            let [x, y] = SIGNS[side as usize];
            let centre = DVec3::new((half.x - upright) * x, (half.y - upright) * y, *z);
            mesh.positions.extend((0..=chords).map(|k| {
                let angle = quarter(side * chords + k, chords);
                centre + (upright - inset) * DVec3::new(angle.cos(), angle.sin(), 0.0)
            }));
        }
    }
    let node = |ring: u32, k: u32| ring * per_ring + k % per_ring;
    for k in 0..per_ring {
        for ring in 1..levels.len() as u32 {
            let (c, d) = (node(ring, k), node(ring, k + 1));
            let (a, b) = (node(ring - 1, k), node(ring - 1, k + 1));
            mesh.faces.extend([[a, b, d], [a, d, c]]);
        }
        let last = levels.len() as u32 - 1;
        if k > 0 && k + 1 < per_ring {
            mesh.faces.push([node(last, 0), node(last, k), node(last, k + 1)]);
        }
    }
    mesh
}

/// An open box that is sharp outside, with fillets in its upright edges inside and others around its floor.
fn cast_box(upright: f64, about_floor: f64, chords: u32) -> TriMesh {
    let within = DVec3::new(HALF.x - WALL, HALF.y - WALL, HALF.z);
    let mut mesh = tub(within, WALL - HALF.z, [upright, about_floor], [chords, chords]);
    let (n, per_ring) = (mesh.positions.len() as u32, 4 * (chords + 1));
    for z in [-HALF.z, HALF.z] {
        mesh.positions.extend(SIGNS.map(|[x, y]| DVec3::new(HALF.x * x, HALF.y * y, z)));
    }
    mesh.faces.extend([[n, n + 2, n + 1], [n, n + 3, n + 2]]);
    for k in 0..4 {
        let next = (k + 1) % 4;
        mesh.faces.extend([[n + k, n + next, n + next + 4], [n + k, n + next + 4, n + k + 4]]);
    }
    for k in 0..per_ring {
        let side = k / (chords + 1);
        let (a, b) = (k, (k + 1) % per_ring);
        mesh.faces.push([n + 4 + side, b, a]);
        if k % (chords + 1) == chords {
            mesh.faces.push([n + 4 + side, n + 4 + (side + 1) % 4, b]);
        }
    }
    mesh
}

/// An open box with rounds and fillets; `within` and `outside`: the radii of its upright edges and about its floor. In how many chords, is
/// said of upright edges and, `down`, about the floor inside and outside.
fn moulded_box(within: [f64; 2], outside: [f64; 2], chords: u32, down: [u32; 2]) -> TriMesh {
    let hollow = DVec3::new(HALF.x - WALL, HALF.y - WALL, HALF.z);
    let mut mesh = tub(hollow, WALL - HALF.z, within, [chords, down[0]]);
    let outside = tub(HALF, -HALF.z, outside, [chords, down[1]]);
    let (n, per_ring) = (mesh.positions.len() as u32, 4 * (chords + 1));
    mesh.positions.extend(outside.positions);
    mesh.faces.extend(outside.faces.iter().map(|[a, b, c]| [n + a, n + c, n + b]));
    for k in 0..per_ring {
        let (a, b) = (k, (k + 1) % per_ring);
        mesh.faces.extend([[a, n + b, b], [a, n + a, n + b]]);
    }
    mesh
}

/// How far the rim of a box lies off the middle of its walls, farther than its rounds are from its corners, in mm.
fn rim_off(sheet: &TriMesh, rounds: f64) -> f64 {
    let loops = Adjacency::new(sheet).boundary_loops();
    let rim = loops.iter().flatten().map(|v| sheet.positions[*v as usize]);
    let off = rim.filter_map(|p| {
        let off = (HALF - WALL / 2.0 - p.abs()).abs();
        match [p.x.abs() < HALF.x - rounds, p.y.abs() < HALF.y - rounds] {
            [true, false] => Some(off.y),
            [false, true] => Some(off.x),
            _ => None,
        }
    });
    off.fold(0.0, f64::max)
}

#[test]
fn corners_of_other_centres_are_one_sheet() {
    for (outer, inner, chords) in [
        (2.0, 1.0, 4),
        (3.0, 2.0, 4),
        (4.0, 1.0, 5),
        (5.0, 5.0, 3),
        (8.0, 7.0, 4),
        (3.0, 2.0, 12),
        (4.0, 0.5, 12),
        (5.0, 1.0, 14),
        (8.0, 7.0, 16),
        (8.0, 5.0, 12),
    ] {
        let what = format!("rounds {outer}, fillets {inner} in {chords}");
        let solid = rounded_box(outer, inner, chords);
        for (lies_turned, solid) in [(false, &solid), (true, &turned(&solid))] {
            let thin = deflate(solid, &DeflateOptions::default(), &Nobody).unwrap();
            let r = &thin.report;
            let topology = [r.patches, r.joints, r.free_loops, r.components];
            assert_eq!(topology, [1, 0, 1, 1], "{what}: {:?}", r.features);
            assert_eq!((r.self_intersections, r.lost_edges), (0, 0), "{what}");
            let sheet: f64 =
                (0..).zip(&thin.thickness).map(|(f, t)| thin.sheet.area_normal(f).length() / 2.0 * t).sum();
            if !lies_turned {
                let off = rim_off(&thin.sheet, outer.max(inner + WALL));
                assert!(off < 1e-3 * WALL, "{what}: the rim is {off} mm off the middle of its walls");
            }
            assert!(
                (sheet / r.solid_volume - 1.0).abs() < 0.01,
                "{what}: {} of the volume",
                sheet / r.solid_volume
            );
        }
    }
}

/// The inside is parallel to the outside only where it begins, ends and, if that is round, in its middle; some of its faces are not by
/// themselves, as those about the floor.
#[test]
fn bends_may_be_larger_inside_than_outside() {
    for (inner, outer, chords) in [(3.0, 2.0, 6), (3.0, 2.0, 12), (3.0, 2.0, 24), (4.0, 2.0, 12)] {
        let solid = moulded_box([5.0, inner], [6.0, outer], chords, [chords, chords]);
        let thin = deflate(&solid, &DeflateOptions::default(), &Nobody).unwrap();
        has_topology(&thin, [1, 0, 1, 1]);
        let r = &thin.report;
        let sheet: f64 =
            (0..).zip(&thin.thickness).map(|(f, t)| thin.sheet.area_normal(f).length() / 2.0 * t).sum();
        near(sheet, r.solid_volume, 0.01);
    }
}

#[test]
fn specks_of_a_fine_tessellation_are_no_plane_faces() {
    for (outer, inner, chords) in [(3.0, 2.0, 20), (4.0, 0.5, 16)] {
        let mut solid = rounded_box(outer, inner, chords);
        // Some facets of the corners are cut in three where they lie.
        for f in (0..solid.faces.len()).step_by(5) {
            if solid.area_normal(f as u32).length() < 0.03 {
                let [a, b, c] = solid.faces[f];
                let middle = solid.positions.len() as u32;
                let [p, q, r] = solid.corners(f as u32);
                solid.positions.push((p + q + r) / 3.0);
                solid.faces[f] = [a, b, middle];
                solid.faces.extend([[b, c, middle], [c, a, middle]]);
            }
        }
        let thin = deflate(&solid, &DeflateOptions::default(), &Nobody).unwrap();
        let r = &thin.report;
        let what = format!("rounds {outer}, fillets {inner} in {chords}");
        assert_eq!((r.self_intersections, r.lost_edges), (0, 0), "{what}");
        assert_eq!([r.patches, r.joints, r.free_loops, r.components], [1, 0, 1, 1], "{what}");
        let planes = r.faces.iter().filter(|f| matches!(f.shape, Shape::Plane { .. })).count();
        assert_eq!(planes, 11, "{what}: two sides of a floor and four walls, and the rim");
    }
}

/// What goes round a corner stays in its place, although the border of the floor goes on to the rib, whose side moves to the middle by many
/// widths of the facets of the inner fillet. Nor are first chords inside and outside twins, only because they begin on the same line.
#[test]
fn a_rib_moves_no_border_round_a_finely_meshed_corner() {
    let rib = block([-38.5, -0.85, -13.5], [38.5, 0.85, 0.0]);
    for (chords, down) in [(16, [16, 6]), (24, [30, 8]), (32, [32, 10]), (20, [40, 12])] {
        let solid = united(&[moulded_box([2.5, 0.5], [4.5, 2.5], chords, down), rib.clone()]);
        let thin = deflate(&solid, &DeflateOptions::default(), &Nobody).unwrap();
        has_topology(&thin, [2, 1, 1, 1]);
        near(thin.report.area, 13146.1, 1e-3);
        // The middle of the floor ends where its sides do.
        let centre = HALF - WALL - 2.5;
        let on_floor = thin.sheet.positions.iter().filter(|p| (p.z + 14.0).abs() < 1e-7);
        let beyond = on_floor.map(|p| {
            let q = p.abs() - centre;
            DVec3::new(q.x.max(0.0), q.y.max(0.0), 0.0).length() - 2.0
        });
        let beyond = beyond.fold(0.0, f64::max);
        assert!(beyond < 1e-9, "in {chords} and {down:?} the floor is wider by {beyond} mm");
    }
}

#[test]
fn fillets_of_two_radii_leave_no_hole_where_they_meet() {
    for (upright, about_floor, chords) in
        [(6.0, 3.0, 3), (6.0, 3.0, 4), (9.0, 2.0, 12), (5.0, 4.5, 5), (4.0, 1.0, 7)]
    {
        let what = format!("upright {upright}, about the floor {about_floor}, in {chords}");
        let solid = cast_box(upright, about_floor, chords);
        for solid in [&solid, &turned(&solid)] {
            let thin = deflate(solid, &DeflateOptions::default(), &Nobody).unwrap();
            let r = &thin.report;
            assert_eq!([r.patches, r.joints, r.free_loops, r.components], [5, 0, 1, 1], "{what}");
            assert_eq!((r.self_intersections, r.lost_edges), (0, 0), "{what}");
            let [a, b, h] = (2.0 * HALF - WALL * DVec3::new(1.0, 1.0, 0.5)).to_array();
            let wanted = a * b + 2.0 * (a + b) * h;
            assert!((r.area / wanted - 1.0).abs() < 1e-6, "{what}: {} mm² of {wanted}", r.area);
        }
    }
}

/// A rib with root fillets in so many chords that these fold by less than a degree: its sides and the floor are planes all the same.
#[test]
fn finely_meshed_fillets_leave_planes_what_they_are() {
    let fillet = |x: f64, turned: f64| {
        (0..=70).map(move |k| {
            let angle = std::f64::consts::FRAC_PI_2 * f64::from(k) / 70.0;
            [x + turned * 0.8 * (1.0 - angle.sin()), 2.0 + 0.8 * (1.0 - angle.cos())]
        })
    };
    let right: Vec<[f64; 2]> = fillet(0.75, 1.0).collect();
    let left: Vec<[f64; 2]> = fillet(-0.75, -1.0).collect();
    let profile: Vec<[f64; 2]> = [[-30.0, 0.0], [30.0, 0.0], [30.0, 2.0]]
        .into_iter()
        .chain(right)
        .chain([[0.75, 14.0], [-0.75, 14.0]])
        .chain(left.into_iter().rev())
        .chain([[-30.0, 2.0]])
        .collect();
    let thin = deflated(&prism(&profile, 50.0, 1));
    has_topology(&thin, [3, 1, 2, 1]);
    near(thin.report.area, 50.0 * (60.0 + 13.0), 1e-6);
}
