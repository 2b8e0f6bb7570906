//! Antialiased filling and stroking in pixels: what legends, 2D drawings and 3D lines are painted with.
//!
//! Coordinates are pixels, x right, y down, (0, 0) the top left corner of the top left pixel.

use crate::color::Color;
use crate::image::Image;

/// A point of the picture, in pixels.
pub(crate) type Point = [f32; 2];

/// Dashes and gaps in pixels, starting with a dash.
pub(crate) type Dash = [f32; 2];

/// Paints onto a picture. Keeps one coverage buffer so that overlapping parts of one shape count once.
pub(crate) struct Painter<'a> {
    image: &'a mut Image,
    coverage: Vec<f32>,
    touched: Vec<u32>,
}

impl<'a> Painter<'a> {
    pub(crate) fn new(image: &'a mut Image) -> Self {
        let pixels = image.width() as usize * image.height() as usize;
        Self { image, coverage: vec![0.0; pixels], touched: Vec::new() }
    }

    pub(crate) fn size(&self) -> [f32; 2] {
        [self.image.width() as f32, self.image.height() as f32]
    }

    /// Fills the inside of closed outlines given by their edges (non-zero winding; edges in any order).
    ///
    /// Coverage is the exact area of the outline in every pixel: signed areas are gathered by rows and summed from
    /// the left, as font rasterisers do (R. Levien, "Inside the fastest font renderer in the world", 2016).
    pub(crate) fn fill(&mut self, edges: &[[Point; 2]], color: Color, alpha: f32) {
        let [width, height] = self.size();
        let (mut lo, mut hi) = ([f32::INFINITY; 2], [f32::NEG_INFINITY; 2]);
        for p in edges.iter().flatten() {
            if !(p[0].is_finite() && p[1].is_finite()) {
                return;
            }
            for k in 0..2 {
                lo[k] = lo[k].min(p[k]);
                hi[k] = hi[k].max(p[k]);
            }
        }
        let (x0, y0) = (lo[0].floor().clamp(0.0, width), lo[1].floor().clamp(0.0, height));
        let (x1, y1) = (hi[0].ceil().clamp(0.0, width), hi[1].ceil().clamp(0.0, height));
        if x0 >= x1 || y0 >= y1 {
            return;
        }
        let mut area = AreaBuffer::new((x1 - x0) as usize, (y1 - y0) as usize);
        for [p, q] in edges {
            area.edge([p[0] - x0, p[1] - y0], [q[0] - x0, q[1] - y0]);
        }
        let row_length = self.image.width() as usize;
        let (x0, y0) = (x0 as usize, y0 as usize);
        for y in 0..area.height {
            let mut winding = 0.0f32;
            for x in 0..area.width {
                winding += area.cells[y * (area.width + 2) + x];
                let covered = winding.abs().min(1.0) * alpha;
                if covered > 1.0 / 512.0 {
                    blend(self.image, (y0 + y) * row_length + x0 + x, color, covered);
                }
            }
        }
    }

