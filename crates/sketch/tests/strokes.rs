//! Strokes against exact projections, at several cameras, resolutions and pixel scales.

// A test that cannot go on fails.
#![allow(clippy::unwrap_used)]

use glam::{DQuat, DVec2, DVec3};
use sketch::{
    Camera, Clear, PickOptions, Plane, ProfileOptions, Projection, Ray, Sight, SpaceEdge, Stabiliser, Stroke,
    bisecting_plane, drawn_over, fitted_plane, pick_edges, profiles, redrawn,
};

/// Cameras about the origin: both lenses, four directions, three sizes.
fn cameras() -> Vec<Camera> {
    let mut out = Vec::new();
    for projection in [Projection::Orthographic, Projection::Perspective { fov: 0.5 }] {
        for turn in [(0.0, 0.0), (0.4, 0.3), (-0.7, 0.2), (2.5, -0.4)] {
            for size in [DVec2::new(640.0, 480.0), DVec2::new(1280.0, 800.0), DVec2::new(2560.0, 1600.0)] {
                let q = DQuat::from_rotation_y(turn.0) * DQuat::from_rotation_x(turn.1);
                out.push(Camera {
                    target: DVec3::new(3.0, -5.0, 8.0),
                    back: q * DVec3::Z,
                    up: q * DVec3::Y,
                    height: 300.0,
                    projection,
                    size,
                });
            }
        }
    }
    out
}

fn drawn(camera: &Camera, places: impl Iterator<Item = DVec3>) -> Stroke {
    let points: Vec<DVec2> = places.map(|p| camera.project(p).unwrap()).collect();
    Stroke::new(&points).unwrap()
}

#[test]
fn projecting_and_back_is_exact() {
    for camera in cameras() {
        let plane =
            Plane { point: DVec3::new(1.0, 2.0, 3.0), normal: (camera.back + 0.4 * camera.up).normalize() };
        for k in 0..20 {
            let (u, v) = plane.normal.any_orthonormal_pair();
            let p = plane.point + u * f64::from(k * 7 % 90) - v * f64::from(k * 5 % 60);
            let again = camera.unproject(camera.project(p).unwrap(), &plane).unwrap();
            assert!(again.distance(p) < 1e-9, "{again} for {p}");
        }
    }
}

#[test]
fn a_circle_on_an_edge_that_faces_the_camera() {
    for camera in cameras() {
        // Half a circle over the edge from (-60, 0) to (60, 0) in the plane of the picture.
        let at = |x: f64, y: f64| camera.target + camera.right() * x + camera.up * y;
        let edge = SpaceEdge { ends: [at(-60.0, 0.0), at(60.0, 0.0)] };
        let arc = |k: u32| std::f64::consts::PI * (1.0 - f64::from(k) / 400.0);
        let stroke = drawn(&camera, (0..=400).map(|k| at(60.0 * arc(k).cos(), 60.0 * arc(k).sin())));
        let picked = pick_edges(&camera, &stroke, &[edge], &Clear, &PickOptions::default());
        assert_eq!(picked.len(), 1);
        let plane = bisecting_plane(&camera, &edge, &[]).unwrap();
        let exact = ProfileOptions { steadying: 0.0, ..ProfileOptions::default() };
        let profile = &profiles(&camera, &stroke, &[edge], &picked, &plane, &exact).unwrap()[0];
        assert_eq!([profile.points[0], profile.points[64]], edge.ends);
        let mut steps = Vec::new();
        for (k, p) in profile.points.iter().enumerate() {
            assert!((p.distance(camera.target) - 60.0).abs() < 0.02, "{} at {k}", p.distance(camera.target));
            assert!((*p - camera.target).dot(camera.back).abs() < 1e-6);
            steps.extend((k > 0).then(|| p.distance(profile.points[k - 1])));
        }
        let (least, most) = steps.iter().fold((f64::MAX, 0.0_f64), |(l, m), s| (l.min(*s), m.max(*s)));
        assert!(most - least < 0.01 * most, "evenly spaced: {least} to {most}");
        // The usual steadying rounds the circle by less than a pixel's worth at this size.
        let usual =
            &profiles(&camera, &stroke, &[edge], &picked, &plane, &ProfileOptions::default()).unwrap()[0];
        for p in &usual.points {
            assert!((p.distance(camera.target) - 60.0).abs() < 1.0, "{}", p.distance(camera.target));
        }
    }
}

