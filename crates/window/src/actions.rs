//! Everything that can be done by name: one list feeds menus, tool bar, palette, keys, the sheet of shortcuts and tests.

use design::draft::{Command, Edit};
use eframe::egui::{self, Key, KeyboardShortcut, Modifiers};

use crate::board::{Wish, pen};
use crate::designer::{Designer, Prompt};
use crate::files::LIBRARY;
use crate::layout::Layout;
use crate::preferences::Theme;
use crate::prompts::Next;
use crate::selection::Mode;
use crate::tools::{Drawing, Tool};
use crate::units::LengthUnit;
use crate::view::scene::{Colouring, Section};
use crate::workspace::Workspace;

/// Where an action stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Menu {
    File,
    Edit,
    Tool,
    Select,
    View,
    Window,
}

impl Menu {
    pub(crate) const ALL: [(Self, &'static str); 6] = [
        (Self::File, "File"),
        (Self::Edit, "Edit"),
        (Self::Tool, "Tool"),
        (Self::Select, "Selection"),
        (Self::View, "View"),
        (Self::Window, "Window"),
    ];
}

/// The switch between workspaces.
pub(crate) const DRAWING_BOARD: &str = "Drawing board";

/// Something that can be done.
pub(crate) struct Action {
    pub(crate) text: String,
    /// A sentence for those who do not know it.
    pub(crate) hint: String,
    pub(crate) menu: Menu,
    pub(crate) shortcut: Option<KeyboardShortcut>,
    /// Of things that are on or off, which.
    pub(crate) is_on: Option<fn(&Designer, usize) -> bool>,
    run: fn(&mut Designer, &egui::Context, usize),
    /// Which of a row of like actions.
    pub(crate) which: usize,
}

impl Action {
    pub(crate) fn run(&self, designer: &mut Designer, context: &egui::Context) {
        (self.run)(designer, context, self.which);
    }

    /// Its keys as they are printed on a keyboard; empty without.
    pub(crate) fn keys(&self, context: &egui::Context) -> String {
        let text = self.shortcut.map(|s| context.format_shortcut(&s)).unwrap_or_default();
        text.replace("Questionmark", "?").replace("Period", ".")
    }

