//! Scripts of modelling commands: text in, a sheet's or solid's mesh and a report out.

use mesh_kernel::TriMesh;
use mesh_kernel::body::Counts;
use serde::Serialize;
use sheet::model::{ExtrusionCase, Limits, Model, Reading, Script, ScriptError, Touching, touching};

/// What `toile model` reports. Coordinates and lengths in millimetres.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ModelReport {
    /// Commands carried out.
    pub commands: usize,
    /// Counts of the model; `v − e + f − r = c − ch + cc`.
    pub counts: ModelCounts,
    /// Whether the two sides of the identity, found independently, agree.
    pub identity_holds: bool,
    /// Patches.
    pub patches: Vec<String>,
    /// Wires that are no sheets yet.
    pub wires: Vec<String>,
    /// Patches with unlimited material behind them.
    pub partial: Vec<String>,
    /// Whether the faces bound material.
    pub solid: bool,
    /// Where a solid touches itself, with both readings.
    pub touching: Vec<TouchingReport>,
    /// Answers of commands that have one.
    pub answers: Vec<String>,
    /// The mesh's file.
    pub file: String,
    /// The whole command.
    pub seconds: f64,
}

/// Counts of a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct ModelCounts {
    /// Vertices.
    pub v: i64,
    /// Edges.
    pub e: i64,
    /// Faces.
    pub f: i64,
    /// Rings.
    pub r: i64,
    /// Components.
    pub c: i64,
    /// Holes.
    pub ch: i64,
    /// Enclosed volumes.
    pub cc: i64,
}

impl From<Counts> for ModelCounts {
    fn from(c: Counts) -> Self {
        Self { v: c.v, e: c.e, f: c.f, r: c.r, c: c.c, ch: c.ch, cc: c.cc }
    }
}

/// A place where a solid touches itself.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TouchingReport {
    /// Ends of the edge, or the node.
    pub at: Vec<[f64; 3]>,
    /// Sheets at the edge, or fans at the node.
    pub sheets: usize,
    /// 'Touch and join': one material across.
    pub join: ReadingReport,
    /// 'Touch but miss': parts of their own.
    pub miss: ReadingReport,
}

/// What one of the readings gives.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ReadingReport {
    /// The counts of the triangulated model then.
    Counts(ModelCounts),
    /// Why there is no such reading.
    Refused(String),
}

/// What a script made.
#[derive(Clone, Debug)]
pub struct Modelled {
    /// The model.
    pub model: Model,
    /// Its faces; groups are patches.
    pub mesh: TriMesh,
    /// The report; `file` and `seconds` are the caller's.
    pub report: ModelReport,
}

/// Runs a script on an empty model.
///
/// # Errors
/// [`ScriptError`] with line and command.
pub fn model(script: &str) -> Result<Modelled, ScriptError> {
    let script = Script::read(script)?;
    let run = script.run(Limits::default())?;
    let mesh = run.model.to_mesh();
    let counts = run.model.complex().counts();
    let solid = is_solid(&mesh);
    let places = if solid && run.model.partial_patches().is_empty() {
        touching(&mesh).unwrap_or_default()
    } else {
        Vec::new()
    };
    let mut answers = Vec::new();
    for ((number, (line, command)), done) in (1..).zip(&script.commands).zip(&run.done) {
        let place = format!("line {line}, command {number} ({})", command.name());
        if let Some(ExtrusionCase::InnerEdges(edges)) = &done.extrusion {
            answers.push(format!(
                "{place}: {} inner edges where the wire runs along the extrusion",
                edges.len()
            ));
        }
        if done.merged_vertices > 0 {
            answers.push(format!(
                "{place}: {} corners and {} edges were joined",
                done.merged_vertices,
                done.merged_edges.len()
            ));
        }
    }
    let report = ModelReport {
        commands: script.commands.len(),
        counts: counts.into(),
        identity_holds: counts.identity_holds(),
        patches: run.model.patches(),
        wires: run.model.wires(),
        partial: run.model.partial_patches(),
        solid,
        touching: places.iter().map(reported).collect(),
        answers,
        file: String::new(),
        seconds: 0.0,
    };
    Ok(Modelled { model: run.model, mesh, report })
}

/// Whether every edge is walked as often one way as the other.
fn is_solid(mesh: &TriMesh) -> bool {
    let mut sides: Vec<([u32; 2], i32)> = mesh
        .faces
        .iter()
        .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
        .map(|[a, b]| if a < b { ([a, b], 1) } else { ([b, a], -1) })
        .collect();
    sides.sort_unstable();
    !sides.is_empty()
        && sides.chunk_by(|a, b| a.0 == b.0).all(|same| same.iter().map(|s| s.1).sum::<i32>() == 0)
}

fn reported(place: &Touching) -> TouchingReport {
    let reading = |r: &Reading| match r {
        Reading::Counts(counts) => ReadingReport::Counts((*counts).into()),
        Reading::Refused(why) => ReadingReport::Refused(why.clone()),
    };
    TouchingReport {
        at: place.at.iter().map(|p| p.to_array()).collect(),
        sheets: place.sheets,
        join: reading(&place.join),
        miss: reading(&place.miss),
    }
}
