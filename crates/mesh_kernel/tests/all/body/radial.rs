//! The radial order against rational arithmetic: sheets at any angle, nearly and exactly coplanar, coincident, far from the
//! origin, tiny and huge.

use std::f64::consts::TAU;

use crate::body::support::Random;
use mesh_kernel::body::{Body, ChainSpec, Defect, JointId, JointSpec, Sheet, SurfaceSpec};
use mesh_kernel::glam::{DMat3, DVec3};

/// Integer coordinates, all differences of which times each other fit 128 bits.
type Point = [i128; 3];

fn minus(p: Point, q: Point) -> Point {
    [p[0] - q[0], p[1] - q[1], p[2] - q[2]]
}

fn cross(p: Point, q: Point) -> Point {
    [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]
}

fn determinant(p: Point, q: Point, r: Point) -> i128 {
    let c = cross(q, r);
    p[0] * c[0] + p[1] * c[1] + p[2] * c[2]
}

/// Integer sheets about an axis.
#[derive(Clone, Debug)]
struct Fan {
    a: Point,
    b: Point,
    apexes: Vec<Point>,
}

impl Fan {
    /// The true place of every sheet about the axis, right hand, counted from the first; equal for coincident ones.
    fn truth(&self) -> Vec<usize> {
        let d = minus(self.b, self.a);
        let out: Vec<Point> = self.apexes.iter().map(|&p| minus(p, self.a)).collect();
        // Perpendicular to axis and sheet: sheets in one plane have parallel ones.
        let normal: Vec<Point> = out.iter().map(|&p| cross(d, p)).collect();
        let axis = (0..3).find(|&i| normal[0][i] != 0).unwrap();
        let class = |i: usize| match determinant(d, out[0], out[i]).signum() {
            1 => 1,
            -1 => 3,
            _ if (normal[i][axis] > 0) == (normal[0][axis] > 0) => 0,
            _ => 2,
        };
        let before = |i: usize, j: usize| {
            class(i) < class(j) || (class(i) == class(j) && determinant(d, out[i], out[j]) > 0)
        };
        let n = out.len();
        (0..n)
            .map(|i| {
                let mut below: Vec<usize> = (0..n).filter(|&j| before(j, i)).collect();
                below.retain(|&j| !(0..j).any(|k| !before(k, j) && !before(j, k)));
                below.len()
            })
            .collect()
    }

    fn sound(&self) -> bool {
        let d = minus(self.b, self.a);
        self.apexes.iter().all(|&p| cross(d, minus(p, self.a)) != [0; 3])
    }

    /// The body with its sheets in an order, and the joint turned round or not; `wound` says which faces run along it.
    fn body(&self, order: &[usize], turned: bool, wound: u64, scale: f64) -> Body {
        let place = |p: Point| {
            let q = DVec3::new(p[0] as f64, p[1] as f64, p[2] as f64);
            assert!(q.to_array().iter().zip(p).all(|(x, i)| *x as i128 == i), "{p:?} is no double");
            q * scale
        };
        let specs: Vec<SurfaceSpec> = order
            .iter()
            .map(|&i| SurfaceSpec {
                name: i.to_string(),
                positions: [self.a, self.b, self.apexes[i]].map(place).to_vec(),
                faces: vec![if wound >> i & 1 == 1 { [0, 1, 2] } else { [1, 0, 2] }],
            })
            .collect();
        let nodes = if turned { vec![1, 0] } else { vec![0, 1] };
        let chains = (0..specs.len())
            .map(|surface| ChainSpec { surface, nodes: nodes.clone(), closed: false })
            .collect();
        Body::build(&specs, &[JointSpec { name: None, chains }]).unwrap()
    }
}

fn sheet_number(body: &Body, s: &Sheet) -> usize {
    let u = body.joint(JointId(0)).uses()[s.use_index as usize];
    body.surface(u.surface).name().parse().unwrap()
}

/// The sheets by number in stored order, the lowest first.
fn stored(body: &Body) -> Vec<usize> {
    let mut order: Vec<usize> =
        body.joint(JointId(0)).radial().iter().map(|s| sheet_number(body, s)).collect();
    let first = order.iter().position(|&i| i == 0).unwrap();
    order.rotate_left(first);
    order
}

fn shuffled(n: usize, random: &mut Random) -> Vec<usize> {
    let mut order: Vec<usize> = (0..n).collect();
    for i in (1..n).rev() {
        order.swap(i, random.below(i + 1));
    }
    order
}

