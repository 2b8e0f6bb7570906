//! The inspector: what is selected, in numbers; eases; the body.

use std::sync::Arc;

use design::draft::{BodySource, Draft, Edit, MEASURES, Named, measure};
use eframe::egui::{self, Response, Slider};
use reference::dress_form::presets;
use template::format::{EaseSpec, NodeSpec, PieceSpec};

use crate::actions::remedy;
use crate::designer::Designer;
use crate::selection::{Element, joint_name, joints_of};
use crate::units::LengthUnit;
use crate::view::scene::Section;

/// A slider of millimetres in the unit that is shown; typed values may name another.
fn length(value: &mut f64, range: std::ops::RangeInclusive<f64>, unit: LengthUnit) -> Slider<'_> {
    Slider::new(value, range)
        .clamping(egui::SliderClamping::Never)
        .custom_formatter(move |mm, _| unit.text(mm))
        .custom_parser(move |text| unit.parse(text))
}

impl Designer {
    pub(crate) fn inspector(&mut self, ui: &mut egui::Ui) {
        let draft = Arc::clone(self.session.draft());
        match self.session.selection.elements.len() {
            0 => {
                let now = draft.template.name.clone();
                if let Some(name) = self.name_field(ui, "Design name", &now) {
                    let t = &draft.template;
                    let (clearance, level, mirrored) = (t.clearance, t.level, t.mirrored);
                    self.edit(Edit::SetTemplate { name, clearance, level, mirrored });
                }
            }
            1 => {
                if let Some(element) = self.session.selection.only().cloned() {
                    ui.strong(element.label(&draft));
                    match &element {
                        Element::Node(name) => self.node(ui, &draft, name),
                        Element::Edge(_) => self.edge(ui, &draft, &element),
                        Element::Face { surface, face } => self.face(ui, &draft, surface, *face),
                        Element::Joint(joint) => self.joint(ui, &draft, *joint),
                    }
                }
            }
            n => {
                ui.strong(format!("{n} selected"));
            }
        }
        self.section_plane(ui);
        self.eases(ui, &draft);
        self.body(ui, &draft);
    }

    /// A widget's new value as an edit: steps of one drag are one entry of the history.
    pub(crate) fn changed(&mut self, response: &Response, edit: Edit) {
        if response.changed() {
            // The frame in which the button goes up still belongs to the drag.
            let is_drag = response.dragged() || response.drag_stopped();
            if is_drag { self.live(response.id, edit) } else { self.edit(edit) }
        }
        if response.drag_stopped() {
            self.settle();
        }
    }

    fn node(&mut self, ui: &mut egui::Ui, draft: &Draft, name: &str) {
        let Some(spec) = draft.template.nodes.get(name) else {
            ui.weak("the twin of a node on the left, which it follows");
            return;
        };
        self.rename_field(ui, Named::Node, "Node name", name);
        let unit = self.preferences.unit;
        let mut node: NodeSpec = spec.clone();
        let mut all: Option<Response> = None;
        for (what, hint, value) in [
            ("outward", "along the body's normal (α)", &mut node.normal),
            ("along first", "along the first curve (β)", &mut node.first),
            ("along second", "along the second curve (γ)", &mut node.second),
        ] {
            let response = ui.add(length(value, -200.0..=200.0, unit).text(what)).on_hover_text(hint);
            all = Some(match all {
                Some(other) if other.changed() || other.dragged() || other.drag_stopped() => other,
                _ => response,
            });
        }
        if let Some(response) = all {
            self.changed(&response, Edit::MoveNode { name: name.to_owned(), node });
        }
    }

    fn edge(&mut self, ui: &mut egui::Ui, draft: &Draft, element: &Element) {
        let unit = self.preferences.unit;
        if let [a, b] = element.places(draft, &self.model.places)[..] {
            ui.label(format!("{} from node to node", unit.text(a.distance(b))));
        }
        if let Element::Edge(ends) = element
            && let Some(line) = self.line_on(ends)
        {
            self.rename_field(ui, Named::Line, "Profile name", &line);
        }
        if ui.button("Delete").on_hover_text("Its profile where it has one, else the edge").clicked() {
            self.delete();
        }
    }

