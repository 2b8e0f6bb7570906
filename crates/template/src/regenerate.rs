//! Regeneration (T8): a template and a body in, a garment out, with no person in between.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use glam::DVec3;
use mesh_kernel::TriMesh;
use reference::{FeatureCurve, Features};

use crate::Template;
use crate::collision::{CollisionReport, Contact, Drape};
use crate::construct::{Construction, Flat, Method};
use crate::ease::{Secant, body_girth, garment_girth};
use crate::error::TemplateError;
use crate::fairing::SparseFactor;
use crate::format::check::DEEPEST;
use crate::garment::{self, Garment, Seconds};
use crate::layout::{Layout, LayoutLine};
use crate::place::Placing;
use crate::refine::{Refined, Tag};
use crate::skin::{Prepared, Skin};
use crate::{adapt, complex, crowding, joints, outline, place};

/// A body with its features, both in the canonical frame (millimetres, y up, facing +z).
#[derive(Clone, Copy, Debug)]
pub struct Reference<'a> {
    /// The body's mesh.
    pub mesh: &'a TriMesh,
    /// Its features.
    pub features: &'a Features,
}

/// Told how far the work is, from 0 to 1, and what is done.
pub type Progress<'a> = dyn Fn(f64, &str) + Sync + 'a;

/// How to regenerate.
#[derive(Clone, Copy, Default)]
pub struct RegenerateOptions<'a> {
    /// Splits instead of the template's `level`.
    pub levels: Option<u8>,
    /// For the eye while something is dragged: nodes keep off the body, but triangles are not looked through for crossings, and
    /// [`Garment::collision`] stays empty.
    pub preview: bool,
    /// How surfaces are made smooth.
    pub method: Method,
    /// Set it from elsewhere to stop the work.
    pub cancel: Option<&'a AtomicBool>,
    /// Told how far the work is (0 to 1) and what is done.
    pub progress: Option<&'a Progress<'a>>,
    /// The body's search structures, where they are at hand; made anew else.
    pub prepared: Option<&'a Prepared>,
    /// What the preview before left, and what this one leaves to the next. Whole garments know nothing of it.
    pub warm: Option<&'a WarmStart>,
}

/// What a preview leaves for the next one, which differs little from it: offsets that gave the eases, contacts with the body,
/// and symbolic factors, which hold as long as the template's faces do. What no longer fits is not used.
#[derive(Default)]
pub struct WarmStart(Mutex<Warm>);

#[derive(Default)]
struct Warm {
    /// Where the template's nodes were without ease.
    places: Vec<DVec3>,
    eases: BTreeMap<String, WarmEase>,
    factors: Vec<Option<SparseFactor>>,
    contact: Option<Contact>,
}

impl Warm {
    /// Whether the offsets still lead the search: nodes in the body can have several that give one ease, so after a leap it
    /// must begin as that of a whole garment does.
    fn leads(&self, places: &[DVec3], eases: &[Level]) -> bool {
        let is_near = |(p, q): (&DVec3, &DVec3)| p.distance_squared(*q) <= LEAP * LEAP;
        let is_found = |level: &Level| {
            let found = self.eases.get(level.name);
            found.is_some_and(|f| (f.wanted - level.wanted).abs() <= LEAP * std::f64::consts::TAU)
        };
        self.places.len() == places.len()
            && self.places.iter().zip(places).all(is_near)
            && eases.iter().all(is_found)
    }
}

/// An ease as it was found.
struct WarmEase {
    push: f64,
    slope: f64,
    wanted: f64,
}

/// An ease within this is right, mm.
const EASE_AIM: f64 = 1.5;
/// An ease further off than this is reported, mm.
const EASE_TOLERANCE: f64 = 10.0;
/// After the search on the coarse garment, an ease this near is left alone on the fine one, mm.
const FINE_AIM: f64 = 3.0;
/// Rounds of the ease solver.
const EASE_ROUNDS: usize = 12;
/// Nodes that move farther from one preview to the next have leapt, mm.
const LEAP: f64 = 10.0;
/// Rounds of pushing out after which a garment's girth is measured; what is left then is some tenths of a millimetre after
/// two, which a preview may leave.
const PUSHES: usize = 3;
const PREVIEW_PUSHES: usize = 2;
/// Rounds on the fine garment after a search on the coarse one.
const FINE_ROUNDS: usize = 5;
/// A garment with as many faces is fine enough to measure girths on: some 60 chords round a hip, 0.3 mm short.
const COARSE_FACES: usize = 1500;
/// More template faces than this times four to the level are refused.
const MOST_FACES: usize = 4_000_000;
/// Memory that a face of a garment takes, with factors and pattern, bytes, times the binary logarithm of the number of faces:
/// 2.5 kB a face at 50 000 faces, as measured, and the factors' share grows.
const BYTES_PER_FACE: usize = 160;
/// Each layer keeps this much more clearance than the one below, mm.
const LAYER_STEP: f64 = 3.0;

