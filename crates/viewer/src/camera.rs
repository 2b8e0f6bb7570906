//! Where a picture is taken from.

use glam::{DVec2, DVec3};

use crate::error::{RenderError, check_size};
use crate::legend;
use crate::render::RenderOptions;
use crate::scene::Scene;

/// Named directions of sight. The model stands along +y and faces +z; its own left is +x.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum View {
    /// The model's front: it looks at the camera, its left is on the picture's right.
    #[default]
    Front,
    /// Its back.
    Back,
    /// Its left side (seen from +x).
    Left,
    /// Its right side (seen from -x).
    Right,
    /// From above; the front is at the picture's lower edge.
    Top,
    /// From below; the front is at the picture's upper edge.
    Bottom,
    /// From the front, its left and a little above.
    Iso,
}

impl View {
    /// All views.
    pub const ALL: [Self; 7] =
        [Self::Front, Self::Back, Self::Left, Self::Right, Self::Top, Self::Bottom, Self::Iso];

    /// Unit vector from the model to the camera, and the unit vector that is up in the picture.
    pub fn axes(self) -> (DVec3, DVec3) {
        let (back, up) = match self {
            Self::Front => (DVec3::Z, DVec3::Y),
            Self::Back => (DVec3::NEG_Z, DVec3::Y),
            Self::Left => (DVec3::X, DVec3::Y),
            Self::Right => (DVec3::NEG_X, DVec3::Y),
            Self::Top => (DVec3::Y, DVec3::NEG_Z),
            Self::Bottom => (DVec3::NEG_Y, DVec3::Z),
            Self::Iso => (DVec3::new(0.58, 0.30, 0.84).normalize(), DVec3::Y),
        };
        let right = up.cross(back).normalize();
        (back, back.cross(right))
    }
}

/// How depth becomes size.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum Lens {
    /// Parallel: lengths across the line of sight are to scale everywhere.
    #[default]
    Orthographic,
    /// Near things are larger.
    Perspective {
        /// Angle of sight from the lower to the upper edge, in radians; more than 0 and less than 3.
        fov: f64,
    },
}

impl Lens {
    /// A long lens (22°): natural, with little distortion.
    pub const PORTRAIT: Self = Self::Perspective { fov: 0.384 };
}

/// A camera: place, direction, lens. Make one with [`Camera::new`] or [`Camera::toward`], then [`Camera::fit`].
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// The point that is at the picture's centre (before `shift`), in millimetres.
    pub target: DVec3,
    /// Unit vector from the target to the camera.
    pub back: DVec3,
    /// Unit vector that is up in the picture, across `back`.
    pub up: DVec3,
    /// The lens.
    pub lens: Lens,
    /// Height in millimetres that the picture shows at the target's depth.
    pub height: f64,
    /// The target's offset from the picture's centre, as a part of the picture's height (right, up).
    pub shift: DVec2,
}

/// Pixels left free around the fitted model.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Insets {
    pub(crate) left: f64,
    pub(crate) right: f64,
    pub(crate) top: f64,
    pub(crate) bottom: f64,
}

impl Camera {
    /// A camera that looks along a named view at the origin; [`Camera::fit`] moves it to the model.
    pub fn new(view: View, lens: Lens) -> Self {
        let (back, up) = view.axes();
        Self { target: DVec3::ZERO, back, up, lens, height: 1000.0, shift: DVec2::ZERO }
    }

    /// A camera that sees the model from direction `from` (model to camera, any length), with `up` about up in the
    /// picture.
    ///
    /// # Errors
    /// [`RenderError::Option`] when `from` has no direction or `up` is parallel to it.
    pub fn toward(from: DVec3, up: DVec3, lens: Lens) -> Result<Self, RenderError> {
        let problem = |value| RenderError::Option {
            option: "camera direction",
            value,
            range: "the direction must be a vector of some length and not parallel to up",
        };
        let back = from.try_normalize().ok_or(problem(from.length()))?;
        let right = up.cross(back).try_normalize().ok_or(problem(up.length()))?;
        Ok(Self {
            target: DVec3::ZERO,
            back,
            up: back.cross(right),
            lens,
            height: 1000.0,
            shift: DVec2::ZERO,
        })
    }

