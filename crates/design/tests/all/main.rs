//! Tests of the document: pipeline, drafts, drawings, reports.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod documentation;
mod draft;
mod drawings;
mod joint_configurations;
mod pipeline;
mod rename;
mod seams;
