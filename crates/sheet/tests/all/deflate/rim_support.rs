//! Thin solids with rounded and chamfered rims.

use std::f64::consts::{FRAC_PI_2, TAU};

use mesh_kernel::TriMesh;
use mesh_kernel::glam::DVec3;

/// The section of a rim: how far inward and how high, from the lower side to the upper one.
pub(crate) type Rim = Vec<[f64; 2]>;

/// A quarter of a circle in `chords`: (1, 0) to (0, 1), that is inward and down from a corner.
fn quarter(chords: u32) -> impl DoubleEndedIterator<Item = [f64; 2]> {
    (0..=chords)
        .map(move |k| FRAC_PI_2 * f64::from(k) / f64::from(chords))
        .map(|a| [1.0 - a.sin(), 1.0 - a.cos()])
}

/// Both edges of a rim of a wall of some thickness, about 0, rounded in `chords`; one chord is a chamfer.
pub(crate) fn rounded_rim(thickness: f64, radius: f64, chords: u32) -> Rim {
    let half = thickness / 2.0;
    let lower = quarter(chords).map(|[d, z]| [radius * d, radius * z - half]);
    let upper = quarter(chords).rev().map(|[d, z]| [radius * d, half - radius * z]);
    lower.chain(upper).collect()
}

/// Only the upper edge rounded.
pub(crate) fn half_rounded_rim(thickness: f64, radius: f64, chords: u32) -> Rim {
    let upper = rounded_rim(thickness, radius, chords).split_off(chords as usize + 1);
    [[0.0, -thickness / 2.0]].into_iter().chain(upper).collect()
}

/// A rectangle about the origin with its corners rounded in `chords`, from the corner (+, +) on, `inward` of its outline.
pub(crate) fn outline(size: [f64; 2], corner: f64, chords: u32, inward: f64) -> Vec<[f64; 2]> {
    let centre = size.map(|s| s / 2.0 - corner);
    let signs = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]];
    let arc = |(k, [sx, sy]): (u32, [f64; 2])| {
        (0..=chords).map(move |i| {
            let a = FRAC_PI_2 * (f64::from(k) + f64::from(i) / f64::from(chords));
            let r = corner - inward;
            [sx * centre[0] + r * a.cos(), sy * centre[1] + r * a.sin()]
        })
    };
    (0..).zip(signs).flat_map(arc).collect()
}

/// As many nodes on a circle about the origin.
pub(crate) fn circle(radius: f64, nodes: u32) -> Vec<[f64; 2]> {
    // From the middle of the first half side on, as an outline is.
    let at = |k: u32| TAU * (f64::from(k) + 0.5) / f64::from(nodes);
    (0..nodes).map(|k| [radius * at(k).cos(), radius * at(k).sin()]).collect()
}

pub(crate) fn area(polygon: &[[f64; 2]]) -> f64 {
    let next = polygon.iter().cycle().skip(1);
    polygon.iter().zip(next).map(|(a, b)| (a[0] * b[1] - a[1] * b[0]) / 2.0).sum()
}

/// Rings of as many nodes each, one above the other, anticlockwise from above.
fn rings(rings: &[Vec<DVec3>], closed: bool) -> TriMesh {
    let (n, m) = (rings[0].len() as u32, rings.len() as u32);
    let mut mesh = TriMesh::new(rings.concat(), Vec::new());
    for k in 0..if closed { m } else { m - 1 } {
        let (here, above) = (k * n, (k + 1) % m * n);
        for i in 0..n {
            let j = (i + 1) % n;
            mesh.faces.extend([[here + i, here + j, above + j], [here + i, above + j, above + i]]);
        }
    }
    mesh
}

fn at_height(ring: Vec<[f64; 2]>, z: f64) -> Vec<DVec3> {
    ring.into_iter().map(|[x, y]| DVec3::new(x, y, z)).collect()
}

/// A plate with an outline, given how far inward, and a rim.
pub(crate) fn plate(outline: impl Fn(f64) -> Vec<[f64; 2]>, rim: &[[f64; 2]]) -> TriMesh {
    capped(&rim.iter().map(|[d, z]| at_height(outline(*d), *z)).collect::<Vec<_>>())
}

