//! Names, changed in the inspector.

use design::draft::{Edit, Named};
use eframe::egui;

use crate::designer::Designer;
use crate::layout::INSPECTOR;
use crate::selection::{Element, joints_of};

/// A name that is being written.
#[derive(Default)]
pub(crate) struct Naming {
    /// F2 was pressed: the first name of the inspector takes the keyboard.
    is_wanted: bool,
    /// The field, and what stands in it.
    writing: Option<(egui::Id, String)>,
}

impl Designer {
    /// Puts the keyboard into the name of what is selected.
    pub(crate) fn name_selected(&mut self) {
        let has_name = match self.session.selection.only() {
            Some(Element::Node(name)) => self.draft().template.nodes.contains_key(name),
            Some(Element::Edge(ends)) => self.line_on(ends).is_some(),
            Some(Element::Face { .. }) => true,
            Some(Element::Joint(_)) if self.draft().template.joints.is_none() => {
                return self.problem("joints that make themselves are named after their surfaces");
            }
            Some(Element::Joint(_)) => true,
            None => false,
        };
        if has_name {
            self.preferences.layout.panels[INSPECTOR].is_shown = true;
            self.naming.is_wanted = true;
        } else {
            self.problem("select one node, patch, joint or edge with a profile; these have names");
        }
    }

    /// A field with a name; says the new one when it is written.
    pub(crate) fn name_field(&mut self, ui: &mut egui::Ui, what: &str, now: &str) -> Option<String> {
        let id = ui.scope_id().with(("name", what, now));
        let written = self.naming.writing.as_ref().filter(|(field, _)| *field == id).map(|(_, t)| t.clone());
        let mut text = written.unwrap_or_else(|| now.to_owned());
        let response = ui
            .horizontal(|ui| {
                let label = ui.label(what);
                ui.add(egui::TextEdit::singleline(&mut text).id(id)).labelled_by(label.id)
            })
            .inner;
        if std::mem::take(&mut self.naming.is_wanted) {
            response.request_focus();
            let mut state = egui::text_edit::TextEditState::load(ui.ctx(), id).unwrap_or_default();
            let end = egui::text::CCursor::new(text.chars().count());
            let all = egui::text::CCursorRange::two(egui::text::CCursor::default(), end);
            state.cursor.set_char_range(Some(all));
            state.store(ui.ctx(), id);
        }
        if response.has_focus() {
            self.naming.writing = Some((id, text));
            return None;
        }
        if response.lost_focus() {
            self.naming.writing = None;
            let is_given_up = ui.input(|i| i.key_pressed(egui::Key::Escape));
            let text = text.trim();
            return (!is_given_up && text != now).then(|| text.to_owned());
        }
        None
    }

    /// A name that others refer to.
    pub(crate) fn rename_field(&mut self, ui: &mut egui::Ui, kind: Named, what: &str, now: &str) {
        let Some(to) = self.name_field(ui, what, now) else { return };
        let from = now.to_owned();
        let selection = self.session.selection.clone();
        let before = self.session.history().labels().1;
        self.edit(Edit::Rename { kind, from: from.clone(), to: to.clone() });
        if self.session.history().labels().1 == before {
            return;
        }
        // What is selected stays so under its new name.
        let renamed = |name: &mut String| {
            if *name == from {
                name.clone_from(&to);
            }
        };
        let mut elements = selection.elements;
        for element in &mut elements {
            match (kind, element) {
                (Named::Node, Element::Node(name)) => renamed(name),
                (Named::Node, Element::Edge(ends)) => {
                    ends.iter_mut().for_each(renamed);
                    ends.sort();
                }
                (Named::Surface, Element::Face { surface, .. }) => renamed(surface),
                _ => {}
            }
        }
        if kind == Named::Surface {
            renamed(&mut self.session.surface);
        }
        self.session.selection.replace(elements);
    }

    /// The line or profile on an edge alone.
    pub(crate) fn line_on(&self, ends: &[String; 2]) -> Option<String> {
        let lines = self.draft().template.lines.iter();
        let mut own =
            lines.filter(|(_, l)| l.through.len() == 2 && l.through.iter().all(|n| ends.contains(n)));
        own.next().map(|(name, _)| name.clone())
    }

    pub(crate) fn joint_name_field(&mut self, ui: &mut egui::Ui, number: usize) {
        let all = joints_of(self.draft());
        let now = all.get(number).and_then(|j| j.name.clone()).unwrap_or_default();
        if let Some(name) = self.name_field(ui, "Joint name", &now) {
            let name = Some(name).filter(|n| !n.is_empty());
            self.edit(Edit::NameJoint { joint: number, name });
        }
    }
}