struct Clock<'a> {
    options: &'a RegenerateOptions<'a>,
    start: Instant,
    last: Instant,
}

impl Clock<'_> {
    /// Reports progress, stops when cancelled, and tells the seconds since the last call.
    fn stage(&mut self, share: f64, what: &str) -> Result<f64, TemplateError> {
        if self.options.cancel.is_some_and(|c| c.load(Ordering::Relaxed)) {
            return Err(TemplateError::Cancelled);
        }
        if let Some(progress) = self.options.progress {
            progress(share, what);
        }
        let now = Instant::now();
        let seconds = (now - self.last).as_secs_f64();
        self.last = now;
        Ok(seconds)
    }
}

/// A level whose girth is wanted.
struct Level<'a> {
    name: &'a str,
    wanted: f64,
    curve: &'a FeatureCurve,
    body: f64,
    surfaces: Vec<usize>,
    secant: Secant,
}

impl Level<'_> {
    /// The faces that the tape goes round.
    fn faces(&self, refined: &Refined) -> Vec<[u32; 3]> {
        self.surfaces.iter().flat_map(|s| refined.welded_faces(*s)).collect()
    }
}

/// Measures all levels and takes a secant step where one is off by more than `aim`; `true` when none is or none can move.
fn step_eases(eases: &mut [Level], faces: &[Vec<[u32; 3]>], positions: &[DVec3], aim: f64) -> bool {
    let mut settled = true;
    for (level, faces) in eases.iter_mut().zip(faces) {
        let Some(girth) = garment_girth(positions, faces, level.curve) else { continue };
        let excess = girth - level.body - level.wanted;
        if excess.abs() > aim {
            settled &= !level.secant.step(excess);
        }
    }
    settled
}

/// A garment at one fineness, with everything that is factored once.
struct Stage<'a> {
    refined: &'a Refined,
    construction: Construction<'a>,
    drape: Drape<'a>,
}

impl<'a> Stage<'a> {
    fn new(
        template: &'a Template,
        lines: &'a [LayoutLine],
        refined: &'a Refined,
        skin: &'a Skin<'a>,
        method: Method,
        warm: &mut Warm,
    ) -> Result<Self, TemplateError> {
        let layout = &template.layout;
        let flats = Flat::all(layout, refined);
        let flaps = flats.iter().flat_map(|f| &f.flaps).copied().collect();
        let (clearance, level) = node_wishes(layout, lines, refined, template.file().clearance);
        let (factors, contact) = (std::mem::take(&mut warm.factors), warm.contact.take());
        let (construction, drape) = rayon::join(
            || Construction::new(layout, lines, refined, method, flats, factors),
            || Drape::new(refined, skin, flaps, clearance, level, layout.symmetric, contact),
        );
        Ok(Self { refined, construction: construction?, drape: drape? })
    }
}

