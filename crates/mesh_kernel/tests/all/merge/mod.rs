//! Booleans of solids.

mod boolean;
mod degenerate;
mod models;
mod support;
