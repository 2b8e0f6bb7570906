//! Building in the background: a worker with the latest draft only; what is out of date is cancelled.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};

use design::draft::{Draft, OnBody};
use design::regenerate::{Regenerated, Settings};
use eframe::egui::Context;

/// What a build came to.
pub(crate) struct Done {
    /// Which draft it is of.
    pub(crate) generation: u64,
    /// The body, where it could be made.
    pub(crate) on: Option<Arc<OnBody>>,
    /// The garment, nothing while the template is incomplete, or why there is none.
    pub(crate) garment: Result<Option<Box<Regenerated>>, String>,
}

/// The worker's near end.
pub(crate) struct Builder {
    sender: Sender<(u64, Arc<Draft>, Context)>,
    receiver: Receiver<Done>,
    latest: Arc<AtomicU64>,
    /// Whether a build is under way.
    pub(crate) busy: bool,
}

impl Builder {
    pub(crate) fn start() -> Self {
        let (sender, work) = channel::<(u64, Arc<Draft>, Context)>();
        let (results, receiver) = channel();
        let latest = Arc::new(AtomicU64::new(0));
        let newest = Arc::clone(&latest);
        std::thread::spawn(move || {
            let mut kept: Option<(Arc<design::draft::BodySource>, Arc<OnBody>)> = None;
            while let Ok((generation, draft, context)) = work.recv() {
                let current = || newest.load(Ordering::Relaxed) == generation;
                if !current() {
                    continue;
                }
                let same =
                    kept.as_ref().filter(|(source, _)| **source == *draft.body).map(|k| Arc::clone(&k.1));
                let on = match same {
                    Some(on) => Ok(on),
                    None => draft.body.load(None).map(Arc::new),
                };
                let done = match on {
                    Err(e) => Done { generation, on: None, garment: Err(e.to_string()) },
                    Ok(on) => {
                        kept = Some((Arc::clone(&draft.body), Arc::clone(&on)));
                        let complete = !draft.template.surfaces.is_empty();
                        let build = || draft.build(&on, &Settings::default(), &|_| current());
                        let garment = complete.then(build).transpose();
                        let garment = garment.map(|g| g.map(Box::new)).map_err(|e| e.to_string());
                        Done { generation, on: Some(on), garment }
                    }
                };
                if results.send(done).is_err() {
                    return;
                }
                context.request_repaint();
            }
        });
        Self { sender, receiver, latest, busy: false }
    }

    /// Builds this draft; an earlier build stops at its next step.
    pub(crate) fn build(&mut self, draft: &Arc<Draft>, context: &Context) {
        let generation = self.latest.fetch_add(1, Ordering::Relaxed) + 1;
        // The worker lives as long as this value.
        self.busy = self.sender.send((generation, Arc::clone(draft), context.clone())).is_ok();
    }

    /// The latest build, when it is ready.
    pub(crate) fn take(&mut self) -> Option<Done> {
        let latest = self.latest.load(Ordering::Relaxed);
        let done = self.receiver.try_iter().filter(|d| d.generation == latest).last()?;
        self.busy = false;
        Some(done)
    }
}
