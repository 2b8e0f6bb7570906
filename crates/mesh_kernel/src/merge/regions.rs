//! The parts of space that merged faces bound.
//!
//! A face has two sides. Going round an edge, the sides of two faces that look at each other belong to one region; at an
//! edge with one face both its sides do. What is joined so, one face after the other, is a *shell*; shells of parts that do
//! not touch are told apart by how often the models wind about them.

use super::edge_uses::{Use, edge_uses};
use super::{MergeError, Merged};
use crate::body::radial::radial_order;
use crate::body::weld::UnionFind;

/// Which region is on either side of every face, and how often each model winds about it.
///
/// Regions are shells: a part that lies in a void of another without touching it has an outer shell of its own.
#[derive(Clone, Debug)]
pub struct Regions {
    /// For every face the region on the side that it is anticlockwise from, and that behind it.
    pub sides: Vec<[u32; 2]>,
    /// How many there are.
    pub count: usize,
    /// Edges of the merged faces.
    pub edges: usize,
    pub(super) windings: Vec<i32>,
    pub(super) models: usize,
}

impl Regions {
    /// How often every model winds about a region.
    pub fn windings(&self, region: u32) -> &[i32] {
        &self.windings[region as usize * self.models..][..self.models]
    }
}

impl Merged {
    /// The regions of space between the faces. O(n log n).
    ///
    /// # Errors
    /// [`MergeError::Open`] where a model is not closed: then nothing is inside it.
    pub fn regions(&self) -> Result<Regions, MergeError> {
        let uses = edge_uses(&self.faces, self.nodes.len());
        self.check_closed(&uses)?;
        let mut sides = UnionFind::new(2 * self.faces.len());
        let mut order = Vec::new();
        let mut edges = 0;
        for fan in uses.chunk_by(|a, b| a.0 == b.0) {
            edges += 1;
            self.turn_round(fan, &mut order);
            for (k, &i) in order.iter().enumerate() {
                let next = order[(k + 1) % order.len()];
                sides.union(ahead(fan[i as usize]), behind(fan[next as usize]));
            }
        }
        let (numbers, count) = sides.number();
        let sides: Vec<[u32; 2]> = numbers.chunks_exact(2).map(|s| [s[0], s[1]]).collect();
        let windings = self.windings_of(&sides, count);
        Ok(Regions { sides, count, edges, windings, models: self.models() })
    }

    /// The uses at an edge in the order in which a right hand about the edge passes their faces.
    fn turn_round(&self, fan: &[Use], order: &mut Vec<u32>) {
        order.clear();
        order.extend(0..fan.len() as u32);
        if fan.len() > 2 {
            let [a, b] = fan[0].0;
            let apexes: Vec<_> = fan
                .iter()
                .map(|(_, f, _)| {
                    let apex = self.faces[*f as usize].iter().find(|v| **v != a && **v != b);
                    self.nodes[apex.copied().unwrap_or(a) as usize]
                })
                .collect();
            if let Some(radial) = radial_order(self.nodes[a as usize], self.nodes[b as usize], &apexes) {
                order.copy_from_slice(&radial.order);
            }
        }
    }

    /// Every model has to run over every edge as often forward as backward.
    fn check_closed(&self, uses: &[Use]) -> Result<(), MergeError> {
        let mut sums = vec![0i32; self.models()];
        for fan in uses.chunk_by(|a, b| a.0 == b.0) {
            for (_, face, forward) in fan {
                for parent in self.parents(*face) {
                    let along = if *forward != parent.reversed { 1 } else { -1 };
                    sums[self.model_of(parent.face) as usize] += along;
                }
            }
            if let Some(model) = sums.iter().position(|s| *s != 0) {
                let [from, to] = fan[0].0.map(|v| self.positions[v as usize].to_array());
                return Err(MergeError::Open { model: model as u32, from, to });
            }
        }
        Ok(())
    }
}

/// The side of a face that looks on when a right hand turns about the edge.
fn ahead((_, face, forward): Use) -> u32 {
    2 * face + u32::from(!forward)
}

/// The other one.
fn behind((_, face, forward): Use) -> u32 {
    2 * face + u32::from(forward)
}
