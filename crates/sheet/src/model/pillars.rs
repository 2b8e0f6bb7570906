//! Straight extrusion of any graph of wires, and what becomes of edges along it (Stroud & Nagy, figs. 6.17–6.19).
//!
//! Nodes on one line along the direction are a *pillar*. Every node that has a link across the direction sweeps an interval
//! of its pillar; a link along the direction lies on a pillar, and what of it no interval covers is the question.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};
use sketch::{Branch, order_of_branches};

use super::ModelError;
use super::build::SAME_POINT;
use super::command::AlongWire;
use super::extrude::{ExtrusionCase, Profile};

/// What an extrusion makes.
pub(super) struct Extruded {
    /// Corners of the faces, each with the number of its link.
    pub(super) faces: Vec<(usize, Vec<DVec3>)>,
    pub(super) case: ExtrusionCase,
    /// Links along the direction that stay wires.
    pub(super) kept: Vec<usize>,
}

struct Pillars<'a> {
    profile: &'a Profile,
    /// Unit direction and distance.
    up: DVec3,
    distance: f64,
    /// Height of every node along the direction.
    height: Vec<f64>,
    pillar: Vec<usize>,
    /// Whether links across the direction leave a node.
    active: Vec<bool>,
}

/// Extrudes a profile by a vector.
pub(super) fn extrude(profile: &Profile, by: DVec3, along: AlongWire) -> Result<Extruded, ModelError> {
    let distance = by.length();
    let Some(up) = by.try_normalize().filter(|_| distance > SAME_POINT) else {
        return Err(ModelError::Number { what: "the extrusion", wanted: "finite and longer than nothing" });
    };
    let height: Vec<f64> = profile.nodes.iter().map(|p| p.dot(up)).collect();
    let lateral: Vec<DVec3> = profile.nodes.iter().zip(&height).map(|(p, h)| *p - up * *h).collect();
    let mut pillar: Vec<usize> = Vec::with_capacity(lateral.len());
    let mut firsts: Vec<usize> = Vec::new();
    for (i, p) in lateral.iter().enumerate() {
        match firsts.iter().position(|&f| lateral[f].distance(*p) <= SAME_POINT) {
            Some(k) => pillar.push(k),
            None => {
                firsts.push(i);
                pillar.push(firsts.len() - 1);
            }
        }
    }
    let across = |l: &[usize; 2]| pillar[l[0]] != pillar[l[1]];
    let mut active = vec![false; profile.nodes.len()];
    for link in profile.links.iter().filter(|l| across(l)) {
        active[link[0]] = true;
        active[link[1]] = true;
    }
    if !active.contains(&true) {
        return Err(ModelError::NothingAcross);
    }
    let pillars = Pillars { profile, up, distance, height, pillar, active };
    pillars.check_branches()?;
    let (case, kept) = pillars.judge(along)?;
    Ok(Extruded { faces: pillars.faces(), case, kept })
}

