//! The two workspaces of the window, and what the same key does in each.

use crate::board::pen;
use crate::designer::Designer;
use crate::tools::Event;

/// What the window is for at the moment.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Workspace {
    /// Body, template, garment, pattern.
    #[default]
    Garment,
    /// The drawing in the plane.
    Drawing,
}

impl Designer {
    pub(crate) fn switch_workspace(&mut self) {
        self.settle();
        self.notices.forget_problems();
        self.workspace = match self.workspace {
            Workspace::Garment => Workspace::Drawing,
            Workspace::Drawing => Workspace::Garment,
        };
        self.follow_drawing();
    }

    pub(crate) fn confirm(&mut self) {
        match self.workspace {
            Workspace::Garment => self.tool_event(Event::Confirm),
            Workspace::Drawing => self.board_event(pen::Event::Confirm),
        }
    }

    pub(crate) fn cancel(&mut self) {
        match self.workspace {
            Workspace::Garment => self.tool_event(Event::Cancel),
            Workspace::Drawing => self.board_event(pen::Event::Cancel),
        }
    }

    pub(crate) fn delete_selected(&mut self) {
        match self.workspace {
            Workspace::Garment => self.delete(),
            Workspace::Drawing => self.delete_parts(),
        }
    }

    pub(crate) fn select_everything(&mut self) {
        match self.workspace {
            Workspace::Garment => self.select_all(),
            Workspace::Drawing => self.select_parts(),
        }
    }

    pub(crate) fn show_everything(&mut self) {
        match self.workspace {
            Workspace::Garment => self.frame_all(),
            Workspace::Drawing => self.show_drawing(),
        }
    }
}
