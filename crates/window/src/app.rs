//! The application: what is being designed, tools, and the frame.

use std::path::PathBuf;
use std::sync::Arc;

use design::draft::{Autosave, Command, Draft, Edit, History, OnBody, edges, state_folder};
use design::regenerate::Regenerated;
use eframe::egui::{self, Key, PointerButton};
use glam::{DVec2, DVec3};
use mesh_kernel::files::write_atomically;
use sketch::{
    PickOptions, ProfileOptions, SpaceEdge, Stroke, bisecting_plane, fitted_plane, pick_edges, profiles,
};
use template::format::{At, NodeSpec};
use template::{Reference, encoding, node_frame, node_places};
use viewer::{Color, Hidden, Scene, SceneLine, SceneMesh, ScenePoint};

use crate::jobs::Builder;
use crate::view::View;

/// What the pointer does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Tool {
    Select,
    Node,
    Edge,
    Face,
    Sketch,
}

impl Tool {
    /// Every tool with its name, key and next step.
    pub(crate) const ALL: [(Self, &'static str, Key, &'static str); 5] = [
        (Self::Select, "Select", Key::V, "click a node; drag it to move it"),
        (Self::Node, "Node", Key::N, "click a feature point (a cross on the body)"),
        (Self::Edge, "Edge", Key::E, "click two nodes"),
        (Self::Face, "Face", Key::F, "click three nodes, then Enter, or four"),
        (Self::Sketch, "Sketch", Key::K, "draw over edges of faces: the stroke becomes their profile"),
    ];
}

/// The designer.
pub struct Designer {
    pub(crate) history: History,
    pub(crate) path: String,
    pub(crate) tool: Tool,
    pub(crate) selected: Vec<String>,
    pub(crate) message: String,
    pub(crate) surface: String,
    pub(crate) garment: Option<Box<Regenerated>>,
    pub(crate) builder: Builder,
    pub(crate) palette: Option<String>,
    on: Option<Arc<OnBody>>,
    anchors: Vec<(NodeSpec, String, DVec3)>,
    view: View,
    stroke: Vec<egui::Pos2>,
    dragging: bool,
    autosave: Autosave,
    stale: bool,
}

impl Designer {
    /// A designer at work on `draft`; `path` is the file that it came from.
    pub fn new(draft: Draft, path: Option<PathBuf>) -> Self {
        let surface = draft.template.surfaces.keys().next().cloned().unwrap_or_else(|| "surface".to_owned());
        Self {
            history: History::new(draft),
            path: path.map_or_else(|| "design.toile".to_owned(), |p| p.display().to_string()),
            tool: Tool::Select,
            selected: Vec::new(),
            message: String::new(),
            surface,
            garment: None,
            builder: Builder::start(),
            palette: None,
            on: None,
            anchors: Vec::new(),
            view: View::new(),
            stroke: Vec::new(),
            dragging: false,
            autosave: Autosave::start(&state_folder()),
            stale: true,
        }
    }

    /// The draft as it is.
    pub fn draft(&self) -> &Draft {
        self.history.draft()
    }

    /// Whether a garment has been built of the latest draft.
    pub fn is_built(&self) -> bool {
        !self.stale && !self.builder.busy && self.garment.is_some()
    }

    pub(crate) fn command(&mut self, command: Command) {
        match self.history.apply(command) {
            Ok(()) => {
                self.message.clear();
                self.autosave.changed(&self.history);
                self.stale = true;
            }
            Err(e) => self.message = e.to_string(),
        }
    }

    pub(crate) fn edit(&mut self, edit: Edit) {
        self.command(Command::Edit(edit));
    }

    pub(crate) fn open(&mut self) {
        let read = std::fs::read(&self.path).map_err(|e| e.to_string());
        match read.and_then(|bytes| Draft::from_bytes(&bytes).map_err(|e| e.to_string())) {
            Ok(draft) => {
                self.history = History::new(draft);
                self.selected.clear();
                self.stale = true;
                self.message = format!("opened {}", self.path);
            }
            Err(e) => self.message = format!("cannot open {}: {e}", self.path),
        }
    }

