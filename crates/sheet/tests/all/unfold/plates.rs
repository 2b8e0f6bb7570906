//! Flat plates: exact lengths, no overlaps, allowances, reliefs, plates where one piece will not do.

use crate::unfold::support::*;
use mesh_kernel::TriMesh;
use sheet::facets::{FacetRule, FacetSheet};
use sheet::unfold::{
    Metal, Plate, Reference, Relief, ReliefShape, UnfoldError, UnfoldOptions, Unfolded, unfold,
};

fn flat(mesh: &TriMesh, options: &UnfoldOptions) -> (FacetSheet, Unfolded) {
    let sheet = FacetSheet::new(mesh, FacetRule::Planes).unwrap();
    let found = unfold(&sheet, options).unwrap();
    assert_eq!(found.overlaps, 0);
    assert!(found.length_error <= 1e-9, "{}", found.length_error);
    (sheet, found)
}

fn area(plate: &Plate) -> f64 {
    let ring = |o: &Vec<sheet::unfold::OutlinePoint>| -> f64 {
        (0..o.len()).map(|i| o[i].at.perp_dot(o[(i + 1) % o.len()].at)).sum::<f64>() / 2.0
    };
    plate.outlines.iter().map(ring).sum()
}

fn outline_length(plate: &Plate) -> f64 {
    let ring = |o: &Vec<sheet::unfold::OutlinePoint>| -> f64 {
        (0..o.len()).map(|i| o[i].at.distance(o[(i + 1) % o.len()].at)).sum()
    };
    plate.outlines.iter().map(ring).sum()
}

/// Every line that is cut appears on the outlines with its length, and the plates have the facets' area.
#[track_caller]
fn is_exact(sheet: &FacetSheet, found: &Unfolded) {
    let bent: f64 =
        found.plates.iter().flat_map(|p| &p.bends).map(|b| sheet.lines[b.line as usize].length).sum();
    let all: f64 = sheet
        .facets
        .iter()
        .flat_map(|f| f.loops.iter().flatten())
        .map(|s| sheet.lines[s.line as usize].length)
        .sum();
    let outlines: f64 = found.plates.iter().map(outline_length).sum();
    assert!((outlines + 2.0 * bent - all).abs() <= 1e-9 * all, "{outlines} + 2·{bent} is not {all}");
    let facets: f64 = sheet.facets.iter().map(|f| f.area).sum();
    let plates: f64 = found.plates.iter().map(area).sum();
    assert!((facets - plates).abs() <= 1e-9 * facets, "{plates} is not {facets}");
    for bend in found.plates.iter().flat_map(|p| &p.bends) {
        let length = bend.ends[0].distance(bend.ends[1]);
        assert!((length - sheet.lines[bend.line as usize].length).abs() < 1e-9);
    }
}

#[test]
fn shared_sheets_unfold_exactly() {
    for name in ["l-shape", "t-shape", "x-shape", "y-extrusion", "open-box", "box-partition"] {
        for kind in ["coarse", "meshed"] {
            let Some(mesh) = shared(&format!("{name}-{kind}.obj")) else { return };
            let (sheet, found) = flat(&mesh, &UnfoldOptions::default());
            is_exact(&sheet, &found);
            let plates = match name {
                "t-shape" | "y-extrusion" => 2,
                "x-shape" => 2,
                _ => 1,
            };
            assert_eq!(found.plates.len(), plates, "{name}-{kind}");
        }
    }
}

#[test]
fn hemispheres_and_saddles_of_triangles_unfold_to_plates_without_overlap() {
    for name in ["hemisphere-cap-coarse.obj", "saddle-fin-coarse.obj"] {
        let Some(mesh) = shared(name) else { return };
        let started = std::time::Instant::now();
        let (sheet, found) = flat(&mesh, &UnfoldOptions::default());
        println!(
            "{name}: {} facets, {} plates, {} tried, {:?}",
            sheet.facets.len(),
            found.plates.len(),
            found.tried,
            started.elapsed()
        );
        is_exact(&sheet, &found);
    }
}

/// A channel: floor 40 × 30, walls 20 high on the two long sides.
fn channel() -> TriMesh {
    let mut mesh = TriMesh::default();
    add_grid(&mut mesh, "floor", p(0., 0., 0.), p(40., 0., 0.), p(0., 30., 0.), 2, 3);
    add_grid(&mut mesh, "left", p(0., 0., 0.), p(40., 0., 0.), p(0., 0., 20.), 2, 1);
    add_grid(&mut mesh, "right", p(0., 30., 0.), p(40., 0., 0.), p(0., 0., -20.), 2, 2);
    mesh
}

#[test]
fn allowances_are_those_of_the_bend_tables() {
    for (reference, radius) in [(Reference::Middle, 3.0), (Reference::Inside, 2.0), (Reference::Outside, 4.0)]
    {
        let metal = Metal { thickness: 2.0, inner_radius: 2.0, k_factor: 0.4, reference };
        let options = UnfoldOptions { metal, ..UnfoldOptions::default() };
        let (_, found) = flat(&channel(), &options);
        let plate = &found.plates[0];
        let size = plate.bounds[1] - plate.bounds[0];
        // Legs less setbacks, allowances of π/2 · (2 + 0.4 · 2) each.
        let wanted = 20.0 + 30.0 + 20.0 - 4.0 * radius + 2.0 * std::f64::consts::FRAC_PI_2 * 2.8;
        assert!((size.max_element() - wanted).abs() < 1e-9, "{reference:?}: {size} is not {wanted}");
        assert!((size.min_element() - 40.0).abs() < 1e-9);
        assert!((area(plate) - 40.0 * wanted).abs() < 1e-7);
        let mut up: Vec<bool> = plate.bends.iter().map(|b| b.up).collect();
        up.sort_unstable();
        assert_eq!(up, [false, true], "one wall stands up, one down");
    }
}

