//! Prints the features of a body mesh (OBJ) as JSON.

fn main() {
    let Some(path) = std::env::args().nth(1) else { return };
    let text = std::fs::read_to_string(&path).unwrap_or_default();
    let mut mesh = mesh_kernel::TriMesh::default();
    for line in text.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let c: Vec<f64> = words.filter_map(|w| w.parse().ok()).collect();
                mesh.positions.push(mesh_kernel::glam::DVec3::new(c[0], c[1], c[2]));
            }
            Some("f") => {
                let v: Vec<u32> =
                    words.filter_map(|w| w.split('/').next()?.parse::<u32>().ok()).map(|i| i - 1).collect();
                for k in 2..v.len() {
                    mesh.faces.push([v[0], v[k - 1], v[k]]);
                }
            }
            _ => {}
        }
    }
    let started = std::time::Instant::now();
    let found = reference::human::extract(&mesh, &reference::human::HumanOptions::default());
    let seconds = started.elapsed().as_secs_f64();
    use std::io::Write;
    let mut out = std::io::stdout().lock();
    match found {
        Ok(body) => {
            let mut value = serde_json::to_value(body.exported()).unwrap_or_default();
            value["seconds"] = seconds.into();
            let _ = writeln!(out, "{value}");
        }
        Err(e) => {
            let _ = writeln!(out, "{{\"error\": {:?}, \"seconds\": {seconds}}}", e.to_string());
        }
    }
}
