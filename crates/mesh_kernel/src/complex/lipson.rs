//! Lipson & Shpitalni's operators for sheet-metal parts (§4, tables 1 and 2, figs. 12–16), and their counts.
//!
//! Bends, welds and free edges are labels of edges ([`EdgeClass`]). The paper leaves rings out; with them counted its holes are
//! `g_nm = Ch − r`, a ring being a hole that lies in one facet: then `f = s + b + e + w − v − g_nm + m` is the identity of
//! [`crate::body::Counts`], and MGB is what its figure shows: the edge from a ring to the outer loop makes the hole count.
//!
//! | name | here | s | b | e | w | v | g_nm | m | f | v e f r C Ch Cc |
//! |---|---|---|---|---|---|---|---|---|---|---|
//! | MCV, KCV | make_vertex_complex; split_vertex, merge_vertices | 1 | | | | 1 | | | | v +1, C +1 |
//! | MEV, KEV | [`Editor::mev`], [`Editor::kev`] | | | 1 | | 1 | | | | v +1, e +1 |
//! | MEF, KEF | [`Editor::mef`], [`Editor::kef`] | | | 1 | | | | | 1 | e +1, f +1 |
//! | MGB, KGB | make_edge_kill_ring | | 1 | | | | 1 | | | e +1, r −1 |
//! | MBKE, KBME | set_edge_class | | 1 | −1 | | | | | | none |
//! | MUKE, KUME | unite_edges, divide_edge | | | −1 | | | | 1 | | e −1, Cc +1 |
//! | MWKB, KWMB | set_edge_class | | −1 | | 1 | | | | | none |

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::Complex;
use super::editor::Editor;
use super::ids::{Corner, EdgeClass, EdgeId, End, FaceId, FaceUse, VertexId};
use super::operation::{Delta, Operation, Outcome, RadialOrder};
use super::refusal::{Reason, Refusal};

/// Lipson & Shpitalni's counts of a sheet-metal part; differences of them too.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct SheetCounts {
    /// Components.
    pub s: i64,
    /// Bends.
    pub b: i64,
    /// Free edges: all that are neither bends nor welds.
    pub e: i64,
    /// Welds.
    pub w: i64,
    /// Vertices.
    pub v: i64,
    /// Non-manifold genus: holes that do not lie in one facet.
    pub g_nm: i64,
    /// Enclosed volumes.
    pub m: i64,
    /// Facets.
    pub f: i64,
}

/// A change of [`SheetCounts`].
pub type SheetDelta = SheetCounts;

impl SheetCounts {
    /// Whether `f = s + b + e + w − v − g_nm + m` (eq. 7).
    pub fn identity_holds(&self) -> bool {
        self.f == self.s + self.b + self.e + self.w - self.v - self.g_nm + self.m
    }

    /// By how many the bends and welds are more than what holds the part together: `v − e + g_nm − m` (eq. 9).
    pub fn redundant_joints(&self) -> i64 {
        self.v - self.e + self.g_nm - self.m
    }

    /// How many of each operator build a part with these counts: `P · M⁻¹` (eqs. 12–14); `None` where the identity does not hold.
    pub fn plan(&self) -> Option<SheetPlan> {
        self.identity_holds().then(|| SheetPlan {
            mcv: self.s,
            mev: self.v - self.s,
            mef: self.f,
            mgb: self.g_nm,
            mbke: self.b - self.g_nm + self.w,
            muke: self.m,
            mwkb: self.w,
        })
    }
}

impl std::ops::Sub for SheetCounts {
    type Output = Self;

    fn sub(self, o: Self) -> Self {
        Self {
            s: self.s - o.s,
            b: self.b - o.b,
            e: self.e - o.e,
            w: self.w - o.w,
            v: self.v - o.v,
            g_nm: self.g_nm - o.g_nm,
            m: self.m - o.m,
            f: self.f - o.f,
        }
    }
}

impl std::fmt::Display for SheetCounts {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { s, b, e, w, v, g_nm, m, f } = self;
        write!(out, "s {s} b {b} e {e} w {w} v {v} g_nm {g_nm} m {m} f {f}")
    }
}

/// How many of each operator; negative for its inverse.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct SheetPlan {
    /// Vertex components.
    pub mcv: i64,
    /// Edges with a vertex.
    pub mev: i64,
    /// Edges with a facet.
    pub mef: i64,
    /// Bends that make a hole of a ring.
    pub mgb: i64,
    /// Free edges to bends.
    pub mbke: i64,
    /// Free edges united to close a volume.
    pub muke: i64,
    /// Bends to welds.
    pub mwkb: i64,
}

