//! The pipeline on a form that the program makes itself.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;
use std::time::Instant;

use design::document::{Document, DocumentError};
use design::regenerate::{Artifact, RegenerateError, Regenerated, Settings, regenerate};
use mesh_kernel::TriMesh;
use mesh_kernel::glam::DVec3;
use reference::dress_form::{DressForm, FormOptions, Measurements};
use template::Template;

fn sample(name: &str) -> Template {
    let path: PathBuf = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples").join(name);
    Template::from_json(&std::fs::read_to_string(path).unwrap()).unwrap()
}

fn form() -> TriMesh {
    let measurements = Measurements {
        bust: Some(92.0),
        waist: Some(76.0),
        hip: Some(99.0),
        height: Some(168.0),
        ..Default::default()
    };
    DressForm::build(&measurements, &FormOptions::default()).unwrap().mesh
}

static DRESS: LazyLock<Regenerated> = LazyLock::new(|| {
    regenerate(&sample("princess-dress.json"), "form.obj", &form(), &Settings::default(), &|_| true).unwrap()
});

#[test]
fn the_dress_is_sound_and_flat_and_sewn() {
    let report = &DRESS.report;
    assert!(report.pieces.len() >= 12);
    assert!(report.joints.iter().any(|j| j.surfaces.len() >= 3), "the peplum is sewn into the waist seam");
    assert_eq!((report.collision.nodes_inside, report.collision.faces_crossing), (0, 0));
    assert!(report.surfaces.iter().map(|s| s.faces).sum::<usize>() >= 10_000);
    for piece in &report.pieces {
        assert_eq!((piece.flipped, piece.overlaps), (0, 0), "{}", piece.name);
        assert!((piece.area_2d / piece.area_3d - 1.0).abs() <= 0.01, "{}", piece.name);
    }
    for seam in &report.seams {
        assert!(seam.mismatch <= 0.5, "{}: {}", seam.name, seam.mismatch);
    }
    for (name, wanted) in &report.ease_wanted {
        assert!((report.ease[name] - wanted).abs() <= 10.0, "{name}: {} for {wanted}", report.ease[name]);
    }
    assert!(DRESS.garment.body.check().is_empty());
    assert!(DRESS.garment.body.counts().identity_holds());
}

/// On a symmetric form, what is left and what is right are mirror images, and the hem is level.
#[test]
fn the_dress_is_symmetric_and_its_hem_level() {
    let key = |p: DVec3| [p.x, p.y, p.z].map(|v| (v * 1e3).round() as i64);
    let places: BTreeSet<[i64; 3]> = DRESS.mesh.positions.iter().map(|p| key(*p)).collect();
    let near = |k: [i64; 3]| {
        let step = [-1, 0, 1];
        step.iter().any(|a| {
            step.iter().any(|b| step.iter().any(|c| places.contains(&[k[0] + a, k[1] + b, k[2] + c])))
        })
    };
    for p in &DRESS.mesh.positions {
        assert!(near(key(DVec3::new(-p.x, p.y, p.z))), "{p} has no mirror image");
    }
    let hem = DRESS.garment.lines.iter().find(|l| l.name == "hem").unwrap();
    let heights = || hem.points.iter().map(|p| p.y);
    let (low, high) = (heights().fold(f64::MAX, f64::min), heights().fold(f64::MIN, f64::max));
    assert!(high - low < 2.0, "the hem wanders from {low} to {high}");
}

/// Metres, another heading, z up: the same garment, over the body as it stands in its file.
#[test]
fn unit_axes_and_heading_of_the_file_do_not_matter() {
    let turn = |p: DVec3| {
        let (s, c) = 0.7_f64.sin_cos();
        let turned = DVec3::new(c * p.x + s * p.z, p.y, c * p.z - s * p.x);
        DVec3::new(turned.x, -turned.z, turned.y) / 1000.0 + DVec3::new(0.4, -0.2, 0.1)
    };
    let mut raw = form();
    for p in &mut raw.positions {
        *p = turn(*p);
    }
    let template = sample("fitted-bodice.json");
    let there = regenerate(&template, "turned.obj", &raw, &Settings::default(), &|_| true).unwrap();
    let here = regenerate(&template, "form.obj", &form(), &Settings::default(), &|_| true).unwrap();
    assert_eq!(there.report.body.units_guessed, "m");
    assert_eq!(here.mesh.faces, there.mesh.faces);
    let far = here
        .mesh
        .positions
        .iter()
        .zip(&there.mesh.positions)
        .map(|(a, b)| turn(here.body.placement.to_file(*a)).distance(there.body.placement.to_file(*b)))
        .fold(0.0, f64::max);
    assert!(far < 1e-3, "farthest node {far} m away");
}