#[test]
fn coplanar_edges_get_their_plane_and_profiles_on_it() {
    let normal = DVec3::new(0.2, 0.3, 0.9).normalize();
    let (u, v) = normal.any_orthonormal_pair();
    let at = |x: f64, y: f64| u * x + v * y;
    let nodes = [at(-80.0, 0.0), at(-20.0, 30.0), at(40.0, 20.0), at(90.0, -10.0)];
    let edges: Vec<SpaceEdge> = nodes.windows(2).map(|w| SpaceEdge { ends: [w[0], w[1]] }).collect();
    for camera in cameras().into_iter().filter(|c| c.back.dot(normal).abs() > 0.3) {
        let bulge = |t: f64| 14.0 * (std::f64::consts::PI * t).sin();
        let places = (0..edges.len()).flat_map(|e| {
            let [a, b] = edges[e].ends;
            (0..100).map(move |k| {
                let t = f64::from(k) / 99.0;
                a.lerp(b, t) + normal.cross(b - a).normalize() * bulge(t)
            })
        });
        let stroke = drawn(&camera, places);
        let picked = pick_edges(&camera, &stroke, &edges, &Clear, &PickOptions::default());
        assert_eq!(picked.iter().map(|p| p.edge).collect::<Vec<_>>(), [0, 1, 2]);
        let plane = fitted_plane(&camera, &edges).unwrap();
        assert!(plane.normal.cross(normal).length() < 1e-9);
        let exact = ProfileOptions { steadying: 0.0, ..ProfileOptions::default() };
        for profile in profiles(&camera, &stroke, &edges, &picked, &plane, &exact).unwrap() {
            let [a, b] = edges[profile.edge].ends;
            let top = profile.points.iter().map(|p| (*p - a).dot(normal.cross(b - a).normalize()));
            let top = top.fold(0.0_f64, f64::max);
            assert!((top - 14.0).abs() < 0.1, "{top}");
            assert!(profile.points.iter().all(|p| p.dot(normal).abs() < 1e-6));
        }
    }
}

/// A wall: everything behind the plane is hidden.
struct Wall(Plane);

impl Sight for Wall {
    fn hides(&self, ray: &Ray, p: DVec3, slack: f64) -> bool {
        let away = |q: DVec3| (q - self.0.point).dot(self.0.normal);
        away(p) < -slack && ray.direction.dot(self.0.normal) < 0.0
    }
}

#[test]
fn hidden_edges_are_not_picked() {
    for camera in cameras() {
        let at = |x: f64, z: f64| camera.target + camera.right() * x + camera.back * z;
        // Two edges that are seen in one place, with parallel sight: one before the wall, one behind it.
        let front = SpaceEdge { ends: [at(-50.0, 20.0), at(50.0, 20.0)] };
        let behind = front.ends.map(|p| {
            let pixel = camera.project(p).unwrap();
            let plane = Plane { point: camera.target - camera.back * 30.0, normal: camera.back };
            camera.unproject(pixel, &plane).unwrap()
        });
        let edges = [front, SpaceEdge { ends: behind }];
        let stroke = drawn(&camera, (0..=50).map(|k| front.ends[0].lerp(front.ends[1], f64::from(k) / 50.0)));
        let wall = Wall(Plane { point: camera.target, normal: camera.back });
        let options = PickOptions::default();
        let seen = pick_edges(&camera, &stroke, &edges, &wall, &options);
        assert_eq!(seen.iter().map(|p| p.edge).collect::<Vec<_>>(), [0]);
        assert_eq!(pick_edges(&camera, &stroke, &edges, &Clear, &options).len(), 2);
    }
}

