//! Validity: every broken rule, with ids and the values measured. One file a family of rules.
//!
//! Rules on ids come first; where an id names nothing the rest cannot be asked and is not. The geometric rules and the
//! counts come last, and run only on a body whose incidence is sound.

mod attributes;
mod boundary;
mod defect;
mod duplicates;
mod geometry;
mod identity;
mod ids;
mod incidence;
mod joints;
#[cfg(test)]
mod planted;

pub use defect::Defect;

use super::Body;

impl Body {
    /// All broken rules, in order of families, then ids; empty for a sound body.
    ///
    /// Checked are: array lengths and ids; incidence both ways, winding; chains, loops and the boundary;
    /// joints: lengths, directions, coincidence, radial order against the geometry (exact); attributes; finite
    /// coordinates, degenerate (exact) and duplicate faces and edges; the identity of [`Body::counts`].
    ///
    /// O(faces · log faces).
    pub fn check(&self) -> Vec<Defect> {
        let (mut defects, incident) = self.check_structure();
        if !incident {
            return defects;
        }
        let joined = defects.is_empty();
        let finite = geometry::check_finite(self, &mut defects);
        if finite {
            joints::check_coincidence(self, &mut defects);
        }
        if !joined {
            return defects;
        }
        duplicates::check(self, &mut defects);
        if finite {
            joints::check_radial_order(self, &mut defects);
            geometry::check_degenerate(self, &mut defects);
        }
        identity::check(self, &mut defects);
        defects
    }

    /// The broken rules that have nothing to do with where nodes are: what a body must keep for its queries and operators
    /// to work at all.
    pub(crate) fn check_topology(&self) -> Vec<Defect> {
        self.check_structure().0
    }

    /// The rules of topology, and whether incidence is sound, without which nothing else can be asked.
    fn check_structure(&self) -> (Vec<Defect>, bool) {
        let mut defects = Vec::new();
        ids::check(self, &mut defects);
        if defects.is_empty() {
            incidence::check(self, &mut defects);
        }
        if !defects.is_empty() {
            return (defects, false);
        }
        boundary::check(self, &mut defects);
        joints::check_topology(self, &mut defects);
        attributes::check(self, &mut defects);
        (defects, true)
    }
}
