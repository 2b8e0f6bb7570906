//! What stands about the 3D view: menus, tool bar, outline, inspector, pattern, status line, palette.

mod inspector;
mod outline;
pub(crate) mod pattern;

pub(crate) use outline::section;

use eframe::egui::{self, Key};

use crate::actions::{Action, DRAWING_BOARD, Menu};
use crate::board;
use crate::designer::Designer;
use crate::layout::{INSPECTOR, OUTLINE, PATTERN};
use crate::selection::Mode;
use crate::tools::Tool;
use crate::workspace::Workspace;

impl Designer {
    pub(crate) fn panels(&mut self, ui: &mut egui::Ui) {
        egui::Panel::top("bar").show(ui, |ui| {
            self.menus(ui);
            self.tool_bar(ui);
        });
        egui::Panel::bottom("status").show(ui, |ui| self.status(ui));
        if self.workspace == Workspace::Drawing {
            return self.board_panels(ui);
        }
        let [outline, pattern, inspector] = self.preferences.layout.panels;
        if outline.is_shown {
            let shown = egui::Panel::left(self.panel_id(OUTLINE))
                .default_size(outline.size)
                .show(ui, |ui| egui::ScrollArea::vertical().show(ui, |ui| self.outline(ui)));
            self.preferences.layout.panels[OUTLINE].size = shown.response.rect.width();
        }
        if !(pattern.is_shown || inspector.is_shown) {
            return;
        }
        let right = egui::Panel::right(self.panel_id(INSPECTOR)).default_size(inspector.size);
        let shown = right.show(ui, |ui| match (pattern.is_shown, inspector.is_shown) {
            (true, true) => {
                let above =
                    egui::Panel::top(self.panel_id(PATTERN)).resizable(true).default_size(pattern.size);
                let above = above.show(ui, |ui| self.pattern_view(ui));
                self.preferences.layout.panels[PATTERN].size = above.response.rect.height();
                egui::CentralPanel::default_margins().show(ui, |ui| self.scrolled_inspector(ui));
            }
            (true, false) => self.pattern_view(ui),
            _ => self.scrolled_inspector(ui),
        });
        self.preferences.layout.panels[INSPECTOR].size = shown.response.rect.width();
    }