#[test]
fn four_pixels_count_on_every_screen() {
    for camera in cameras() {
        let pixel = camera.height / camera.size.y;
        let at = |x: f64, y: f64| camera.target + camera.right() * x + camera.up * y;
        let edge = SpaceEdge { ends: [at(-40.0, 0.0), at(40.0, 0.0)] };
        for scale in [1.0, 1.5, 2.0] {
            for (off, hit) in [(3.9, true), (4.1, false)] {
                let y = off * scale * pixel;
                let stroke = drawn(&camera, [at(-45.0, y), at(45.0, y)].into_iter());
                let options = PickOptions { pixel_scale: scale, ..PickOptions::default() };
                let picked = pick_edges(&camera, &stroke, &[edge], &Clear, &options);
                assert_eq!(picked.len() == 1, hit, "{off} pixels at scale {scale}");
            }
        }
    }
}

#[test]
fn an_edge_that_a_stroke_crosses_is_not_meant() {
    let camera = cameras()[1];
    let at = |x: f64, y: f64| camera.target + camera.right() * x + camera.up * y;
    let short = SpaceEdge { ends: [at(0.0, -1.5), at(0.0, 1.5)] };
    let stroke = drawn(&camera, [at(-60.0, 0.0), at(60.0, 0.0)].into_iter());
    assert!(pick_edges(&camera, &stroke, &[short], &Clear, &PickOptions::default()).is_empty());
}

#[test]
fn one_edge_is_bisected_and_the_profile_faces_the_camera() {
    // A roof whose ridge runs along x: faces rise at 45°, so the bisecting planes are y = 0 and z = 0.
    let edge = SpaceEdge { ends: [DVec3::new(-50.0, 0.0, 0.0), DVec3::new(50.0, 0.0, 0.0)] };
    let normals = [DVec3::new(0.0, 1.0, 1.0).normalize(), DVec3::new(0.0, 1.0, -1.0).normalize()];
    for camera in cameras() {
        let Ok(plane) = bisecting_plane(&camera, &edge, &normals) else { continue };
        let eye = camera.eye().map_or(camera.back, |e| e - plane.point);
        let wanted = if eye.z.abs() > eye.y.abs() { DVec3::Z } else { DVec3::Y };
        assert!(plane.normal.cross(wanted).length() < 1e-12);
        assert!(plane.normal.dot(eye) > 0.0);
    }
    let along = Camera { back: DVec3::X, up: DVec3::Y, ..cameras()[0] };
    assert!(bisecting_plane(&along, &edge, &normals).is_err());
}

#[test]
fn a_stroke_over_a_joint_gives_one_profile_to_each_edge_with_common_ends() {
    // Two edges of two surfaces meet in a joint's node.
    let nodes = [DVec3::new(-60.0, 0.0, 0.0), DVec3::new(0.0, 10.0, 5.0), DVec3::new(60.0, 0.0, 0.0)];
    let edges = [SpaceEdge { ends: [nodes[0], nodes[1]] }, SpaceEdge { ends: [nodes[2], nodes[1]] }];
    for camera in cameras().into_iter().filter(|c| c.back.z.abs() > 0.5) {
        let way = |k: u32| {
            if k < 50 {
                nodes[0].lerp(nodes[1], f64::from(k) / 50.0)
            } else {
                nodes[1].lerp(nodes[2], f64::from(k - 50) / 50.0)
            }
        };
        let stroke = drawn(&camera, (0..=100).map(way));
        let picked = pick_edges(&camera, &stroke, &edges, &Clear, &PickOptions::default());
        assert_eq!(picked.len(), 2);
        let plane = fitted_plane(&camera, &edges).unwrap();
        let made = profiles(&camera, &stroke, &edges, &picked, &plane, &ProfileOptions::default()).unwrap();
        for profile in made {
            let ends = [profile.points[0], profile.points[profile.points.len() - 1]];
            assert_eq!(ends, edges[profile.edge].ends, "to the bit, in the edge's direction");
        }
    }
}

