//! Flat drawings: pattern pieces, layouts, diagrams.

use glam::DVec2;
use mesh_kernel::MAX_COORDINATE;

use crate::color::Color;
use crate::error::{RenderError, check_size};
use crate::image::Image;
use crate::painter::{Painter, Point};
use crate::text::{self, Align, TextStyle};

/// A drawing in millimetres, y up. Items are painted in order.
#[derive(Clone, Debug, Default)]
pub struct Drawing2d {
    /// What is drawn.
    pub items: Vec<Item2d>,
}

/// One thing in a drawing.
#[derive(Clone, Debug)]
pub enum Item2d {
    /// A filled area: the first ring is its border, the others are holes; rings close themselves.
    Polygon {
        /// Corners of each ring, in millimetres.
        rings: Vec<Vec<DVec2>>,
        /// Fill.
        fill: Color,
        /// 0 (nothing) to 1 (opaque).
        opacity: f64,
    },
    /// Many triangles in their own colours: a flat mesh with a quantity on it.
    Triangles {
        /// Corners in millimetres.
        positions: Vec<DVec2>,
        /// Corner indices.
        faces: Vec<[u32; 3]>,
        /// One colour a face.
        colors: Vec<Color>,
    },
    /// A line.
    Polyline {
        /// Corners in millimetres; repeat the first to close it.
        points: Vec<DVec2>,
        /// How it is drawn.
        pen: Pen,
    },
    /// A circle's line, or a disc.
    Circle {
        /// Centre in millimetres.
        centre: DVec2,
        /// Radius in millimetres.
        radius: f64,
        /// The circle's line; `None`: filled.
        pen: Option<Pen>,
        /// Colour when filled.
        fill: Color,
    },
    /// A line of text.
    Text {
        /// Where its baseline starts, is centred or ends, in millimetres.
        at: DVec2,
        /// What it says.
        text: String,
        /// Font size; capitals are 0.69 of it.
        size: Length,
        /// Turned anticlockwise by this angle, in radians.
        angle: f64,
        /// What is at `at`.
        align: Align,
        /// Colour.
        color: Color,
    },
}

/// A line's looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pen {
    /// Colour.
    pub color: Color,
    /// Width.
    pub width: Length,
    /// Lengths of dash and gap.
    pub dash: Option<[Length; 2]>,
}

impl Pen {
    /// A line of a width in pixels, as thin however large the drawing is.
    pub fn pixels(color: Color, width: f64) -> Self {
        Self { color, width: Length::Pixels(width), dash: None }
    }

    /// A line of a width in millimetres.
    pub fn millimetres(color: Color, width: f64) -> Self {
        Self { color, width: Length::Millimetres(width), dash: None }
    }

    /// The same, dashed.
    pub fn dashed(self, dash: Length, gap: Length) -> Self {
        Self { dash: Some([dash, gap]), ..self }
    }
}

/// A length in the drawing or in the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Length {
    /// Grows with the drawing.
    Millimetres(f64),
    /// Pixels of the picture.
    Pixels(f64),
}

/// The picture of a drawing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PageOptions {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Background.
    pub background: Color,
    /// Free border, in pixels.
    pub margin: f64,
    /// The part of the drawing that is shown, lower left and upper right corner in millimetres; `None`: all of it.
    pub window: Option<[DVec2; 2]>,
}

impl Default for PageOptions {
    /// 1600 x 1000 pixels, light background, 40 pixels of margin, everything shown.
    fn default() -> Self {
        Self { width: 1600, height: 1000, background: Color::PAPER, margin: 40.0, window: None }
    }
}

impl Drawing2d {
    /// Lower left and upper right corner of everything but text, in millimetres; `None` when empty. O(n).
    pub fn bounds(&self) -> Option<[DVec2; 2]> {
        let mut bounds: Option<[DVec2; 2]> = None;
        let mut add = |p: DVec2| bounds = Some(bounds.map_or([p, p], |[lo, hi]| [lo.min(p), hi.max(p)]));
        for item in &self.items {
            match item {
                Item2d::Polygon { rings, .. } => rings.iter().flatten().for_each(|p| add(*p)),
                Item2d::Triangles { positions, .. } => positions.iter().for_each(|p| add(*p)),
                Item2d::Polyline { points, .. } => points.iter().for_each(|p| add(*p)),
                Item2d::Circle { centre, radius, .. } => {
                    add(*centre - *radius);
                    add(*centre + *radius);
                }
                Item2d::Text { at, .. } => add(*at),
            }
        }
        bounds
    }

    /// Draws it: one scale both ways, centred. The same drawing gives the same bytes. O(items + pixels covered).
    ///
    /// # Errors
    /// [`RenderError`]: an impossible size, nothing to draw, a coordinate that is no number.
    pub fn render(&self, options: &PageOptions) -> Result<Image, RenderError> {
        check_size(options.width, options.height)?;
        self.check()?;
        let [lo, hi] = match options.window {
            Some([lo, hi]) if lo.is_finite() && hi.is_finite() => [lo.min(hi), lo.max(hi)],
            Some(_) => {
                return Err(RenderError::Coordinate {
                    what: "corner of the window, index".to_owned(),
                    index: 0,
                });
            }
            None => self.bounds().ok_or(RenderError::Empty)?,
        };
        let size = DVec2::new(f64::from(options.width), f64::from(options.height));
        let margin = options.margin.clamp(0.0, 0.4 * size.min_element());
        let extent = (hi - lo).max(DVec2::splat(1e-9));
        let scale = ((size - 2.0 * margin) / extent).min_element().min(1e12);
        let page = Page { scale, middle: 0.5 * (lo + hi), centre: 0.5 * size };
        let mut image = Image::filled(options.width, options.height, options.background)?;
        let mut painter = Painter::new(&mut image);
        for item in &self.items {
            page.draw(&mut painter, item);
        }
        Ok(image)
    }

