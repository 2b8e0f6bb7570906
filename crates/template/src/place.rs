//! Template nodes on a body: feature frames, offsets, heights, twins (T2 and T8).

use std::collections::BTreeMap;

use glam::DVec3;
use reference::{FeatureCurve, Features, Frame};

use crate::Reference;
use crate::encoding::{Offset, decode, decode_axes, encode};
use crate::error::TemplateError;
use crate::format::{At, Level, NodeSpec, Scale, Slide, TemplateFile};
use crate::layout::Layout;
use crate::skin::{Prepared, Skin};

/// Steps in which an ease moves a node, mm.
const PUSH_STEP: f64 = 2.0;

/// Stature at which `"scale": "height"` changes nothing, mm.
pub const SCALE_STATURE: f64 = 1680.0;

fn names<'a>(all: impl Iterator<Item = &'a String>) -> String {
    let list: Vec<&str> = all.map(String::as_str).collect();
    if list.is_empty() { "none".into() } else { list.join(", ") }
}

/// A feature curve by name.
pub(crate) fn feature_curve<'f>(
    features: &'f Features,
    name: &str,
    path: &str,
) -> Result<&'f FeatureCurve, TemplateError> {
    features.curves.get(name).filter(|c| c.points.len() >= 2 && c.normals.len() == c.points.len()).ok_or_else(
        || TemplateError::UnknownFeature {
            path: path.into(),
            feature: name.into(),
            known: format!("the curves {}", names(features.curves.keys())),
        },
    )
}

/// A place on a feature curve.
pub(crate) struct OnCurve {
    pub(crate) position: DVec3,
    pub(crate) normal: DVec3,
    pub(crate) tangent: DVec3,
}

/// A feature curve by arc length.
pub(crate) struct ArcLength<'c> {
    curve: &'c FeatureCurve,
    /// Length up to each point, and the whole length at the end when closed.
    sums: Vec<f64>,
}

impl<'c> ArcLength<'c> {
    pub(crate) fn new(curve: &'c FeatureCurve) -> Self {
        let n = curve.points.len();
        let mut sums = vec![0.0];
        for i in 1..n + usize::from(curve.closed) {
            sums.push(sums[i - 1] + (curve.points[i % n] - curve.points[i - 1]).length());
        }
        Self { curve, sums }
    }

    pub(crate) fn length(&self) -> f64 {
        self.sums[self.sums.len() - 1]
    }

    /// The place at arc length `s`: wrapped round on a closed curve, held at the ends of an open one.
    pub(crate) fn at(&self, s: f64) -> OnCurve {
        let (n, total) = (self.curve.points.len(), self.length());
        let s = if self.curve.closed && total > 0.0 { s.rem_euclid(total) } else { s.clamp(0.0, total) };
        let after = self.sums.partition_point(|v| *v <= s).clamp(1, self.sums.len() - 1);
        let step = self.sums[after] - self.sums[after - 1];
        let t = if step > 0.0 { (s - self.sums[after - 1]) / step } else { 0.0 };
        let (a, b) = (after - 1, after % n);
        let normal = self.curve.normals[a].lerp(self.curve.normals[b], t);
        OnCurve {
            position: self.curve.points[a].lerp(self.curve.points[b], t),
            normal: normal.try_normalize().unwrap_or(self.curve.normals[a]),
            tangent: (self.curve.points[b] - self.curve.points[a]).normalize_or_zero(),
        }
    }

    /// Arc length of the curve's place nearest to `p`. O(n).
    pub(crate) fn nearest(&self, p: DVec3) -> f64 {
        let n = self.curve.points.len();
        let mut best = (f64::INFINITY, 0.0);
        for k in 1..self.sums.len() {
            let (a, b) = (self.curve.points[k - 1], self.curve.points[k % n]);
            let d = b - a;
            let t = if d.length_squared() > 0.0 {
                ((p - a).dot(d) / d.length_squared()).clamp(0.0, 1.0)
            } else {
                0.0
            };
            let distance = (a + t * d - p).length_squared();
            if distance < best.0 {
                best = (distance, self.sums[k - 1] + t * (self.sums[k] - self.sums[k - 1]));
            }
        }
        best.1
    }

    /// Signed way from `a` to `b`: the shorter way round on a closed curve.
    pub(crate) fn way(&self, a: f64, b: f64) -> f64 {
        let way = b - a;
        if !self.curve.closed {
            return way;
        }
        let total = self.length();
        (way + 0.5 * total).rem_euclid(total) - 0.5 * total
    }
}

/// Where each node is and which way is outward.
#[derive(Clone, Debug)]
pub(crate) struct Placed {
    pub(crate) positions: Vec<DVec3>,
    /// Horizontal unit direction in which the node's ease moves it.
    pub(crate) outward: Vec<DVec3>,
}

