//! Draws the interface by the processor: triangles with textures, blended as the window blends them.

use std::collections::HashMap;

use eframe::egui::epaint::{ImageData, Primitive, Vertex};
use eframe::egui::{ClippedPrimitive, Color32, ColorImage, Context, FullOutput, TextureId, TexturesDelta};
use egui_kittest::TestRenderer;
use image::{Rgba, RgbaImage};

#[derive(Default)]
pub(crate) struct CpuRenderer {
    textures: HashMap<TextureId, ColorImage>,
}

impl TestRenderer for CpuRenderer {
    // Textures have nothing to do with each other: the order in which they change does not matter.
    #[allow(clippy::iter_over_hash_type)]
    fn handle_delta(&mut self, delta: &mut TexturesDelta) {
        let delta = std::mem::take(delta);
        for (id, parts) in &delta.set {
            for part in parts {
                let ImageData::Color(new) = &part.image;
                match part.pos {
                    None => drop(self.textures.insert(*id, (**new).clone())),
                    Some([x, y]) => {
                        let whole = self.textures.get_mut(id).unwrap();
                        for row in 0..new.size[1] {
                            let to = (y + row) * whole.size[0] + x;
                            let from = row * new.size[0];
                            whole.pixels[to..to + new.size[0]]
                                .copy_from_slice(&new.pixels[from..from + new.size[0]]);
                        }
                    }
                }
            }
        }
        for id in &delta.free {
            self.textures.remove(id);
        }
    }

    fn render(&mut self, context: &Context, output: &FullOutput) -> Result<RgbaImage, String> {
        let size = context.content_rect().size() * output.pixels_per_point;
        // As the window is cleared.
        let ground = Rgba(context.global_style().visuals.panel_fill.to_array());
        let mut picture = RgbaImage::from_pixel(size.x as u32, size.y as u32, ground);
        for ClippedPrimitive { clip_rect, primitive } in
            context.tessellate(output.shapes.clone(), output.pixels_per_point)
        {
            let Primitive::Mesh(mesh) = primitive else { return Err("a callback needs OpenGL".to_owned()) };
            let texture = self.textures.get(&mesh.texture_id);
            let clip = clip_rect * output.pixels_per_point;
            for corners in mesh.indices.chunks_exact(3) {
                let corners = [0, 1, 2].map(|k| mesh.vertices[corners[k] as usize]);
                triangle(&mut picture, texture, clip, output.pixels_per_point, &corners);
            }
        }
        Ok(picture)
    }
}

fn triangle(
    picture: &mut RgbaImage,
    texture: Option<&ColorImage>,
    clip: eframe::egui::Rect,
    scale: f32,
    corners: &[Vertex; 3],
) {
    let [a, b, c] = corners.each_ref().map(|v| v.pos.to_vec2() * scale);
    let double = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    if double == 0.0 {
        return;
    }
    let range = |of: [f32; 3], low: f32, high: f32, most: u32| {
        let first = of.into_iter().fold(f32::INFINITY, f32::min).max(low).max(0.0);
        let last = of.into_iter().fold(f32::NEG_INFINITY, f32::max).min(high).min(most as f32);
        (first - 0.5).ceil().max(0.0) as u32..(last - 0.5).ceil().max(0.0) as u32
    };
    for y in range([a.y, b.y, c.y], clip.min.y, clip.max.y, picture.height()) {
        for x in range([a.x, b.x, c.x], clip.min.x, clip.max.x, picture.width()) {
            let (px, py) = (x as f32 + 0.5, y as f32 + 0.5);
            let weight = |p: eframe::egui::Vec2, q: eframe::egui::Vec2| {
                ((q.x - p.x) * (py - p.y) - (q.y - p.y) * (px - p.x)) / double
            };
            let w = [weight(b, c), weight(c, a), weight(a, b)];
            // A pixel on an edge belongs to one of the two triangles.
            let top_left = |p: eframe::egui::Vec2, q: eframe::egui::Vec2| {
                let d = (q - p) * double.signum();
                d.y < 0.0 || (d.y == 0.0 && d.x > 0.0)
            };
            let edges = [top_left(b, c), top_left(c, a), top_left(a, b)];
            if w.iter().zip(edges).any(|(w, owns)| *w < 0.0 || (*w == 0.0 && !owns)) {
                continue;
            }
            let mix = |of: &dyn Fn(&Vertex) -> f32| (0..3).map(|k| w[k] * of(&corners[k])).sum::<f32>();
            let texel = texture.map_or([255.0; 4], |t| sample(t, mix(&|v| v.uv.x), mix(&|v| v.uv.y)));
            let color: [f32; 4] =
                std::array::from_fn(|k| mix(&|v| f32::from(v.color.to_array()[k])) * texel[k] / 255.0);
            let pixel = picture.get_pixel_mut(x, y);
            for k in 0..3 {
                let under = f32::from(pixel.0[k]) * (1.0 - color[3] / 255.0);
                pixel.0[k] = (color[k] + under).round().clamp(0.0, 255.0) as u8;
            }
        }
    }
}

/// A texture's colour between its texels.
fn sample(texture: &ColorImage, u: f32, v: f32) -> [f32; 4] {
    let [width, height] = texture.size;
    let (x, y) = (u * width as f32 - 0.5, v * height as f32 - 0.5);
    let texel = |x: f32, y: f32| -> Color32 {
        let at = |v: f32, most: usize| (v.max(0.0) as usize).min(most - 1);
        texture.pixels[at(y, height) * width + at(x, width)]
    };
    let (x0, y0) = (x.floor(), y.floor());
    let (fx, fy) = (x - x0, y - y0);
    std::array::from_fn(|k| {
        let at = |dx: f32, dy: f32| f32::from(texel(x0 + dx, y0 + dy).to_array()[k]);
        let upper = at(0.0, 0.0) * (1.0 - fx) + at(1.0, 0.0) * fx;
        let lower = at(0.0, 1.0) * (1.0 - fx) + at(1.0, 1.0) * fx;
        upper * (1.0 - fy) + lower * fy
    })
}
