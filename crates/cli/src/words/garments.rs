//! Words of what makes garments: forms, features, templates on bodies, patterns.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use template::format::DEEPEST;

use super::Unit;

/// What `regenerate` can write.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    Obj,
    Glb,
    Dxf,
    Svg,
    Pdf,
    Json,
    Png,
    Toile,
    /// garment.body.json, for programs: written only when named
    Body,
}

/// Rebuild a template on a body: features, surfaces, patterns, files.
///
/// The template may also be a design that was rebuilt before (design.toile) or drawn in the window (.toile): what counts is the
/// template in it.
///
/// Example: toile regenerate samples/princess-dress.json --body samples/form-12.obj --out out/dress
#[derive(Debug, Args)]
pub(crate) struct Regenerate {
    /// The feature template (JSON), or a design with one (.toile).
    pub(crate) template: PathBuf,
    /// The body: OBJ, PLY, STL, OFF or GLB.
    #[arg(long, value_name = "MESH")]
    pub(crate) body: PathBuf,
    /// Folder for the results; made when missing.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) build: Build,
}

/// How a garment is built and what is written of it.
#[derive(Debug, Args)]
pub(crate) struct Build {
    /// What to write, separated by commas. Default: everything but body.
    #[arg(long, value_name = "LIST", value_enum, value_delimiter = ',')]
    pub(crate) formats: Vec<Format>,
    /// How often every triangle of the template is split in four. Default: what the template says.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(0..=i64::from(DEEPEST)))]
    pub(crate) levels: Option<u8>,
    /// Name of the size, as printed on the pieces.
    #[arg(long, value_name = "NAME", default_value = "MADE TO MEASURE")]
    pub(crate) sample_size: String,
    /// Paper of the PDF.
    #[arg(long, value_enum, default_value_t = Paper::A4)]
    pub(crate) paper: Paper,
    /// Whose habits the DXF follows.
    #[arg(long, value_enum, default_value_t = Dialect::Astm)]
    pub(crate) dxf: Dialect,
    /// Unit of the body's file. Default: told from the height (metres, centimetres, millimetres).
    #[arg(long, value_enum)]
    pub(crate) unit: Option<Unit>,
}

/// Sheets of the PDF.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Paper {
    A4,
    A3,
    A0,
    Letter,
    /// One page as large as the layout.
    Plotter,
}

/// Dialects of the cutting room's DXF.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Dialect {
    Astm,
    Aama,
    Gerber,
    Clo,
    Richpeace,
}

/// The same template on many bodies; a body that fails is reported and the others go on. Can be resumed.
///
/// Example: toile batch samples/princess-dress.json --bodies scans/ --out out/
#[derive(Debug, Args)]
pub(crate) struct Batch {
    /// The feature template (JSON), or a design with one (.toile).
    pub(crate) template: PathBuf,
    /// A folder of meshes, or a text file with one path a line.
    #[arg(long, value_name = "DIR_OR_LIST")]
    pub(crate) bodies: PathBuf,
    /// Folder for the results: a folder a body, and `batch.json`.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// Do only the I-th of N parts of the list (1 ≤ I ≤ N), so that several machines can share it.
    #[arg(long, value_name = "I/N")]
    pub(crate) shard: Option<String>,
    /// Build again what an earlier run has finished.
    #[arg(long)]
    pub(crate) again: bool,
    #[command(flatten)]
    pub(crate) build: Build,
}

/// Find the landmarks, feature curves and girths of a body.
///
/// Example: toile features body.obj -o features.json --picture features.png
#[derive(Debug, Args)]
pub(crate) struct Features {
    /// The body.
    pub(crate) mesh: PathBuf,
    /// Write the features as JSON.
    #[arg(short, long, value_name = "FILE.json")]
    pub(crate) output: Option<PathBuf>,
    /// Draw them over the body, from the front, the side and the back.
    #[arg(long, value_name = "FILE.png")]
    pub(crate) picture: Option<PathBuf>,
    /// Unit of the body. Default: told from its height (metres, centimetres, millimetres).
    #[arg(long, value_enum)]
    pub(crate) unit: Option<Unit>,
}