/// Builds a template on a body.
///
/// Deterministic: the same input gives the same bits on any number of threads.
///
/// # Errors
/// [`TemplateError`]: a feature that the body lacks, a patch that is no manifold, joints that do not fit, cancellation.
pub fn regenerate(
    template: &Template,
    reference: &Reference,
    options: &RegenerateOptions,
) -> Result<Garment, TemplateError> {
    let start = Instant::now();
    let mut clock = Clock { options, start, last: start };
    let (layout, file) = (&template.layout, template.file());
    let mut seconds = Seconds::default();
    let mut warnings = Vec::new();
    check_reference(reference)?;
    clock.stage(0.0, "reading the body")?;
    let made;
    let prepared = match options.prepared {
        Some(prepared) => prepared,
        None => {
            made = Prepared::new(reference.mesh);
            &made
        }
    };
    let skin = Skin::new(reference.mesh, prepared);
    seconds.prepare = clock.stage(0.1, "placing nodes")?;

    let placing = Placing::new(layout, reference.features, &skin, file.clearance)?;
    let mut first = placing.place_all(&BTreeMap::new())?;
    let patches = complex::patches(layout, &first.positions, &skin, &mut Vec::new())?;
    let moves = crowding::find(layout, &patches, &first.positions, &skin);
    crowding::apply(&moves, &mut first.positions, &skin);
    place::symmetrise(layout, &mut first.positions);
    warnings.extend(crowding::tell(layout, &moves));
    // Once more: where nodes have moved, other diagonals may be the better ones.
    let patches = complex::patches(layout, &first.positions, &skin, &mut warnings)?;
    if let Some((line, a, b)) = joints::missing_edge(layout, &patches) {
        let name = |n: u32| &layout.nodes[n as usize].name;
        let message = format!("no surface has an edge from `{}` to `{}`", name(a), name(b));
        return Err(TemplateError::format(format!("lines.{line}.through"), message));
    }
    let levels = options.levels.unwrap_or(file.level).min(DEEPEST);
    let coarse: usize = patches.iter().map(|p| p.faces.len()).sum();
    if coarse.saturating_mul(1 << (2 * levels)) > MOST_FACES {
        let message =
            format!("{levels} splits of {coarse} faces make more than {MOST_FACES} faces; use fewer");
        return Err(TemplateError::format("level", message));
    }
    check_memory(levels, coarse << (2 * levels))?;
    let joint_specs = joints::joints(layout, &patches)?;
    let mut lines = layout.lines.clone();
    lines.extend(outline::missing_lines(layout, &patches, &joint_specs, &first.positions));
    let build = |levels: u8| Refined::new(layout, &lines, &patches, &joint_specs, &first.positions, levels);
    let mut refined = build(levels)?;
    // Girths are searched on a coarser garment, where everything is cheap, and then put right on the fine one.
    let mut warm = match options.warm.filter(|_| options.preview) {
        Some(warm) => std::mem::take(&mut *warm.0.lock().unwrap_or_else(PoisonError::into_inner)),
        None => Warm::default(),
    };
    let mut eases = ease_levels(layout, reference.features, &mut warnings)?;
    let is_led = warm.leads(&first.positions, &eases);
    let coarse_level = (0..levels).find(|l| coarse << (2 * l) >= COARSE_FACES).filter(|_| !is_led);
    let coarse_refined = coarse_level.map(build).transpose()?;
    seconds.topology = clock.stage(0.3, "factoring")?;

    let stage = |refined, warm: &mut Warm| Stage::new(template, &lines, refined, &skin, options.method, warm);
    let mut fine = stage(&refined, &mut warm)?;
    let rough = coarse_refined.as_ref().map(|coarse| stage(coarse, &mut Warm::default()));
    let mut rough = rough.transpose()?;
    let crossings = || prepared.crossings(reference.mesh);
    seconds.factor = clock.stage(0.4, "fairing")?;

    for level in &mut eases {
        if let Some(before) = warm.eases.get(level.name).filter(|_| is_led) {
            level.secant = Secant::warm(before.push, before.slope, level.wanted - before.wanted);
        }
    }
    let build = |push: BTreeMap<String, f64>, stage: &Stage| {
        let mut placed = placing.place_all(&push)?;
        crowding::apply(&moves, &mut placed.positions, &skin);
        place::symmetrise(layout, &mut placed.positions);
        let curves = stage.construction.curves(&placed.positions, reference.features)?;
        stage.construction.positions(&placed.positions, &curves)
    };
    let pushes = |eases: &[Level]| eases.iter().map(|l| (l.name.to_string(), l.secant.push)).collect();
    if let Some(rough) = &mut rough {
        let faces: Vec<_> = eases.iter().map(|l| l.faces(rough.refined)).collect();
        for round in 0..EASE_ROUNDS {
            let mut positions = build(pushes(&eases), rough)?;
            rough.drape.push_out(&mut positions, 4, None)?;
            let settled = step_eases(&mut eases, &faces, &positions, EASE_AIM);
            clock.stage(0.4 + 0.03 * round as f64, "finding the ease")?;
            if settled {
                break;
            }
        }
        fine.drape.start_from(&rough.drape);
        eases.iter_mut().for_each(|l| l.secant.restart());
    }
    let faces: Vec<_> = eases.iter().map(|l| l.faces(fine.refined)).collect();
    let rounds = if rough.is_some() { FINE_ROUNDS } else { EASE_ROUNDS };
    let push_rounds = if options.preview { PREVIEW_PUSHES } else { PUSHES };
    let mut round = 0;
    let (positions, moved) = loop {
        let mut positions = build(pushes(&eases), &fine)?;
        let mut moved = fine.drape.push_out(&mut positions, push_rounds, None)?;
        round += 1;
        let settled = round >= rounds || step_eases(&mut eases, &faces, &positions, FINE_AIM);
        clock.stage(0.7 + 0.03 * round as f64, "fairing")?;
        if settled && options.preview {
            break (positions, moved);
        }
        if settled {
            let more = fine.drape.push_out(&mut positions, usize::MAX, Some(crossings()))?;
            moved.iter_mut().zip(more).for_each(|(m, v)| *m += v);
            if fine.drape.mend(&mut positions, 0.5 * file.clearance.max(1.0)) > 0 {
                warnings.push("some nodes inside the body had to be moved to the skin one by one".into());
            }
            break (positions, moved);
        }
    };
    let mut collision = CollisionReport::default();
    if !options.preview {
        collision = fine.drape.report(&positions, &moved, crossings());
    }
    let mut ease = BTreeMap::new();
    for (level, faces) in eases.iter().zip(&faces) {
        let Some(girth) = garment_girth(&positions, faces, level.curve) else { continue };
        let got = girth - level.body;
        if (got - level.wanted).abs() > EASE_TOLERANCE {
            let text = format!("ease {}: {got:.0} mm instead of {:.0} mm", level.name, level.wanted);
            let why = if got > level.wanted { "; the body needs the room" } else { "" };
            warnings.push(format!("{text}{why}"));
        }
        ease.insert(level.name.to_string(), got);
    }
    if collision.nodes_inside > 0 || collision.faces_crossing > 0 {
        warnings.push(format!(
            "{} nodes inside the body, {} triangles cross it",
            collision.nodes_inside, collision.faces_crossing
        ));
    }
    if let Some(keep) = options.warm.filter(|_| options.preview) {
        let found = |l: &Level| WarmEase { push: l.secant.push, slope: l.secant.slope(), wanted: l.wanted };
        let (places, eases) =
            (first.positions, eases.iter().map(|l| (l.name.to_owned(), found(l))).collect());
        let (factors, contact) = (fine.construction.into_factors(), Some(fine.drape.into_contact()));
        *keep.0.lock().unwrap_or_else(PoisonError::into_inner) = Warm { places, eases, factors, contact };
    } else {
        drop(fine);
    }
    drop(rough);
    if let Some(tolerance) = file.adaptive.filter(|_| !options.preview) {
        // Wider triangles may cut into the body where narrow ones did not: those are split.
        let crossing = |faces: &[[u32; 3]]| {
            let mut found = vec![false; faces.len()];
            let mesh = TriMesh::new(positions.clone(), faces.to_vec());
            crossings().faces_crossing(&mesh).iter().for_each(|(face, _)| found[*face as usize] = true);
            collision.faces_crossing = found.iter().filter(|f| **f).count();
            found
        };
        refined = adapt::adapted(&refined, &positions, tolerance, crossing)?;
    }
    settle(&mut refined, &positions);
    clock.stage(0.95, "naming")?;
    let spent = seconds.prepare + seconds.topology + seconds.factor;
    seconds.shape = (Instant::now() - clock.start).as_secs_f64() - spent;

    let ease_wanted = layout.ease.iter().map(|e| (e.name.clone(), e.spec.ease)).collect();
    let garment_lines = garment::lines(&refined, &lines, layout.lines.len());
    seconds.total = (Instant::now() - clock.start).as_secs_f64();
    Ok(Garment {
        name: file.name.clone(),
        surfaces: garment::surfaces(&refined, layout, &garment_lines),
        seams: garment::seams(&refined),
        marks: garment::marks(&refined, layout),
        lines: garment_lines,
        body: refined.body,
        collision,
        ease,
        ease_wanted,
        warnings,
        seconds,
    })
}

