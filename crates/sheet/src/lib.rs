//! Sheets: models of thin parts without thickness, manifold or not.
//!
//! * [`bends`]: bends and welds, counts, whether one piece will do (Lipson & Shpitalni);
//! * [`mod@deflate`]: a thin solid becomes its mid-surface (Sheen et al. 2008);
//! * [`facets`]: what is a facet, a line, a vertex of a sheet;
//! * [`model`]: wires, sheets and solids made by commands, and scripts of these;
//! * [`mod@thicken`]: a sheet becomes a solid (Lee & Kim 2001).
//! * [`mod@unfold`]: flat plates with bend lines.

pub mod bends;
mod cleaning;
pub mod deflate;
pub mod facets;
pub mod model;
pub mod thicken;
pub mod unfold;