/// Places template nodes on one body.
pub(crate) struct Placing<'a> {
    layout: &'a Layout,
    features: &'a Features,
    skin: &'a Skin<'a>,
    /// Ease moves no node nearer to the skin than this, mm.
    clearance: f64,
    /// For twins: the signs of the first and second tangent, so that an offset means its mirror image.
    signs: Vec<[f64; 2]>,
    order: Vec<u32>,
}

impl<'a> Placing<'a> {
    /// Looks all features up once.
    pub(crate) fn new(
        layout: &'a Layout,
        features: &'a Features,
        skin: &'a Skin<'a>,
        clearance: f64,
    ) -> Result<Self, TemplateError> {
        let order = dependency_order(layout)?;
        let mut placing =
            Self { layout, features, skin, clearance, signs: vec![[1.0; 2]; layout.nodes.len()], order };
        for i in 0..layout.nodes.len() {
            let (Some(source), Some(_)) = (layout.nodes[i].made_from, &layout.nodes[i].spec.at) else {
                continue;
            };
            // The mirror image of "30 mm along the waist" is 30 mm against it when the waist runs on round the body.
            let (own, original) = (placing.frame(i)?, placing.frame(source as usize)?);
            let sign = |a: DVec3, b: DVec3| if mirror(b).dot(a) < 0.0 { -1.0 } else { 1.0 };
            placing.signs[i] = [sign(own.first, original.first), sign(own.second, original.second)];
        }
        Ok(placing)
    }

    fn path(&self, node: usize) -> String {
        let node = &self.layout.nodes[node];
        let source = node.made_from.map_or(&node.name, |m| &self.layout.nodes[m as usize].name);
        format!("nodes.{source}")
    }

    /// The frame of a node's feature point, after its slide.
    fn frame(&self, node: usize) -> Result<Frame, TemplateError> {
        let spec = &self.layout.nodes[node].spec;
        let path = format!("{}.at", self.path(node));
        let frame = match &spec.at {
            Some(At::Crossing([a, b])) => {
                feature_curve(self.features, a, &path)?;
                feature_curve(self.features, b, &path)?;
                self.features.crossing(a, b).ok_or_else(|| TemplateError::NoCrossing {
                    path: path.clone(),
                    first: a.clone(),
                    second: b.clone(),
                })?
            }
            Some(At::Point(p)) => {
                self.features.point_frame(p).ok_or_else(|| TemplateError::UnknownFeature {
                    path: path.clone(),
                    feature: p.clone(),
                    known: format!("the points {}", names(self.features.points.keys())),
                })?
            }
            None => return Err(TemplateError::format(path, "missing")),
        };
        match &spec.slide {
            None => Ok(frame),
            Some(slide) => self.slid(node, spec, slide, &frame),
        }
    }

    fn slid(
        &self,
        node: usize,
        spec: &NodeSpec,
        slide: &Slide,
        frame: &Frame,
    ) -> Result<Frame, TemplateError> {
        let path = format!("{}.slide", self.path(node));
        let curve = feature_curve(self.features, &slide.along, &path)?;
        let arc = ArcLength::new(curve);
        let start = arc.nearest(frame.origin);
        let (toward, reach) = match &slide.toward {
            None => (1.0, arc.length()),
            Some(target) => {
                let place = if self.features.curves.contains_key(target) {
                    let crossing = self.features.crossing(&slide.along, target);
                    crossing.map(|f| f.origin).ok_or_else(|| TemplateError::NoCrossing {
                        path: path.clone(),
                        first: slide.along.clone(),
                        second: target.clone(),
                    })?
                } else {
                    let known = || format!("the points {}", names(self.features.points.keys()));
                    let point =
                        self.features.points.get(target).ok_or_else(|| TemplateError::UnknownFeature {
                            path: path.clone(),
                            feature: target.clone(),
                            known: known(),
                        })?;
                    point.position
                };
                let way = arc.way(start, arc.nearest(place));
                (if way < 0.0 { -1.0 } else { 1.0 }, way.abs())
            }
        };
        let step = match (slide.by, slide.fraction) {
            (Some(by), _) => by * self.scale(spec),
            (_, Some(fraction)) => fraction * reach,
            _ => 0.0,
        };
        let there = arc.at(start + toward * step);
        // The offset's first direction runs on along the walk, the second stays on the side it was.
        let first = toward * there.tangent;
        let across = there.normal.cross(first);
        let second = if across.dot(frame.second) < 0.0 { -across } else { across };
        Ok(Frame { origin: there.position, normal: there.normal, first, second: second.normalize_or_zero() })
    }

