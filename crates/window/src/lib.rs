//! The designer: body, template and pattern in a window.
//!
//! [`Designer`] is the whole application; [`run`] opens it in a window of its own. All changes go through
//! `design::draft` commands, so everything can be undone and nothing is lost.
//!
//! * `session`: the history, its file, the selection; `model`: what follows from the draft; `jobs`: work in the background;
//! * `tools`: state machines from events to effects; `actions`: everything that can be done by name;
//! * `board`: the drawing in the plane, its tools and its panels;
//! * `view`: the eye, the draw list and its two painters; `canvas`, `panels`, `prompts`: what is on the screen.

mod actions;
mod board;
mod browsing;
mod canvas;
mod deletion;
mod designer;
mod dialogs;
mod files;
mod following;
mod jobs;
mod layout;
#[cfg(test)]
mod measure;
mod model;
mod naming;
mod notices;
mod panels;
mod preferences;
mod prompts;
mod region;
mod selection;
mod session;
mod tools;
mod units;
mod view;
mod workshop;
mod workspace;

pub use browsing::{FileDialog, FileWish, PathKind};
pub use designer::{Designer, Start};

/// Opens the window and returns when it is closed.
///
/// # Errors
/// What the system says when there is no display or no OpenGL.
pub fn run(designer: Designer) -> Result<(), eframe::Error> {
    let options = eframe::NativeOptions {
        viewport: eframe::egui::ViewportBuilder::default()
            .with_app_id("toile")
            .with_inner_size([1280.0, 800.0])
            .with_drag_and_drop(true),
        depth_buffer: 24,
        // The interface is flat: there is nothing to dither, and it costs at every pixel.
        dithering: false,
        ..eframe::NativeOptions::default()
    };
    eframe::run_native("toile", options, Box::new(|context| Ok(Box::new(designer.with_context(context)))))
}
