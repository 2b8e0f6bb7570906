//! Other names for nodes, surfaces and lines: everything that refers to them follows.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use template::format::Grain;

use super::topology::pair;
use super::{Draft, EditError};

/// A kind of thing that has a name of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Named {
    /// A node.
    Node,
    /// A surface, with its piece.
    Surface,
    /// A line or profile.
    Line,
}

impl Named {
    /// What people call it.
    pub fn words(self) -> &'static str {
        match self {
            Self::Node => "node",
            Self::Surface => "surface",
            Self::Line => "line",
        }
    }
}

/// The twin that a name has in a mirrored template, by itself or because the thing is marked so.
fn twin(name: &str, is_marked: bool) -> Option<String> {
    let left = name.strip_prefix("left_").map(|rest| format!("right_{rest}"));
    left.or_else(|| is_marked.then(|| format!("right_{name}")))
}

/// A name and its twin's, with what they become.
struct Names {
    pairs: Vec<[String; 2]>,
}

impl Names {
    fn change(&self, name: &mut String) {
        if let Some([_, new]) = self.pairs.iter().find(|[old, _]| old == name) {
            name.clone_from(new);
        }
    }

    fn change_all<'a>(&self, names: impl IntoIterator<Item = &'a mut String>) {
        names.into_iter().for_each(|name| self.change(name));
    }

    fn change_keys<T>(&self, map: &mut BTreeMap<String, T>) {
        for [old, new] in &self.pairs {
            if let Some(value) = map.remove(old) {
                map.insert(new.clone(), value);
            }
        }
    }
}

/// Renames; in a mirrored template the twin follows, so a name may not gain or lose the `left_` that makes one.
pub(super) fn rename(draft: &mut Draft, kind: Named, from: &str, to: &str) -> Result<(), EditError> {
    let file = &draft.template;
    let refused =
        |why: &str| EditError::Value { what: format!("{} {from}", kind.words()), why: why.to_owned() };
    let marks = |name: &str| match kind {
        Named::Node => file.nodes.get(name).map(|n| n.mirror),
        Named::Surface => file.surfaces.get(name).map(|s| s.mirror),
        Named::Line => file.lines.get(name).map(|l| l.mirror),
    };
    let missing = || EditError::Missing { kind: kind.words(), name: from.to_owned() };
    let is_marked = marks(from).ok_or_else(missing)?;
    let mut pairs = vec![[from.to_owned(), to.to_owned()]];
    if file.mirrored {
        if to.starts_with("right_") {
            return Err(refused("in a mirrored template names with right_ are those of twins"));
        }
        match (twin(from, is_marked), twin(to, is_marked)) {
            (Some(old), Some(new)) => pairs.push([old, new]),
            (None, None) => {}
            (Some(_), None) => {
                return Err(refused(
                    "its name must go on beginning with left_, or it would lose its twin on the right",
                ));
            }
            (None, Some(_)) => {
                return Err(refused("a name that begins with left_ would give it a twin on the right"));
            }
        }
    }
    for [old, new] in &pairs {
        if old != new && marks(new).is_some() {
            return Err(EditError::Taken { kind: kind.words(), name: new.clone() });
        }
    }
    let names = Names { pairs };
    let file = &mut draft.template;
    match kind {
        Named::Node => {
            names.change_keys(&mut file.nodes);
            names.change_all(file.nodes.values_mut().filter_map(|n| n.between.as_mut()).flatten());
            for surface in file.surfaces.values_mut() {
                names.change_all(surface.rows.iter_mut().chain(&mut surface.faces).flatten().flatten());
            }
            names.change_all(file.joints.iter_mut().flatten().flat_map(|j| &mut j.nodes));
            names
                .change_all(file.lines.values_mut().flat_map(|l| l.through.iter_mut().chain(&mut l.corners)));
            for piece in file.pieces.values_mut() {
                if let Some(Grain::Nodes(ends)) = &mut piece.grain {
                    names.change_all(ends);
                }
            }
            let wires = std::mem::take(&mut draft.wires);
            draft.wires = wires
                .into_iter()
                .map(|mut ends| {
                    names.change_all(&mut ends);
                    pair(&ends[0], &ends[1])
                })
                .collect();
        }
        Named::Surface => {
            names.change_keys(&mut file.surfaces);
            names.change_keys(&mut file.pieces);
            names.change_all(file.joints.iter_mut().flatten().flat_map(|j| &mut j.surfaces));
            names.change_all(file.fair_across.iter_mut().flatten());
            names.change_all(file.ease.values_mut().flat_map(|e| &mut e.surfaces));
        }
        Named::Line => {
            names.change_keys(&mut file.lines);
            names.change_all(file.lines.values_mut().filter_map(|l| l.continues.as_mut()));
            names.change_all(file.surfaces.values_mut().flat_map(|s| &mut s.open_along));
            for piece in file.pieces.values_mut() {
                names.change_keys(&mut piece.edges);
                names.change_all(&mut piece.on_fold);
            }
        }
    }
    Ok(())
}
