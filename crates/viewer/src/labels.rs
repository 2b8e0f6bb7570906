//! Names at places: near their point, beside each other, readable over the picture.

use crate::color::Color;
use crate::image::Image;
use crate::lines::Depth;
use crate::painter::Painter;
use crate::render::RenderOptions;
use crate::scene::{Hidden, Scene};
use crate::text::{self, Align, TextStyle};

/// A text's place: left, top, right, bottom in pixels.
type Box2 = [f32; 4];

/// Draws all labels. A label takes the first free place around its point; when all are taken it moves away and gets
/// a thin leader. O(labels squared).
pub(crate) fn draw(image: &mut Image, scene: &Scene, depth: &Depth, options: &RenderOptions) {
    if scene.labels.is_empty() {
        return;
    }
    let unit = options.unit() as f32;
    let size = 14.0 * unit;
    let mut painter = Painter::new(image);
    let [picture_width, picture_height] = painter.size();
    let mut taken: Vec<Box2> = Vec::new();
    for label in &scene.labels {
        let Some((at, visible)) = depth.locate(label.position) else { continue };
        let color = match (visible, label.hidden) {
            (true, _) | (_, Hidden::Shown) => label.color,
            (false, Hidden::Omitted) => continue,
            (false, Hidden::Faint | Hidden::Dashed) => label.color.mix(Color::PAPER, 0.55),
        };
        let width = text::width(&label.text, size);
        let height = text::CAP_HEIGHT * size;
        let inside = |b: &Box2| {
            b[0] >= 2.0 && b[1] >= 2.0 && b[2] <= picture_width - 2.0 && b[3] <= picture_height - 2.0
        };
        let free = |b: &Box2| {
            inside(b) && !taken.iter().any(|t| b[0] < t[2] && t[0] < b[2] && b[1] < t[3] && t[1] < b[3])
        };
        let mut choices = Vec::new();
        for ring in 0..6 {
            let gap = (7.0 + 15.0 * ring as f32) * unit;
            for (side, rise) in [(1.0, 0.0), (-1.0, 0.0), (1.0, -1.0), (-1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            {
                let left = if side > 0.0 { at[0] + gap } else { at[0] - gap - width };
                let middle = at[1] + rise * (gap + 0.4 * height);
                let pad = 2.5 * unit;
                choices.push((
                    ring,
                    [
                        left - pad,
                        middle - 0.5 * height - pad,
                        left + width + pad,
                        middle + 0.5 * height + pad,
                    ],
                ));
            }
        }
        let (ring, place) = choices.iter().find(|(_, b)| free(b)).copied().unwrap_or((0, choices[0].1));
        let pad = 2.5 * unit;
        if ring > 0 {
            let near = [at[0].clamp(place[0], place[2]), at[1].clamp(place[1] + pad, place[3] - pad)];
            painter.stroke(&[at, near], 0.8 * unit, None, color, 0.7);
        }
        let style = TextStyle { align: Align::Start, color, halo: 1.6 * unit, ..TextStyle::new(size) };
        text::draw(&mut painter, &label.text, [place[0] + pad, place[3] - pad], &style);
        taken.push(place);
    }
}
