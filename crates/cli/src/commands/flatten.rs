//! `toile flatten`: any mesh to flat pieces.

use design::units::FileUnit;
use mesh_kernel::TriMesh;
use mesh_kernel::files::{Format, WriteOptions, to_bytes};
use mesh_kernel::glam::DVec3;
use pattern::{DxfOptions, FlattenMeshOptions, Paper, Pattern, PdfOptions, SvgOptions, flatten_mesh};
use serde::Serialize;

use super::{extension, file_name, read_mesh, write};
use crate::failure::Failure;
use crate::speech::{Speech, table};
use crate::words::{Flatten, Unit};

#[derive(Serialize)]
struct Flattened {
    file: String,
    pieces: Vec<FlatPiece>,
    seams: usize,
    largest_mismatch: f64,
    /// Millimetres in one unit of the mesh.
    unit_mm: f64,
    warnings: Vec<String>,
}

#[derive(Serialize)]
struct FlatPiece {
    name: String,
    #[serde(flatten)]
    report: pattern::PieceReport,
}

/// The kinds of files that pieces are written to.
enum Kind {
    Svg,
    Dxf,
    Pdf,
    Obj,
}

pub(crate) fn run(words: &Flatten, speech: &Speech) -> Result<(), Failure> {
    let kind = match extension(&words.output).as_str() {
        "svg" => Kind::Svg,
        "dxf" => Kind::Dxf,
        "pdf" => Kind::Pdf,
        "obj" => Kind::Obj,
        _ => return Err(Failure::words("the file of pieces must end in .svg, .dxf, .pdf or .obj")),
    };
    let cuts = words.cut.as_deref().map(chains).transpose()?.unwrap_or_default();
    speech.step("reading");
    let mut mesh = read_mesh(&words.mesh)?;
    if let Some(node) = cuts.iter().flatten().find(|n| **n as usize >= mesh.positions.len()) {
        let (node, nodes) = (node + 1, mesh.positions.len());
        return Err(Failure::new(format!(
            "--cut names node {node}, but {} has {nodes}",
            words.mesh.display()
        )));
    }
    let (said, format) = (words.unit.map(Unit::millimetres), Format::of_path(&words.mesh));
    // What is drawn is to be cut; a mesh keeps its numbers.
    let unit = match kind {
        Kind::Obj => FileUnit::of_format(said, format),
        Kind::Svg | Kind::Dxf | Kind::Pdf => FileUnit::of_pieces(said, format, &mesh),
    };
    for p in &mut mesh.positions {
        *p *= unit.millimetres;
    }
    speech.step("flattening");
    let options = FlattenMeshOptions { cuts, allowance_mm: words.allowance, ..FlattenMeshOptions::default() };
    let pattern = flatten_mesh(&mesh, &options).map_err(|e| Failure::from(e).about(&words.mesh))?;
    let title = file_name(&words.mesh);
    let bytes = match kind {
        Kind::Svg => pattern::to_svg(&pattern, &SvgOptions { title, ..SvgOptions::default() }).into_bytes(),
        Kind::Dxf => {
            let style_name = title;
            pattern::to_dxf(&pattern, &DxfOptions { style_name, ..DxfOptions::default() }).into_bytes()
        }
        Kind::Pdf => {
            pattern::to_pdf(&pattern, &PdfOptions { title, paper: Paper::A4, ..PdfOptions::default() })
        }
        Kind::Obj => to_bytes(Format::Obj, &flat_mesh(&pattern), &WriteOptions::default()),
    };
    write(&words.output, &bytes)?;
    let warnings: Vec<String> = unit.warning().into_iter().chain(pattern.warnings.iter().cloned()).collect();
    for warning in &warnings {
        speech.warn(warning);
    }
    let done = Flattened {
        file: words.output.display().to_string(),
        pieces: pattern
            .pieces
            .iter()
            .map(|p| FlatPiece { name: p.name.clone(), report: p.report.clone() })
            .collect(),
        seams: pattern.seams.len(),
        largest_mismatch: pattern.seams.iter().map(|s| s.mismatch).fold(0.0, f64::max),
        unit_mm: unit.millimetres,
        warnings,
    };
    speech.report(&done, || summary(&done))
}

fn summary(done: &Flattened) -> String {
    let rows: Vec<Vec<String>> = done
        .pieces
        .iter()
        .map(|p| {
            vec![
                p.name.clone(),
                format!("{:.1}", p.report.area_2d / 100.0),
                format!("{:.2}", 100.0 * p.report.mean_stretch),
                format!("{:.2}", 100.0 * p.report.max_stretch),
                p.report.flipped.to_string(),
                p.report.overlaps.to_string(),
            ]
        })
        .collect();
    let mut text = table(&["piece", "area [cm²]", "stretch [%]", "most [%]", "flipped", "overlaps"], &rows);
    text.push_str(&format!(
        "  {} seams, largest mismatch {:.3} mm; written to {}\n",
        done.seams, done.largest_mismatch, done.file
    ));
    text
}

/// The pieces as they lie on the cloth, a group each, z = 0.
fn flat_mesh(pattern: &Pattern) -> TriMesh {
    let mut mesh = TriMesh::default();
    for ((flat, piece), offset) in pattern.flats.iter().zip(&pattern.pieces).zip(&pattern.layout.offsets) {
        let (first_node, first_face) = (mesh.positions.len() as u32, mesh.faces.len() as u32);
        mesh.positions.extend(flat.uv.iter().map(|p| DVec3::from((*p + *offset, 0.0))));
        mesh.faces.extend(flat.faces.iter().map(|f| f.map(|v| v + first_node)));
        let faces = first_face..mesh.faces.len() as u32;
        mesh.groups.push(mesh_kernel::Group { name: piece.name.clone(), faces });
    }
    mesh
}

/// `3-17-9;4-5`: chains of node numbers, counted from 1.
pub(super) fn chains(text: &str) -> Result<Vec<Vec<u32>>, Failure> {
    let bad = || {
        Failure::words(format!(
            "--cut takes chains of node numbers from 1, such as \"3-17-9;4-5\", not {text:?}"
        ))
    };
    let node = |word: &str| match word.trim().parse::<u32>() {
        Ok(n) if n > 0 => Ok(n - 1),
        _ => Err(bad()),
    };
    text.split(';')
        .map(str::trim)
        .filter(|c| !c.is_empty())
        .map(|chain| {
            let nodes = chain.split('-').map(node).collect::<Result<Vec<u32>, Failure>>()?;
            if nodes.len() < 2 { Err(bad()) } else { Ok(nodes) }
        })
        .collect()
}
