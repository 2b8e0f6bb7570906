//! The operators' page in `docs/`: every operator is carried out, its picture drawn, its delta counted, its refusal
//! quoted. `UPDATE_DOCS=1 cargo test --release -p mesh_kernel --test all operator_docs` writes the page anew.

mod drawing;

use std::fmt::Write;
use std::path::{Path, PathBuf};

use mesh_kernel::body::edit::{CollapseOptions, Editor, Guard, Operation};
use mesh_kernel::body::{
    AttributeEdge, AttributeNode, AttributeNodeId, Body, ChainSpec, Counts, EdgeId, FaceId, JointSpec,
    NodeId, SurfaceId, SurfaceSpec,
};
use mesh_kernel::glam::DVec3;

const S: SurfaceId = SurfaceId(0);

fn at(x: f64, y: f64) -> DVec3 {
    DVec3::new(x, y, 0.0)
}

fn flat(points: &[(f64, f64)], faces: &[[u32; 3]]) -> Body {
    let positions = points.iter().map(|&(x, y)| at(x, y)).collect();
    Body::build(&[SurfaceSpec { name: "patch".into(), positions, faces: faces.to_vec() }], &[]).unwrap()
}

fn wires(points: &[(f64, f64)], edges: &[(u32, u32)]) -> Body {
    let mut editor = Editor::new(Body::default());
    let surface = editor.add_surface("wires");
    for &(x, y) in points {
        editor.make_vertex_complex(surface, at(x, y)).unwrap();
    }
    for &(a, b) in edges {
        editor.make_edge(surface, NodeId(a), NodeId(b)).unwrap();
    }
    editor.into_body()
}

/// Six triangles round node 0.
fn disk() -> Body {
    let mut points = vec![(0.0, 0.0)];
    points
        .extend((0..6).map(|k| (f64::from(k) * std::f64::consts::FRAC_PI_3).sin_cos()).map(|(s, c)| (c, s)));
    let faces: Vec<[u32; 3]> = (0..6).map(|k| [0, 1 + k, 1 + (k + 1) % 6]).collect();
    flat(&points, &faces)
}

/// Three flaps of two faces at a rib of two edges: a T.
fn flaps(joined: bool) -> Body {
    let flap = |out: DVec3| SurfaceSpec {
        name: "flap".into(),
        positions: vec![at(0.0, -1.0), at(0.0, 0.0), at(0.0, 1.0), out],
        faces: vec![[0, 1, 3], [1, 2, 3]],
    };
    let flaps = [DVec3::X, DVec3::NEG_X, DVec3::new(0.4, 0.3, 1.6)].map(flap);
    let chains = (0..3).map(|surface| ChainSpec { surface, nodes: vec![0, 1, 2], closed: false }).collect();
    let joint = JointSpec { name: Some("rib".into()), chains };
    Body::build(&flaps, if joined { std::slice::from_ref(&joint) } else { &[] }).unwrap()
}

fn with_attributes(mut body: Body, nodes: &[AttributeNode], line: &[u32]) -> Body {
    let s = body.surface_mut(S);
    for &node in nodes {
        s.add_attribute_node(node).unwrap();
    }
    if !line.is_empty() {
        let nodes = line.iter().map(|&n| AttributeNodeId(n)).collect();
        s.add_attribute_edge(AttributeEdge { name: None, nodes }).unwrap();
    }
    body
}

fn edge(body: &Body, surface: u32, a: u32, b: u32) -> EdgeId {
    body.surface(SurfaceId(surface)).find_edge(NodeId(a), NodeId(b)).unwrap()
}

struct Entry {
    /// The method of the editor; names the picture too.
    name: &'static str,
    title: &'static str,
    text: &'static str,
    cost: &'static str,
    before: Body,
    operation: Operation,
    /// One that is refused, on the body before or after.
    refused: Operation,
}

