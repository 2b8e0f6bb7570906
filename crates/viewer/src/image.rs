//! Finished pictures.

use image::ImageEncoder;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};

use crate::color::Color;
use crate::error::{RenderError, check_size};

/// A picture: sRGB, eight bits a channel, rows from the top.
#[derive(Clone, PartialEq, Eq)]
pub struct Image {
    width: u32,
    height: u32,
    rgb: Vec<u8>,
}

impl std::fmt::Debug for Image {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Image({} x {})", self.width, self.height)
    }
}

impl Image {
    /// A picture of one colour.
    ///
    /// # Errors
    /// [`RenderError::Size`].
    pub fn filled(width: u32, height: u32, color: Color) -> Result<Self, RenderError> {
        check_size(width, height)?;
        let rgb = color.0.iter().copied().cycle().take(width as usize * height as usize * 3).collect();
        Ok(Self { width, height, rgb })
    }

    /// A picture from `3 * width * height` bytes of a checked size.
    pub(crate) fn from_rgb(width: u32, height: u32, rgb: Vec<u8>) -> Self {
        debug_assert_eq!(rgb.len(), width as usize * height as usize * 3);
        Self { width, height, rgb }
    }

    /// Width in pixels.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Height in pixels.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// All bytes: red, green, blue of the top left pixel, then to the right, then down.
    pub fn rgb(&self) -> &[u8] {
        &self.rgb
    }

    pub(crate) fn rgb_mut(&mut self) -> &mut [u8] {
        &mut self.rgb
    }

    /// The colour of pixel (`x`, `y`), y down from the top; `None` outside.
    pub fn pixel(&self, x: u32, y: u32) -> Option<Color> {
        if x >= self.width || y >= self.height {
            return None;
        }
        let i = (y as usize * self.width as usize + x as usize) * 3;
        Some(Color([self.rgb[i], self.rgb[i + 1], self.rgb[i + 2]]))
    }

    /// Copies `other` into this picture with its top left pixel at (`x`, `y`); what sticks out is cut off.
    pub fn paste(&mut self, other: &Image, x: u32, y: u32) {
        let columns = other.width.min(self.width.saturating_sub(x)) as usize * 3;
        let rows = other.height.min(self.height.saturating_sub(y));
        for row in 0..rows {
            let from = row as usize * other.width as usize * 3;
            let to = ((row + y) as usize * self.width as usize + x as usize) * 3;
            self.rgb[to..to + columns].copy_from_slice(&other.rgb[from..from + columns]);
        }
    }

    /// The picture as a PNG file: RGB, no date, no comment; the same picture gives the same bytes.
    pub fn to_png(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        let encoder = PngEncoder::new_with_quality(&mut bytes, CompressionType::Fast, FilterType::Adaptive);
        let written = encoder.write_image(&self.rgb, self.width, self.height, image::ExtendedColorType::Rgb8);
        // Writing to memory fails only for a wrong byte count, which the constructors exclude.
        debug_assert!(written.is_ok());
        bytes
    }
}
