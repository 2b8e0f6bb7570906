//! Profiles: 3D curves on template edges, parameterised by arc length, and how they move with their edge (eq. 3).

use glam::{DQuat, DVec3};

/// A curve with its arc-length parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    pub(crate) points: Vec<DVec3>,
    /// Share of the whole length at each point, 0 to 1.
    pub(crate) shares: Vec<f64>,
    length: f64,
}

impl Profile {
    /// A curve through `points` (two at least; the caller checked), straight between them.
    pub fn new(points: Vec<DVec3>) -> Self {
        let mut shares = Vec::with_capacity(points.len());
        let mut length = 0.0;
        for (i, p) in points.iter().enumerate() {
            length += if i == 0 { 0.0 } else { (*p - points[i - 1]).length() };
            shares.push(length);
        }
        if length > 0.0 {
            shares.iter_mut().for_each(|s| *s /= length);
        }
        Self { points, shares, length }
    }

    /// Its points, first and last are the edge's ends.
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// Length, mm.
    pub fn length(&self) -> f64 {
        self.length
    }

    /// The place at share `u` (0 to 1) of the length. O(log n).
    pub fn place(&self, u: f64) -> DVec3 {
        let last = self.points.len() - 1;
        let after = self.shares.partition_point(|s| *s < u).clamp(1, last);
        let (a, b) = (self.shares[after - 1], self.shares[after]);
        let t = if b > a { ((u - a) / (b - a)).clamp(0.0, 1.0) } else { 0.0 };
        self.points[after - 1].lerp(self.points[after], t)
    }

    /// The profile after its edge moved to new ends (eq. 3): the detail, that is the distance to the straight edge at
    /// the same arc-length share, is scaled with the edge's length and added to the new straight edge.
    ///
    /// With [`Detail::Turned`] the detail also takes the smallest turn that brings the old edge's direction to the new.
    pub fn moved(&self, start: DVec3, end: DVec3, detail: Detail) -> Self {
        let (v, w) = (self.points[0], self.points[self.points.len() - 1]);
        let (old, new) = (w - v, end - start);
        let scale = if old.length() > 0.0 { new.length() / old.length() } else { 0.0 };
        let turn = match detail {
            Detail::Kept => DQuat::IDENTITY,
            Detail::Turned => match (old.try_normalize(), new.try_normalize()) {
                (Some(a), Some(b)) => DQuat::from_rotation_arc(a, b),
                _ => DQuat::IDENTITY,
            },
        };
        let last = self.points.len() - 1;
        let points = self.points.iter().zip(&self.shares).enumerate().map(|(i, (q, u))| match i {
            // The ends meet the edge's ends to the bit.
            0 => start,
            i if i == last => end,
            _ => scale * (turn * (*q - v - *u * old)) + start + *u * new,
        });
        Self::new(points.collect())
    }
}

/// What happens to a profile's detail when its edge turns.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Detail {
    /// It keeps its direction in space, as in the paper.
    #[default]
    Kept,
    /// It turns with the edge.
    Turned,
}
