//! Editing by operators that can be undone (K4, K5).
//!
//! An [`Editor`] holds a body, the edges at its nodes, and a journal. Every operator first finds out whether it may
//! (typed refusals, nothing changed), then acts and is logged. [`Editor::undo`] gives the body back bit for bit, ids
//! included; [`Editor::transaction`] rolls back whole on an error.

mod collapse_edge;
mod journal;
mod link_condition;
mod loops;
mod split_edge;
mod stars;
mod swap_edge;

pub use collapse_edge::{CollapseError, CollapseOptions, CollapsedEdge, EdgeCollapse};
pub use link_condition::Obstacle;
pub use split_edge::{EdgeSplit, SplitEdgeError};
pub use swap_edge::{Guard, SwapError};

use journal::{Journal, Record};
use stars::Stars;

use super::Body;

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
        let records = self.journal.done.split_off(from);
        self.take_back(&records);
        self.journal.undone.push(records);
        true
    }

    /// Does the operator or transaction undone last again; `false` where there is none. Any other operator forgets what was
    /// undone.
    pub fn redo(&mut self) -> bool {
        let Some(records) = self.journal.undone.pop() else { return false };
        for record in records {
            self.act(&record);
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
            let records = self.journal.done.split_off(start);
            self.take_back(&records);
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
    fn apply(&mut self, record: Record) {
        self.act(&record);
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

    fn act(&mut self, record: &Record) {
        match record {
            Record::SwapEdge { surface, edge, clockwise } => self.do_swap(*surface, *edge, *clockwise),
            Record::SplitEdge { surface, edge, at, more, .. } => {
                self.do_split(*surface, *edge, *at, more.as_deref());
            }
            Record::CollapseEdge(collapse) => self.do_collapse(collapse),
        }
    }

    fn take_back(&mut self, records: &[Record]) {
        for record in records.iter().rev() {
            match record {
                Record::SwapEdge { surface, edge, clockwise } => self.do_swap(*surface, *edge, !*clockwise),
                Record::SplitEdge { surface, edge, second, reused, more, .. } => {
                    self.do_join(*surface, *edge, *second, *reused, more.as_deref());
                }
                Record::CollapseEdge(collapse) => self.undo_collapse(collapse),
            }
        }
    }
}
