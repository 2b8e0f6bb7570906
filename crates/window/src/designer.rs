//! The application: a session, what follows from it, and the frame.

use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use design::draft::{
    Command, Draft, Edit, EditError, FileKind, History, Journal, Recovery, SourceFile, recoveries,
    state_folder,
};
use design::regenerate::Regenerated;
use eframe::egui;
use eframe::glow;
use mesh_kernel::TriMesh;

use crate::actions::remedy;
use crate::board::Board;
use crate::browsing::{Browsing, FileDialog, system_dialog};
use crate::jobs::{Body, Builder, Cloth, FileJob};
use crate::model::Model;
use crate::naming::Naming;
use crate::notices::{Answer, Notice, Notices};
use crate::panels::pattern::PatternView;
use crate::preferences::{Preferences, Theme};
pub(crate) use crate::prompts::Prompt;
use crate::region::Region;
use crate::selection::{Element, Mode};
use crate::session::Session;
use crate::tools::{Drawing, Effect, Event, Machine, Tool, World};
use crate::view::pick::Picker;
use crate::view::scene::{Look, Section};
use crate::view::{GlPainter, View};
use crate::workspace::Workspace;

/// What a window begins with.
#[derive(Debug)]
pub struct Start {
    /// The design.
    pub draft: Draft,
    /// The file that it came from, and what that is.
    pub file: Option<(PathBuf, FileKind)>,
    /// The mesh that the design's body was read from, with its groups: shown as it is when it is no body.
    pub model: Option<TriMesh>,
    /// Where work in progress and choices are kept.
    pub state: PathBuf,
}

impl Start {
    /// A design without a file, with the state where it usually is.
    pub fn new(draft: Draft) -> Self {
        Self { draft, file: None, model: None, state: state_folder() }
    }
}

/// What of the latest draft is still to be made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Stale {
    Nothing,
    /// A preview, while something is dragged.
    Rough,
    Whole,
}

/// The designer.
pub struct Designer {
    pub(crate) session: Session,
    pub(crate) model: Model,
    pub(crate) view: View,
    pub(crate) look: Look,
    pub(crate) tool: Tool,
    pub(crate) machine: Box<dyn Machine>,
    pub(crate) drawing: Drawing,
    pub(crate) workspace: Workspace,
    pub(crate) board: Board,
    pub(crate) notices: Notices,
    pub(crate) preferences: Preferences,
    pub(crate) prompt: Option<Prompt>,
    pub(crate) palette: Option<String>,
    pub(crate) pattern: PatternView,
    /// The pattern made last: it stays to be seen while something is dragged.
    pub(crate) last_made: Option<Arc<Regenerated>>,
    /// How many layouts were taken: each has panels of its own.
    pub(crate) layouts_taken: usize,
    pub(crate) naming: Naming,
    /// A field had the keyboard in the frame before.
    pub(crate) was_typing: bool,
    pub(crate) file_dialog: FileDialog,
    pub(crate) browsing: Option<Browsing>,
    /// What is under the pointer, in whichever view.
    pub(crate) hovered: Option<Element>,
    /// The seam under the pointer in the pattern.
    pub(crate) hovered_seam: Option<usize>,
    pub(crate) builder: Builder,
    pub(crate) file_job: Option<FileJob>,
    /// A folder to export to as soon as the garment is built.
    pub(crate) export_to: Option<PathBuf>,
    pub(crate) state: PathBuf,
    /// The mesh of the first body, with its groups.
    pub(crate) first_mesh: Option<TriMesh>,
    pub(crate) may_close: bool,
    /// What the eye turns about while it is turned.
    pub(crate) pivot: Option<glam::DVec3>,
    pub(crate) stale: Stale,
    /// The draft whose garment is shown, whole.
    pub(crate) built: Option<Arc<Draft>>,
    /// The body that the view has, and how it is cut.
    pub(crate) shown_body: Option<(Arc<Body>, Option<Section>)>,
    pub(crate) kept: VecDeque<(Arc<Draft>, Arc<Body>, Arc<Cloth>)>,
    gl: Option<Arc<glow::Context>>,
    pub(crate) is_framed: bool,
}