    fn scale(&self, spec: &NodeSpec) -> f64 {
        match spec.scale {
            Some(Scale::Height) if self.features.height > 0.0 => self.features.height / SCALE_STATURE,
            _ => 1.0,
        }
    }

    fn height_of(&self, feature: &str, path: &str) -> Result<f64, TemplateError> {
        if let Some(curve) = self.features.curves.get(feature).filter(|c| c.points.len() >= 2) {
            let arc = ArcLength::new(curve);
            let total = arc.length();
            // The mean by length, whatever the spacing of the points.
            let heights = |k: usize| curve.points[k % curve.points.len()].y;
            let weighted: f64 = (1..arc.sums.len())
                .map(|k| 0.5 * (heights(k - 1) + heights(k)) * (arc.sums[k] - arc.sums[k - 1]))
                .sum();
            return Ok(if total > 0.0 { weighted / total } else { heights(0) });
        }
        if let Some(point) = self.features.points.get(feature) {
            return Ok(point.position.y);
        }
        match feature {
            "floor" => Ok(0.0),
            "crown" => Ok(self.features.height),
            _ => Err(TemplateError::UnknownFeature {
                path: path.into(),
                feature: feature.into(),
                known: format!(
                    "floor, crown, the curves {}, the points {}",
                    names(self.features.curves.keys()),
                    names(self.features.points.keys())
                ),
            }),
        }
    }

    fn level(&self, node: usize, spec: &NodeSpec) -> Result<Option<f64>, TemplateError> {
        let path = format!("{}.level", self.path(node));
        Ok(match &spec.level {
            None => None,
            Some(Level::Feature(f)) => Some(self.height_of(f, &path)?),
            Some(Level::Between(l)) => {
                let from = self.height_of(&l.from, &path)?;
                let to = self.height_of(l.to.as_deref().unwrap_or(&l.from), &path)?;
                Some(from + l.t * (to - from) + l.plus * self.scale(spec))
            }
        })
    }

    fn place(&self, node: usize, done: &[DVec3], push: f64) -> Result<(DVec3, DVec3), TemplateError> {
        let spec = &self.layout.nodes[node].spec;
        let scale = self.scale(spec);
        let (mut place, mut outward) = match &spec.between {
            Some(ends) => {
                let find = |n: &String| self.layout.nodes.iter().position(|m| m.name == *n);
                let (a, b) = (find(&ends[0]), find(&ends[1]));
                let (Some(a), Some(b)) = (a, b) else {
                    return Err(TemplateError::format(
                        format!("{}.between", self.path(node)),
                        "unknown node",
                    ));
                };
                let origin = done[a].lerp(done[b], spec.t.unwrap_or(0.5));
                let normal = self.skin.look(origin).normal;
                (origin + scale * spec.normal * normal, normal)
            }
            None => {
                let frame = self.frame(node)?;
                let [first, second] = self.signs[node];
                if (spec.first != 0.0 || spec.second != 0.0) && encode(&frame, frame.origin).is_none() {
                    return Err(TemplateError::FlatFrame {
                        path: self.path(node),
                        feature: format!("{:?}", spec.at),
                    });
                }
                let offset = Offset {
                    normal: scale * spec.normal,
                    first: scale * first * spec.first,
                    second: scale * second * spec.second,
                };
                (decode(&frame, offset), frame.normal)
            }
        };
        if let Some(axes) = spec.axes {
            place = decode_axes(place, axes.map(|v| v * scale));
        }
        if let Some(lift) = spec.skin {
            let sight = self.skin.look(place);
            place = sight.point + lift * sight.normal;
            outward = sight.normal;
        }
        if let Some(height) = self.level(node, spec)? {
            place.y = height;
        }
        let horizontal = DVec3::new(outward.x, 0.0, outward.z).try_normalize();
        let outward = horizontal.unwrap_or(DVec3::ZERO);
        Ok((self.pushed(place, outward, push), outward))
    }

    /// Moves a node for its ease, in steps, and stops before the skin: of the trunk inward, of an arm outward (T6).
    fn pushed(&self, place: DVec3, outward: DVec3, push: f64) -> DVec3 {
        if push == 0.0 || outward == DVec3::ZERO {
            return place;
        }
        let steps = (push.abs() / PUSH_STEP).ceil().max(1.0);
        let mut distance = self.skin.signed(place);
        for k in 1..=steps as usize {
            let there = self.skin.signed(place + push * k as f64 / steps * outward);
            if there < self.clearance && there < distance {
                return place + push * (k - 1) as f64 / steps * outward;
            }
            distance = there;
        }
        place + push * outward
    }

