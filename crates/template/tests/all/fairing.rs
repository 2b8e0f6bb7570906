//! T5: the umbrella against its limit, the plate against what it must reproduce.

use mesh_kernel::glam::DVec3;
use template::fairing::plate::Hold;
use template::fairing::{Plate, Umbrella, flaps};

/// A grid of uneven spacing over 100 × 100 mm with its rim flagged.
fn uneven(n: usize) -> (Vec<DVec3>, Vec<[u32; 3]>, Vec<bool>) {
    let stretch = |k: usize| {
        let t = k as f64 / n as f64;
        100.0 * t * (0.4 + 0.6 * t)
    };
    let (mut p, mut f, mut rim) = (Vec::new(), Vec::new(), Vec::new());
    for i in 0..=n {
        for j in 0..=n {
            p.push(DVec3::new(stretch(i), stretch(j), 0.0));
            rim.push(i == 0 || j == 0 || i == n || j == n);
        }
    }
    let at = |i: usize, j: usize| (i * (n + 1) + j) as u32;
    for i in 0..n {
        for j in 0..n {
            let q = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            let cut = if (i + j) % 2 == 0 {
                [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]
            } else {
                [[q[0], q[1], q[3]], [q[1], q[2], q[3]]]
            };
            f.extend(cut);
        }
    }
    (p, f, rim)
}

#[test]
fn the_umbrella_runs_to_its_limit() {
    let (mut p, faces, fixed) = uneven(8);
    for (i, (v, fixed)) in p.iter_mut().zip(&fixed).enumerate() {
        if *fixed {
            v.z = 10.0 * (v.x * 0.05).sin();
        } else {
            // Disorder inside.
            *v += DVec3::new((i % 3) as f64, (i % 5) as f64, (i % 7) as f64);
        }
    }
    let umbrella = Umbrella::new(&faces, &fixed);
    let mut limit = p.clone();
    umbrella.limit(&mut limit).unwrap();
    let mut stepped = p.clone();
    umbrella.iterate(&mut stepped, 6000);
    let apart = stepped.iter().zip(&limit).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    assert!(apart < 1e-7, "{apart}");
    // And the limit is at rest.
    let before = limit.clone();
    umbrella.iterate(&mut limit, 1);
    assert!(limit.iter().zip(&before).all(|(a, b)| a.distance(*b) < 1e-9));
    for (i, f) in fixed.iter().enumerate().filter(|f| *f.1) {
        assert!(*f && stepped[i] == p[i], "a fixed node moved");
    }
}

#[test]
fn one_umbrella_step_by_hand() {
    // A fan of six round one free node: U(p) = −p; U of the ring nodes (three neighbours each) is known.
    let ring: Vec<DVec3> = (0..6)
        .map(|k| std::f64::consts::FRAC_PI_3 * f64::from(k))
        .map(|a| DVec3::new(a.cos(), a.sin(), 0.0))
        .collect();
    let mut p = ring.clone();
    p.push(DVec3::new(0.0, 0.0, 1.0));
    let faces: Vec<[u32; 3]> = (0..6).map(|k| [k, (k + 1) % 6, 6]).collect();
    let mut fixed = vec![true; 7];
    fixed[6] = false;
    Umbrella::new(&faces, &fixed).iterate(&mut p, 1);
    // z: U(centre) = −1, U(ring) = 1/3, U² = 1/3 + 1 = 4/3, ν = 1 + 1/3, step −1.
    assert!(p[6].z.abs() < 1e-12, "{}", p[6]);
}

#[test]
fn a_plate_reproduces_linear_functions_on_uneven_grids() {
    let (flat, faces, rim) = uneven(12);
    let hold: Vec<Hold> = rim.iter().map(|r| if *r { Hold::Fixed } else { Hold::Free }).collect();
    let plate = Plate::new(flaps(&flat, &faces), &hold, &flat).unwrap();
    let linear = |p: &DVec3| DVec3::new(p.x, p.y, 3.0 + 0.2 * p.x - 0.7 * p.y);
    let mut p: Vec<DVec3> =
        flat.iter().zip(&rim).map(|(p, r)| if *r { linear(p) } else { DVec3::ZERO }).collect();
    plate.solve(&mut p, &flat).unwrap();
    let worst = p.iter().zip(&flat).map(|(a, b)| a.distance(linear(b))).fold(0.0, f64::max);
    assert!(worst < 1e-9, "{worst}");
}

