//! The split body and what every node of it stands for: a template node, a place on a line, or neither; which nodes are one
//! over joints; which are each other's mirror images.

use std::collections::BTreeMap;

use glam::DVec3;
use mesh_kernel::body::{Body, JointSpec, SurfaceId, SurfaceSpec};

use crate::complex::Patch;
use crate::error::TemplateError;
use crate::layout::{Layout, LayoutLine};

/// What a node of a split surface stands for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Tag {
    /// A template node.
    Template(u32),
    /// A place on a line: at share `u` of the arc length of a span.
    Line { line: u32, span: u32, u: f64 },
    /// On no line.
    Inside,
}

/// No node.
pub(crate) const NONE: u32 = u32::MAX;

/// A template split `levels` times, flat: new nodes lie in the template's triangles.
pub(crate) struct Refined {
    pub(crate) body: Body,
    pub(crate) ids: Vec<SurfaceId>,
    /// By surface and node.
    pub(crate) tags: Vec<Vec<Tag>>,
    /// Number of each surface's node in the welded garment.
    pub(crate) weld: Vec<Vec<u32>>,
    /// Flat position by welded node.
    pub(crate) flat: Vec<DVec3>,
    /// Tag by welded node.
    pub(crate) welded_tags: Vec<Tag>,
    /// Mirror image by welded node; [`NONE`] where there is none.
    pub(crate) twins: Vec<u32>,
    /// Faces of each surface at each level from 0 on, over local nodes; a level's nodes come first at the next.
    pub(crate) level_faces: Vec<Vec<Vec<[u32; 3]>>>,
    /// Node counts of each surface at each level.
    pub(crate) level_nodes: Vec<Vec<usize>>,
    /// The line of each edge of each surface at the finest level.
    pub(crate) edge_lines: Vec<Vec<Option<OnLine>>>,
    /// The lines of each surface's edges at all levels, by their nodes, the smaller first.
    pub(crate) line_edges: Vec<BTreeMap<[u32; 2], OnLine>>,
}

/// An edge's part of a line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OnLine {
    pub(crate) line: u32,
    pub(crate) span: u32,
    /// Arc-length shares at the edge's first and second node.
    pub(crate) ends: [f64; 2],
}

