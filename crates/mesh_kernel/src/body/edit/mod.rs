//! Editing by operators that can be undone (K4, K5).
//!
//! An [`Editor`] holds a body, the edges at its nodes, and a journal. Every operator first finds out whether it may
//! (typed refusals, nothing changed), then acts and is logged. [`Editor::undo`] gives the body back bit for bit, ids
//! included; [`Editor::transaction`] rolls back whole on an error.

mod carry_attributes;
mod collapse_edge;
mod delta;
pub mod euler;
mod face_mesh;
mod joints;
mod journal;
mod journal_file;
mod layers;
mod link_condition;
mod loops;
mod minimise;
mod operation;
mod split_edge;
mod split_face;
mod stars;
mod swap_edge;
mod triangulate_face;
mod whole;

pub use collapse_edge::{CollapseError, CollapseOptions, CollapsedEdge, EdgeCollapse};
pub use euler::{EdgeRole, EulerError, EulerOperator, FaceRole};
pub use joints::JointError;
pub use journal_file::{JOURNAL_FILE_VERSION, JournalFile, ReplayError};
pub use layers::LayerError;
pub use link_condition::Obstacle;
pub use minimise::{minimise, minimise_with};
pub use operation::{Operation, Outcome, Refusal};
pub use split_edge::{EdgeSplit, SplitEdgeError};
pub use split_face::{FaceSplit, SplitEdge, SplitFaceError};
pub use swap_edge::{Guard, SwapError};
pub use triangulate_face::{FaceTriangulation, TriangulateError};

use delta::{Delta, Recorder};
use journal::{Journal, Record};
use stars::Stars;
use whole::Whole;

use super::{Body, Surface, SurfaceId};

/// A body under edit.
#[derive(Clone, Debug, Default)]
pub struct Editor {
    body: Body,
    /// By surface, made when first asked for.
    stars: Vec<Option<Stars>>,
    journal: Journal,
    /// Whether nothing can be undone but what a transaction that is open did.
    forgetful: bool,
    /// Depth of transactions that are open.
    open: u32,
}

impl Editor {
    /// Takes a body to edit. The journal is empty.
    pub fn new(body: Body) -> Self {
        let stars = vec![None; body.surfaces.len()];
        Self { body, stars, journal: Journal::default(), forgetful: false, open: 0 }
    }

    /// Takes a body to edit without a journal: nothing can be undone, but a transaction that fails is still taken back.
    /// For whoever makes a mesh anew and keeps the old body himself.
    pub fn without_journal(body: Body) -> Self {
        Self { forgetful: true, ..Self::new(body) }
    }

    /// The body as it is now.
    pub fn body(&self) -> &Body {
        &self.body
    }

    /// Gives the body back; the journal is lost.
    pub fn into_body(self) -> Body {
        self.body
    }

    /// Operators and transactions that can be undone.
    pub fn undo_len(&self) -> usize {
        self.journal.marks.len()
    }

    /// Operators and transactions that can be done again.
    pub fn redo_len(&self) -> usize {
        self.journal.undone.len()
    }

    /// Takes the last operator or transaction back; `false` where there is none.
    pub fn undo(&mut self) -> bool {
        if self.journal.marks.pop().is_none() {
            return false;
        }
        let from = self.journal.marks.last().copied().unwrap_or(0);
        let mut records = self.journal.done.split_off(from);
        self.take_back(&mut records);
        self.journal.undone.push(records);
        true
    }

    /// Does the operator or transaction undone last again; `false` where there is none. Any other operator forgets what was
    /// undone.
    pub fn redo(&mut self) -> bool {
        let Some(records) = self.journal.undone.pop() else { return false };
        for mut record in records {
            self.act(&mut record);
            self.journal.done.push(record);
        }
        self.journal.marks.push(self.journal.done.len());
        true
    }

    /// Runs `edit` as one step of the journal. On an error everything that it did is taken back.
    ///
    /// # Errors
    /// Those of `edit`.
    pub fn transaction<T, E>(&mut self, edit: impl FnOnce(&mut Self) -> Result<T, E>) -> Result<T, E> {
        let start = self.journal.done.len();
        self.open += 1;
        let result = edit(self);
        self.open -= 1;
        if result.is_err() {
            let mut records = self.journal.done.split_off(start);
            self.take_back(&mut records);
        } else if self.open == 0 && self.journal.done.len() > start {
            self.close();
        }
        result
    }

    /// Ends a step of the journal.
    #[inline]
    fn close(&mut self) {
        if self.forgetful {
            self.journal.done.clear();
        } else {
            self.journal.marks.push(self.journal.done.len());
        }
    }

    /// Does and logs an operator that has been found possible.
    fn perform(&mut self, mut record: Record) {
        self.act(&mut record);
        self.log(record);
    }

    /// Logs an operator that has been done.
    #[inline]
    fn log(&mut self, record: Record) {
        if self.forgetful && self.open == 0 {
            return;
        }
        self.journal.undone.clear();
        self.journal.done.push(record);
        if self.open == 0 {
            self.close();
        }
    }

