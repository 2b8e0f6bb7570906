//! Checks of a template file that need no body: names exist, numbers make sense.

use std::collections::BTreeSet;

use super::{Grain, Shape, TemplateFile};
use crate::error::TemplateError;

type Checked = Result<(), TemplateError>;

/// Largest length that a template may hold, mm: ten metres.
const LONGEST: f64 = 10_000.0;
/// Most splits of every face of a template.
pub const DEEPEST: u8 = 8;

pub(crate) fn check(file: &TemplateFile) -> Checked {
    check_incomplete(file)?;
    if file.nodes.is_empty() || file.surfaces.is_empty() {
        return Err(TemplateError::format("", "a template needs nodes and surfaces"));
    }
    Ok(())
}

/// The same for a template that is being made: nodes or surfaces may still be missing.
pub(crate) fn check_incomplete(file: &TemplateFile) -> Checked {
    if file.toile_template != super::FORMAT_VERSION {
        return Err(TemplateError::Version { found: file.toile_template, known: super::FORMAT_VERSION });
    }
    if file.level > DEEPEST {
        return Err(TemplateError::format(
            "level",
            format!("{} splits are too many; at most {DEEPEST}", file.level),
        ));
    }
    if let Some(adaptive) = file.adaptive
        && !(0.01..=50.0).contains(&adaptive)
    {
        return Err(TemplateError::format("adaptive", "must be from 0.01 to 50 mm"));
    }
    length("clearance", file.clearance)?;
    if file.clearance < 0.0 {
        return Err(TemplateError::format("clearance", "must not be negative"));
    }
    for name in file.nodes.keys().chain(file.surfaces.keys()).chain(file.lines.keys()) {
        if name.trim().is_empty() {
            return Err(TemplateError::format("", "a node, surface or line has an empty name"));
        }
    }
    nodes(file)?;
    surfaces(file)?;
    lines(file)?;
    rest(file)
}

fn length(path: &str, value: f64) -> Checked {
    if !value.is_finite() || value.abs() > LONGEST {
        return Err(TemplateError::format(
            path,
            format!("{value} mm is no sensible length (at most {LONGEST} mm)"),
        ));
    }
    Ok(())
}

fn nodes(file: &TemplateFile) -> Checked {
    for (name, node) in &file.nodes {
        let path = |key: &str| format!("nodes.{name}{key}");
        let bad = |key: &str, message: &str| Err(TemplateError::format(path(key), message));
        match (&node.at, &node.between) {
            (None, None) => return bad("", "give `at` (feature curves or a point) or `between` (two nodes)"),
            (Some(_), Some(_)) => return bad("", "give `at` or `between`, not both"),
            _ => {}
        }
        if node.t.is_some() && node.between.is_none() {
            return bad(".t", "belongs to `between`, which is missing");
        }
        if node.between.is_some() && (node.slide.is_some() || node.first != 0.0 || node.second != 0.0) {
            return bad("", "`between` has no feature curves: use `normal`, `axes`, `skin`");
        }
        for (key, v) in [(".normal", node.normal), (".first", node.first), (".second", node.second)] {
            length(&path(key), v)?;
        }
        for v in node.axes.iter().flatten() {
            length(&path(".axes"), *v)?;
        }
        if let Some(v) = node.skin {
            length(&path(".skin"), v)?;
        }
        if let Some(t) = node.t
            && !(t.is_finite() && (-10.0..=11.0).contains(&t))
        {
            return bad(".t", "must be a share of the way, usually 0 to 1");
        }
        if let Some(slide) = &node.slide {
            match (slide.by, slide.fraction) {
                (Some(v), None) => length(&path(".slide.by"), v)?,
                (None, Some(f)) if f.is_finite() && f.abs() <= 2.0 => {}
                (None, Some(_)) => return bad(".slide.fraction", "must lie between -2 and 2"),
                _ => return bad(".slide", "give `by` (mm) or `fraction`, one of them"),
            }
        }
        if let Some(super::Level::Between(level)) = &node.level {
            length(&path(".level.plus"), level.plus)?;
            if !level.t.is_finite() || level.t.abs() > 10.0 {
                return bad(".level.t", "must be a share of the way, usually 0 to 1");
            }
        }
        if let Some(ease) = &node.ease
            && !file.ease.contains_key(ease)
        {
            return bad(".ease", &format!("there is no ease level `{ease}`; add it under `ease`"));
        }
    }
    Ok(())
}

