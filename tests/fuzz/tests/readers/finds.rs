//! What fuzzing and looking for more of its kind found, a test each.

use design::document::{Document, DocumentError};
use mesh_kernel::body::Body;
use mesh_kernel::files::{Format, ReadError, parse};

use crate::designs::{document, templates};

#[test]
fn ply_with_two_vertex_elements() {
    // Texture coordinates of the second element alone were looked up with the numbers of both: a panic.
    let vertices = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
    let flats = "property float s\nproperty float t\n";
    let face = "element face 1\nproperty list uchar int vertex_index\nend_header\n";
    let text = format!(
        "ply\nformat ascii 1.0\n{vertices}{vertices}{flats}{face}0 0 0\n1 0 0\n0 1 0\n\
         0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 3 4 5\n"
    );
    let error = parse(Format::Ply, text.as_bytes()).unwrap_err();
    assert!(matches!(error, ReadError::Malformed { .. }), "{error}");
}

#[test]
fn ply_with_the_axes_in_two_elements() {
    // The missing axes were read as zero.
    let text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nelement vertex 3\nproperty float y\n\
        property float z\nelement face 1\nproperty list uchar int vertex_index\nend_header\n\
        0\n1\n2\n0 0\n1 0\n0 1\n3 0 1 2\n";
    let error = parse(Format::Ply, text.as_bytes()).unwrap_err();
    assert!(matches!(error, ReadError::WrongMagic { .. }), "{error}");
}

/// A glTF of `nodes` nodes that all show one mesh of `primitives` primitives on the same `vertices` vertices.
fn instances(nodes: usize, primitives: usize, vertices: usize) -> String {
    let list = |what: &str, count: usize| vec![what; count].join(",");
    let roots: Vec<String> = (0..nodes).map(|k| k.to_string()).collect();
    format!(
        r#"{{"asset":{{"version":"2.0"}},"scenes":[{{"nodes":[{}]}}],"nodes":[{}],"meshes":[{{"primitives":[{}]}}],
        "accessors":[{{"bufferView":0,"componentType":5121,"count":{vertices},"type":"VEC3"}}],
        "bufferViews":[{{"buffer":0,"byteLength":{bytes}}}],
        "buffers":[{{"byteLength":{bytes},"uri":"data:;base64,{}"}}]}}"#,
        roots.join(","),
        list(r#"{"mesh":0}"#, nodes),
        list(r#"{"attributes":{"POSITION":0},"mode":5}"#, primitives),
        "AAAA".repeat(vertices),
        bytes = 3 * vertices,
    )
}

#[test]
fn gltf_that_unfolds_to_the_square_of_its_size() {
    // Parts that come again are a model; the 64 KiB that made a gigabyte of memory are none.
    let model = parse(Format::Glb, instances(40, 2, 100).as_bytes()).unwrap();
    assert_eq!((model.positions.len(), model.faces.len()), (4_000, 40 * 2 * 98));
    for (nodes, primitives) in [(2_000, 1), (1, 800)] {
        let error = parse(Format::Glb, instances(nodes, primitives, 5_000).as_bytes()).unwrap_err();
        assert!(matches!(error, ReadError::TooMany { .. }), "{error}");
    }
}

#[test]
fn gltf_messages_do_not_quote_the_whole_file() {
    let long = "long ".repeat(2_000);
    for text in [
        format!(r#"{{"asset":{{"version":"{long}"}}}}"#),
        format!(r#"{{"asset":{{"version":"2.0"}},"extensionsRequired":["{long}compression"]}}"#),
        format!(r#"{{"asset":{{"version":"2.0"}},"scene":"{long}"}}"#),
        instances(1, 1, 3).replace("VEC3", &long),
    ] {
        let error = parse(Format::Glb, text.as_bytes()).unwrap_err();
        assert!(error.to_string().len() < 400, "{error}");
    }
}

#[test]
fn design_with_a_placement_that_leads_nowhere() {
    let good = document(&templates()[0]);
    for change in [
        (|d: &mut Document| d.body.placement.scale = 0.0) as fn(&mut Document),
        |d| d.body.placement.scale = -0.001,
        |d| d.body.placement.rotation = [[0.0; 3]; 3],
        |d| d.body.placement.rotation[0] = [0.0, 0.0, 1.0],
        |d| d.body.placement.rotation[1] = [0.0, 1.5, 0.0],
    ] {
        let mut design = good.clone();
        change(&mut design);
        let error = Document::from_bytes(&design.to_bytes()).unwrap_err();
        assert!(matches!(error, DocumentError::Placement), "{error}");
    }
}

#[test]
fn design_with_more_splits_than_a_template_may_have() {
    let mut design = document(&templates()[0]);
    design.levels = Some(200);
    let error = Document::from_bytes(&design.to_bytes()).unwrap_err();
    assert!(matches!(error, DocumentError::Levels { levels: 200 }), "{error}");
}

#[test]
fn template_with_an_unknown_name_of_many_letters() {
    // The guess what was meant compared every letter with every other.
    let name = "n".repeat(30_000);
    let text = templates()[0].replace(r#""rows":[["b","#, &format!(r#""rows":[["{name}","#));
    let many: String = (0..200).map(|k| format!(r#""{k}{}":{{"at":"crown"}},"#, "m".repeat(99))).collect();
    let text = text.replacen(r#""nodes":{"#, &format!(r#""nodes":{{{many}"#), 1);
    let error = template::Template::from_json(&text).unwrap_err();
    assert!(error.to_string().contains("there is no node"), "{error}");
}

#[test]
fn messages_do_not_quote_names_of_any_length() {
    let long = "\u{1f9f5}\u{0}".repeat(5_000);
    let text = templates()[0].replace("\"waist\",\"toward\"", "\"waist\",\"towards\"");
    for text in [
        text.replace("towards", &serde_json::to_string(&long).unwrap().replace('"', "")),
        templates()[0].replace(r#""rows":[["b","#, &format!(r#""rows":[[{},"#, serde_json::json!(long))),
        templates()[0].replace(r#""level":2"#, &format!(r#""level":{}"#, serde_json::json!(long))),
    ] {
        let error = template::Template::from_json(&text).unwrap_err();
        assert!(error.to_string().len() < 3_000, "{error}");
    }
    let design = String::from_utf8(document(&templates()[0]).to_bytes()).unwrap();
    let design = design.replace(r#""levels":2"#, &format!(r#""levels":{}"#, serde_json::json!(long)));
    let error = Document::from_bytes(design.as_bytes()).unwrap_err();
    assert!(error.to_string().len() < 3_000, "{error}");
    let body = r#"{"format":"toile-body","version":1,"surfaces":[{"name":"s","positions":[[0,0,0]],"edges":[],"faces":[],
        "chains":[{"start":0,"edges":[]}],"loops":[LOOPS]}]}"#
        .replace("LOOPS", &["[0]"; 3_000].join(","));
    let error = Body::from_file_bytes(body.as_bytes()).unwrap_err();
    assert!(error.to_string().len() < 1_000, "{error}");
}
