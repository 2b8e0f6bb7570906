//! The window as people use it: by names, keys and the mouse, without a display.

// A test that cannot go on fails.
#![allow(clippy::unwrap_used)]

mod board;
mod browsing;
mod files;
mod from_nothing;
mod hand;
mod keyboard;
mod layout;
mod names;
mod pictures;
mod renderer;
mod support;
mod tools;
