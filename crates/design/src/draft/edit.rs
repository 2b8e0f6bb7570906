//! Edits: the only way to change a draft.

use std::sync::Arc;

use serde::{Deserialize, Serialize};
use sketch::Drawing;
use template::Template;
use template::format::{
    EaseSpec, JointSpec, LineSpec, NodeSpec, PieceSpec, ProfileShape, Shape, SurfaceSpec,
};

use super::rename::{Named, rename};
use super::seams::{make_joint, split_joint};
use super::topology::{edges, faces, pair, sides};
use super::{BodySource, Draft, DrawnFeature, EditError, set_measure};

/// One change of a draft.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "edit", rename_all = "snake_case", deny_unknown_fields)]
#[allow(missing_docs, reason = "fields are named by what they hold; every edit is described")]
pub enum Edit {
    /// A new node.
    CreateNode { name: String, node: NodeSpec },
    /// A node somewhere else, or with other wishes.
    MoveNode { name: String, node: NodeSpec },
    /// A node goes, with the wires at it. Refused where faces, lines, joints or other nodes need it.
    DeleteNode { name: String },
    /// A wire between two nodes.
    CreateEdge { from: String, to: String },
    /// A wire goes. An edge of a face goes with its face.
    DeleteEdge { from: String, to: String },
    /// A face of three or four nodes; the surface is made when it is new. Wires along it become its edges.
    FillFace { surface: String, nodes: Vec<String> },
    /// A face goes; its edges stay as wires. A surface without faces goes with its last.
    DeleteFace { surface: String, face: usize },
    /// A face goes over to another surface, which is made when it is new.
    AssignSurface { surface: String, face: usize, to: String },
    /// A surface goes with all that is said of it.
    DeleteSurface { surface: String },
    /// A joint is made, cut out of those that hold its edges; all others are made explicit first.
    MakeJoint { joint: JointSpec },
    /// A joint becomes two; the first takes the surfaces named. Joints are numbered as listed, or as they make themselves.
    SplitJoint { joint: usize, first: Vec<String> },
    /// Joints make themselves again.
    AutomaticJoints,
    /// A profile on an edge; a line that is there already on this edge is drawn again.
    DrawProfile { name: String, nodes: [String; 2], points: Vec<[f64; 3]> },
    /// A line of a chain of edges.
    SetLine { name: String, line: LineSpec },
    /// A line or profile goes.
    DeleteProfile { name: String },
    /// A feature curve drawn on the body.
    DrawFeature { name: String, feature: DrawnFeature },
    /// A drawn feature goes.
    DeleteFeature { name: String },
    /// A wanted girth (mm over the body's), or none.
    SetEase { level: String, ease: Option<EaseSpec> },
    /// How a surface becomes a piece.
    EditPiece { surface: String, piece: PieceSpec },
    /// Another name; everything that refers to it follows.
    Rename { kind: Named, from: String, to: String },
    /// A listed joint gets a name, or none.
    NameJoint { joint: usize, name: Option<String> },
    /// Groups of surfaces that are smooth across their joints.
    SetFairAcross { groups: Vec<Vec<String>> },
    /// Name, clearance, level, symmetry.
    SetTemplate { name: String, clearance: f64, level: u8, mirrored: bool },
    /// Another body.
    SwitchBody {
        #[serde(with = "super::shared")]
        body: Arc<BodySource>,
    },
    /// A measurement of the form, cm; none: derived.
    SetMeasure { name: String, value: Option<f64> },
    /// The drawing in the plane becomes another; `label` says by what.
    Draw { label: String, drawing: Drawing },
    /// Edits that are one to a person: a stroke over several edges. All of them or none.
    Together { label: String, edits: Vec<Edit> },
}

impl Edit {
    /// What it does, in words for menus and history.
    pub fn label(&self) -> String {
        match self {
            Self::CreateNode { name, .. } => format!("create node {name}"),
            Self::MoveNode { name, .. } => format!("move node {name}"),
            Self::DeleteNode { name } => format!("delete node {name}"),
            Self::CreateEdge { from, to } => format!("connect {from} – {to}"),
            Self::DeleteEdge { from, to } => format!("delete edge {from} – {to}"),
            Self::FillFace { surface, .. } => format!("fill face of {surface}"),
            Self::DeleteFace { surface, .. } => format!("delete face of {surface}"),
            Self::AssignSurface { to, .. } => format!("assign face to {to}"),
            Self::DeleteSurface { surface } => format!("delete surface {surface}"),
            Self::MakeJoint { .. } => "make joint".to_owned(),
            Self::SplitJoint { .. } => "split joint".to_owned(),
            Self::AutomaticJoints => "automatic joints".to_owned(),
            Self::DrawProfile { name, .. } => format!("draw profile {name}"),
            Self::SetLine { name, .. } => format!("set line {name}"),
            Self::DeleteProfile { name } => format!("delete profile {name}"),
            Self::DrawFeature { name, .. } => format!("draw feature {name}"),
            Self::DeleteFeature { name } => format!("delete feature {name}"),
            Self::SetEase { level, .. } => format!("set ease {level}"),
            Self::EditPiece { surface, .. } => format!("edit piece {surface}"),
            Self::Rename { from, to, .. } => format!("rename {from} to {to}"),
            Self::NameJoint { .. } => "name joint".to_owned(),
            Self::SetFairAcross { .. } => "set smooth joints".to_owned(),
            Self::SetTemplate { .. } => "set template".to_owned(),
            Self::SwitchBody { .. } => "switch body".to_owned(),
            Self::SetMeasure { name, .. } => format!("set {}", name.replace('_', " ")),
            Self::Draw { label, .. } | Self::Together { label, .. } => label.clone(),
        }
    }

