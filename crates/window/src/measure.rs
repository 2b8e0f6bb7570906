//! How long hands wait, measured and not judged:
//! `cargo test --release -p window --lib -- --ignored --nocapture how_long`.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use design::draft::{BodySource, Command, Draft, DraggedForm, Edit, preview};
use design::regenerate::Settings;
use eframe::egui;
use glam::DVec2;
use mesh_kernel::TriMesh;
use reference::dress_form::{DressForm, FormOptions, Measurements};

use crate::designer::{Designer, Start};
use crate::selection::Mode;
use crate::tools::{Event, Tool};

/// What calls took, ms.
struct Waits {
    /// 95 of 100 stay under it.
    p95: f64,
    /// What a machine with nothing else to do would take.
    least: f64,
}

impl std::fmt::Display for Waits {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let places = f.precision().unwrap_or(1);
        write!(f, "{:.places$} (least {:.places$})", self.p95, self.least)
    }
}

fn p95(count: usize, mut call: impl FnMut(usize)) -> Waits {
    let mut times: Vec<f64> = (0..count)
        .map(|k| {
            let started = Instant::now();
            call(k);
            1000.0 * started.elapsed().as_secs_f64()
        })
        .collect();
    times.sort_by(f64::total_cmp);
    Waits { p95: times[(count * 95 / 100).min(count - 1)], least: times[0] }
}

fn dress() -> Draft {
    Draft::from_bytes(crate::files::LIBRARY[0].1.as_bytes()).unwrap()
}