impl Pillars<'_> {
    fn is_along(&self, link: usize) -> bool {
        let [a, b] = self.profile.links[link];
        self.pillar[a] == self.pillar[b]
    }

    /// What becomes of links along the direction.
    fn judge(&self, along: AlongWire) -> Result<(ExtrusionCase, Vec<usize>), ModelError> {
        let mut inner = Vec::new();
        let mut kept = Vec::new();
        for run in self.runs() {
            let at = |h: f64, node: usize| self.profile.nodes[node] + self.up * (h - self.height[node]);
            let nodes: Vec<usize> = {
                let mut nodes: Vec<usize> = run.iter().flat_map(|&l| self.profile.links[l]).collect();
                nodes.sort_by(|a, b| self.height[*a].total_cmp(&self.height[*b]).then(a.cmp(b)));
                nodes.dedup();
                nodes
            };
            let (Some(&bottom), Some(&top)) = (nodes.first(), nodes.last()) else { continue };
            // An end of the run that nothing else hangs on dangles.
            let loose = [(bottom, top), (top, bottom)].into_iter().find(|(end, _)| !self.active[*end]);
            if let Some((end, other)) = loose {
                match along {
                    AlongWire::Refuse => {
                        return Err(ModelError::Dangling {
                            from: self.profile.nodes[other],
                            to: self.profile.nodes[end],
                        });
                    }
                    AlongWire::Keep => kept.extend(&run),
                    AlongWire::Drop => {}
                }
                continue;
            }
            // Sheets from active nodes of the run must overlap from one to the next.
            let heights: Vec<(f64, usize)> =
                nodes.iter().filter(|n| self.active[**n]).map(|n| (self.height[*n], *n)).collect();
            for w in heights.windows(2) {
                let gap = w[1].0 - w[0].0;
                if gap >= self.distance - SAME_POINT {
                    match along {
                        AlongWire::Refuse => {
                            return Err(ModelError::AmbiguousAlong {
                                from: self.profile.nodes[w[0].1],
                                to: self.profile.nodes[w[1].1],
                                length: gap,
                                distance: self.distance,
                            });
                        }
                        AlongWire::Keep => kept.extend(&run),
                        AlongWire::Drop => {}
                    }
                } else {
                    inner.push([at(w[1].0, w[1].1), at(w[0].0 + self.distance, w[0].1)]);
                }
            }
        }
        kept.sort_unstable();
        kept.dedup();
        let case = if inner.is_empty() { ExtrusionCase::Plain } else { ExtrusionCase::InnerEdges(inner) };
        Ok((case, kept))
    }

    /// Links along the direction, those that hang together in one run.
    fn runs(&self) -> Vec<Vec<usize>> {
        let mut runs: Vec<Vec<usize>> = Vec::new();
        for link in (0..self.profile.links.len()).filter(|&l| self.is_along(l)) {
            let touches = |run: &Vec<usize>| {
                let ends = self.profile.links[link];
                run.iter().any(|&l| self.profile.links[l].iter().any(|n| ends.contains(n)))
            };
            let (mut joined, others): (Vec<_>, Vec<_>) = runs.into_iter().partition(touches);
            runs = others;
            let mut run: Vec<usize> = joined.drain(..).flatten().collect();
            run.push(link);
            runs.push(run);
        }
        runs
    }

    /// A face over every link across the direction; corners wherever an interval of its pillars begins or ends.
    fn faces(&self) -> Vec<(usize, Vec<DVec3>)> {
        let mut events: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
        for (n, &h) in self.height.iter().enumerate() {
            let list = events.entry(self.pillar[n]).or_default();
            list.push(h);
            if self.active[n] {
                list.push(h + self.distance);
            }
        }
        for list in events.values_mut() {
            list.sort_by(f64::total_cmp);
            list.dedup_by(|a, b| (*a - *b).abs() <= SAME_POINT);
        }
        let climb = |node: usize| -> Vec<DVec3> {
            let from = self.height[node];
            let mut points = vec![self.profile.nodes[node]];
            for h in &events[&self.pillar[node]] {
                if *h > from + SAME_POINT && *h < from + self.distance - SAME_POINT {
                    points.push(self.profile.nodes[node] + self.up * (h - from));
                }
            }
            points.push(self.profile.nodes[node] + self.up * self.distance);
            points
        };
        (0..self.profile.links.len())
            .filter(|&l| !self.is_along(l))
            .map(|l| {
                let [a, b] = self.profile.links[l];
                let mut corners = vec![self.profile.nodes[a]];
                corners.extend(climb(b));
                corners.extend(climb(a).into_iter().skip(1).rev());
                (l, corners)
            })
            .collect()
    }

    /// Where three and more links branch, their order about the direction by tangents and curvatures must be that of the chords
    /// by which the faces are ordered (Müller's method, figs. 6.19).
    fn check_branches(&self) -> Result<(), ModelError> {
        let x = self.up.any_orthonormal_vector();
        let y = self.up.cross(x);
        let flat = |d: DVec3| DVec2::new(d.dot(x), d.dot(y));
        for node in 0..self.profile.nodes.len() {
            let links: Vec<(usize, usize)> = (0..self.profile.links.len())
                .filter(|&l| !self.is_along(l))
                .filter_map(|l| Some((l, self.profile.links[l].iter().position(|n| *n == node)?)))
                .collect();
            if links.len() < 3 {
                continue;
            }
            let at = self.profile.nodes[node];
            let refuse = |why: String| ModelError::Branches { at, why };
            let chord = |&(l, end): &(usize, usize)| {
                let tangent =
                    flat(self.profile.nodes[self.profile.links[l][1 - end]] - at).normalize_or_zero();
                Branch { tangent, curvature: 0.0 }
            };
            let curve = |key: &(usize, usize)| match self.profile.leaves.get(key) {
                Some(leave) => {
                    let (t, k) = (flat(leave.tangent), flat(leave.curvature));
                    let curvature = t.perp_dot(k) / t.length().powi(3).max(f64::MIN_POSITIVE);
                    Branch { tangent: t.normalize_or_zero(), curvature }
                }
                None => chord(key),
            };
            let curves: Vec<Branch> = links.iter().map(curve).collect();
            let chords: Vec<Branch> = links.iter().map(chord).collect();
            let by_curve = order_of_branches(&curves).map_err(|e| refuse(e.to_string()))?;
            let by_chord = order_of_branches(&chords).map_err(|e| refuse(e.to_string()))?;
            if by_curve != by_chord {
                return Err(refuse("curves are sampled too coarsely there; take a smaller tolerance".into()));
            }
        }
        Ok(())
    }
}