    /// Whether after `self` nothing is left of `earlier`: both give the same thing a value.
    pub(super) fn overrides(&self, earlier: &Self) -> bool {
        match (self, earlier) {
            (Self::MoveNode { name, .. }, Self::MoveNode { name: old, .. })
            | (Self::SetMeasure { name, .. }, Self::SetMeasure { name: old, .. }) => name == old,
            (Self::SetEase { level, ease: Some(_) }, Self::SetEase { level: old, ease: Some(_) }) => {
                level == old
            }
            (Self::EditPiece { surface, .. }, Self::EditPiece { surface: old, .. }) => surface == old,
            (Self::SetTemplate { .. }, Self::SetTemplate { .. }) | (Self::Draw { .. }, Self::Draw { .. }) => {
                true
            }
            _ => false,
        }
    }

    /// The draft after this edit.
    ///
    /// # Errors
    /// [`EditError`]: why it does not fit; `draft` is as it was in any case.
    pub fn apply(&self, draft: &Draft) -> Result<Draft, EditError> {
        let mut new = draft.clone();
        self.change(&mut new)?;
        Template::check_incomplete(&new.template)?;
        Ok(new)
    }

    fn change(&self, draft: &mut Draft) -> Result<(), EditError> {
        let file = &mut draft.template;
        match self {
            Self::CreateNode { name, node } => {
                if file.nodes.insert(name.clone(), node.clone()).is_some() {
                    return Err(taken("node", name));
                }
            }
            Self::MoveNode { name, node } => {
                *file.nodes.get_mut(name).ok_or_else(|| missing("node", name))? = node.clone();
            }
            Self::DeleteNode { name } => {
                file.nodes.remove(name).ok_or_else(|| missing("node", name))?;
                if let Some(by) = user_of(draft, name) {
                    return Err(EditError::Used { kind: "node", name: name.clone(), by });
                }
                draft.wires.retain(|ends| !ends.contains(name));
            }
            Self::CreateEdge { from, to } => {
                known(draft, [from, to])?;
                let refused = |why| EditError::Edge { from: from.clone(), to: to.clone(), why };
                if from == to {
                    return Err(refused("both ends are one node"));
                }
                let edge = pair(from, to);
                if edges(&draft.template).contains_key(&edge) || !draft.wires.insert(edge) {
                    return Err(refused("it is there already"));
                }
            }
            Self::DeleteEdge { from, to } => {
                if !draft.wires.remove(&pair(from, to)) {
                    let why = if edges(&draft.template).contains_key(&pair(from, to)) {
                        "faces have it; delete those"
                    } else {
                        "there is none"
                    };
                    return Err(EditError::Edge { from: from.clone(), to: to.clone(), why });
                }
            }
            Self::FillFace { surface, nodes } => fill(draft, surface, nodes)?,
            Self::DeleteFace { surface, face } => {
                let nodes = take_face(draft, surface, *face)?;
                let have = edges(&draft.template);
                draft.wires.extend(sides(&nodes).filter(|side| !have.contains_key(side)));
            }
            Self::AssignSurface { surface, face, to } => {
                let nodes = take_face(draft, surface, *face)?;
                fill(draft, to, &nodes)?;
            }
            Self::DeleteSurface { surface } => {
                file.surfaces.remove(surface).ok_or_else(|| missing("surface", surface))?;
                forget_surface(draft, surface);
            }
            Self::MakeJoint { joint } => make_joint(draft, joint)?,
            Self::SplitJoint { joint, first } => split_joint(draft, *joint, first)?,
            Self::AutomaticJoints => file.joints = None,
            Self::DrawProfile { name, nodes, points } => draw_profile(draft, name, nodes, points)?,
            Self::SetLine { name, line } => {
                file.lines.insert(name.clone(), line.clone());
            }
            Self::DeleteProfile { name } => {
                file.lines.remove(name).ok_or_else(|| missing("line", name))?;
            }
            Self::DrawFeature { name, feature } => {
                let bad = feature.points.len() < 2 || feature.points.iter().flatten().any(|v| !v.is_finite());
                if bad {
                    let why = "a feature curve needs two finite points at least".to_owned();
                    return Err(EditError::Value { what: name.clone(), why });
                }
                draft.features.insert(name.clone(), feature.clone());
            }
            Self::DeleteFeature { name } => {
                draft.features.remove(name).ok_or_else(|| missing("drawn feature", name))?;
            }
            Self::SetEase { level, ease: Some(ease) } => {
                file.ease.insert(level.clone(), ease.clone());
            }
            Self::SetEase { level, ease: None } => {
                file.ease.remove(level).ok_or_else(|| missing("ease level", level))?;
            }
            Self::EditPiece { surface, piece } => {
                file.pieces.insert(surface.clone(), piece.clone());
            }
            Self::Rename { kind, from, to } => rename(draft, *kind, from, to)?,
            Self::NameJoint { joint, name } => {
                let joints = file.joints.as_mut().ok_or_else(|| EditError::Value {
                    what: "the name of a joint".to_owned(),
                    why: "joints that make themselves are named after their surfaces".to_owned(),
                })?;
                let number = || missing("joint", &(joint + 1).to_string());
                joints.get_mut(*joint).ok_or_else(number)?.name = name.clone();
            }
            Self::SetFairAcross { groups } => file.fair_across = groups.clone(),
            Self::SetTemplate { name, clearance, level, mirrored } => {
                file.name = name.clone();
                file.clearance = *clearance;
                file.level = *level;
                file.mirrored = *mirrored;
            }
            Self::SwitchBody { body } => {
                body.check()?;
                draft.body = Arc::clone(body);
            }
            Self::SetMeasure { name, value } => {
                let BodySource::Form(mut m) = (*draft.body).clone() else {
                    let why = "the body is a mesh; choose a dress form to change measurements".to_owned();
                    return Err(EditError::Value { what: name.clone(), why });
                };
                set_measure(&mut m, name, *value)?;
                draft.body = Arc::new(BodySource::Form(m));
            }
            Self::Draw { drawing, .. } => draft.drawing = drawing.clone(),
            Self::Together { edits, .. } => {
                for edit in edits {
                    edit.change(draft)?;
                }
            }
        }
        Ok(())
    }
}

