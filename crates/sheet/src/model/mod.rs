//! Sheet modelling: wires, sheets and solids made by commands on the kernel's Euler operators (Lee & Kim 2001, section 3;
//! Stroud & Nagy, chapter 6).
//!
//! A [`Model`] is a [`Complex`] with names: every face belongs to a *patch*. Each [`Command`] is one transaction of the
//! kernel's journal: refused, it has changed nothing; undone, it leaves no trace. A [`Script`] is a list of commands as text.

mod bend;
mod build;
mod carry_out;
mod command;
mod corners;
mod error;
mod extrude;
mod faces;
mod join;
mod links;
mod partial;
mod pillars;
mod plane;
mod rebuild;
mod script;
mod sweep;
mod touching;
mod wire;

pub use build::SAME_POINT;
pub use command::{AlongWire, Command, Done, JoinEdges};
pub use error::ModelError;
pub use extrude::ExtrusionCase;
pub use links::{Link, LinkSide, joint_links};
pub use plane::WorkPlane;
pub use script::{Script, ScriptError, ScriptRun};
pub use touching::{Reading, Touching, touching};
pub use wire::Wire;

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;
use mesh_kernel::complex::{Complex, EdgeId, Editor, FaceId, Loop, VertexId};
use mesh_kernel::{Group, TriMesh};

use crate::bends::forest::Roots;
use crate::unfold::flat_triangles;

/// Limits of what a model is made of, so that no script takes all memory or time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Farthest that chords may be from the curves that they stand for, in millimetres.
    pub tolerance: f64,
    /// Points of one drawing.
    pub points: usize,
    /// Faces of the model.
    pub faces: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Self { tolerance: 0.05, points: 2000, faces: 20_000 }
    }
}

/// Faces of one patch that turn by more than that, in radians, and by less than the next, are strips of a curve: what turns less is
/// plane and was drawn as two faces, what turns more is a fold.
const FLAT_TURN: f64 = 1e-6;
const SMOOTH_TURN: f64 = 0.55;

/// What is known of a model besides its complex.
#[derive(Clone, Debug, Default, PartialEq)]
struct Tables {
    /// Patch of every face.
    patch_of: BTreeMap<FaceId, u32>,
    names: Vec<String>,
    /// Patches with unlimited material behind them.
    partial: BTreeSet<u32>,
    wires: BTreeMap<String, Wire>,
}

/// A step that was done.
#[derive(Clone, Debug, PartialEq)]
struct Step {
    /// The tables on the other side of it.
    tables: Tables,
    /// Whether the kernel's journal has a transaction for it.
    edited: bool,
}

/// A model under work.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Model {
    editor: Editor,
    tables: Tables,
    limits: Limits,
    done: Vec<Step>,
    undone: Vec<Step>,
}

impl Model {
    /// An empty model.
    pub fn new(limits: Limits) -> Self {
        Self { limits, ..Self::default() }
    }

    /// The complex.
    pub fn complex(&self) -> &Complex {
        self.editor.complex()
    }

    /// Names of the patches that have faces, in the order in which they were made.
    pub fn patches(&self) -> Vec<String> {
        let used: BTreeSet<u32> = self.tables.patch_of.values().copied().collect();
        used.into_iter().map(|p| self.tables.names[p as usize].clone()).collect()
    }

    /// Names of the partial patches.
    pub fn partial_patches(&self) -> Vec<String> {
        self.tables.partial.iter().map(|p| self.tables.names[*p as usize].clone()).collect()
    }

    /// Wires that were not made sheets yet.
    pub fn wires(&self) -> Vec<String> {
        self.tables.wires.keys().cloned().collect()
    }

    /// Faces of a patch, ascending.
    ///
    /// # Errors
    /// [`ModelError::NoPatch`].
    pub fn faces_of(&self, patch: &str) -> Result<Vec<FaceId>, ModelError> {
        let faces: Vec<FaceId> = match self.tables.names.iter().position(|n| n == patch) {
            Some(number) => {
                let of = self.tables.patch_of.iter().filter(|(_, p)| **p as usize == number);
                of.map(|(f, _)| *f).collect()
            }
            None => Vec::new(),
        };
        if faces.is_empty() {
            return Err(ModelError::NoPatch { name: patch.to_owned(), known: self.patches() });
        }
        Ok(faces)
    }