#[test]
fn a_tab_gets_reliefs_and_a_box_corner_too() {
    // A tab of 10 mm in the middle of the long side of a plate.
    let mut mesh = TriMesh::default();
    add_grid(&mut mesh, "plate", p(0., 0., 0.), p(30., 0., 0.), p(0., 20., 0.), 3, 1);
    add_grid(&mut mesh, "tab", p(10., 0., 0.), p(10., 0., 0.), p(0., 0., 8.), 1, 1);
    let metal = Metal { thickness: 1.0, inner_radius: 1.0, ..Metal::default() };
    let plain = UnfoldOptions {
        metal,
        relief: Relief { shape: ReliefShape::None, ..Relief::default() },
        ..UnfoldOptions::default()
    };
    let (_, without) = flat(&mesh, &plain);
    assert_eq!(without.reliefs, 0);
    for shape in [ReliefShape::Rectangle, ReliefShape::Round] {
        let relief = Relief { shape, width: Some(1.5), depth: Some(1.0) };
        let (_, found) = flat(&mesh, &UnfoldOptions { relief, ..plain });
        assert_eq!(found.reliefs, 2);
        let cut = area(&without.plates[0]) - area(&found.plates[0]);
        // Two slots of 1.5 mm, one setback (1.5 mm) and 1 mm deep.
        let wanted = if shape == ReliefShape::Rectangle {
            2.0 * 1.5 * 2.5
        } else {
            2.0 * (1.5 * 1.75 + std::f64::consts::PI * 0.75f64.powi(2) / 2.0)
        };
        assert!((cut - wanted).abs() < 0.03, "{shape:?}: {cut} is not {wanted}");
    }
    let Some(open_box) = shared("open-box-coarse.obj") else { return };
    let (_, found) = flat(&open_box, &UnfoldOptions { metal, ..UnfoldOptions::default() });
    assert_eq!(found.reliefs, 4);
    assert!(found.one_piece);
}

#[test]
fn what_bends_cannot_do_is_said() {
    let sheet = FacetSheet::new(&channel(), FacetRule::Planes).unwrap();
    let metal = Metal { thickness: 2.0, inner_radius: 30.0, ..Metal::default() };
    let error = unfold(&sheet, &UnfoldOptions { metal, ..UnfoldOptions::default() }).unwrap_err();
    assert!(matches!(error, UnfoldError::TooSmall { .. }), "{error}");
    let metal = Metal { k_factor: 1.5, ..Metal::default() };
    let error = unfold(&sheet, &UnfoldOptions { metal, ..UnfoldOptions::default() }).unwrap_err();
    assert_eq!(error.to_string(), "the k-factor is 1.5, but must be from 0 to 1");
}

#[test]
fn holes_stay_and_bends_beside_a_hole_are_one_line_in_two_parts() {
    // An L whose fold has a window in its middle: the flat plate has a hole, and two bends on one line.
    let mut mesh = TriMesh::default();
    for (name, up) in [("floor", p(0., 1., 0.)), ("wall", p(0., 0., 1.))] {
        let first = mesh.faces.len() as u32;
        for (x, y, w, h) in [
            (0., 0., 10., 10.),
            (20., 0., 10., 10.),
            (0., 10., 10., 10.),
            (10., 10., 10., 10.),
            (20., 10., 10., 10.),
        ] {
            let at = p(x, 0., 0.) + up * y;
            let base = mesh.positions.len() as u32;
            mesh.positions.extend([at, at + p(w, 0., 0.), at + p(w, 0., 0.) + up * h, at + up * h]);
            mesh.faces.extend([[base, base + 1, base + 2], [base, base + 2, base + 3]]);
        }
        mesh.groups.push(mesh_kernel::Group { name: name.into(), faces: first..mesh.faces.len() as u32 });
    }
    let (sheet, found) = flat(&mesh, &UnfoldOptions::default());
    is_exact(&sheet, &found);
    let plate = &found.plates[0];
    assert_eq!((found.plates.len(), plate.outlines.len(), plate.bends.len()), (1, 2, 2));
    assert!(plate.welds.is_empty());
    let line = |b: &sheet::unfold::FlatBend| (b.ends[1] - b.ends[0]).normalize();
    assert!(line(&plate.bends[0]).perp_dot(line(&plate.bends[1])).abs() < 1e-12);
    let counts = sheet.counts(|_| true);
    assert_eq!((counts.g_nm, counts.f), (1, 2));
}

#[test]
fn a_wall_welded_inside_a_facet_leaves_a_mark_and_no_cut() {
    let mut mesh = TriMesh::default();
    add_grid(&mut mesh, "floor", p(0., 0., 0.), p(30., 0., 0.), p(0., 30., 0.), 3, 3);
    add_grid(&mut mesh, "rib", p(10., 10., 0.), p(10., 0., 0.), p(0., 0., 5.), 1, 1);
    add_grid(&mut mesh, "fin", p(0., 20., 0.), p(10., 0., 0.), p(0., 0., 5.), 1, 1);
    let (_, found) = flat(&mesh, &UnfoldOptions::default());
    let floor = &found.plates[0];
    // The rib's foot lies inside, the fin's begins at the border: neither is cut.
    assert_eq!((found.plates.len(), floor.outlines.len(), floor.outlines[0].len()), (3, 1, 5));
    assert!((area(floor) - 900.0).abs() < 1e-9 && (outline_length(floor) - 120.0).abs() < 1e-9);
    let lengths: Vec<f64> = floor.welds.iter().map(|w| w.ends[0].distance(w.ends[1])).collect();
    assert_eq!(lengths, [10.0, 10.0]);
}
