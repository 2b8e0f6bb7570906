//! Tests of references: dress forms and human bodies.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod dress_form;
mod dress_form_tape;
mod human_changes;
mod human_common;
mod human_refusals;
mod human_shared;