impl Refined {
    pub(crate) fn new(
        layout: &Layout,
        lines: &[LayoutLine],
        patches: &[Patch],
        joints: &[JointSpec],
        positions: &[DVec3],
        levels: u8,
    ) -> Result<Self, TemplateError> {
        let specs: Vec<SurfaceSpec> = layout
            .surfaces
            .iter()
            .zip(patches)
            .map(|(surface, patch)| SurfaceSpec {
                name: surface.name.clone(),
                positions: patch.nodes.iter().map(|n| positions[*n as usize]).collect(),
                faces: patch.faces.clone(),
            })
            .collect();
        let mut body = Body::build(&specs, joints).map_err(|e| TemplateError::Kernel(e.to_string()))?;
        let ids: Vec<SurfaceId> = body.surface_ids().collect();
        let mut tags: Vec<Vec<Tag>> =
            patches.iter().map(|p| p.nodes.iter().map(|n| Tag::Template(*n)).collect()).collect();
        let mut on_line = edges_on_lines(&body, &ids, patches, lines)?;
        let mut images = Images::new(layout, patches, &body, &ids);
        let mut level_faces =
            vec![ids.iter().map(|id| body.surface(*id).faces().to_vec()).collect::<Vec<_>>()];
        let mut level_nodes = vec![patches.iter().map(|p| p.nodes.len()).collect::<Vec<_>>()];
        let mut line_edges: Vec<BTreeMap<[u32; 2], OnLine>> = vec![BTreeMap::new(); ids.len()];
        list_lines(&body, &ids, &on_line, &mut line_edges);
        for _ in 0..levels {
            images.split(&body, &ids);
            let old: Vec<Vec<[u32; 2]>> = ids.iter().map(|id| body.surface(*id).edges().to_vec()).collect();
            body.split_all(None).map_err(|e| TemplateError::Kernel(e.to_string()))?;
            for (s, id) in ids.iter().enumerate() {
                let edges = body.surface(*id).edges();
                let mut next: Vec<Option<OnLine>> = vec![None; edges.len()];
                for (e, line) in on_line[s].iter().enumerate() {
                    let Some(on) = line else {
                        tags[s].push(Tag::Inside);
                        continue;
                    };
                    let u = 0.5 * (on.ends[0] + on.ends[1]);
                    tags[s].push(Tag::Line { line: on.line, span: on.span, u });
                    for (child, outer) in [(2 * e, 0), (2 * e + 1, 1)] {
                        let forth = edges[child][0] == old[s][e][outer];
                        let ends = if forth { [on.ends[outer], u] } else { [u, on.ends[outer]] };
                        next[child] = Some(OnLine { ends, ..*on });
                    }
                }
                on_line[s] = next;
            }
            list_lines(&body, &ids, &on_line, &mut line_edges);
            level_faces.push(ids.iter().map(|id| body.surface(*id).faces().to_vec()).collect());
            level_nodes.push(ids.iter().map(|id| body.surface(*id).positions().len()).collect());
        }
        let (weld, count) = weld(&body, &ids, &tags);
        let mut flat = vec![DVec3::ZERO; count];
        let mut welded_tags = vec![Tag::Inside; count];
        let mut twins = vec![NONE; count];
        for (s, id) in ids.iter().enumerate() {
            for (v, p) in body.surface(*id).positions().iter().enumerate() {
                let w = weld[s][v] as usize;
                flat[w] = *p;
                // Of a node's tags over its surfaces, those that say something win.
                if welded_tags[w] == Tag::Inside {
                    welded_tags[w] = tags[s][v];
                }
                if let Some((t, image)) = images.of(s, v) {
                    twins[w] = weld[t][image as usize];
                }
            }
        }
        // A twin that is not mutual (surfaces whose halves are cut differently) is none.
        for w in 0..count {
            if twins[w] != NONE && twins[twins[w] as usize] != w as u32 {
                twins[w] = NONE;
            }
        }
        Ok(Self {
            body,
            ids,
            tags,
            weld,
            flat,
            welded_tags,
            twins,
            level_faces,
            level_nodes,
            edge_lines: on_line,
            line_edges,
        })
    }

    /// The line of an edge of a surface at any level, with the edge's nodes in the order given.
    pub(crate) fn line_of(&self, surface: usize, [a, b]: [u32; 2]) -> Option<OnLine> {
        let on = self.line_edges[surface].get(&[a.min(b), a.max(b)])?;
        let [first, second] = on.ends;
        Some(OnLine { ends: if a < b { [first, second] } else { [second, first] }, ..*on })
    }

    /// Faces of a surface over welded nodes, at the finest level.
    pub(crate) fn welded_faces(&self, surface: usize) -> Vec<[u32; 3]> {
        self.faces_at(surface, self.level_faces.len() - 1)
    }

    /// Faces of a surface over welded nodes at a level.
    pub(crate) fn faces_at(&self, surface: usize, level: usize) -> Vec<[u32; 3]> {
        let weld = &self.weld[surface];
        self.level_faces[level][surface].iter().map(|f| f.map(|v| weld[v as usize])).collect()
    }

    /// Makes positions of twins each other's mirror images, to the bit.
    pub(crate) fn symmetrise(&self, positions: &mut [DVec3]) {
        let mirror = |p: DVec3| DVec3::new(-p.x, p.y, p.z);
        for w in 0..positions.len() {
            let t = self.twins[w];
            if t == w as u32 {
                positions[w].x = 0.0;
            } else if t != NONE && w < t as usize {
                let mean = 0.5 * (positions[w] + mirror(positions[t as usize]));
                positions[w] = mean;
                positions[t as usize] = mirror(mean);
            }
        }
    }
}

