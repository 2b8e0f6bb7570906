//! The designer: body, template and pattern in a window.
//!
//! [`Designer`] is the whole application; [`run`] opens it in a window of its own. All changes go through
//! `design::draft` commands, so everything can be undone and nothing is lost.

mod app;
mod jobs;
mod panels;
mod view;

pub use app::Designer;

/// Opens the window and returns when it is closed.
///
/// # Errors
/// What the system says when there is no display or no OpenGL.
pub fn run(designer: Designer) -> Result<(), eframe::Error> {
    let options = eframe::NativeOptions {
        viewport: eframe::egui::ViewportBuilder::default().with_inner_size([1280.0, 800.0]),
        ..eframe::NativeOptions::default()
    };
    eframe::run_native("toile", options, Box::new(|_| Ok(Box::new(designer))))
}
