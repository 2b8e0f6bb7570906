//! Words of what is done with solids: mid-surfaces.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::{Unit, positive};

/// Make a mid-surface of a thin solid: one sheet with joints where walls meet, and its thickness.
///
/// Walls are told from the solid's triangles alone. The sheet has a group a patch and nodes shared at joints; beside it lies
/// NAME.thickness.json, a number a triangle in millimetres, which `toile thicken --thickness-file` reads.
///
/// Example: toile deflate bracket.stl -o bracket-mid.obj
///
/// Example: toile deflate cover.stl --simplify 1.5 --edge-length 2 -o cover-mid.obj --inp cover.inp --vtk cover.vtk
#[derive(Debug, Args)]
#[command(verbatim_doc_comment)]
pub(crate) struct Deflate {
    /// The solid: OBJ, PLY, STL, OFF or GLB; closed, of thin walls.
    pub(crate) solid: PathBuf,
    /// Walls thicker than this are not looked for, in millimetres. Default: told from the solid.
    #[arg(long, value_name = "MM", value_parser = positive, allow_hyphen_values = true)]
    pub(crate) max_thickness: Option<f64>,
    /// Plane walls may be inclined to each other by this much, in degrees. Default: 8.
    #[arg(long, value_name = "DEG", value_parser = draft, allow_hyphen_values = true)]
    pub(crate) max_draft: Option<f64>,
    /// Remove fillets, rounds, holes, bosses, chamfers and steps up to this size first, in millimetres. Default: only
    /// fillets without a partner, which no mid-surface can hold.
    #[arg(long, value_name = "MM", value_parser = positive, allow_hyphen_values = true)]
    pub(crate) simplify: Option<f64>,
    /// Keep a feature although it is small: its number in the list, from 1; may be given again.
    #[arg(long, value_name = "NUMBER", value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) keep: Vec<u32>,
    /// Where to write the sheet (OBJ, PLY, STL, OFF or GLB).
    #[arg(short, long, value_name = "SHEET")]
    pub(crate) output: PathBuf,
    /// Write a shell model for Abaqus and CalculiX: nodes, elements, sections (N, mm, MPa; steel).
    #[arg(long, value_name = "FILE.inp")]
    pub(crate) inp: Option<PathBuf>,
    /// Write the sheet with its thickness for ParaView.
    #[arg(long, value_name = "FILE.vtk")]
    pub(crate) vtk: Option<PathBuf>,
    /// Draw the sheet, coloured by thickness.
    #[arg(long, value_name = "FILE.png")]
    pub(crate) picture: Option<PathBuf>,
    /// Mesh the sheet anew, with edges of about this length in millimetres.
    #[arg(long, value_name = "MM", value_parser = positive, allow_hyphen_values = true)]
    pub(crate) edge_length: Option<f64>,
    /// What becomes of places where the thickness steps and the mid-planes do not meet.
    #[arg(long, value_enum, default_value_t = ThicknessSteps::Joined)]
    pub(crate) steps: ThicknessSteps,
    /// Elements of the shell model.
    #[arg(long, value_enum, default_value_t = ShellElement::S6)]
    pub(crate) elements: ShellElement,
    /// How the shell model says the thickness.
    #[arg(long, value_enum, default_value_t = ShellSections::Thickness)]
    pub(crate) sections: ShellSections,
    /// Unit of the solid. Default: metres for GLB, else millimetres.
    #[arg(long, value_enum)]
    pub(crate) unit: Option<Unit>,
}

/// What becomes of steps in thickness.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ThicknessSteps {
    /// A narrow strip joins the two middles.
    Joined,
    /// The middles stay apart.
    Apart,
    /// The thinner part is moved to the middle of the thicker one.
    Aligned,
}

/// Shell elements.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ShellElement {
    /// Six nodes.
    S6,
    /// Three nodes; too stiff in bending.
    S3,
}

/// How a thickness is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ShellSections {
    /// A section a thickness.
    Thickness,
    /// A thickness a node.
    Nodal,
}

/// A draft angle in degrees.
fn draft(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(x) if (0.0..=45.0).contains(&x) => Ok(x),
        _ => Err("it takes an angle from 0 to 45 degrees".to_owned()),
    }
}