    fn check(&self) -> Result<(), RenderError> {
        let bad = |p: &DVec2| !(p.is_finite() && p.abs().max_element() <= MAX_COORDINATE);
        for (i, item) in self.items.iter().enumerate() {
            let index = match item {
                Item2d::Polygon { rings, .. } => rings.iter().flatten().position(bad),
                Item2d::Triangles { positions, faces, colors } => {
                    if colors.len() != faces.len() {
                        let (wanted, got) = (faces.len(), colors.len());
                        return Err(RenderError::PaintCount { mesh: i, of: "faces", wanted, got });
                    }
                    let nodes = positions.len();
                    if let Some(face) = faces.iter().position(|f| f.iter().any(|v| *v as usize >= nodes)) {
                        let node = faces[face].into_iter().max().unwrap_or(0);
                        return Err(RenderError::Index { mesh: i, face, node, nodes });
                    }
                    positions.iter().position(bad)
                }
                Item2d::Polyline { points, .. } => points.iter().position(bad),
                Item2d::Circle { centre, radius, .. } => (bad(centre) || !radius.is_finite()).then_some(0),
                Item2d::Text { at, angle, .. } => (bad(at) || !angle.is_finite()).then_some(0),
            };
            if let Some(index) = index {
                return Err(RenderError::Coordinate {
                    what: format!("point of drawing item {i}, index"),
                    index,
                });
            }
        }
        Ok(())
    }
}

/// A drawing's place in the picture.
struct Page {
    scale: f64,
    middle: DVec2,
    centre: DVec2,
}

impl Page {
    fn at(&self, p: DVec2) -> Point {
        let d = (p - self.middle) * self.scale;
        [(self.centre.x + d.x) as f32, (self.centre.y - d.y) as f32]
    }

    fn length(&self, length: Length) -> f32 {
        match length {
            Length::Millimetres(x) => (x * self.scale) as f32,
            Length::Pixels(x) => x as f32,
        }
    }

    fn line(&self, painter: &mut Painter, points: &[Point], pen: &Pen) {
        let dash = pen.dash.map(|d| d.map(|x| self.length(x)));
        painter.stroke(points, self.length(pen.width), dash, pen.color, 1.0);
    }

    fn draw(&self, painter: &mut Painter, item: &Item2d) {
        match item {
            Item2d::Polygon { rings, fill, opacity } => {
                let mut edges = Vec::new();
                for (i, ring) in rings.iter().enumerate() {
                    // Borders run one way round and holes the other, however they were given.
                    let turned = (signed_area(ring) < 0.0) == (i == 0);
                    let points: Vec<Point> = ring.iter().map(|p| self.at(*p)).collect();
                    for k in 0..points.len() {
                        let edge = [points[k], points[(k + 1) % points.len()]];
                        edges.push(if turned { [edge[1], edge[0]] } else { edge });
                    }
                }
                painter.fill(&edges, *fill, opacity.clamp(0.0, 1.0) as f32);
            }
            Item2d::Triangles { positions, faces, colors } => {
                let points: Vec<Point> = positions.iter().map(|p| self.at(*p)).collect();
                for (face, color) in faces.iter().zip(colors) {
                    let [a, b, c] = face.map(|v| points[v as usize]);
                    painter.fill_seamless(&[a, b, c], *color);
                }
            }
            Item2d::Polyline { points, pen } => {
                let points: Vec<Point> = points.iter().map(|p| self.at(*p)).collect();
                self.line(painter, &points, pen);
            }
            Item2d::Circle { centre, radius, pen, fill } => match pen {
                None => painter.disc(self.at(*centre), (radius * self.scale) as f32, *fill, 1.0),
                Some(pen) => {
                    let steps = ((radius * self.scale).abs().sqrt() * 8.0).clamp(12.0, 720.0) as usize;
                    let points: Vec<Point> = (0..=steps)
                        .map(|i| DVec2::from_angle(i as f64 / steps as f64 * std::f64::consts::TAU))
                        .map(|d| self.at(*centre + d * *radius))
                        .collect();
                    self.line(painter, &points, pen);
                }
            },
            Item2d::Text { at, text, size, angle, align, color } => {
                let size = self.length(*size);
                // Smaller than this no letter can be told from a speck.
                if size >= 2.0 {
                    let style = TextStyle {
                        align: *align,
                        angle: *angle as f32,
                        color: *color,
                        ..TextStyle::new(size.min(20_000.0))
                    };
                    text::draw(painter, text, self.at(*at), &style);
                }
            }
        }
    }
}

fn signed_area(ring: &[DVec2]) -> f64 {
    (0..ring.len()).map(|i| ring[i].perp_dot(ring[(i + 1) % ring.len()])).sum::<f64>() * 0.5
}
