//! Shape construction (T5): the split body's nodes put on their lines and faired.

use std::collections::BTreeSet;

use glam::DVec3;
use rayon::prelude::*;

use crate::error::TemplateError;
use crate::fairing::plate::Hold;
use crate::fairing::{Flap, Plate, SparseFactor, Umbrella, flaps};
use crate::format::Interior;
use crate::layout::{Layout, LayoutLine};
use crate::lines::{self, Profile};
use crate::refine::{Refined, Tag};

/// How surfaces are made smooth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// A thin plate that knows the sizes of triangles, solved once at the finest level. The default.
    #[default]
    Plate,
    /// The paper's iteration: after every split, so many steps of the second-order umbrella on each surface.
    Umbrella {
        /// Steps a level.
        steps: usize,
    },
    /// The limit of the paper's iteration, solved at the finest level.
    UmbrellaLimit,
}

/// Pull of a template node inside a patch that the surface only goes near, relative to the plate's own stiffness at the
/// spacing of the template's nodes: a node out of line is followed by about half.
const NEAR: f64 = 60.0;

/// Surfaces that are faired as one.
struct Group {
    surfaces: Vec<usize>,
    hold: Vec<Hold>,
    plate: Option<Plate>,
}

/// Surfaces that are to be faired as one.
pub(crate) struct Flat {
    surfaces: Vec<usize>,
    faces: Vec<[u32; 3]>,
    /// The bending stencils, over welded nodes.
    pub(crate) flaps: Vec<Flap>,
}

impl Flat {
    /// All of a garment.
    pub(crate) fn all(layout: &Layout, refined: &Refined) -> Vec<Self> {
        let flat = |surfaces: Vec<usize>| {
            let faces: Vec<[u32; 3]> = surfaces.iter().flat_map(|s| refined.welded_faces(*s)).collect();
            Self { flaps: flaps(&refined.flat, &faces), surfaces, faces }
        };
        surface_groups(layout).into_par_iter().map(flat).collect()
    }
}

/// A template on its way to a garment: topology, lines and factors, ready to be placed again and again.
pub(crate) struct Construction<'a> {
    layout: &'a Layout,
    /// The template's lines and those added for joints and free edges.
    lines: &'a [LayoutLine],
    refined: &'a Refined,
    groups: Vec<Group>,
    method: Method,
}

impl<'a> Construction<'a> {
    pub(crate) fn new(
        layout: &'a Layout,
        lines: &'a [LayoutLine],
        refined: &'a Refined,
        method: Method,
        flats: Vec<Flat>,
        mut earlier: Vec<Option<SparseFactor>>,
    ) -> Result<Self, TemplateError> {
        let holds = Holds::new(layout, lines, refined, &flats);
        earlier.resize_with(flats.len(), || None);
        // Groups are factored side by side: none needs another one for that.
        let group = |(g, (flat, earlier)): (usize, (Flat, Option<SparseFactor>))| {
            let hold = holds.of(g, &flat);
            let Flat { surfaces, flaps, .. } = flat;
            let plate = match method {
                Method::Plate => {
                    let plate = Plate::reusing(earlier, flaps, &hold, &refined.flat);
                    Some(plate.map_err(|e| fairing_error(layout, &surfaces, &e))?)
                }
                Method::Umbrella { .. } | Method::UmbrellaLimit => None,
            };
            Ok(Group { surfaces, hold, plate })
        };
        let groups = flats.into_par_iter().zip(earlier).enumerate().with_max_len(1).map(group);
        // Of several problems the first group's, on any number of threads.
        let groups: Vec<Result<Group, TemplateError>> = groups.collect();
        let groups = groups.into_iter().collect::<Result<_, _>>()?;
        Ok(Self { layout, lines, refined, groups, method })
    }

    /// The factors of all groups, for a construction of the same faces.
    pub(crate) fn into_factors(self) -> Vec<Option<SparseFactor>> {
        self.groups.into_iter().map(|g| g.plate.and_then(Plate::into_factor)).collect()
    }