fn euler() -> Vec<Entry> {
    let triangle = || flat(&[(0.0, 0.0), (2.0, 0.0), (0.8, 1.6)], &[[0, 1, 2]]);
    let loop_of_three = || wires(&[(0.0, 0.0), (2.0, 0.0), (0.8, 1.6)], &[(0, 1), (1, 2), (2, 0)]);
    let path = || wires(&[(0.0, 0.0), (2.0, 0.0), (0.8, 1.6)], &[(0, 1), (1, 2)]);
    let two = || wires(&[(0.0, 0.0), (0.0, 1.5), (2.0, 0.0), (2.0, 1.5)], &[(0, 1), (2, 3)]);
    // A tetrahedron without its last face.
    let open = || {
        let positions = vec![at(0.0, 0.0), at(2.0, 0.0), at(1.0, 1.7), DVec3::new(1.0, 0.5, 1.5)];
        let faces = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3]];
        Body::build(&[SurfaceSpec { name: "shell".into(), positions, faces }], &[]).unwrap()
    };
    let sides = |b: &Body, [p, q, r]: [u32; 3]| [edge(b, 0, p, q), edge(b, 0, q, r), edge(b, 0, r, p)];
    let ring = |areal| AttributeNode::InFace { face: FaceId(0), areal };
    vec![
        Entry {
            name: "make_vertex_complex",
            title: "make_vertex_complex",
            text: "A node that stands alone. Inverse: `kill_vertex_complex`. Lee & Kim: MVS.",
            cost: "O(1)",
            before: triangle(),
            operation: Operation::MakeVertexComplex { surface: S, position: at(1.9, 1.3) },
            refused: Operation::MakeVertexComplex { surface: S, position: at(f64::NAN, 0.0) },
        },
        Entry {
            name: "make_vertex_edge",
            title: "make_vertex_edge",
            text: "A node and an edge to it from a node that is there. Inverse: `kill_vertex_edge`. Lee & Kim: MEV.",
            cost: "O(1)",
            before: triangle(),
            operation: Operation::MakeVertexEdge { surface: S, from: NodeId(2), position: at(2.0, 1.6) },
            refused: Operation::MakeVertexEdge { surface: S, from: NodeId(9), position: at(2.0, 1.6) },
        },
        Entry {
            name: "make_edge_chole",
            title: "make_edge_chole",
            text: "An edge between nodes of one component: it closes a cycle. Inverse: `kill_edge_chole`. Lee & Kim: MEC.",
            cost: "O(component)",
            before: path(),
            operation: Operation::MakeEdgeChole { surface: S, from: NodeId(2), to: NodeId(0) },
            refused: Operation::MakeEdgeKillComplex { surface: S, from: NodeId(2), to: NodeId(0) },
        },
        Entry {
            name: "make_edge_kill_complex",
            title: "make_edge_kill_complex",
            text: "An edge between two components: they become one. Inverse: `kill_edge_make_complex`. Lee & Kim: MEKS.",
            cost: "O(component)",
            before: two(),
            operation: Operation::MakeEdgeKillComplex { surface: S, from: NodeId(1), to: NodeId(3) },
            refused: Operation::MakeEdgeChole { surface: S, from: NodeId(1), to: NodeId(3) },
        },
        Entry {
            name: "make_face_kill_chole",
            title: "make_face_kill_chole",
            text: "A face over a cycle of three edges. Inverse: `kill_face_make_chole`. Lee & Kim: MFKC.",
            cost: "O(edges of the surface), for its boundary loops",
            operation: Operation::MakeFaceKillChole { surface: S, sides: sides(&loop_of_three(), [0, 1, 2]) },
            before: loop_of_three(),
            refused: Operation::MakeFaceMakeCavity { surface: S, sides: sides(&loop_of_three(), [0, 1, 2]) },
        },
        Entry {
            name: "make_face_make_cavity",
            title: "make_face_make_cavity",
            text: "The face that closes a shell: it encloses a void. Inverse: `kill_face_kill_cavity`. Lee & Kim: MFR.",
            cost: "O(faces of the shell + edges of the surface)",
            operation: Operation::MakeFaceMakeCavity { surface: S, sides: sides(&open(), [0, 3, 2]) },
            refused: Operation::MakeFaceKillChole { surface: S, sides: sides(&open(), [0, 3, 2]) },
            before: open(),
        },
        Entry {
            name: "split_wire",
            title: "split_edge (`split_wire`)",
            text: "A node on an edge without faces. Inverse: `merge_wire`. Lee & Kim: SEMV. On an edge with faces K4's edge split cuts these too.",
            cost: "O(1), on a joint O(its length)",
            operation: Operation::SplitWire { surface: S, edge: EdgeId(0), at: 0.4 },
            before: path(),
            refused: Operation::SplitWire { surface: S, edge: EdgeId(0), at: 1.0 },
        },
        Entry {
            name: "make_vertex_ring",
            title: "make_vertex_ring",
            text: "A node inside a face. Faces of a triangle surface have no rings; the node is an attribute (ATTRIB_FACENODE) until face triangulation makes it real. v + 1 and r + 1 cancel in the identity, and the counts leave both out. Inverse: `kill_vertex_ring`. Lee & Kim: MVL.",
            cost: "O(1)",
            before: triangle(),
            operation: Operation::MakeVertexRing { surface: S, face: FaceId(0), areal: [0.4, 0.3, 0.3] },
            refused: Operation::MakeVertexRing { surface: S, face: FaceId(0), areal: [0.5, 0.6, 0.5] },
        },
        Entry {
            name: "make_edge_kill_ring",
            title: "make_edge_kill_ring",
            text: "A line between two such nodes (ATTRIB_EDGE); e + 1 and r − 1 cancel likewise. Inverse: `kill_edge_make_ring`. Lee & Kim: MEKL.",
            cost: "O(1)",
            before: with_attributes(triangle(), &[ring([0.6, 0.2, 0.2]), ring([0.2, 0.5, 0.3])], &[]),
            operation: Operation::MakeEdgeKillRing {
                surface: S,
                nodes: [AttributeNodeId(0), AttributeNodeId(1)],
            },
            refused: Operation::MakeEdgeKillRing {
                surface: S,
                nodes: [AttributeNodeId(0), AttributeNodeId(7)],
            },
        },
    ]
}

