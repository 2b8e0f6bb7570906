//! A window in a test, and hands for it.

use std::time::{Duration, Instant};

use design::draft::{Draft, FileKind};
use eframe::egui::{Event, Key, Modifiers, PointerButton, Pos2, Theme, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use tempfile::TempDir;
use window::{Designer, Start};

use crate::renderer::CpuRenderer;

pub(crate) const SIZE: [f32; 2] = [1280.0, 800.0];

/// A window with a folder of its own for journals and choices.
pub(crate) struct Window {
    pub(crate) harness: Harness<'static, Designer>,
    pub(crate) folder: TempDir,
}

impl Window {
    pub(crate) fn new(draft: Draft) -> Self {
        Self::open(draft, None, tempfile::tempdir().unwrap())
    }

    pub(crate) fn open(draft: Draft, file: Option<(std::path::PathBuf, FileKind)>, folder: TempDir) -> Self {
        Self::sized(SIZE, draft, file, folder)
    }

    pub(crate) fn sized(
        size: [f32; 2],
        draft: Draft,
        file: Option<(std::path::PathBuf, FileKind)>,
        folder: TempDir,
    ) -> Self {
        let start = Start { file, state: folder.path().join("state"), ..Start::new(draft) };
        Self::of(size, Designer::new(start), folder)
    }

    /// With the mesh that the design's body was read from.
    pub(crate) fn with_model(draft: Draft, model: mesh_kernel::TriMesh) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let state = folder.path().join("state");
        let start = Start { model: Some(model), state, ..Start::new(draft) };
        Self::of(SIZE, Designer::new(start), folder)
    }

    /// With this instead of the desktop's file dialog.
    pub(crate) fn with_dialog(draft: Draft, dialog: window::FileDialog) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let start = Start { state: folder.path().join("state"), ..Start::new(draft) };
        Self::of(SIZE, Designer::new(start).with_file_dialog(dialog), folder)
    }

    fn of(size: [f32; 2], designer: Designer, folder: TempDir) -> Self {
        let harness = Harness::builder()
            .with_size(size)
            .with_theme(Theme::Light)
            .with_step_dt(1.0 / 60.0)
            .with_max_steps(64)
            .renderer(CpuRenderer::default())
            .build_eframe(|_| designer);
        let mut window = Self { harness, folder };
        window.wait(Designer::is_idle);
        window
    }

    /// A sample of the project.
    pub(crate) fn sample(name: &str) -> Self {
        Self::new(sample(name))
    }

    pub(crate) fn draft(&self) -> &Draft {
        self.harness.state().draft()
    }

    pub(crate) fn message(&self) -> String {
        self.harness.state().message().unwrap_or_default().to_owned()
    }

    /// Some frames.
    pub(crate) fn steps(&mut self) {
        self.harness.run_steps(3);
    }

    pub(crate) fn wait(&mut self, until: impl Fn(&Designer) -> bool) {
        let started = Instant::now();
        loop {
            self.steps();
            if until(self.harness.state()) {
                break;
            }
            assert!(started.elapsed() < Duration::from_secs(60), "still waiting: {}", self.message());
            std::thread::sleep(Duration::from_millis(5));
        }
        self.steps();
    }

    pub(crate) fn key(&mut self, key: Key) {
        self.keys(Modifiers::NONE, key);
    }

    pub(crate) fn keys(&mut self, modifiers: Modifiers, key: Key) {
        self.harness.key_press_modifiers(modifiers, key);
        self.steps();
    }

    /// Clicks what has this name.
    pub(crate) fn click(&mut self, name: &str) {
        self.find(name).click();
        self.steps();
        self.harness.remove_cursor();
    }

    pub(crate) fn has(&self, name: &str) -> bool {
        self.harness.query_all_by_label(name).next().is_some()
    }

    /// The middle of what has this name.
    pub(crate) fn at(&self, name: &str) -> Pos2 {
        self.find(name).rect().center()
    }

    /// What has this name; the thing itself where the status line or the inspector speaks of it too.
    fn find<'a>(&'a self, name: &'a str) -> egui_kittest::Node<'a> {
        let thing = self.harness.query_by_role_and_label(eframe::egui::Role::GraphicsObject, name);
        thing.unwrap_or_else(|| self.harness.get_by_label(name))
    }

    /// Writes into a field instead of what it holds.
    pub(crate) fn write(&mut self, field: &str, text: &str) {
        self.harness.get_by_label(field).focus();
        self.steps();
        self.keys(Modifiers::COMMAND, Key::A);
        self.harness.get_by_label(field).type_text(text);
        self.steps();
    }

    /// A stroke of the primary button through these places, a frame a step.
    pub(crate) fn stroke(&mut self, through: &[Pos2]) {
        self.drag(PointerButton::Primary, through, 8, Modifiers::NONE);
    }

    pub(crate) fn drag(
        &mut self,
        button: PointerButton,
        through: &[Pos2],
        steps: usize,
        modifiers: Modifiers,
    ) {
        let press = |pos, pressed| Event::PointerButton { pos, button, pressed, modifiers };
        self.harness.event(Event::ModifiersChanged(modifiers));
        self.harness.event(Event::PointerMoved(through[0]));
        self.harness.step();
        self.harness.event(press(through[0], true));
        self.harness.step();
        for w in through.windows(2) {
            for k in 1..=steps {
                let at = w[0] + (w[1] - w[0]) * (k as f32 / steps as f32);
                self.harness.event(Event::PointerMoved(at));
                self.harness.step();
            }
        }
        let last = *through.last().unwrap();
        self.harness.event(press(last, false));
        self.harness.step();
        self.harness.event(Event::ModifiersChanged(Modifiers::NONE));
        self.steps();
        self.harness.remove_cursor();
    }

    pub(crate) fn wheel(&mut self, at: Pos2, lines: f32) {
        self.harness.event(Event::PointerMoved(at));
        self.harness.event(Event::MouseWheel {
            unit: eframe::egui::MouseWheelUnit::Line,
            delta: Vec2::new(0.0, lines),
            modifiers: Modifiers::NONE,
            phase: eframe::egui::TouchPhase::Move,
            source: eframe::egui::MouseWheelSource::Wheel,
        });
        self.harness.run_steps(20);
    }
}