fn surfaces(file: &TemplateFile) -> Checked {
    for (name, surface) in &file.surfaces {
        let path = |key: &str| format!("surfaces.{name}{key}");
        if surface.rows.is_none() && surface.faces.is_none() {
            return Err(TemplateError::format(path(""), "give `rows` (a grid of nodes) or `faces`"));
        }
        if let Some(rows) = &surface.rows {
            if rows.len() < 2 {
                return Err(TemplateError::format(path(".rows"), "a grid needs two rows at least"));
            }
            if rows.iter().any(Vec::is_empty) || rows.iter().all(|r| r.len() < 2) {
                return Err(TemplateError::format(
                    path(".rows"),
                    "a row is empty, or all rows have one node only",
                ));
            }
        }
        for (i, face) in surface.faces.iter().flatten().enumerate() {
            if !(3..=4).contains(&face.len()) {
                return Err(TemplateError::format(
                    path(&format!(".faces[{i}]")),
                    "a face has three or four nodes",
                ));
            }
        }
        if surface.across_centre && !file.mirrored {
            return Err(TemplateError::format(path(".across_centre"), "needs `\"mirrored\": true`"));
        }
        for line in &surface.open_along {
            if !crate::layout::line_known(file, line) {
                return Err(TemplateError::format(path(".open_along"), format!("there is no line `{line}`")));
            }
        }
    }
    for (g, group) in file.fair_across.iter().enumerate() {
        for name in group {
            if !crate::layout::surface_known(file, name) {
                return Err(TemplateError::format(
                    format!("fair_across[{g}]"),
                    format!("there is no surface `{name}`"),
                ));
            }
        }
    }
    Ok(())
}

fn lines(file: &TemplateFile) -> Checked {
    for (name, line) in &file.lines {
        let path = |key: &str| format!("lines.{name}{key}");
        let bad = |key: &str, message: String| Err(TemplateError::format(path(key), message));
        if line.through.len() < 2 {
            return bad(".through", "a line needs two nodes at least".into());
        }
        if line.across_centre && !file.mirrored {
            return bad(".across_centre", "needs `\"mirrored\": true`".into());
        }
        if let Some(next) = &line.continues {
            if line.closed {
                return bad(".continues", "a closed line cannot run into another".into());
            }
            if next == name || !crate::layout::line_known(file, next) {
                return bad(".continues", format!("there is no other line `{next}`"));
            }
        }
        for corner in &line.corners {
            if !line.through.contains(corner) {
                return bad(".corners", format!("`{corner}` is not a node of this line"));
            }
        }
        match &line.shape {
            Some(Shape::Profile(p)) => {
                if line.closed || line.across_centre || line.through.len() != 2 {
                    return bad(".shape", "a profile belongs to one template edge: list two nodes".into());
                }
                if p.points.len() < 2
                    || p.points.iter().flatten().any(|v| !v.is_finite() || v.abs() > LONGEST)
                {
                    return bad(".shape.points", "a profile needs two finite points at least".into());
                }
                if p.points.first() == p.points.last() {
                    return bad(
                        ".shape.points",
                        "the profile's ends coincide; eq. 3 needs two different ends".into(),
                    );
                }
            }
            Some(Shape::Follow(f)) => length(&path(".shape.clearance"), f.clearance.unwrap_or(0.0))?,
            _ => {}
        }
    }
    Ok(())
}

fn rest(file: &TemplateFile) -> Checked {
    for (name, ease) in &file.ease {
        length(&format!("ease.{name}.ease"), ease.ease)?;
        for surface in &ease.surfaces {
            if !crate::layout::surface_known(file, surface) {
                let message = format!("there is no surface `{surface}`");
                return Err(TemplateError::format(format!("ease.{name}.surfaces"), message));
            }
        }
    }
    for (name, piece) in &file.pieces {
        let path = |key: &str| format!("pieces.{name}{key}");
        if !crate::layout::surface_known(file, name) {
            return Err(TemplateError::format(path(""), format!("there is no surface `{name}`")));
        }
        let negative = piece.allowance.iter().chain(piece.edges.values()).any(|v| *v < 0.0);
        for v in piece.allowance.iter().chain(piece.edges.values()) {
            length(&path(".allowance"), *v)?;
        }
        if negative {
            return Err(TemplateError::format(path(".allowance"), "an allowance must not be negative"));
        }
        for line in piece.edges.keys().chain(&piece.on_fold) {
            if !crate::layout::line_known(file, line) {
                return Err(TemplateError::format(path(".edges"), format!("there is no line `{line}`")));
            }
        }
        if let Some(Grain::Nodes(ends)) = &piece.grain {
            for end in ends {
                if !crate::layout::node_known(file, end) {
                    return Err(TemplateError::format(path(".grain"), format!("there is no node `{end}`")));
                }
            }
        }
        if piece.quantity == Some(0) {
            return Err(TemplateError::format(path(".quantity"), "cut at least one"));
        }
    }
    let mut seen = BTreeSet::new();
    for (j, joint) in file.joints.iter().flatten().enumerate() {
        let path = format!("joints[{j}]");
        if joint.nodes.len() < 2 {
            return Err(TemplateError::format(path, "a joint needs two nodes at least"));
        }
        if joint.surfaces.len() < 2 {
            return Err(TemplateError::format(path, "a joint needs two surfaces at least"));
        }
        if let Some(name) = &joint.name
            && !seen.insert(name)
        {
            return Err(TemplateError::format(path, format!("the name `{name}` is given twice")));
        }
    }
    Ok(())
}