/// Compares with the truth, over permutations, directions, windings, places and scales.
fn try_fan(fan: &Fan, random: &mut Random) {
    if !fan.sound() {
        return;
    }
    let truth = fan.truth();
    let n = truth.len();
    let distinct = (0..n).all(|i| (0..i).all(|j| truth[i] != truth[j]));
    let mut first: Option<Vec<usize>> = None;
    for round in 0..6 {
        let order = if round == 0 { (0..n).collect() } else { shuffled(n, random) };
        let turned = round % 2 == 1;
        let wound = if round == 4 { random.next() } else { 0x5555_5555 };
        let scale = [1.0, 2f64.powi(-20), 2f64.powi(-60), 2f64.powi(30), 1.0, 2f64.powi(-1)][round];
        let body = fan.body(&order, turned, wound, scale);
        assert_eq!(body.check(), [], "{fan:?} {order:?}");
        assert!(body.counts().identity_holds());
        let mut cyclic = stored(&body);
        if turned {
            // Clockwise about the other direction.
            cyclic[1..].reverse();
        }
        let places: Vec<usize> = cyclic.iter().map(|&i| truth[i]).collect();
        let next = places.iter().cycle().skip(1);
        let falls = places.iter().zip(next).filter(|(p, q)| p > q).count();
        assert!(falls <= 1, "{fan:?}: {cyclic:?} has places {places:?}");
        if distinct {
            assert_eq!(*first.get_or_insert(cyclic.clone()), cyclic, "{fan:?}");
        }
        let sectors = body.sectors(JointId(0), 0);
        assert!(sectors.iter().all(|s| (0.0..=TAU).contains(&s.angle)), "{sectors:?}");
        let sum: f64 = sectors.iter().map(|s| s.angle).sum();
        assert!((sum - TAU).abs() < 1e-9, "{fan:?}: {sum} {sectors:?}");
        for s in &sectors {
            let [p, q] = [s.from, s.to].map(|s| truth[sheet_number(&body, &s)]);
            assert!(p != q || s.angle == 0.0 || s.angle == TAU, "{sectors:?}");
        }
    }
}

fn integer(random: &mut Random, below: i128) -> i128 {
    let wide = i128::from(random.next()) << 31 | i128::from(random.next());
    wide % (2 * below + 1) - below
}

fn point(random: &mut Random, below: i128) -> Point {
    [(); 3].map(|()| integer(random, below))
}

fn sum(p: Point, k: i128, q: Point) -> Point {
    [p[0] + k * q[0], p[1] + k * q[1], p[2] + k * q[2]]
}

#[test]
fn random_angles() {
    let mut random = Random(11);
    for round in 0..300 {
        let n = 3 + round % 7;
        let (a, b) = (point(&mut random, 1 << 20), point(&mut random, 1 << 20));
        let apexes = (0..n).map(|_| point(&mut random, 1 << 20)).collect();
        try_fan(&Fan { a, b, apexes }, &mut random);
    }
}

#[test]
fn nearly_coplanar() {
    let mut random = Random(12);
    for round in 0..400 {
        let n = 3 + round % 7;
        // Angles differ by some 2^-30 to 2^-49: 1e-9 to 1e-15.
        let long = 1i128 << (30 + round % 20);
        let d = point(&mut random, 8);
        let w = point(&mut random, 3);
        let a = point(&mut random, 4);
        let apexes = (0..n)
            .map(|_| {
                let sign = if random.below(2) == 0 { 1 } else { -1 };
                let base = sum(sum(a, long * sign, w), integer(&mut random, 3), d);
                sum(base, 1, point(&mut random, 1))
            })
            .collect();
        try_fan(&Fan { a, b: sum(a, 1, d), apexes }, &mut random);
    }
}

#[test]
fn exactly_coplanar_and_coincident() {
    let mut random = Random(13);
    for round in 0..400 {
        let n = 3 + round % 7;
        let (a, d) = (point(&mut random, 1 << 10), point(&mut random, 1 << 10));
        let outs: Vec<Point> = (0..1 + random.below(3)).map(|_| point(&mut random, 1 << 10)).collect();
        let apexes = (0..n)
            .map(|_| {
                let out = outs[random.below(outs.len())];
                let far = 1 + random.below(9) as i128;
                let sign = if random.below(3) == 0 { -1 } else { 1 };
                sum(sum(a, sign * far, out), integer(&mut random, 9), d)
            })
            .collect();
        try_fan(&Fan { a, b: sum(a, 1, d), apexes }, &mut random);
    }
}

