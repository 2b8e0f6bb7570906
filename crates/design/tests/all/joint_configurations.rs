//! T7: one wireframe with the same profiles, joined in four ways, becomes four shapes (the samples in `samples/joints`).
//!
//! And what can be asked beyond that (T5): surfaces faired as one across their joints, and adaptive splits.
//!
//! `UPDATE_DOCS=1 cargo test --release -p design --test all joint_configurations` draws the guide's pictures anew.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use mesh_kernel::TriMesh;
use mesh_kernel::files::read;
use mesh_kernel::glam::DVec3;
use reference::human::{HumanBody, HumanOptions, extract};
use template::format::TemplateFile;
use template::{Garment, Reference, RegenerateOptions, Template, regenerate};
use viewer::{
    Camera, Color, Lens, MontageOptions, Occlusion, RenderOptions, Scene, SceneLine, SceneMesh, montage,
    render,
};

/// Samples with their titles, surfaces, and the uses of their joints.
const CONFIGURATIONS: [(&str, &str, usize, &[usize]); 4] = [
    ("one-joint", "I: one joint of five boundary edges", 5, &[5]),
    ("one-inner-edge", "II: an inner edge and three boundary edges", 4, &[4]),
    ("two-inner-edges", "III: two inner edges and one boundary edge", 3, &[3]),
    ("two-joints", "IV: two joints", 4, &[2, 2]),
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn sample(name: &str) -> Template {
    let path = root().join("samples/joints").join(name).with_extension("json");
    Template::from_json(&std::fs::read_to_string(path).unwrap()).unwrap()
}

fn form() -> HumanBody {
    extract(&read(&root().join("samples/form-12.obj")).unwrap(), &HumanOptions::default()).unwrap()
}

fn build(template: &Template, body: &HumanBody) -> Garment {
    let reference = Reference { mesh: &body.mesh, features: &body.features };
    let garment = regenerate(template, &reference, &RegenerateOptions::default()).unwrap();
    assert!(garment.body.check().is_empty() && garment.body.counts().identity_holds());
    garment
}

/// At the middle of the spine, the directions in which surfaces leave it, by the wing (1 to 5) that they lead to.
fn leaving(garment: &Garment) -> BTreeMap<usize, DVec3> {
    let mut out = BTreeMap::new();
    for side in garment.seams.iter().flat_map(|seam| &seam.sides) {
        let surface = garment.body.surface(garment.surfaces[side.surface].id);
        let at = |v: u32| surface.positions()[v as usize];
        let middle = side.nodes.len() / 2;
        let ends = [side.nodes[middle - 1], side.nodes[middle]];
        let [a, b] = ends.map(at);
        // Middles of the wings' tips: the template nodes b1 to b5.
        let tips: Vec<(usize, DVec3)> = garment
            .marks
            .iter()
            .filter(|mark| mark.surface == side.surface && mark.name.len() == 2)
            .filter_map(|mark| Some((mark.name.strip_prefix('b')?.parse().ok()?, at(mark.node))))
            .collect();
        let centre = tips.iter().map(|(_, p)| *p).sum::<DVec3>() / tips.len() as f64;
        for face in surface.faces().iter().filter(|f| ends.iter().all(|v| f.contains(v))) {
            let apex = at(*face.iter().find(|v| !ends.contains(v)).unwrap());
            let away = (apex - a).reject_from_normalized((b - a).normalize()).normalize();
            let toward = |tip: DVec3| (tip - centre).dot(away);
            let wing = tips.iter().max_by(|(_, p), (_, q)| toward(*p).total_cmp(&toward(*q))).unwrap().0;
            assert!(out.insert(wing, away).is_none());
        }
    }
    assert_eq!(out.len(), 5);
    out
}

/// The angle in degrees by which one wing goes on straight into another: 0 when the spine is no crease of theirs.
fn crease(wings: &BTreeMap<usize, DVec3>, one: usize, other: usize) -> f64 {
    wings[&one].angle_between(-wings[&other]).to_degrees()
}

#[test]
fn the_same_wireframe_has_four_shapes() {
    let body = form();
    let templates = CONFIGURATIONS.map(|(name, ..)| sample(name));
    for template in &templates {
        let (file, first) = (template.file(), templates[0].file());
        assert_eq!(
            (&file.nodes, &file.lines),
            (&first.nodes, &first.lines),
            "one wireframe, the same profiles"
        );
    }
    let garments = templates.each_ref().map(|template| build(template, &body));
    for (garment, (name, _, surfaces, uses)) in garments.iter().zip(CONFIGURATIONS) {
        assert_eq!(garment.surfaces.len(), surfaces, "{name}");
        assert_eq!(garment.seams.iter().map(|s| s.sides.len()).collect::<Vec<_>>(), uses, "{name}");
    }
    let [one, two, three, four] = garments.each_ref().map(leaving);
    // Each surface is smooth in itself: what runs over the spine bends there by one row of triangles' share of the turn,
    // boundary edges keep all of it. The fourth's second joint is faired across.
    let cases = [(&two, 1, 5), (&four, 1, 5), (&three, 1, 4), (&three, 2, 5), (&four, 2, 4)];
    for (wings, a, b) in cases {
        let (turn, left) = (crease(&one, a, b), crease(wings, a, b));
        assert!(turn > 25.0 && left < 0.5 * turn, "{a} and {b}: {left}° of {turn}°");
    }
    assert!(crease(&two, 2, 4) > 0.9 * crease(&one, 2, 4));
    keep("configurations.png", || drawn(&body.mesh, &garments));
}

/// Draws a picture of the guide anew, when asked to.
fn keep(name: &str, draw: impl FnOnce() -> Vec<u8>) {
    let picture = root().join("docs/joints").join(name);
    if std::env::var_os("UPDATE_DOCS").is_some() {
        std::fs::create_dir_all(picture.parent().unwrap()).unwrap();
        std::fs::write(&picture, draw()).unwrap();
    }
    assert!(picture.is_file(), "run with UPDATE_DOCS=1");
}

/// The four from above and behind, as PNG.
fn drawn(body: &TriMesh, garments: &[Garment; 4]) -> Vec<u8> {
    let options = RenderOptions { occlusion: Some(Occlusion::default()), ..RenderOptions::sized(440, 360) };
    let images: Vec<_> = garments
        .iter()
        .map(|garment| {
            let cloth = SceneMesh::garment(&garment.body.to_tri_mesh());
            let alone = Scene { meshes: vec![cloth.clone()], ..Scene::default() };
            let from = DVec3::new(-0.25, 1.4, -1.0);
            let camera =
                Camera::toward(from, DVec3::Y, Lens::PORTRAIT).unwrap().fit(&alone, &options).unwrap();
            let scene = Scene { meshes: vec![SceneMesh::body(body), cloth], ..Scene::default() };
            render(&scene, &camera, &options).unwrap()
        })
        .collect();
    let parts: Vec<_> =
        CONFIGURATIONS.iter().zip(&images).map(|((_, title, ..), image)| (*title, image)).collect();
    montage(&parts, &MontageOptions { columns: 2, gap: 8, ..MontageOptions::default() }).unwrap().to_png()
}

/// Mean angle in degrees by which the two surfaces at a seam go off each other, over all edges of two-sided seams.
fn mean_crease(garment: &Garment) -> f64 {
    let mut creases: Vec<f64> = Vec::new();
    for seam in garment.seams.iter().filter(|seam| seam.sides.len() == 2) {
        for k in 1..seam.sides[0].nodes.len() {
            let normals: Vec<DVec3> = seam
                .sides
                .iter()
                .filter_map(|side| {
                    let surface = garment.body.surface(garment.surfaces[side.surface].id);
                    let ends = [side.nodes[k - 1], side.nodes[k]];
                    let face = surface.faces().iter().find(|f| ends.iter().all(|v| f.contains(v)))?;
                    let [a, b, c] = face.map(|v| surface.positions()[v as usize]);
                    Some((b - a).cross(c - a).normalize())
                })
                .collect();
            // Surfaces may be wound against each other.
            if let [one, other] = normals[..] {
                let angle = one.angle_between(other).to_degrees();
                creases.push(angle.min(180.0 - angle));
            }
        }
    }
    creases.iter().sum::<f64>() / creases.len() as f64
}

#[test]
fn fairing_across_joints_and_adaptive_splits() {
    let body = form();
    let path = root().join("samples/princess-dress.json");
    let sample = Template::from_json(&std::fs::read_to_string(path).unwrap()).unwrap();
    let changed = |change: &dyn Fn(&mut TemplateFile)| {
        let mut file = sample.file().clone();
        change(&mut file);
        build(&Template::from_json(&serde_json::to_string(&file).unwrap()).unwrap(), &body)
    };
    let one_by_one = changed(&|file| file.fair_across.clear());
    let across = changed(&|_| ());
    let adaptive = changed(&|file| file.adaptive = Some(1.5));
    let (kept, smooth) = (mean_crease(&one_by_one), mean_crease(&across));
    assert!(smooth < 0.7 * kept, "{smooth}° across, {kept}° one by one");
    let faces = |garment: &Garment| garment.body.to_tri_mesh().faces.len();
    assert!(faces(&adaptive) < faces(&across) / 2, "{} of {}", faces(&adaptive), faces(&across));
    keep("options.png", || {
        let options = RenderOptions::sized(250, 390).plain();
        let images = [&one_by_one, &across, &adaptive].map(|garment| {
            let mesh = garment.body.to_tri_mesh();
            let mut lines = Vec::new();
            for face in &mesh.faces {
                let corners = face.map(|v| mesh.positions[v as usize]);
                let points = vec![corners[0], corners[1], corners[2], corners[0]];
                lines.push(SceneLine::new(points, Color::INK, 0.4));
            }
            let alone = Scene { meshes: vec![SceneMesh::garment(&mesh)], ..Scene::default() };
            let camera = Camera::toward(DVec3::new(0.5, 0.2, 1.0), DVec3::Y, Lens::PORTRAIT).unwrap();
            let camera = camera.fit(&alone, &options).unwrap();
            let meshes = vec![SceneMesh::body(&body.mesh), SceneMesh::garment(&mesh)];
            render(&Scene { meshes, lines, ..Scene::default() }, &camera, &options).unwrap()
        });
        let titles = ["one by one", "across joints", "adaptive"];
        let parts: Vec<_> = titles.into_iter().zip(&images).collect();
        montage(&parts, &MontageOptions { gap: 8, ..MontageOptions::default() }).unwrap().to_png()
    });
}
