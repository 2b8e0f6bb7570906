//! Drawings as scripts of modelling commands, and the drawings that scripts hold.

use glam::DVec2;
use serde_json::{Value, json};
use sheet::model::{Command, Limits, Script, ScriptError};
use sketch::{Drawing, DrawingError, Outline, Path, SketchError, polygon_holds};

/// What a drawing is to be made into.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Making {
    /// Plane sheets of its closed outlines; outlines inside others are holes.
    Sheets,
    /// Walls over all of it, of a height in mm.
    Walls(f64),
    /// Nodes and links.
    Wires,
}

/// Why there is no script of a drawing, or no drawing of a script.
#[derive(Debug, thiserror::Error)]
pub enum DrawingFileError {
    /// The drawing is empty.
    #[error("nothing is drawn yet")]
    Empty,
    /// A sheet needs closed outlines.
    #[error("no outline is closed, and a sheet needs one; walls and wires can be made of open ones")]
    NoneClosed,
    /// Shapes of the drawing.
    #[error(transparent)]
    Drawing(#[from] DrawingError),
    /// Outlines of it.
    #[error("an outline of the drawing: {0}")]
    Outline(#[from] SketchError),
    /// The file, or what would come of the drawing.
    #[error(transparent)]
    Script(#[from] ScriptError),
    /// More than hands draw, and than the board can be fast with.
    #[error("the script's drawings have {found} points and more; the board takes {MOST} at most")]
    TooMany {
        /// How many there are.
        found: usize,
    },
    /// The script draws nothing.
    #[error("the script has no drawing on a plane")]
    NoDrawing,
}

/// Chords of outlines in containment tests stay this near to their curves, mm.
const CHORD: f64 = 0.05;
/// More corners than this are no drawing by hand.
const CORNERS: usize = 100_000;

/// Points that a drawing may have to be edited.
const MOST: usize = 2000;

/// The script that makes something of a drawing, and what of it was left out, in words.
///
/// It has been run: what a script would be refused for is told here.
///
/// # Errors
/// [`DrawingFileError`].
pub fn to_script(drawing: &Drawing, making: Making) -> Result<(String, Option<String>), DrawingFileError> {
    let outlines = drawing.outlines()?;
    if outlines.is_empty() {
        return Err(DrawingFileError::Empty);
    }
    let wire = || json!({"do": "wire", "name": "drawing", "drawings": outlines});
    let (commands, left_out) = match making {
        Making::Wires => (vec![wire()], None),
        Making::Walls(height) => {
            let walls =
                json!({"do": "extrude", "name": "walls", "wire": "drawing", "by": [0.0, 0.0, height]});
            (vec![wire(), walls], None)
        }
        Making::Sheets => sheets(&outlines)?,
    };
    let script = json!({"toile_script": 1, "about": "A drawing.", "commands": commands});
    // Maps have text keys, so this cannot fail.
    let mut text = serde_json::to_string_pretty(&script).unwrap_or_default();
    text.push('\n');
    Script::read(&text)?.run(Limits::default())?;
    Ok((text, left_out))
}

/// A sheet for every outline that lies in an even number of others; those right inside it are its holes.
fn sheets(outlines: &[Outline]) -> Result<(Vec<Value>, Option<String>), DrawingFileError> {
    let mut closed: Vec<(&Outline, Vec<DVec2>)> = Vec::new();
    for outline in outlines {
        let path = Path::of(outline)?;
        if path.closed {
            closed.push((outline, path.simple_loop(CHORD, CORNERS)?));
        }
    }
    if closed.is_empty() {
        return Err(DrawingFileError::NoneClosed);
    }
    let around = |k: usize| -> Vec<usize> {
        let inside = |j: &usize| *j != k && polygon_holds(&closed[*j].1, closed[k].1[0]);
        (0..closed.len()).filter(inside).collect()
    };
    let nests: Vec<Vec<usize>> = (0..closed.len()).map(around).collect();
    let mut commands = Vec::new();
    for k in (0..closed.len()).filter(|k| nests[*k].len().is_multiple_of(2)) {
        let is_hole = |j: &usize| nests[*j].len() == nests[k].len() + 1 && nests[*j].contains(&k);
        let holes: Vec<&Outline> = (0..closed.len()).filter(is_hole).map(|j| closed[j].0).collect();
        let name = format!("sheet_{}", commands.len() + 1);
        commands.push(json!({"do": "create", "name": name, "outline": closed[k].0, "holes": holes}));
    }
    let open = outlines.len() - closed.len();
    Ok((commands, (open > 0).then(|| format!("{open} open outlines"))))
}

/// The drawing that a script begins with: outlines of its commands on the plane of the first. What of it was left out, in words.
///
/// # Errors
/// [`DrawingFileError`].
pub fn of_script(text: &str) -> Result<(Drawing, Option<String>), DrawingFileError> {
    let script = Script::read(text)?;
    let mut plane = None;
    let mut drawing = Drawing::default();
    let mut elsewhere = 0;
    for (_, command) in &script.commands {
        let (on, outlines): (_, Vec<&Outline>) = match command {
            Command::Wire { drawings, plane, .. } => (plane, drawings.iter().collect()),
            Command::Extrude { outline: Some(outline), plane, .. }
            | Command::Punch { outline, plane, .. }
            | Command::Draw { outline, plane, .. } => (plane, vec![outline]),
            Command::Create { outline, holes, plane, .. } => {
                (plane, std::iter::once(outline).chain(holes).collect())
            }
            _ => continue,
        };
        if outlines.is_empty() {
            continue;
        }
        if *plane.get_or_insert(*on) != *on {
            elsewhere += outlines.len();
            continue;
        }
        for outline in outlines {
            let found = drawing.points().count() + corners(outline);
            if found > MOST {
                return Err(DrawingFileError::TooMany { found });
            }
            drawing.add_outline(outline)?;
        }
    }
    if plane.is_none() {
        return Err(DrawingFileError::NoDrawing);
    }
    Ok((drawing, (elsewhere > 0).then(|| format!("{elsewhere} outlines on other planes"))))
}

/// About how many points an outline has.
fn corners(outline: &Outline) -> usize {
    match outline {
        Outline::Polygon(points) | Outline::Polyline(points) | Outline::Spline(points) => points.len(),
        Outline::Path(parts) => parts.iter().map(corners).sum(),
        _ => 4,
    }
}
