//! A complex under edit: every operator is checked, applied and logged with its inverse.

use serde::{Deserialize, Serialize};

use super::Complex;
use super::operation::{Delta, Operation, Outcome};
use super::plan::Step;
use super::refusal::Refusal;

/// An operator that was applied, and the one that takes it back.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// What was done; radial places that were found from positions are written down.
    pub operation: Operation,
    /// What gives the complex before it, bit for bit.
    pub inverse: Operation,
}

/// What was done, grouped to transactions.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Journal {
    /// Transactions in the order in which they were done; a single operator is one too.
    pub done: Vec<Vec<Record>>,
    /// Transactions taken back, the last first.
    #[serde(default)]
    pub undone: Vec<Vec<Record>>,
}

impl Journal {
    /// All operators done, in order.
    pub fn operations(&self) -> impl Iterator<Item = &Operation> {
        self.done.iter().flatten().map(|r| &r.operation)
    }
}

/// A complex with its journal. The operators are its methods.
///
/// ```
/// use mesh_kernel::complex::{EdgeKind, Editor, FaceKind, NewFace};
/// use mesh_kernel::glam::DVec3;
///
/// let mut editor = Editor::default();
/// let a = editor.make_vertex_complex(DVec3::ZERO)?;
/// let b = editor.make_vertex_edge(a, DVec3::X)?.vertex;
/// let c = editor.make_vertex_edge(b, DVec3::Y)?.vertex;
/// assert_eq!(editor.make_edge(c, a)?.kind, EdgeKind::Chole);
/// let walk = editor.complex().walk(&[a, b, c])?;
/// assert_eq!(editor.make_face(NewFace::new(walk))?.kind, FaceKind::Chole);
/// assert_eq!(editor.complex().counts().to_string(), "v 3 − e 3 + f 1 − r 0, c 1 − ch 0 + cc 0");
/// editor.undo();
/// assert_eq!(editor.complex().counts().ch, 1);
/// # Ok::<(), mesh_kernel::complex::Refusal>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Editor {
    complex: Complex,
    journal: Journal,
    /// Of the transaction that is open.
    open: Vec<Record>,
    depth: u32,
}

impl Editor {
    /// Takes a complex to edit. The journal is empty.
    pub fn new(complex: Complex) -> Self {
        Self { complex, ..Self::default() }
    }

    /// The complex as it is now.
    pub fn complex(&self) -> &Complex {
        &self.complex
    }

    /// Gives the complex back; the journal is lost.
    pub fn into_complex(self) -> Complex {
        self.complex
    }

    /// What was done so far, without a transaction that is open.
    pub fn journal(&self) -> &Journal {
        &self.journal
    }

    /// Checks an operator, applies and logs it. O(what it touches), and its search; see the method of its name.
    ///
    /// # Errors
    /// [`Refusal`]; nothing was changed.
    pub fn apply(&mut self, operation: &Operation) -> Result<Outcome, Refusal> {
        let step = self.complex.plan(operation)?;
        Ok(self.take(step))
    }

    /// Does and logs what was found possible.
    pub(super) fn take(&mut self, step: Step) -> Outcome {
        let outcome = self.complex.act(&step.operation);
        self.open.push(Record { operation: step.operation, inverse: step.inverse });
        if self.depth == 0 {
            self.close();
        }
        Outcome { delta: step.delta, ..outcome }
    }

    fn close(&mut self) {
        if !self.open.is_empty() {
            self.journal.undone.clear();
            self.journal.done.push(std::mem::take(&mut self.open));
        }
    }

    /// Runs `edit` as one step of the journal. On an error everything that it did is taken back, and what could be done again
    /// still can. Transactions nest: an inner one that fails takes back its own part only.
    ///
    /// # Errors
    /// Those of `edit`.
    pub fn transaction<T, E>(&mut self, edit: impl FnOnce(&mut Self) -> Result<T, E>) -> Result<T, E> {
        let start = self.open.len();
        self.depth += 1;
        let result = edit(self);
        self.depth -= 1;
        if result.is_err() {
            for record in self.open.split_off(start).iter().rev() {
                self.complex.act(&record.inverse);
            }
        }
        if self.depth == 0 {
            self.close();
        }
        result
    }

    /// A transaction that sums up what its operators change.
    pub(super) fn sequence<T>(
        &mut self,
        edit: impl FnOnce(&mut Self, &mut Delta) -> Result<T, Refusal>,
    ) -> Result<(T, Delta), Refusal> {
        let mut delta = Delta::default();
        let result = self.transaction(|editor| edit(editor, &mut delta))?;
        Ok((result, delta))
    }

    /// Takes the last operator or transaction back; `false` where there is none, or within a transaction.
    pub fn undo(&mut self) -> bool {
        if self.depth > 0 {
            return false;
        }
        let Some(records) = self.journal.done.pop() else { return false };
        for record in records.iter().rev() {
            self.complex.act(&record.inverse);
        }
        self.journal.undone.push(records);
        true
    }

    /// Does the operator or transaction undone last again; `false` where there is none, or within a transaction. Any other
    /// operator forgets what was undone.
    pub fn redo(&mut self) -> bool {
        if self.depth > 0 {
            return false;
        }
        let Some(records) = self.journal.undone.pop() else { return false };
        for record in &records {
            self.complex.act(&record.operation);
        }
        self.journal.done.push(records);
        true
    }

    /// Applies a saved journal's operators to the complex, with all checks, transaction by transaction.
    ///
    /// # Errors
    /// The first refusal, with the numbers (from 0) of the transaction and of the operator in it; transactions before it stay.
    pub fn replay(&mut self, journal: &Journal) -> Result<(), ReplayError> {
        for (transaction, records) in journal.done.iter().enumerate() {
            self.transaction(|editor| {
                for (number, record) in records.iter().enumerate() {
                    let applied = editor.apply(&record.operation);
                    applied.map_err(|refusal| ReplayError { transaction, number, refusal })?;
                }
                Ok(())
            })?;
        }
        Ok(())
    }
}

/// A journal that does not fit the complex.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("transaction {transaction}, operator {number}: {refusal}")]
pub struct ReplayError {
    /// Number of the transaction.
    pub transaction: usize,
    /// Number of the operator in it.
    pub number: usize,
    /// Why it was refused.
    #[source]
    pub refusal: Refusal,
}