    fn face(&mut self, ui: &mut egui::Ui, draft: &Draft, surface: &str, face: usize) {
        self.rename_field(ui, Named::Surface, "Surface name", surface);
        let mut chosen = None;
        egui::ComboBox::from_label("Assign to surface").selected_text(surface).show_ui(ui, |ui| {
            let others = draft.template.surfaces.keys().filter(|s| *s != surface);
            for other in others {
                if ui.selectable_label(false, other).clicked() {
                    chosen = Some(other.clone());
                }
            }
        });
        let wanted = self.session.surface.clone();
        if wanted != surface && !wanted.is_empty() && !draft.template.surfaces.contains_key(&wanted) {
            let text = format!("Assign to the new surface {wanted}");
            if ui.button(text).clicked() {
                chosen = Some(wanted);
            }
        }
        if let Some(to) = chosen {
            self.edit(Edit::AssignSurface { surface: surface.to_owned(), face, to });
        }
        ui.horizontal(|ui| {
            if ui.button("Delete face").clicked() {
                self.edit(Edit::DeleteFace { surface: surface.to_owned(), face });
            }
            if ui.button("Delete surface").clicked() {
                self.edit(Edit::DeleteSurface { surface: surface.to_owned() });
            }
        });
        let mut piece = draft.template.pieces.get(surface).cloned().unwrap_or_default();
        let label = piece.label.clone().unwrap_or_default();
        if let Some(label) = self.name_field(ui, "Piece label", &label) {
            let label = Some(label).filter(|l| !l.is_empty());
            let piece = PieceSpec { label, ..piece.clone() };
            self.edit(Edit::EditPiece { surface: surface.to_owned(), piece });
        }
        let mut allowance = piece.allowance.unwrap_or(10.0);
        let response =
            ui.add(length(&mut allowance, 0.0..=40.0, self.preferences.unit).text("seam allowance"));
        piece.allowance = Some(allowance);
        self.changed(&response, Edit::EditPiece { surface: surface.to_owned(), piece });
    }

    fn joint(&mut self, ui: &mut egui::Ui, draft: &Draft, number: usize) {
        let joints = joints_of(draft);
        let Some(joint) = joints.get(number) else { return };
        ui.label(joint.nodes.join(" – "));
        if draft.template.joints.is_some() {
            self.joint_name_field(ui, number);
        }
        if joint.surfaces.len() > 3 {
            ui.label("Split it: these two in one joint, the others in another");
            let mut split = None;
            for (k, a) in joint.surfaces.iter().enumerate() {
                for b in &joint.surfaces[k + 1..] {
                    if ui.button(format!("{a} + {b}")).clicked() {
                        split = Some(vec![a.clone(), b.clone()]);
                    }
                }
            }
            if let Some(first) = split {
                self.edit(Edit::SplitJoint { joint: number, first });
            }
        } else {
            ui.weak(format!("{} surfaces meet; four and more can be split", joint.surfaces.len()));
        }
        let groups = &draft.template.fair_across;
        let is_member = |g: &Vec<String>| joint.surfaces.iter().all(|s| g.contains(s));
        let mut is_smooth = groups.iter().any(is_member);
        let hint = format!("The cloth bends smoothly across {}", joint_name(joint));
        if ui.checkbox(&mut is_smooth, "Smooth across").on_hover_text(hint).changed() {
            let mut groups: Vec<Vec<String>> = groups.iter().filter(|g| !is_member(g)).cloned().collect();
            if is_smooth {
                groups.push(joint.surfaces.clone());
            }
            self.edit(Edit::SetFairAcross { groups });
        }
        if draft.template.joints.is_some() && ui.button(remedy::AUTOMATIC_JOINTS).clicked() {
            self.edit(Edit::AutomaticJoints);
        }
    }

    fn section_plane(&mut self, ui: &mut egui::Ui) {
        let Some(mut section) = self.look.section else { return };
        ui.separator();
        ui.strong("Section");
        ui.horizontal(|ui| {
            for (axis, name) in ["across", "level", "along"].into_iter().enumerate() {
                ui.selectable_value(&mut section.axis, axis, name);
            }
        });
        let range = if section.axis == 1 { 0.0..=2000.0 } else { -400.0..=400.0 };
        ui.add(length(&mut section.at, range, self.preferences.unit).text("plane"));
        if self.look.section != Some(section) {
            if self.look.section.is_some_and(|s| s.axis != section.axis) {
                section = Section { at: if section.axis == 1 { 1050.0 } else { 0.0 }, ..section };
            }
            self.relook(|look| look.section = Some(section));
        }
    }

