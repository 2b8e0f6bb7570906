//! The eye: orbit, pan, zoom, named views, frame.

use eframe::egui;
use glam::{DQuat, DVec2, DVec3};
use sketch::{Camera, Projection, Ray};

/// Angle of sight, radians: a long lens, with little distortion.
const FOV: f64 = 0.384;
/// Radians a pixel of the hand turns.
const TURN: f64 = 0.008;
/// Heights in millimetres that the picture may show.
const HEIGHTS: [f64; 2] = [5.0, 20_000.0];
/// Parallel sight begins this far before the target, mm: farther than any model that [`HEIGHTS`] can show.
const FAR: f64 = 50_000.0;

/// A camera, and how hands move it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Eye {
    pub(crate) camera: Camera,
}

impl Eye {
    /// Sees a person from the front.
    pub(crate) fn new() -> Self {
        let projection = Projection::Perspective { fov: FOV };
        let target = DVec3::new(0.0, 1050.0, 0.0);
        let camera =
            Camera { target, back: DVec3::Z, up: DVec3::Y, height: 1500.0, projection, size: DVec2::ONE };
        Self { camera }
    }

    /// Turns about a place, which stays where it is in the picture; up stays the world's.
    pub(crate) fn orbit(&mut self, pixels: egui::Vec2, pivot: DVec3) {
        let c = &mut self.camera;
        let turn = DQuat::from_rotation_y(-TURN * f64::from(pixels.x));
        let tilt = DQuat::from_axis_angle(turn * c.right(), -TURN * f64::from(pixels.y));
        // Not over the head: left and right would change places.
        let whole = if (tilt * turn * c.up).y > 0.0 { tilt * turn } else { turn };
        c.target = pivot + whole * (c.target - pivot);
        c.back = (whole * c.back).normalize();
        let up = whole * c.up;
        c.up = (up - c.back * up.dot(c.back)).normalize();
    }

    pub(crate) fn pan(&mut self, pixels: egui::Vec2) {
        let c = &mut self.camera;
        let step = c.height / c.size.y;
        c.target += step * (f64::from(pixels.y) * c.up - f64::from(pixels.x) * c.right());
    }

    /// Zooms so that what is under the pointer stays there.
    pub(crate) fn zoom(&mut self, factor: f64, at: DVec2) {
        let c = &mut self.camera;
        let height = (c.height / factor).clamp(HEIGHTS[0], HEIGHTS[1]);
        let off = (at - 0.5 * c.size) * ((c.height - height) / c.size.y);
        c.target += c.right() * off.x - c.up * off.y;
        c.height = height;
    }

    pub(crate) fn look(&mut self, view: viewer::View) {
        (self.camera.back, self.camera.up) = view.axes();
    }

    /// Between perspective and parallel sight; what is at the target's depth keeps its size.
    pub(crate) fn toggle_projection(&mut self) {
        self.camera.projection = match self.camera.projection {
            Projection::Orthographic => Projection::Perspective { fov: FOV },
            Projection::Perspective { .. } => Projection::Orthographic,
        };
    }

    pub(crate) fn is_parallel(&self) -> bool {
        self.camera.projection == Projection::Orthographic
    }

    /// Shows all of some places, with air about them; nothing where there are none.
    pub(crate) fn frame(&mut self, places: impl IntoIterator<Item = DVec3> + Clone) {
        let c = &mut self.camera;
        let axes = [c.right(), c.up, c.back];
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for p in places {
            let along = DVec3::from_array(axes.map(|a| p.dot(a)));
            (low, high) = (low.min(along), high.max(along));
        }
        if !low.is_finite() {
            return;
        }
        let middle = 0.5 * (low + high);
        c.target = axes[0] * middle.x + axes[1] * middle.y + axes[2] * middle.z;
        let size = high - low;
        let needed = size.y.max(size.x * c.size.y / c.size.x);
        // What is nearer than the middle looks larger; a single node must not fill the window.
        c.height = (1.15 * needed + 0.2 * size.z).clamp(120.0, HEIGHTS[1]);
    }

    /// The line of sight through a pixel, from a place before everything.
    pub(crate) fn ray(&self, at: DVec2) -> Ray {
        before(self.camera.ray(at), self.is_parallel())
    }
}

/// A line of sight whose origin is before everything: that of parallel sight starts at the target's depth.
pub(super) fn before(ray: Ray, is_parallel: bool) -> Ray {
    if is_parallel { Ray { origin: ray.origin - FAR * ray.direction, ..ray } } else { ray }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pivot_stays_in_its_place_and_up_stays_up() {
        let mut eye = Eye::new();
        eye.camera.size = DVec2::new(800.0, 600.0);
        let pivot = DVec3::new(120.0, 1300.0, 90.0);
        let before = eye.camera.project(pivot).unwrap();
        for k in 0..200 {
            eye.orbit(egui::vec2(7.0 * (k % 5) as f32, 11.0 - (k % 23) as f32), pivot);
        }
        assert!(eye.camera.project(pivot).unwrap().distance(before) < 1e-6);
        assert!(eye.camera.up.y > 0.0 && eye.camera.right().y.abs() < 1e-9);
        // From straight above one can turn and come down again.
        eye.look(viewer::View::Top);
        eye.orbit(egui::vec2(40.0, -60.0), DVec3::ZERO);
        assert!(eye.camera.up.y > 0.1, "{}", eye.camera.up);
    }

    #[test]
    fn what_is_framed_is_in_the_picture() {
        let mut eye = Eye::new();
        eye.camera.size = DVec2::new(500.0, 900.0);
        let places = [DVec3::new(-300.0, 0.0, 50.0), DVec3::new(250.0, 900.0, -80.0), DVec3::Y * 1700.0];
        for view in viewer::View::ALL {
            for _ in 0..2 {
                eye.toggle_projection();
                eye.look(view);
                eye.frame(places);
                for p in places {
                    let at = eye.camera.project(p).unwrap();
                    assert!(at.cmpge(DVec2::ZERO).all() && at.cmple(eye.camera.size).all(), "{view:?} {at}");
                }
            }
        }
    }
}
