//! Title and legend: what colours and lines mean.

use crate::camera::Insets;
use crate::color::Color;
use crate::color_map::{Scale, tick_text};
use crate::image::Image;
use crate::painter::Painter;
use crate::render::RenderOptions;
use crate::scene::Scene;
use crate::text::{self, TextStyle};

/// The meaning of a picture's colours and lines, drawn in a column at its right border.
#[derive(Clone, Debug, Default)]
pub struct Legend {
    /// The bar of a scale.
    pub bar: Option<ColorBar>,
    /// Names of lines and colours.
    pub keys: Vec<LegendKey>,
}

/// The bar of a scale with ticks.
#[derive(Clone, Debug)]
pub struct ColorBar {
    /// What is measured.
    pub title: String,
    /// Its unit; may be empty.
    pub unit: String,
    /// Numbers to colours.
    pub scale: Scale,
}

/// One line of a legend.
#[derive(Clone, Debug)]
pub struct LegendKey {
    /// What it is.
    pub text: String,
    /// Its colour.
    pub color: Color,
    /// What stands before the text.
    pub sign: KeySign,
}

/// The sign before a legend's line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeySign {
    /// A filled patch.
    Patch,
    /// A line.
    Line,
    /// A dashed line.
    DashedLine,
    /// A dot.
    Dot,
}

const TEXT: f32 = 14.0;
const TITLE: f32 = 20.0;
const BAR_WIDTH: f32 = 16.0;
const ROW: f32 = 22.0;
const SIGN: f32 = 24.0;
const MARGIN: f32 = 22.0;

impl ColorBar {
    fn heading(&self) -> String {
        if self.unit.is_empty() { self.title.clone() } else { format!("{} [{}]", self.title, self.unit) }
    }

    fn ticks(&self) -> Vec<(f64, String)> {
        let ticks = self.scale.ticks(6);
        let step = if ticks.len() > 1 { ticks[1] - ticks[0] } else { 0.0 };
        ticks.into_iter().map(|t| (t, tick_text(t, step))).collect()
    }
}

impl Legend {
    /// Width of the column in pixels at unit 1.
    fn width(&self) -> f32 {
        let bar = self.bar.as_ref().map_or(0.0, |bar| {
            let ticks = bar.ticks().iter().map(|(_, t)| text::width(t, TEXT)).fold(0.0, f32::max);
            (BAR_WIDTH + 10.0 + ticks).max(text::width(&bar.heading(), TEXT))
        });
        let keys = self.keys.iter().map(|k| SIGN + 8.0 + text::width(&k.text, TEXT)).fold(0.0, f32::max);
        bar.max(keys)
    }

    fn is_empty(&self) -> bool {
        self.bar.is_none() && self.keys.is_empty()
    }
}

/// Room that a scene's title and legend need beside the model.
pub(crate) fn insets(scene: &Scene, options: &RenderOptions) -> Insets {
    let mut insets = Insets::margin(options);
    let unit = options.unit();
    if let Some(legend) = scene.legend.as_ref().filter(|l| !l.is_empty()) {
        insets.right += f64::from(legend.width() + MARGIN) * unit;
    }
    if scene.title.is_some() {
        insets.top += f64::from(TITLE + 0.6 * MARGIN) * unit;
    }
    insets
}

/// Draws title and legend.
pub(crate) fn draw(image: &mut Image, scene: &Scene, options: &RenderOptions) {
    let unit = options.unit() as f32;
    let mut painter = Painter::new(image);
    let [width, height] = painter.size();
    if let Some(title) = &scene.title {
        let size = fitted(title, TITLE * unit, width - 2.0 * MARGIN * unit);
        let at = [MARGIN * unit, (MARGIN + TITLE * text::CAP_HEIGHT) * unit];
        text::draw(&mut painter, title, at, &TextStyle::new(size));
    }
    let Some(legend) = scene.legend.as_ref().filter(|l| !l.is_empty()) else { return };
    let left = (width - (legend.width() + MARGIN) * unit).max(0.0);
    let bar_height = if legend.bar.is_some() { (0.42 * height).max(40.0 * unit) } else { 0.0 };
    let heading = if legend.bar.is_some() { ROW * 1.3 * unit } else { 0.0 };
    let between = if legend.bar.is_some() && !legend.keys.is_empty() { ROW * unit } else { 0.0 };
    let all = heading + bar_height + between + ROW * unit * legend.keys.len() as f32;
    let mut y = (0.5 * (height - all)).max(MARGIN * unit);
    let style = TextStyle::new(TEXT * unit);
    if let Some(bar) = &legend.bar {
        text::draw(&mut painter, &bar.heading(), [left, y + TEXT * text::CAP_HEIGHT * unit], &style);
        y += heading;
        draw_bar(&mut painter, bar, [left, y], bar_height, unit);
        y += bar_height + between;
    }
    for key in &legend.keys {
        draw_key(&mut painter, key, [left, y + 0.5 * ROW * unit], unit);
        y += ROW * unit;
    }
}

/// The largest size up to `size` at which the text is at most `room` wide.
fn fitted(words: &str, size: f32, room: f32) -> f32 {
    let width = text::width(words, size);
    if width > room { size * (room / width).max(0.1) } else { size }
}

fn draw_bar(painter: &mut Painter, bar: &ColorBar, at: [f32; 2], height: f32, unit: f32) {
    let width = BAR_WIDTH * unit;
    let rows = height.ceil() as usize;
    for row in 0..rows {
        let t = 1.0 - (row as f64 + 0.5) / rows as f64;
        let y = at[1].round() + row as f32;
        painter.rectangle([at[0].round(), y], [(at[0] + width).round(), y + 1.0], bar.scale.map.at(t), 1.0);
    }
    let style = TextStyle::new(TEXT * unit);
    for (value, words) in bar.ticks() {
        let y = at[1] + (1.0 - bar.scale.position(value) as f32) * height;
        let x = at[0] + width;
        painter.stroke(&[[x + unit, y], [x + 5.0 * unit, y]], unit, None, Color::FAINT_INK, 1.0);
        text::draw(painter, &words, [x + 9.0 * unit, y + 0.5 * text::CAP_HEIGHT * TEXT * unit], &style);
    }
}

fn draw_key(painter: &mut Painter, key: &LegendKey, at: [f32; 2], unit: f32) {
    let [x, y] = at;
    let end = x + SIGN * unit;
    match key.sign {
        KeySign::Patch => {
            let half = 6.5 * unit;
            painter.rectangle([x, y - half], [end, y + half], key.color, 1.0);
        }
        KeySign::Line => painter.stroke(&[[x, y], [end, y]], 2.2 * unit, None, key.color, 1.0),
        KeySign::DashedLine => {
            painter.stroke(&[[x, y], [end, y]], 2.2 * unit, Some([6.0 * unit, 3.5 * unit]), key.color, 1.0);
        }
        KeySign::Dot => painter.disc([0.5 * (x + end), y], 4.0 * unit, key.color, 1.0),
    }
    let base = [end + 8.0 * unit, y + 0.5 * text::CAP_HEIGHT * TEXT * unit];
    text::draw(painter, &key.text, base, &TextStyle::new(TEXT * unit));
}
