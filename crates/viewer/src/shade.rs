//! Light on surfaces: a soft key light from the upper left, a fill light from the right, sky and floor.

use glam::{DVec3, Vec3};

use crate::camera::Projector;
use crate::occlusion::Light;

/// The lights, fixed to the camera so that every view is lit alike.
pub(crate) struct Lights {
    pub(crate) key: Vec3,
    fill: Vec3,
    up: Vec3,
}

/// How much of the light's play a surface shows.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Finish {
    /// Cloth, skin.
    Matte,
    /// Colours that mean numbers: shaded just enough to show the form.
    Data,
}

impl Lights {
    pub(crate) fn new(projector: &Projector) -> Self {
        let [right, up, back] = projector.axes();
        let toward = |x: f64, y: f64, z: f64| (right * x + up * y + back * z).normalize().as_vec3();
        // The sky is the world's, but a view along the vertical takes the picture's up for it.
        let sky = if DVec3::Y.dot(back).abs() > 0.9 { up } else { DVec3::Y };
        Self { key: toward(-0.52, 0.66, 0.62), fill: toward(0.75, 0.05, 0.55), up: sky.as_vec3() }
    }

    /// Light that leaves a surface of colour `albedo` (linear) towards the eye.
    pub(crate) fn shade(
        &self,
        albedo: [f32; 3],
        normal: Vec3,
        to_eye: Vec3,
        light: Light,
        finish: Finish,
    ) -> [f32; 3] {
        // The key wraps a little around the form, as light through a soft box does.
        let key = ((normal.dot(self.key) + 0.22) / 1.22).max(0.0) * (0.25 + 0.75 * light.key);
        let fill = normal.dot(self.fill).max(0.0) * light.ambient;
        let sky = (0.72 + 0.28 * normal.dot(self.up)) * light.ambient;
        let sum = 0.74 * key + 0.14 * fill + 0.40 * sky;
        let sum = match finish {
            Finish::Matte => sum,
            Finish::Data => 0.62 + 0.40 * sum,
        };
        // Fibres on the outline catch light.
        let graze = (1.0 - normal.dot(to_eye).clamp(0.0, 1.0)).powi(4);
        let sheen = if finish == Finish::Matte { 0.05 * graze * light.ambient } else { 0.0 };
        // What is shut off from the sky is lit by its neighbours' colour: deep folds stay warm, not grey.
        albedo.map(|c| {
            let bounce = 0.10 * c * (1.0 - light.ambient);
            c * (sum + bounce) + sheen
        })
    }
}
