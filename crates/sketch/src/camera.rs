//! Cameras: places to pixels and back, exactly.

use glam::{DVec2, DVec3};

/// How depth becomes size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// Parallel sight.
    Orthographic,
    /// Near things are larger; angle of sight from the lower to the upper edge, radians, above 0 and below π.
    Perspective {
        /// The angle.
        fov: f64,
    },
}

/// A camera with the size of its picture. Pixels count from the upper left corner, x to the right, y down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// The place that is at the picture's centre, mm.
    pub target: DVec3,
    /// Unit vector from the target to the eye.
    pub back: DVec3,
    /// Unit vector that is up in the picture, at a right angle to `back`.
    pub up: DVec3,
    /// Height that the picture shows at the target's depth, mm.
    pub height: f64,
    /// The lens.
    pub projection: Projection,
    /// Size of the picture, pixels.
    pub size: DVec2,
}

/// A line of sight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// A point on it: the eye, or for parallel sight a point of the plane through the target.
    pub origin: DVec3,
    /// Unit direction away from the eye.
    pub direction: DVec3,
}

/// A plane through `point` with unit `normal`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// A point of it, mm.
    pub point: DVec3,
    /// Its unit normal.
    pub normal: DVec3,
}

/// A line of sight that meets a plane under a smaller sine than this (about 1°) says nothing about where on it.
const GRAZING: f64 = 0.0175;

impl Camera {
    /// Unit vector to the right in the picture.
    pub fn right(&self) -> DVec3 {
        self.up.cross(self.back)
    }

    /// Distance of the eye from the target, mm; infinite for parallel sight.
    pub fn distance(&self) -> f64 {
        match self.projection {
            Projection::Orthographic => f64::INFINITY,
            Projection::Perspective { fov } => 0.5 * self.height / (0.5 * fov).tan(),
        }
    }

    /// The eye; `None` for parallel sight.
    pub fn eye(&self) -> Option<DVec3> {
        let distance = self.distance();
        distance.is_finite().then(|| self.target + self.back * distance)
    }

    /// Pixels a millimetre at a place; `None` behind the eye.
    pub fn scale_at(&self, p: DVec3) -> Option<f64> {
        let scale = self.size.y / self.height;
        let distance = self.distance();
        if distance.is_infinite() {
            return Some(scale);
        }
        let ahead = distance - (p - self.target).dot(self.back);
        (ahead > 1e-6 * distance).then(|| scale * distance / ahead)
    }

    /// Where a place is in the picture, which may be beyond its border; `None` behind the eye.
    pub fn project(&self, p: DVec3) -> Option<DVec2> {
        let scale = self.scale_at(p)?;
        let d = p - self.target;
        Some(0.5 * self.size + scale * DVec2::new(d.dot(self.right()), -d.dot(self.up)))
    }

    /// How far a place lies from the plane of the target towards the eye, mm.
    pub fn depth(&self, p: DVec3) -> f64 {
        (p - self.target).dot(self.back)
    }

    /// The line of sight through a pixel.
    pub fn ray(&self, at: DVec2) -> Ray {
        let d = (at - 0.5 * self.size) * (self.height / self.size.y);
        let through = self.target + self.right() * d.x - self.up * d.y;
        match self.eye() {
            Some(eye) => Ray { origin: eye, direction: (through - eye).normalize_or(-self.back) },
            None => Ray { origin: through, direction: -self.back },
        }
    }

    /// The place on a plane that is seen at a pixel; `None` where the plane is seen from its edge or lies behind the eye.
    pub fn unproject(&self, at: DVec2, plane: &Plane) -> Option<DVec3> {
        let ray = self.ray(at);
        let slope = ray.direction.dot(plane.normal);
        if slope.abs() < GRAZING {
            return None;
        }
        let t = (plane.point - ray.origin).dot(plane.normal) / slope;
        (self.eye().is_none() || t > 0.0).then(|| ray.origin + t * ray.direction)
    }

    /// The same camera with a picture of another size: the same height is shown.
    #[must_use]
    pub fn with_size(self, size: DVec2) -> Self {
        Self { size, ..self }
    }
}