    fn scrolled_inspector(&mut self, ui: &mut egui::Ui) {
        egui::ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| self.inspector(ui));
    }

    fn menus(&mut self, ui: &mut egui::Ui) {
        let all = self.actions();
        let mut chosen: Option<&Action> = None;
        egui::MenuBar::new().ui(ui, |ui| {
            for (menu, name) in Menu::ALL {
                if !all.iter().any(|a| a.menu == menu) {
                    continue;
                }
                ui.menu_button(name, |ui| {
                    ui.set_min_width(220.0);
                    for action in all.iter().filter(|a| a.menu == menu) {
                        let keys = action.keys(ui.ctx());
                        let is_on = action.is_on(self).unwrap_or(false);
                        let button = egui::Button::selectable(is_on, &action.text).shortcut_text(keys);
                        let history = self.session.history();
                        // What exactly is taken back or made again.
                        let what = match action.text.as_str() {
                            "Undo" => history.undo_label(),
                            "Redo" => history.redo_label(),
                            _ => None,
                        };
                        let hint =
                            what.map_or_else(|| action.hint.clone(), |w| format!("{}: {w}", action.hint));
                        if ui.add(button).on_hover_text(hint).clicked() {
                            chosen = Some(action);
                            ui.close();
                        }
                    }
                });
            }
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                let mark = if self.session.is_unsaved() { " •" } else { "" };
                let name = format!("{}{mark}", self.session.name());
                let path = self
                    .session
                    .file
                    .as_ref()
                    .map_or_else(|| "not saved to a file yet".to_owned(), |f| f.path.display().to_string());
                ui.label(name).on_hover_text(path);
            });
        });
        if let Some(action) = chosen {
            action.run(self, &ui.ctx().clone());
        }
    }

    /// Tools, what clicks select, and the switches that hands look for.
    fn tool_bar(&mut self, ui: &mut egui::Ui) {
        let all = self.actions();
        let mut chosen: Option<&Action> = None;
        ui.horizontal_wrapped(|ui| {
            let is_tool = |a: &&Action| match self.workspace {
                Workspace::Garment => Tool::ALL.iter().any(|(_, name, ..)| *name == a.text),
                Workspace::Drawing => board::pen::Tool::ALL.iter().any(|(_, name, ..)| *name == a.text),
            };
            let is_mode = |a: &&Action| Mode::ALL.iter().any(|(_, name)| *name == a.text);
            let is_switch = |a: &&Action| a.menu == Menu::View && a.is_on.is_some() && a.shortcut.is_some();
            let mut show = |ui: &mut egui::Ui, pick: &dyn Fn(&&Action) -> bool| {
                for action in all.iter().filter(|a| pick(a)) {
                    let hint = format!("{} ({})", action.hint, action.keys(ui.ctx()));
                    let button = egui::Button::selectable(action.is_on(self).unwrap_or(false), &action.text);
                    if ui.add(button).on_hover_text(hint).clicked() {
                        chosen = Some(action);
                    }
                }
            };
            show(ui, &is_tool);
            ui.separator();
            show(ui, &is_mode);
            if self.workspace == Workspace::Garment {
                ui.separator();
            }
            show(ui, &is_switch);
            ui.separator();
            show(ui, &|a: &&Action| a.text == DRAWING_BOARD);
        });
        if let Some(action) = chosen {
            action.run(self, &ui.ctx().clone());
        }
    }

    fn status(&mut self, ui: &mut egui::Ui) {
        ui.horizontal(|ui| {
            let busy = self.file_job.as_ref().map(|j| j.what.clone()).or(self.builder.step());
            if let Some(step) = busy {
                ui.spinner();
                ui.label(step);
                if ui.small_button("Stop").on_hover_text("Stop what is being built or made").clicked() {
                    self.stop();
                }
                ui.separator();
            }
            if self.workspace == Workspace::Drawing {
                let pen = &self.board.pen;
                ui.strong(board::pen::Tool::ALL.iter().find(|t| t.0 == pen.tool).map_or("", |t| t.1));
                ui.label(pen.next_step());
                let at = self.board.pointer_at().map(|at| {
                    let [x, y] = [at.x, at.y].map(|v| self.preferences.unit.text(v));
                    format!("{x}; {y}")
                });
                ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                    ui.weak(at.unwrap_or_default());
                });
                return;
            }
            let name = Tool::ALL.iter().find(|t| t.0 == self.tool).map_or("", |t| t.1);
            ui.strong(name);
            ui.label(self.machine.next_step(&self.world(1.0)));
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                if let Some(cloth) = &self.model.cloth {
                    ui.weak(format!("{} triangles", cloth.mesh.faces.len()));
                }
                if let Some(element) = &self.hovered {
                    ui.label(element.label(self.session.draft()));
                }
            });
        });
    }

    pub(crate) fn show_palette(&mut self, context: &egui::Context) {
        let Some(mut text) = self.palette.take() else { return };
        let all = self.actions();
        let wanted = text.to_lowercase();
        let fits = |a: &&Action| {
            wanted
                .split_whitespace()
                .all(|word| a.text.to_lowercase().contains(word) || a.hint.to_lowercase().contains(word))
        };
        let mut found: Vec<&Action> = all.iter().filter(fits).collect();
        // Those that begin with the word, then those that have it in their name, then those that only tell of it.
        found.sort_by_key(|a| {
            let name = a.text.to_lowercase();
            (!name.starts_with(&wanted), !name.contains(&wanted))
        });
        let mut chosen: Option<&Action> = None;
        let modal = egui::Modal::new(egui::Id::unique("palette")).show(context, |ui| {
            ui.set_width(480.0);
            let label = ui.label("Find an action");
            let field = ui.text_edit_singleline(&mut text).labelled_by(label.id);
            field.request_focus();
            if ui.input(|i| i.key_pressed(Key::Enter)) {
                chosen = found.first().copied();
            }
            egui::ScrollArea::vertical().max_height(320.0).auto_shrink([false, true]).show(ui, |ui| {
                for (k, action) in found.iter().enumerate() {
                    let keys = action.keys(ui.ctx());
                    let button = egui::Button::selectable(k == 0, &action.text).shortcut_text(keys);
                    if ui.add(button).on_hover_text(&action.hint).clicked() {
                        chosen = Some(action);
                    }
                }
            });
        });
        match chosen {
            Some(action) => action.run(self, context),
            None if !modal.should_close() => self.palette = Some(text),
            None => {}
        }
    }
}
