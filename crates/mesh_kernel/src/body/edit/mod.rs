//! Editing by operators that can be undone (K4, K5).
//!
//! An [`Editor`] holds a body, the pairs of nodes that edges join, and a journal. Every operator first finds out whether it may
//! (typed refusals, nothing changed), then acts and is logged. [`Editor::undo`] gives the body back bit for bit, ids
//! included; [`Editor::transaction`] rolls back whole on an error.

mod delta;
mod edge_set;
mod face_mesh;
mod journal;
mod split_edge;
mod swap_edge;
mod triangulate_face;

pub use split_edge::{EdgeSplit, SplitEdgeError};
pub use swap_edge::{Guard, SwapError};
pub use triangulate_face::{FaceTriangulation, TriangulateError};

use edge_set::EdgeSet;
use journal::{Journal, Record};

use super::{Body, SurfaceId};

/// A body under edit.
#[derive(Clone, Debug, Default)]
pub struct Editor {
    body: Body,
    /// By surface, made when first asked for.
    joined: Vec<Option<EdgeSet>>,
    journal: Journal,
    /// Depth of transactions that are open.
    open: u32,
}

impl Editor {
    /// Takes a body to edit. The journal is empty.
    pub fn new(body: Body) -> Self {
        let joined = vec![None; body.surfaces.len()];
        Self { body, joined, journal: Journal::default(), open: 0 }
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
            self.journal.marks.push(self.journal.done.len());
        }
        result
    }

    /// Does and logs an operator that has been found possible.
    fn apply(&mut self, mut record: Record) {
        self.act(&mut record);
        self.journal.undone.clear();
        self.journal.done.push(record);
        if self.open == 0 {
            self.journal.marks.push(self.journal.done.len());
        }
    }

    fn log_deltas(&mut self, deltas: Vec<delta::Delta>) {
        self.joined.iter_mut().for_each(|j| *j = None);
        self.journal.undone.clear();
        self.journal.done.push(Record::Deltas(deltas));
        if self.open == 0 {
            self.journal.marks.push(self.journal.done.len());
        }
    }

    fn act(&mut self, record: &mut Record) {
        match record {
            Record::SwapEdge { surface, edge, clockwise } => self.do_swap(*surface, *edge, *clockwise),
            Record::Deltas(d) => d.iter_mut().for_each(|d| d.exchange(&mut self.body)),
            Record::SplitEdge { surface, edge, at, position, .. } => {
                self.do_split(*surface, *edge, *at, *position);
            }
        }
    }

    fn take_back(&mut self, records: &mut [Record]) {
        for record in records.iter_mut().rev() {
            match record {
                Record::SwapEdge { surface, edge, clockwise } => self.do_swap(*surface, *edge, !*clockwise),
                Record::Deltas(d) => d.iter_mut().for_each(|d| d.exchange(&mut self.body)),
                Record::SplitEdge { surface, edge, attributes, .. } => {
                    self.do_join(*surface, *edge, attributes.as_deref());
                }
            }
        }
    }

    /// Whether an edge of the surface joins two nodes. O(edges) when first asked, then O(1).
    fn joined(&mut self, surface: SurfaceId, a: u32, b: u32) -> bool {
        let s = &self.body.surfaces[surface.index()];
        self.joined[surface.index()].get_or_insert_with(|| EdgeSet::new(s)).contains(a, b)
    }
}