    /// Carries a command out as one step.
    ///
    /// # Errors
    /// [`ModelError`]; nothing was changed.
    pub fn apply(&mut self, command: &Command) -> Result<Done, ModelError> {
        match command {
            Command::Undo {} => {
                return if self.undo() { Ok(Done::default()) } else { Err(ModelError::Nothing("undo")) };
            }
            Command::Redo {} => {
                return if self.redo() { Ok(Done::default()) } else { Err(ModelError::Nothing("redo")) };
            }
            _ => {}
        }
        let before = self.tables.clone();
        let transactions = self.editor.journal().done.len();
        // The model's parts are borrowed one by one inside, so the editor is taken out for the transaction.
        let mut editor = std::mem::take(&mut self.editor);
        let result = editor.transaction(|editor| {
            std::mem::swap(editor, &mut self.editor);
            let result = self.carry_out(command).and_then(|done| {
                let faces = self.editor.complex().face_count();
                if faces > self.limits.faces {
                    return Err(ModelError::TooFine { points: faces, most: self.limits.faces });
                }
                Ok(done)
            });
            std::mem::swap(editor, &mut self.editor);
            result
        });
        self.editor = editor;
        match result {
            Ok(done) => {
                let edited = self.editor.journal().done.len() > transactions;
                self.done.push(Step { tables: before, edited });
                self.undone.clear();
                Ok(done)
            }
            Err(error) => {
                self.tables = before;
                Err(error)
            }
        }
    }

    /// Takes the last command back; `false` where there is none.
    pub fn undo(&mut self) -> bool {
        let Some(step) = self.done.pop() else { return false };
        if step.edited {
            self.editor.undo();
        }
        let tables = std::mem::replace(&mut self.tables, step.tables);
        self.undone.push(Step { tables, edited: step.edited });
        true
    }

    /// Does the command undone last again; `false` where there is none.
    pub fn redo(&mut self) -> bool {
        let Some(step) = self.undone.pop() else { return false };
        if step.edited {
            self.editor.redo();
        }
        let tables = std::mem::replace(&mut self.tables, step.tables);
        self.done.push(Step { tables, edited: step.edited });
        true
    }

    /// The faces as triangles, a group a face, apart from strips of one patch that make a curve: these are one group. Groups are
    /// named after their patches, with a number where there are several. Wires have none. O(n log n).
    pub fn to_mesh(&self) -> TriMesh {
        let groups = self.smooth_parts();
        let mut mesh = self.mesh_of(|_| true, |f| groups.get(&f).copied().unwrap_or(f.0));
        let names: Vec<String> = mesh.groups.iter().map(|g| g.name.clone()).collect();
        let mut seen: BTreeMap<String, usize> = BTreeMap::new();
        for group in &mut mesh.groups {
            let all = names.iter().filter(|n| **n == group.name).count();
            if all > 1 {
                let number = seen.entry(group.name.clone()).or_default();
                *number += 1;
                group.name = format!("{}-{number}", group.name);
            }
        }
        mesh
    }

    /// The first face of the curved strip that every face belongs to.
    fn smooth_parts(&self) -> BTreeMap<FaceId, u32> {
        let complex = self.complex();
        let bound = complex.faces().last().map_or(0, |f| f.index() + 1);
        let mut parts = Roots::new(bound);
        let normal: BTreeMap<FaceId, DVec3> = complex
            .faces()
            .map(|f| {
                (
                    f,
                    self.corners_of(f)
                        .first()
                        .map_or(DVec3::ZERO, |c| build::area_vector(c).normalize_or_zero()),
                )
            })
            .collect();
        for e in complex.edges() {
            let [a, b] = complex.uses(e)[..] else { continue };
            let one_patch = self.tables.patch_of.get(&a.face) == self.tables.patch_of.get(&b.face);
            let other = if a.along == b.along { -normal[&b.face] } else { normal[&b.face] };
            let turn = normal[&a.face].cross(other).length().atan2(normal[&a.face].dot(other));
            if one_patch && turn > FLAT_TURN && turn < SMOOTH_TURN {
                parts.union(b.face.0, a.face.0);
            }
        }
        complex.faces().map(|f| (f, parts.find(f.0))).collect()
    }

    /// Some faces as triangles, grouped by a number.
    fn mesh_of(&self, wanted: impl Fn(FaceId) -> bool, group: impl Fn(FaceId) -> u32) -> TriMesh {
        let complex = self.complex();
        let mut node = BTreeMap::new();
        let mut mesh = TriMesh::default();
        let mut faces: Vec<(u32, FaceId)> =
            complex.faces().filter(|f| wanted(*f)).map(|f| (group(f), f)).collect();
        faces.sort_unstable();
        for same in faces.chunk_by(|a, b| a.0 == b.0) {
            let first = mesh.faces.len() as u32;
            for (_, f) in same {
                let loops: Vec<Vec<VertexId>> =
                    complex.loops(*f).iter().map(|l| complex.loop_vertices(l)).collect();
                let points: Vec<Vec<DVec3>> = loops
                    .iter()
                    .map(|l| l.iter().map(|v| complex.position(*v).unwrap_or_default()).collect())
                    .collect();
                let flat: Vec<VertexId> = loops.concat();
                for triangle in flat_triangles(&points) {
                    mesh.faces.push(triangle.map(|k| {
                        let v = flat[k];
                        *node.entry(v).or_insert_with(|| {
                            mesh.positions.push(complex.position(v).unwrap_or_default());
                            mesh.positions.len() as u32 - 1
                        })
                    }));
                }
            }
            let name = self.patch_name(same[0].1).to_owned();
            mesh.groups.push(Group { name, faces: first..mesh.faces.len() as u32 });
        }
        mesh
    }

