//! Extrusion along a path, shifted or turned with it.

use glam::DVec3;

use super::ModelError;
use super::build::SAME_POINT;
use super::extrude::Profile;

/// Where the profile's nodes are at every corner of a path.
pub(super) struct Stations {
    pub(super) nodes: Vec<Vec<DVec3>>,
    /// Whether the last station is the first again.
    pub(super) closed: bool,
}

/// Carries a profile along a path without turning it.
pub(super) fn shifted(profile: &Profile, path: &[DVec3], closed: bool) -> Stations {
    let nodes = path.iter().map(|q| profile.nodes.iter().map(|p| *p + (*q - path[0])).collect());
    Stations { nodes: nodes.collect(), closed }
}

/// Carries a profile along a path and turns it with that: every face is plane, and corners of the path are mitred.
pub(super) fn turned(profile: &Profile, path: &[DVec3], closed: bool) -> Result<Stations, ModelError> {
    let n = path.len();
    let steps = if closed { n } else { n - 1 };
    let direction: Vec<DVec3> =
        (0..steps).map(|k| (path[(k + 1) % n] - path[k]).normalize_or_zero()).collect();
    // The plane across the path at every corner.
    let across = |k: usize| {
        let before = if k > 0 {
            Some(k - 1)
        } else if closed {
            Some(steps - 1)
        } else {
            None
        };
        let after = (k < steps).then_some(k);
        match (before, after) {
            (Some(b), Some(a)) => direction[b] + direction[a],
            (Some(b), None) => direction[b],
            (None, Some(a)) => direction[a],
            (None, None) => DVec3::ZERO,
        }
    };
    let slide = |p: DVec3, d: DVec3, k: usize, at: DVec3| -> Result<DVec3, ModelError> {
        let normal = across(k);
        let slope = d.dot(normal);
        if slope <= 1e-3 {
            return Err(ModelError::TurnsTooSharply { at });
        }
        Ok(p + d * ((at - p).dot(normal) / slope))
    };
    let mut stations: Vec<Vec<DVec3>> = Vec::with_capacity(n);
    let start = if closed {
        profile.nodes.iter().map(|p| slide(*p, direction[0], 0, path[0])).collect::<Result<_, _>>()?
    } else {
        profile.nodes.clone()
    };
    stations.push(start);
    for k in 0..if closed { n - 1 } else { steps } {
        let next = stations[k]
            .iter()
            .map(|p| {
                let q = slide(*p, direction[k], k + 1, path[(k + 1) % n])?;
                // Where the sweep runs backward it turns into itself.
                if (q - *p).dot(direction[k]) < -SAME_POINT {
                    return Err(ModelError::TurnsTooSharply { at: path[k] });
                }
                Ok(q)
            })
            .collect::<Result<Vec<_>, _>>()?;
        stations.push(next);
    }
    Ok(Stations { nodes: stations, closed })
}

impl Stations {
    /// A face over every link and step, each with the number of its link; faces without an area are left out.
    pub(super) fn faces(&self, profile: &Profile) -> Vec<(usize, Vec<DVec3>)> {
        let n = self.nodes.len();
        let steps = if self.closed { n } else { n - 1 };
        let mut faces = Vec::new();
        for k in 0..steps {
            let (here, there) = (&self.nodes[k], &self.nodes[(k + 1) % n]);
            for (l, &[a, b]) in profile.links.iter().enumerate() {
                let mut corners = vec![here[a], here[b], there[b], there[a]];
                corners.dedup_by(|p, q| p.distance(*q) <= SAME_POINT);
                if corners.len() > 1 && corners[0].distance(corners[corners.len() - 1]) <= SAME_POINT {
                    corners.pop();
                }
                if corners.len() > 2 && super::build::area_vector(&corners).length() > SAME_POINT * SAME_POINT
                {
                    faces.push((l, corners));
                }
            }
        }
        faces
    }
}