/// Make a dress form from tape measurements (centimetres).
///
/// Example: toile form --bust 98.4 --waist 81.9 --hip 105.4 --height 168 -o form.obj
#[derive(Debug, Args)]
pub(crate) struct Form {
    /// Where to write the form (OBJ, PLY, STL, OFF or GLB).
    #[arg(short, long, value_name = "MESH", required_unless_present = "list_presets")]
    pub(crate) output: Option<PathBuf>,
    /// A named size to start from; single measurements given beside it win.
    #[arg(long, value_name = "NAME")]
    pub(crate) preset: Option<String>,
    /// A JSON file of measurements in centimetres: {"bust": 92, "waist": 74, …}.
    #[arg(long, value_name = "FILE")]
    pub(crate) measurements: Option<PathBuf>,
    /// Woman, man or child; decides what is assumed where nothing is given.
    #[arg(long, value_enum)]
    pub(crate) figure: Option<Figure>,
    /// Draw the form, from the front, the side and the back.
    #[arg(long, value_name = "FILE.png")]
    pub(crate) picture: Option<PathBuf>,
    /// Give the form a plain head, so that it is as high as the person.
    #[arg(long)]
    pub(crate) head: bool,
    /// List the presets and stop.
    #[arg(long)]
    pub(crate) list_presets: bool,
    #[command(flatten)]
    pub(crate) tape: Tape,
}

/// Whose proportions fill in what was not measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Figure {
    Woman,
    Man,
    Child,
}

/// Tape measurements in centimetres.
#[derive(Debug, Args)]
pub(crate) struct Tape {
    /// Fullest girth of bust or chest.
    #[arg(long, value_name = "CM")]
    pub(crate) bust: Option<f64>,
    /// Girth below the breasts.
    #[arg(long, value_name = "CM")]
    pub(crate) underbust: Option<f64>,
    /// Narrowest girth.
    #[arg(long, value_name = "CM")]
    pub(crate) waist: Option<f64>,
    /// Girth at the top of the hip bones.
    #[arg(long, value_name = "CM")]
    pub(crate) high_hip: Option<f64>,
    /// Fullest girth of the seat.
    #[arg(long, value_name = "CM")]
    pub(crate) hip: Option<f64>,
    /// Stature, without shoes.
    #[arg(long, value_name = "CM")]
    pub(crate) height: Option<f64>,
    /// Girth of the neck base.
    #[arg(long, value_name = "CM")]
    pub(crate) neck: Option<f64>,
    /// Straight width, shoulder point to shoulder point.
    #[arg(long, value_name = "CM")]
    pub(crate) shoulder_width: Option<f64>,
    /// Nape to waist.
    #[arg(long, value_name = "CM")]
    pub(crate) back_length: Option<f64>,
    /// Girth of an upper arm.
    #[arg(long, value_name = "CM")]
    pub(crate) upper_arm: Option<f64>,
    /// Girth of a thigh.
    #[arg(long, value_name = "CM")]
    pub(crate) thigh: Option<f64>,
    /// Girth of a knee.
    #[arg(long, value_name = "CM")]
    pub(crate) knee: Option<f64>,
    /// Girth of a calf.
    #[arg(long, value_name = "CM")]
    pub(crate) calf: Option<f64>,
    /// Girth of an ankle.
    #[arg(long, value_name = "CM")]
    pub(crate) ankle: Option<f64>,
}

/// Flatten any mesh: one piece a group.
///
/// Example: toile flatten cover.obj -o cover.svg
#[derive(Debug, Args)]
pub(crate) struct Flatten {
    /// The mesh; its groups become pieces.
    pub(crate) mesh: PathBuf,
    /// Where to write the pieces: .svg, .dxf, .pdf or .obj.
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,
    /// Chains of node numbers (from 1, as in the OBJ) to cut along: "3-17-9;4-5".
    #[arg(long, value_name = "CHAINS")]
    pub(crate) cut: Option<String>,
    /// Seam allowance in millimetres, at most 10000.
    #[arg(long, value_name = "MM", default_value_t = 0.0)]
    pub(crate) allowance: f64,
    /// Unit of the mesh. Default: metres for GLB; else millimetres, or metres where it is only a few units large and is drawn to be cut.
    #[arg(long, value_enum)]
    pub(crate) unit: Option<Unit>,
}