    /// All nodes, with each ease level's offset (by level name, mm) added to the nodes that carry its name.
    pub(crate) fn place_all(&self, push: &BTreeMap<String, f64>) -> Result<Placed, TemplateError> {
        let n = self.layout.nodes.len();
        let mut out = Placed { positions: vec![DVec3::ZERO; n], outward: vec![DVec3::ZERO; n] };
        for &node in &self.order {
            let i = node as usize;
            let by =
                self.layout.nodes[i].spec.ease.as_ref().and_then(|e| push.get(e)).copied().unwrap_or(0.0);
            (out.positions[i], out.outward[i]) = self.place(i, &out.positions, by)?;
            if !out.positions[i].is_finite() {
                let problem = format!("{} is not finite on this body", self.path(i));
                return Err(TemplateError::BadReference(problem));
            }
        }
        symmetrise(self.layout, &mut out.positions);
        Ok(out)
    }
}

/// Where the nodes of a template are on a body, twins included, before ease and collision; the template may be incomplete.
/// `prepared` is the body's. O(nodes · curve points).
///
/// # Errors
/// [`TemplateError`]: a feature that the body lacks, curves that do not cross.
pub fn node_places(
    file: &TemplateFile,
    reference: &Reference,
    prepared: &Prepared,
) -> Result<BTreeMap<String, DVec3>, TemplateError> {
    let layout = nodes_only(file)?;
    let skin = Skin::new(reference.mesh, prepared);
    let placing = Placing::new(&layout, reference.features, &skin, file.clearance)?;
    let placed = placing.place_all(&BTreeMap::new())?;
    Ok(layout.nodes.iter().map(|n| n.name.clone()).zip(placed.positions).collect())
}

/// The frame that a node's offsets (`normal`, `first`, `second`) are counted in, after its slide.
///
/// # Errors
/// As [`node_places`]; a node that is placed between others has no frame.
pub fn node_frame(
    file: &TemplateFile,
    node: &str,
    reference: &Reference,
    prepared: &Prepared,
) -> Result<Frame, TemplateError> {
    let layout = nodes_only(file)?;
    let skin = Skin::new(reference.mesh, prepared);
    let placing = Placing::new(&layout, reference.features, &skin, file.clearance)?;
    let index = layout.nodes.iter().position(|n| n.name == node);
    let index =
        index.ok_or_else(|| TemplateError::format(format!("nodes.{node}"), "there is no such node"))?;
    placing.frame(index)
}

fn nodes_only(file: &TemplateFile) -> Result<Layout, TemplateError> {
    crate::format::check::check_incomplete(file)?;
    let nodes = TemplateFile {
        surfaces: BTreeMap::new(),
        lines: BTreeMap::new(),
        joints: None,
        fair_across: Vec::new(),
        ease: BTreeMap::new(),
        pieces: BTreeMap::new(),
        ..file.clone()
    };
    Layout::new(&nodes)
}

fn mirror(p: DVec3) -> DVec3 {
    DVec3::new(-p.x, p.y, p.z)
}

/// In a symmetric template, makes each node the mirror image of its twin, to the bit; centre nodes lie at x = 0.
pub(crate) fn symmetrise(layout: &Layout, positions: &mut [DVec3]) {
    if !layout.symmetric {
        return;
    }
    for (i, node) in layout.nodes.iter().enumerate() {
        let Some(t) = node.twin.map(|t| t as usize) else { continue };
        if t == i {
            positions[i].x = 0.0;
        } else if i < t {
            let mean = 0.5 * (positions[i] + mirror(positions[t]));
            positions[i] = mean;
            positions[t] = mirror(mean);
        }
    }
}

/// Nodes in an order in which `between` finds its ends done.
fn dependency_order(layout: &Layout) -> Result<Vec<u32>, TemplateError> {
    let index: BTreeMap<&str, usize> =
        layout.nodes.iter().enumerate().map(|(i, n)| (n.name.as_str(), i)).collect();
    // 0 not seen, 1 being visited, 2 done
    let mut state = vec![0u8; layout.nodes.len()];
    let mut order = Vec::with_capacity(layout.nodes.len());
    for root in 0..layout.nodes.len() {
        let mut stack = vec![root];
        while let Some(&i) = stack.last() {
            if state[i] == 2 {
                stack.pop();
                continue;
            }
            let ends = layout.nodes[i].spec.between.iter().flatten().filter_map(|n| index.get(n.as_str()));
            let open: Vec<usize> = ends.copied().filter(|e| state[*e] != 2).collect();
            if open.is_empty() {
                state[i] = 2;
                order.push(i as u32);
                stack.pop();
            } else if state[i] == 1 {
                let message = "`between` goes round in a circle; give one of its nodes with `at`";
                return Err(TemplateError::format(
                    format!("nodes.{}.between", layout.nodes[i].name),
                    message,
                ));
            } else {
                state[i] = 1;
                stack.extend(open);
            }
        }
    }
    Ok(order)
}