    /// Runs a part of an operator whose first part names the operation: partners on a joint.
    fn follow<T>(&mut self, part: impl FnOnce(&mut Self) -> T) -> T {
        let from = self.journal.done.len();
        let made = part(self);
        let parts = self.journal.done.split_off(from);
        self.journal.done.extend(parts.into_iter().map(|r| Record::Following(Box::new(r))));
        made
    }

    fn act(&mut self, record: &mut Record) {
        match record {
            Record::SwapEdge { surface, edge, attributes } => {
                self.do_swap(*surface, *edge, false, attributes.is_some());
            }
            Record::SplitEdge { surface, edge, at, more, .. } => {
                self.do_split(*surface, *edge, *at, more.as_deref());
            }
            Record::CollapseEdge(collapse) => self.do_collapse(collapse),
            Record::Following(record) => self.act(record),
            _ => self.exchange(record),
        }
    }

    fn take_back(&mut self, records: &mut [Record]) {
        for record in records.iter_mut().rev() {
            self.take_one_back(record);
        }
    }

    fn take_one_back(&mut self, record: &mut Record) {
        match record {
            Record::SwapEdge { surface, edge, attributes } => {
                self.do_swap(*surface, *edge, true, false);
                if let Some(before) = attributes {
                    before.restore(&mut self.body.surfaces[surface.index()]);
                }
            }
            Record::SplitEdge { surface, edge, second, reused, more, .. } => {
                self.do_join(*surface, *edge, *second, *reused, more.as_deref());
            }
            Record::CollapseEdge(collapse) => self.undo_collapse(collapse),
            Record::Following(record) => self.take_one_back(record),
            _ => self.exchange(record),
        }
    }

    /// Records whose inverse is to exchange what they hold with what is in the body.
    fn exchange(&mut self, record: &mut Record) {
        match record {
            Record::Deltas { deltas, stars_kept, .. } => {
                // Each is on a surface of its own: the order is of no matter.
                for delta in deltas {
                    delta.exchange(&mut self.body);
                    if !*stars_kept {
                        self.forget_stars(delta.surface);
                    }
                }
            }
            Record::Whole { whole, .. } => {
                whole.exchange(&mut self.body);
                whole.surfaces().for_each(|i| self.stars[i] = None);
            }
            Record::Surface { surface, .. } => match surface.take() {
                Some(s) => {
                    self.body.surfaces.push(*s);
                    self.stars.push(None);
                }
                None => {
                    *surface = self.body.surfaces.pop().map(Box::new);
                    self.stars.pop();
                }
            },
            Record::SwapEdge { .. }
            | Record::SplitEdge { .. }
            | Record::CollapseEdge(_)
            | Record::Following(_) => {}
        }
    }

    /// Carries out an operator on one surface and logs it.
    fn record<T>(
        &mut self,
        surface: SurfaceId,
        operation: impl FnOnce() -> Operation,
        change: impl FnOnce(&mut Recorder) -> T,
    ) -> T {
        let (made, delta) = self.change(surface, change);
        self.log_deltas(operation(), vec![delta]);
        made
    }

    /// The same for an operator that leaves nodes and edges as they are.
    fn record_layer<T>(
        &mut self,
        surface: SurfaceId,
        operation: impl FnOnce() -> Operation,
        change: impl FnOnce(&mut Recorder) -> T,
    ) -> T {
        let (made, delta) = self.change(surface, change);
        let operation = Box::new(operation());
        self.log(Record::Deltas { operation, deltas: vec![delta], stars_kept: true });
        made
    }

    fn change<T>(&mut self, surface: SurfaceId, change: impl FnOnce(&mut Recorder) -> T) -> (T, Delta) {
        let mut recorder = Recorder::new(&mut self.body, surface);
        let made = change(&mut recorder);
        (made, recorder.finish())
    }

    /// Logs an operator whose changes have been made, on surfaces that differ.
    fn log_deltas(&mut self, operation: Operation, deltas: Vec<Delta>) {
        deltas.iter().for_each(|d| self.forget_stars(d.surface));
        self.log(Record::Deltas { operation: Box::new(operation), deltas, stars_kept: false });
    }

    /// A surface under changes that are not logged and that the caller takes back.
    fn trial(&mut self, surface: SurfaceId) -> Recorder<'_> {
        Recorder::new(&mut self.body, surface)
    }

    /// Puts `next`, which has the same surfaces, in the place of the body and logs it.
    fn replace(&mut self, next: Body, operation: impl FnOnce() -> Operation) {
        let whole = Box::new(Whole::replace(&mut self.body, next));
        whole.surfaces().for_each(|i| self.stars[i] = None);
        self.log(Record::Whole { operation: Box::new(operation()), whole });
    }

    fn push_surface(&mut self, surface: Surface, operation: Operation) {
        self.perform(Record::Surface { operation: Box::new(operation), surface: Some(Box::new(surface)) });
    }

    /// Operators done and not undone, oldest first; a transaction of several is an [`Operation::Group`]. Applied to the body
    /// with which the editor began they give the present body bit for bit. O(records).
    pub fn operations(&self) -> Vec<Operation> {
        self.journal.operations()
    }
}