/// Refuses a garment for which there is no memory: the system is asked for as much as it takes, and gets it back at once.
fn check_memory(levels: u8, faces: usize) -> Result<(), TemplateError> {
    let bytes = faces.saturating_mul(BYTES_PER_FACE * faces.max(2).ilog2() as usize);
    let mut probe: Vec<u8> = Vec::new();
    probe.try_reserve_exact(bytes).map_err(|_| TemplateError::Memory { levels, faces, bytes })
}

fn check_reference(reference: &Reference) -> Result<(), TemplateError> {
    let bad = |what: &str| Err(TemplateError::BadReference(what.into()));
    if reference.mesh.faces.is_empty() {
        return bad("its mesh has no faces");
    }
    if reference.mesh.positions.iter().any(|p| !p.is_finite()) {
        return bad("its mesh has coordinates that are no finite numbers");
    }
    let count = reference.mesh.positions.len() as u32;
    if reference.mesh.faces.iter().flatten().any(|v| *v >= count) {
        return bad("its mesh names nodes that it does not have");
    }
    let curves = reference.features.curves.values();
    if curves.flat_map(|c| &c.points).any(|p| !p.is_finite()) {
        return bad("a feature curve has coordinates that are no finite numbers");
    }
    Ok(())
}

/// Clearance of every welded node, and whether it keeps its height.
fn node_wishes(
    layout: &Layout,
    lines: &[LayoutLine],
    refined: &Refined,
    clearance: f64,
) -> (Vec<f64>, Vec<bool>) {
    let count = refined.flat.len();
    let mut layer = vec![u8::MAX; count];
    for (s, weld) in refined.weld.iter().enumerate() {
        for w in weld {
            let l = &mut layer[*w as usize];
            *l = (*l).min(layout.surfaces[s].layer);
        }
    }
    let kept: Vec<bool> = layout.nodes.iter().map(|n| n.spec.level.is_some()).collect();
    let line_kept: Vec<bool> = lines.iter().map(|l| l.nodes.iter().all(|n| kept[*n as usize])).collect();
    let level = refined.welded_tags.iter().map(|tag| match tag {
        Tag::Template(n) => kept[*n as usize],
        Tag::Line { line, .. } => line_kept[*line as usize],
        Tag::Inside => false,
    });
    let clearances = layer.iter().map(|l| clearance + LAYER_STEP * f64::from(*l)).collect();
    (clearances, level.collect())
}