    pub(crate) fn is_on(&self, designer: &Designer) -> Option<bool> {
        self.is_on.map(|is_on| is_on(designer, self.which))
    }
}

/// Texts that notices offer as remedies; a test sees to it that every one is an action's.
pub(crate) mod remedy {
    pub(crate) const SAVE_AS: &str = "Save as …";
    pub(crate) const FACE_TOOL: &str = "Face";
    pub(crate) const AUTOMATIC_JOINTS: &str = "Automatic joints";
    pub(crate) const OPEN: &str = "Open …";
    #[cfg(test)]
    pub(crate) const ALL: [&str; 4] = [SAVE_AS, FACE_TOOL, AUTOMATIC_JOINTS, OPEN];
}

const CTRL: Modifiers = Modifiers::COMMAND;
const CTRL_SHIFT: Modifiers = Modifiers::COMMAND.plus(Modifiers::SHIFT);
const PLAIN: Modifiers = Modifiers::NONE;

type Run = fn(&mut Designer, &egui::Context, usize);
type Row = (Menu, &'static str, Option<(Modifiers, Key)>, &'static str, Run);
type Switch = (Menu, &'static str, Option<(Modifiers, Key)>, &'static str, Run, fn(&Designer, usize) -> bool);

const ROWS: &[Row] = &[
    (Menu::File, "New", Some((CTRL, Key::N)), "An empty template on the average form", |d, _, _| {
        d.ask(Next::New)
    }),
    (Menu::File, remedy::OPEN, Some((CTRL, Key::O)), "A design, a template, or a body's mesh", |d, _, _| {
        d.prompt_open();
    }),
    (Menu::File, "Save", Some((CTRL, Key::S)), "Into the file that the design has", |d, _, _| d.save()),
    (
        Menu::File,
        remedy::SAVE_AS,
        Some((CTRL_SHIFT, Key::S)),
        "Under another name: .toile holds everything, .json the template",
        |d, _, _| {
            d.prompt_save_as(None);
        },
    ),
    (
        Menu::File,
        "Export files …",
        Some((CTRL, Key::E)),
        "Garment, pattern (DXF, SVG, PDF), pictures and report into a folder",
        |d, _, _| {
            d.prompt_export();
        },
    ),
    (Menu::File, "Thicken …", None, "The garment as a solid of some thickness, into a file", |d, _, _| {
        d.prompt_thicken()
    }),
    (
        Menu::File,
        "Mid-surface of a solid …",
        None,
        "The surface halfway between the walls of a thin solid, from file to file",
        |d, _, _| {
            d.prompt_deflate();
        },
    ),
    (
        Menu::File,
        "Flat plates of a sheet …",
        None,
        "A folded sheet as plates with bend lines, from file to file",
        |d, _, _| {
            d.prompt_unfold();
        },
    ),
    (Menu::File, "Quit", Some((CTRL, Key::Q)), "Close the window", |d, _, _| d.ask(Next::Quit)),
    (Menu::Edit, "Undo", Some((CTRL, Key::Z)), "Take the last change back", |d, _, _| {
        d.command(Command::Undo)
    }),
    (Menu::Edit, "Redo", Some((CTRL, Key::Y)), "Make the change again that was taken back", |d, _, _| {
        d.command(Command::Redo);
    }),
    (
        Menu::Edit,
        "Confirm",
        Some((PLAIN, Key::Enter)),
        "End what the tool has under way: fill the face, join the edges",
        |d, _, _| {
            d.confirm();
        },
    ),
    (
        Menu::Edit,
        "Cancel",
        Some((PLAIN, Key::Escape)),
        "Leave what is under way; then select nothing",
        |d, _, _| {
            d.cancel();
        },
    ),
    (
        Menu::Edit,
        "Delete",
        Some((PLAIN, Key::Delete)),
        "Delete what is selected: nodes, edges, faces, profiles of edges",
        |d, _, _| {
            d.delete_selected();
        },
    ),
    (Menu::Edit, "Stop building", None, "Stop what is being built or made in the background", |d, _, _| {
        d.stop()
    }),
    (
        Menu::Select,
        "Select all",
        Some((CTRL, Key::A)),
        "Everything of the kind that clicks select",
        |d, _, _| d.select_everything(),
    ),
    (
        Menu::View,
        "Show all",
        Some((PLAIN, Key::Home)),
        "Move the eye so that everything is seen",
        |d, _, _| d.show_everything(),
    ),
    (
        Menu::Window,
        "Find an action",
        Some((CTRL, Key::P)),
        "Every action by a part of its name",
        |d, _, _| {
            d.palette = Some(String::new());
        },
    ),
    (Menu::Window, "Keys", Some((PLAIN, Key::Questionmark)), "All keys on one sheet", |d, _, _| {
        d.prompt = Some(Prompt::Keys);
    }),
];

const GARMENT_ROWS: &[Row] = &[
    (Menu::Window, "Keep layout …", None, "The panels as they are, under a name", |d, _, _| {
        d.prompt = Some(Prompt::layout());
    }),
    (Menu::Window, "Usual layout", None, "All panels, as large as they were at first", |d, _, _| {
        d.take_layout(Layout::default());
    }),
    (
        Menu::Edit,
        "Rename",
        Some((PLAIN, Key::F2)),
        "Another name for what is selected: node, patch, profile, joint",
        |d, _, _| d.name_selected(),
    ),
    (
        Menu::Edit,
        remedy::AUTOMATIC_JOINTS,
        None,
        "Joints make themselves wherever surfaces share edges",
        |d, _, _| {
            d.edit(Edit::AutomaticJoints);
        },
    ),
    (
        Menu::View,
        "Show selection",
        Some((PLAIN, Key::Period)),
        "Move the eye to what is selected",
        |d, _, _| {
            d.frame_selection();
        },
    ),
];

const DRAWING_ROWS: &[Row] = &[
    (Menu::File, "Open a drawing …", None, "Take the drawing of a script onto the board", |d, _, _| {
        d.prompt_drawing()
    }),
    (
        Menu::File,
        "Write a script …",
        None,
        "Sheets, walls or wires of the drawing, as commands for toile model",
        |d, _, _| d.prompt_script(),
    ),
];

const SWITCHES: &[Switch] = &[
    (
        Menu::Window,
        DRAWING_BOARD,
        Some((PLAIN, Key::F3)),
        "Draw outlines in the plane, for sheets, walls and wires",
        |d, _, _| d.switch_workspace(),
        |d, _| d.workspace == Workspace::Drawing,
    ),
    (
        Menu::Window,
        "Draw without OpenGL",
        None,
        "By the processor: slower, right on every machine",
        |d, _, _| d.toggle_painter(),
        |d, _| !d.view.is_by_gl(),
    ),
];

const DRAWING_SWITCHES: &[Switch] = &[(
    Menu::View,
    "Snap to grid",
    Some((PLAIN, Key::G)),
    "Places snap to the grid that is shown",
    |d, _, _| d.board.snaps_to_grid = !d.board.snaps_to_grid,
    |d, _| d.board.snaps_to_grid,
)];

const GARMENT_SWITCHES: &[Switch] = &[
    (
        Menu::Edit,
        "Mirror",
        Some((PLAIN, Key::M)),
        "The left half is drawn, and the right one follows",
        |d, _, _| d.toggle_mirror(),
        |d, _| d.draft().template.mirrored,
    ),
    (
        Menu::View,
        "Parallel sight",
        Some((PLAIN, Key::O)),
        "No perspective",
        |d, _, _| d.view.eye.toggle_projection(),
        |d, _| d.view.eye.is_parallel(),
    ),
    (
        Menu::View,
        "X-ray",
        Some((PLAIN, Key::X)),
        "See through the cloth, and take what is hidden",
        |d, _, _| d.relook(|l| l.x_ray = !l.x_ray),
        |d, _| d.look.x_ray,
    ),
    (
        Menu::View,
        "Body",
        Some((PLAIN, Key::B)),
        "Show the body",
        |d, _, _| d.relook(|l| l.body = !l.body),
        |d, _| d.look.body,
    ),
    (
        Menu::View,
        "Garment",
        Some((PLAIN, Key::G)),
        "Show the garment",
        |d, _, _| d.relook(|l| l.garment = !l.garment),
        |d, _| d.look.garment,
    ),
    (
        Menu::View,
        "Template",
        Some((PLAIN, Key::T)),
        "Show nodes and edges",
        |d, _, _| d.relook(|l| l.template = !l.template),
        |d, _| d.look.template,
    ),
    (
        Menu::View,
        "Section",
        Some((PLAIN, Key::C)),
        "Cut the picture with a plane",
        |d, _, _| {
            d.relook(|l| {
                l.section = if l.section.is_some() { None } else { Some(Section { axis: 2, at: 0.0 }) }
            });
        },
        |d, _| d.look.section.is_some(),
    ),
];

const VIEWS: [(viewer::View, &str, Key); 6] = [
    (viewer::View::Front, "Front view", Key::F5),
    (viewer::View::Back, "Back view", Key::F6),
    (viewer::View::Left, "Left view", Key::F7),
    (viewer::View::Right, "Right view", Key::F8),
    (viewer::View::Top, "Top view", Key::F9),
    (viewer::View::Iso, "View from the corner", Key::F4),
];

const MODE_KEYS: [Key; 4] = [Key::Num1, Key::Num2, Key::Num3, Key::Num4];

const THEMES: [(Theme, &str); 3] =
    [(Theme::Light, "Light window"), (Theme::Dark, "Dark window"), (Theme::System, "Window as the system")];

const UNITS: [&str; 3] = ["Millimetres", "Centimetres", "Inches"];

/// Every action of a workspace.
fn actions(workspace: Workspace) -> Vec<Action> {
    let key = |k: Option<(Modifiers, Key)>| k.map(|(m, k)| KeyboardShortcut::new(m, k));
    let mut out = Vec::new();
    let mut add = |menu, text: String, shortcut, hint: String, which, run: Run, is_on| {
        out.push(Action { text, hint, menu, shortcut, is_on, run, which });
    };
    let (own_rows, own_switches) = match workspace {
        Workspace::Garment => (GARMENT_ROWS, GARMENT_SWITCHES),
        Workspace::Drawing => (DRAWING_ROWS, DRAWING_SWITCHES),
    };
    for (menu, text, shortcut, hint, run) in ROWS.iter().chain(own_rows) {
        add(*menu, (*text).to_owned(), key(*shortcut), (*hint).to_owned(), 0, *run, None);
    }
    for (k, (name, _)) in LIBRARY.iter().enumerate() {
        let hint = "A template that comes with the program, on the average form".to_owned();
        add(Menu::File, format!("Template: {name}"), None, hint, k, |d, _, k| d.ask(Next::Library(k)), None);
    }
    for (menu, text, shortcut, hint, run, is_on) in SWITCHES.iter().chain(own_switches) {
        add(*menu, (*text).to_owned(), key(*shortcut), (*hint).to_owned(), 0, *run, Some(*is_on));
    }
    if workspace == Workspace::Garment {
        for (k, (_, name, tool_key, hint)) in Tool::ALL.iter().enumerate() {
            let shortcut = key(Some((PLAIN, *tool_key)));
            let run: Run = |d, _, k| d.take_tool(Tool::ALL[k].0);
            add(
                Menu::Tool,
                (*name).to_owned(),
                shortcut,
                (*hint).to_owned(),
                k,
                run,
                Some(|d, k| d.tool == Tool::ALL[k].0),
            );
        }
        for (k, (_, name)) in Drawing::ALL.iter().enumerate() {
            let hint = "How the curve tool draws on the body".to_owned();
            let run: Run = |d, _, k| {
                d.drawing = Drawing::ALL[k].0;
                d.take_tool(Tool::Feature);
            };
            add(
                Menu::Tool,
                format!("Curve: {name}"),
                None,
                hint,
                k,
                run,
                Some(|d, k| d.drawing == Drawing::ALL[k].0),
            );
        }
        for (k, (_, name)) in Mode::ALL.iter().enumerate() {
            let shortcut = key(Some((PLAIN, MODE_KEYS[k])));
            let run: Run = |d, _, k| d.take_mode(Mode::ALL[k].0);
            let hint = "Clicks select these".to_owned();
            let is_on: fn(&Designer, usize) -> bool = |d, k| d.session.mode == Mode::ALL[k].0;
            add(Menu::Select, (*name).to_owned(), shortcut, hint, k, run, Some(is_on));
        }
        for (k, (_, name, view_key)) in VIEWS.iter().enumerate() {
            let run: Run = |d, _, k| d.view.eye.look(VIEWS[k].0);
            add(
                Menu::View,
                (*name).to_owned(),
                key(Some((PLAIN, *view_key))),
                "Look along an axis".to_owned(),
                k,
                run,
                None,
            );
        }
        for (k, (_, name)) in Colouring::ALL.iter().enumerate() {
            let run: Run = |d, _, k| d.relook(|l| l.colouring = Colouring::ALL[k].0);
            let hint = "What the garment's colours mean".to_owned();
            let is_on: fn(&Designer, usize) -> bool = |d, k| d.look.colouring == Colouring::ALL[k].0;
            add(Menu::View, format!("Colours: {name}"), None, hint, k, run, Some(is_on));
        }
    }
    if workspace == Workspace::Drawing {
        for (k, (_, name, tool_key, hint)) in pen::Tool::ALL.iter().enumerate() {
            let run: Run = |d, _, k| d.take_pen(pen::Tool::ALL[k].0);
            let is_on: fn(&Designer, usize) -> bool = |d, k| d.board.pen.tool == pen::Tool::ALL[k].0;
            let shortcut = key(Some((PLAIN, *tool_key)));
            add(Menu::Tool, (*name).to_owned(), shortcut, (*hint).to_owned(), k, run, Some(is_on));
        }
        for (k, (_, name, hint)) in Wish::ALL.iter().enumerate() {
            let run: Run = |d, _, k| d.grant(Wish::ALL[k].0);
            add(Menu::Select, (*name).to_owned(), None, (*hint).to_owned(), k, run, None);
        }
    }
    if workspace == Workspace::Garment {
        for (k, (name, hint)) in Layout::PANELS.iter().enumerate() {
            let is_on: fn(&Designer, usize) -> bool = |d, k| d.preferences.layout.panels[k].is_shown;
            let run: Run = |d, _, k| d.toggle_panel(k);
            add(Menu::Window, (*name).to_owned(), None, (*hint).to_owned(), k, run, Some(is_on));
        }
    }
    for (k, name) in UNITS.iter().enumerate() {
        let run: Run = |d, _, k| d.prefer(|p| p.unit = LengthUnit::ALL[k]);
        let is_on: fn(&Designer, usize) -> bool = |d, k| d.preferences.unit == LengthUnit::ALL[k];
        add(Menu::Window, (*name).to_owned(), None, "The unit of lengths".to_owned(), k, run, Some(is_on));
    }
    for (k, (_, name)) in THEMES.iter().enumerate() {
        let run: Run = |d, context, k| {
            d.prefer(|p| p.theme = THEMES[k].0);
            d.apply_theme(context);
        };
        let is_on: fn(&Designer, usize) -> bool = |d, k| d.preferences.theme == THEMES[k].0;
        add(
            Menu::Window,
            (*name).to_owned(),
            None,
            "How light the window is".to_owned(),
            k,
            run,
            Some(is_on),
        );
    }
    out
}

impl Designer {
    /// Everything that can be done by name in this workspace.
    pub(crate) fn actions(&self) -> Vec<Action> {
        let mut all = actions(self.workspace);
        if self.workspace == Workspace::Garment {
            all.extend(self.preferences.layouts.iter().enumerate().map(|(which, named)| Action {
                text: format!("Layout: {}", named.name),
                hint: "Panels as they were kept under this name".to_owned(),
                menu: Menu::Window,
                shortcut: None,
                is_on: None,
                run: |d, _, k| d.take_named_layout(k),
                which,
            }));
        }
        all
    }

