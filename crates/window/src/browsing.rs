//! The system's file dialog, beside the path field that is always there.
//!
//! It runs on a thread of its own: where there is no portal, or one that never answers, the window goes on.

use std::path::PathBuf;
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::time::{Duration, Instant};

use eframe::egui::Context;

/// What a file dialog is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PathKind {
    /// A file that is there.
    Open,
    /// A file that is written.
    Save,
    /// A folder that is written into.
    Folder,
}

/// What a file dialog begins with.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileWish {
    /// What it is for.
    pub kind: PathKind,
    /// Its title.
    pub title: String,
    /// The folder that it shows.
    pub folder: PathBuf,
    /// The name that it offers.
    pub name: String,
}

/// Asks a person for a path and waits for the answer; `None`: closed without one.
pub type FileDialog = fn(&FileWish) -> Option<PathBuf>;

/// The dialog of the desktop, by its portal.
pub(crate) fn system_dialog(wish: &FileWish) -> Option<PathBuf> {
    let dialog = rfd::FileDialog::new().set_title(&wish.title).set_directory(&wish.folder);
    match wish.kind {
        PathKind::Open => dialog.pick_file(),
        PathKind::Save => dialog.set_file_name(&wish.name).save_file(),
        PathKind::Folder => dialog.pick_folder(),
    }
}

/// A hand is slower: a dialog that ends so soon without a path never was on the screen.
const NO_HAND: Duration = Duration::from_millis(300);

/// What a dialog came to.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Browsed {
    Path(PathBuf),
    Closed,
    /// There is no dialog on this system.
    Missing,
}

/// A dialog that is open.
pub(crate) struct Browsing {
    receiver: Receiver<Option<PathBuf>>,
    since: Instant,
}

impl Browsing {
    pub(crate) fn start(dialog: FileDialog, wish: FileWish, context: &Context) -> Self {
        let (sender, receiver) = channel();
        let context = context.clone();
        std::thread::spawn(move || {
            // Nobody listens any more when the question was closed.
            let _ = sender.send(dialog(&wish));
            context.request_repaint();
        });
        Self { receiver, since: Instant::now() }
    }

    /// What it came to, once; `None` while it is open. A dialog that fell over counts as missing.
    pub(crate) fn take(&self) -> Option<Browsed> {
        match self.receiver.try_recv() {
            Ok(Some(path)) => Some(Browsed::Path(path)),
            Ok(None) if self.since.elapsed() < NO_HAND => Some(Browsed::Missing),
            Ok(None) => Some(Browsed::Closed),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => Some(Browsed::Missing),
        }
    }
}
