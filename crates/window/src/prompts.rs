//! Questions in front of the window: unsaved work, files, folders, recovery, the sheet of keys.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use design::draft::{BodySource, Draft, Edit, FileKind, History, Journal, Recovery, SourceFile};
use design::drawings::Making;
use eframe::egui;

use crate::actions::remedy;
use crate::board::pen::Pen;
use crate::browsing::{Browsed, Browsing, FileWish};
use crate::designer::{Designer, Stale, describe};
use crate::dialogs::{changed, keys, path, recovery, unsaved};
use crate::files::{self, LIBRARY, Opened};
use crate::jobs::FileJob;
use crate::layout::{self, LayoutAnswer};
use crate::notices::Notice;
use crate::session::Session;
use crate::workshop::{self, Stop};

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
    /// By how many millimetres.
    Thicken(f64),
    /// A mid-surface of a solid: of which, once that is known.
    Deflate(Option<PathBuf>),
    /// Flat plates of a sheet: how thick it is, mm, and which.
    Unfold(f64, Option<PathBuf>),
    /// A script, for its drawing.
    Drawing,
    /// A script of the drawing, and what it makes.
    Script(Making),
}

impl Purpose {
    /// Whether a file that is there is asked for.
    pub(crate) fn reads(&self) -> bool {
        matches!(self, Self::Open | Self::Drawing | Self::Deflate(None) | Self::Unfold(_, None))
    }
}

/// A question.
pub(crate) enum Prompt {
    Unsaved(Next),
    /// The design's own file was written by something else; with what to do once it is saved.
    Changed {
        path: PathBuf,
        next: Option<Next>,
    },
    Recovery(Vec<(Recovery, String)>),
    Path {
        purpose: Purpose,
        text: String,
        note: String,
    },
    Keys,
    /// The panels are kept under a name.
    Layout {
        name: String,
    },
}

impl Prompt {
    pub(crate) fn recovery(found: Vec<Recovery>) -> Self {
        Self::Recovery(found.into_iter().map(|r| (r.clone(), describe(&r))).collect())
    }
}

