//! First flat positions without flips: least-squares conformal map, else Tutte's embedding.

use glam::{DVec2, DVec3};

use super::{
    energy,
    sheet::Sheet,
    sparse::{BlockSystem, NotDefinite},
    topology::NONE,
};

/// Fills `sheet.flat` with a flip-free map of the right size.
///
/// The conformal map (B. Lévy et al., *Least Squares Conformal Maps*, 2002) is near the wanted one for cloth, but may
/// flip triangles; then W. T. Tutte's *How to draw a graph*, 1963, which cannot.
pub(crate) fn start(sheet: &mut Sheet) -> Result<(), NotDefinite> {
    if conformal(sheet).is_ok() && rescale(sheet) {
        return Ok(());
    }
    tutte(sheet)?;
    if rescale(sheet) { Ok(()) } else { Err(NotDefinite) }
}

fn conformal(sheet: &mut Sheet) -> Result<(), NotDefinite> {
    // |f00 − f11|² + |f01 + f10|²
    const H: [[f64; 4]; 4] =
        [[2.0, 0.0, 0.0, -2.0], [0.0, 2.0, 2.0, 0.0], [0.0, 2.0, 2.0, 0.0], [-2.0, 0.0, 0.0, 2.0]];
    sheet.system.clear();
    for f in 0..sheet.faces.len() {
        sheet.add_face(f, &H);
    }
    let pins = sheet.pins[0];
    let weight = 1e4 * sheet.system.mean_diagonal();
    let span = sheet.space[pins[0]].distance(sheet.space[pins[1]]);
    let mut right = vec![[0.0; 2]; sheet.space.len()];
    for pin in pins {
        sheet.system.add_node(pin as u32, [weight, 0.0, weight]);
    }
    right[pins[1]][0] = weight * span;
    sheet.system.factorise()?;
    let mut out = vec![[0.0; 2]; right.len()];
    sheet.system.solve(&right, &mut out);
    for (p, o) in sheet.flat.iter_mut().zip(&out) {
        *p = DVec2::from_array(*o);
    }
    Ok(())
}

/// Scales the map to least energy; false when a triangle is flipped, collapsed or not finite.
fn rescale(sheet: &mut Sheet) -> bool {
    let (mut out, mut back) = (0.0, 0.0);
    for f in 0..sheet.faces.len() {
        let j = sheet.jacobian(&sheet.flat, f);
        let det = energy::determinant(j);
        let square: f64 = j.iter().map(|x| x * x).sum();
        // A collapsed triangle has a determinant of rounding errors only.
        if !det.is_finite() || det <= 1e-13 * square {
            return false;
        }
        out += sheet.rest[f].area * square;
        back += sheet.rest[f].area * square / (det * det);
    }
    let scale = (back / out).powf(0.25);
    sheet.flat.iter_mut().for_each(|p| *p *= scale);
    scale.is_finite() && scale > 0.0 && sheet.is_flip_free(&sheet.flat)
}

/// Longest boundary loop on a circle, every other node in the middle of its neighbours. Other loops are filled with
/// a fan about one more node, which keeps the theorem's condition.
fn tutte(sheet: &mut Sheet) -> Result<(), NotDefinite> {
    let length = |rim: &Vec<u32>| -> f64 {
        (0..rim.len())
            .map(|i| sheet.space[rim[i] as usize].distance(sheet.space[rim[(i + 1) % rim.len()] as usize]))
            .sum()
    };
    let lengths: Vec<f64> = sheet.loops.iter().map(length).collect();
    let outer =
        (0..lengths.len()).max_by(|&a, &b| lengths[a].total_cmp(&lengths[b]).then(b.cmp(&a))).unwrap_or(0);
    let mut space = sheet.space.clone();
    let mut edges = sheet.edges.clone();
    for (i, rim) in sheet.loops.iter().enumerate() {
        if i == outer {
            continue;
        }
        let hub = space.len() as u32;
        space.push(rim.iter().map(|&v| sheet.space[v as usize]).sum::<DVec3>() / rim.len() as f64);
        edges.extend(rim.iter().map(|&v| [v, hub]));
    }
    let mut on_circle = vec![NONE; space.len()];
    let mut fixed = vec![DVec2::ZERO; space.len()];
    let mut along = 0.0;
    let rim = &sheet.loops[outer];
    for i in 0..rim.len() {
        let angle = std::f64::consts::TAU * along / lengths[outer];
        on_circle[rim[i] as usize] = i as u32;
        fixed[rim[i] as usize] = DVec2::from_angle(angle);
        along += sheet.space[rim[i] as usize].distance(sheet.space[rim[(i + 1) % rim.len()] as usize]);
    }
    let mut system = BlockSystem::new(&space, &edges)?;
    system.clear();
    let mut right = vec![[0.0; 2]; space.len()];
    for (e, &[a, b]) in edges.iter().enumerate() {
        let (a_fixed, b_fixed) = (on_circle[a as usize] != NONE, on_circle[b as usize] != NONE);
        for (v, w, v_fixed, w_fixed) in [(a, b, a_fixed, b_fixed), (b, a, b_fixed, a_fixed)] {
            if !v_fixed {
                system.add_node(v, [1.0, 0.0, 1.0]);
                if w_fixed {
                    right[v as usize][0] += fixed[w as usize].x;
                    right[v as usize][1] += fixed[w as usize].y;
                }
            }
        }
        if !a_fixed && !b_fixed {
            system.add_edge(e as u32, true, [[-1.0, 0.0], [0.0, -1.0]]);
        }
    }
    for v in 0..space.len() {
        if on_circle[v] != NONE {
            system.add_node(v as u32, [1.0, 0.0, 1.0]);
            right[v] = fixed[v].to_array();
        }
    }
    system.factorise()?;
    let mut out = vec![[0.0; 2]; space.len()];
    system.solve(&right, &mut out);
    for (p, o) in sheet.flat.iter_mut().zip(&out) {
        *p = DVec2::from_array(*o);
    }
    Ok(())
}
