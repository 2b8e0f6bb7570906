//! Stereolithography files, text and binary. Corners at exactly the same place become one node.

use glam::DVec3;

use super::error::{bad_coordinates, excerpt};
use super::number::{ends_token, float, push_float, push_rounded};
use super::obj::one_line;
use super::weld::{Welder, key};
use super::{Encoding, Format, Place, ReadError, WriteOptions, are_coordinates, check_room};
use crate::{Group, TriMesh};

/// Bytes before the first facet of a binary file, and of a facet.
const HEAD: usize = 84;
const FACET: usize = 50;

struct Builder {
    welder: Welder<3>,
    mesh: TriMesh,
}

impl Builder {
    fn new(faces: usize) -> Self {
        Self { welder: Welder::with_capacity(faces / 2 + 8), mesh: TriMesh::default() }
    }

    fn node(&mut self, p: DVec3) -> u32 {
        let (number, new) = self.welder.number(p.to_array().map(key));
        if new {
            self.mesh.positions.push(p);
        }
        number
    }
}

pub(super) fn parse(bytes: &[u8]) -> Result<TriMesh, ReadError> {
    // Binary files may begin with "solid" too; their length gives them away.
    let announced = bytes.get(80..HEAD).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]) as usize);
    if announced.is_some_and(|count| count > 0 && bytes.len() == HEAD + FACET * count) {
        return binary(bytes);
    }
    let start = bytes.iter().position(|b| !ends_token(*b)).unwrap_or(bytes.len());
    let solid = bytes[start..].get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    // Text has no zero bytes; a cut-off binary file that begins with "solid" does.
    if solid && !bytes[start..].iter().take(512).any(|b| *b == 0) { text(bytes) } else { binary(bytes) }
}

fn binary(bytes: &[u8]) -> Result<TriMesh, ReadError> {
    let Some(count) = bytes.get(80..HEAD).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])) else {
        let reason = "it neither begins with 'solid' nor has the 84 bytes of a binary header".into();
        return Err(ReadError::WrongMagic { format: Format::Stl, reason });
    };
    let room = bytes.len() - HEAD;
    if count as usize > room / FACET {
        let place = Place::Byte(80);
        return Err(ReadError::CountTooLarge { place, what: "facets".into(), count: u64::from(count), room });
    }
    check_room("triangles", count as usize)?;
    let mut builder = Builder::new(count as usize);
    builder.mesh.faces.reserve(count as usize);
    for (f, facet) in bytes[HEAD..].chunks_exact(FACET).take(count as usize).enumerate() {
        let mut face = [0; 3];
        for (corner, node) in face.iter_mut().enumerate() {
            let at = 12 + 12 * corner;
            let number = |k: usize| {
                let b = &facet[at + 4 * k..];
                f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]]))
            };
            let p = DVec3::new(number(0), number(1), number(2));
            if !are_coordinates(&p.to_array()) {
                return Err(bad_coordinates(Place::Byte(HEAD + FACET * f + at), &p.to_array()));
            }
            *node = builder.node(p);
        }
        builder.mesh.faces.push(face);
    }
    Ok(builder.mesh)
}

