//! Words of what is done with sheets: scripts, bends, plates, solids.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use mesh_kernel::MAX_COORDINATE;

use super::{Unit, positive, too_long};

/// Make a solid of a sheet: walls, corners at folds, joints of any number of sheets, strips along free edges.
///
/// The solid is closed and does not cross itself: it can be printed. A group of the sheet is a patch; a group of the solid
/// is a part of it (front_wall, back_wall, thickness_faces, fills, corners). The solid has the sheet's unit; GLB is in metres.
///
/// Example: toile thicken bracket.obj --thickness 2 -o bracket.stl
///
/// Example: toile thicken box.obj --thickness 2 --patch-thickness floor=4 --corners mitre -o box.obj
///
/// Example: toile thicken out/dress/garment.obj --thickness 1.2 -o dress.stl
#[derive(Debug, Args)]
#[command(verbatim_doc_comment)]
pub(crate) struct Thicken {
    /// The sheet: OBJ, PLY, STL, OFF, GLB, a native body (.body.json), or a script of modelling commands (.json).
    pub(crate) sheet: PathBuf,
    /// How thick, in millimetres, whatever the sheet's unit.
    #[arg(
        long,
        value_name = "MM",
        value_parser = positive,
        allow_hyphen_values = true,
        required_unless_present_any = ["patch_thickness", "thickness_file"]
    )]
    pub(crate) thickness: Option<f64>,
    /// Which side of the sheet gets material: half of it each, or all on the side from which its triangles are
    /// anticlockwise (front), or on the other (back). One side needs a sheet without joints of three and more patches.
    #[arg(long, value_enum, default_value_t = WallSide::Both)]
    pub(crate) side: WallSide,
    /// How the outer side of a fold is closed: by an arc, or by walls extended until they meet.
    #[arg(long, value_enum, default_value_t = FoldCorners::Round)]
    pub(crate) corners: FoldCorners,
    /// Where to write the solid (OBJ, PLY, STL, OFF or GLB).
    #[arg(short, long, value_name = "SOLID")]
    pub(crate) output: PathBuf,
    /// Another thickness for one patch, in millimetres; may be given again.
    #[arg(long, value_name = "NAME=MM", value_parser = named_thickness, conflicts_with = "thickness_file")]
    pub(crate) patch_thickness: Vec<(String, f64)>,
    /// A JSON list of thicknesses in millimetres, one a triangle or one a node of the file: [2, 2.5, …].
    #[arg(long, value_name = "FILE.json", conflicts_with = "thickness")]
    pub(crate) thickness_file: Option<PathBuf>,
    /// Farthest that the chords of an arc may be from it, in millimetres. Default: 3.5 % of its radius.
    #[arg(long, value_name = "MM", value_parser = positive, allow_hyphen_values = true)]
    pub(crate) chord: Option<f64>,
    /// A mitre that would stick out more than this many times the wall's offset becomes an arc.
    #[arg(long, value_name = "TIMES", value_parser = mitre_limit, allow_hyphen_values = true)]
    pub(crate) mitre_limit: Option<f64>,
    /// Unit of the sheet. Default: metres for GLB; else millimetres, or metres where it is only a few units large and
    /// could not be so thick otherwise.
    #[arg(long, value_enum)]
    pub(crate) unit: Option<Unit>,
}

/// Which side of a sheet gets material.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum WallSide {
    Both,
    Front,
    Back,
}

/// How the outer side of a fold is closed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum FoldCorners {
    Round,
    #[value(alias = "miter")]
    Mitre,
}

/// `NAME=MM`; names may hold equals signs.
pub(crate) fn named_thickness(text: &str) -> Result<(String, f64), String> {
    let (name, thickness) =
        text.rsplit_once('=').ok_or("it takes a patch and its thickness, such as floor=4")?;
    Ok((name.to_owned(), positive(thickness)?))
}

fn mitre_limit(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(x) if x.is_finite() && x >= 1.0 => Ok(x),
        _ => Err("it takes a number from 1 on: a mitre is never shorter than the wall's offset".to_owned()),
    }
}

/// Carry out a script of modelling commands: wires, sheets and solids, drawn, extruded, bent, punched, joined.
///
/// A script is JSON: {"toile_script": 1, "commands": [{"do": "create", …}, …]}; docs/sheet-modelling.md tells all commands. bends,
/// unfold and thicken take scripts too. What is wrong is said with line and command, and nothing is written then.
///
/// Example: toile model samples/sheets/bracket.json -o bracket.obj
#[derive(Debug, Args)]
#[command(verbatim_doc_comment)]
pub(crate) struct ModelScript {
    /// The script.
    pub(crate) script: PathBuf,
    /// Where to write the model (OBJ, PLY, STL, OFF or GLB), a group a patch. Without it the script is only tried.
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
}

