//! Round shapes through nodes of a skin (least squares).
//!
//! Nodes lie on the exact face however coarsely it is meshed; facets are chords. So facets only give first guesses, and the nodes
//! what comes of them.

use glam::DVec3;

use super::descent::refined;
use super::eigen::eigen;
use super::shape::Shape;

/// Radii larger than this many times the extent of what is fitted are flat.
const FLAT: f64 = 30.0;
/// Cones are steeper than this and less steep than a right angle less this, in radians.
const STEEP: f64 = 3e-3;
/// Nodes that are within this share of the wanted error of one plane are on no round shape.
const IN_PLANE: f64 = 0.1;
/// Eigenvalues smaller than this share of the largest are directions in which the shape moves within itself.
const IDLE: f64 = 1e-11;

/// What is to be fitted: nodes, and facets with their middles, unit normals and areas.
#[derive(Debug, Default)]
pub(super) struct Cloud {
    pub(super) nodes: Vec<DVec3>,
    /// Mean unit normals of the facets about every node.
    pub(super) node_normals: Vec<DVec3>,
    pub(super) facets: Vec<(DVec3, DVec3, f64)>,
}

/// A shape with the largest distance of a node from it, in mm.
pub(super) type Fitted = (Shape, f64);

/// A shape to begin with.
type Guess = fn(&Cloud) -> Option<Shape>;

impl Cloud {
    /// The four round shapes that come nearest to the nodes, the simplest first; those that degenerate are left out, and those that
    /// clearly will not come within `wanted` mm.
    pub(super) fn fits(&self, wanted: f64) -> Vec<Fitted> {
        let Some((centre, scale)) = self.frame().filter(|_| self.sag() > IN_PLANE * wanted) else {
            return Vec::new();
        };
        let unit = Self {
            nodes: self.nodes.iter().map(|p| (*p - centre) / scale).collect(),
            node_normals: self.node_normals.clone(),
            facets: self.facets.iter().map(|(p, n, a)| ((*p - centre) / scale, *n, *a)).collect(),
        };
        // Fewer nodes than this are on some shape of the kind anyway.
        let kinds: [(usize, Guess); 4] =
            [(8, Self::cylinder), (10, Self::cone), (7, Self::sphere), (14, Self::torus)];
        let guesses = kinds.iter().filter(|k| unit.nodes.len() >= k.0).filter_map(|(_, guess)| guess(&unit));
        let shapes = guesses.map(|guess| refined(guess, &unit.nodes, wanted / scale)).filter(is_round);
        shapes.map(|s| self.with_error(placed(s, centre, scale))).collect()
    }

    /// The same kind of shape, fitted from another.
    pub(super) fn refit(&self, shape: Shape, wanted: f64) -> Option<Fitted> {
        let (centre, scale) = self.frame()?;
        let nodes: Vec<DVec3> = self.nodes.iter().map(|p| (*p - centre) / scale).collect();
        let guess = placed(shape, -centre / scale, 1.0 / scale);
        let fitted = Some(refined(guess, &nodes, wanted / scale)).filter(is_round)?;
        Some(self.with_error(placed(fitted, centre, scale)))
    }

    /// How far the nodes are from one plane, at most.
    pub(super) fn sag(&self) -> f64 {
        let Some((centre, _)) = self.frame() else { return 0.0 };
        let spread = eigen::<3>(|i, j| self.nodes.iter().map(|p| (*p - centre)[i] * (*p - centre)[j]).sum());
        let Some([(_, least), ..]) = spread else { return 0.0 };
        let normal = DVec3::from_array(least);
        let heights = self.nodes.iter().map(|p| normal.dot(*p - centre));
        let (low, high) = heights.fold((f64::MAX, f64::MIN), |(l, h), x| (l.min(x), h.max(x)));
        high - low
    }

    fn with_error(&self, shape: Shape) -> Fitted {
        (shape, self.nodes.iter().map(|p| shape.distance(*p).abs()).fold(0.0, f64::max))
    }

    fn frame(&self) -> Option<(DVec3, f64)> {
        let n = self.nodes.len();
        let centre = self.nodes.iter().sum::<DVec3>() / n.max(1) as f64;
        let scale = self.nodes.iter().map(|p| p.distance(centre)).fold(0.0, f64::max);
        (n >= 6 && scale > 0.0).then_some((centre, scale))
    }

    fn cylinder(&self) -> Option<Shape> {
        let [(_, least), ..] = eigen::<3>(|i, j| self.facets.iter().map(|(_, n, a)| n[i] * n[j] * a).sum())?;
        let axis = DVec3::from_array(least);
        let (x, y) = axis.any_orthonormal_pair();
        // A circle through what is seen along the axis: |p|² = 2 c · p + k.
        let rows = self
            .nodes
            .iter()
            .map(|p| ([2.0 * p.dot(x), 2.0 * p.dot(y), 1.0], p.dot(x).powi(2) + p.dot(y).powi(2)));
        let s = linear(rows)?;
        let radius = (s[2] + s[0] * s[0] + s[1] * s[1]).max(0.0).sqrt();
        Some(Shape::Cylinder { point: x * s[0] + y * s[1], axis, radius })
    }