fn high_level() -> Vec<Entry> {
    let collapse = |surface, edge, keep| {
        let CollapseOptions { at, guard } = CollapseOptions::default();
        Operation::CollapseEdge { surface, edge, keep, at, guard }
    };
    let marked = || {
        let on = |e, u| AttributeNode::OnEdge { edge: EdgeId(e), u };
        let inside = AttributeNode::InFace { face: FaceId(0), areal: [0.3, 0.3, 0.4] };
        let body = flat(&[(0.0, 0.0), (2.4, 0.0), (1.2, 1.8), (1.2, -1.2)], &[[0, 1, 2], [1, 0, 3]]);
        with_attributes(body, &[on(0, 0.3), inside, on(1, 0.5)], &[0, 1, 2])
    };
    vec![
        Entry {
            name: "split_edge",
            title: "Edge split",
            text: "A node on an edge; its faces are cut in two.",
            cost: "O(1) inside a surface, O(chain) on one",
            operation: Operation::SplitEdge { surface: S, edge: edge(&disk(), 0, 0, 1), at: 0.5 },
            refused: Operation::SplitEdge { surface: S, edge: edge(&disk(), 0, 0, 1), at: 0.0 },
            before: disk(),
        },
        Entry {
            name: "split_edge_joint",
            title: "Edge split on a joint",
            text: "All partners of the edge are split, their new nodes bit-equal in position.",
            cost: "O(sheets · chain)",
            operation: Operation::SplitEdge { surface: S, edge: edge(&flaps(true), 0, 1, 2), at: 0.5 },
            refused: Operation::SplitEdge { surface: S, edge: EdgeId(99), at: 0.5 },
            before: flaps(true),
        },
        Entry {
            name: "collapse_edge",
            title: "Edge collapse",
            text: "One end of an edge goes into the other, with the edge and its faces, if the link condition holds.",
            cost: "O(faces at both ends)",
            operation: collapse(S, edge(&disk(), 0, 0, 1), NodeId(1)),
            before: disk(),
            refused: collapse(S, edge(&disk(), 0, 0, 1), NodeId(5)),
        },
        Entry {
            name: "collapse_edge_joint",
            title: "Edge collapse on a joint",
            text: "All partners collapse together; the end that other joints or the joint's end hold is the one to keep.",
            cost: "O(sheets · (chain + faces at both ends))",
            operation: collapse(S, edge(&flaps(true), 0, 1, 2), NodeId(2)),
            refused: collapse(S, edge(&flaps(true), 0, 1, 3), NodeId(3)),
            before: flaps(true),
        },
        Entry {
            name: "swap_edge",
            title: "Edge swap",
            text: "The other diagonal of the two faces at an edge.",
            cost: "O(faces at one end)",
            operation: Operation::SwapEdge { surface: S, edge: edge(&disk(), 0, 0, 1), guard: Guard::None },
            before: disk(),
            refused: Operation::SwapEdge { surface: S, edge: edge(&disk(), 0, 1, 2), guard: Guard::None },
        },
        Entry {
            name: "split_face",
            title: "Face split, 1 → 4",
            text: "Nodes in the middle of a face's sides; neighbours are cut along.",
            cost: "O(chains concerned)",
            operation: Operation::SplitFace { surface: S, face: FaceId(1) },
            before: disk(),
            refused: Operation::SplitFace { surface: S, face: FaceId(9) },
        },
        Entry {
            name: "split_face_joint",
            title: "Face split at a joint",
            text: "Partners of its sides on joints get nodes too, and the faces there are triangulated.",
            cost: "O(chains concerned)",
            operation: Operation::SplitFace { surface: S, face: FaceId(0) },
            before: flaps(true),
            refused: Operation::SplitFace { surface: SurfaceId(5), face: FaceId(0) },
        },
        Entry {
            name: "triangulate_face",
            title: "Face triangulation",
            text: "Attribute nodes and lines in a face become nodes and edges, by constrained Delaunay triangulation.",
            cost: "O(n log n) for n attributes there",
            before: marked(),
            operation: Operation::TriangulateFace { surface: S, face: FaceId(0) },
            refused: Operation::TriangulateFace { surface: S, face: FaceId(7) },
        },
    ]
}

