//! Which way is up, and in which unit: from the height and from how the level sections branch.
//!
//! A standing person has two outlines of like size in the lower third (legs), one that holds nearly all of the area in
//! the middle (trunk, with or without arms beside it) and a single small one at the top (head). A dress form may have
//! one pole or one block instead of legs and a neck plate instead of a head.

use mesh_kernel::TriMesh;
use mesh_kernel::glam::{DVec2, DVec3};
use mesh_kernel::query::SectionStack;
use rayon::prelude::*;

use super::error::HumanError;
use super::ring::{Gaps, Ring, outer_rings};
use super::{HumanOptions, Unit};

/// Levels of the coarse look.
const LEVELS: usize = 64;
/// Shortest and tallest body (or dress form without head and stand), metres.
const HEIGHT_RANGE: [f64; 2] = [0.5, 2.5];

/// The answer.
pub(crate) struct Upright {
    /// Unit vector upward, file frame.
    pub(crate) up: DVec3,
    pub(crate) unit: Unit,
}

/// A pair of horizontal directions that makes a right-handed frame `(left, up, front)` with `up`.
pub(crate) fn level_directions(up: DVec3) -> (DVec3, DVec3) {
    let front = [DVec3::Z, DVec3::X, DVec3::Y]
        .into_iter()
        .find(|d| d.dot(up).abs() < 0.6)
        .map_or(DVec3::Z, |d| (d - up * d.dot(up)).normalize());
    (up.cross(front), front)
}

/// Finds up and unit.
pub(crate) fn find(mesh: &TriMesh, options: &HumanOptions) -> Result<Upright, HumanError> {
    let axes: Vec<DVec3> = match options.up {
        Some(up) => vec![up.normalize()],
        None => vec![DVec3::Y, DVec3::Z, DVec3::X],
    };
    let extents: Vec<(f64, f64)> = axes.iter().map(|axis| extent(mesh, *axis)).collect();
    let longest = extents.iter().map(|(low, high)| high - low).fold(0.0, f64::max);
    let candidates: Vec<(DVec3, f64, f64, Unit)> = axes
        .into_iter()
        .zip(extents)
        .filter(|(_, (low, high))| high - low > 0.45 * longest)
        .filter_map(|(axis, (low, high))| Some((axis, low, high, unit_of(high - low, options.unit)?)))
        .collect();
    if candidates.is_empty() {
        return Err(match options.unit {
            Some(unit) => HumanError::HeightInUnit { height: longest, unit },
            None => HumanError::Height { height: longest },
        });
    }
    let looks: Vec<[Look; 2]> =
        candidates.par_iter().map(|&(axis, low, high, _)| look(mesh, axis, low, high)).collect();
    let mut best: Option<(f64, DVec3, Unit)> = None;
    let mut reason = (-1.0, String::new());
    for (&(axis, _, _, unit), pair) in candidates.iter().zip(&looks) {
        for (look, sign) in pair.iter().zip([1.0, -1.0]) {
            if sign < 0.0 && options.up.is_some() {
                continue;
            }
            if let Some(why) = &look.missing {
                if look.score > reason.0 {
                    reason = (look.score, why.clone());
                }
            } else if best.as_ref().is_none_or(|b| look.score > b.0 + 1e-9) {
                best = Some((look.score, axis * sign, unit));
            }
        }
    }
    match best {
        Some((_, up, unit)) => Ok(Upright { up, unit }),
        None => Err(HumanError::NotUpright { reason: reason.1 }),
    }
}

fn extent(mesh: &TriMesh, axis: DVec3) -> (f64, f64) {
    mesh.faces.iter().flatten().fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), v| {
        let h = mesh.positions[*v as usize].dot(axis);
        (lo.min(h), hi.max(h))
    })
}

/// The unit in which an extent is a person's height: the one that was said, if it is.
fn unit_of(extent: f64, said: Option<Unit>) -> Option<Unit> {
    let units = said.map_or(&[Unit::Metre, Unit::Centimetre, Unit::Millimetre][..], |_| &[]);
    said.iter()
        .chain(units)
        .copied()
        .find(|u| (HEIGHT_RANGE[0]..=HEIGHT_RANGE[1]).contains(&(extent * u.millimetres() / 1000.0)))
}

/// How well the sections along one direction are those of a person.
struct Look {
    score: f64,
    missing: Option<String>,
}

fn look(mesh: &TriMesh, axis: DVec3, low: f64, high: f64) -> [Look; 2] {
    let stack = SectionStack::new(mesh, axis);
    let (left, front) = level_directions(axis);
    let height = high - low;
    let mut levels: Vec<Vec<Ring>> = (0..LEVELS)
        .map(|i| {
            let at = low + height * (i as f64 + 0.5) / LEVELS as f64;
            let mut rings = outer_rings(&stack.cut(at), 0.008, Gaps::Join, |p| {
                DVec2::new(p.dot(left), p.dot(front)) / height
            });
            rings.retain(|r| r.area > 1e-4);
            rings
        })
        .collect();
    let upward = judge(&levels);
    levels.reverse();
    [upward, judge(&levels)]
}

/// Levels from the floor up; lengths are parts of the height.
fn judge(levels: &[Vec<Ring>]) -> Look {
    let share = |from: f64, to: f64, test: &dyn Fn(&[Ring]) -> bool| {
        let range = (from * LEVELS as f64) as usize..(to * LEVELS as f64) as usize;
        let count = range.len() as f64;
        range.filter(|i| test(&levels[*i])).count() as f64 / count
    };
    let area = |rings: &[Ring]| rings.iter().map(|r| r.area).sum::<f64>();
    let legs = share(0.05, 0.36, &|r| {
        r.len() >= 2
            && r[1].area > 0.4 * r[0].area
            && r.get(2).is_none_or(|third| third.area < 0.7 * r[1].area)
    });
    let trunk = share(0.58, 0.70, &|r| !r.is_empty() && r[0].area > 0.55 * area(r));
    let head = share(0.90, 0.98, &|r| !r.is_empty() && r[0].area > 0.75 * area(r));
    let widest = |from: f64, to: f64| {
        let range = (from * LEVELS as f64) as usize..(to * LEVELS as f64) as usize;
        levels[range].iter().filter_map(|r| r.first()).map(|r| r.area).fold(0.0, f64::max)
    };
    let chest = widest(0.55, 0.80);
    let top = widest(0.93, 0.99);
    let neck =
        levels[LEVELS * 72 / 100..LEVELS * 98 / 100].iter().map(|r| area(r)).fold(f64::INFINITY, f64::min);
    let score = legs + trunk + head;
    let missing = if !(0.004..0.09).contains(&chest) {
        Some(format!(
            "its trunk would have a section of {:.1} % of the height squared (people: 1 to 6 %)",
            chest * 100.0
        ))
    } else if legs < 0.75 {
        Some("there are no two legs of like size below".to_owned())
    } else if trunk < 0.8 {
        Some("there is no single trunk above the legs".to_owned())
    } else if head < 0.6 || top > 1.2 * chest || neck > 0.55 * chest {
        Some("there is no head or neck narrower than the trunk at the top".to_owned())
    } else {
        None
    };
    Look { score, missing }
}