#[test]
fn files_are_whole_and_the_document_reads_back() {
    let folder = tempfile::tempdir().unwrap();
    let mut dress = DRESS.clone();
    dress.write(folder.path(), &Artifact::DEFAULT, Instant::now()).unwrap();
    let mut names: Vec<String> = std::fs::read_dir(folder.path())
        .unwrap()
        .map(|e| e.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    let wanted = [
        "back.png",
        "design.toile",
        "front.png",
        "garment.glb",
        "garment.obj",
        "pattern.dxf",
        "pattern.json",
        "pattern.pdf",
        "pattern.png",
        "pattern.svg",
        "report.json",
    ];
    assert_eq!(names, wanted);
    let bytes = std::fs::read(folder.path().join("design.toile")).unwrap();
    let document = Document::from_bytes(&bytes).unwrap();
    assert_eq!(document.to_bytes(), bytes);
    let (mesh, template) = (document.mesh(), document.template().unwrap());
    let again = regenerate(&template, "form.obj", &mesh, &Settings::default(), &|_| true).unwrap();
    assert_eq!(again.mesh.faces, DRESS.mesh.faces);
    for (a, b) in again.mesh.positions.iter().zip(&DRESS.mesh.positions) {
        assert!(a.distance(*b) < 2.0, "{a} against {b}");
    }
}

#[test]
fn damaged_documents_are_refused() {
    assert!(matches!(Document::from_bytes(b"{"), Err(DocumentError::Format(_))));
    assert!(matches!(
        Document::from_bytes(b"{\"toile_design\": 9}"),
        Err(DocumentError::Version { found: 9 })
    ));
    let folder = tempfile::tempdir().unwrap();
    DRESS.clone().write(folder.path(), &[Artifact::Toile], Instant::now()).unwrap();
    let text = std::fs::read_to_string(folder.path().join("design.toile")).unwrap();
    let mut value: serde_json::Value = serde_json::from_str(&text).unwrap();
    value["body"]["faces"][0][0] = 4_000_000_000_u32.into();
    let bytes = serde_json::to_vec(&value).unwrap();
    assert!(matches!(Document::from_bytes(&bytes), Err(DocumentError::Index { face: 0, .. })));
    for cut in [text.len() / 3, text.len() - 2] {
        assert!(Document::from_bytes(&text.as_bytes()[..cut]).is_err());
    }
}

#[test]
fn what_is_no_body_is_refused_and_work_can_be_stopped() {
    let template = sample("princess-dress.json");
    let ball = mesh_of_a_ball(40, 900.0);
    let refused = regenerate(&template, "ball.obj", &ball, &Settings::default(), &|_| true);
    assert!(matches!(refused, Err(RegenerateError::Body(_))));
    let stopped = regenerate(&template, "form.obj", &form(), &Settings::default(), &|_| false);
    assert!(matches!(stopped, Err(RegenerateError::Cancelled)));
}

fn mesh_of_a_ball(rings: u32, radius: f64) -> TriMesh {
    let (rows, columns) = (rings, 2 * rings);
    let mut mesh = TriMesh::default();
    for i in 0..=rows {
        for j in 0..columns {
            let (a, b) = (
                std::f64::consts::PI * f64::from(i) / f64::from(rows),
                std::f64::consts::TAU * f64::from(j) / f64::from(columns),
            );
            mesh.positions.push(DVec3::new(a.sin() * b.cos(), a.cos(), a.sin() * b.sin()) * radius);
        }
    }
    for i in 0..rows {
        for j in 0..columns {
            let at = |i: u32, j: u32| i * columns + j % columns;
            mesh.faces.push([at(i, j), at(i, j + 1), at(i + 1, j)]);
            mesh.faces.push([at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)]);
        }
    }
    mesh
}