impl SheetPlan {
    /// The counts of a part that these operators build: the plan times table 1.
    pub fn counts(&self) -> SheetCounts {
        SheetCounts {
            s: self.mcv,
            b: self.mgb + self.mbke - self.mwkb,
            e: self.mev + self.mef - self.mbke - self.muke,
            w: self.mwkb,
            v: self.mcv + self.mev,
            g_nm: self.mgb,
            m: self.muke,
            f: self.mef,
        }
    }
}

impl Complex {
    /// Counts of the complex as a sheet-metal part. O(all loops), see [`Complex::counts`].
    pub fn sheet_counts(&self) -> SheetCounts {
        let counts = self.counts();
        let of = |class| self.edges.iter().filter(|(_, e)| e.class == class).count() as i64;
        SheetCounts {
            s: counts.c,
            b: of(EdgeClass::Bend),
            e: of(EdgeClass::Free),
            w: of(EdgeClass::Weld),
            v: counts.v,
            g_nm: counts.ch - counts.r,
            m: counts.cc,
            f: counts.f,
        }
    }
}

impl Editor {
    /// A sequence that must change the counts as its name says; else it is taken back.
    fn strictly(
        &mut self,
        operator: &'static str,
        wanted: Delta,
        edit: impl FnOnce(&mut Self) -> Result<Outcome, Refusal>,
    ) -> Result<Outcome, Refusal> {
        self.transaction(|editor| {
            let outcome = edit(editor)?;
            if outcome.delta != wanted {
                let reason = Reason::WrongDelta { found: Box::new(outcome.delta), wanted: Box::new(wanted) };
                return Err(Refusal { operator, reason });
            }
            Ok(outcome)
        })
    }

    fn must_be_of(&self, operator: &'static str, edge: EdgeId, class: EdgeClass) -> Result<(), Refusal> {
        let found = self.complex().edge(edge).map_err(|reason| Refusal { operator, reason })?.class;
        if found == class { Ok(()) } else { Err(Refusal { operator, reason: Reason::WrongClass { edge } }) }
    }

    fn reclass(
        &mut self,
        operator: &'static str,
        edge: EdgeId,
        from: EdgeClass,
        to: EdgeClass,
    ) -> Result<Outcome, Refusal> {
        self.must_be_of(operator, edge, from)?;
        if to != EdgeClass::Free && self.complex().uses(edge).len() < 2 {
            let reason = Reason::NotJoint { edge, faces: self.complex().faces_of(edge) };
            return Err(Refusal { operator, reason });
        }
        self.apply(&Operation::SetEdgeClass { edge, class: to })
    }

    /// MCV (fig. 12a), make component and vertex: [`Self::make_vertex_complex`]. s +1, v +1.
    ///
    /// # Errors
    /// Those of it.
    pub fn mcv(&mut self, position: DVec3) -> Result<VertexId, Refusal> {
        self.make_vertex_complex(position)
    }

    /// MCV (fig. 12b), the split operation: the given edges leave the vertex for a new one, and the component falls in two.
    ///
    /// ```text
    ///    ╲ ╱          ╲       ╱
    ///     •      →     •     •
    ///    ╱ ╲          ╱       ╲
    /// ```
    /// s +1, v +1; v +1, C +1. Sequence: [`Self::split_vertex`].
    ///
    /// # Errors
    /// Those of it; [`Reason::WrongDelta`] where the parts still hang together.
    pub fn mcv_split(
        &mut self,
        vertex: VertexId,
        edges: &[EdgeId],
        position: DVec3,
    ) -> Result<Outcome, Refusal> {
        let wanted = Delta { v: 1, c: 1, ..Delta::default() };
        self.strictly("mcv_split", wanted, |editor| editor.split_vertex(vertex, edges, position))
    }

    /// KCV of [`Self::mcv`]: [`Self::kill_vertex_complex`]. s −1, v −1.
    ///
    /// # Errors
    /// Those of it.
    pub fn kcv(&mut self, vertex: VertexId) -> Result<Delta, Refusal> {
        self.kill_vertex_complex(vertex)
    }

