//! The Euler–Poincaré identity.

use super::Defect;
use crate::body::Body;

pub(super) fn check(body: &Body, defects: &mut Vec<Defect>) {
    let counts = body.counts();
    if !counts.identity_holds() {
        defects.push(Defect::Identity(counts));
    }
}
