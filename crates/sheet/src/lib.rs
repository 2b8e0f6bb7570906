//! Sheets: models of thin parts without thickness, manifold or not.
//!
//! * [`mod@thicken`]: a sheet becomes a solid (Lee & Kim 2001).

pub mod thicken;