    /// Fills a triangle of a mesh: pixels whose centre it holds wholly, so that neighbours neither gap nor overlap
    /// (up to rounding); its outline is left to lines drawn over it.
    pub(crate) fn fill_seamless(&mut self, corners: &[Point; 3], color: Color) {
        let [a, b, c] = *corners;
        let [width, height] = self.size();
        let cross =
            |p: Point, q: Point, x: f32, y: f32| (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]);
        let sign = cross(a, b, c[0], c[1]).signum();
        let y_from = (a[1].min(b[1]).min(c[1]) - 0.5).ceil().clamp(0.0, height) as usize;
        let y_to = (a[1].max(b[1]).max(c[1]) + 0.5).floor().clamp(0.0, height) as usize;
        let x_from = (a[0].min(b[0]).min(c[0]) - 0.5).ceil().clamp(0.0, width) as usize;
        let x_to = (a[0].max(b[0]).max(c[0]) + 0.5).floor().clamp(0.0, width) as usize;
        let row_length = self.image.width() as usize;
        for y in y_from..y_to {
            for x in x_from..x_to {
                let (u, v) = (x as f32 + 0.5, y as f32 + 0.5);
                let inside = [(a, b), (b, c), (c, a)].iter().all(|(p, q)| sign * cross(*p, *q, u, v) >= 0.0);
                if inside {
                    blend(self.image, y * row_length + x, color, 1.0);
                }
            }
        }
    }

    /// Strokes a polyline with round caps and joins; `width` in pixels.
    pub(crate) fn stroke(
        &mut self,
        points: &[Point],
        width: f32,
        dash: Option<Dash>,
        color: Color,
        alpha: f32,
    ) {
        match dash {
            None => self.cover(points, width),
            Some(dash) => {
                self.cover_dashed(points, width, dash);
            }
        }
        self.flush(color, alpha);
    }

    /// Covers the dashes of a polyline; their round ends lie within the dash's length.
    pub(crate) fn cover_dashed(&mut self, points: &[Point], width: f32, [dash, gap]: Dash) {
        for piece in dashes(points, [(dash - width).max(0.01), gap + width]) {
            self.cover(&piece, width);
        }
    }

    /// Fills a disc; `radius` in pixels.
    pub(crate) fn disc(&mut self, centre: Point, radius: f32, color: Color, alpha: f32) {
        self.cover(&[centre, centre], 2.0 * radius);
        self.flush(color, alpha);
    }

    /// Fills an axis-aligned rectangle.
    pub(crate) fn rectangle(&mut self, lo: Point, hi: Point, color: Color, alpha: f32) {
        let corners = [lo, [hi[0], lo[1]], hi, [lo[0], hi[1]]];
        let edges: Vec<[Point; 2]> = (0..4).map(|i| [corners[i], corners[(i + 1) % 4]]).collect();
        self.fill(&edges, color, alpha);
    }

    /// Raises the coverage of all pixels that the segments touch to the segments' own. A pixel's coverage is that
    /// of a straight band at the pixel centre's distance: exact for one straight edge, and crisp.
    pub(crate) fn cover(&mut self, points: &[Point], width: f32) {
        if points.len() == 1 {
            return self.cover(&[points[0], points[0]], width);
        }
        // A line thinner than a pixel keeps the pixel's width and grows fainter instead.
        let (half, weight) = if width < 1.0 { (0.5, width.max(0.0)) } else { (0.5 * width, 1.0) };
        let reach = half + 0.5;
        let [image_width, image_height] = self.size();
        let row_length = self.image.width() as usize;
        for pair in points.windows(2) {
            let [a, b] = [pair[0], pair[1]];
            if !(a[0].is_finite() && a[1].is_finite() && b[0].is_finite() && b[1].is_finite()) {
                continue;
            }
            let along = [b[0] - a[0], b[1] - a[1]];
            let length_squared = along[0] * along[0] + along[1] * along[1];
            let y_from = (a[1].min(b[1]) - reach).floor().clamp(0.0, image_height) as usize;
            let y_to = (a[1].max(b[1]) + reach).ceil().clamp(0.0, image_height) as usize;
            for y in y_from..y_to {
                let centre_y = y as f32 + 0.5;
                let (from, to) = span(a, along, centre_y, reach);
                let x_from = from.floor().clamp(0.0, image_width) as usize;
                let x_to = to.ceil().clamp(0.0, image_width) as usize;
                for x in x_from..x_to {
                    let p = [x as f32 + 0.5 - a[0], centre_y - a[1]];
                    let t = if length_squared > 0.0 {
                        ((p[0] * along[0] + p[1] * along[1]) / length_squared).clamp(0.0, 1.0)
                    } else {
                        0.0
                    };
                    let away = (p[0] - t * along[0]).hypot(p[1] - t * along[1]);
                    let covered = (reach - away).clamp(0.0, 1.0) * weight;
                    if covered > 0.0 {
                        let i = y * row_length + x;
                        if self.coverage[i] == 0.0 {
                            self.touched.push(i as u32);
                        }
                        self.coverage[i] = self.coverage[i].max(covered);
                    }
                }
            }
        }
    }

    /// Blends everything covered since the last flush in one colour.
    pub(crate) fn flush(&mut self, color: Color, alpha: f32) {
        for i in self.touched.drain(..) {
            let i = i as usize;
            blend(self.image, i, color, self.coverage[i] * alpha);
            self.coverage[i] = 0.0;
        }
    }
}

/// The columns that a row at `y` may have within `reach` of segment a–b: the segment cut to the rows near `y`,
/// widened by `reach`.
fn span(a: Point, along: Point, y: f32, reach: f32) -> (f32, f32) {
    let (mut t0, mut t1) = (0.0f32, 1.0f32);
    if along[1].abs() > 1e-6 {
        let (u, v) = ((y - reach - a[1]) / along[1], (y + reach - a[1]) / along[1]);
        t0 = t0.max(u.min(v));
        t1 = t1.min(u.max(v));
        if t0 > t1 {
            return (0.0, 0.0);
        }
    }
    let (x0, x1) = (a[0] + t0 * along[0], a[0] + t1 * along[0]);
    (x0.min(x1) - reach, x0.max(x1) + reach)
}

