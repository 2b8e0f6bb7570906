//! T2 and T4 on worked numbers, and random round trips.

use mesh_kernel::glam::DVec3;
use proptest::prelude::*;
use reference::Frame;
use template::encoding::{Offset, decode, decode_axes, encode, encode_axes};
use template::lines::{Detail, Profile, Spline};

const SLANTED: Frame = Frame {
    origin: DVec3::new(10.0, 1000.0, 120.0),
    normal: DVec3::Z,
    first: DVec3::X,
    second: DVec3::new(0.6, 0.8, 0.0),
};

#[test]
fn worked_offsets() {
    // q + 2 n + 3 t1 + 5 t2 = (10, 1000, 120) + (3 + 3, 4, 2)
    let offset = Offset { normal: 2.0, first: 3.0, second: 5.0 };
    assert!((decode(&SLANTED, offset) - DVec3::new(16.0, 1004.0, 122.0)).length() < 1e-12);
    let back = encode(&SLANTED, DVec3::new(16.0, 1004.0, 122.0)).unwrap();
    assert!((back.normal - 2.0).abs() + (back.first - 3.0).abs() + (back.second - 5.0).abs() < 1e-12);
    assert_eq!(decode_axes(SLANTED.origin, [1.0, -2.0, 3.0]), DVec3::new(11.0, 998.0, 123.0));
    assert_eq!(encode_axes(SLANTED.origin, DVec3::new(11.0, 998.0, 123.0)), [1.0, -2.0, 3.0]);
    // The same offset in another model's frame: the node of that model.
    let other = Frame { origin: DVec3::ZERO, normal: DVec3::X, first: DVec3::Y, second: DVec3::Z };
    assert_eq!(decode(&other, offset), DVec3::new(2.0, 3.0, 5.0));
}

#[test]
fn a_flat_frame_holds_no_offset() {
    let flat = Frame { second: DVec3::new(1.0, 1e-5, 0.0).normalize(), ..SLANTED };
    assert_eq!(encode(&flat, DVec3::ONE), None);
}

#[test]
fn worked_profile() {
    let points = vec![DVec3::ZERO, DVec3::new(50.0, 20.0, 0.0), DVec3::new(100.0, 0.0, 0.0)];
    let profile = Profile::new(points);
    // Scale 2: Q* = 2 · (0, 20, 0) + (10, 0, 0) + ½ (200, 0, 0)
    let moved = profile.moved(DVec3::new(10.0, 0.0, 0.0), DVec3::new(210.0, 0.0, 0.0), Detail::Kept);
    assert!((moved.points()[1] - DVec3::new(110.0, 40.0, 0.0)).length() < 1e-12);
    assert!((moved.length() - 2.0 * profile.length()).abs() < 1e-9);
    // The edge turns: the paper keeps the detail's direction, the variant turns it with the edge.
    let end = DVec3::new(0.0, 100.0, 0.0);
    let kept = profile.moved(DVec3::ZERO, end, Detail::Kept);
    assert!((kept.points()[1] - DVec3::new(0.0, 70.0, 0.0)).length() < 1e-12);
    let turned = profile.moved(DVec3::ZERO, end, Detail::Turned);
    assert!((turned.points()[1] - DVec3::new(-20.0, 50.0, 0.0)).length() < 1e-12);
    assert_eq!((turned.points()[0], turned.points()[2]), (DVec3::ZERO, end));
}

#[test]
fn splines_pass_through_their_points_and_are_smooth() {
    let circle: Vec<DVec3> = (0..8)
        .map(|k| std::f64::consts::FRAC_PI_4 * f64::from(k))
        .map(|a| DVec3::new(a.sin(), 0.0, a.cos()) * 100.0)
        .collect();
    let spline = Spline::new(&circle, true);
    assert_eq!(spline.spans(), 8);
    for (k, p) in circle.iter().enumerate() {
        assert!((spline.place(k, 0.0) - *p).length() < 1e-9);
        // A closed spline through points of a circle stays near the circle, also across its seam.
        assert!((spline.place(k, 0.5).length() - 100.0).abs() < 0.4, "{}", spline.place(k, 0.5).length());
        let before = spline.place((k + 7) % 8, 1.0) - spline.place((k + 7) % 8, 0.999);
        let after = spline.place(k, 0.001) - spline.place(k, 0.0);
        assert!(before.angle_between(after) < 2e-3);
    }
}

fn unit() -> impl Strategy<Value = DVec3> {
    (-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64)
        .prop_map(|(x, y, z)| DVec3::new(x, y, z))
        .prop_filter("needs a direction", |v| v.length() > 0.1)
        .prop_map(DVec3::normalize)
}

proptest! {
    #[test]
    fn offsets_come_back(n in unit(), s in unit(), t in unit(), x in -500.0..500.0f64, y in -500.0..500.0f64, z in -500.0..500.0f64) {
        prop_assume!(n.dot(s.cross(t)).abs() > 0.05);
        let frame = Frame { origin: DVec3::new(3.0, 1200.0, -40.0), normal: n, first: s, second: t };
        let offset = encode(&frame, decode(&frame, Offset { normal: x, first: y, second: z })).unwrap();
        prop_assert!((offset.normal - x).abs() + (offset.first - y).abs() + (offset.second - z).abs() < 1e-8);
    }
}