    /// Runs the action of this text.
    pub(crate) fn run_action(&mut self, text: &str, context: &egui::Context) {
        if let Some(action) = self.actions().into_iter().find(|a| a.text == text) {
            action.run(self, context);
        }
    }

    /// Keys of actions. Those without Ctrl are text while a field has the keyboard.
    pub(crate) fn keys(&mut self, context: &egui::Context) {
        if self.prompt.is_some() || self.palette.is_some() {
            return;
        }
        if self.workspace == Workspace::Drawing && self.begin_number(context) {
            // Letters of units are no tools.
            return;
        }
        // Escape has taken the keyboard from a field before this is asked, and was meant for the field.
        let is_written = context.egui_wants_keyboard_input();
        let is_typing = std::mem::replace(&mut self.was_typing, is_written) || is_written;
        for action in self.actions() {
            let Some(shortcut) = action.shortcut else { continue };
            // Letters are text then, and these are the field's own.
            let is_text = matches!(shortcut.logical_key, Key::A | Key::Z | Key::Y);
            if is_typing && (!shortcut.modifiers.command || is_text) {
                continue;
            }
            if context.input_mut(|i| consume(i, &shortcut)) {
                action.run(self, context);
            }
        }
        for (shortcut, text) in ALSO {
            if !is_typing && context.input_mut(|i| i.consume_shortcut(&shortcut)) {
                self.run_action(text, context);
            }
        }
    }
}

/// Keys that other programs have taught hands.
pub(crate) const ALSO: [(KeyboardShortcut, &str); 3] = [
    (KeyboardShortcut::new(CTRL_SHIFT, Key::Z), "Redo"),
    (KeyboardShortcut::new(PLAIN, Key::Backspace), "Delete"),
    (KeyboardShortcut::new(PLAIN, Key::F1), "Keys"),
];

/// Like `consume_shortcut`, but Shift must be up where it is not asked for; `?` is typed with Shift on most keyboards.
fn consume(input: &mut egui::InputState, shortcut: &KeyboardShortcut) -> bool {
    if shortcut.logical_key == Key::Questionmark {
        return input.consume_key(Modifiers::SHIFT, Key::Questionmark)
            || input.consume_key(PLAIN, Key::Questionmark);
    }
    input.modifiers.shift == shortcut.modifiers.shift && input.consume_shortcut(shortcut)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn texts_and_keys_are_each_one_action() {
        for workspace in [Workspace::Garment, Workspace::Drawing] {
            are_each_one_action(workspace);
        }
    }

    fn are_each_one_action(workspace: Workspace) {
        let all = actions(workspace);
        let texts: BTreeSet<&str> = all.iter().map(|a| a.text.as_str()).collect();
        assert_eq!(texts.len(), all.len());
        let keys: Vec<String> = all.iter().filter_map(|a| a.shortcut).map(|s| format!("{s:?}")).collect();
        assert_eq!(keys.iter().collect::<BTreeSet<_>>().len(), keys.len(), "{keys:?}");
        assert!(all.iter().all(|a| !a.hint.is_empty()));
        for (shortcut, text) in ALSO {
            assert!(texts.contains(text) && !keys.contains(&format!("{shortcut:?}")), "{text}");
        }
        for text in remedy::ALL.iter().filter(|_| workspace == Workspace::Garment) {
            assert!(texts.contains(text), "{text}");
        }
    }
}
