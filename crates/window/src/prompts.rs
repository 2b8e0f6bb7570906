//! Questions in front of the window: unsaved work, files, folders, recovery, the sheet of keys.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use design::draft::{BodySource, Draft, Edit, FileKind, History, Recovery};
use eframe::egui;

use crate::actions::{actions, remedy};
use crate::designer::{Designer, describe};
use crate::files::{self, LIBRARY, Opened, kind_of_name};
use crate::jobs::FileJob;
use crate::notices::Notice;
use crate::session::{OnDisk, Session};

/// What is done once unsaved work is safe or given up.
#[derive(Clone, Debug)]
pub(crate) enum Next {
    New,
    Library(usize),
    Open(PathBuf),
    Quit,
}

/// What a path is asked for.
#[derive(Clone, Debug)]
pub(crate) enum Purpose {
    Open,
    /// With what to do then.
    SaveAs(Option<Next>),
    Export,
    Thicken(f64),
}

/// A question.
pub(crate) enum Prompt {
    Unsaved(Next),
    Recovery(Vec<(Recovery, String)>),
    Path { purpose: Purpose, text: String, note: String },
    Keys,
}

impl Prompt {
    pub(crate) fn recovery(found: Vec<Recovery>) -> Self {
        Self::Recovery(found.into_iter().map(|r| (r.clone(), describe(&r))).collect())
    }
}

/// What a person answered.
enum Answer {
    None,
    Close,
    Save(Next),
    GiveUp(Next),
    Recover(Recovery),
    Discard(Recovery),
    Path(Purpose, PathBuf),
}

impl Designer {
    /// Does something that ends the work on this design: asks first when some of it is not saved.
    pub(crate) fn ask(&mut self, next: Next) {
        // A body's mesh becomes a part of the design, and can be undone.
        let is_body =
            matches!(&next, Next::Open(path) if mesh_kernel::files::Format::of_path(path).is_some());
        if self.session.is_unsaved() && !is_body {
            self.prompt = Some(Prompt::Unsaved(next));
        } else {
            self.go_on(next);
        }
    }

    fn go_on(&mut self, next: Next) {
        match next {
            Next::Quit => self.may_close = true,
            Next::New => self.begin(History::new(Draft::empty()), None, true),
            Next::Library(k) => {
                let Some((name, text)) = LIBRARY.get(k) else { return };
                match Draft::from_bytes(text.as_bytes()) {
                    Ok(draft) => {
                        self.begin(History::new(draft), None, true);
                        self.notices.say(format!("{name}, on the average form"));
                    }
                    Err(e) => self.problem(e.to_string()),
                }
            }
            Next::Open(path) => self.open(&path),
        }
    }

    /// Opens a file; when it is bad, nothing changes.
    fn open(&mut self, path: &Path) {
        match files::open(path) {
            Ok(Opened::Design { history, kind }) => {
                let name = history.draft().template.name.clone();
                self.begin(history, Some(OnDisk { path: path.to_owned(), kind }), true);
                self.notices.say(format!("opened {name}, {}", kind.words()));
            }
            Ok(Opened::Journal(history)) => {
                self.begin(history, None, false);
                self.notices.say("opened the work that a journal holds; it is not saved yet");
            }
            Ok(Opened::Body(mesh)) => {
                self.edit(Edit::SwitchBody { body: Arc::new(BodySource::Mesh(mesh)) });
                self.notices.say(format!("{} is the body now; undo takes the one before", path.display()));
            }
            Err(e) => return self.notices.push(Notice::problem(e).with_remedy(remedy::OPEN)),
        }
        self.prefer(|p| p.remember(path));
    }

    /// Another design: with a history and a journal of its own.
    fn begin(&mut self, history: History, file: Option<OnDisk>, is_saved: bool) {
        self.session = Session::new(history, file, is_saved, &self.state);
        self.take_tool(self.tool);
        self.forget_garments();
    }