    /// The positions of all welded nodes for given places of the template nodes and curves of the lines.
    pub(crate) fn positions(
        &self,
        template: &[DVec3],
        curves: &[Vec<Profile>],
    ) -> Result<Vec<DVec3>, TemplateError> {
        let mut out = self.refined.flat.clone();
        for (p, tag) in out.iter_mut().zip(&self.refined.welded_tags) {
            match tag {
                Tag::Template(n) => *p = template[*n as usize],
                Tag::Line { line, span, u } => *p = curves[*line as usize][*span as usize].place(*u),
                Tag::Inside => {}
            }
        }
        let targets = out.clone();
        for group in &self.groups {
            match self.method {
                Method::Plate => {
                    let Some(plate) = &group.plate else { continue };
                    let solved = plate.solve(&mut out, &targets);
                    solved.map_err(|e| fairing_error(self.layout, &group.surfaces, &e))?;
                }
                Method::Umbrella { steps } => self.iterate(group, &mut out, steps),
                Method::UmbrellaLimit => {
                    let umbrella = self.umbrella(group, self.refined.level_faces.len() - 1);
                    umbrella.limit(&mut out).map_err(|e| fairing_error(self.layout, &group.surfaces, &e))?;
                }
            }
        }
        if self.layout.symmetric {
            self.refined.symmetrise(&mut out);
        }
        Ok(out)
    }

    fn umbrella(&self, group: &Group, level: usize) -> Umbrella {
        let faces: Vec<[u32; 3]> =
            group.surfaces.iter().flat_map(|s| self.refined.faces_at(*s, level)).collect();
        let fixed: Vec<bool> = group.hold.iter().map(|h| *h == Hold::Fixed).collect();
        Umbrella::new(&faces, &fixed)
    }

    /// Level by level: new free nodes begin in the middle of their edge.
    fn iterate(&self, group: &Group, out: &mut [DVec3], steps: usize) {
        for level in 1..self.refined.level_faces.len() {
            for s in &group.surfaces {
                let (old, weld) = (self.refined.level_nodes[level - 1][*s], &self.refined.weld[*s]);
                let coarse = &self.refined.level_faces[level - 1][*s];
                for (f, corners) in coarse.iter().enumerate() {
                    // The middle child's corners are the midpoints of sides 0, 1, 2.
                    let middle = self.refined.level_faces[level][*s][4 * f + 3];
                    for (i, m) in middle.iter().enumerate() {
                        debug_assert!(*m as usize >= old);
                        let w = weld[*m as usize] as usize;
                        if group.hold[w] != Hold::Fixed {
                            let ends =
                                [corners[i], corners[(i + 1) % 3]].map(|v| out[weld[v as usize] as usize]);
                            out[w] = 0.5 * (ends[0] + ends[1]);
                        }
                    }
                }
            }
            self.umbrella(group, level).iterate(out, steps);
        }
    }

    /// The curves of all lines for given places of the template nodes.
    pub(crate) fn curves(
        &self,
        template: &[DVec3],
        features: &reference::Features,
    ) -> Result<Vec<Vec<Profile>>, TemplateError> {
        let on_centre = |n: u32| self.layout.mirrored && self.layout.nodes[n as usize].twin == Some(n);
        lines::resolve(self.lines, template, &on_centre, features)
    }
}

fn fairing_error(layout: &Layout, surfaces: &[usize], e: &crate::fairing::FactorError) -> TemplateError {
    let names: Vec<&str> = surfaces.iter().map(|s| layout.surfaces[*s].name.as_str()).collect();
    TemplateError::Fairing { what: names.join(", "), problem: e.to_string() }
}

/// The template's groups, overlapping ones united, and every other surface by itself.
fn surface_groups(layout: &Layout) -> Vec<Vec<usize>> {
    let mut groups: Vec<BTreeSet<usize>> = Vec::new();
    for group in &layout.groups {
        let mut set: BTreeSet<usize> = group.iter().map(|s| *s as usize).collect();
        groups.retain(|other| {
            let apart = other.is_disjoint(&set);
            if !apart {
                set.extend(other);
            }
            apart
        });
        groups.push(set);
    }
    let grouped: BTreeSet<usize> = groups.iter().flatten().copied().collect();
    let mut out: Vec<Vec<usize>> = groups.into_iter().map(|g| g.into_iter().collect()).collect();
    out.extend((0..layout.surfaces.len()).filter(|s| !grouped.contains(s)).map(|s| vec![s]));
    out
}

/// How welded nodes take part in the fairing of groups.
struct Holds<'a> {
    layout: &'a Layout,
    lines: &'a [LayoutLine],
    refined: &'a Refined,
    group_of: Vec<usize>,
    /// The first group of a node's surfaces moves it; for the later ones it stands.
    owner: Vec<usize>,
    /// Nodes in more than one group.
    shared: Vec<bool>,
    held_line: Vec<bool>,
    /// Template nodes on lines.
    on_line: Vec<bool>,
}

