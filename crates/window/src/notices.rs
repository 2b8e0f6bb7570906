//! Short messages in the corner: what happened, and what can be done about it.

use std::time::{Duration, Instant};

use eframe::egui;

use crate::selection::Element;

/// A message.
#[derive(Clone, Debug)]
pub(crate) struct Notice {
    pub(crate) text: String,
    /// Something went wrong or was refused: it stays until it is closed or the next command succeeds.
    pub(crate) is_problem: bool,
    /// A remedy that a click carries out: the text of an action.
    pub(crate) remedy: Option<&'static str>,
    /// What it speaks of; a click shows it.
    pub(crate) element: Option<Element>,
    since: Instant,
}

/// News stays as long.
const STAYS: Duration = Duration::from_secs(6);
/// More than these are too many to read.
const MOST: usize = 4;

/// What a person did with a notice.
pub(crate) enum Answer {
    Remedy(&'static str),
    Show(Element),
}

/// The messages that are shown.
#[derive(Debug, Default)]
pub(crate) struct Notices {
    all: Vec<Notice>,
}

impl Notices {
    pub(crate) fn say(&mut self, text: impl Into<String>) {
        self.push(Notice { is_problem: false, ..Notice::problem(text) });
    }

    pub(crate) fn push(&mut self, notice: Notice) {
        self.all.retain(|n| n.text != notice.text);
        self.all.push(notice);
        let over = self.all.len().saturating_sub(MOST);
        self.all.drain(..over);
    }

    /// What was refused is no longer of interest.
    pub(crate) fn forget_problems(&mut self) {
        self.all.retain(|n| !n.is_problem);
    }

    /// The newest message.
    pub(crate) fn last(&self) -> Option<&str> {
        self.all.last().map(|n| n.text.as_str())
    }

    pub(crate) fn show(&mut self, context: &egui::Context) -> Option<Answer> {
        self.all.retain(|n| n.is_problem || n.since.elapsed() < STAYS);
        if self.all.is_empty() {
            return None;
        }
        if let Some(left) =
            self.all.iter().filter(|n| !n.is_problem).map(|n| STAYS.saturating_sub(n.since.elapsed())).min()
        {
            context.request_repaint_after(left);
        }
        let mut answer = None;
        let mut closed = None;
        let area =
            egui::Area::new(egui::Id::unique("notices")).anchor(egui::Align2::CENTER_BOTTOM, [0.0, -40.0]);
        area.order(egui::Order::Foreground).show(context, |ui| {
            for (k, notice) in self.all.iter().enumerate() {
                egui::Frame::popup(ui.style()).show(ui, |ui| {
                    ui.set_max_width(560.0);
                    ui.horizontal(|ui| {
                        let color = if notice.is_problem {
                            ui.visuals().warn_fg_color
                        } else {
                            ui.visuals().text_color()
                        };
                        ui.add(egui::Label::new(egui::RichText::new(&notice.text).color(color)).wrap());
                        if let Some(remedy) = notice.remedy
                            && ui.button(remedy).clicked()
                        {
                            answer = Some(Answer::Remedy(remedy));
                            closed = Some(k);
                        }
                        if let Some(element) = &notice.element
                            && ui.button("Show").on_hover_text("Select it and look at it").clicked()
                        {
                            answer = Some(Answer::Show(element.clone()));
                        }
                        if ui.small_button("×").on_hover_text("Close this message").clicked() {
                            closed = Some(k);
                        }
                    });
                });
            }
        });
        if let Some(k) = closed {
            self.all.remove(k);
        }
        answer
    }
}

impl Notice {
    pub(crate) fn problem(text: impl Into<String>) -> Self {
        Self { text: text.into(), is_problem: true, remedy: None, element: None, since: Instant::now() }
    }

    pub(crate) fn with_remedy(self, action: &'static str) -> Self {
        Self { remedy: Some(action), ..self }
    }

    pub(crate) fn about(self, element: Element) -> Self {
        Self { element: Some(element), ..self }
    }
}