    pub(crate) fn save(&mut self) {
        match self.session.file.clone() {
            Some(OnDisk { path, kind: FileKind::Draft }) => {
                self.save_to(&path);
            }
            Some(OnDisk { path, kind }) => self.prompt_save_as(Some(format!(
                "{} is {}. A draft keeps the body, loose edges and drawn curves too.",
                path.display(),
                kind.words()
            ))),
            None => self.prompt_save_as(None),
        }
    }

    fn save_to(&mut self, path: &Path) -> bool {
        match files::save(self.session.draft(), path) {
            Ok(kind) => {
                self.session.saved_to(OnDisk { path: path.to_owned(), kind });
                self.prefer(|p| p.remember(path));
                let left_out = files::left_out(self.draft()).filter(|_| kind == FileKind::Template);
                let left_out = left_out.map_or_else(String::new, |l| format!("; a template is without {l}"));
                self.notices.say(format!("saved {}{left_out}", path.display()));
                true
            }
            Err(e) => {
                self.notices.push(Notice::problem(e).with_remedy(remedy::SAVE_AS));
                false
            }
        }
    }

    pub(crate) fn prompt_open(&mut self) {
        let folder = self.session.beside("");
        let folder = std::path::absolute(&folder).or_else(|_| std::env::current_dir()).unwrap_or(folder);
        let text = format!("{}{}", folder.display(), std::path::MAIN_SEPARATOR);
        self.prompt = Some(Prompt::Path { purpose: Purpose::Open, text, note: String::new() });
    }

    pub(crate) fn prompt_save_as(&mut self, note: Option<String>) {
        let name = self.session.beside(&format!("{}.toile", self.session.name()));
        self.prompt_path(Purpose::SaveAs(None), &name, note.unwrap_or_default());
    }

    pub(crate) fn prompt_export(&mut self) {
        if self.draft().template.surfaces.is_empty() {
            let text = "nothing can be exported yet: the template has no faces";
            return self.notices.push(Notice::problem(text).with_remedy(remedy::FACE_TOOL));
        }
        let folder = self.session.beside(&format!("{}.export", self.session.name()));
        self.prompt_path(Purpose::Export, &folder, "A folder; it is made when it is not there.".to_owned());
    }

    pub(crate) fn prompt_thicken(&mut self) {
        if self.model.cloth.is_none() {
            return self.problem("there is no garment yet to be made thick; fill faces first");
        }
        let path = self.session.beside(&format!("{}-solid.stl", self.session.name()));
        let note = "Millimetres; .obj, .ply, .stl, .off or .glb.".to_owned();
        self.prompt_path(Purpose::Thicken(2.0), &path, note);
    }

    fn prompt_path(&mut self, purpose: Purpose, path: &Path, note: String) {
        let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        self.prompt = Some(Prompt::Path { purpose, text: path.display().to_string(), note });
    }

    /// Writes all files of the garment; waits for it where it is being built.
    pub(crate) fn export(&mut self, folder: PathBuf, context: &egui::Context) {
        let made = self.model.cloth.as_ref().and_then(|c| c.made.clone()).filter(|_| self.is_built());
        match made {
            Some(made) => {
                let work = move || files::export(&made, &folder);
                self.file_job = Some(FileJob::start("exporting".to_owned(), context, work));
            }
            None => self.export_to = Some(folder),
        }
    }

    fn thicken(&mut self, thickness: f64, path: PathBuf, context: &egui::Context) {
        let Some(cloth) = self.model.cloth.clone() else { return };
        let work = move || files::thicken_to(&cloth.mesh, thickness, &path);
        self.file_job = Some(FileJob::start("thickening".to_owned(), context, work));
    }

    fn recover(&mut self, recovery: &Recovery) {
        match recovery.open() {
            Ok(history) => {
                self.begin(history, None, false);
                // The old journal goes only when the new one holds the work.
                match self.session.keep_now() {
                    Ok(()) => recovery.discard(),
                    Err(e) => {
                        self.problem(format!("the work is back, but is not being kept: {e}; save it now"))
                    }
                }
                self.notices.say("the work is back; it is not saved yet");
            }
            Err(e) => self.problem(e.to_string()),
        }
    }

