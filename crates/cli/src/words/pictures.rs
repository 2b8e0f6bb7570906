//! Words of what is looked at: pictures and the window.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::Unit;

/// Open the window: design a template on a body, with its pattern beside it.
///
/// Example: toile view samples/fitted-bodice.json --body samples/form-12.obj
#[derive(Debug, Args)]
pub(crate) struct View {
    /// A template, a design, a body's mesh, or any mesh to look at; nothing: an empty template on the average form.
    pub(crate) file: Option<PathBuf>,
    /// The body.
    #[arg(long, value_name = "MESH")]
    pub(crate) body: Option<PathBuf>,
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
