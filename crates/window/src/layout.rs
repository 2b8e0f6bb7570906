//! Which panels stand about the view, and how large they are: arrangements that can be kept under names.

use eframe::egui;
use serde::{Deserialize, Serialize};

use crate::designer::Designer;
use crate::prompts::Prompt;

/// A panel beside the 3D view.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Panel {
    pub(crate) is_shown: bool,
    /// Width, or height of the pattern, points.
    pub(crate) size: f32,
}

/// Panels of the garment's workspace, in the order of [`Layout::PANELS`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub(crate) struct Layout {
    pub(crate) panels: [Panel; 3],
}

pub(crate) const OUTLINE: usize = 0;
pub(crate) const PATTERN: usize = 1;
pub(crate) const INSPECTOR: usize = 2;

impl Default for Layout {
    fn default() -> Self {
        let panel = |size| Panel { is_shown: true, size };
        Self { panels: [panel(190.0), panel(300.0), panel(330.0)] }
    }
}

impl Layout {
    pub(crate) const PANELS: [(&'static str, &'static str); 3] = [
        ("Outline panel", "Everything by name, at the left"),
        ("Pattern panel", "The flat pattern, at the upper right"),
        ("Inspector panel", "What is selected, in numbers, at the right"),
    ];
}

/// A layout with its name.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct NamedLayout {
    pub(crate) name: String,
    pub(crate) layout: Layout,
}

impl Designer {
    /// A panel's name for the interface. Another layout has other panels, which have the sizes that it says.
    pub(crate) fn panel_id(&self, panel: usize) -> (&'static str, usize, usize) {
        ("panel", panel, self.layouts_taken)
    }

    pub(crate) fn toggle_panel(&mut self, panel: usize) {
        let panel = &mut self.preferences.layout.panels[panel];
        panel.is_shown = !panel.is_shown;
        self.preferences.save(&self.state);
    }

    pub(crate) fn take_layout(&mut self, layout: Layout) {
        self.layouts_taken += 1;
        self.prefer(|p| p.layout = layout);
    }

    pub(crate) fn take_named_layout(&mut self, number: usize) {
        if let Some(named) = self.preferences.layouts.get(number) {
            self.take_layout(named.layout);
        }
    }

    /// Keeps the arrangement as it is under a name; one that has this name already is replaced.
    pub(crate) fn keep_layout(&mut self, name: &str) {
        let named = NamedLayout { name: name.trim().to_owned(), layout: self.preferences.layout };
        self.prefer(|p| match p.layouts.iter_mut().find(|l| l.name == named.name) {
            Some(old) => *old = named,
            None => p.layouts.push(named),
        });
    }
}

/// What a person wants of layouts.
pub(crate) enum LayoutAnswer {
    None,
    Close,
    Keep(String),
    Delete(usize),
}

/// Asks for a name; what is kept already can be deleted here.
pub(crate) fn ask(ui: &mut egui::Ui, text: &mut String, kept: &[NamedLayout]) -> LayoutAnswer {
    let mut answer = LayoutAnswer::None;
    ui.heading("Keep the layout");
    ui.label("Which panels are shown and how large they are; it stands in the Window menu then.");
    let label = ui.label("Name");
    let field = ui.add(egui::TextEdit::singleline(text).desired_width(f32::INFINITY)).labelled_by(label.id);
    let is_entered = field.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
    if ui.memory(|m| m.focused().is_none()) {
        field.request_focus();
    }
    for (k, named) in kept.iter().enumerate() {
        ui.horizontal(|ui| {
            let delete = format!("Delete layout {}", named.name);
            let button = ui.small_button("×").on_hover_text(&delete);
            button.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &delete));
            if button.clicked() {
                answer = LayoutAnswer::Delete(k);
            }
            ui.label(&named.name);
        });
    }
    ui.horizontal(|ui| {
        let is_named = !text.trim().is_empty();
        let is_kept = ui.add_enabled(is_named, egui::Button::new("Keep")).clicked();
        if is_kept || is_entered && is_named {
            answer = LayoutAnswer::Keep(text.clone());
        }
        if ui.button("Cancel").clicked() {
            answer = LayoutAnswer::Close;
        }
    });
    answer
}

impl Prompt {
    pub(crate) fn layout() -> Self {
        Self::Layout { name: String::new() }
    }
}
