//! The insides of the questions: what is shown, and what was answered.

use std::path::{Path, PathBuf};

use design::draft::{FileKind, Recovery};
use design::drawings::Making;
use eframe::egui;

use crate::actions::{ALSO, Action};
use crate::browsing::{FileWish, PathKind};
use crate::files::{self, kind_of_name};
use crate::prompts::{Answer, Next, Purpose};

pub(crate) fn unsaved(ui: &mut egui::Ui, name: &str, next: &Next) -> Answer {
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

pub(crate) fn changed(ui: &mut egui::Ui, path: &Path, next: Option<&Next>) -> Answer {
    ui.heading("Save over another version?");
    ui.label(format!(
        "{} was written by another program since it was opened here. Saving over it would lose what that wrote.",
        path.display()
    ));
    let mut answer = Answer::None;
    ui.horizontal(|ui| {
        if ui.button("Save under another name").clicked() {
            answer = Answer::SaveAs(next.cloned());
        }
        if ui.button("Save over it").clicked() {
            answer = Answer::SaveOver(path.to_owned(), next.cloned());
        }
        if ui.button("Go on working").clicked() {
            answer = Answer::Close;
        }
    });
    answer
}

pub(crate) fn recovery(ui: &mut egui::Ui, found: &[(Recovery, String)]) -> Answer {
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

pub(crate) fn path(
    ui: &mut egui::Ui,
    purpose: &mut Purpose,
    text: &mut String,
    note: &str,
    recent: &[PathBuf],
    is_browsing: bool,
) -> Answer {
    let (heading, button) = match purpose {
        Purpose::Open => ("Open a design, a template or a body", "Open"),
        Purpose::SaveAs(_) => ("Save as", "Save"),
        Purpose::Export => ("Export all files", "Export"),
        Purpose::Thicken(_) => ("Thicken the garment to a solid", "Thicken"),
        Purpose::Deflate(None) => ("The mid-surface of which solid?", "Next"),
        Purpose::Deflate(Some(_)) => ("Write the mid-surface", "Make the mid-surface"),
        Purpose::Unfold(_, None) => ("Which sheet is laid flat?", "Next"),
        Purpose::Unfold(_, Some(_)) => ("Draw the flat plates", "Lay it flat"),
        Purpose::Drawing => ("Take the drawing of which script?", "Open"),
        Purpose::Script(_) => ("Write the drawing as a script", "Write"),
    };
    ui.heading(heading);
    if !note.is_empty() {
        ui.label(note);
    }
    let least = if matches!(purpose, Purpose::Thicken(_)) { 0.01 } else { 0.0 };
    if let Purpose::Thicken(thickness) | Purpose::Unfold(thickness, Some(_)) = purpose {
        ui.horizontal(|ui| {
            let label = ui.label("Thickness");
            let value = egui::DragValue::new(thickness).range(least..=100.0).speed(0.05).suffix(" mm");
            ui.add(value).labelled_by(label.id);
        });
    }
    if let Purpose::Script(making) = purpose {
        script(ui, making);
    }
    let label = ui.label("Path");
    let mut is_asked = false;
    let field = ui
        .horizontal(|ui| {
            let width = ui.available_width() - 90.0;
            let field = ui.add(egui::TextEdit::singleline(text).desired_width(width)).labelled_by(label.id);
            let button = ui.add_enabled(!is_browsing, egui::Button::new("Browse …"));
            is_asked = button.on_hover_text("The file dialog of the desktop").clicked();
            field
        })
        .inner;
    // Asked before the field takes the keyboard again.
    let entered = field.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
    if ui.memory(|m| m.focused().is_none()) {
        field.request_focus();
    }
    let mut chosen = None;
    if purpose.reads() {
        chosen = browse(ui, text, recent);
    }
    let target = PathBuf::from(text.trim());
    let mut answer = Answer::None;
    let is_file = target.is_file();
    let is_refused = matches!(purpose, Purpose::Export) && is_file;
    let is_over = !purpose.reads() && is_file;
    if is_refused {
        ui.label("That is a file: write the name of a folder.");
    }
    if matches!(purpose, Purpose::SaveAs(_)) && kind_of_name(&target) == FileKind::Template {
        ui.label("A .json holds the template alone: without the body, loose edges, drawn curves and the drawing board.");
    }
    ui.horizontal(|ui| {
        let says_over = is_over && !is_refused;
        let text =
            if says_over { format!("{button} over the file that is there") } else { button.to_owned() };
        if ui.add_enabled(!is_refused, egui::Button::new(text)).clicked() || entered && !is_over {
            answer = Answer::Path(purpose.clone(), target.clone());
        }
        if ui.button("Cancel").clicked() {
            answer = Answer::Close;
        }
    });
    if is_asked {
        return Answer::Browse(wish(purpose, heading, &target));
    }
    match chosen {
        Some(path) => Answer::Path(purpose.clone(), path),
        None => answer,
    }
}

/// What the desktop's dialog is asked for.
fn wish(purpose: &Purpose, title: &str, target: &Path) -> FileWish {
    let kind = match purpose {
        Purpose::Export => PathKind::Folder,
        _ if purpose.reads() => PathKind::Open,
        _ => PathKind::Save,
    };
    let folder = if target.is_dir() { Some(target) } else { target.parent() };
    let name = target.file_name().filter(|_| !target.is_dir());
    FileWish {
        kind,
        title: title.to_owned(),
        folder: folder.map(Path::to_owned).unwrap_or_default(),
        name: name.map(|n| n.to_string_lossy().into_owned()).unwrap_or_default(),
    }
}

/// What the script makes of the drawing.
fn script(ui: &mut egui::Ui, making: &mut Making) {
    ui.horizontal(|ui| {
        let height = if let Making::Walls(height) = making { *height } else { 50.0 };
        for (kind, name) in [
            (Making::Sheets, "Plane sheets with holes"),
            (Making::Walls(height), "Walls"),
            (Making::Wires, "Wires"),
        ] {
            ui.radio_value(making, kind, name);
        }
    });
    if let Making::Walls(height) = making {
        ui.horizontal(|ui| {
            let label = ui.label("Height");
            let value = egui::DragValue::new(height).range(0.01..=10_000.0).speed(0.5).suffix(" mm");
            ui.add(value).labelled_by(label.id);
        });
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
    // The buttons below stay in sight in a low window.
    let height = (ui.ctx().content_rect().height() - 250.0).clamp(60.0, 300.0);
    egui::ScrollArea::vertical().max_height(height).auto_shrink([false, true]).show(ui, |ui| {
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

pub(crate) fn keys(ui: &mut egui::Ui, actions: &[Action]) -> Answer {
    ui.heading("Keys");
    egui::ScrollArea::vertical().max_height(480.0).show(ui, |ui| {
        egui::Grid::new("keys").num_columns(3).striped(true).show(ui, |ui| {
            for action in actions {
                if action.shortcut.is_none() {
                    continue;
                }
                ui.monospace(action.keys(ui.ctx()));
                ui.label(&action.text);
                ui.weak(&action.hint);
                ui.end_row();
            }
            for (shortcut, text) in ALSO {
                ui.monospace(ui.ctx().format_shortcut(&shortcut));
                ui.label(text);
                ui.weak("also");
                ui.end_row();
            }
            for (hand, what) in [
                ("right or middle drag", "turn the eye about what is under the pointer"),
                ("Shift + the same", "move the eye across"),
                ("wheel", "nearer and farther"),
                ("Shift + click", "add to the selection, or take out of it"),
                ("drag on empty ground", "select by a box; with Ctrl by a lasso"),
            ] {
                ui.monospace(hand);
                ui.label(what);
                ui.end_row();
            }
        });
    });
    if ui.button("Close").clicked() { Answer::Close } else { Answer::None }
}