fn joints() -> Vec<Entry> {
    let chains = |n: usize| {
        (0..n).map(|surface| ChainSpec { surface, nodes: vec![0, 1, 2], closed: false }).collect::<Vec<_>>()
    };
    vec![Entry {
        name: "make_joint",
        title: "make_joint",
        text: "Chains of edges that lie on each other become one; sheets stand in radial order. Inverse: `kill_joint`.",
        cost: "O(faces of its surfaces)",
        before: flaps(false),
        operation: Operation::MakeJoint { joint: JointSpec { name: Some("rib".into()), chains: chains(3) } },
        refused: Operation::MakeJoint { joint: JointSpec { name: Some("rib".into()), chains: chains(1) } },
    }]
}

fn delta(a: Counts, b: Counts) -> String {
    let part =
        |name: &str, d: i64| (d != 0).then(|| format!("{name} {}{}", if d < 0 { "−" } else { "+" }, d.abs()));
    let parts = [
        part("v", b.v - a.v),
        part("e", b.e - a.e),
        part("f", b.f - a.f),
        part("r", b.r - a.r),
        part("C", b.c - a.c),
        part("Ch", b.ch - a.ch),
        part("Cc", b.cc - a.cc),
    ];
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    if parts.is_empty() { "none".into() } else { parts.join(", ") }
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs")
}

/// Compares with what is in `docs/`, or writes it.
fn keep(path: &Path, text: &str) {
    if std::env::var_os("UPDATE_DOCS").is_some() {
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }
    let there = std::fs::read_to_string(path).unwrap_or_default();
    assert!(
        there == text,
        "{} is out of date: run with UPDATE_DOCS=1 and look at the change",
        path.display()
    );
}

const HEAD: &str = "# Operators

Every edit of a body goes through an operator of `mesh_kernel::body::edit::Editor`. An operator first finds out whether it
may; if not, it says why, names what is in the way and the remedy, and changes nothing. If it may, it acts, keeps the body
sound, and is logged: undo gives the body back bit for bit, numbers included. `Operation` is every operator as data, to be
saved, replayed and shrunk to the few lines that matter.

This page is written by the test `operator_docs` of the kernel: pictures, deltas and refusals come from running each operator.
Deltas are those of the whole body's counts, `v − e + f − r = C − Ch + Cc`. Faces are tinted by surface, edges on joints are
red, attribute nodes and lines violet; numbers are the nodes' and faces' own.
";

