//! What follows from a change: places and lines at once, previews and whole garments when the workers have made them.

use std::sync::Arc;

use design::draft::BodySource;
use eframe::egui;
use mesh_kernel::TriMesh;

use crate::designer::{Designer, Stale};
use crate::jobs::FileJob;
use crate::model::SeenMesh;
use crate::view::{Part, scene};

/// Garments of earlier drafts that are kept, for undo to show them at once.
const KEPT: usize = 8;

impl Designer {
    /// Brings everything that is derived up to the draft.
    pub(crate) fn follow(&mut self) {
        let draft = Arc::clone(self.session.draft());
        if self.stale == Stale::Whole
            && let Some((_, body, cloth)) = self.kept.iter().find(|(d, ..)| Arc::ptr_eq(d, &draft))
        {
            (self.model.body, self.model.cloth) = (Some(Arc::clone(body)), Some(Arc::clone(cloth)));
            self.show_solids();
            self.builder.cancel();
            self.stale = Stale::Nothing;
            self.built = Some(Arc::clone(&draft));
        }
        if draft.template.surfaces.is_empty() && self.model.cloth.take().is_some() {
            self.show_solids();
        }
        if let Err(e) = self.model.follow(&draft) {
            self.problem(e);
        }
        self.model.find_anchors(&draft);
        let places = &self.model.places;
        self.session.selection.elements.retain(|e| e.is_in(&draft, places));
        if !draft.template.surfaces.contains_key(&self.session.surface)
            && self.session.surface.is_empty()
            && let Some(first) = draft.template.surfaces.keys().next()
        {
            self.session.surface.clone_from(first);
        }
        self.show_lines();
    }

    /// The garments of the design before are of no use to the next.
    pub(crate) fn forget_garments(&mut self) {
        self.kept.clear();
        self.builder.cancel();
        (self.export_to, self.model.cloth, self.last_made) = (None, None, None);
        self.stale = Stale::Whole;
        self.is_framed = false;
        self.follow();
        self.show_solids();
    }

    /// Shows the mesh of which no body could be made.
    fn see_mesh(&mut self) {
        let BodySource::Mesh(body) = &*self.session.draft().body else { return };
        let mesh = self.first_mesh.as_ref().filter(|first| first.faces == body.faces).cloned();
        let mesh = mesh.unwrap_or_else(|| {
            let positions = body.positions.iter().map(|p| glam::DVec3::from_array(*p)).collect();
            TriMesh::new(positions, body.faces.clone())
        });
        self.model.seen = Some(SeenMesh::new(mesh));
    }

    /// Another body or garment is there.
    pub(crate) fn show_solids(&mut self) {
        let seen = self.model.seen.as_ref();
        let caster = self.model.body.as_ref().map(|b| &b.caster).or(seen.map(|s| &s.caster));
        self.view.solids.body = caster.map(Arc::clone);
        self.view.solids.garment =
            self.model.cloth.as_ref().filter(|_| self.look.garment).map(|c| Arc::clone(&c.caster));
        self.view.set_x_ray(self.look.x_ray);
        // Most of what is new is a garment on the same body.
        let shown = self.model.body.clone().filter(|_| self.look.body).map(|body| (body, self.look.section));
        let is_same = match (&shown, &self.shown_body) {
            (Some((new, section)), Some((old, cut))) => Arc::ptr_eq(new, old) && section == cut,
            (None, None) => true,
            _ => false,
        };
        if !is_same || seen.is_some() {
            let is_closed = shown.as_ref().is_some_and(|(body, section)| body.is_closed && section.is_none());
            self.view.set_mesh(Part::Body, scene::body(&self.model, &self.look), is_closed);
            self.shown_body = shown;
        }
        self.view.set_mesh(Part::Garment, scene::garment(&self.model, &self.look), false);
        self.show_lines();
    }

    pub(crate) fn show_lines(&mut self) {
        let (lines, points) = scene::template_lines(&self.model, &self.look);
        self.view.set_lines(lines, points);
    }

    /// Takes what the workers have made and starts what is wanted.
    pub(crate) fn refresh(&mut self, context: &egui::Context) {
        if let Some(done) = self.builder.take() {
            let is_new_body = done.body.is_some();
            match done.body {
                Some(body) => (self.model.body, self.model.seen) = (Some(body), None),
                None if self.model.body.is_none() => self.see_mesh(),
                None => {}
            }
            match done.cloth {
                Ok(cloth) => {
                    // What was made of an earlier draft may still come in.
                    let is_latest = self.stale == Stale::Nothing && self.builder.step().is_none();
                    if done.is_whole && is_latest {
                        let draft = Arc::clone(self.session.draft());
                        self.built = Some(Arc::clone(&draft));
                        if let (Some(cloth), Some(body)) = (&cloth, &self.model.body) {
                            self.kept.retain(|(d, ..)| !Arc::ptr_eq(d, &draft));
                            self.kept.push_front((draft, Arc::clone(body), Arc::clone(cloth)));
                            self.kept.truncate(KEPT);
                        }
                    }
                    self.model.cloth = cloth;
                }
                // The whole build that follows says so too.
                Err(_) if !done.is_whole && self.builder.step().is_some() => {}
                Err(e) => {
                    self.export_to = None;
                    let name = self.draft().body.name().to_owned();
                    self.problem(match self.model.seen {
                        Some(_) => format!("{name} is shown as a mesh to look at, for it is no body: {e}"),
                        None => e,
                    });
                }
            }
            let draft = Arc::clone(self.session.draft());
            if is_new_body && let Err(e) = self.model.follow(&draft) {
                self.problem(e);
            }
            self.model.find_anchors(&draft);
            self.show_solids();
            if !std::mem::replace(&mut self.is_framed, true) {
                self.frame_all();
            }
        }
        match self.stale {
            Stale::Nothing => {}
            Stale::Rough => self.builder.preview(self.session.draft(), context),
            Stale::Whole => self.builder.build(self.session.draft(), context),
        }
        self.stale = Stale::Nothing;
        if self.is_built()
            && let Some(folder) = self.export_to.take()
        {
            self.export(folder, context);
        }
        if let Some(done) = self.file_job.as_ref().and_then(FileJob::take) {
            self.file_job = None;
            match done {
                Ok(text) => self.notices.say(text),
                Err(text) => self.problem(text),
            }
        }
    }
}
