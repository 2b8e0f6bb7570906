//! The words of the command line. Names are fixed: scripts rely on them.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};

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

/// Open the window: design a template on a body, with its pattern beside it.
///
/// Example: toile view samples/fitted-bodice.json --body samples/form-12.obj
#[derive(Debug, Args)]
pub(crate) struct View {
    /// A template, a design, or a body's mesh; nothing: an empty template on the average form.
    pub(crate) file: Option<PathBuf>,
    /// The body.
    #[arg(long, value_name = "MESH")]
    pub(crate) body: Option<PathBuf>,
}

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
/// Example: toile regenerate samples/princess-dress.json --body samples/form-12.obj --out out/dress
#[derive(Debug, Args)]
pub(crate) struct Regenerate {
    /// The feature template (JSON).
    pub(crate) template: PathBuf,
    /// The body: OBJ, PLY, STL, OFF or GLB, in metres, centimetres or millimetres.
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
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(0..=7))]
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
    /// The feature template (JSON).
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

/// A model: OBJ (groups are surfaces), PLY, STL, OFF or GLB; or a body with all its joints, attributes and numbers
/// (.body.json).
#[derive(Debug, Args)]
pub(crate) struct Model {
    /// The model.
    pub(crate) model: PathBuf,
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
    /// Seam allowance in millimetres.
    #[arg(long, value_name = "MM", default_value_t = 0.0)]
    pub(crate) allowance: f64,
    /// Unit of the mesh.
    #[arg(long, value_enum, default_value_t = Unit::Mm)]
    pub(crate) unit: Unit,
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
}

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
    #[arg(long, value_name = "NUMBER")]
    pub(crate) keep: Vec<usize>,
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

/// A length that something can have.
fn positive(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(x) if x.is_finite() && x > 0.0 => Ok(x),
        _ => Err("it takes a number of millimetres larger than 0, such as 2 or 0.8".to_owned()),
    }
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
        Ok(x) if x.is_finite() && x >= 0.0 => Ok(x),
        _ => Err("it takes a number of millimetres, not negative, such as 0 or 1.5".to_owned()),
    }
}

fn share(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(x) if (0.0..=1.0).contains(&x) => Ok(x),
        _ => Err("it takes a number from 0 to 1, such as 0.44".to_owned()),
    }
}

/// What a picture is taken from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Side {
    Front,
    Back,
    Left,
    Right,
    Top,
    Iso,
}

/// What colours mean in a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Colour {
    Stretch,
    Distance,
    Thickness,
    None,
}

/// Draw a model, with no GPU and no display.
///
/// Example: toile render out/dress/garment.obj --with samples/form-12.obj --view back -o back.png
#[derive(Debug, Args)]
pub(crate) struct Render {
    /// The model.
    pub(crate) model: PathBuf,
    /// The picture.
    #[arg(short, long, value_name = "FILE.png")]
    pub(crate) output: PathBuf,
    /// Where it is seen from.
    #[arg(long, value_enum, default_value_t = Side::Front)]
    pub(crate) view: Side,
    /// Size of the picture in pixels.
    #[arg(long, value_name = "WxH", default_value = "1024x1024")]
    pub(crate) size: String,
    /// A body to draw with it.
    #[arg(long, value_name = "BODY")]
    pub(crate) with: Option<PathBuf>,
    /// What the colours show.
    #[arg(long, value_enum, default_value_t = Colour::None)]
    pub(crate) color: Colour,
    /// Unit of the model; told from its size when left out.
    #[arg(long, value_enum)]
    pub(crate) unit: Option<Unit>,
}
