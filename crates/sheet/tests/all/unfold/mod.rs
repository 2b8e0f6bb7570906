//! Bends, and sheets laid flat.

mod bends;
mod plates;
mod support;
