//! Edges, faces and joints of a template as it is written, without a body.

use std::collections::{BTreeMap, BTreeSet};

use template::format::{JointSpec, SurfaceSpec, TemplateFile};

/// The faces of a surface by node names: those of its grid, then those that are listed.
pub fn faces(surface: &SurfaceSpec) -> Vec<Vec<String>> {
    let mut out = Vec::new();
    for pair in surface.rows.iter().flat_map(|rows| rows.windows(2)) {
        let [upper, lower] = [&pair[0], &pair[1]];
        let (mut i, mut j) = (0, 0);
        // The row that lags goes first; rows in step make a quad, as the template's own grids do.
        while i + 1 < upper.len() || j + 1 < lower.len() {
            let ahead =
                |k: usize, n: usize| if k + 1 < n { (k + 1) as f64 / (n - 1) as f64 } else { f64::INFINITY };
            let (u, l) = (ahead(i, upper.len()), ahead(j, lower.len()));
            let corners = if (u - l).abs() < 1e-9 {
                (i, j) = (i + 1, j + 1);
                vec![&upper[i - 1], &lower[j - 1], &lower[j], &upper[i]]
            } else if u < l {
                i += 1;
                vec![&upper[i - 1], &lower[j], &upper[i]]
            } else {
                j += 1;
                vec![&upper[i], &lower[j - 1], &lower[j]]
            };
            out.push(corners.into_iter().cloned().collect());
        }
    }
    out.extend(surface.faces.iter().flatten().cloned());
    out
}

/// A pair of names in order.
pub(super) fn pair(a: &str, b: &str) -> [String; 2] {
    if a <= b { [a.to_owned(), b.to_owned()] } else { [b.to_owned(), a.to_owned()] }
}

/// The sides of a face as pairs in order.
pub(super) fn sides(face: &[String]) -> impl Iterator<Item = [String; 2]> + '_ {
    (0..face.len()).map(|k| pair(&face[k], &face[(k + 1) % face.len()])).filter(|[a, b]| a != b)
}

/// Every edge of a template with the surfaces that have it; written ones only, no twins.
pub fn edges(file: &TemplateFile) -> BTreeMap<[String; 2], BTreeSet<String>> {
    let mut out: BTreeMap<[String; 2], BTreeSet<String>> = BTreeMap::new();
    for (name, surface) in &file.surfaces {
        for face in faces(surface) {
            for side in sides(&face) {
                out.entry(side).or_default().insert(name.clone());
            }
        }
    }
    out
}

/// The joints that edges shared by surfaces make: a chain for every set of surfaces.
pub fn joints(file: &TemplateFile) -> Vec<JointSpec> {
    let mut by_surfaces: BTreeMap<BTreeSet<String>, Vec<[String; 2]>> = BTreeMap::new();
    for (edge, surfaces) in edges(file) {
        if surfaces.len() > 1 {
            by_surfaces.entry(surfaces).or_default().push(edge);
        }
    }
    let mut out = Vec::new();
    for (surfaces, mut rest) in by_surfaces {
        while let Some([a, b]) = rest.pop() {
            let mut chain = vec![a, b];
            // Grow the chain at both ends as long as one edge goes on.
            for front in [false, true] {
                loop {
                    let end = if front { &chain[0] } else { &chain[chain.len() - 1] };
                    let next: Vec<usize> = (0..rest.len()).filter(|k| rest[*k].contains(end)).collect();
                    let [k] = next[..] else { break };
                    let [p, q] = rest.remove(k);
                    let other = if p == *end { q } else { p };
                    if front {
                        chain.insert(0, other);
                    } else {
                        chain.push(other);
                    }
                }
            }
            let closed = chain.len() > 3 && chain[0] == chain[chain.len() - 1];
            if closed {
                chain.pop();
            }
            out.push(JointSpec {
                name: None,
                surfaces: surfaces.iter().cloned().collect(),
                nodes: chain,
                closed,
            });
        }
    }
    out
}