    pub(crate) fn show_prompt(&mut self, context: &egui::Context) {
        let Some(mut prompt) = self.prompt.take() else { return };
        let mut answer = Answer::None;
        let modal = egui::Modal::new(egui::Id::unique("prompt")).show(context, |ui| {
            ui.set_width(if matches!(prompt, Prompt::Keys) { 880.0 } else { 620.0 });
            answer = match &mut prompt {
                Prompt::Unsaved(next) => unsaved(ui, &self.session.name(), next),
                Prompt::Recovery(found) => recovery(ui, found),
                Prompt::Path { purpose, text, note } => {
                    path(ui, purpose, text, note, &self.preferences.recent)
                }
                Prompt::Keys => keys(ui),
            };
        });
        if matches!(answer, Answer::None) && modal.should_close() {
            answer = Answer::Close;
        }
        match answer {
            Answer::None => self.prompt = self.prompt.take().or(Some(prompt)),
            Answer::Close => {}
            Answer::GiveUp(next) => self.go_on(next),
            Answer::Save(next) => match self.session.file.clone() {
                Some(OnDisk { path, kind: FileKind::Draft }) => {
                    if self.save_to(&path) {
                        self.go_on(next);
                    }
                }
                _ => {
                    self.prompt_save_as(None);
                    if let Some(Prompt::Path { purpose, .. }) = &mut self.prompt {
                        *purpose = Purpose::SaveAs(Some(next));
                    }
                }
            },
            Answer::Recover(recovery) => self.recover(&recovery),
            Answer::Discard(gone) => {
                gone.discard();
                if let Prompt::Recovery(mut found) = prompt {
                    found.retain(|(r, _)| *r != gone);
                    self.prompt = (!found.is_empty()).then_some(Prompt::Recovery(found));
                }
            }
            Answer::Path(purpose, path) => match purpose {
                Purpose::Open => self.ask(Next::Open(path)),
                Purpose::SaveAs(next) => {
                    if self.save_to(&path)
                        && let Some(next) = next
                    {
                        self.go_on(next);
                    }
                }
                Purpose::Export => self.export(path, context),
                Purpose::Thicken(thickness) => self.thicken(thickness, path, context),
            },
        }
    }
}

fn unsaved(ui: &mut egui::Ui, name: &str, next: &Next) -> Answer {
    ui.heading("Save the changes?");
    ui.label(format!("Changes of {name} are not saved."));
    let mut answer = Answer::None;
    ui.horizontal(|ui| {
        if ui.button("Save").clicked() {
            answer = Answer::Save(next.clone());
        }
        if ui.button("Do not save").clicked() {
            answer = Answer::GiveUp(next.clone());
        }
        if ui.button("Go on working").clicked() {
            answer = Answer::Close;
        }
    });
    answer
}

fn recovery(ui: &mut egui::Ui, found: &[(Recovery, String)]) -> Answer {
    ui.heading("Work that was not saved");
    ui.label("toile ended without saving. The work is still there:");
    let mut answer = Answer::None;
    for (recovery, text) in found {
        ui.horizontal(|ui| {
            ui.add(egui::Label::new(text).wrap());
            if ui.button("Recover").clicked() {
                answer = Answer::Recover(recovery.clone());
            }
            if ui.button("Throw away").clicked() {
                answer = Answer::Discard(recovery.clone());
            }
        });
    }
    if ui.button("Later").on_hover_text("Ask again at the next start").clicked() {
        answer = Answer::Close;
    }
    answer
}

