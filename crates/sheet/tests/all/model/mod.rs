//! Modelling functions of sheets.

mod experiments;
mod functions;
mod support;