    /// KCV of [`Self::mcv_split`]: two components become one at a vertex. s −1, v −1. Sequence: [`Self::merge_vertices`].
    ///
    /// # Errors
    /// Those of it; [`Reason::WrongDelta`] where they hang together already.
    pub fn kcv_join(&mut self, kept: VertexId, gone: VertexId) -> Result<Outcome, Refusal> {
        let wanted = Delta { v: -1, c: -1, ..Delta::default() };
        self.strictly("kcv_join", wanted, |editor| editor.merge_vertices(kept, gone))
    }

    /// MGB (fig. 14), make genus and bend: a bend from a loop of a face to another makes a hole of a ring. b +1, g_nm +1; e +1, r −1.
    ///
    /// # Errors
    /// Those of [`Self::make_edge_kill_ring`].
    pub fn mgb(&mut self, face: FaceId, from: Corner, to: Corner) -> Result<Outcome, Refusal> {
        self.apply(&Operation::MakeEdgeKillRing { face, from, to, class: EdgeClass::Bend })
    }

    /// KGB. b −1, g_nm −1; e −1, r +1.
    ///
    /// # Errors
    /// Those of [`Self::kill_edge_make_ring`]; [`Reason::WrongClass`] where it is no bend.
    pub fn kgb(&mut self, edge: EdgeId, ring: End) -> Result<Outcome, Refusal> {
        self.must_be_of("kgb", edge, EdgeClass::Bend)?;
        self.apply(&Operation::KillEdgeMakeRing { edge, ring })
    }

    /// MBKE (fig. 16a), make bend and kill free edge: an inner edge is called a bend. b +1, e −1.
    ///
    /// # Errors
    /// [`Reason::NoEdge`], [`Reason::WrongClass`] where it is not free; [`Reason::NotJoint`] with less than two uses.
    pub fn mbke(&mut self, edge: EdgeId) -> Result<Outcome, Refusal> {
        self.reclass("mbke", edge, EdgeClass::Free, EdgeClass::Bend)
    }

    /// KBME. b −1, e +1.
    ///
    /// # Errors
    /// [`Reason::NoEdge`], [`Reason::WrongClass`].
    pub fn kbme(&mut self, edge: EdgeId) -> Result<Outcome, Refusal> {
        self.reclass("kbme", edge, EdgeClass::Bend, EdgeClass::Free)
    }

    /// MWKB (fig. 16b), make weld and kill bend. w +1, b −1.
    ///
    /// # Errors
    /// [`Reason::NoEdge`], [`Reason::WrongClass`], [`Reason::NotJoint`].
    pub fn mwkb(&mut self, edge: EdgeId) -> Result<Outcome, Refusal> {
        self.reclass("mwkb", edge, EdgeClass::Bend, EdgeClass::Weld)
    }

    /// KWMB. w −1, b +1.
    ///
    /// # Errors
    /// [`Reason::NoEdge`], [`Reason::WrongClass`], [`Reason::NotJoint`].
    pub fn kwmb(&mut self, edge: EdgeId) -> Result<Outcome, Refusal> {
        self.reclass("kwmb", edge, EdgeClass::Weld, EdgeClass::Bend)
    }

    /// MUKE (fig. 15), make volume and kill free edge: two free edges with the same ends, the only entry to a volume, become one.
    /// e −1, m +1; e −1, Cc +1. Sequence: [`Self::unite_edges`].
    ///
    /// # Errors
    /// Those of it; [`Reason::WrongClass`]; [`Reason::WrongDelta`] where no volume is closed (fig. 6d: g_nm −1).
    pub fn muke(
        &mut self,
        kept: EdgeId,
        gone: EdgeId,
        order: Option<RadialOrder>,
    ) -> Result<Outcome, Refusal> {
        self.must_be_of("muke", kept, EdgeClass::Free)?;
        self.must_be_of("muke", gone, EdgeClass::Free)?;
        let wanted = Delta { e: -1, cc: 1, ..Delta::default() };
        self.strictly("muke", wanted, |editor| editor.unite_edges(kept, gone, order))
    }

    /// KUME: the given uses of a free edge hang on a new one, which opens a volume. e +1, m −1. Sequence: [`Self::divide_edge`].
    ///
    /// # Errors
    /// Those of it; [`Reason::WrongClass`]; [`Reason::WrongDelta`] where no volume is opened.
    pub fn kume(&mut self, edge: EdgeId, uses: &[FaceUse]) -> Result<Outcome, Refusal> {
        self.must_be_of("kume", edge, EdgeClass::Free)?;
        let wanted = Delta { e: 1, cc: -1, ..Delta::default() };
        self.strictly("kume", wanted, |editor| editor.divide_edge(edge, uses))
    }
}