    pub(crate) fn save(&mut self) {
        // A template or a design of `regenerate` is not overwritten by a draft.
        let path = PathBuf::from(&self.path).with_extension("toile");
        self.message = match write_atomically(&path, &self.draft().to_bytes()) {
            Ok(()) => format!("saved {}", path.display()),
            Err(e) => format!("cannot save {}: {e}; choose another place in the path field", path.display()),
        };
    }

    pub(crate) fn export(&mut self) {
        let folder = PathBuf::from(&self.path).with_extension("export");
        let Some(garment) = &mut self.garment else {
            self.message = "nothing is built yet: fill faces first".to_owned();
            return;
        };
        let all = design::regenerate::Artifact::DEFAULT;
        self.message = match garment.write(&folder, &all, std::time::Instant::now()) {
            Ok(()) => format!("exported to {}", folder.display()),
            Err(e) => e.to_string(),
        };
    }

    pub(crate) fn look(&mut self, view: viewer::View) {
        self.view.look(view);
    }

    /// Takes what the worker has made and starts what is wanted.
    fn refresh(&mut self, context: &egui::Context) {
        if std::mem::take(&mut self.stale) {
            self.builder.build(self.history.draft(), context);
            self.redraw();
        }
        if let Some(done) = self.builder.take() {
            if let Some(on) = done.on {
                self.on = Some(on);
                self.find_anchors();
            }
            match done.garment {
                Ok(garment) => self.garment = garment,
                Err(e) => self.message = e,
            }
            self.redraw();
        }
    }

    /// Crossings of level curves with lines down the body, and feature points.
    fn find_anchors(&mut self) {
        let Some(on) = &self.on else { return };
        let features = &on.body.features;
        let mut anchors = Vec::new();
        for (level, _) in features.curves.iter().filter(|(n, c)| c.closed && n.ends_with("_tape")) {
            for (line, _) in features.curves.iter().filter(|(_, c)| !c.closed) {
                let Some(frame) = features.crossing(level, line) else { continue };
                let at = Some(At::Crossing([level.clone(), line.clone()]));
                let centre = line.starts_with("centre");
                let node = NodeSpec { at, centre, normal: 12.0, ..NodeSpec::default() };
                anchors.push((node, format!("{line}_{}", level.trim_end_matches("_tape")), frame.origin));
            }
        }
        for (name, point) in &features.points {
            let centre = point.position.x.abs() < 1.0;
            let node =
                NodeSpec { at: Some(At::Point(name.clone())), centre, normal: 12.0, ..NodeSpec::default() };
            anchors.push((node, format!("{name}_node"), point.position));
        }
        // In a mirrored template the left side is written, and the right one follows.
        if self.draft().template.mirrored {
            anchors.retain(|a| !a.1.starts_with("right_"));
        }
        self.anchors = anchors;
    }

    fn redraw(&mut self) {
        let Some(on) = &self.on else { return };
        let draft = Arc::clone(self.history.draft());
        let reference = Reference { mesh: &on.body.mesh, features: &on.body.features };
        match node_places(&draft.template, &reference) {
            Ok(places) => self.view.places = places,
            Err(e) => self.message = e.to_string(),
        }
        let mut scene = Scene { meshes: vec![SceneMesh::body(&on.body.mesh)], ..Scene::default() };
        if let Some(garment) = &self.garment {
            scene.meshes.push(SceneMesh::garment(&garment.mesh));
        }
        let places = &self.view.places;
        let have = edges(&draft.template);
        let drawn = have.iter().map(|(e, s)| (e, s.len())).chain(draft.wires.iter().map(|e| (e, 0)));
        for ([a, b], surfaces) in drawn {
            let (Some(a), Some(b)) = (places.get(a), places.get(b)) else { continue };
            // Joints by valence: wires grey, boundaries dark, seams red, more sheets than two blue.
            let color = [Color::FAINT_INK, Color::INK, Color::ACCENT, Color([40, 80, 200])][surfaces.min(3)];
            scene.lines.push(SceneLine { hidden: Hidden::Faint, ..SceneLine::new(vec![*a, *b], color, 2.0) });
        }
        let point = |position, color| ScenePoint { position, color, diameter: 9.0, hidden: Hidden::Faint };
        for name in places.keys() {
            let chosen = self.selected.contains(name);
            scene.points.push(point(places[name], if chosen { Color([240, 140, 0]) } else { Color::INK }));
        }
        self.view.show_scene(scene);
    }