    /// Moves the camera so that the whole scene is in the picture, with room for its title and legend. O(n).
    ///
    /// # Errors
    /// As [`crate::render`]: an empty scene, a bad coordinate, an impossible size or lens.
    pub fn fit(self, scene: &Scene, options: &RenderOptions) -> Result<Self, RenderError> {
        check_size(options.width, options.height)?;
        scene.check()?;
        self.check()?;
        let insets = legend::insets(scene, options);
        Ok(self.fitted(&scene.places().collect::<Vec<_>>(), options, insets))
    }

    /// Moves the camera so that the box `[lo, hi]` (mm) is in the picture: the same frame for several scenes.
    ///
    /// # Errors
    /// An impossible size or lens, a box that is none.
    pub fn fit_bounds(self, bounds: [DVec3; 2], options: &RenderOptions) -> Result<Self, RenderError> {
        check_size(options.width, options.height)?;
        self.check()?;
        let [lo, hi] = bounds;
        if !(lo.is_finite() && hi.is_finite() && lo.cmple(hi).all()) {
            return Err(RenderError::Coordinate {
                what: "corner of the box to fit, index".to_owned(),
                index: 0,
            });
        }
        let pick = |i: u32, k: u32| if i & k == 0 { lo } else { hi };
        let corners: Vec<DVec3> =
            (0..8).map(|i| DVec3::new(pick(i, 1).x, pick(i, 2).y, pick(i, 4).z)).collect();
        Ok(self.fitted(&corners, options, Insets::margin(options)))
    }

    pub(crate) fn right(&self) -> DVec3 {
        self.up.cross(self.back)
    }

    /// Checks lens and directions.
    pub(crate) fn check(&self) -> Result<(), RenderError> {
        if let Lens::Perspective { fov } = self.lens
            && !(fov > 1e-3 && fov < 3.0)
        {
            return Err(RenderError::Option {
                option: "angle of sight",
                value: fov,
                range: "it must be more than 0.001 and less than 3 radians",
            });
        }
        if !(self.height.is_finite() && self.height > 0.0) {
            return Err(RenderError::Option {
                option: "height shown",
                value: self.height,
                range: "it must be a positive number of millimetres",
            });
        }
        let skew =
            (self.back.length() - 1.0).abs() + (self.up.length() - 1.0).abs() + self.back.dot(self.up).abs();
        if skew.is_nan() || skew > 1e-6 || !self.target.is_finite() || !self.shift.is_finite() {
            return Err(RenderError::Option {
                option: "camera directions",
                value: skew,
                range: "back and up must be unit vectors at right angles",
            });
        }
        Ok(())
    }

    fn fitted(mut self, places: &[DVec3], options: &RenderOptions, insets: Insets) -> Self {
        let (width, height) = (f64::from(options.width), f64::from(options.height));
        // The free rectangle, at least a third of the picture.
        let free = DVec2::new(
            (width - insets.left - insets.right).max(width / 3.0),
            (height - insets.top - insets.bottom).max(height / 3.0),
        );
        let right = self.right();
        let extent = |axis: DVec3| {
            places
                .iter()
                .map(|p| p.dot(axis))
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)))
        };
        let (x, y, z) = (extent(right), extent(self.up), extent(self.back));
        let middle = |(l, h): (f64, f64)| 0.5 * (l + h);
        let target = |x: f64, y: f64| right * x + self.up * y + self.back * middle(z);
        self.target = target(middle(x), middle(y));
        // A single point still gets a picture: a millimetre of it.
        let least = 1e-6 * self.target.abs().max_element().max(1.0);
        match self.lens {
            Lens::Orthographic => {
                let scale = ((x.1 - x.0) / free.x).max((y.1 - y.0) / free.y).max(least / free.y);
                self.height = scale * height;
            }
            Lens::Perspective { fov } => {
                // Pixels of an object of size 1 at distance 1.
                let focal = 0.5 * height / (0.5 * fov).tan();
                // Nearest allowed distance along each border's plane: a point at (u, w) is seen within ±half when
                // |u| f / (d - w) <= half. Lower and upper borders give the lens's best place and distance.
                let cone = |axis: DVec3, half: f64| {
                    let k = half / focal;
                    let (mut upper, mut lower) = (f64::NEG_INFINITY, f64::NEG_INFINITY);
                    for p in places {
                        let (u, w) = (p.dot(axis), (*p - self.target).dot(self.back));
                        upper = upper.max(u + k * w);
                        lower = lower.max(-u + k * w);
                    }
                    // At distance d the borders stand at c ± k d: c + k d >= upper, -c + k d >= lower.
                    (0.5 * (upper - lower), 0.5 * (upper + lower) / k)
                };
                let (cx, dx) = cone(right, 0.5 * free.x);
                let (cy, dy) = cone(self.up, 0.5 * free.y);
                self.target = target(cx, cy);
                let depth = z.1 - z.0;
                let distance = dx.max(dy).max(0.5 * depth * 1.05).max(least);
                self.height = distance * height / focal;
            }
        }
        let centre = DVec2::new(0.5 * (insets.left - insets.right), 0.5 * (insets.bottom - insets.top));
        self.shift = centre / height;
        self
    }
}

