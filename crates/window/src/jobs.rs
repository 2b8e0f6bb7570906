//! Work in the background: previews while something is dragged, whole builds when it is let go, files at the end.
//!
//! Two workers hear of every draft. Each takes the newest only; a build that is out of date stops at its next stage, a
//! preview is short and runs to its end, so that a long drag shows something.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};

use design::draft::{BodySource, BuildError, Draft, DraggedForm, OnBody, faces, preview};
use design::regenerate::{RegenerateError, Regenerated, Settings};
use eframe::egui::Context;
use mesh_kernel::TriMesh;
use mesh_kernel::query::{Adjacency, RayCaster};
use rayon::prelude::*;
use template::{Prepared, WarmStart};

use crate::workshop::Stop;

/// A body, ready for everything.
pub(crate) struct Body {
    source: Arc<BodySource>,
    /// Made coarsely, for the eye while a measurement is dragged.
    is_coarse: bool,
    pub(crate) on: OnBody,
    pub(crate) caster: Arc<RayCaster>,
    /// Every edge has two faces.
    pub(crate) is_closed: bool,
}

/// A garment, ready to be shown.
pub(crate) struct Cloth {
    /// A group a surface.
    pub(crate) mesh: TriMesh,
    pub(crate) caster: Arc<RayCaster>,
    /// With pattern and report; `None`: a preview.
    pub(crate) made: Option<Arc<Regenerated>>,
    /// Distance to the body a node, mm, negative inside; of whole garments only.
    pub(crate) distances: Vec<f64>,
}

/// What a job came to.
pub(crate) struct Done {
    pub(crate) generation: u64,
    pub(crate) is_whole: bool,
    /// The body, where it could be made.
    pub(crate) body: Option<Arc<Body>>,
    /// The garment, nothing while the template is incomplete, or why there is none.
    pub(crate) cloth: Result<Option<Arc<Cloth>>, String>,
}

/// A job that may be stopped.
#[derive(Clone)]
struct Order {
    generation: u64,
    draft: Arc<Draft>,
    context: Context,
}

/// Triangles of a preview: three times fewer than the eye needs at rest, and fast.
const PREVIEW_FACES: usize = 4000;
/// Triangles of a body whose measurements are being dragged: about the fewest that a form can have.
pub(crate) const PREVIEW_BODY: usize = 6500;

#[derive(Default)]
struct Shared {
    /// The newest draft; whole builds of older ones stop.
    newest: AtomicU64,
    step: Mutex<String>,
    /// The whole body that was made last, and the coarse one.
    bodies: Mutex<[Option<Arc<Body>>; 2]>,
    /// The form made last, for its measurements to be dragged.
    dragged: Mutex<Option<(Arc<BodySource>, Arc<DraggedForm>)>>,
    /// What previews leave to each other.
    warm: WarmStart,
}

/// The workers' near end.
pub(crate) struct Builder {
    whole: Sender<Order>,
    rough: Sender<Order>,
    receiver: Receiver<Done>,
    shared: Arc<Shared>,
    /// The last result that was taken, and whether it was whole.
    taken: (u64, bool),
    waiting: Option<u64>,
}

impl Builder {
    pub(crate) fn start() -> Self {
        let shared = Arc::new(Shared::default());
        let (results, receiver) = channel();
        let worker = |is_whole: bool| {
            let (sender, orders) = channel::<Order>();
            let (shared, results) = (Arc::clone(&shared), results.clone());
            std::thread::spawn(move || {
                while let Ok(mut order) = orders.recv() {
                    while let Ok(newer) = orders.try_recv() {
                        order = newer;
                    }
                    let send = |done| {
                        let is_heard = results.send(done).is_ok();
                        order.context.request_repaint();
                        is_heard
                    };
                    if let Some(done) = shared.carry_out(&order, is_whole, &send)
                        && !send(done)
                    {
                        return;
                    }
                    if is_whole && order.generation == shared.newest.load(Ordering::Relaxed) {
                        shared.ready_for_dragging();
                    }
                }
            });
            sender
        };
        Self { whole: worker(true), rough: worker(false), receiver, shared, taken: (0, false), waiting: None }
    }

    /// Previews this draft.
    pub(crate) fn preview(&mut self, draft: &Arc<Draft>, context: &Context) {
        let order = self.order(draft, context);
        // Workers live as long as this value.
        let _ = self.rough.send(order);
    }

    /// Builds this draft whole; where the body is at hand a preview comes first.
    pub(crate) fn build(&mut self, draft: &Arc<Draft>, context: &Context) {
        let order = self.order(draft, context);
        self.waiting = Some(order.generation);
        if self.shared.has_body(&draft.body) {
            let _ = self.rough.send(order.clone());
        }
        let _ = self.whole.send(order);
    }