fn ease_levels<'a>(
    layout: &'a Layout,
    features: &'a Features,
    warnings: &mut Vec<String>,
) -> Result<Vec<Level<'a>>, TemplateError> {
    let mut out = Vec::new();
    let lowest = layout.surfaces.iter().map(|s| s.layer).min().unwrap_or(0);
    for ease in &layout.ease {
        let name = ease.spec.curve.as_deref().unwrap_or(&ease.name);
        let curve = crate::place::feature_curve(features, name, &format!("ease.{}.curve", ease.name))?;
        let surfaces: Vec<usize> = if ease.surfaces.is_empty() {
            (0..layout.surfaces.len()).filter(|s| layout.surfaces[*s].layer == lowest).collect()
        } else {
            ease.surfaces.iter().map(|s| *s as usize).collect()
        };
        if !layout.nodes.iter().any(|n| n.spec.ease.as_deref() == Some(&ease.name)) {
            warnings.push(format!(
                "ease {}: no node says `\"ease\": \"{}\"`, so nothing can move",
                ease.name, ease.name
            ));
        }
        out.push(Level {
            name: &ease.name,
            wanted: ease.spec.ease,
            curve,
            body: body_girth(curve),
            surfaces,
            secant: Secant::new(),
        });
    }
    Ok(out)
}

/// Puts welded positions into the body; the radial order at joints follows the final shape.
fn settle(refined: &mut Refined, positions: &[DVec3]) {
    for (s, id) in refined.ids.iter().enumerate() {
        let weld = &refined.weld[s];
        for (v, p) in refined.body.surface_mut(*id).positions_mut().iter_mut().enumerate() {
            *p = positions[weld[v] as usize];
        }
    }
    let joints: Vec<_> = refined.body.joint_ids().collect();
    for joint in joints {
        refined.body.order_joint(joint);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_that_nobody_has_is_refused() {
        assert_eq!(check_memory(3, 10_000), Ok(()));
        let refused = check_memory(8, 1 << 50).unwrap_err();
        assert!(matches!(refused, TemplateError::Memory { levels: 8, .. }), "{refused}");
    }
}
