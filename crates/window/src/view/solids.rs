//! What hides things and what rays meet: the body and the garment.

use std::sync::Arc;

use glam::DVec3;
use mesh_kernel::query::RayCaster;
use sketch::{Ray, Sight};

use super::eye::before;

/// Meshes prepared for rays.
#[derive(Clone, Debug, Default)]
pub(crate) struct Solids {
    pub(crate) body: Option<Arc<RayCaster>>,
    pub(crate) garment: Option<Arc<RayCaster>>,
}

/// Where a line of sight ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Seen {
    pub(crate) place: DVec3,
    /// The face of the garment; `None` on the body.
    pub(crate) garment_face: Option<u32>,
}

impl Solids {
    /// The first place that a line of sight meets. O(log faces).
    pub(crate) fn first(&self, ray: &Ray) -> Option<Seen> {
        let cast = |caster: &Option<Arc<RayCaster>>, to: f64| {
            caster.as_ref().and_then(|c| c.first(ray.origin, ray.direction, 0.0, to))
        };
        let garment = cast(&self.garment, f64::INFINITY);
        let body = cast(&self.body, garment.map_or(f64::INFINITY, |h| h.distance));
        let (distance, face) = match (body, garment) {
            (Some(body), _) => (body.distance, None),
            (None, garment) => garment.map(|h| (h.distance, Some(h.face)))?,
        };
        Some(Seen { place: ray.origin + distance * ray.direction, garment_face: face })
    }

    /// The first place of the body alone: what is drawn on it goes through the cloth.
    pub(crate) fn on_body(&self, ray: &Ray) -> Option<DVec3> {
        let hit = self.body.as_ref()?.first(ray.origin, ray.direction, 0.0, f64::INFINITY)?;
        Some(ray.origin + hit.distance * ray.direction)
    }

    /// What hides things from an eye with parallel sight or with perspective.
    pub(crate) fn seen_by(&self, is_parallel: bool) -> SolidSight<'_> {
        SolidSight { solids: self, is_parallel }
    }
}

/// The solids as something that hides.
pub(crate) struct SolidSight<'a> {
    solids: &'a Solids,
    is_parallel: bool,
}

impl Sight for SolidSight<'_> {
    fn hides(&self, ray: &Ray, p: DVec3, slack: f64) -> bool {
        let ray = before(*ray, self.is_parallel);
        let reach = (p - ray.origin).dot(ray.direction) - slack;
        let meets = |caster: &Option<Arc<RayCaster>>| {
            caster.as_ref().is_some_and(|c| c.first(ray.origin, ray.direction, 0.0, reach).is_some())
        };
        reach > 0.0 && (meets(&self.solids.body) || meets(&self.solids.garment))
    }
}