/// A designer whose garment is built, seen in a picture of 1280 × 800.
fn designer(state: &std::path::Path) -> Designer {
    let started = Instant::now();
    let mut designer = Designer::new(Start { state: state.to_owned(), ..Start::new(dress()) });
    let context = egui::Context::default();
    let mut seen = None;
    while !designer.is_built() {
        designer.refresh(&context);
        if designer.model.cloth.is_some() {
            seen.get_or_insert_with(|| started.elapsed());
        }
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    println!("body and garment are seen after {seen:.2?}, built after {:.2?}", started.elapsed());
    designer.view.eye.camera.size = DVec2::new(1280.0, 800.0);
    designer.frame_all();
    designer
}

/// Every triangle in four.
fn quartered(mesh: &TriMesh) -> TriMesh {
    let mut positions = mesh.positions.clone();
    let mut middles = std::collections::BTreeMap::new();
    let mut faces = Vec::with_capacity(4 * mesh.faces.len());
    for [a, b, c] in &mesh.faces {
        let [ab, bc, ca] = [[*a, *b], [*b, *c], [*c, *a]].map(|[p, q]| {
            *middles.entry([p.min(q), p.max(q)]).or_insert_with(|| {
                positions.push(0.5 * (mesh.positions[p as usize] + mesh.positions[q as usize]));
                positions.len() as u32 - 1
            })
        });
        faces.extend([[*a, ab, ca], [ab, *b, bc], [ca, bc, *c], [ab, bc, ca]]);
    }
    TriMesh::new(positions, faces)
}

#[test]
#[ignore = "a measurement"]
fn how_long() {
    let folder = tempfile::tempdir().unwrap();
    let mut d = designer(folder.path());
    let draft = Arc::clone(d.session.draft());
    let on = d.model.body.as_ref().map(|b| b.on.clone()).unwrap();
    println!(
        "body {} triangles, garment {}",
        on.body.mesh.faces.len(),
        d.model.cloth.as_ref().unwrap().mesh.faces.len()
    );

    let place = |name: &str| d.view.eye.camera.project(d.model.places[name]).unwrap();
    let (a, b) = (place("front_hip"), place("front_thigh"));
    d.take_tool(Tool::Sketch);
    d.tool_event(Event::DragStart { from: a });
    let ink = p95(200, |k| {
        let t = k as f64 / 199.0;
        let to = a.lerp(b, t) + DVec2::X * 6.0 * (3.0 * t).sin();
        d.tool_event(Event::Drag { to });
        let world = d.world(1.0);
        std::hint::black_box(d.machine.ghosts(Some(to), &world));
    });
    println!("ink: a move of the pen {ink:.2} ms, and the frame");
    let entries = d.session.history().labels().1;
    let release = p95(1, |_| d.tool_event(Event::DragEnd { to: b, add: false }));
    let drawn = d.session.history().labels().1 - entries;
    println!("stroke release: profile {release:.1} ms ({drawn} entries)");

    let levels = [1u8, 2, 3];
    let stop = AtomicBool::new(false);
    for level in levels {
        let mut faces = 0;
        let cold = p95(20, |_| {
            let made = preview(&draft, &on, level, &template::WarmStart::default(), &stop).unwrap();
            faces = made.body.to_tri_mesh().faces.len();
        });
        let warm = template::WarmStart::default();
        let mut dragged = (*draft).clone();
        let eased = p95(60, |k| {
            dragged.template.ease.values_mut().for_each(|e| e.ease += if k < 30 { 2.0 } else { -2.0 });
            drop(preview(&dragged, &on, level, &warm, &stop).unwrap());
        });
        let moved = p95(60, |k| {
            dragged.template.nodes.get_mut("front_hip").unwrap().normal += if k < 30 { 1.0 } else { -1.0 };
            drop(preview(&dragged, &on, level, &warm, &stop).unwrap());
        });
        println!(
            "preview of {faces} triangles: first {cold:.1} ms; an ease dragged {eased:.1} ms, a node {moved:.1} ms"
        );
    }
    let BodySource::Form(measurements) = &*draft.body else { unreachable!() };
    let form = DraggedForm::new(measurements, &on.body, crate::jobs::PREVIEW_BODY).unwrap().unwrap();
    let waist = measurements.resolve().unwrap().waist;
    let warm = template::WarmStart::default();
    let mut parts = [0.0; 2];
    let mut seconds = template::Seconds::default();
    let sized = p95(60, |k| {
        let wider = waist + 0.1 * (30.0 - (k as f64 - 30.0).abs());
        let started = Instant::now();
        let (on, _) = form.at(&Measurements { waist: Some(wider), ..measurements.clone() }).unwrap();
        parts[0] += started.elapsed().as_secs_f64();
        seconds = preview(&draft, &on, 2, &warm, &stop).unwrap().seconds;
        parts[1] += started.elapsed().as_secs_f64();
    });
    let [body, garment] = parts.map(|s| 1000.0 * s / 60.0);
    println!(
        "a measurement dragged: {sized:.1} ms; in the mean {body:.1} ms to the body, {garment:.1} ms with the garment: {seconds:.4?}"
    );
    let shown = p95(20, |_| {
        d.show_solids();
        let meshes: Vec<_> = crate::view::scene::garment(&d.model, &d.look).into_iter().collect();
        std::hint::black_box(viewer::MeshBuffer::of(&meshes));
    });
    println!("a new garment in the view: {shown:.1} ms");
    for triangles in [crate::jobs::PREVIEW_BODY, FormOptions::default().triangles] {
        let options = FormOptions { triangles, ..FormOptions::default() };
        let build = || DressForm::build(&Measurements::default(), &options).unwrap().mesh;
        let form = p95(5, |_| drop(build()));
        let mesh = build();
        let extract = || reference::human::extract(&mesh, &Default::default()).unwrap();
        let features = p95(5, |_| drop(extract()));
        let body = extract();
        let prepared = p95(5, |_| drop(template::Prepared::new(&body.mesh)));
        let caster = p95(5, |_| drop(mesh_kernel::query::RayCaster::new(&body.mesh)));
        println!(
            "a form of {} triangles: {form:.1} ms, its features {features:.1} ms, prepared {prepared:.1} ms, for rays {caster:.1} ms",
            mesh.faces.len()
        );
    }
    let coarse = p95(5, |_| drop(draft.body.load(Some(crate::jobs::PREVIEW_BODY)).unwrap()));
    println!("a coarse body: {coarse:.1} ms");
    println!("the body: {:.1} ms", p95(3, |_| drop(draft.body.load(None))));
    let whole = p95(5, |_| drop(draft.build(&on, &Settings::default(), &|_| true)));
    println!("whole garment with pattern: {whole:.1} ms");

    let level = draft.template.ease.keys().next().unwrap().clone();
    let ease = draft.template.ease[&level].clone();
    for k in 0..20 {
        let ease = Some(template::format::EaseSpec { ease: 40.0 + f64::from(k), ..ease.clone() });
        d.command(Command::Edit(Edit::SetEase { level: level.clone(), ease }));
    }
    println!("undo: {:.2} ms", p95(20, |_| d.command(Command::Undo)));
    println!("redo: {:.2} ms", p95(20, |_| d.command(Command::Redo)));

    let options = FormOptions { triangles: 80_000, ..FormOptions::default() };
    let form = DressForm::build(&Measurements::default(), &options).unwrap().mesh;
    let large = quartered(&form);
    d.view.solids.body = Some(Arc::new(mesh_kernel::query::RayCaster::new(&large)));
    for (mode, name) in Mode::ALL {
        let time = p95(2000, |k| {
            let at = DVec2::new(300.0 + 0.34 * k as f64, 100.0 + (k * 37 % 600) as f64);
            std::hint::black_box(d.picker().all(at, mode));
        });
        println!("hover pick of {name} on {} triangles: {time:.3} ms", large.faces.len());
    }
}