/// Mixes a colour into byte pixel `i`. Done on encoded values: thin dark strokes keep the weight that designers of
/// fonts expect.
fn blend(image: &mut Image, i: usize, color: Color, alpha: f32) {
    let rgb = image.rgb_mut();
    for k in 0..3 {
        let old = f32::from(rgb[3 * i + k]);
        rgb[3 * i + k] = (old + (f32::from(color.0[k]) - old) * alpha.clamp(0.0, 1.0)).round() as u8;
    }
}

/// Cuts a polyline into its dashes.
fn dashes(points: &[Point], [dash, gap]: Dash) -> Vec<Vec<Point>> {
    let mut pieces = Vec::new();
    if !(dash > 0.0 && gap > 0.0) {
        return vec![points.to_vec()];
    }
    let mut current: Vec<Point> = points.first().map(|p| vec![*p]).unwrap_or_default();
    let mut drawing = true;
    let mut left = dash;
    for pair in points.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        if !length.is_finite() {
            continue;
        }
        let mut done = 0.0;
        while length - done > left {
            done += left;
            let t = done / length;
            let p = [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])];
            if drawing {
                current.push(p);
                pieces.push(std::mem::take(&mut current));
            } else {
                current = vec![p];
            }
            drawing = !drawing;
            left = if drawing { dash } else { gap };
        }
        left -= length - done;
        if drawing {
            current.push(b);
        }
    }
    if drawing && current.len() > 1 {
        pieces.push(current);
    }
    pieces
}

/// Signed areas of outline edges by pixel: the sum from a row's left end to a pixel is the pixel's winding coverage.
struct AreaBuffer {
    width: usize,
    height: usize,
    cells: Vec<f32>,
}

impl AreaBuffer {
    fn new(width: usize, height: usize) -> Self {
        Self { width, height, cells: vec![0.0; (width + 2) * height] }
    }

    /// Adds an edge. What lies above, below or right of the buffer adds nothing; what lies left of it counts at the
    /// left border, so that cut-off outlines stay closed.
    fn edge(&mut self, p: Point, q: Point) {
        if p[1] == q[1] {
            return;
        }
        let (top, bottom, sign) = if p[1] < q[1] { (p, q, 1.0) } else { (q, p, -1.0) };
        let slope = (bottom[0] - top[0]) / (bottom[1] - top[1]);
        let y_from = top[1].max(0.0);
        let y_to = bottom[1].min(self.height as f32);
        let mut y = y_from;
        while y < y_to {
            let row = y.floor();
            let next = (row + 1.0).min(y_to);
            let xs = [y, next].map(|at| top[0] + (at - top[1]) * slope);
            self.row_piece(row as usize, xs, sign * (next - y));
            y = next;
        }
    }

    /// Adds the part of an edge in one row: from column position `xs[0]` to `xs[1]`, signed height `height`.
    fn row_piece(&mut self, row: usize, xs: [f32; 2], height: f32) {
        let w = self.width as f32;
        let (x0, x1) = (xs[0].min(xs[1]), xs[0].max(xs[1]));
        let cells = &mut self.cells[row * (self.width + 2)..(row + 1) * (self.width + 2)];
        let run = x1 - x0;
        // Height per column; a vertical piece has all of it in one column.
        let mut spread = |from: f32, to: f32, part: f32| {
            let column = from.floor().clamp(0.0, w);
            let middle = 0.5 * (from + to) - column;
            cells[column as usize] += part * (1.0 - middle);
            cells[column as usize + 1] += part * middle;
        };
        if run < 1e-6 || x0.floor() == x1.floor() {
            let at = 0.5 * (x0 + x1);
            let at = at.clamp(0.0, w);
            spread(at, at, height);
            return;
        }
        if x0 < 0.0 {
            spread(0.0, 0.0, height * (x1.min(0.0) - x0) / run);
        }
        let mut x = x0.max(0.0);
        let end = x1.min(w);
        while x < end {
            let next = (x.floor() + 1.0).min(end);
            spread(x, next, height * (next - x) / run);
            x = next;
        }
    }
}
