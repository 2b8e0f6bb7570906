//! Menus, outline, inspector, pattern view, palette, status line: all fed by one list of actions.

use design::draft::{BodySource, Command, Edit, MEASURES, measure};
use eframe::egui::{self, Key, KeyboardShortcut, Modifiers};
use template::format::EaseSpec;

use crate::app::{Designer, Tool};

type Action = (&'static str, Option<KeyboardShortcut>, fn(&mut Designer));

const CTRL: Modifiers = Modifiers::COMMAND;

/// Every action with its shortcut; menu, palette and keys are made of this list.
fn actions() -> Vec<Action> {
    let key = |m, k| Some(KeyboardShortcut::new(m, k));
    vec![
        ("Open", key(CTRL, Key::O), Designer::open),
        ("Save", key(CTRL, Key::S), Designer::save),
        ("Export files", key(CTRL, Key::E), Designer::export),
        ("Undo", key(CTRL, Key::Z), |d| d.command(Command::Undo)),
        ("Redo", key(CTRL, Key::Y), |d| d.command(Command::Redo)),
        ("Fill face", key(Modifiers::NONE, Key::Enter), Designer::fill),
        ("Delete node", key(Modifiers::NONE, Key::Delete), |d| {
            for name in std::mem::take(&mut d.selected) {
                d.edit(Edit::DeleteNode { name });
            }
        }),
        ("Front view", key(Modifiers::NONE, Key::Num1), |d| d.look(viewer::View::Front)),
        ("Left view", key(Modifiers::NONE, Key::Num3), |d| d.look(viewer::View::Left)),
        ("Back view", key(Modifiers::NONE, Key::Num7), |d| d.look(viewer::View::Back)),
        ("Palette", key(CTRL, Key::P), |d| d.palette = Some(String::new())),
    ]
}

impl Designer {
    pub(crate) fn keys(&mut self, context: &egui::Context) {
        let typing = context.egui_wants_keyboard_input();
        for (_, shortcut, act) in actions() {
            let plain = shortcut.is_some_and(|s| s.modifiers == Modifiers::NONE);
            if shortcut.is_some_and(|s| !(typing && plain) && context.input_mut(|i| i.consume_shortcut(&s))) {
                act(self);
            }
        }
        for (tool, _, key, _) in Tool::ALL {
            if !typing && context.input_mut(|i| i.consume_key(Modifiers::NONE, key)) {
                self.tool = tool;
                self.selected.clear();
            }
        }
    }

    pub(crate) fn panels(&mut self, ui: &mut egui::Ui) {
        egui::Panel::top("bar").show(ui, |ui| {
            ui.horizontal_wrapped(|ui| {
                for (tool, name, key, hint) in Tool::ALL {
                    let label = format!("{name} ({})", key.name());
                    if ui.selectable_label(self.tool == tool, label).on_hover_text(hint).clicked() {
                        self.tool = tool;
                        self.selected.clear();
                    }
                }
                ui.separator();
                for (name, shortcut, act) in actions() {
                    let hint = shortcut.map(|s| ui.ctx().format_shortcut(&s)).unwrap_or_default();
                    if ui.button(name).on_hover_text(hint).clicked() {
                        act(self);
                    }
                }
                let label = ui.label("File");
                ui.text_edit_singleline(&mut self.path).labelled_by(label.id);
                let chosen = ui.ctx().options(|o| o.theme_preference);
                for (name, theme) in [
                    ("light", egui::ThemePreference::Light),
                    ("dark", egui::ThemePreference::Dark),
                    ("as the system", egui::ThemePreference::System),
                ] {
                    if ui.selectable_label(chosen == theme, name).clicked() {
                        ui.ctx().set_theme(theme);
                    }
                }
            });
        });
        egui::Panel::bottom("status").show(ui, |ui| {
            let hint = Tool::ALL.iter().find(|t| t.0 == self.tool).map_or("", |t| t.3);
            let busy = if self.builder.busy { "building …  " } else { "" };
            ui.label(format!("{busy}{hint}   {}", self.message));
        });
        egui::Panel::left("outline")
            .show(ui, |ui| egui::ScrollArea::vertical().show(ui, |ui| self.outline(ui)));
        egui::Panel::right("inspector").default_size(340.0).show(ui, |ui| {
            self.pattern(ui);
            ui.separator();
            egui::ScrollArea::vertical().show(ui, |ui| self.inspector(ui));
        });
        self.show_palette(ui.ctx());
    }

    fn outline(&mut self, ui: &mut egui::Ui) {
        let file = self.draft().template.clone();
        ui.strong("Surfaces");
        for name in file.surfaces.keys() {
            if ui.selectable_label(self.surface == *name, name).clicked() {
                self.surface = name.clone();
            }
        }
        let label = ui.label("New faces go to");
        ui.text_edit_singleline(&mut self.surface).labelled_by(label.id);
        ui.strong("Nodes");
        for name in file.nodes.keys() {
            if ui.selectable_label(self.selected.contains(name), name).clicked() {
                self.selected = vec![name.clone()];
            }
        }
        ui.strong("Lines");
        for name in file.lines.keys() {
            ui.horizontal(|ui| {
                ui.label(name);
                if ui.small_button("×").on_hover_text(format!("Delete line {name}")).clicked() {
                    self.edit(Edit::DeleteProfile { name: name.clone() });
                }
            });
        }
    }

    fn inspector(&mut self, ui: &mut egui::Ui) {
        let draft = std::sync::Arc::clone(self.history.draft());
        if let Some((name, spec)) = self.selected.first().and_then(|n| draft.template.nodes.get_key_value(n))
        {
            ui.strong(name);
            let mut node = spec.clone();
            for (what, value) in [
                ("α outward", &mut node.normal),
                ("β first", &mut node.first),
                ("γ second", &mut node.second),
            ] {
                ui.add(egui::Slider::new(value, -200.0..=200.0).suffix(" mm").text(what));
            }
            if node != *spec {
                self.command(Command::Continue(Edit::MoveNode { name: name.clone(), node }));
            }
        }
        for (level, spec) in &draft.template.ease {
            let mut ease: EaseSpec = spec.clone();
            if ui
                .add(
                    egui::Slider::new(&mut ease.ease, 0.0..=300.0)
                        .suffix(" mm")
                        .text(format!("{level} ease")),
                )
                .changed()
            {
                self.command(Command::Continue(Edit::SetEase { level: level.clone(), ease: Some(ease) }));
            }
        }
        if let BodySource::Form(measurements) = &*draft.body {
            ui.strong("Body");
            for name in MEASURES {
                let Some(now) = measure(measurements, name) else { continue };
                let mut value = now;
                let text = name.replace('_', " ");
                ui.add(egui::Slider::new(&mut value, 0.5 * now..=1.5 * now).suffix(" cm").text(text));
                if value != now {
                    self.command(Command::Continue(Edit::SetMeasure {
                        name: name.to_owned(),
                        value: Some(value),
                    }));
                }
            }
        }
    }

    /// The flat pieces; the one of the chosen surface stands out, and a click chooses.
    fn pattern(&mut self, ui: &mut egui::Ui) {
        let size = egui::vec2(ui.available_width(), 260.0);
        let (rect, response) = ui.allocate_exact_size(size, egui::Sense::click());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, "Pattern view"));
        let Some(garment) = &self.garment else { return };
        let pattern = &garment.pattern;
        let loops: Vec<(&str, Vec<glam::DVec2>)> = pattern
            .pieces
            .iter()
            .zip(&pattern.layout.offsets)
            .flat_map(|(p, o)| {
                p.cut.iter().map(move |c| (p.name.as_str(), c.points.iter().map(|q| *q + *o).collect()))
            })
            .collect();
        let all = || loops.iter().flat_map(|l| l.1.iter());
        let low = all().fold(glam::DVec2::INFINITY, |m, p| m.min(*p));
        let high = all().fold(glam::DVec2::NEG_INFINITY, |m, p| m.max(*p));
        let scale =
            (f64::from(rect.width()) / (high.x - low.x)).min(f64::from(rect.height()) / (high.y - low.y));
        let place = |p: &glam::DVec2| {
            rect.min + egui::vec2(((p.x - low.x) * scale) as f32, ((high.y - p.y) * scale) as f32)
        };
        let mut chosen = None;
        for (name, points) in &loops {
            let mut points: Vec<egui::Pos2> = points.iter().map(place).collect();
            if response.interact_pointer_pos().is_some_and(|p| egui::Rect::from_points(&points).contains(p)) {
                chosen = Some((*name).to_owned());
            }
            points.extend(points.first().copied());
            let width = if *name == self.surface { 3.0 } else { 1.0 };
            ui.painter().line(points, egui::Stroke::new(width, ui.visuals().text_color()));
        }
        if let Some(name) = chosen.filter(|_| response.clicked()) {
            self.surface = name;
        }
    }

    fn show_palette(&mut self, context: &egui::Context) {
        let Some(mut text) = self.palette.take() else { return };
        let mut open = !context.input(|i| i.key_pressed(Key::Escape));
        egui::Window::new("Palette").collapsible(false).show(context, |ui| {
            let label = ui.label("Find an action");
            ui.text_edit_singleline(&mut text).labelled_by(label.id).request_focus();
            for (name, _, act) in actions() {
                if name != "Palette"
                    && name.to_lowercase().contains(&text.to_lowercase())
                    && ui.button(format!("{name} …")).clicked()
                {
                    act(self);
                    open = false;
                }
            }
        });
        self.palette = open.then_some(text);
    }
}