impl Window {
    /// A click of the primary button at a place.
    pub(crate) fn stroke_click(&mut self, at: Pos2) {
        self.drag(PointerButton::Primary, &[at], 1, Modifiers::NONE);
    }

    /// Runs an action by its name, as the palette does.
    pub(crate) fn action(&mut self, name: &str) {
        self.keys(Modifiers::COMMAND, Key::P);
        self.harness.get_by_label("Find an action").type_text(name);
        self.steps();
        self.key(Key::Enter);
    }

    /// All names of what can be found.
    pub(crate) fn labels(&self) -> Vec<String> {
        use egui_kittest::kittest::NodeT as _;
        let all = self.harness.root().children_recursive();
        let name = |n: egui_kittest::Node<'_>| {
            let node = n.accesskit_node();
            let text = if node.role() == eframe::egui::Role::Label { node.value() } else { node.label() };
            text.map(|l| l.to_string())
        };
        all.filter_map(name).collect()
    }

    /// Where the slider with this text is.
    pub(crate) fn slider(&self, text: &str) -> eframe::egui::Rect {
        self.harness.get_by_role_and_label(eframe::egui::Role::Slider, text).rect()
    }
}

/// A file that the system hands over.
#[derive(Debug)]
struct Dropped(std::path::PathBuf);

impl eframe::egui::DroppedFile for Dropped {
    fn path(&self) -> &std::path::Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|e| e.to_string())
    }
}

impl Window {
    /// Drops a file on the window.
    pub(crate) fn drop_on(&mut self, path: &std::path::Path) {
        self.harness.input_mut().dropped_files.push(std::sync::Arc::new(Dropped(path.to_owned())));
        self.steps();
    }
}

/// A sample of the project.
pub(crate) fn sample(name: &str) -> Draft {
    let path = format!("{}/../../samples/{name}", env!("CARGO_MANIFEST_DIR"));
    Draft::from_bytes(&std::fs::read(path).unwrap()).unwrap()
}

impl Window {
    /// Where one writes into the field of this name.
    pub(crate) fn field(&self, name: &str) -> Pos2 {
        self.harness.get_by_role_and_label(eframe::egui::Role::TextInput, name).rect().center()
    }

    /// The keyboard belongs to no field any more.
    pub(crate) fn away(&mut self) {
        self.key(Key::Escape);
    }
}

impl Window {
    /// Presses the primary button and moves on, without letting go.
    pub(crate) fn hold(&mut self, through: &[Pos2]) {
        self.harness.event(Event::PointerMoved(through[0]));
        self.harness.event(press(through[0], true));
        for at in through {
            self.harness.event(Event::PointerMoved(*at));
        }
        self.steps();
    }

    /// Moves there and lets go.
    pub(crate) fn let_go(&mut self, at: Pos2) {
        self.harness.event(Event::PointerMoved(at));
        self.harness.event(press(at, false));
        self.steps();
        self.harness.remove_cursor();
    }

    /// Long enough for a preview.
    pub(crate) fn pause(&mut self) {
        let started = Instant::now();
        while started.elapsed() < Duration::from_millis(1500) {
            self.steps();
            std::thread::sleep(Duration::from_millis(20));
        }
    }
}

fn press(pos: Pos2, pressed: bool) -> Event {
    Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers: Modifiers::NONE }
}