    fn view_3d(&mut self, ui: &mut egui::Ui) {
        let rect = ui.available_rect_before_wrap();
        let response = ui.allocate_rect(rect, egui::Sense::click_and_drag());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, "3D view"));
        self.view.paint(ui, rect);
        let local = |p: egui::Pos2| DVec2::new(f64::from(p.x - rect.min.x), f64::from(p.y - rect.min.y));
        if self.tool == Tool::Node {
            for (_, _, place) in &self.anchors {
                if let Some(at) = self.view.screen(rect, *place) {
                    ui.painter().text(
                        at,
                        egui::Align2::CENTER_CENTER,
                        "+",
                        egui::FontId::proportional(16.0),
                        egui::Color32::BLUE,
                    );
                }
            }
        }
        let pointer = response.interact_pointer_pos();
        let shift = ui.input(|i| i.modifiers.shift);
        if response.dragged_by(PointerButton::Middle) || response.dragged_by(PointerButton::Secondary) {
            let by = response.drag_delta();
            if shift { self.view.pan(by) } else { self.view.orbit(by) }
        }
        if let Some(at) = response.hover_pos() {
            let scroll = ui.input(|i| i.smooth_scroll_delta().y);
            if scroll != 0.0 {
                self.view.zoom(f64::from(scroll * 0.004).exp(), local(at));
            }
        }
        let near = |view: &View, at: egui::Pos2| {
            let all = view
                .places
                .iter()
                .filter_map(|(n, p)| Some((view.screen(rect, *p)?.distance(at), n.clone())));
            all.filter(|(d, _)| *d < 10.0).min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, n)| n)
        };
        match (self.tool, pointer) {
            (Tool::Sketch, Some(at)) if response.dragged_by(PointerButton::Primary) => self.stroke.push(at),
            (Tool::Select, Some(at)) if response.drag_started_by(PointerButton::Primary) => {
                // A drag is known by its first movement; what it takes lay where it began.
                let from = ui.input(|i| i.pointer.press_origin()).unwrap_or(at);
                self.selected = near(&self.view, from).into_iter().collect();
                self.dragging = !self.selected.is_empty();
                if !self.dragging {
                    self.message = "no node here; orbit with the right button".to_owned();
                }
            }
            (Tool::Select, _) if response.dragged_by(PointerButton::Primary) && self.dragging => {
                self.drag_node(response.drag_delta());
            }
            (tool, Some(at)) if response.clicked() => self.click(tool, at, near(&self.view, at), rect),
            _ => {}
        }
        if response.drag_stopped() {
            self.dragging = false;
            let stroke = std::mem::take(&mut self.stroke);
            if self.tool == Tool::Sketch && stroke.len() > 1 {
                self.sketch(
                    &stroke.iter().map(|p| local(*p)).collect::<Vec<_>>(),
                    f64::from(ui.ctx().zoom_factor()),
                );
            }
        }
        ui.painter().line(self.stroke.clone(), egui::Stroke::new(2.0, egui::Color32::RED));
    }

    fn click(&mut self, tool: Tool, at: egui::Pos2, node: Option<String>, rect: egui::Rect) {
        match (tool, node) {
            (Tool::Node, _) => {
                let seen =
                    self.anchors.iter().filter_map(|a| Some((self.view.screen(rect, a.2)?.distance(at), a)));
                let nearest = seen.filter(|(d, _)| *d < 12.0).min_by(|a, b| {
                    // Of those under the pointer the one in front.
                    self.view.camera.depth(b.1.2).total_cmp(&self.view.camera.depth(a.1.2))
                });
                match nearest.map(|(_, a)| (a.1.clone(), a.0.clone())) {
                    Some((name, node)) => self.edit(Edit::CreateNode { name, node }),
                    None => self.message = "no feature point here; click one of the blue crosses".to_owned(),
                }
            }
            (Tool::Select | Tool::Sketch, node) => self.selected = node.into_iter().collect(),
            (Tool::Edge | Tool::Face, None) => self.message = "no node here".to_owned(),
            (_, Some(node)) => {
                self.selected.push(node);
                if tool == Tool::Edge && self.selected.len() > 1 {
                    let to = self.selected.pop().unwrap_or_default();
                    let from = self.selected.pop().unwrap_or_default();
                    self.selected.clear();
                    self.edit(Edit::CreateEdge { from, to });
                } else if tool == Tool::Face && self.selected.len() == 4 {
                    self.fill();
                }
            }
        }
        self.redraw();
    }

    pub(crate) fn fill(&mut self) {
        let nodes = std::mem::take(&mut self.selected);
        self.edit(Edit::FillFace { surface: self.surface.clone(), nodes });
    }

    /// Moves the selected node across the line of sight; the way is encoded in its feature frame (eq. 1).
    fn drag_node(&mut self, by: egui::Vec2) {
        let (Some(name), Some(on)) = (self.selected.first().cloned(), self.on.clone()) else { return };
        let file = &self.draft().template;
        let Some(mut node) = file.nodes.get(&name).cloned() else {
            self.message = format!("{name} is a twin; move the left one");
            return;
        };
        let c = &self.view.camera;
        let Some(scale) = self.view.places.get(&name).and_then(|p| c.scale_at(*p)) else { return };
        let way = (c.right() * f64::from(by.x) - c.up * f64::from(by.y)) / scale;
        let reference = Reference { mesh: &on.body.mesh, features: &on.body.features };
        let offset =
            node_frame(file, &name, &reference).ok().and_then(|f| encoding::encode(&f, f.origin + way));
        match offset {
            Some(offset) => {
                node.normal += offset.normal;
                node.first += offset.first;
                node.second += offset.second;
            }
            // Between other nodes there is no frame: the world's axes (eq. 2).
            None => node.axes = Some((DVec3::from_array(node.axes.unwrap_or_default()) + way).to_array()),
        }
        self.command(Command::Continue(Edit::MoveNode { name, node }));
    }

    fn sketch(&mut self, points: &[DVec2], pixel_scale: f64) {
        let file = &self.draft().template;
        let names: Vec<[String; 2]> = edges(file).into_keys().collect();
        let places = &self.view.places;
        let known: Vec<_> =
            names.iter().filter(|[a, b]| places.contains_key(a) && places.contains_key(b)).collect();
        let space: Vec<SpaceEdge> =
            known.iter().map(|[a, b]| SpaceEdge { ends: [places[a], places[b]] }).collect();
        let camera = &self.view.camera;
        let drawn = Stroke::new(points).and_then(|stroke| {
            let options = PickOptions { pixel_scale, slack: 25.0 };
            let picked = pick_edges(camera, &stroke, &space, &self.view.sight(), &options);
            let meant: Vec<SpaceEdge> = picked.iter().map(|p| space[p.edge]).collect();
            let plane = match &meant[..] {
                [] => return Ok(Vec::new()),
                [one] => bisecting_plane(camera, one, &[])?,
                several => fitted_plane(camera, several)?,
            };
            profiles(camera, &stroke, &space, &picked, &plane, &ProfileOptions::default())
        });
        let edits: Vec<Edit> = match drawn {
            Err(e) => return self.message = e.to_string(),
            Ok(made) if made.is_empty() => {
                return self.message =
                    "the stroke is near both ends of no visible edge; draw from node to node".to_owned();
            }
            Ok(made) => made
                .into_iter()
                .map(|p| {
                    let nodes = known[p.edge].clone();
                    let on_edge = |l: &&template::format::LineSpec| {
                        l.through.len() == 2 && l.through.iter().all(|n| nodes.contains(n))
                    };
                    let name = file
                        .lines
                        .iter()
                        .find(|(_, l)| on_edge(l))
                        .map_or_else(|| format!("{}_{}", nodes[0], nodes[1]), |(n, _)| n.clone());
                    Edit::DrawProfile { name, nodes, points: p.points.iter().map(|p| p.to_array()).collect() }
                })
                .collect(),
        };
        edits.into_iter().for_each(|edit| self.edit(edit));
    }
}

impl eframe::App for Designer {
    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        let context = ui.ctx().clone();
        let dropped = context.input(|i| i.raw.dropped_files.first().map(|f| f.path().to_path_buf()));
        if let Some(path) = dropped {
            self.path = path.display().to_string();
            self.open();
        }
        self.refresh(&context);
        self.keys(&context);
        self.panels(ui);
        egui::CentralPanel::default().show(ui, |ui| self.view_3d(ui));
    }
}