    fn cone(&self) -> Option<Shape> {
        let area: f64 = self.facets.iter().map(|f| f.2).sum();
        let mean = self.facets.iter().map(|(_, n, a)| *n * *a).sum::<DVec3>() / area;
        let [(_, least), ..] =
            eigen::<3>(|i, j| self.facets.iter().map(|(_, n, a)| (*n - mean)[i] * (*n - mean)[j] * a).sum())?;
        let axis = DVec3::from_array(least);
        // All tangent planes go through the tip.
        let rows = self.facets.iter().map(|(p, n, a)| ([n.x * a, n.y * a, n.z * a], n.dot(*p) * a));
        let apex = DVec3::from_array(linear(rows)?);
        let into = -apex;
        let axis = if axis.dot(into) < 0.0 { -axis } else { axis };
        Some(Shape::Cone { apex, axis, half_angle: mean.dot(axis).abs().clamp(0.0, 1.0).asin() })
    }

    fn sphere(&self) -> Option<Shape> {
        let rows = self.nodes.iter().map(|p| ([2.0 * p.x, 2.0 * p.y, 2.0 * p.z, 1.0], p.length_squared()));
        let s = linear(rows)?;
        let centre = DVec3::new(s[0], s[1], s[2]);
        Some(Shape::Sphere { centre, radius: (s[3] + centre.length_squared()).max(0.0).sqrt() })
    }

    /// All normals of a surface of revolution meet its axis: the nearest line to that (Pottmann & Randrup 1998), and a circle through
    /// what is seen in the half-plane beside it.
    fn torus(&self) -> Option<Shape> {
        let lines: Vec<[f64; 6]> = self
            .nodes
            .iter()
            .zip(&self.node_normals)
            .map(|(p, n)| {
                let m = p.cross(*n);
                [n.x, n.y, n.z, m.x, m.y, m.z]
            })
            .collect();
        let [(_, least), ..] = eigen::<6>(|i, j| lines.iter().map(|l| l[i] * l[j]).sum())?;
        let (moment, direction) = (DVec3::from_slice(&least[..3]), DVec3::from_slice(&least[3..]));
        let square = direction.length_squared();
        if square < 1e-6 {
            return None;
        }
        let (axis, on_axis) = (direction / square.sqrt(), direction.cross(moment) / square);
        let flat = |p: DVec3| {
            let along = axis.dot(p - on_axis);
            ((p - on_axis - axis * along).length(), along)
        };
        let rows = self.nodes.iter().map(|p| {
            let (r, h) = flat(*p);
            ([2.0 * r, 2.0 * h, 1.0], r * r + h * h)
        });
        let s = linear(rows)?;
        let minor = (s[2] + s[0] * s[0] + s[1] * s[1]).max(0.0).sqrt();
        Some(Shape::Torus { centre: on_axis + axis * s[1], axis, major: s[0], minor })
    }
}

/// A shape scaled about the origin, then moved.
fn placed(shape: Shape, by: DVec3, scale: f64) -> Shape {
    match shape {
        Shape::Plane { normal, offset } => Shape::Plane { normal, offset: offset * scale + normal.dot(by) },
        Shape::Cylinder { point, axis, radius } => {
            Shape::Cylinder { point: point * scale + by, axis, radius: radius * scale }
        }
        Shape::Cone { apex, axis, half_angle } => Shape::Cone { apex: apex * scale + by, axis, half_angle },
        Shape::Sphere { centre, radius } => {
            Shape::Sphere { centre: centre * scale + by, radius: radius * scale }
        }
        Shape::Torus { centre, axis, major, minor } => {
            Shape::Torus { centre: centre * scale + by, axis, major: major * scale, minor: minor * scale }
        }
        Shape::Freeform => Shape::Freeform,
    }
}

/// Whether a shape of extent one is what it is called, and not a flat or pointed limit of it.
fn is_round(shape: &Shape) -> bool {
    let sound = |r: f64| r > 1e-6 && r < FLAT;
    match *shape {
        Shape::Cylinder { radius, .. } | Shape::Sphere { radius, .. } => sound(radius),
        Shape::Cone { half_angle, .. } => {
            half_angle > STEEP && half_angle < std::f64::consts::FRAC_PI_2 - STEEP
        }
        Shape::Torus { major, minor, .. } => sound(minor) && major > 1e-3 && major < FLAT,
        Shape::Plane { .. } | Shape::Freeform => true,
    }
}

/// The least squares solution of linear equations.
fn linear<const N: usize>(rows: impl Iterator<Item = ([f64; N], f64)>) -> Option<[f64; N]> {
    let (mut matrix, mut right) = ([[0.0; N]; N], [0.0; N]);
    for (row, value) in rows {
        for i in 0..N {
            right[i] += row[i] * value;
            for j in 0..N {
                matrix[i][j] += row[i] * row[j];
            }
        }
    }
    let values = eigen::<N>(|i, j| matrix[i][j])?;
    let largest = values[N - 1].0.max(0.0);
    let mut solution = [0.0; N];
    for (value, vector) in values.iter().filter(|v| v.0 > IDLE * largest) {
        let share: f64 = vector.iter().zip(&right).map(|(v, r)| v * r).sum::<f64>() / value;
        solution.iter_mut().zip(vector).for_each(|(x, v)| *x += share * v);
    }
    Some(solution)
}
