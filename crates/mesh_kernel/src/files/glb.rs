//! glTF 2.0: triangle meshes in, one mesh with a primitive a group out.

use std::borrow::Cow;

use glam::{DMat4, DQuat, DVec2, DVec3};
use serde_json::json;

use super::error::shortened;
use super::gltf::{Document, Node, Numbers, Primitive, chunks, data_uri, get, malformed};
use super::weld::{Welder, key};
use super::{MAX_ELEMENTS, Place, Polyline, ReadError, WriteOptions, are_coordinates};
use crate::{Group, MAX_COORDINATE, TriMesh};

pub(super) fn parse(bytes: &[u8]) -> Result<TriMesh, ReadError> {
    let (text, binary) = chunks(bytes)?;
    let document: Document = serde_json::from_slice(text).map_err(|error| ReadError::Malformed {
        place: Place::Line(error.line()),
        reason: format!("the glTF document cannot be understood: {}", shortened(&error.to_string())),
    })?;
    if !document.asset.version.starts_with("2.") {
        return Err(ReadError::Unsupported {
            what: format!("glTF version '{}'", shortened(&document.asset.version)),
        });
    }
    // Extensions that change how geometry is stored; materials, lights and the like do not matter here.
    let geometry = |name: &&String| name.contains("compression");
    if let Some(name) = document.extensions_required.iter().find(geometry) {
        return Err(ReadError::Unsupported { what: format!("the glTF extension '{}'", shortened(name)) });
    }
    let mut buffers: Vec<Cow<[u8]>> = Vec::new();
    for (k, buffer) in document.buffers.iter().enumerate() {
        let bytes = match (&buffer.uri, binary) {
            (Some(uri), _) => Cow::Owned(data_uri(uri)?),
            (None, Some(chunk)) if k == 0 => Cow::Borrowed(chunk),
            _ => return Err(malformed(format!("buffer {k} has no data"))),
        };
        if bytes.len() < buffer.length {
            let expected = format!("buffer {k} should have {} bytes", buffer.length);
            return Err(ReadError::Truncated { place: Place::Byte(text.len() + bytes.len()), expected });
        }
        buffers.push(bytes);
    }
    let mut reader = Reader {
        document: &document,
        buffers: &buffers,
        mesh: TriMesh::default(),
        flats: Some(Vec::new()),
        limit: unfolding_limit(bytes.len()),
    };
    reader.nodes()?;
    let Reader { mut mesh, flats, .. } = reader;
    mesh.corner_uvs = flats.filter(|flats| !flats.is_empty());
    Ok(mesh)
}

struct Reader<'a> {
    document: &'a Document,
    buffers: &'a [Cow<'a, [u8]>],
    mesh: TriMesh,
    /// Corner positions in the flat; `None` once a primitive has none.
    flats: Option<Vec<[DVec2; 3]>>,
    /// Most vertices, and most triangles.
    limit: usize,
}

/// Most vertices, and most triangles, that a glTF file of so many bytes may unfold to.
///
/// Nodes may share a mesh and primitives their accessors, so that a file can ask for the square of its size. Room for
/// a quarter of a million, and four a byte beyond, holds any model with parts that come again; without such parts, a
/// byte gives one triangle at most.
fn unfolding_limit(bytes: usize) -> usize {
    bytes.saturating_mul(4).saturating_add(1 << 18).min(MAX_ELEMENTS)
}