#[test]
fn trembling_is_taken_out_and_straight_stays_straight() {
    let wave = |k: u32| DVec2::new(f64::from(k), 100.0 + 1.5 * (f64::from(k) * 1.3).sin());
    let stroke = Stroke::new(&(0..300).map(wave).collect::<Vec<_>>()).unwrap();
    let steady = stroke.steadied(4.0);
    let worst = steady.points().iter().filter(|p| (20.0..280.0).contains(&p.x)).map(|p| (p.y - 100.0).abs());
    assert!(worst.fold(0.0, f64::max) < 0.3);
    assert_eq!(steady.points()[0], stroke.points()[0]);
    let line = Stroke::new(&[DVec2::ZERO, DVec2::new(200.0, 50.0)]).unwrap().steadied(6.0);
    assert!(line.points().iter().all(|p| (p.y - p.x / 4.0).abs() < 1e-9));
    assert!(Stroke::new(&[DVec2::ONE, DVec2::ONE]).is_err());
    assert!(Stroke::new(&[DVec2::ONE, DVec2::new(f64::NAN, 0.0)]).is_err());
}

#[test]
fn the_string_follows_only_when_it_is_taut() {
    let mut string = Stabiliser::new(10.0);
    string.push(DVec2::ZERO);
    string.push(DVec2::new(5.0, 5.0));
    assert_eq!(string.points().len(), 1);
    string.push(DVec2::new(30.0, 0.0));
    assert_eq!(string.points()[1], DVec2::new(20.0, 0.0));
    assert_eq!(string.finish(DVec2::new(30.0, 0.0)).len(), 3);
}

/// A bent curve before the camera, seen whole, and a place on it by its share.
fn bow(camera: &Camera) -> Vec<DVec3> {
    let at = |k: u32| {
        let t = f64::from(k) / 64.0;
        let up = 30.0 * (std::f64::consts::PI * t).sin();
        camera.target + camera.right() * (120.0 * t - 60.0) + camera.up * up
    };
    (0..=64).map(at).collect()
}

#[test]
fn a_part_that_is_drawn_over_is_replaced_and_the_rest_stays() {
    for camera in cameras() {
        let curve = bow(&camera);
        let plane = Plane { point: camera.target, normal: camera.back };
        let scale = camera.size.y / 480.0;
        // From a quarter to three quarters, straight: the bow's top is cut off. Either way round.
        let part: Vec<DVec3> = (0..=40).map(|k| curve[16].lerp(curve[48], f64::from(k) / 40.0)).collect();
        for against in [false, true] {
            let stroke = if against {
                drawn(&camera, part.iter().rev().copied())
            } else {
                drawn(&camera, part.iter().copied())
            };
            let over = drawn_over(&camera, &stroke, &curve, scale).unwrap();
            assert_eq!(over.against, against);
            let [before, replaced, after] = &over.parts;
            assert!(
                replaced[0].distance(curve[16]) < 1.0 && replaced.last().unwrap().distance(curve[48]) < 1.0
            );
            assert_eq!((before[0], *after.last().unwrap()), (curve[0], curve[64]));
            let new = redrawn(&camera, &stroke, &over, &plane, &ProfileOptions::default()).unwrap();
            assert_eq!((new[0], new[64]), (curve[0], curve[64]));
            let rise = |p: &DVec3| (*p - camera.target).dot(camera.up);
            let top = new.iter().map(rise).fold(0.0, f64::max);
            assert!(top < 22.5, "{top}: cut at {}", rise(&curve[16]));
            let low = curve[..12].iter().chain(&curve[53..]);
            for p in low {
                let off = new.windows(2).map(|w| {
                    let t = ((*p - w[0]).dot(w[1] - w[0]) / (w[1] - w[0]).length_squared()).clamp(0.0, 1.0);
                    w[0].lerp(w[1], t).distance(*p)
                });
                let off = off.fold(f64::INFINITY, f64::min);
                assert!(off < 0.6, "the rest is off by {off}");
            }
        }
        // A stroke that only touches the curve, crosses it, or begins beside it replaces nothing.
        let right = camera.right();
        for ends in [
            [curve[16], curve[16] + right],
            [curve[32] + camera.up * 30.0, curve[32] - camera.up * 30.0],
            [curve[16] + camera.up * 40.0, curve[48]],
        ] {
            let stroke = drawn(&camera, (0..=20).map(|k| ends[0].lerp(ends[1], f64::from(k) / 20.0)));
            assert_eq!(drawn_over(&camera, &stroke, &curve, scale), None);
        }
    }
}