/// Adds the edges that lie on lines to lists by nodes.
fn list_lines(
    body: &Body,
    ids: &[SurfaceId],
    on_line: &[Vec<Option<OnLine>>],
    out: &mut [BTreeMap<[u32; 2], OnLine>],
) {
    for ((id, on_line), out) in ids.iter().zip(on_line).zip(out) {
        for (&[a, b], on) in body.surface(*id).edges().iter().zip(on_line) {
            if let Some(on) = on {
                let ends = if a < b { on.ends } else { [on.ends[1], on.ends[0]] };
                out.insert([a.min(b), a.max(b)], OnLine { ends, ..*on });
            }
        }
    }
}

/// For each surface and edge the line it lies on.
fn edges_on_lines(
    body: &Body,
    ids: &[SurfaceId],
    patches: &[Patch],
    lines: &[LayoutLine],
) -> Result<Vec<Vec<Option<OnLine>>>, TemplateError> {
    let mut spans: BTreeMap<[u32; 2], (u32, u32, bool)> = BTreeMap::new();
    for (l, line) in lines.iter().enumerate() {
        let n = line.nodes.len();
        for s in 0..n - usize::from(!line.closed) {
            let (a, b) = (line.nodes[s], line.nodes[(s + 1) % n]);
            if let Some((other, ..)) = spans.insert([a.min(b), a.max(b)], (l as u32, s as u32, a < b)) {
                let message = format!(
                    "shares a template edge with the line `{}`; let one end where the other begins",
                    line.name
                );
                return Err(TemplateError::format(format!("lines.{}", lines[other as usize].name), message));
            }
        }
    }
    let mut out = Vec::with_capacity(ids.len());
    for (id, patch) in ids.iter().zip(patches) {
        let edges = body.surface(*id).edges().iter().map(|[a, b]| {
            let (a, b) = (patch.nodes[*a as usize], patch.nodes[*b as usize]);
            let (line, span, forth) = *spans.get(&[a.min(b), a.max(b)])?;
            let ends = if (a < b) == forth { [0.0, 1.0] } else { [1.0, 0.0] };
            Some(OnLine { line, span, ends })
        });
        out.push(edges.collect());
    }
    Ok(out)
}

/// Numbers nodes that are one over joints, or the same template node, alike: in order of first appearance.
fn weld(body: &Body, ids: &[SurfaceId], tags: &[Vec<Tag>]) -> (Vec<Vec<u32>>, usize) {
    let mut offsets = vec![0usize];
    for t in tags {
        offsets.push(offsets[offsets.len() - 1] + t.len());
    }
    let mut parent: Vec<u32> = (0..offsets[tags.len()] as u32).collect();
    fn root(parent: &mut [u32], mut i: u32) -> u32 {
        while parent[i as usize] != i {
            parent[i as usize] = parent[parent[i as usize] as usize];
            i = parent[i as usize];
        }
        i
    }
    let mut join = |a: usize, b: usize| {
        let (a, b) = (root(&mut parent, a as u32), root(&mut parent, b as u32));
        parent[a.max(b) as usize] = a.min(b);
    };
    let mut first: BTreeMap<u32, usize> = BTreeMap::new();
    for (s, list) in tags.iter().enumerate() {
        for (v, tag) in list.iter().enumerate() {
            let Tag::Template(n) = tag else { continue };
            let at = offsets[s] + v;
            match first.get(n) {
                Some(other) => join(*other, at),
                None => {
                    first.insert(*n, at);
                }
            }
        }
    }
    for joint in body.joint_ids() {
        let uses = body.joint(joint).uses();
        let rank = |k: usize| ids.iter().position(|id| *id == uses[k].surface).unwrap_or(0);
        let base = body.joint_nodes(joint, 0);
        for k in 1..uses.len() {
            for (a, b) in base.iter().zip(body.joint_nodes(joint, k)) {
                join(offsets[rank(0)] + *a as usize, offsets[rank(k)] + b as usize);
            }
        }
    }
    let mut number = vec![NONE; parent.len()];
    let mut count = 0u32;
    let mut out = Vec::with_capacity(tags.len());
    for (s, list) in tags.iter().enumerate() {
        let mut own = Vec::with_capacity(list.len());
        for v in 0..list.len() {
            let r = root(&mut parent, (offsets[s] + v) as u32) as usize;
            if number[r] == NONE {
                number[r] = count;
                count += 1;
            }
            own.push(number[r]);
        }
        out.push(own);
    }
    (out, count as usize)
}