impl Reader<'_> {
    fn check_room(&self, what: &'static str, count: usize) -> Result<(), ReadError> {
        if count > self.limit { Err(ReadError::TooMany { what, limit: self.limit }) } else { Ok(()) }
    }

    /// Every node of the scene once, parents before children.
    fn nodes(&mut self) -> Result<(), ReadError> {
        let nodes = &self.document.nodes;
        let roots = match self.document.scene.or((!self.document.scenes.is_empty()).then_some(0)) {
            Some(scene) => get(&self.document.scenes, scene, "scene")?.nodes.clone(),
            // A document without scenes is a library of nodes: take all that are nobody's children.
            None => {
                let mut child = vec![false; nodes.len()];
                for index in nodes.iter().flat_map(|node| &node.children) {
                    if let Some(child) = child.get_mut(*index) {
                        *child = true;
                    }
                }
                (0..nodes.len()).filter(|k| !child[*k]).collect()
            }
        };
        let mut visited = vec![false; nodes.len()];
        let mut pending: Vec<(usize, DMat4)> =
            roots.into_iter().rev().map(|root| (root, DMat4::IDENTITY)).collect();
        while let Some((index, parent)) = pending.pop() {
            let node = get(nodes, index, "node")?;
            if std::mem::replace(&mut visited[index], true) {
                return Err(malformed(format!("node {index} has two parents or is its own ancestor")));
            }
            let place = parent * transform(node);
            if let Some(mesh) = node.mesh {
                self.mesh(mesh, node, place)?;
            }
            pending.extend(node.children.iter().rev().map(|child| (*child, place)));
        }
        Ok(())
    }

    fn mesh(&mut self, index: usize, node: &Node, place: DMat4) -> Result<(), ReadError> {
        let mesh = get(&self.document.meshes, index, "mesh")?;
        let start = self.mesh.faces.len() as u32;
        // Primitives often share their positions.
        let mut known = Vec::new();
        for primitive in &mesh.primitives {
            self.primitive(primitive, place, &mut known)?;
        }
        let faces = start..self.mesh.faces.len() as u32;
        if !faces.is_empty() {
            let name = node.name.clone().or_else(|| mesh.name.clone()).unwrap_or_default();
            self.mesh.groups.push(Group { name, faces });
        }
        Ok(())
    }

    /// Appends positions and returns the number of the first.
    fn positions(&mut self, positions: &Numbers, accessor: usize, place: DMat4) -> Result<usize, ReadError> {
        let first = self.mesh.positions.len();
        self.check_room("vertices", first + positions.count)?;
        self.mesh.positions.reserve(positions.count);
        for k in 0..positions.count {
            let p = DVec3::new(positions.float(k, 0), positions.float(k, 1), positions.float(k, 2));
            let p = if place == DMat4::IDENTITY { p } else { place.transform_point3(p) };
            if !are_coordinates(&p.to_array()) {
                let what = if p.is_finite() {
                    format!("beyond ±{MAX_COORDINATE:e}")
                } else {
                    "not finite (NaN or infinity)".to_owned()
                };
                return Err(malformed(format!("position {k} of accessor {accessor} is {what}")));
            }
            self.mesh.positions.push(p);
        }
        Ok(first)
    }

    /// `known`: accessors of positions that were read for this node, and the number of their first position.
    fn primitive(
        &mut self,
        primitive: &Primitive,
        place: DMat4,
        known: &mut Vec<(usize, usize)>,
    ) -> Result<(), ReadError> {
        let mode = primitive.mode.unwrap_or(4);
        if mode < 4 {
            return Ok(());
        }
        if mode > 6 {
            return Err(malformed(format!("a primitive has the unknown mode {mode}")));
        }
        let Some(position) = primitive.attributes.position else { return Ok(()) };
        let positions = self.document.numbers(self.buffers, position, "VEC3", 3)?;
        let first = match known.iter().find(|(accessor, _)| *accessor == position) {
            Some((_, first)) => *first,
            None => {
                let first = self.positions(&positions, position, place)?;
                known.push((position, first));
                first
            }
        };
        let indices =
            primitive.indices.map(|i| self.document.numbers(self.buffers, i, "SCALAR", 1)).transpose()?;
        if indices.as_ref().is_some_and(|indices| !indices.is_unsigned()) {
            return Err(malformed("indices must be unsigned whole numbers".into()));
        }
        let corners = indices.as_ref().map_or(positions.count, |indices| indices.count);
        let triangles = if mode == 4 { corners / 3 } else { corners.saturating_sub(2) };
        let face_start = self.mesh.faces.len();
        self.check_room("triangles", face_start + triangles)?;
        let corner = |k: usize| -> Result<u32, ReadError> {
            let index = indices.as_ref().map_or(k, |indices| indices.float(k, 0) as usize);
            if index >= positions.count {
                let place = Place::Byte(0);
                let index = index as i64;
                return Err(ReadError::IndexOutOfRange { place, index, count: positions.count, first: 0 });
            }
            Ok((first + index) as u32)
        };
        // A mirroring transform turns faces over.
        let mirrored = place.determinant() < 0.0;
        for t in 0..triangles {
            let [a, b, c] = match mode {
                4 => [3 * t, 3 * t + 1, 3 * t + 2],
                5 => [t, t + 1 + t % 2, t + 2 - t % 2],
                _ => [t + 1, t + 2, 0],
            };
            let [a, b, c] = [corner(a)?, corner(b)?, corner(c)?];
            self.mesh.faces.push(if mirrored { [a, c, b] } else { [a, b, c] });
        }
        if triangles == 0 {
            return Ok(());
        }
        let Some(accessor) = primitive.attributes.texcoord.filter(|_| self.flats.is_some()) else {
            self.flats = None;
            return Ok(());
        };
        let flat = self.document.numbers(self.buffers, accessor, "VEC2", 2)?;
        if flat.count < positions.count {
            return Err(malformed(format!(
                "accessor {accessor} has fewer elements than the positions beside it"
            )));
        }
        if let Some(flats) = &mut self.flats {
            for face in &self.mesh.faces[face_start..] {
                flats.push(face.map(|v| {
                    let k = v as usize - first;
                    DVec2::new(flat.float(k, 0), flat.float(k, 1))
                }));
            }
            if flats[face_start..].as_flattened().iter().any(|uv| !uv.is_finite()) {
                return Err(malformed(format!("accessor {accessor} holds a number that is not finite")));
            }
        }
        Ok(())
    }
}

