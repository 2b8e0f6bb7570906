//! Pictures of what the program found and made.

mod features;
mod garment;
mod model;
mod pattern;

pub use features::{body_picture, features_picture};
pub use garment::{GarmentPictures, garment_pictures};
pub use model::{ModelColor, ModelPicture, ModelPictureError, model_picture};
pub use pattern::pattern_picture;

use viewer::{ColorBar, ColorMap, Legend, Scale};

/// Pattern pieces are coloured up to this much stretch, in percent: what cloth gives without being eased.
const STRETCH_SHOWN: f64 = 5.0;

/// The bar that explains colours of stretch.
fn stretch_bar() -> ColorBar {
    ColorBar { title: "flat against worn".to_owned(), unit: "%".to_owned(), scale: stretch_scale() }
}

/// Blue where the flat piece is smaller than the cloth on the body, red where it is larger.
pub fn stretch_scale() -> Scale {
    Scale::new(ColorMap::Diverging, -STRETCH_SHOWN, STRETCH_SHOWN)
}

/// The stretch of a face as one number, in percent: the singular value of the map to the plane that is farther from 1.
pub fn stretch_percent([larger, smaller]: [f64; 2]) -> f64 {
    100.0 * if (larger - 1.0).abs() >= (smaller - 1.0).abs() { larger - 1.0 } else { smaller - 1.0 }
}

fn legend(bar: Option<ColorBar>, keys: Vec<viewer::LegendKey>) -> Option<Legend> {
    Some(Legend { bar, keys })
}