/// What a person answered.
pub(crate) enum Answer {
    None,
    Close,
    Save(Next),
    /// Over what something else has written.
    SaveOver(PathBuf, Option<Next>),
    SaveAs(Option<Next>),
    GiveUp(Next),
    Recover(Recovery),
    Discard(Recovery),
    Path(Purpose, PathBuf),
    Browse(FileWish),
    Layout(LayoutAnswer),
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
            Ok(Opened::Design { history, file }) => {
                let (name, kind) = (history.draft().template.name.clone(), file.kind);
                self.begin(history, Some(file), true);
                self.notices.say(format!("opened {name}, {}", kind.words()));
            }
            Ok(Opened::Journal(Journal { history, file })) => {
                self.begin(history, file, false);
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
    fn begin(&mut self, history: History, file: Option<SourceFile>, is_saved: bool) {
        self.session = Session::new(history, file, is_saved, &self.state);
        self.take_tool(self.tool);
        (self.board.pen, self.board.selection) = (Pen::new(self.board.pen.tool), Vec::new());
        self.forget_garments();
    }

    pub(crate) fn save(&mut self) {
        match self.session.file.clone() {
            Some(file) if file.kind == FileKind::Draft => {
                self.save_own(&file, None);
            }
            Some(SourceFile { path, kind, .. }) => self.prompt_save_as(Some(format!(
                "{} is {}. A draft keeps the body, loose edges and drawn curves too.",
                path.display(),
                kind.words()
            ))),
            None => self.prompt_save_as(None),
        }
    }

    /// Saves into the design's own file, unless something else has written it; then goes on.
    fn save_own(&mut self, file: &SourceFile, next: Option<Next>) {
        if file.is_changed() {
            self.prompt = Some(Prompt::Changed { path: file.path.clone(), next });
        } else {
            self.save_and(&file.path, next);
        }
    }

    /// Saves, and goes on when it could be saved.
    fn save_and(&mut self, path: &Path, next: Option<Next>) {
        if self.save_to(path)
            && let Some(next) = next
        {
            self.go_on(next);
        }
    }

    fn save_to(&mut self, path: &Path) -> bool {
        match files::save(self.session.draft(), path) {
            Ok(file) => {
                let kind = file.kind;
                self.session.saved_to(file);
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
        self.prompt_source(Purpose::Open, String::new());
    }

    pub(crate) fn prompt_deflate(&mut self) {
        let note = "A closed solid of thin walls: .obj, .ply, .stl, .off or .glb.".to_owned();
        self.prompt_source(Purpose::Deflate(None), note);
    }

    pub(crate) fn prompt_unfold(&mut self) {
        let note = "A folded sheet, or a script of modelling commands (.json).".to_owned();
        self.prompt_source(Purpose::Unfold(0.0, None), note);
    }

    /// Asks for a file that is there.
    fn prompt_source(&mut self, purpose: Purpose, note: String) {
        let own = self.session.file.as_ref().and_then(|f| f.path.parent()).map(Path::to_owned);
        let folder = own.and_then(|f| std::path::absolute(f).ok()).or_else(|| std::env::current_dir().ok());
        let folder = folder.unwrap_or_default();
        let text = format!("{}{}", folder.display(), std::path::MAIN_SEPARATOR);
        self.prompt = Some(Prompt::Path { purpose, text, note });
    }

    pub(crate) fn prompt_drawing(&mut self) {
        let note = "A script of modelling commands (.json); undo takes the drawing before.".to_owned();
        self.prompt_source(Purpose::Drawing, note);
    }

    pub(crate) fn prompt_script(&mut self) {
        let path = self.session.beside(&format!("{}-drawing.json", self.session.name()));
        let note = "Commands for `toile model`; the design keeps the drawing with its rules.".to_owned();
        self.prompt_path(Purpose::Script(Making::Sheets), &path, note);
    }

    pub(crate) fn prompt_save_as(&mut self, note: Option<String>) {
        let name = self.session.beside(&format!("{}.toile", self.session.name()));
        self.prompt_path(Purpose::SaveAs(None), &name, note.unwrap_or_default());
    }

    /// Asks for a name to save under, and what is done then.
    fn prompt_save_as_and(&mut self, next: Option<Next>) {
        self.prompt_save_as(None);
        if let Some(Prompt::Path { purpose, .. }) = &mut self.prompt {
            *purpose = Purpose::SaveAs(next);
        }
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
                let work = move |stop: &Stop| files::export(&made, &folder, stop);
                self.file_job = Some(FileJob::start("exporting".to_owned(), context, work));
            }
            None => {
                self.export_to = Some(folder);
                // It may have been stopped before.
                if self.builder.step().is_none() {
                    self.stale = Stale::Whole;
                }
            }
        }
    }

    fn thicken(&mut self, thickness: f64, path: PathBuf, context: &egui::Context) {
        let Some(cloth) = self.model.cloth.clone() else { return };
        let work = move |stop: &Stop| workshop::thicken_to(&cloth.mesh, thickness, &path, stop);
        self.file_job = Some(FileJob::start("thickening".to_owned(), context, work));
    }

    /// The solid is known: where its mid-surface goes; both are known: makes it.
    fn deflate(&mut self, source: Option<PathBuf>, path: PathBuf, context: &egui::Context) {
        let Some(solid) = source else {
            let beside = named_like(&path, "-mid.obj");
            let note = "The thickness goes into a .thickness.json beside it.".to_owned();
            return self.prompt_path(Purpose::Deflate(Some(path)), &beside, note);
        };
        let work = move |stop: &Stop| workshop::deflate_to(&solid, &path, stop);
        self.file_job = Some(FileJob::start("looking for the mid-surface".to_owned(), context, work));
    }

    /// The sheet is known: where its plates go; both are known: lays it flat.
    fn unfold(&mut self, thickness: f64, source: Option<PathBuf>, path: PathBuf, context: &egui::Context) {
        let Some(sheet) = source else {
            let beside = named_like(&path, "-flat.dxf");
            let note = "A drawing, .dxf or .svg. Without a thickness the sheet is folded sharply.".to_owned();
            return self.prompt_path(Purpose::Unfold(thickness, Some(path)), &beside, note);
        };
        let work = move |stop: &Stop| workshop::unfold_to(&sheet, thickness, &path, stop);
        self.file_job = Some(FileJob::start("laying the sheet flat".to_owned(), context, work));
    }

    fn recover(&mut self, recovery: &Recovery) {
        match recovery.open() {
            Ok(Journal { history, file }) => {
                self.begin(history, file, false);
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

    /// What the desktop's dialog came to goes into the field; a person still says yes to it.
    fn take_browsed(&mut self, prompt: &mut Prompt) {
        let Some(browsed) = self.browsing.as_ref().and_then(Browsing::take) else { return };
        self.browsing = None;
        match (browsed, prompt) {
            (Browsed::Path(path), Prompt::Path { text, .. }) => *text = path.display().to_string(),
            (Browsed::Missing, Prompt::Path { note, .. }) => {
                *note = "There is no file dialog of the desktop here; write the path.".to_owned();
            }
            _ => {}
        }
    }

    pub(crate) fn show_prompt(&mut self, context: &egui::Context) {
        let Some(mut prompt) = self.prompt.take() else {
            // An answer that comes later is to a question that is no more.
            self.browsing = None;
            return;
        };
        self.take_browsed(&mut prompt);
        let is_browsing = self.browsing.is_some();
        let mut answer = Answer::None;
        let modal = egui::Modal::new(egui::Id::unique("prompt")).show(context, |ui| {
            ui.set_width(if matches!(prompt, Prompt::Keys) { 880.0 } else { 620.0 });
            answer = match &mut prompt {
                Prompt::Unsaved(next) => unsaved(ui, &self.session.name(), next),
                Prompt::Changed { path, next } => changed(ui, path, next.as_ref()),
                Prompt::Recovery(found) => recovery(ui, found),
                Prompt::Path { purpose, text, note } => {
                    path(ui, purpose, text, note, &self.preferences.recent, is_browsing)
                }
                Prompt::Keys => keys(ui, &self.actions()),
                Prompt::Layout { name } => match layout::ask(ui, name, &self.preferences.layouts) {
                    LayoutAnswer::None => Answer::None,
                    LayoutAnswer::Close => Answer::Close,
                    other => Answer::Layout(other),
                },
            };
        });
        if matches!(answer, Answer::None) && modal.should_close() {
            answer = Answer::Close;
        }
        match answer {
            Answer::None => self.prompt = self.prompt.take().or(Some(prompt)),
            Answer::Close => {}
            Answer::Browse(wish) => {
                self.browsing = Some(Browsing::start(self.file_dialog, wish, context));
                self.prompt = Some(prompt);
            }
            Answer::GiveUp(next) => self.go_on(next),
            Answer::Layout(LayoutAnswer::Keep(name)) => self.keep_layout(&name),
            Answer::Layout(LayoutAnswer::Delete(k)) => {
                self.prefer(|p| drop(p.layouts.remove(k)));
                self.prompt = Some(prompt);
            }
            Answer::Layout(_) => {}
            Answer::Save(next) => match self.session.file.clone() {
                Some(file) if file.kind == FileKind::Draft => self.save_own(&file, Some(next)),
                _ => self.prompt_save_as_and(Some(next)),
            },
            Answer::SaveOver(path, next) => self.save_and(&path, next),
            Answer::SaveAs(next) => self.prompt_save_as_and(next),
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
                Purpose::SaveAs(next) => self.save_and(&path, next),
                Purpose::Export => self.export(path, context),
                Purpose::Thicken(thickness) => self.thicken(thickness, path, context),
                Purpose::Deflate(source) => self.deflate(source, path, context),
                Purpose::Unfold(thickness, source) => self.unfold(thickness, source, path, context),
                Purpose::Drawing => self.open_drawing(&path),
                Purpose::Script(making) => self.write_script(making, &path),
            },
        }
    }
}

/// A file beside another, with its name and another ending.
fn named_like(path: &Path, ending: &str) -> PathBuf {
    let stem = path.file_stem().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
    path.with_file_name(format!("{stem}{ending}"))
}