/// Count a sheet's facets, bends, welds, free edges and vertices, and find out what bends and what is welded.
///
/// Facets are the groups of the file, or what lies in one plane; how finely they are triangulated does not matter.
///
/// Example: toile bends box.obj
#[derive(Debug, Args)]
#[command(verbatim_doc_comment)]
pub(crate) struct Bends {
    /// The sheet: OBJ, PLY, STL, OFF, GLB, a native body (.body.json), or a script of modelling commands (.json).
    pub(crate) sheet: PathBuf,
    /// What is one facet: a group of the file (of two and more), or what lies in one plane of a group.
    #[arg(long, value_enum, default_value_t = Facets::Auto)]
    pub(crate) facets: Facets,
    /// Unit of the sheet. Default: metres for GLB, else millimetres.
    #[arg(long, value_enum)]
    pub(crate) unit: Option<Unit>,
}

/// What is one facet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Facets {
    /// Groups where there are two and more, else planes
    Auto,
    /// Groups, plane or curved
    #[value(alias = "patches")]
    Groups,
    /// What lies in one plane of a group
    Planes,
}

impl Facets {
    pub(crate) fn rule(self) -> sheet::facets::FacetRule {
        match self {
            Self::Auto => sheet::facets::FacetRule::Auto,
            Self::Groups => sheet::facets::FacetRule::Patches,
            Self::Planes => sheet::facets::FacetRule::Planes,
        }
    }
}

/// Lay a folded sheet flat: plates with bend lines, bend allowances and reliefs, in millimetres.
///
/// Bends are chosen so that the flat sheet does not lie on itself; what cannot be bent is cut and welded, and where one plate
/// will not do there are several. Without a thickness the sheet is folded sharply, as paper is.
///
/// Example: toile unfold bracket.obj -o bracket.dxf
///
/// Example: toile unfold bracket.obj --thickness 2 --radius 3 --k-factor 0.42 --relief round -o bracket.svg
#[derive(Debug, Args)]
#[command(verbatim_doc_comment)]
pub(crate) struct Unfold {
    /// The sheet: OBJ, PLY, STL, OFF, GLB, a native body (.body.json), or a script of modelling commands (.json).
    pub(crate) sheet: PathBuf,
    /// Where to write the plates: .dxf (layers CUT, BEND, WELD, TEXT) or .svg.
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,
    /// Thickness of the metal, in millimetres.
    #[arg(long, value_name = "MM", value_parser = positive, allow_hyphen_values = true)]
    pub(crate) thickness: Option<f64>,
    /// Radius on the inner side of bends, in millimetres. Default: the thickness.
    #[arg(long, value_name = "MM", value_parser = not_negative, allow_hyphen_values = true)]
    pub(crate) radius: Option<f64>,
    /// How deep in the metal, as a share of its thickness from the inner side, a bend keeps its length.
    #[arg(long, value_name = "SHARE", default_value_t = 0.44, value_parser = share, allow_hyphen_values = true)]
    pub(crate) k_factor: f64,
    /// Which layer of the metal the sheet's coordinates are of.
    #[arg(long, value_enum, default_value_t = Layer::Middle)]
    pub(crate) layer: Layer,
    /// What is cut away at the ends of bends so that the metal beside them does not tear.
    #[arg(long, value_enum, default_value_t = Reliefs::Rectangle)]
    pub(crate) relief: Reliefs,
    /// Width of reliefs along the bend, in millimetres. Default: the thickness.
    #[arg(long, value_name = "MM", value_parser = positive, allow_hyphen_values = true)]
    pub(crate) relief_width: Option<f64>,
    /// How much deeper than the bend reliefs are, in millimetres. Default: half the thickness.
    #[arg(long, value_name = "MM", value_parser = not_negative, allow_hyphen_values = true)]
    pub(crate) relief_depth: Option<f64>,
    /// The file is a thin solid, not a sheet: the middle of its walls is unfolded, with their thickness.
    #[arg(long, conflicts_with_all = ["thickness", "layer"])]
    pub(crate) from_solid: bool,
    /// Unit of the sheet. Default: metres for GLB, else millimetres.
    #[arg(long, value_enum)]
    pub(crate) unit: Option<Unit>,
}

/// A layer of the metal.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Layer {
    /// The middle of the thickness
    Middle,
    /// The inner side of every bend: inside dimensions
    Inside,
    /// The outer side of every bend: outside dimensions
    Outside,
}

/// Reliefs at the ends of bends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Reliefs {
    None,
    Rectangle,
    Round,
}

fn not_negative(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(x) if x > MAX_COORDINATE => Err(too_long()),
        Ok(x) if x >= 0.0 => Ok(x),
        _ => Err("it takes a number of millimetres, not negative, such as 0 or 1.5".to_owned()),
    }
}

fn share(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(x) if (0.0..=1.0).contains(&x) => Ok(x),
        _ => Err("it takes a number from 0 to 1, such as 0.44".to_owned()),
    }
}