impl Designer {
    /// A designer at work.
    pub fn new(start: Start) -> Self {
        let preferences = Preferences::load(&start.state);
        let found = recoveries(&start.state);
        let file = start.file.map(|(path, kind)| match std::fs::read(&path) {
            Ok(bytes) => SourceFile::holding(path, kind, &bytes),
            Err(_) => SourceFile { path, kind, fingerprint: None },
        });
        let mut designer = Self {
            session: Session::new(History::new(start.draft), file, true, &start.state),
            model: Model::default(),
            view: View::new(None),
            look: Look::default(),
            tool: Tool::Select,
            machine: Tool::Select.start(),
            drawing: Drawing::default(),
            workspace: Workspace::default(),
            board: Board::default(),
            notices: Notices::default(),
            preferences,
            prompt: None,
            palette: None,
            pattern: PatternView::default(),
            last_made: None,
            layouts_taken: 0,
            naming: Naming::default(),
            was_typing: false,
            file_dialog: system_dialog,
            browsing: None,
            hovered: None,
            hovered_seam: None,
            builder: Builder::start(),
            file_job: None,
            export_to: None,
            state: start.state,
            first_mesh: start.model,
            may_close: false,
            pivot: None,
            stale: Stale::Whole,
            built: None,
            shown_body: None,
            kept: VecDeque::new(),
            gl: None,
            is_framed: false,
        };
        if let Some(file) = &designer.session.file {
            let path = file.path.clone();
            designer.prefer(|p| p.remember(&path));
        }
        if !found.is_empty() {
            designer.prompt = Some(Prompt::recovery(found));
        }
        designer
    }

    /// Takes what the window offers: its theme, and OpenGL where there is some.
    pub fn with_context(mut self, context: &eframe::CreationContext<'_>) -> Self {
        self.gl = context.gl.clone();
        if !self.preferences.software {
            self.view.set_painter(self.gl.as_deref().and_then(GlPainter::new));
        }
        self.apply_theme(&context.egui_ctx);
        self
    }

    /// Another dialog for paths than the desktop's.
    #[must_use]
    pub fn with_file_dialog(self, file_dialog: FileDialog) -> Self {
        Self { file_dialog, ..self }
    }

    /// The draft as it is.
    pub fn draft(&self) -> &Draft {
        self.session.draft()
    }

    /// Whether the garment that is shown is that of the latest draft, pattern and all.
    pub fn is_built(&self) -> bool {
        let is_latest = self.built.as_ref().is_some_and(|b| Arc::ptr_eq(b, self.session.draft()));
        is_latest && self.model.cloth.as_ref().is_some_and(|c| c.made.is_some())
    }

    /// Whether the body, or the mesh that is none, is there, and nothing is being built.
    pub fn is_idle(&self) -> bool {
        self.stale == Stale::Nothing
            && self.builder.step().is_none()
            && (self.model.body.is_some() || self.model.seen.is_some())
            && self.file_job.is_none()
    }

    /// How many pieces the pattern has that is shown.
    pub fn pieces(&self) -> usize {
        let made = self.model.cloth.as_ref().and_then(|c| c.made.as_ref());
        made.map_or(0, |m| m.pattern.pieces.len())
    }

    /// The newest message.
    pub fn message(&self) -> Option<&str> {
        self.notices.last()
    }

    pub(crate) fn problem(&mut self, text: impl Into<String>) {
        self.notices.push(Notice::problem(text));
    }

    pub(crate) fn command(&mut self, command: Command) {
        let before = Arc::clone(self.session.draft());
        let done = self.session.apply(command);
        self.after(&before, done, Stale::Whole);
    }

    pub(crate) fn edit(&mut self, edit: Edit) {
        self.command(Command::Edit(edit));
    }

    /// A step of a drag that `gesture` names.
    pub(crate) fn live(&mut self, gesture: egui::Id, edit: Edit) {
        let before = Arc::clone(self.session.draft());
        let done = self.session.live(gesture, edit);
        self.after(&before, done, Stale::Rough);
    }

    /// The drag is over.
    pub(crate) fn settle(&mut self) {
        // What is dragged on the board has no part in the garment.
        if self.session.settle() && self.workspace == Workspace::Garment {
            self.stale = Stale::Whole;
        }
    }

    fn after(&mut self, before: &Arc<Draft>, done: Result<(), EditError>, stale: Stale) {
        match done {
            Ok(()) if self.session.draft().has_garment_of(before) => {
                self.notices.forget_problems();
                if self.built.as_ref().is_some_and(|built| Arc::ptr_eq(built, before)) {
                    self.built = Some(Arc::clone(self.session.draft()));
                }
                self.follow_drawing();
            }
            Ok(()) => {
                self.notices.forget_problems();
                self.stale = self.stale.max(stale);
                self.follow();
            }
            Err(e) => {
                let notice = Notice::problem(e.to_string());
                self.notices.push(match e {
                    EditError::Used { kind: "node", name, .. } => notice.about(Element::Node(name)),
                    EditError::Held { joint, .. } => notice.about(Element::Joint(joint)),
                    EditError::Edge { from, to, .. } => {
                        notice.with_remedy(remedy::FACE_TOOL).about(Element::edge(&from, &to))
                    }
                    _ => notice,
                });
            }
        }
    }