impl Insets {
    /// The plain margin around a picture.
    pub(crate) fn margin(options: &RenderOptions) -> Self {
        let m = 0.04 * f64::from(options.height.min(options.width));
        Self { left: m, right: m, top: m, bottom: m }
    }
}

/// A camera with a picture's size: places to pixels.
#[derive(Clone, Debug)]
pub(crate) struct Projector {
    target: DVec3,
    right: DVec3,
    up: DVec3,
    back: DVec3,
    /// Pixels a millimetre at the target's depth.
    scale: f64,
    /// Distance of the eye from the target; infinite for parallel sight.
    distance: f64,
    centre: DVec2,
}

/// A place in the picture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OnScreen {
    /// Pixels, x right, y down.
    pub(crate) at: DVec2,
    /// Rises towards the eye and is linear over the picture on every plane.
    pub(crate) nearness: f64,
}

impl Projector {
    pub(crate) fn new(camera: &Camera, width: u32, height: u32) -> Self {
        let (w, h) = (f64::from(width), f64::from(height));
        let distance = match camera.lens {
            Lens::Orthographic => f64::INFINITY,
            Lens::Perspective { fov } => 0.5 * camera.height / (0.5 * fov).tan(),
        };
        Self {
            target: camera.target,
            right: camera.right(),
            up: camera.up,
            back: camera.back,
            scale: h / camera.height,
            distance,
            centre: DVec2::new(0.5 * w + camera.shift.x * h, 0.5 * h - camera.shift.y * h),
        }
    }

    /// A place in the camera's axes: right, up, towards the eye, from the target, in millimetres.
    pub(crate) fn to_camera(&self, p: DVec3) -> DVec3 {
        let d = p - self.target;
        DVec3::new(d.dot(self.right), d.dot(self.up), d.dot(self.back))
    }

    /// Largest camera depth (towards the eye) that is in front of the eye.
    pub(crate) fn near_limit(&self) -> f64 {
        if self.distance.is_finite() { self.distance * (1.0 - 1e-4) } else { f64::INFINITY }
    }

    /// A camera-space place in front of the near limit to the picture.
    pub(crate) fn camera_to_screen(&self, c: DVec3) -> OnScreen {
        let (factor, nearness) = if self.distance.is_finite() {
            let ratio = self.distance / (self.distance - c.z);
            (self.scale * ratio, ratio)
        } else {
            (self.scale, c.z)
        };
        OnScreen { at: DVec2::new(self.centre.x + c.x * factor, self.centre.y - c.y * factor), nearness }
    }

    /// A place in the picture; `None` behind the eye.
    pub(crate) fn project(&self, p: DVec3) -> Option<OnScreen> {
        let c = self.to_camera(p);
        (c.z < self.near_limit()).then(|| self.camera_to_screen(c))
    }

    /// The line of sight through a pixel position: a point on it and its unit direction away from the eye.
    pub(crate) fn ray(&self, at: DVec2) -> (DVec3, DVec3) {
        let u = (at.x - self.centre.x) / self.scale;
        let v = (self.centre.y - at.y) / self.scale;
        let through = self.target + self.right * u + self.up * v;
        if self.distance.is_finite() {
            let eye = self.target + self.back * self.distance;
            (eye, (through - eye).normalize())
        } else {
            (through, -self.back)
        }
    }

    /// Right, up and back as vectors of the scene.
    pub(crate) fn axes(&self) -> [DVec3; 3] {
        [self.right, self.up, self.back]
    }

    /// Millimetres a pixel at a place.
    pub(crate) fn pixel_size(&self, p: DVec3) -> f64 {
        let z = self.to_camera(p).z;
        if self.distance.is_finite() {
            (self.distance - z) / self.distance / self.scale
        } else {
            1.0 / self.scale
        }
    }
}