/// Mirror images of faces and nodes, carried through splits.
struct Images {
    /// For each surface, the surface that is its image.
    surface: Vec<Option<usize>>,
    /// For each face, the face that is its image (NONE: none).
    faces: Vec<Vec<u32>>,
    nodes: Vec<Vec<u32>>,
}

impl Images {
    fn new(layout: &Layout, patches: &[Patch], body: &Body, ids: &[SurfaceId]) -> Self {
        let surface: Vec<Option<usize>> =
            layout.surfaces.iter().map(|s| s.twin.map(|t| t as usize)).collect();
        let sorted = |mut t: [u32; 3]| {
            t.sort_unstable();
            t
        };
        let corners = |s: usize, f: &[u32; 3]| f.map(|v| patches[s].nodes[v as usize]);
        let index: Vec<BTreeMap<[u32; 3], u32>> = (0..ids.len())
            .map(|s| {
                let faces = body.surface(ids[s]).faces().iter().enumerate();
                faces.map(|(i, f)| (sorted(corners(s, f)), i as u32)).collect()
            })
            .collect();
        let (mut faces, mut nodes) = (Vec::new(), Vec::new());
        for s in 0..ids.len() {
            let own = body.surface(ids[s]).faces();
            let mut face_images = vec![NONE; own.len()];
            let mut node_images = vec![NONE; patches[s].nodes.len()];
            for (i, f) in own.iter().enumerate() {
                let twin = corners(s, f).map(|n| layout.nodes[n as usize].twin.unwrap_or(NONE));
                let Some(t) = surface[s] else { continue };
                let Some(image) = index[t].get(&sorted(twin)) else { continue };
                face_images[i] = *image;
                for g in body.surface(ids[t]).faces()[*image as usize] {
                    let k = twin.iter().position(|n| *n == patches[t].nodes[g as usize]);
                    if let Some(k) = k {
                        node_images[f[k] as usize] = g;
                    }
                }
            }
            faces.push(face_images);
            nodes.push(node_images);
        }
        Self { surface, faces, nodes }
    }

    /// Follows a split of everything; `body` is as before it.
    fn split(&mut self, body: &Body, ids: &[SurfaceId]) {
        let (mut faces, mut nodes) = (Vec::new(), self.nodes.clone());
        for (s, id) in ids.iter().enumerate() {
            let own = body.surface(*id);
            nodes[s].resize(own.positions().len() + own.edges().len(), NONE);
            let mut children = vec![NONE; 4 * own.faces().len()];
            let Some(t) = self.surface[s] else {
                faces.push(children);
                continue;
            };
            let other = body.surface(ids[t]);
            let image = |v: u32| self.nodes[s][v as usize];
            for (f, corners) in own.faces().iter().enumerate() {
                let g = self.faces[s][f];
                if g == NONE {
                    continue;
                }
                let there = other.faces()[g as usize];
                children[4 * f + 3] = 4 * g + 3;
                for (i, v) in corners.iter().enumerate() {
                    if let Some(k) = there.iter().position(|w| *w == image(*v)) {
                        children[4 * f + i] = 4 * g + k as u32;
                    }
                }
                for e in own.face_edges()[f] {
                    let [a, b] = own.edges()[e as usize].map(image);
                    let found = other.face_edges()[g as usize].into_iter().find(|h| {
                        let [c, d] = other.edges()[*h as usize];
                        (a, b) == (c, d) || (a, b) == (d, c)
                    });
                    if let Some(h) = found {
                        nodes[s][own.positions().len() + e as usize] = other.positions().len() as u32 + h;
                    }
                }
            }
            faces.push(children);
        }
        (self.faces, self.nodes) = (faces, nodes);
    }

    fn of(&self, surface: usize, node: usize) -> Option<(usize, u32)> {
        let image = self.nodes[surface][node];
        self.surface[surface].filter(|_| image != NONE).map(|t| (t, image))
    }
}