    /// Shows things in another way.
    pub(crate) fn relook(&mut self, change: impl FnOnce(&mut Look)) {
        change(&mut self.look);
        self.show_solids();
    }

    pub(crate) fn toggle_painter(&mut self) {
        let software = self.view.is_by_gl();
        let painter = if software { None } else { self.gl.as_deref().and_then(GlPainter::new) };
        if !software && painter.is_none() {
            self.problem("there is no OpenGL here that could draw the view");
            return;
        }
        self.view.set_painter(painter);
        self.prefer(|p| p.software = software);
    }

    pub(crate) fn prefer(&mut self, change: impl FnOnce(&mut Preferences)) {
        change(&mut self.preferences);
        self.preferences.save(&self.state);
    }

    pub(crate) fn apply_theme(&self, context: &egui::Context) {
        context.set_theme(match self.preferences.theme {
            Theme::System => egui::ThemePreference::System,
            Theme::Light => egui::ThemePreference::Light,
            Theme::Dark => egui::ThemePreference::Dark,
        });
    }

    pub(crate) fn take_tool(&mut self, tool: Tool) {
        self.tool = tool;
        self.machine = tool.start();
        self.notices.forget_problems();
        self.session.selection.replace(Vec::new());
    }

    pub(crate) fn take_mode(&mut self, mode: Mode) {
        self.session.mode = mode;
        self.take_tool(Tool::Select);
    }

    pub(crate) fn toggle_mirror(&mut self) {
        let t = &self.draft().template;
        let edit = Edit::SetTemplate {
            name: t.name.clone(),
            clearance: t.clearance,
            level: t.level,
            mirrored: !t.mirrored,
        };
        self.edit(edit);
    }

    pub(crate) fn select_all(&mut self) {
        let far = glam::DVec2::splat(1e9);
        let everything = Region::Box(-far, far);
        let mode = self.session.mode;
        let picker = Picker { x_ray: true, ..self.picker() };
        let all = picker.within(&everything, mode);
        self.session.selection.replace(all);
    }

    pub(crate) fn frame_all(&mut self) {
        let of = |mesh: &mesh_kernel::TriMesh| mesh.positions.clone();
        let garment = self.model.cloth.as_ref().filter(|_| self.look.garment).map(|c| of(&c.mesh));
        let body = self.model.body.as_ref().map(|b| of(&b.on.body.mesh));
        let body = body.or(self.model.seen.as_ref().map(|s| of(&s.mesh)));
        if let Some(places) = garment.filter(|_| !self.look.body).or(body) {
            self.view.eye.frame(places);
        }
    }

    pub(crate) fn frame_selection(&mut self) {
        let places: Vec<glam::DVec3> = self
            .session
            .selection
            .elements
            .iter()
            .flat_map(|e| e.places(self.session.draft(), &self.model.places))
            .collect();
        if places.is_empty() { self.frame_all() } else { self.view.eye.frame(places) }
    }

    pub(crate) fn stop(&mut self) {
        if let Some(job) = self.file_job.take() {
            if job.stop() {
                self.notices.say(format!("{}: stopped, and nothing is written", job.what));
            } else {
                // It says so itself in a moment.
                self.file_job = Some(job);
            }
            return;
        }
        self.builder.cancel();
        self.export_to = None;
        self.notices.say("stopped; the garment shown is that of an earlier design until the next change");
    }