#[test]
fn the_page_shows_what_the_operators_do() {
    let mut page = String::from(HEAD);
    let sections = [
        ("Extended Euler operators on triangle surfaces (K3)", euler()),
        ("High-level operators (K4)", high_level()),
        ("Joints", joints()),
    ];
    for (title, entries) in sections {
        let _ = write!(page, "\n## {title}\n");
        for entry in entries {
            let mut editor = Editor::new(entry.before.clone());
            let refusal = editor.apply(&entry.refused).unwrap_err();
            assert_eq!(editor.body(), &entry.before, "{}", entry.name);
            editor.apply(&entry.operation).unwrap_or_else(|e| panic!("{}: {e}", entry.name));
            let after = editor.body().clone();
            assert_eq!(after.check(), [], "{}", entry.name);
            let picture = drawing::before_after(&entry.before, &after);
            keep(&folder().join(format!("operators/{}.svg", entry.name)), &picture);
            let _ = write!(
                page,
                "\n### {}\n\n{}\n\n![Before and after](operators/{}.svg)\n\nDelta here: {}. Cost: {}. Refused, for example: *{}*\n",
                entry.title,
                entry.text,
                entry.name,
                delta(entry.before.counts(), after.counts()),
                entry.cost,
                refusal,
            );
            assert!(editor.undo());
            assert_eq!(editor.body(), &entry.before, "{}", entry.name);
        }
    }
    page.push_str(FOOT);
    keep(&folder().join("operators.md"), &page);
}

const FOOT: &str = "
## K4 in terms of K3

Killing a face means the form that its surroundings ask for (it makes a hole, or opens a cavity), and so does making one.
n is the number of faces at the edge over all its sheets, m the number of faces on a split face's other sides.

| operator | sequence of Euler operators | delta |
|---|---|---|
| edge split | kill_face for its faces; split_edge; make_edge to the tips; make_face for the parts | v + 1, e + 1 + n, f + n |
| edge collapse | kill_face for all faces at the node that goes; kill_edge for its edges; kill_vertex_complex; make_edge and make_face to the node that stays | v − 1, e − 1 − n, f − n |
| edge swap | kill_face ×2, kill_edge, make_edge, make_face ×2 | none |
| face split | kill_face for it and the faces on its sides; split_edge ×3; make_edge for the cuts; make_face for the parts | v + 3, e + 6 + m, f + 3 + m |
| face triangulation | the same with split_edge for every attribute node on a side and make_vertex_complex for every one inside | by the nodes there |

The test `body::sequences` of the kernel carries out both ways and compares the bodies bit for bit, numbers included. On a
joint the joint is killed first, the sequence done on every partner, and the joint made again. The order of every step is in
the documentation of `body::edit::euler`.

## Names of other papers

On a `Complex`, whose faces may have any outline and rings and whose edges any number of faces, Lee & Kim's operators are
(inverses KVS, KVL, KEV, KEC, KEF, KEMS, KEML, KFMC, KFR, JEKV with the negative deltas):

| name | sequence | V | E | F | L | S | C | R |
|---|---|---|---|---|---|---|---|---|
| MVS | make_vertex_complex | +1 | | | | +1 | | |
| MVL | make_vertex_ring | +1 | | | +1 | | | |
| MEV | make_vertex_edge | +1 | +1 | | | | | |
| MEC | make_edge_chole | | +1 | | | | +1 | |
| MEF | kill the face, make_edge_chole, make two faces; on wires make_edge_chole, make_face_kill_chole | | +1 | +1 | | | | |
| MEKS | make_edge_kill_complex | | +1 | | | −1 | | |
| MEKL | make_edge_kill_ring | | +1 | | −1 | | | |
| MFKC | make_face_kill_chole | | | +1 | | | −1 | |
| MFR | make_face_make_cavity | | | +1 | | | | +1 |
| SEMV | split_edge | +1 | +1 | | | | | |

and Lipson & Shpitalni's for sheet metal, where every edge is free, a bend or a weld (inverses likewise):

| name | sequence | s | b | e | w | v | g_nm | m | f |
|---|---|---|---|---|---|---|---|---|---|
| MCV | make_vertex_complex; of a vertex that joins two parts, its division | +1 | | | | +1 | | | |
| MEV | MEV | | | +1 | | +1 | | | |
| MEF | MEF | | | +1 | | | | | +1 |
| MGB | make_edge_kill_ring, the edge a bend | | +1 | | | | +1 | | |
| MBKE | a free edge becomes a bend | | +1 | −1 | | | | | |
| MUKE | two free edges become one that closes a cavity | | | −1 | | | | +1 | |
| MWKB | a bend becomes a weld | | −1 | | +1 | | | | |
";