fn transform(node: &Node) -> DMat4 {
    if let Some(columns) = node.matrix {
        return DMat4::from_cols_array(&columns);
    }
    DMat4::from_scale_rotation_translation(
        node.scale.map_or(DVec3::ONE, DVec3::from_array),
        node.rotation.map_or(DQuat::IDENTITY, |q| {
            let q = DQuat::from_array(q);
            if q.length_squared() > 0.0 { q.normalize() } else { DQuat::IDENTITY }
        }),
        node.translation.map_or(DVec3::ZERO, DVec3::from_array),
    )
}

/// Buffer, views and accessors as they grow.
#[derive(Default)]
struct Writer {
    binary: Vec<u8>,
    views: Vec<serde_json::Value>,
    accessors: Vec<serde_json::Value>,
    meshes: Vec<serde_json::Value>,
    nodes: Vec<serde_json::Value>,
}

impl Writer {
    /// A view over what was written since `start`, and an accessor on it.
    fn accessor(&mut self, start: usize, target: u32, component: u32, shape: &str, count: usize) -> usize {
        self.views.push(json!({
            "buffer": 0, "byteOffset": start, "byteLength": self.binary.len() - start, "target": target,
        }));
        self.accessors.push(json!({
            "bufferView": self.views.len() - 1, "componentType": component, "count": count, "type": shape,
        }));
        self.accessors.len() - 1
    }

    fn floats<const N: usize>(&mut self, values: &[[f64; N]]) -> usize {
        let start = self.binary.len();
        for value in values.as_flattened() {
            self.binary.extend_from_slice(&(*value as f32).to_le_bytes());
        }
        self.accessor(start, 34962, 5126, if N == 3 { "VEC3" } else { "VEC2" }, values.len())
    }

    /// Positions with the bounds that the standard demands, of the numbers as they are stored.
    fn positions(&mut self, points: &[[f64; 3]]) -> usize {
        let accessor = self.floats(points);
        let (mut min, mut max) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
        for (axis, value) in points.iter().flat_map(|p| p.iter().enumerate()) {
            min[axis] = min[axis].min(*value as f32);
            max[axis] = max[axis].max(*value as f32);
        }
        self.accessors[accessor]["min"] = json!(min);
        self.accessors[accessor]["max"] = json!(max);
        accessor
    }

    fn node(&mut self, name: &str, primitive: serde_json::Value) {
        self.meshes.push(json!({ "name": name, "primitives": [primitive] }));
        self.nodes.push(json!({ "name": name, "mesh": self.meshes.len() - 1 }));
    }

