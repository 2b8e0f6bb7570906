//! Sheets: models of thin parts without thickness, manifold or not.
//!
//! * [`mod@thicken`]: a sheet becomes a solid (Lee & Kim 2001);
//! * [`mod@deflate`]: a thin solid becomes its mid-surface (Sheen et al. 2008).

pub mod deflate;
pub mod thicken;
mod weld;
