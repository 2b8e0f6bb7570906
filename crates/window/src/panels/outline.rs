//! The outline: everything that the design has, by name; also the way to it for the keyboard.

use std::sync::Arc;

use design::draft::{BodySource, Edit};
use eframe::egui;

use crate::designer::Designer;
use crate::selection::{Element, Mode, joint_name, joints_of};

impl Designer {
    pub(crate) fn outline(&mut self, ui: &mut egui::Ui) {
        // A long name must not move the views beside it.
        ui.style_mut().wrap_mode = Some(egui::TextWrapMode::Truncate);
        let draft = Arc::clone(self.session.draft());
        let file = &draft.template;
        let mut chosen: Option<(Mode, Element)> = None;
        let mut hovered: Option<Element> = None;
        let mut gone: Option<Edit> = None;
        let mut entry = |ui: &mut egui::Ui, is_on: bool, text: String, mode: Mode, element: Element| {
            let response = ui.selectable_label(is_on, text);
            if response.clicked() {
                chosen = Some((mode, element.clone()));
            }
            if response.hovered() {
                hovered = Some(element);
            }
        };
        section(ui, "Surfaces", file.surfaces.len(), |ui| {
            for name in file.surfaces.keys() {
                let is_on = self.session.surface == *name;
                let element = Element::Face { surface: name.clone(), face: 0 };
                entry(ui, is_on, name.clone(), Mode::Patches, element);
            }
        });
        let label = ui.label("New faces go to");
        ui.text_edit_singleline(&mut self.session.surface).labelled_by(label.id);
        section(ui, "Nodes", file.nodes.len(), |ui| {
            for name in file.nodes.keys() {
                let element = Element::Node(name.clone());
                entry(ui, self.session.selection.contains(&element), name.clone(), Mode::Nodes, element);
            }
        });
        let wires: Vec<_> = draft.wires.iter().collect();
        section(ui, "Loose edges", wires.len(), |ui| {
            for [a, b] in wires {
                let element = Element::edge(a, b);
                let is_on = self.session.selection.contains(&element);
                entry(ui, is_on, format!("{a} – {b}"), Mode::Edges, element);
            }
        });
        let joints = joints_of(&draft);
        section(ui, "Joints", joints.len(), |ui| {
            for (k, joint) in joints.iter().enumerate() {
                let element = Element::Joint(k);
                let text = format!("{} ({})", joint_name(joint), joint.surfaces.len());
                entry(ui, self.session.selection.contains(&element), text, Mode::Joints, element);
            }
        });
        section(ui, "Lines", file.lines.len(), |ui| {
            for name in file.lines.keys() {
                deletable(ui, name, "line", &mut gone, || Edit::DeleteProfile { name: name.clone() });
            }
        });
        section(ui, "Curves drawn on the body", draft.features.len(), |ui| {
            for name in draft.features.keys() {
                deletable(ui, name, "curve", &mut gone, || Edit::DeleteFeature { name: name.clone() });
            }
        });
        ui.separator();
        ui.strong("Body");
        ui.label(match &*draft.body {
            BodySource::Form(_) => "dress form".to_owned(),
            BodySource::Mesh(mesh) => format!("{}: {} triangles", mesh.file, mesh.faces.len()),
        });
        if hovered.is_some() {
            self.hovered = hovered;
        }
        if let Some((mode, element)) = chosen {
            self.session.mode = mode;
            let add = ui.input(|i| i.modifiers.shift);
            if add { self.session.selection.toggle(vec![element]) } else { self.select(vec![element]) }
        }
        if let Some(edit) = gone {
            self.edit(edit);
        }
    }
}

/// A heading with what is under it, folded away when there is nothing.
pub(crate) fn section(ui: &mut egui::Ui, name: &str, count: usize, inside: impl FnOnce(&mut egui::Ui)) {
    if count > 0 {
        let header = egui::CollapsingHeader::new(format!("{name} ({count})")).id_salt(name);
        header.default_open(true).show(ui, inside);
    }
}

fn deletable(
    ui: &mut egui::Ui,
    name: &str,
    kind: &str,
    gone: &mut Option<Edit>,
    edit: impl FnOnce() -> Edit,
) {
    ui.horizontal(|ui| {
        let delete = format!("Delete {kind} {name}");
        let button = ui.small_button("×").on_hover_text(&delete);
        button.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &delete));
        if button.clicked() {
            *gone = Some(edit());
        }
        ui.label(name);
    });
}