    fn order(&mut self, draft: &Arc<Draft>, context: &Context) -> Order {
        let generation = self.shared.newest.fetch_add(1, Ordering::Relaxed) + 1;
        Order { generation, draft: Arc::clone(draft), context: context.clone() }
    }

    /// Stops what is being built; what is shown stays.
    pub(crate) fn cancel(&mut self) {
        self.shared.newest.fetch_add(1, Ordering::Relaxed);
        self.waiting = None;
    }

    /// What is being done, while something is.
    pub(crate) fn step(&self) -> Option<String> {
        self.waiting?;
        Some(self.shared.step.lock().unwrap_or_else(PoisonError::into_inner).clone())
    }

    /// The newest result, when there is one that is newer than the last.
    pub(crate) fn take(&mut self) -> Option<Done> {
        let taken = self.taken;
        let rank = |d: &Done| (d.generation, d.is_whole);
        let newest = self.receiver.try_iter().filter(|d| rank(d) > taken).max_by_key(rank)?;
        self.taken = rank(&newest);
        if self.waiting.is_some_and(|w| w < newest.generation || w == newest.generation && newest.is_whole) {
            self.waiting = None;
        }
        Some(newest)
    }
}

impl Shared {
    /// Does what is asked, and sends a preview ahead when there was nothing to be seen of the body yet.
    fn carry_out(&self, order: &Order, is_whole: bool, send: &dyn Fn(Done) -> bool) -> Option<Done> {
        let generation = order.generation;
        let is_current = || self.newest.load(Ordering::Relaxed) == generation;
        if is_whole && !is_current() {
            return None;
        }
        let tell = |step: &str| {
            if is_whole {
                step.clone_into(&mut self.step.lock().unwrap_or_else(PoisonError::into_inner));
                order.context.request_repaint();
            }
            !is_whole || is_current()
        };
        tell("making the body");
        let is_seen = self.at_hand(&order.draft.body, false).is_some();
        let body = match self.body(&order.draft.body, is_whole) {
            Ok(body) => body,
            Err(e) => return Some(Done { generation, is_whole, body: None, cloth: Err(e.to_string()) }),
        };
        if order.draft.template.surfaces.is_empty() {
            return Some(Done { generation, is_whole, body: Some(body), cloth: Ok(None) });
        }
        if is_whole && !is_seen {
            let cloth = rough(&order.draft, &body, &self.warm).map(|cloth| Some(Arc::new(cloth)));
            let cloth = cloth.map_err(|e| e.to_string());
            send(Done { generation, is_whole: false, body: Some(Arc::clone(&body)), cloth });
        }
        let cloth =
            if is_whole { whole(&order.draft, &body, &tell) } else { rough(&order.draft, &body, &self.warm) };
        let cloth = match cloth {
            Err(BuildError::Regenerate(RegenerateError::Cancelled)) => return None,
            Ok(cloth) => Ok(Some(Arc::new(cloth))),
            Err(e) => Err(e.to_string()),
        };
        Some(Done { generation, is_whole, body: Some(body), cloth })
    }

    fn has_body(&self, source: &Arc<BodySource>) -> bool {
        self.at_hand(source, true).is_some()
    }

    /// The body of a source that has been made, whole or else coarse.
    fn at_hand(&self, source: &Arc<BodySource>, is_whole: bool) -> Option<Arc<Body>> {
        let bodies = self.bodies.lock().unwrap_or_else(PoisonError::into_inner);
        let same = |b: &&Arc<Body>| Arc::ptr_eq(&b.source, source) || b.source == *source;
        bodies.iter().flatten().filter(|b| !is_whole || !b.is_coarse).find(same).cloned()
    }

    /// The body of a source: one that is at hand, or one that is made. A preview takes a whole one where there is one.
    fn body(&self, source: &Arc<BodySource>, is_whole: bool) -> Result<Arc<Body>, BuildError> {
        if let Some(body) = self.at_hand(source, is_whole) {
            return Ok(body);
        }
        let is_coarse = !is_whole && matches!(**source, BodySource::Form(_));
        let dragged = if is_coarse { self.dragged(source) } else { None };
        let (on, caster, is_closed) = match dragged {
            Some((on, caster)) => (on, caster, true),
            None => {
                let body = source.human((!is_whole).then_some(PREVIEW_BODY))?;
                let (prepared, (caster, is_closed)) = rayon::join(
                    || Prepared::new(&body.mesh),
                    || (RayCaster::new(&body.mesh), Adjacency::new(&body.mesh).is_closed_manifold()),
                );
                (OnBody { name: source.name(), body, prepared }, caster, is_closed)
            }
        };
        let body =
            Arc::new(Body { source: Arc::clone(source), is_coarse, on, caster: Arc::new(caster), is_closed });
        let mut bodies = self.bodies.lock().unwrap_or_else(PoisonError::into_inner);
        bodies[usize::from(is_coarse)] = Some(Arc::clone(&body));
        Ok(body)
    }