    fn eases(&mut self, ui: &mut egui::Ui, draft: &Draft) {
        let made = self.last_made.as_ref().map(|m| m.garment.ease.clone());
        if draft.template.surfaces.is_empty() {
            return;
        }
        ui.separator();
        ui.strong("Ease");
        let unit = self.preferences.unit;
        for (level, spec) in &draft.template.ease {
            let mut ease: EaseSpec = spec.clone();
            ui.horizontal(|ui| {
                let response =
                    ui.add(length(&mut ease.ease, 0.0..=300.0, unit).text(format!("{level} ease")));
                let edit = Edit::SetEase { level: level.clone(), ease: Some(ease.clone()) };
                self.changed(&response, edit);
                let button = ui.small_button("×").on_hover_text(format!("No ease is asked at {level}"));
                let name = format!("Delete ease {level}");
                button.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &name));
                if button.clicked() {
                    self.edit(Edit::SetEase { level: level.clone(), ease: None });
                }
            });
            // A line in any case: what stands below must not move under the hand while a preview has no ease.
            let got = made.as_ref().and_then(|m| m.get(level));
            ui.weak(got.map_or_else(
                || "not built yet".to_owned(),
                |g| format!("the garment has {}", unit.text(*g)),
            ));
        }
        let levels = self.model.human().map(|h| {
            let closed = h.features.curves.iter().filter(|(n, c)| c.closed && n.ends_with("_tape"));
            closed.map(|(n, _)| n.trim_end_matches("_tape").to_owned()).collect::<Vec<_>>()
        });
        let mut chosen = None;
        egui::ComboBox::from_label("Ask for an ease").selected_text("…").show_ui(ui, |ui| {
            for level in levels.unwrap_or_default() {
                if !draft.template.ease.contains_key(&level) && ui.selectable_label(false, &level).clicked() {
                    chosen = Some(level);
                }
            }
        });
        if let Some(level) = chosen {
            let curve = Some(format!("{level}_tape"));
            let ease = EaseSpec { ease: 40.0, curve, surfaces: Vec::new() };
            self.edit(Edit::SetEase { level, ease: Some(ease) });
        }
    }

    fn body(&mut self, ui: &mut egui::Ui, draft: &Draft) {
        ui.separator();
        ui.strong("Body");
        let mut chosen = None;
        egui::ComboBox::from_label("Size").selected_text("choose …").height(400.0).show_ui(ui, |ui| {
            for preset in presets() {
                if ui.selectable_label(false, &preset.name).on_hover_text(preset.source).clicked() {
                    chosen = Some(BodySource::Form(preset.measurements.clone()));
                }
            }
        });
        if let Some(body) = chosen {
            self.edit(Edit::SwitchBody { body: Arc::new(body) });
        }
        let BodySource::Form(measurements) = &*draft.body else {
            ui.weak("a mesh has no measurements to change; choose a size to take a dress form");
            return;
        };
        for name in MEASURES {
            let Some(now) = measure(measurements, name) else { continue };
            let mut value = 10.0 * now;
            let range = 5.0 * now..=15.0 * now;
            let unit = match self.preferences.unit {
                LengthUnit::Inch => LengthUnit::Inch,
                // Tape measurements are centimetres everywhere else.
                LengthUnit::Millimetre | LengthUnit::Centimetre => LengthUnit::Centimetre,
            };
            // While it is dragged the ends stay where they were.
            let response = ui
                .push_id(name, |ui| {
                    let key = egui::Id::unique(("range", name));
                    let is_down = ui.input(|i| i.pointer.primary_down());
                    let kept = ui.data(|d| d.get_temp::<[f64; 2]>(key)).filter(|_| is_down);
                    let ends = kept.unwrap_or([*range.start(), *range.end()]);
                    ui.data_mut(|d| d.insert_temp(key, ends));
                    let slider = length(&mut value, ends[0]..=ends[1], unit).text(name.replace('_', " "));
                    ui.add(slider.clamping(egui::SliderClamping::Never))
                })
                .inner;
            let edit = Edit::SetMeasure { name: name.to_owned(), value: Some((value).round() / 10.0) };
            self.changed(&response, edit);
        }
    }
}
