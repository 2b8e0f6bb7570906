//! What follows from the draft and its body: where nodes are, feature points, edges, joints, faces.

use std::collections::BTreeMap;
use std::sync::Arc;

use design::draft::{Draft, edges, faces, with_drawn_features};
use design::units::guess_of_model;
use glam::DVec3;
use mesh_kernel::TriMesh;
use mesh_kernel::query::RayCaster;
use reference::human::HumanBody;
use template::format::{At, NodeSpec};
use template::{Reference, node_frame, node_places};

use crate::jobs::{Body, Cloth};
use crate::selection::joints_of;

/// Distance from the skin at which new nodes are put, mm.
pub(crate) const OFF_SKIN: f64 = 12.0;

/// A feature point at which a node can be.
#[derive(Clone, Debug)]
pub(crate) struct Anchor {
    pub(crate) at: At,
    /// A name for a node there.
    pub(crate) name: String,
    pub(crate) place: DVec3,
    pub(crate) normal: DVec3,
    /// It lies on the plane of symmetry.
    pub(crate) is_centre: bool,
}

impl Anchor {
    /// A node there, off the skin.
    pub(crate) fn node(&self) -> NodeSpec {
        NodeSpec {
            at: Some(self.at.clone()),
            centre: self.is_centre,
            normal: OFF_SKIN,
            ..NodeSpec::default()
        }
    }
}

/// An edge as it is drawn and picked.
#[derive(Clone, Debug)]
pub(crate) struct Edge {
    pub(crate) ends: [String; 2],
    /// How many surfaces have it: 0 for a wire.
    pub(crate) surfaces: usize,
}

/// A face as it is picked.
#[derive(Clone, Debug)]
pub(crate) struct Face {
    pub(crate) surface: String,
    pub(crate) number: usize,
    pub(crate) nodes: Vec<String>,
}

/// Edges, faces and joints of the template as written; twins of a mirrored one are drawn and not picked.
#[derive(Clone, Debug, Default)]
pub(crate) struct Wireframe {
    pub(crate) edges: Vec<Edge>,
    /// Twins of edges that are written, with the number of surfaces.
    pub(crate) twins: Vec<Edge>,
    pub(crate) faces: Vec<Face>,
    /// Places along every joint.
    pub(crate) joints: Vec<Vec<DVec3>>,
    /// Surfaces of the garment by their first face.
    groups: Vec<(u32, String)>,
}

impl Wireframe {
    fn new(draft: &Draft, places: &BTreeMap<String, DVec3>) -> Self {
        let file = &draft.template;
        let counted = edges(file).into_iter().map(|(ends, surfaces)| Edge { ends, surfaces: surfaces.len() });
        let wires = draft.wires.iter().map(|ends| Edge { ends: ends.clone(), surfaces: 0 });
        let all: Vec<Edge> = counted.chain(wires).collect();
        let twin = |name: &String| match name.strip_prefix("left_") {
            Some(rest) => format!("right_{rest}"),
            None if file.nodes.get(name).is_some_and(|n| n.mirror) => format!("right_{name}"),
            None => name.clone(),
        };
        let twins = if file.mirrored {
            let mirrored =
                all.iter().map(|e| Edge { ends: [twin(&e.ends[0]), twin(&e.ends[1])], ..e.clone() });
            let known = |e: &Edge| e.ends.iter().all(|n| places.contains_key(n));
            mirrored.zip(&all).filter(|(t, e)| t.ends != e.ends && known(t)).map(|(t, _)| t).collect()
        } else {
            Vec::new()
        };
        let of_surface = |(surface, spec): (&String, _)| {
            let surface = surface.clone();
            faces(spec).into_iter().enumerate().map(move |(number, nodes)| Face {
                surface: surface.clone(),
                number,
                nodes,
            })
        };
        let all_joints = joints_of(draft);
        let joints = all_joints.iter().map(|joint| {
            let mut points: Vec<DVec3> = joint.nodes.iter().filter_map(|n| places.get(n).copied()).collect();
            if joint.closed {
                points.extend(points.first().copied());
            }
            points
        });
        Self {
            edges: all,
            twins,
            faces: file.surfaces.iter().flat_map(of_surface).collect(),
            joints: joints.collect(),
            groups: Vec::new(),
        }
    }

    /// The written surface of a face of the garment.
    pub(crate) fn surface_of(&self, face: u32) -> Option<&str> {
        let after = self.groups.partition_point(|(first, _)| *first <= face);
        self.groups[..after].last().map(|(_, name)| name.as_str())
    }
}

/// A mesh that is no body: to be looked at, and nothing else.
pub(crate) struct SeenMesh {
    /// In millimetres, as far as its size tells.
    pub(crate) mesh: TriMesh,
    pub(crate) caster: Arc<RayCaster>,
}