    fn group(&mut self, mesh: &TriMesh, group: &Group, normals: &[DVec3], scale: f64) {
        // A vertex for every node and place in the flat that the group uses.
        let flats = mesh.corner_uvs.as_ref().filter(|flats| flats.len() == mesh.faces.len());
        let mut welder = Welder::<3>::with_capacity(group.faces.len());
        let (mut points, mut directions, mut places) = (Vec::new(), Vec::new(), Vec::new());
        let mut indices = Vec::with_capacity(3 * group.faces.len());
        for f in group.faces.start as usize..group.faces.end as usize {
            for (k, v) in mesh.faces[f].into_iter().enumerate() {
                let flat = flats.map_or(DVec2::ZERO, |flats| flats[f][k]);
                let (number, new) = welder.number([u64::from(v), key(flat.x), key(flat.y)]);
                if new {
                    points.push((mesh.positions[v as usize] * scale).to_array());
                    // A zero vector is no normal to glTF.
                    directions.push(normals[v as usize].try_normalize().unwrap_or(DVec3::Y).to_array());
                    places.push(flat.to_array());
                }
                indices.push(number);
            }
        }
        if points.is_empty() {
            return;
        }
        let position = self.positions(&points);
        let normal = self.floats(&directions);
        let mut attributes = json!({ "POSITION": position, "NORMAL": normal });
        if flats.is_some() {
            attributes["TEXCOORD_0"] = json!(self.floats(&places));
        }
        let start = self.binary.len();
        self.binary.extend(indices.iter().flat_map(|index| index.to_le_bytes()));
        let indices = self.accessor(start, 34963, 5125, "SCALAR", indices.len());
        let primitive = json!({ "attributes": attributes, "indices": indices, "mode": 4, "material": 0 });
        self.node(&group.name, primitive);
    }

    fn polyline(&mut self, line: &Polyline, scale: f64) {
        if line.points.len() >= 2 {
            let points: Vec<[f64; 3]> = line.points.iter().map(|p| (*p * scale).to_array()).collect();
            let position = self.positions(&points);
            self.node(&line.name, json!({ "attributes": { "POSITION": position }, "mode": 3 }));
        }
    }
}

pub(super) fn to_bytes(mesh: &TriMesh, options: &WriteOptions) -> Vec<u8> {
    let mut writer = Writer::default();
    let normals = mesh.node_normals();
    let faces = mesh.faces.len() as u32;
    let mut done = 0;
    for group in &mesh.groups {
        let range = group.faces.start.clamp(done, faces)..group.faces.end.clamp(done, faces);
        if done < range.start {
            writer.group(
                mesh,
                &Group { name: String::new(), faces: done..range.start },
                &normals,
                options.glb_scale,
            );
        }
        done = range.end.max(range.start);
        writer.group(mesh, &Group { name: group.name.clone(), faces: range }, &normals, options.glb_scale);
    }
    if done < faces {
        writer.group(mesh, &Group { name: String::new(), faces: done..faces }, &normals, options.glb_scale);
    }
    for line in &options.polylines {
        writer.polyline(line, options.glb_scale);
    }
    let mut document = json!({
        "asset": { "version": "2.0", "generator": "toile" },
        "scene": 0,
        "scenes": [{ "nodes": (0..writer.nodes.len()).collect::<Vec<_>>() }],
    });
    if !writer.nodes.is_empty() {
        // Cloth and body are seen from both sides and do not shine.
        document["materials"] = json!([{
            "doubleSided": true,
            "pbrMetallicRoughness": { "baseColorFactor": [0.8, 0.78, 0.75, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.9 },
        }]);
        document["buffers"] = json!([{ "byteLength": writer.binary.len() }]);
        document["bufferViews"] = json!(writer.views);
        document["accessors"] = json!(writer.accessors);
        document["meshes"] = json!(writer.meshes);
        document["nodes"] = json!(writer.nodes);
    } else {
        document["scenes"] = json!([{}]);
    }
    let mut text = document.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let binary_chunk = if writer.binary.is_empty() { 0 } else { 8 + writer.binary.len() };
    let total = 12 + 8 + text.len() + binary_chunk;
    let mut out = Vec::with_capacity(total);
    out.extend_from_slice(b"glTF");
    for word in [2, total as u32, text.len() as u32, 0x4e4f_534a] {
        out.extend_from_slice(&word.to_le_bytes());
    }
    out.extend_from_slice(&text);
    if !writer.binary.is_empty() {
        // Floats and 32-bit indices alone: always a multiple of four.
        for word in [writer.binary.len() as u32, 0x004e_4942] {
            out.extend_from_slice(&word.to_le_bytes());
        }
        out.extend_from_slice(&writer.binary);
    }
    out
}
