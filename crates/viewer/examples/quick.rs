//! A quick look at a model: `quick MODEL.obj OUT.png [VIEW] [BODY.obj]`.
//!
//! Views: front, back, left, right, top, bottom, iso, or `all` for four side by side. Groups get their own colours.

use std::error::Error;
use std::path::Path;

use glam::DVec3;
use mesh_kernel::{Group, TriMesh};
use viewer::{Camera, Lens, MontageOptions, RenderOptions, Scene, SceneMesh, View, montage, render};

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [model, out, rest @ ..] = words.as_slice() else {
        return Err("quick MODEL.obj OUT.png [front|back|left|right|top|bottom|iso|all] [BODY.obj]".into());
    };
    let mesh = read_obj(Path::new(model))?;
    let mut scene = Scene::default();
    let is_body = mesh.groups.len() < 2 && rest.len() < 2;
    scene.meshes.push(if is_body { SceneMesh::body(&mesh) } else { SceneMesh::garment(&mesh) });
    if let Some(body) = rest.get(1) {
        scene.meshes.push(SceneMesh::body(&read_obj(Path::new(body))?));
    }
    let views: Vec<(String, View)> = match rest.first().map(String::as_str).unwrap_or("front") {
        "all" => [View::Front, View::Left, View::Back, View::Iso].map(|v| (format!("{v:?}"), v)).to_vec(),
        name => {
            let found = View::ALL.into_iter().find(|v| format!("{v:?}").to_lowercase() == name);
            vec![(String::new(), found.ok_or("unknown view")?)]
        }
    };
    let options = if views.len() > 1 { RenderOptions::sized(560, 1100) } else { RenderOptions::default() };
    let mut cameras = Vec::new();
    for (_, view) in &views {
        let lens = if *view == View::Iso { Lens::PORTRAIT } else { Lens::Orthographic };
        cameras.push(Camera::new(*view, lens).fit(&scene, &options)?);
    }
    // One scale for all.
    let height = cameras.iter().map(|c| c.height).fold(0.0, f64::max);
    let mut images = Vec::new();
    for ((name, view), camera) in views.iter().zip(cameras) {
        let options = RenderOptions { floor: *view == View::Iso, ..options.clone() };
        let camera = Camera { height, ..camera };
        images.push((name.as_str(), render(&scene, &camera, &options)?));
    }
    let parts: Vec<_> = images.iter().map(|(name, image)| (*name, image)).collect();
    std::fs::write(out, montage(&parts, &MontageOptions::default())?.to_png())?;
    Ok(())
}

/// Positions, faces (fans) and groups of an OBJ.
fn read_obj(path: &Path) -> Result<TriMesh, Box<dyn Error>> {
    let text = std::fs::read_to_string(path)?;
    let mut mesh = TriMesh::default();
    for line in text.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let x: Vec<f64> = words.take(3).map(str::parse).collect::<Result<_, _>>()?;
                mesh.positions.push(DVec3::from_slice(&x));
            }
            Some("f") => {
                let nodes: Vec<u32> = words
                    .map(|w| w.split('/').next().unwrap_or(w).parse::<i64>())
                    .map(|i| i.map(|i| if i < 0 { mesh.positions.len() as i64 + i } else { i - 1 } as u32))
                    .collect::<Result<_, _>>()?;
                mesh.faces.extend((2..nodes.len()).map(|i| [nodes[0], nodes[i - 1], nodes[i]]));
            }
            Some("g" | "o") => {
                let at = mesh.faces.len() as u32;
                mesh.groups.push(Group { name: words.collect::<Vec<_>>().join(" "), faces: at..at });
            }
            _ => {}
        }
        if let Some(group) = mesh.groups.last_mut() {
            group.faces.end = mesh.faces.len() as u32;
        }
    }
    mesh.groups.retain(|g| !g.faces.is_empty());
    Ok(mesh)
}
