//! Queries against values of libigl (`tests/reference/make_queries.py`).

use mesh_kernel::TriMesh;
use mesh_kernel::files::read;
use mesh_kernel::glam::DVec3;
use mesh_kernel::query::{ClosestPoint, Geodesics, SignedDistance, WindingNumber, winding_number};
use serde_json::Value;

fn data(name: &str) -> std::path::PathBuf {
    std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/reference/data").join(name)
}

fn floats(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect()
}

fn records() -> Vec<(TriMesh, Value)> {
    let text = std::fs::read_to_string(data("queries.json")).unwrap();
    let all: Value = serde_json::from_str(&text).unwrap();
    let mesh = |name: &str| (read(&data(&format!("{name}.obj"))).unwrap(), all[name].clone());
    vec![mesh("bumpy-sphere"), mesh("holed-torus")]
}

#[test]
fn distances_and_winding_numbers() {
    for (mesh, record) in records() {
        let (closest, signed, fast) =
            (ClosestPoint::new(&mesh), SignedDistance::new(&mesh), WindingNumber::new(&mesh));
        let (distances, windings) = (floats(&record["distance"]), floats(&record["winding"]));
        let area: f64 = (0..mesh.faces.len() as u32).map(|f| mesh.area_normal(f).length() / 2.0).sum();
        assert!((area / record["area"].as_f64().unwrap() - 1.0).abs() < 1e-12);
        let points = record["points"].as_array().unwrap();
        assert!(points.len() == 300 && distances.len() == 300 && windings.len() == 300);
        for (p, (distance, winding)) in points.iter().zip(distances.into_iter().zip(windings)) {
            let p = DVec3::from_slice(&floats(p));
            assert!((closest.closest(p).unwrap().distance - distance).abs() < 1e-9, "{p}");
            assert!((winding_number(&mesh, p) - winding).abs() < 1e-9, "{p}");
            let approximate = fast.winding(p, 1e-4);
            assert!((approximate.value - winding).abs() <= approximate.error + 1e-9, "{p}");
            let signed = signed.signed(p).distance;
            assert!((signed.abs() - distance).abs() < 1e-9 && (signed < 0.0) == (winding > 0.5), "{p}");
        }
    }
}

#[test]
fn exact_geodesics() {
    let (mesh, record) = records().swap_remove(0);
    let paths = Geodesics::new(&mesh);
    let record = &record["geodesic"];
    let at = |v: &Value| mesh.positions[v.as_u64().unwrap() as usize];
    let mut longer = 0;
    for (target, length) in record["targets"].as_array().unwrap().iter().zip(floats(&record["length"])) {
        let path = paths.path(at(&record["source"]), at(target)).unwrap();
        // Never shorter than the shortest; nearly always the same, at worst another geodesic nearby.
        assert!(path.length > length * (1.0 - 1e-7), "{} {length}", path.length);
        assert!(path.length < length * 1.02, "{} {length}", path.length);
        longer += usize::from(path.length > length * (1.0 + 1e-6));
    }
    println!("{longer} of 60 paths are another geodesic than the shortest");
    assert!(longer <= 9, "{longer}");
}