#[test]
fn far_from_the_origin() {
    let mut random = Random(14);
    for round in 0..300 {
        let n = 3 + round % 7;
        // A unit of 2^-20 mm: 10^6 mm away, sheets of some millimetres that differ by units.
        let far = [1_000_000 << 20, -(999_983 << 20), (1_000_003 << 20) * integer(&mut random, 1)];
        let d = point(&mut random, 1 << 20);
        let w = point(&mut random, 1 << 20);
        let apexes =
            (0..n).map(|_| sum(sum(far, 1 + random.below(4) as i128, w), 1, point(&mut random, 3))).collect();
        try_fan(&Fan { a: far, b: sum(far, 1, d), apexes }, &mut random);
    }
}

/// Sheets at angles about a turned axis, on a raster of 2⁻²⁰: what a designer's rounding leaves.
#[test]
fn random_angles_turned_and_rounded() {
    let mut random = Random(15);
    for round in 0..300 {
        let n = 3 + round % 7;
        let turn = DMat3::from_euler(
            mesh_kernel::glam::EulerRot::XYZ,
            TAU * random.unit(),
            TAU * random.unit(),
            TAU * random.unit(),
        );
        let steps = [1e-15, 1e-12, 1e-9, 0.1, 1.0][round % 5];
        let raster = |p: DVec3| (turn * p * 2f64.powi(20)).to_array().map(|x| x.round() as i128);
        let mut angle = TAU * random.unit();
        let apexes = (0..n)
            .map(|_| {
                angle += steps * (0.5 + random.unit()) + [0.0, TAU / 2.0][random.below(2)];
                let r = 10.0 + 90.0 * random.unit();
                raster(DVec3::new(r * angle.cos(), r * angle.sin(), 40.0 * random.unit()))
            })
            .collect();
        try_fan(&Fan { a: raster(DVec3::ZERO), b: raster(DVec3::Z * 30.0), apexes }, &mut random);
    }
}

#[test]
fn beyond_what_products_of_doubles_hold() {
    let mut random = Random(16);
    for exponent in [-320, -200, 200, 330] {
        for _ in 0..20 {
            let (a, b) = (point(&mut random, 1 << 20), point(&mut random, 1 << 20));
            let apexes: Vec<Point> = (0..6).map(|_| point(&mut random, 1 << 20)).collect();
            let fan = Fan { a, b, apexes };
            let order: Vec<usize> = (0..6).collect();
            let expected = stored(&fan.body(&order, false, 0x15, 1.0));
            assert_eq!(stored(&fan.body(&order, false, 0x15, 2f64.powi(exponent))), expected);
        }
    }
}

/// Strips along an axis of several edges: `angles[s][k]` is that of sheet `s` at edge `k`, in degrees.
fn strips(angles: &[Vec<f64>], order: &[usize], wound: u64) -> Body {
    let edges = angles[0].len() as u32;
    let specs: Vec<SurfaceSpec> = order
        .iter()
        .map(|&s| {
            let mut spec = SurfaceSpec { name: s.to_string(), ..SurfaceSpec::default() };
            spec.positions.extend((0..=edges).map(|k| DVec3::Z * f64::from(k)));
            for (k, angle) in angles[s].iter().enumerate() {
                // Exact in the directions of the axes, so that coincidence is.
                let (sin, cos) = match *angle {
                    0.0 => (0.0, 1.0),
                    90.0 => (1.0, 0.0),
                    180.0 => (0.0, -1.0),
                    270.0 => (-1.0, 0.0),
                    x => x.to_radians().sin_cos(),
                };
                let r = 1.0 + s as f64;
                spec.positions.push(DVec3::new(r * cos, r * sin, k as f64 + 0.5));
            }
            for k in 0..edges {
                let apex = edges + 1 + k;
                spec.faces.push([k, k + 1, apex]);
                if k > 0 {
                    spec.faces.push([k, apex, apex - 1]);
                }
            }
            if wound >> s & 1 == 0 {
                spec.faces.iter_mut().for_each(|f| f.swap(1, 2));
            }
            spec
        })
        .collect();
    let nodes: Vec<u32> = (0..=edges).collect();
    let chains =
        (0..specs.len()).map(|surface| ChainSpec { surface, nodes: nodes.clone(), closed: false }).collect();
    Body::build(&specs, &[JointSpec { name: None, chains }]).unwrap()
}