    pub(crate) fn picker(&self) -> Picker<'_> {
        Picker {
            eye: &self.view.eye,
            solids: &self.view.solids,
            places: &self.model.places,
            wires: &self.model.wires,
            x_ray: self.look.x_ray,
        }
    }

    pub(crate) fn world(&self, pixel_scale: f64) -> World<'_> {
        World {
            draft: self.session.draft(),
            model: &self.model,
            picker: self.picker(),
            selection: &self.session.selection,
            mode: self.session.mode,
            surface: &self.session.surface,
            drawing: self.drawing,
            pixel_scale,
        }
    }

    /// Gives the tool an event, and does what it answers.
    pub(crate) fn tool_event(&mut self, event: Event) {
        self.tool_event_at(event, 1.0);
    }

    pub(crate) fn tool_event_at(&mut self, event: Event, pixel_scale: f64) {
        let mut machine = std::mem::replace(&mut self.machine, Tool::Select.start());
        let effects = machine.on(event, &self.world(pixel_scale));
        self.machine = machine;
        let gesture = egui::Id::unique("3D view drag");
        for effect in effects {
            match effect {
                Effect::Edit(edit) => self.edit(edit),
                Effect::Live(edit) => self.live(gesture, edit),
                Effect::Settle => self.settle(),
                Effect::Select(elements) => self.select(elements),
                Effect::Toggle(elements) => self.session.selection.toggle(elements),
                Effect::Problem(text) => self.problem(text),
            }
        }
    }

    /// Selects; the surface of a face becomes the one that new faces go to.
    pub(crate) fn select(&mut self, elements: Vec<Element>) {
        if let [Element::Face { surface, .. }] = &elements[..] {
            self.session.surface.clone_from(surface);
        }
        self.session.selection.replace(elements);
    }
}

impl eframe::App for Designer {
    /// The ground of panels and view, which draw none of their own.
    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        visuals.panel_fill.to_normalized_gamma_f32()
    }

    fn logic(&mut self, context: &egui::Context, _frame: &mut eframe::Frame) {
        let is_dark = context.theme() == egui::Theme::Dark;
        if self.look.is_dark != is_dark {
            self.look.is_dark = is_dark;
            self.show_lines();
        }
        if context.input(|i| i.viewport().close_requested()) && !self.may_close && self.session.is_unsaved() {
            context.send_viewport_cmd(egui::ViewportCommand::CancelClose);
            self.ask(crate::prompts::Next::Quit);
        }
        if self.may_close {
            context.send_viewport_cmd(egui::ViewportCommand::Close);
        }
    }

    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        let context = ui.ctx().clone();
        // The window is cleared to the panels' colour: panels in panels would lay it on again and again.
        ui.visuals_mut().panel_fill = egui::Color32::TRANSPARENT;
        let dropped = context.input(|i| i.raw.dropped_files.first().map(|f| f.path().to_path_buf()));
        if let Some(path) = dropped {
            self.ask(crate::prompts::Next::Open(path));
        }
        // A drag is over when no button is down, even when what was dragged is no longer on the screen.
        if !context.input(|i| i.pointer.any_down() || i.pointer.any_released()) {
            self.settle();
        }
        self.refresh(&context);
        self.keys(&context);
        self.hovered_seam = None;
        let hovered = self.hovered.take();
        self.panels(ui);
        egui::CentralPanel::no_frame().show(ui, |ui| match self.workspace {
            Workspace::Garment => self.canvas(ui),
            Workspace::Drawing => self.board_canvas(ui),
        });
        if self.hovered != hovered {
            context.request_repaint();
        }
        self.show_palette(&context);
        self.show_prompt(&context);
        match self.notices.show(&context) {
            Some(Answer::Remedy(action)) => self.run_action(action, &context),
            Some(Answer::Show(element)) => {
                self.session.selection.replace(vec![element]);
                self.frame_selection();
            }
            None => {}
        }
        if self.stale != Stale::Nothing {
            context.request_repaint();
        }
        if self.builder.step().is_some() || self.file_job.is_some() {
            // The progress bar moves.
            context.request_repaint_after(Duration::from_millis(200));
        }
    }

    fn on_exit(&mut self, gl: Option<&glow::Context>) {
        self.preferences.save(&self.state);
        if let Some(gl) = gl {
            self.view.destroy(gl);
        }
    }
}

/// Work that an earlier run left, with what is known of it.
pub(crate) fn describe(recovery: &Recovery) -> String {
    let age =
        std::fs::metadata(&recovery.path).and_then(|m| m.modified()).ok().and_then(|t| t.elapsed().ok());
    let age = age.map_or_else(String::new, |a| match a.as_secs() / 60 {
        0 => ", a moment ago".to_owned(),
        m if m < 120 => format!(", {m} minutes ago"),
        m if m < 48 * 60 => format!(", {} hours ago", m / 60),
        m => format!(", {} days ago", m / (24 * 60)),
    });
    match recovery.open() {
        Ok(Journal { history, file }) => {
            let last = history.undo_label().unwrap_or("nothing changed").to_owned();
            let of = file.map_or_else(String::new, |f| format!(" of {}", f.path.display()));
            format!(
                "{}: {} changes{of}, the last: {last}{age}",
                history.draft().template.name,
                history.labels().1
            )
        }
        Err(e) => format!("a journal that cannot be read{age}: {e}"),
    }
}