impl SeenMesh {
    pub(crate) fn new(mut mesh: TriMesh) -> Self {
        let unit = guess_of_model(&mesh);
        mesh.positions.iter_mut().for_each(|p| *p *= unit);
        let caster = Arc::new(RayCaster::new(&mesh));
        Self { mesh, caster }
    }
}

/// Everything that follows from a draft.
#[derive(Default)]
pub(crate) struct Model {
    pub(crate) body: Option<Arc<Body>>,
    /// What is seen while there is no body.
    pub(crate) seen: Option<SeenMesh>,
    pub(crate) cloth: Option<Arc<Cloth>>,
    pub(crate) places: BTreeMap<String, DVec3>,
    pub(crate) anchors: Vec<Anchor>,
    pub(crate) wires: Wireframe,
    /// The body with the curves drawn on it, where there are any.
    drawn: Option<HumanBody>,
}

impl Model {
    /// The body with all its features.
    pub(crate) fn human(&self) -> Option<&HumanBody> {
        self.drawn.as_ref().or(self.body.as_ref().map(|b| &b.on.body))
    }

    /// Follows the draft. Says why nodes cannot be placed; those that could be before stay where they were.
    pub(crate) fn follow(&mut self, draft: &Draft) -> Result<(), String> {
        let Some(body) = self.body.clone() else { return Ok(()) };
        self.drawn = (!draft.features.is_empty()).then(|| with_drawn_features(draft, &body.on));
        let human = self.drawn.as_ref().unwrap_or(&body.on.body);
        let reference = Reference { mesh: &human.mesh, features: &human.features };
        let placed = node_places(&draft.template, &reference, &body.on.prepared);
        let result = placed.map(|places| self.places = places).map_err(|e| e.to_string());
        self.places.retain(|name, _| draft.template.nodes.contains_key(name) || name.starts_with("right_"));
        self.wires = Wireframe::new(draft, &self.places);
        self.name_groups(draft);
        result
    }

    /// The body changed, or curves on it.
    pub(crate) fn find_anchors(&mut self, draft: &Draft) {
        self.anchors = self.human().map(|human| anchors(human, draft.template.mirrored)).unwrap_or_default();
    }

    /// Which written surface every run of the garment's faces is.
    fn name_groups(&mut self, draft: &Draft) {
        let Some(cloth) = &self.cloth else { return };
        let written = |name: &str| {
            let known = &draft.template.surfaces;
            let twin = name.strip_prefix("right_");
            let left = twin.map(|rest| format!("left_{rest}")).filter(|n| known.contains_key(n));
            let own = twin.filter(|rest| known.contains_key(*rest)).map(str::to_owned);
            if known.contains_key(name) {
                name.to_owned()
            } else {
                left.or(own).unwrap_or_else(|| name.to_owned())
            }
        };
        self.wires.groups = cloth.mesh.groups.iter().map(|g| (g.faces.start, written(&g.name))).collect();
        self.wires.groups.sort();
    }

    /// The frame that a node's offsets are counted in.
    pub(crate) fn frame(&self, draft: &Draft, node: &str) -> Result<reference::Frame, String> {
        let (Some(body), Some(human)) = (&self.body, self.human()) else {
            return Err("the body is not ready yet".to_owned());
        };
        let reference = Reference { mesh: &human.mesh, features: &human.features };
        node_frame(&draft.template, node, &reference, &body.on.prepared).map_err(|e| e.to_string())
    }
}

/// Crossings of level curves with lines down the body, of drawn curves with all others, and feature points. In a mirrored
/// template the left half is written, and the right one follows.
fn anchors(human: &HumanBody, mirrored: bool) -> Vec<Anchor> {
    let features = &human.features;
    let is_level = |name: &str| name.ends_with("_tape");
    let mut out = Vec::new();
    for (level, _) in features.curves.iter().filter(|(n, c)| c.closed && (is_level(n) || is_drawn(n))) {
        for (line, curve) in &features.curves {
            if line == level || curve.closed && !(is_drawn(line) && line > level) {
                continue;
            }
            let Some(frame) = features.crossing(level, line) else { continue };
            out.push(Anchor {
                at: At::Crossing([level.clone(), line.clone()]),
                name: format!("{line}_{}", level.trim_end_matches("_tape")),
                place: frame.origin,
                normal: frame.normal,
                is_centre: line.starts_with("centre"),
            });
        }
    }
    for (name, point) in &features.points {
        out.push(Anchor {
            at: At::Point(name.clone()),
            name: format!("{name}_node"),
            place: point.position,
            normal: point.normal,
            is_centre: point.position.x.abs() < 1.0,
        });
    }
    if mirrored {
        out.retain(|a| !a.name.starts_with("right_"));
    }
    out
}

/// Curves that a person drew are named like this.
pub(crate) fn is_drawn(name: &str) -> bool {
    name.starts_with(DRAWN)
}

/// Begins the names of drawn curves.
pub(crate) const DRAWN: &str = "drawn_";