fn path(
    ui: &mut egui::Ui,
    purpose: &mut Purpose,
    text: &mut String,
    note: &str,
    recent: &[PathBuf],
) -> Answer {
    let (heading, button) = match purpose {
        Purpose::Open => ("Open a design, a template or a body", "Open"),
        Purpose::SaveAs(_) => ("Save as", "Save"),
        Purpose::Export => ("Export all files", "Export"),
        Purpose::Thicken(_) => ("Thicken the garment to a solid", "Thicken"),
    };
    ui.heading(heading);
    if !note.is_empty() {
        ui.label(note);
    }
    if let Purpose::Thicken(thickness) = purpose {
        ui.horizontal(|ui| {
            let label = ui.label("Thickness");
            let value = egui::DragValue::new(thickness).range(0.01..=100.0).speed(0.05).suffix(" mm");
            ui.add(value).labelled_by(label.id);
        });
    }
    let label = ui.label("Path");
    let field = ui.add(egui::TextEdit::singleline(text).desired_width(f32::INFINITY)).labelled_by(label.id);
    // Asked before the field takes the keyboard again.
    let entered = field.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
    if ui.memory(|m| m.focused().is_none()) {
        field.request_focus();
    }
    let mut chosen = None;
    if matches!(purpose, Purpose::Open) {
        chosen = browse(ui, text, recent);
    }
    let target = PathBuf::from(text.trim());
    let mut answer = Answer::None;
    let is_over = matches!(purpose, Purpose::SaveAs(_) | Purpose::Thicken(_)) && target.is_file();
    if matches!(purpose, Purpose::SaveAs(_)) && kind_of_name(&target) == FileKind::Template {
        ui.label("A .json holds the template alone: without the body, loose edges and drawn curves.");
    }
    ui.horizontal(|ui| {
        let text = if is_over { format!("{button} over the file that is there") } else { button.to_owned() };
        if ui.button(text).clicked() || entered && !is_over {
            answer = Answer::Path(purpose.clone(), target.clone());
        }
        if ui.button("Cancel").clicked() {
            answer = Answer::Close;
        }
    });
    match chosen {
        Some(path) => Answer::Path(purpose.clone(), path),
        None => answer,
    }
}

/// Recent files and what lies in the folder; a click opens a file or goes into a folder.
fn browse(ui: &mut egui::Ui, text: &mut String, recent: &[PathBuf]) -> Option<PathBuf> {
    let mut chosen = None;
    let typed = PathBuf::from(text.trim());
    let folder = if text.ends_with(std::path::MAIN_SEPARATOR) || typed.is_dir() {
        typed
    } else {
        typed.parent().map(Path::to_owned).unwrap_or_default()
    };
    egui::ScrollArea::vertical().max_height(300.0).auto_shrink([false, true]).show(ui, |ui| {
        if !recent.is_empty() {
            ui.strong("Recent");
            for path in recent {
                if ui.selectable_label(false, path.display().to_string()).clicked() {
                    chosen = Some(path.clone());
                }
            }
        }
        ui.strong(folder.display().to_string());
        let into = |folder: &Path| format!("{}{}", folder.display(), std::path::MAIN_SEPARATOR);
        if let Some(above) = folder.parent()
            && ui.selectable_label(false, "…/").on_hover_text("The folder above").clicked()
        {
            *text = into(above);
        }
        let (folders, files) = files::listing(&folder);
        let name = |p: &Path| p.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
        for path in folders {
            if ui.selectable_label(false, format!("{}/", name(&path))).clicked() {
                *text = into(&path);
            }
        }
        for path in files {
            if ui.selectable_label(false, name(&path)).clicked() {
                chosen = Some(path);
            }
        }
    });
    chosen
}

fn keys(ui: &mut egui::Ui) -> Answer {
    ui.heading("Keys");
    egui::ScrollArea::vertical().max_height(480.0).show(ui, |ui| {
        egui::Grid::new("keys").num_columns(3).striped(true).show(ui, |ui| {
            for action in actions() {
                if action.shortcut.is_none() {
                    continue;
                }
                ui.monospace(action.keys(ui.ctx()));
                ui.label(&action.text);
                ui.weak(&action.hint);
                ui.end_row();
            }
            for (hand, what) in [
                ("right or middle drag", "turn the eye about what is under the pointer"),
                ("Shift + the same", "move the eye across"),
                ("wheel", "nearer and farther"),
                ("Shift + click", "add to the selection, or take out of it"),
            ] {
                ui.monospace(hand);
                ui.label(what);
                ui.end_row();
            }
        });
    });
    if ui.button("Close").clicked() { Answer::Close } else { Answer::None }
}