pub(super) fn missing(kind: &'static str, name: &str) -> EditError {
    EditError::Missing { kind, name: name.to_owned() }
}

fn taken(kind: &'static str, name: &str) -> EditError {
    EditError::Taken { kind, name: name.to_owned() }
}

/// Whether nodes are written or are twins of written ones.
fn known<'a>(draft: &Draft, names: impl IntoIterator<Item = &'a String>) -> Result<(), EditError> {
    for name in names {
        let nodes = &draft.template.nodes;
        let twin = name.strip_prefix("right_").filter(|_| draft.template.mirrored);
        let twin = twin.is_some_and(|rest| {
            nodes.contains_key(&format!("left_{rest}")) || nodes.get(rest).is_some_and(|n| n.mirror)
        });
        if !nodes.contains_key(name) && !twin {
            return Err(missing("node", name));
        }
    }
    Ok(())
}

/// What needs a node, in words.
fn user_of(draft: &Draft, node: &str) -> Option<String> {
    let file = &draft.template;
    let named = |list: &[String]| list.iter().any(|n| n == node);
    let surface = file.surfaces.iter().find(|(_, s)| faces(s).iter().any(|f| named(f)));
    let line = file.lines.iter().find(|(_, l)| named(&l.through));
    let other = file.nodes.iter().find(|(_, n)| n.between.as_ref().is_some_and(|b| named(b)));
    let joint = file.joints.iter().flatten().position(|j| named(&j.nodes));
    surface
        .map(|(n, _)| format!("the surface `{n}`"))
        .or_else(|| line.map(|(n, _)| format!("the line `{n}`")))
        .or_else(|| other.map(|(n, _)| format!("the node `{n}`")))
        .or_else(|| joint.map(|j| format!("joint {j}")))
}