    /// The last form with these measurements, where it can follow them.
    fn dragged(&self, source: &BodySource) -> Option<(OnBody, RayCaster)> {
        let BodySource::Form(measurements) = source else { return None };
        let at_hand = self.dragged.lock().unwrap_or_else(PoisonError::into_inner).clone();
        let form = match at_hand {
            Some((_, form)) => form,
            None => self.ready_for_dragging()?,
        };
        form.at(measurements).ok()
    }

    /// Makes the form of the last whole body ready for its measurements to be dragged, unless it is.
    fn ready_for_dragging(&self) -> Option<Arc<DraggedForm>> {
        let whole = self.bodies.lock().unwrap_or_else(PoisonError::into_inner)[0].clone()?;
        let lock = || self.dragged.lock().unwrap_or_else(PoisonError::into_inner);
        let BodySource::Form(measurements) = &*whole.source else { return None };
        if let Some((_, form)) = lock().as_ref().filter(|(source, _)| *source == whole.source) {
            return Some(Arc::clone(form));
        }
        // Where none can be made every preview makes a coarse form, slower.
        let made = DraggedForm::new(measurements, &whole.on.body, PREVIEW_BODY).ok().flatten().map(Arc::new);
        *lock() = made.clone().map(|form| (Arc::clone(&whole.source), form));
        made
    }
}

/// The garment with its pattern, and what the maps show.
fn whole(draft: &Draft, body: &Body, tell: &(dyn Fn(&str) -> bool + Sync)) -> Result<Cloth, BuildError> {
    let made = draft.build(&body.on, &Settings::default(), tell)?;
    tell("measuring distances");
    let distances = made.mesh.positions.par_iter().map(|p| body.on.prepared.distance(*p)).collect();
    let mesh = made.mesh.clone();
    let caster = Arc::new(RayCaster::new(&mesh));
    Ok(Cloth { mesh, caster, made: Some(Arc::new(made)), distances })
}

/// A coarse garment without pattern.
fn rough(draft: &Draft, body: &Body, warm: &WarmStart) -> Result<Cloth, BuildError> {
    let coarse: usize =
        draft.template.surfaces.values().flat_map(faces).map(|f| f.len() - 2).sum::<usize>().max(1);
    let coarse = if draft.template.mirrored { 2 * coarse } else { coarse };
    let levels = (0..draft.template.level).take_while(|l| coarse << (2 * (l + 1)) <= PREVIEW_FACES).count();
    let garment = preview(draft, &body.on, levels as u8, warm, &AtomicBool::new(false))?;
    let mesh = garment.body.to_tri_mesh();
    let caster = Arc::new(RayCaster::new(&mesh));
    Ok(Cloth { mesh, caster, made: None, distances: Vec::new() })
}

/// Work that ends in a file: named, so that the status line can tell.
pub(crate) struct FileJob {
    pub(crate) what: String,
    receiver: Receiver<Result<String, String>>,
    stop: Stop,
}

impl FileJob {
    /// Runs `work` on a thread of its own; what it returns is said when it is done.
    pub(crate) fn start(
        what: String,
        context: &Context,
        work: impl FnOnce(&Stop) -> Result<String, String> + Send + 'static,
    ) -> Self {
        let (sender, receiver) = channel();
        let context = context.clone();
        let stop = Stop::default();
        let asked = stop.clone();
        std::thread::spawn(move || {
            // Nobody listens any more when the window is closed.
            let _ = sender.send(work(&asked));
            context.request_repaint();
        });
        Self { what, receiver, stop }
    }

    /// Stops it, unless it writes already; whether it could. What it is in the midst of it may end, for nobody.
    pub(crate) fn stop(&self) -> bool {
        self.stop.now()
    }

    /// What it came to, once.
    pub(crate) fn take(&self) -> Option<Result<String, String>> {
        match self.receiver.try_recv() {
            Ok(done) => Some(done),
            Err(std::sync::mpsc::TryRecvError::Empty) => None,
            Err(std::sync::mpsc::TryRecvError::Disconnected) => Some(Err(format!("{} stopped", self.what))),
        }
    }
}