fn text(bytes: &[u8]) -> Result<TriMesh, ReadError> {
    let mut builder = Builder::new(bytes.len() / 250);
    let (mut pos, mut line) = (0, 1);
    let mut corners: Vec<u32> = Vec::new();
    let (mut in_facet, mut in_solid) = (false, false);
    let mut groups: Vec<(u32, String)> = Vec::new();
    loop {
        while let Some(byte) = bytes.get(pos).filter(|b| ends_token(**b)) {
            line += usize::from(*byte == b'\n');
            pos += 1;
        }
        if pos >= bytes.len() {
            break;
        }
        let end = bytes[pos..].iter().position(|b| ends_token(*b)).map_or(bytes.len(), |len| pos + len);
        let word = &bytes[pos..end];
        let place = Place::Line(line);
        let is = |name: &str| word.eq_ignore_ascii_case(name.as_bytes());
        let line_end = bytes[pos..].iter().position(|b| *b == b'\n').map_or(bytes.len(), |len| pos + len);
        if is("vertex") {
            pos = end;
            let mut p = [0.0; 3];
            for value in &mut p {
                while bytes.get(pos).is_some_and(|b| *b == b' ' || *b == b'\t') {
                    pos += 1;
                }
                *value = match float(bytes, &mut pos) {
                    Some(value) if are_coordinates(&[value]) => value,
                    Some(value) => return Err(bad_coordinates(place, &[value])),
                    None if pos >= bytes.len() => {
                        return Err(ReadError::Truncated {
                            place,
                            expected: "a coordinate should follow".into(),
                        });
                    }
                    None => return Err(ReadError::BadNumber { place, text: excerpt(bytes, pos) }),
                };
            }
            corners.push(builder.node(DVec3::from_array(p)));
            continue;
        }
        if is("facet") {
            in_facet = true;
            corners.clear();
        } else if is("endfacet") {
            let [a, b, c] = corners[..] else {
                return Err(ReadError::TooFewCorners { place, corners: corners.len() });
            };
            builder.mesh.faces.push([a, b, c]);
            check_room("triangles", builder.mesh.faces.len())?;
            in_facet = false;
        } else if is("solid") {
            in_solid = true;
            let name = String::from_utf8_lossy(&bytes[end..line_end]).trim().to_owned();
            groups.push((builder.mesh.faces.len() as u32, name));
        } else if is("endsolid") {
            in_solid = false;
        } else if !is("outer") && !is("endloop") {
            let reason = format!("'{}' does not belong in an STL file", excerpt(word, 0));
            return Err(ReadError::Malformed { place, reason });
        }
        pos = line_end;
    }
    if in_facet || in_solid {
        let expected = if in_facet { "'endfacet' should follow" } else { "'endsolid' should follow" };
        return Err(ReadError::Truncated { place: Place::Line(line), expected: expected.into() });
    }
    // One solid is the mesh itself; several are its groups.
    let mut mesh = builder.mesh;
    if groups.len() > 1 {
        let ends: Vec<u32> = groups.iter().skip(1).map(|g| g.0).chain([mesh.faces.len() as u32]).collect();
        let runs = groups.into_iter().zip(ends).map(|((start, name), end)| Group { name, faces: start..end });
        mesh.groups = runs.filter(|group| !group.faces.is_empty()).collect();
    }
    Ok(mesh)
}

pub(super) fn to_bytes(mesh: &TriMesh, options: &WriteOptions) -> Vec<u8> {
    let normal = |f: u32| mesh.area_normal(f).normalize_or_zero();
    if options.encoding == Encoding::Binary {
        let mut out = Vec::with_capacity(HEAD + FACET * mesh.faces.len());
        // Not "solid": readers would take the file for text.
        out.extend_from_slice(b"binary STL");
        out.resize(80, b' ');
        out.extend_from_slice(&(mesh.faces.len() as u32).to_le_bytes());
        for f in 0..mesh.faces.len() as u32 {
            for p in [normal(f)].into_iter().chain(mesh.corners(f)) {
                for value in p.to_array() {
                    out.extend_from_slice(&(value as f32).to_le_bytes());
                }
            }
            out.extend_from_slice(&[0, 0]);
        }
        return out;
    }
    let mut out = Vec::with_capacity(260 * mesh.faces.len());
    let whole = [Group { name: "mesh".into(), faces: 0..mesh.faces.len() as u32 }];
    for group in if mesh.groups.is_empty() { &whole[..] } else { &mesh.groups } {
        let name = one_line(&group.name);
        out.extend_from_slice(format!("solid {name}\n").as_bytes());
        for f in group.faces.clone() {
            out.extend_from_slice(b"facet normal");
            numbers(&mut out, normal(f), options.decimals);
            out.extend_from_slice(b"outer loop\n");
            for p in mesh.corners(f) {
                out.extend_from_slice(b"vertex");
                numbers(&mut out, p, options.decimals);
            }
            out.extend_from_slice(b"endloop\nendfacet\n");
        }
        out.extend_from_slice(format!("endsolid {name}\n").as_bytes());
    }
    out
}

fn numbers(out: &mut Vec<u8>, p: DVec3, decimals: Option<u8>) {
    for value in p.to_array() {
        out.push(b' ');
        match decimals {
            Some(places) => push_rounded(out, value, places),
            None => push_float(out, value),
        }
    }
    out.push(b'\n');
}
