//! Several pictures in one.

use crate::color::Color;
use crate::error::RenderError;
use crate::image::Image;
use crate::painter::Painter;
use crate::text::{self, Align, TextStyle};

/// How pictures are put together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MontageOptions {
    /// Pictures a row; 0: all in one row.
    pub columns: usize,
    /// Pixels between pictures.
    pub gap: u32,
    /// Size of the titles, in pixels.
    pub title_size: f64,
    /// Background.
    pub background: Color,
}

impl Default for MontageOptions {
    /// One row, no gap, titles of 22 pixels.
    fn default() -> Self {
        Self { columns: 0, gap: 0, title_size: 22.0, background: Color::PAPER }
    }
}

/// Puts pictures side by side, each with a title above it (none where the title is empty). Cells are as wide and as
/// high as the largest picture; smaller ones are centred.
///
/// # Errors
/// [`RenderError::Empty`] without pictures; [`RenderError::Size`] when the whole would be too large.
pub fn montage(parts: &[(&str, &Image)], options: &MontageOptions) -> Result<Image, RenderError> {
    if parts.is_empty() {
        return Err(RenderError::Empty);
    }
    let columns = if options.columns == 0 { parts.len() } else { options.columns.min(parts.len()) };
    let rows = parts.len().div_ceil(columns);
    let cell_width = parts.iter().map(|(_, image)| image.width()).max().unwrap_or(1);
    let cell_height = parts.iter().map(|(_, image)| image.height()).max().unwrap_or(1);
    let titled = parts.iter().any(|(title, _)| !title.is_empty());
    let size = options.title_size.clamp(4.0, 400.0) as f32;
    let title_height = if titled { (2.0 * size).ceil() as u32 } else { 0 };
    let total = |cell: u32, n: usize| {
        let n = u32::try_from(n).unwrap_or(u32::MAX);
        cell.saturating_mul(n).saturating_add(options.gap.saturating_mul(n - 1))
    };
    let width = total(cell_width, columns);
    let height = total(cell_height + title_height, rows);
    let mut out = Image::filled(width, height, options.background)?;
    for (i, (_, image)) in parts.iter().enumerate() {
        let [x, y] = corner(i, columns, cell_width, cell_height + title_height, options.gap);
        let left = x + (cell_width - image.width()) / 2;
        let top = y + title_height + (cell_height - image.height()) / 2;
        out.paste(image, left, top);
    }
    let mut painter = Painter::new(&mut out);
    for (i, (title, _)) in parts.iter().enumerate() {
        let [x, y] = corner(i, columns, cell_width, cell_height + title_height, options.gap);
        let at = [x as f32 + 0.5 * cell_width as f32, y as f32 + 1.45 * size];
        let room = cell_width as f32 * 0.96;
        let fitted = size * (room / text::width(title, size).max(1e-3)).min(1.0);
        text::draw(&mut painter, title, at, &TextStyle { align: Align::Middle, ..TextStyle::new(fitted) });
    }
    Ok(out)
}

fn corner(i: usize, columns: usize, width: u32, height: u32, gap: u32) -> [u32; 2] {
    [(i % columns) as u32 * (width + gap), (i / columns) as u32 * (height + gap)]
}
