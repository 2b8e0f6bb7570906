//! Work planes: where drawings lie in space.

use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

use super::ModelError;

/// A plane with axes. In JSON `"xy"`, `"yz"`, `"zx"`, or `{"origin": [0, 0, 0], "x": [1, 0, 0], "y": [0, 1, 0]}`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "PlaneData", into = "PlaneData")]
pub struct WorkPlane {
    /// Where (0, 0) of the drawing lies.
    pub origin: DVec3,
    /// Direction of the drawing's x axis.
    pub x: DVec3,
    /// Direction of the drawing's y axis; what of it is along x is left out.
    pub y: DVec3,
}

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Named {
    Xy,
    Yz,
    Zx,
}

#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum PlaneData {
    Named(Named),
    Axes {
        #[serde(default)]
        origin: DVec3,
        x: DVec3,
        y: DVec3,
    },
}

impl From<PlaneData> for WorkPlane {
    fn from(data: PlaneData) -> Self {
        let [origin, x, y] = match data {
            PlaneData::Named(Named::Xy) => [DVec3::ZERO, DVec3::X, DVec3::Y],
            PlaneData::Named(Named::Yz) => [DVec3::ZERO, DVec3::Y, DVec3::Z],
            PlaneData::Named(Named::Zx) => [DVec3::ZERO, DVec3::Z, DVec3::X],
            PlaneData::Axes { origin, x, y } => [origin, x, y],
        };
        Self { origin, x, y }
    }
}

impl From<WorkPlane> for PlaneData {
    fn from(p: WorkPlane) -> Self {
        Self::Axes { origin: p.origin, x: p.x, y: p.y }
    }
}

impl Default for WorkPlane {
    fn default() -> Self {
        Self { origin: DVec3::ZERO, x: DVec3::X, y: DVec3::Y }
    }
}

impl WorkPlane {
    /// The plane with unit axes at a right angle.
    ///
    /// # Errors
    /// [`ModelError::NoPlane`]; numbers that are not finite.
    pub fn squared(&self) -> Result<Self, ModelError> {
        if ![self.origin, self.x, self.y].iter().all(|v| v.is_finite()) {
            return Err(ModelError::Number { what: "the plane", wanted: "made of finite numbers" });
        }
        let x = self.x.try_normalize().ok_or(ModelError::NoPlane)?;
        let y = (self.y - x * self.y.dot(x)).try_normalize().ok_or(ModelError::NoPlane)?;
        if self.y.normalize_or_zero().cross(x).length() < 1e-9 {
            return Err(ModelError::NoPlane);
        }
        Ok(Self { origin: self.origin, x, y })
    }

    /// A point of the drawing in space.
    pub fn place(&self, p: DVec2) -> DVec3 {
        self.origin + self.x * p.x + self.y * p.y
    }

    /// A direction of the drawing in space.
    pub fn direction(&self, d: DVec2) -> DVec3 {
        self.x * d.x + self.y * d.y
    }

    /// Unit normal.
    pub fn normal(&self) -> DVec3 {
        self.x.cross(self.y)
    }
}