fn radial_defects(body: &Body) -> Vec<(usize, usize)> {
    let defects = body.check();
    let found = |d: &Defect| match d {
        Defect::RadialOrder { at, edges, .. } => Some((*at, *edges)),
        _ => None,
    };
    defects.iter().filter_map(found).collect()
}

#[test]
fn most_edges_decide_and_the_check_names_the_others() {
    let mut random = Random(17);
    let twisted = [vec![0.0; 4], vec![100.0, 100.0, 200.0, 100.0], vec![200.0, 200.0, 100.0, 200.0]];
    for _ in 0..6 {
        let body = strips(&twisted, &shuffled(3, &mut random), random.next());
        assert_eq!((stored(&body), radial_defects(&body)), (vec![0, 1, 2], vec![(2, 1)]));
    }
    // As many one way as the other: the first along the joint, whatever the order of the uses.
    let even = [vec![0.0; 4], vec![200.0, 100.0, 100.0, 200.0], vec![100.0, 200.0, 200.0, 100.0]];
    for _ in 0..6 {
        let body = strips(&even, &shuffled(3, &mut random), random.next());
        assert_eq!((stored(&body), radial_defects(&body)), (vec![0, 2, 1], vec![(1, 2)]));
    }
    // More edges where sheets coincide do not outvote those that tell them apart.
    let mostly = [vec![0.0; 4], vec![90.0, 90.0, 200.0, 90.0], vec![90.0, 90.0, 100.0, 90.0]];
    for _ in 0..6 {
        let body = strips(&mostly, &shuffled(3, &mut random), random.next());
        assert_eq!((stored(&body), radial_defects(&body)), (vec![0, 2, 1], vec![]));
    }
}

#[test]
fn edges_that_each_tell_some_sheets_apart_decide_together() {
    let mut random = Random(18);
    // 1 and 2 coincide on the first edge, 3 and 4 on the second.
    let angles = [vec![10.0; 2], vec![90.0, 100.0], vec![90.0, 80.0], vec![190.0, 180.0], vec![170.0, 180.0]];
    for _ in 0..20 {
        let body = strips(&angles, &shuffled(5, &mut random), random.next());
        assert_eq!((stored(&body), radial_defects(&body)), (vec![0, 2, 1, 4, 3], vec![]));
    }
}

#[test]
fn coincident_sheets_alternate_if_they_can() {
    let mut random = Random(19);
    // Two bodies face to face: 0 and 1 bound the one, 2 and 3 the other; 1 and 2 coincide.
    let faces = [vec![10.0; 2], vec![90.0; 2], vec![90.0; 2], vec![160.0; 2]];
    for _ in 0..10 {
        let body = strips(&faces, &shuffled(4, &mut random), 0b1010);
        assert!(body.alternates(JointId(0)));
        assert_eq!((stored(&body), radial_defects(&body)), (vec![0, 1, 2, 3], vec![]));
    }
    // Four sheets folded to two pairs: the gaps without width are empty, material lies between the pairs.
    let folded = [vec![0.0; 2], vec![0.0; 2], vec![90.0; 2], vec![90.0; 2]];
    for _ in 0..10 {
        let body = strips(&folded, &shuffled(4, &mut random), 0b1010);
        assert!(body.alternates(JointId(0)));
        assert_eq!((stored(&body), radial_defects(&body)), (vec![0, 3, 2, 1], vec![]));
        let material = body.edge_pairings(JointId(0)).unwrap().material;
        let wide =
            |p: &[Sheet; 2]| body.sectors(JointId(0), 0).iter().any(|s| s.from == p[0] && s.angle > 1.0);
        assert!(material.iter().all(wide));
    }
    // Two sheets folded on each other, and nothing else: one order.
    let two = [vec![0.0; 2], vec![0.0; 2]];
    let body = strips(&two, &[1, 0], 0b10);
    assert_eq!((stored(&body), radial_defects(&body)), (vec![0, 1], vec![]));
    let angles: Vec<f64> = body.sectors(JointId(0), 0).iter().map(|s| s.angle).collect();
    assert_eq!(angles, [0.0, TAU]);
}
