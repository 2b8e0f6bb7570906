//! Sheets made thick.

mod chain;
mod sheet_models;
mod solids;
