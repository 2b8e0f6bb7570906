//! The native file of bodies.

use fuzz::{Reader, Reading, Shape};
use mesh_kernel::body::{
    AttributeEdge, AttributeNode, Body, ChainSpec, EdgeId, FaceId, JointSpec, NodeId, SurfaceId, SurfaceSpec,
};
use mesh_kernel::glam::{DVec2, DVec3};

use crate::run;

/// Flaps of `rows` squares on one joint, the last one through it with an inner chain.
fn fan(rows: u32) -> Body {
    let strip = |name: &str, columns: &[DVec3]| {
        let width = columns.len() as u32;
        let at = |row: u32, c: u32| row * width + c;
        let cells = (0..rows).flat_map(|row| (0..width - 1).map(move |c| (row, c)));
        SurfaceSpec {
            name: name.into(),
            positions: (0..=rows)
                .flat_map(|row| columns.iter().map(move |c| *c + DVec3::Z * f64::from(row)))
                .collect(),
            faces: cells
                .flat_map(|(row, c)| {
                    [
                        [at(row, c), at(row, c + 1), at(row + 1, c + 1)],
                        [at(row, c), at(row + 1, c + 1), at(row + 1, c)],
                    ]
                })
                .collect(),
        }
    };
    let specs = [
        strip("a", &[DVec3::ZERO, DVec3::X]),
        strip("b", &[DVec3::ZERO, DVec3::Y]),
        strip("through", &[DVec3::new(-1.0, -1.0, 0.0), DVec3::ZERO, DVec3::new(1.0, -1.0, 0.0)]),
    ];
    let column = |width: u32, c: u32| (0..=rows).map(|row| row * width + c).collect();
    let chains = [(2, 0), (2, 0), (3, 1)]
        .into_iter()
        .enumerate()
        .map(|(surface, (width, c))| ChainSpec { surface, nodes: column(width, c), closed: false })
        .collect();
    Body::build(&specs, &[JointSpec { name: Some("rib".into()), chains }]).expect("flaps make a body")
}

/// With a wire, a node that stands alone, attributes, backup and flat positions.
fn full(rows: u32) -> Body {
    let mut body = fan(rows);
    let id = SurfaceId(1);
    let [a, b, _] = [7.0, 8.0, 9.0].map(|x| body.add_node(id, DVec3::splat(x)).expect("a node"));
    body.add_edge(id, a, b).expect("a wire");
    body.add_edge(id, NodeId(0), a).expect("a wire");
    let s = body.surface_mut(id);
    s.store_backup();
    let flat = s.positions().iter().map(|p| DVec2::new(p.x, p.z)).collect();
    assert!(s.set_planar(flat));
    let edge = EdgeId(s.face_edges()[0][1]);
    let p = s.add_attribute_node(AttributeNode::OnEdge { edge, u: 0.25 }).expect("on an edge");
    let q = s
        .add_attribute_node(AttributeNode::InFace { face: FaceId(0), areal: [0.25, 0.25, 0.5] })
        .expect("in a face");
    s.add_attribute_edge(AttributeEdge { name: Some("dart".into()), nodes: vec![p, q] }).expect("a line");
    body
}

/// Two tetrahedra on one triangle, every face a surface: joints of three sheets, two voids.
fn voids() -> Body {
    let positions =
        vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(0.3, 0.3, 1.0), DVec3::new(0.3, 0.3, -1.0)];
    let mut mesh = mesh_kernel::TriMesh::new(positions, vec![[0, 1, 2]]);
    for top in [3, 4] {
        mesh.faces.extend([[0, 1, top], [1, 2, top], [2, 0, top]]);
    }
    mesh.groups = (0..7).map(|i| mesh_kernel::Group { name: format!("f{i}"), faces: i..i + 1 }).collect();
    Body::from_tri_mesh(&mesh).expect("a mesh is a body")
}

/// One triangle and free numbers of every kind.
const SPARSE: &str = r#"{"format":"toile-body","version":1,"surfaces":[{"name":"s",
"positions":[[0,0,0],[9,9,9],[1,0,0],[0,1,0],[8,8,8]],"edges":[[0,2],null,[2,3],[0,3],null],"faces":[null,[0,2,-4]],
"chains":[null,{"start":0,"edges":[0,2,-4]}],"loops":[[1]],
"free":{"nodes":[4,1],"edges":[1,4],"faces":[0],"chains":[0]}}],"joints":[null],"free_joints":[0]}"#;

pub(crate) fn seeds() -> Vec<Vec<u8>> {
    let bodies = [fan(1), full(2), voids(), fan(12), Body::default()];
    let mut files: Vec<Vec<u8>> =
        bodies.iter().map(|b| b.to_file_bytes().expect("a sound body is written")).collect();
    files.push(SPARSE.into());
    files
}

/// What is read is written again, and can be asked everything that a sound body can be asked.
pub(crate) fn check(body: &Body) -> Vec<usize> {
    let bytes = body.to_file_bytes().expect("what was read is written");
    let again = Body::from_file_bytes(&bytes).expect("what was written is read");
    assert!(again == *body);
    let defects = body.check();
    assert!(defects.iter().all(|d| !d.to_string().is_empty()));
    let counts = body.counts();
    let mut compact = body.clone();
    compact.compact();
    assert_eq!(compact.counts(), counts);
    let _ = (body.volume(), body.regions(), body.to_tri_mesh());
    vec![
        body.face_count(),
        body.surfaces().len(),
        body.joint_count(),
        counts.c as usize,
        counts.ch as usize,
        counts.cc as usize,
        defects.len(),
    ]
}

#[test]
fn body() {
    run(Reader {
        name: "body",
        shape: Shape::Json,
        seeds: seeds(),
        words: &[
            "null", "left", "right", "0", "-1", "[0,1]", "[0,1,2]", "format", "version", "free", "backup",
            "planar",
        ],
        inputs: 10_000,
        base_memory: 1 << 16,
        // A surface of 11 bytes takes 500; the checks and queries keep tables of every entity besides.
        memory_factor: 600,
        read: Box::new(|bytes| match Body::from_file_bytes(bytes) {
            Ok(body) => Reading::Sound(check(&body)),
            Err(error) => Reading::Refused(error.to_string()),
        }),
    });
}
