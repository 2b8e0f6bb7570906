//! Bodies before and after an operator as SVG, for the operators' page in `docs/`.

use std::fmt::Write;

use mesh_kernel::body::{AttributeEdgeId, AttributeNodeId, Body, FaceId, NONE, NodeId, SurfaceId};
use mesh_kernel::glam::{DVec2, DVec3};

const SIZE: f64 = 200.0;
const MARGIN: f64 = 26.0;
const COLOURS: [&str; 5] = ["#7aa6d6", "#e0a458", "#8cc084", "#c58bc0", "#d97b7b"];

/// From the front, a little from the right and above, so that planar bodies stay as they are and sheets stand apart.
fn project(p: DVec3) -> DVec2 {
    DVec2::new(p.x + 0.42 * p.z, p.y + 0.26 * p.z)
}

/// Picture of two bodies side by side with an arrow between them, in one scale.
pub(crate) fn before_after(before: &Body, after: &Body) -> String {
    let points: Vec<DVec2> = [before, after]
        .iter()
        .flat_map(|b| b.surfaces())
        .flat_map(|(_, s)| s.live_nodes().map(|v| project(s.positions()[v.index()])).collect::<Vec<_>>())
        .collect();
    let low = points.iter().copied().fold(DVec2::INFINITY, DVec2::min);
    let high = points.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
    let span = (high - low).max_element().max(1e-9);
    let scale = (SIZE - 2.0 * MARGIN) / span;
    let centre = (low + high) * 0.5;
    let width = 2.0 * SIZE + 60.0;
    let mut svg = String::new();
    let _ = writeln!(
        svg,
        r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {SIZE}" width="{width}" height="{SIZE}" font-family="sans-serif" font-size="11">
<rect width="100%" height="100%" fill="#ffffff"/>"##
    );
    for (body, left) in [(before, 0.0), (after, SIZE + 60.0)] {
        let place = |p: DVec3| {
            let q = (project(p) - centre) * scale;
            DVec2::new(left + SIZE * 0.5 + q.x, SIZE * 0.5 - q.y)
        };
        draw(&mut svg, body, &place);
    }
    let (x, y) = (SIZE + 8.0, SIZE * 0.5);
    let _ = writeln!(
        svg,
        r##"<path d="M {x} {y} h 40 m -9 -6 l 9 6 l -9 6" fill="none" stroke="#444" stroke-width="2"/>
</svg>"##
    );
    svg
}

fn draw(svg: &mut String, body: &Body, place: &dyn Fn(DVec3) -> DVec2) {
    let at = |s: SurfaceId, v: u32| place(body.surface(s).positions()[v as usize]);
    for (id, s) in body.surfaces() {
        let colour = COLOURS[id.index() % COLOURS.len()];
        for f in s.live_faces() {
            let [a, b, c] = s.faces()[f.index()].map(|v| at(id, v));
            let _ = writeln!(
                svg,
                r#"<path d="M {:.1} {:.1} L {:.1} {:.1} L {:.1} {:.1} Z" fill="{colour}" fill-opacity="0.45"/>"#,
                a.x, a.y, b.x, b.y, c.x, c.y
            );
        }
    }
    for (id, s) in body.surfaces() {
        for e in s.live_edges() {
            let [a, b] = s.edges()[e.index()].map(|v| at(id, v));
            let joint = s.edge_chain(e).is_some_and(|c| s.chain(c).joint().is_some());
            let wire = s.edge_faces()[e.index()] == [NONE; 2];
            let (stroke, width) = if joint {
                ("#b03030", 3.0)
            } else if wire {
                ("#333", 2.0)
            } else {
                ("#333", 1.0)
            };
            let _ = writeln!(
                svg,
                r#"<path d="M {:.1} {:.1} L {:.1} {:.1}" stroke="{stroke}" stroke-width="{width}"/>"#,
                a.x, a.y, b.x, b.y
            );
        }
        lines(svg, s, place);
    }
    for (id, s) in body.surfaces() {
        for NodeId(v) in s.live_nodes() {
            let p = at(id, v);
            let _ = writeln!(svg, r##"<circle cx="{:.1}" cy="{:.1}" r="3" fill="#222"/>"##, p.x, p.y);
        }
    }
    labels(svg, body, place);
}

/// Attribute nodes as rings, attribute edges dashed.
fn lines(svg: &mut String, s: &mesh_kernel::body::Surface, place: &dyn Fn(DVec3) -> DVec2) {
    let at = |n: AttributeNodeId| place(s.attribute_position(n));
    for l in 0..s.attribute_edges().len() as u32 {
        let nodes = &s.attribute_edges()[AttributeEdgeId(l).index()].nodes;
        let path: Vec<String> =
            nodes.iter().map(|&n| at(n)).map(|p| format!("{:.1} {:.1}", p.x, p.y)).collect();
        let _ = writeln!(
            svg,
            r##"<path d="M {}" fill="none" stroke="#7a2fa0" stroke-width="2" stroke-dasharray="5 3"/>"##,
            path.join(" L ")
        );
    }
    for n in 0..s.attribute_nodes().len() as u32 {
        let p = at(AttributeNodeId(n));
        let _ = writeln!(
            svg,
            r##"<circle cx="{:.1}" cy="{:.1}" r="5" fill="none" stroke="#7a2fa0" stroke-width="2"/>"##,
            p.x, p.y
        );
    }
}

/// Numbers of nodes and faces, where there is one surface: numbers of several would lie on each other.
fn labels(svg: &mut String, body: &Body, place: &dyn Fn(DVec3) -> DVec2) {
    if body.surfaces().len() != 1 {
        return;
    }
    let s = body.surface(SurfaceId(0));
    for NodeId(v) in s.live_nodes() {
        let p = place(s.positions()[v as usize]);
        let _ = writeln!(svg, r##"<text x="{:.1}" y="{:.1}" fill="#222">{v}</text>"##, p.x + 6.0, p.y - 6.0);
    }
    for FaceId(f) in s.live_faces() {
        let m = place(s.corners(FaceId(f)).iter().sum::<DVec3>() / 3.0);
        let _ = writeln!(
            svg,
            r##"<text x="{:.1}" y="{:.1}" fill="#225" font-style="italic" text-anchor="middle">f{f}</text>"##,
            m.x,
            m.y + 4.0
        );
    }
}