/// The same with a round hole, which has the same rim.
pub(crate) fn plate_with_hole(
    outline: impl Fn(f64) -> Vec<[f64; 2]>,
    radius: f64,
    rim: &[[f64; 2]],
) -> TriMesh {
    let nodes = outline(0.0).len() as u32;
    let outer = rim.iter().map(|[d, z]| at_height(outline(*d), *z));
    let inner = rim.iter().rev().map(|[d, z]| at_height(circle(radius + d, nodes), *z));
    rings(&outer.chain(inner).collect::<Vec<_>>(), true)
}

/// Rings with strips across them at both ends: the last node of a ring lies opposite to its first one, and so on.
fn capped(all: &[Vec<DVec3>]) -> TriMesh {
    let mut mesh = rings(all, false);
    let n = all[0].len() as u32;
    let top = mesh.positions.len() as u32 - n;
    for i in 0..n / 2 - 1 {
        let [a, b, c, d] = [i, i + 1, n - 2 - i, n - 1 - i];
        for [a, b, c] in [[a, b, c], [a, c, d]] {
            mesh.faces.extend([[a, c, b], [top + a, top + b, top + c]]);
        }
    }
    mesh
}

/// A plate bent by 90°: legs to the bend, mid radius of the bend in `chords`, width. The lower side of the rim is outside.
/// `beside`: the rim goes along the edges that are bent, too, not only along those at the ends of the legs.
pub(crate) fn bracket(
    leg: f64,
    radius: f64,
    chords: u32,
    width: f64,
    rim: &[[f64; 2]],
    beside: bool,
) -> TriMesh {
    let length = 2.0 * leg + FRAC_PI_2 * radius;
    let ring = |[inward, w]: [f64; 2]| {
        let aside = if beside { inward } else { 0.0 };
        let bend = (0..=chords).map(|k| leg + FRAC_PI_2 * radius * f64::from(k) / f64::from(chords));
        let along: Vec<f64> = [inward].into_iter().chain(bend).chain([length - inward]).collect();
        let bent = |s: f64, z: f64| {
            let a = ((s - leg) / radius).clamp(0.0, FRAC_PI_2);
            let (before, after) = ((s - leg).min(0.0), (s - length + leg).max(0.0));
            DVec3::new(leg + before + (radius - w) * a.sin(), radius + after - (radius - w) * a.cos(), z)
        };
        let back = along.iter().rev().map(|s| bent(*s, aside));
        // Anticlockwise as seen from the upper side.
        along.iter().map(|s| bent(*s, width - aside)).chain(back).collect::<Vec<_>>()
    };
    capped(&rim.iter().map(|r| ring(*r)).collect::<Vec<_>>())
}

/// A wall of a tube: radius, number of facets.
type Skin = (f64, u32);

/// A tube about z of two skins of long facets with nodes only at the ends; `end`: how high it goes at a point.
pub(crate) fn tube(inner: Skin, outer: Skin, end: impl Fn([f64; 2]) -> f64) -> TriMesh {
    let mut mesh = TriMesh::default();
    let mut starts = Vec::new();
    for ((radius, n), outward) in [(outer, true), (inner, false)] {
        let start = mesh.positions.len() as u32;
        let ring = circle(radius, n);
        mesh.positions.extend(at_height(ring.clone(), 0.0));
        mesh.positions.extend(ring.iter().map(|p| DVec3::new(p[0], p[1], end(*p))));
        for i in 0..n {
            let [a, b] = [start + i, start + (i + 1) % n];
            let faces = [[a, b, b + n], [a, b + n, a + n]];
            mesh.faces.extend(faces.map(|[a, b, c]| if outward { [a, b, c] } else { [a, c, b] }));
        }
        starts.push(start);
    }
    // The ends: whichever ring is behind goes on.
    let ([o, i], (n, m)) = ([starts[0], starts[1]], (outer.1, inner.1));
    let (mut k, mut l) = (0, 0);
    while k < n || l < m {
        let outside = l == m || k < n && (2 * k + 1) * m <= (2 * l + 1) * n;
        let [a, b] = [o + k % n, i + l % m];
        let c = if outside { o + (k + 1) % n } else { i + (l + 1) % m };
        let up = |v: u32| if v < i { v + n } else { v + m };
        mesh.faces.extend([[a, b, c], [up(a), up(c), up(b)]]);
        if outside { k += 1 } else { l += 1 }
    }
    mesh
}
