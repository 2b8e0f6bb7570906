//! A body as JSON: a line a node, edge, face.

use serde::Serialize;

use super::record::{AttributeRecord, ChainRecord, FreeRecord, JointRecord, LineRecord, signed};
use super::{BODY_FILE_VERSION, FORMAT};
use crate::body::{Body, EdgeId, FaceId, Surface};

/// Appends the body, all of whose numbers are finite.
pub(crate) fn write_body(body: &Body, out: &mut Vec<u8>) {
    out.extend_from_slice(b"{");
    let mut object = Object { out, first: true };
    object.member("format", FORMAT);
    object.member("version", &BODY_FILE_VERSION);
    object.key("surfaces");
    object.out.extend_from_slice(b"[");
    for (i, s) in body.surfaces.iter().enumerate() {
        object.out.extend_from_slice(if i == 0 { b"\n" } else { b",\n" });
        write_surface(s, object.out);
    }
    object.out.extend_from_slice(b"]");
    object.list("joints", body.joints.iter().map(JointRecord::of));
    if !body.joint_slots.is_compact() {
        object.member("free_joints", body.joint_slots.free());
    }
    object.out.extend_from_slice(b"}");
}

fn write_surface(s: &Surface, out: &mut Vec<u8>) {
    out.extend_from_slice(b"{");
    let mut object = Object { out, first: true };
    object.member("name", &s.name);
    object.list("positions", s.positions.iter().map(|p| p.to_array()));
    if !s.backup.is_empty() {
        object.list("backup", s.backup.iter().map(|p| p.to_array()));
    }
    if !s.planar.is_empty() {
        object.list("planar", s.planar.iter().map(|p| p.to_array()));
    }
    object.list("edges", (0..s.edges.len()).map(|e| s.is_edge(EdgeId(e as u32)).then(|| s.edges[e])));
    let face = |f: usize| {
        let face = FaceId(f as u32);
        s.is_face(face).then(|| [0, 1, 2].map(|i| signed(s.face_side(face, i))))
    };
    object.list("faces", (0..s.faces.len()).map(face));
    if !s.chains.is_empty() {
        object.list("chains", s.chains.iter().map(ChainRecord::of));
    }
    if !s.loops.is_empty() {
        object.list("loops", s.loops.iter().map(|l| l.chains.iter().map(|c| c.0).collect::<Vec<_>>()));
    }
    if !s.attribute_nodes.is_empty() {
        object.list("attribute_nodes", s.attribute_nodes.iter().map(AttributeRecord::of));
    }
    if !s.attribute_edges.is_empty() {
        object.list("attribute_edges", s.attribute_edges.iter().map(LineRecord::of));
    }
    if !s.slots.is_compact() {
        object.member("free", &FreeRecord::of(&s.slots));
    }
    object.out.extend_from_slice(b"}");
}

/// A JSON object being written.
struct Object<'a> {
    out: &'a mut Vec<u8>,
    first: bool,
}

impl Object<'_> {
    fn key(&mut self, key: &str) {
        if !std::mem::replace(&mut self.first, false) {
            self.out.extend_from_slice(b",\n");
        }
        put(self.out, key);
        self.out.extend_from_slice(b":");
    }

    fn member(&mut self, key: &str, value: &(impl Serialize + ?Sized)) {
        self.key(key);
        put(self.out, value);
    }

    /// A line an entry.
    fn list(&mut self, key: &str, items: impl Iterator<Item = impl Serialize>) {
        self.key(key);
        self.out.extend_from_slice(b"[");
        for (i, item) in items.enumerate() {
            self.out.extend_from_slice(if i == 0 { b"\n" } else { b",\n" });
            put(self.out, &item);
        }
        self.out.extend_from_slice(b"]");
    }
}

fn put(out: &mut Vec<u8>, value: &(impl Serialize + ?Sized)) {
    // Memory takes every byte, and there are no maps with strange keys.
    let written = serde_json::to_writer(out, value);
    debug_assert!(written.is_ok());
}