    fn patch_name(&self, face: FaceId) -> &str {
        let patch = self.tables.patch_of.get(&face).copied().unwrap_or(0);
        self.tables.names.get(patch as usize).map_or("", String::as_str)
    }

    /// A new patch of that name.
    fn new_patch(&mut self, name: &str) -> Result<u32, ModelError> {
        if self.faces_of(name).is_ok() {
            return Err(ModelError::NameTaken { name: name.to_owned() });
        }
        if let Some(known) = self.tables.names.iter().position(|n| n == name) {
            return Ok(known as u32);
        }
        self.tables.names.push(name.to_owned());
        Ok(self.tables.names.len() as u32 - 1)
    }

    fn enter(&mut self, faces: impl IntoIterator<Item = FaceId>, patch: u32) {
        for f in faces {
            self.tables.patch_of.insert(f, patch);
        }
    }

    /// Corners of a face's loops.
    fn corners_of(&self, face: FaceId) -> Vec<Vec<DVec3>> {
        let complex = self.complex();
        let corners =
            |l: &Loop| complex.loop_vertices(l).into_iter().filter_map(|v| complex.position(v)).collect();
        complex.loops(face).iter().map(corners).collect()
    }

    /// Vertices of some faces, ascending.
    fn vertices_of(&self, faces: &[FaceId]) -> BTreeSet<VertexId> {
        let complex = self.complex();
        faces.iter().flat_map(|f| complex.loops(*f)).flat_map(|l| complex.loop_vertices(l)).collect()
    }

    fn at(&self, v: VertexId) -> DVec3 {
        self.complex().position(v).unwrap_or_default()
    }

    /// Edges that lead straight from one point to another, in order, each with whether it runs that way.
    fn edges_along(&self, from: DVec3, to: DVec3) -> Result<Vec<EdgeId>, ModelError> {
        let complex = self.complex();
        let missing = || ModelError::NoEdge { from, to };
        let d = (to - from).try_normalize().ok_or_else(missing)?;
        let on = |p: DVec3| {
            let t = (p - from).dot(d);
            let near = (p - from - d * t).length() <= SAME_POINT;
            near && t >= -SAME_POINT && t <= (to - from).length() + SAME_POINT
        };
        let mut found: Vec<(f64, f64, EdgeId)> = complex
            .edges()
            .filter_map(|e| {
                let [a, b] = complex.ends(e)?.map(|v| self.at(v));
                let (s, t) = ((a - from).dot(d), (b - from).dot(d));
                (on(a) && on(b)).then_some((s.min(t), s.max(t), e))
            })
            .collect();
        found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.2.cmp(&b.2)));
        let mut reached = 0.0f64;
        for (low, high, _) in &found {
            if *low > reached + SAME_POINT {
                break;
            }
            reached = reached.max(*high);
        }
        if reached + SAME_POINT < (to - from).length() {
            return Err(missing());
        }
        Ok(found.into_iter().map(|x| x.2).collect())
    }

    /// Kills edges of a list that no face uses, and vertices that then stand alone.
    fn sweep_up(
        &mut self,
        edges: &BTreeSet<EdgeId>,
        vertices: &BTreeSet<VertexId>,
    ) -> Result<(), ModelError> {
        for &e in edges {
            if self.complex().ends(e).is_some() && self.complex().uses(e).is_empty() {
                self.editor.kill_edge(e)?;
            }
        }
        for &v in vertices {
            let complex = self.complex();
            let alone = complex.edges_at(v).is_empty() && complex.faces_pierced_at(v).is_empty();
            if complex.position(v).is_some() && alone {
                self.editor.kill_vertex_complex(v)?;
            }
        }
        Ok(())
    }

    /// Edges of some faces, ascending.
    fn edges_of(&self, faces: &[FaceId]) -> BTreeSet<EdgeId> {
        let loops = faces.iter().flat_map(|f| self.complex().loops(*f));
        loops.flat_map(Loop::edges).map(|d| d.edge).collect()
    }
}