impl<'a> Holds<'a> {
    fn new(layout: &'a Layout, lines: &'a [LayoutLine], refined: &'a Refined, groups: &[Flat]) -> Self {
        let count = refined.flat.len();
        let mut group_of = vec![0usize; layout.surfaces.len()];
        for (g, group) in groups.iter().enumerate() {
            group.surfaces.iter().for_each(|s| group_of[*s] = g);
        }
        let mut owner = vec![usize::MAX; count];
        let mut shared = vec![false; count];
        for (s, weld) in refined.weld.iter().enumerate() {
            for w in weld {
                let o = &mut owner[*w as usize];
                shared[*w as usize] |= *o != usize::MAX && *o != group_of[s];
                *o = (*o).min(group_of[s]);
            }
        }
        let held_line = lines.iter().map(|l| l.hold.unwrap_or(l.shape.is_some())).collect();
        let mut on_line = vec![false; layout.nodes.len()];
        lines.iter().flat_map(|l| &l.nodes).for_each(|n| on_line[*n as usize] = true);
        Self { layout, lines, refined, group_of, owner, shared, held_line, on_line }
    }

    /// How each node takes part in the fairing of group `g`.
    fn of(&self, g: usize, group: &Flat) -> Vec<Hold> {
        let (layout, refined) = (self.layout, self.refined);
        let count = refined.flat.len();
        let mut hold = vec![Hold::Fixed; count];
        let rim = rim(count, &group.faces);
        let mut template_edge = vec![0.0f64; count];
        let mut template_ends = vec![0u32; count];
        for s in &group.surfaces {
            for f in refined.faces_at(*s, 0) {
                for i in 0..3 {
                    let (a, b) = (f[i] as usize, f[(i + 1) % 3] as usize);
                    let length = (refined.flat[a] - refined.flat[b]).length();
                    for v in [a, b] {
                        template_edge[v] += length;
                        template_ends[v] += 1;
                    }
                }
            }
        }
        for s in &group.surfaces {
            for (v, w) in refined.weld[*s].iter().enumerate() {
                let w = *w as usize;
                if self.owner[w] != g {
                    continue;
                }
                // On a free edge, or where only other groups go on: on the curve, unless that is free on purpose.
                let edge = rim[w];
                hold[w] = match refined.tags[*s][v] {
                    Tag::Template(n) => {
                        let spacing = template_edge[w] / f64::from(template_ends[w].max(1));
                        match layout.surfaces[*s].interior {
                            _ if edge || self.on_line[n as usize] || self.shared[w] => Hold::Fixed,
                            Interior::Pinned => Hold::Fixed,
                            Interior::Near => Hold::Drawn(NEAR / (spacing * spacing).max(1.0)),
                            Interior::Free => Hold::Free,
                        }
                    }
                    Tag::Line { line, .. } => {
                        let l = line as usize;
                        let free = if edge {
                            self.lines[l].hold == Some(false) && !self.shared[w]
                        } else {
                            !self.held_line[l]
                        };
                        if free { Hold::Free } else { Hold::Fixed }
                    }
                    Tag::Inside => Hold::Free,
                };
            }
        }
        // A joint with a single use in this group is a fixed curve (T5), also inside the surface.
        for joint in refined.body.joint_ids() {
            let all = refined.body.joint(joint).uses();
            let rank = |k: usize| refined.ids.iter().position(|id| *id == all[k].surface).unwrap_or(0);
            let mut inside = (0..all.len()).filter(|k| self.group_of[rank(*k)] == g);
            if let (Some(k), None) = (inside.next(), inside.next()) {
                for v in refined.body.joint_nodes(joint, k) {
                    hold[refined.weld[rank(k)][v as usize] as usize] = Hold::Fixed;
                }
            }
        }
        hold
    }
}

/// Nodes at edges with one face.
fn rim(count: usize, faces: &[[u32; 3]]) -> Vec<bool> {
    let mut sides: Vec<[u32; 2]> = Vec::with_capacity(3 * faces.len());
    for f in faces {
        for i in 0..3 {
            let (a, b) = (f[i], f[(i + 1) % 3]);
            sides.push([a.min(b), a.max(b)]);
        }
    }
    sides.sort_unstable();
    let mut out = vec![false; count];
    for same in sides.chunk_by(|a, b| a == b) {
        if same.len() == 1 {
            same[0].iter().for_each(|v| out[*v as usize] = true);
        }
    }
    out
}
