//! Parts of a picture that hands go round: boxes and lassos.

use glam::DVec2;
use sketch::polygon_holds;

/// A box or a lasso, in whatever the picture is measured in.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Region {
    /// Two opposite corners.
    Box(DVec2, DVec2),
    /// A line that closes itself.
    Lasso(Vec<DVec2>),
}

impl Region {
    pub(crate) fn new(at: DVec2, is_lasso: bool) -> Self {
        if is_lasso { Self::Lasso(vec![at]) } else { Self::Box(at, at) }
    }

    /// The hand is here now.
    pub(crate) fn reach(&mut self, to: DVec2) {
        match self {
            Self::Box(_, end) => *end = to,
            Self::Lasso(line) => line.push(to),
        }
    }

    pub(crate) fn holds(&self, p: DVec2) -> bool {
        match self {
            Self::Box(a, b) => p.cmpge(a.min(*b)).all() && p.cmple(a.max(*b)).all(),
            Self::Lasso(line) => polygon_holds(line, p),
        }
    }

    /// Its border, closed.
    pub(crate) fn border(&self) -> Vec<DVec2> {
        match self {
            Self::Box(a, b) => vec![*a, DVec2::new(b.x, a.y), *b, DVec2::new(a.x, b.y), *a],
            Self::Lasso(line) => line.iter().chain(line.first()).copied().collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lasso_leaves_out_what_it_goes_round() {
        let mut lasso = Region::new(DVec2::ZERO, true);
        for (x, y) in [(10.0, 0.0), (10.0, 10.0), (5.0, 2.0), (0.0, 10.0)] {
            lasso.reach(DVec2::new(x, y));
        }
        assert!(lasso.holds(DVec2::new(1.0, 4.0)) && lasso.holds(DVec2::new(9.0, 4.0)));
        assert!(!lasso.holds(DVec2::new(5.0, 6.0)) && !lasso.holds(DVec2::new(11.0, 1.0)));
        let mut whole = Region::new(DVec2::new(8.0, 9.0), false);
        whole.reach(DVec2::ZERO);
        assert!(whole.holds(DVec2::new(5.0, 6.0)) && !whole.holds(DVec2::new(9.0, 1.0)));
    }
}
