//! How fast the view turns: `cargo run --release -p window --example orbit -- [BODY_TRIANGLES] [cpu]`.
//!
//! Opens the window with a sample dress on a dress form of so many triangles, drags the eye round with a button that is
//! never let go, and tells how long frames took, without waiting for the screen.

#![allow(clippy::print_stdout, reason = "a measurement speaks")]

use std::sync::Arc;
use std::time::{Duration, Instant};

use design::draft::{BodySource, Draft, Mesh};
use eframe::egui::{self, Event, Modifiers, PointerButton, pos2};
use reference::dress_form::{DressForm, FormOptions, Measurements};
use window::{Designer, Start};

/// The designer under an unresting hand.
struct Turning {
    designer: Designer,
    started: Instant,
    ready: Option<Instant>,
    frame: usize,
    last: Instant,
    times: Vec<Duration>,
    /// Spent in the interface's own code, without tessellation and painting.
    own: Duration,
}

const FRAMES: usize = 300;

impl eframe::App for Turning {
    fn raw_input_hook(&mut self, _: &egui::Context, input: &mut egui::RawInput) {
        if self.ready.is_none() {
            return;
        }
        let x = 500.0 + 100.0 * (0.05 * self.frame as f32).sin();
        let pos = pos2(x, 400.0 + 20.0 * (0.03 * self.frame as f32).cos());
        input.events.push(Event::PointerMoved(pos));
        if self.frame == 1 {
            let (button, modifiers) = (PointerButton::Secondary, Modifiers::NONE);
            input.events.push(Event::PointerButton { pos, button, pressed: true, modifiers });
        }
    }

    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        self.designer.clear_color(visuals)
    }

    fn logic(&mut self, context: &egui::Context, frame: &mut eframe::Frame) {
        self.designer.logic(context, frame);
    }

    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut eframe::Frame) {
        let began = Instant::now();
        self.designer.ui(ui, frame);
        let now = Instant::now();
        if self.ready.is_some() {
            self.own += now - began;
        }
        if self.ready.is_none() && self.designer.is_built() {
            println!("built {:.2} s after the start", self.started.elapsed().as_secs_f64());
            self.ready = Some(now);
        }
        if self.ready.is_some() {
            self.frame += 1;
            if self.frame > 20 {
                self.times.push(now - self.last);
            }
        }
        self.last = now;
        if self.times.len() == FRAMES {
            self.times.sort();
            let ms = |k: usize| 1000.0 * self.times[k].as_secs_f64();
            let mean = self.times.iter().sum::<Duration>().as_secs_f64() / FRAMES as f64;
            println!(
                "{:.1} frames a second; a frame {:.1} ms in the middle, {:.1} ms at most for 95 of 100",
                1.0 / mean,
                ms(FRAMES / 2),
                ms(FRAMES * 95 / 100)
            );
            println!(
                "of which {:.1} ms before tessellation",
                1000.0 * self.own.as_secs_f64() / self.frame as f64
            );
            ui.ctx().send_viewport_cmd(egui::ViewportCommand::Close);
        }
        ui.ctx().request_repaint();
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut words = std::env::args().skip(1);
    let triangles: usize = words.next().as_deref().unwrap_or("20000").parse()?;
    let by_processor = words.next().as_deref() == Some("cpu");
    let text = std::fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/../../samples/princess-dress.json"))?;
    let mut draft = Draft::from_bytes(&text)?;
    let options = FormOptions { triangles, ..FormOptions::default() };
    let form = DressForm::build(&Measurements::default(), &options)?.mesh;
    let positions = form.positions.iter().map(|p| p.to_array()).collect();
    println!("a dress of 11648 triangles on a body of {}", form.faces.len());
    draft.body = Arc::new(BodySource::Mesh(Mesh { file: "form".to_owned(), positions, faces: form.faces }));
    let state = std::env::temp_dir().join(format!("toile-orbit-{}", std::process::id()));
    let designer = Designer::new(Start { state, ..Start::new(draft) });
    let mut native = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default().with_inner_size([1280.0, 800.0]),
        depth_buffer: 24,
        dithering: false,
        ..eframe::NativeOptions::default()
    };
    native.glow_options.vsync = false;
    let now = Instant::now();
    let turn = move |context: &eframe::CreationContext<'_>| {
        let designer = if by_processor { designer } else { designer.with_context(context) };
        Turning {
            designer,
            started: now,
            ready: None,
            frame: 0,
            last: now,
            times: Vec::new(),
            own: Duration::ZERO,
        }
    };
    eframe::run_native("orbit", native, Box::new(|context| Ok(Box::new(turn(context)))))?;
    Ok(())
}
