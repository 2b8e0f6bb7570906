//! The words of the command line, a file for what belongs together. Names are fixed: scripts rely on them.

mod garments;
mod pictures;
mod sheets;
mod solids;

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};
use mesh_kernel::MAX_COORDINATE;

pub(crate) use garments::*;
pub(crate) use pictures::*;
pub(crate) use sheets::*;
pub(crate) use solids::*;

/// Freeform non-manifold meshes around a body: one template, any body, patterns a factory can cut.
#[derive(Debug, Parser)]
#[command(name = "toile", version, propagate_version = true, arg_required_else_help = true)]
pub(crate) struct Words {
    #[command(subcommand)]
    pub(crate) command: Command,
    #[command(flatten)]
    pub(crate) common: Common,
}

/// Options that every command takes.
#[derive(Debug, Args)]
pub(crate) struct Common {
    /// Print the report as JSON on standard output instead of the table.
    #[arg(long, global = true)]
    pub(crate) json: bool,
    /// Say nothing but errors.
    #[arg(long, short, global = true, conflicts_with = "verbose")]
    pub(crate) quiet: bool,
    /// Say every step.
    #[arg(long, short, global = true)]
    pub(crate) verbose: bool,
    /// Threads to work on; results do not depend on it. Default: one a core.
    #[arg(long, global = true, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Regenerate(Regenerate),
    Batch(Batch),
    Features(Features),
    Form(Form),
    /// Find every broken rule of a model: incidence, orientation, joints, degenerate and duplicate faces, counts.
    ///
    /// Example: toile check out/dress/garment.obj
    Check(Model),
    /// Say what a model holds: surfaces, joints, nodes, edges, faces, parts, cycles, voids, boundary, area, volume.
    ///
    /// Example: toile info out/dress/garment.obj
    Info(Model),
    Flatten(Flatten),
    Thicken(Thicken),
    Deflate(Deflate),
    Model(ModelScript),
    Bends(Bends),
    Unfold(Unfold),
    Render(Render),
    View(View),
}

/// A model: OBJ (groups are surfaces), PLY, STL, OFF or GLB; or a body with all its joints, attributes and numbers
/// (.body.json).
#[derive(Debug, Args)]
pub(crate) struct Model {
    /// The model.
    pub(crate) model: PathBuf,
}

/// Units of length of files that do not say.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Unit {
    Mm,
    Cm,
    M,
    Inch,
}

impl Unit {
    /// Millimetres in one.
    pub(crate) fn millimetres(self) -> f64 {
        match self {
            Self::Mm => 1.0,
            Self::Cm => 10.0,
            Self::M => 1000.0,
            Self::Inch => 25.4,
        }
    }

    /// The same for a body.
    pub(crate) fn of_body(self) -> reference::human::Unit {
        match self {
            Self::Mm => reference::human::Unit::Millimetre,
            Self::Cm => reference::human::Unit::Centimetre,
            Self::M => reference::human::Unit::Metre,
            Self::Inch => reference::human::Unit::Inch,
        }
    }
}

/// What is said of a length that nothing has.
fn too_long() -> String {
    format!("it takes a number of millimetres, no more than {MAX_COORDINATE:e}")
}

/// A length that something can have.
fn positive(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(x) if x > MAX_COORDINATE => Err(too_long()),
        Ok(x) if x > 0.0 => Ok(x),
        _ => Err("it takes a number of millimetres larger than 0, such as 2 or 0.8".to_owned()),
    }
}