#[test]
fn a_plate_on_a_drum_has_no_dents() {
    // A piece of a cylinder held at its rim: only near the straight ends, where nothing bends the plate, is it flatter.
    let (flat, faces, rim) = uneven(16);
    let hold: Vec<Hold> = rim.iter().map(|r| if *r { Hold::Fixed } else { Hold::Free }).collect();
    let plate = Plate::new(flaps(&flat, &faces), &hold, &flat).unwrap();
    let drum = |p: &DVec3| DVec3::new(p.x, p.y, (200.0f64.powi(2) - (p.x - 50.0).powi(2)).sqrt());
    let mut p: Vec<DVec3> =
        flat.iter().zip(&rim).map(|(p, r)| if *r { drum(p) } else { DVec3::ZERO }).collect();
    plate.solve(&mut p, &flat).unwrap();
    let worst = p.iter().zip(&flat).map(|(a, b)| (a.z - drum(b).z).abs()).fold(0.0, f64::max);
    assert!(worst < 0.9, "{worst} of a sagitta of 6.4 mm");
}

#[test]
fn springs_draw_and_a_kept_pattern_gives_the_same() {
    let (flat, faces, rim) = uneven(10);
    let middle = 5 * 11 + 5;
    let hold = |k: f64| -> Vec<Hold> {
        let free = |i: usize| if i == middle { Hold::Drawn(k) } else { Hold::Free };
        rim.iter().enumerate().map(|(i, r)| if *r { Hold::Fixed } else { free(i) }).collect()
    };
    let mut targets = flat.clone();
    targets[middle].z = 10.0;
    let solve = |plate: &Plate| {
        let mut p = flat.clone();
        plate.solve(&mut p, &targets).unwrap();
        p
    };
    let stiff = solve(&Plate::new(flaps(&flat, &faces), &hold(1e3), &flat).unwrap());
    assert!((stiff[middle].z - 10.0).abs() < 0.1);
    let mut kept = Plate::new(flaps(&flat, &faces), &hold(1e-3), &flat).unwrap();
    let soft = solve(&kept);
    assert!(soft[middle].z > 0.0 && soft[middle].z < 9.0);
    kept.set_springs(|i| if i == middle { 1e3 } else { 0.0 }).unwrap();
    assert_eq!(solve(&kept), stiff);
}

#[test]
fn a_factor_serves_a_moved_plate_and_no_other_one() {
    let (flat, faces, rim) = uneven(10);
    let hold = |rim: &[bool]| -> Vec<Hold> {
        rim.iter().map(|r| if *r { Hold::Fixed } else { Hold::Free }).collect()
    };
    let drum = |p: &DVec3| DVec3::new(p.x, p.y, 0.002 * p.x * p.x);
    let solve = |plate: &Plate, flat: &[DVec3]| {
        let mut p: Vec<DVec3> = flat.iter().map(drum).collect();
        plate.solve(&mut p, flat).unwrap();
        p
    };
    let apart = |p: &[DVec3], q: &[DVec3]| p.iter().zip(q).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    let moved: Vec<DVec3> = flat.iter().map(|p| *p + 0.1 * DVec3::new(p.y, 0.5 * p.x, 0.0)).collect();
    let mut wider = rim.clone();
    wider[5 * 11 + 5] = true;
    for (places, held) in [(&moved, &rim), (&flat, &wider)] {
        let first = Plate::new(flaps(&flat, &faces), &hold(&rim), &flat).unwrap();
        let fresh = Plate::new(flaps(places, &faces), &hold(held), places).unwrap();
        let earlier = first.into_factor();
        let reused = Plate::reusing(earlier, flaps(places, &faces), &hold(held), places).unwrap();
        assert!(apart(&solve(&fresh, places), &solve(&reused, places)) < 1e-8);
    }
}