fn fill(draft: &mut Draft, surface: &str, nodes: &[String]) -> Result<(), EditError> {
    let refused = |why: String| EditError::Face { nodes: nodes.join(", "), why };
    let mut distinct = nodes.to_vec();
    distinct.sort_unstable();
    distinct.dedup();
    if !(3..=4).contains(&nodes.len()) || distinct.len() != nodes.len() {
        return Err(refused("it needs three or four different nodes".to_owned()));
    }
    known(draft, nodes)?;
    let spec = draft
        .template
        .surfaces
        .entry(surface.to_owned())
        .or_insert_with(|| SurfaceSpec { faces: Some(Vec::new()), ..SurfaceSpec::default() });
    let have = faces(spec);
    let same = |f: &Vec<String>| {
        let mut f = f.clone();
        f.sort_unstable();
        f == distinct
    };
    if have.iter().any(same) {
        return Err(refused(format!("`{surface}` has it already")));
    }
    for side in sides(nodes) {
        if have.iter().filter(|f| sides(f).any(|s| s == side)).count() > 1 {
            let [a, b] = side;
            return Err(refused(format!(
                "two faces of `{surface}` meet at {a} – {b} already; give this one to another surface"
            )));
        }
    }
    spec.faces.get_or_insert_default().push(nodes.to_vec());
    for side in sides(nodes) {
        draft.wires.remove(&side);
    }
    Ok(())
}

/// Takes a face out of a surface; one of a grid turns the grid into a list first.
fn take_face(draft: &mut Draft, surface: &str, face: usize) -> Result<Vec<String>, EditError> {
    let spec = draft.template.surfaces.get_mut(surface).ok_or_else(|| missing("surface", surface))?;
    let mut all = faces(spec);
    if face >= all.len() {
        return Err(missing("face", &format!("{face} of {surface}")));
    }
    let nodes = all.remove(face);
    let empty = all.is_empty();
    spec.rows = None;
    spec.faces = Some(all);
    if empty {
        draft.template.surfaces.remove(surface);
        forget_surface(draft, surface);
    }
    Ok(nodes)
}

/// Takes out what is said of a surface that is no more.
fn forget_surface(draft: &mut Draft, surface: &str) {
    let file = &mut draft.template;
    file.pieces.remove(surface);
    let twin = surface.strip_prefix("left_").map(|rest| format!("right_{rest}"));
    let gone = |name: &String| name == surface || Some(name) == twin.as_ref();
    for group in &mut file.fair_across {
        group.retain(|name| !gone(name));
    }
    file.fair_across.retain(|group| group.len() > 1);
    for ease in file.ease.values_mut() {
        ease.surfaces.retain(|name| !gone(name));
    }
    if let Some(joints) = &mut file.joints {
        for joint in joints.iter_mut() {
            joint.surfaces.retain(|name| !gone(name));
        }
        joints.retain(|joint| joint.surfaces.len() > 1);
    }
    // Lines whose edges no surface has any more would make the template refuse to build.
    let have = edges(file);
    let stands = |line: &LineSpec| line.through.windows(2).all(|w| have.contains_key(&pair(&w[0], &w[1])));
    let fallen: Vec<String> = file.lines.iter().filter(|(_, l)| !stands(l)).map(|(n, _)| n.clone()).collect();
    for name in fallen {
        file.lines.remove(&name);
        for piece in file.pieces.values_mut() {
            piece.edges.remove(&name);
            piece.on_fold.take_if(|l| *l == name);
        }
        for other in file.surfaces.values_mut() {
            other.open_along.retain(|l| *l != name);
        }
        for line in file.lines.values_mut() {
            line.continues.take_if(|l| *l == name);
        }
    }
}

fn draw_profile(
    draft: &mut Draft,
    name: &str,
    nodes: &[String; 2],
    points: &[[f64; 3]],
) -> Result<(), EditError> {
    known(draft, nodes)?;
    if !edges(&draft.template).contains_key(&pair(&nodes[0], &nodes[1])) {
        let why = "no face has it; fill one first";
        return Err(EditError::Edge { from: nodes[0].clone(), to: nodes[1].clone(), why });
    }
    let lines = &mut draft.template.lines;
    // Lines on single edges are drawn again in place; longer ones keep the rest of their chain only as straight parts would,
    // so they are not touched.
    let on_edge = |l: &LineSpec| l.through.len() == 2 && l.through.iter().all(|n| nodes.contains(n));
    if let Some(other) = lines.iter().find(|(n, l)| n.as_str() != name && on_edge(l)).map(|(n, _)| n.clone())
    {
        return Err(EditError::Used {
            kind: "edge",
            name: nodes.join(" – "),
            by: format!("the line `{other}`"),
        });
    }
    if lines.get(name).is_some_and(|l| !on_edge(l)) {
        return Err(taken("line", name));
    }
    let shape = Some(Shape::Profile(ProfileShape { points: points.to_vec(), turn: false }));
    let old = lines.remove(name).unwrap_or_else(|| LineSpec {
        through: Vec::new(),
        closed: false,
        across_centre: false,
        mirror: false,
        shape: None,
        corners: Vec::new(),
        continues: None,
        hold: None,
    });
    lines.insert(name.to_owned(), LineSpec { through: nodes.to_vec(), shape, ..old });
    Ok(())
}
