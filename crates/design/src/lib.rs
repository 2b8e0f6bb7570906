//! The document and the pipeline: template and body in, garment, pattern, pictures and report out.
//!
//! * [`modelling`]: scripts of modelling commands; [`drawings`]: scripts of drawings, drawings of scripts;
//! * [`mod@regenerate`]: features → construction → flattening → pieces → files;
//! * [`batch`]: the same for many bodies;
//! * [`draft`]: a design that is being made: commands, undo, journal, autosave;
//! * [`report`]: the keys of `report.json`;
//! * [`document`]: the file `design.toile`;
//! * [`pictures`]: front, back, pattern, features, any model;
//! * [`model_info`]: what a model holds;
//! * [`mod@thicken`]: a sheet to a solid's file;
//! * [`mod@deflate`]: a solid to its mid-surface's file;
//! * [`sheet_metal`]: bends, welds and flat plates of a sheet;
//! * [`units`]: what a file's numbers mean;
//! * [`output`]: files made in memory, then written.

pub mod batch;
pub mod deflate;
pub mod document;
pub mod draft;
pub mod drawings;
mod fingerprint;
mod garment_pattern;
pub mod model_info;
pub mod modelling;
pub mod output;
pub mod pictures;
pub mod regenerate;
pub mod report;
pub mod sheet_metal;
pub mod thicken;
pub mod units;
