//! Wavefront OBJ.
//!
//! Read: `v`, `vt`, `f` (all four corner forms, negative indices, polygons as fans), `g`, `o`, `usemtl`; everything else
//! is passed over. Groups are the runs of `g` and `o`; a file without either takes its `usemtl` runs.

use std::ops::Range;

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::error::{bad_coordinates, excerpt, shortened};
use super::number::{ends_token, float, integer, push_float, push_integer, push_rounded};
use super::weld::{Welder, key};
use super::{Format, Place, ReadError, WriteOptions, are_coordinates, check_room};
use crate::{Group, TriMesh};

/// No texture vertex at a corner.
const NONE: u32 = u32::MAX;

struct Reader<'a> {
    bytes: &'a [u8],
    pos: usize,
    line: usize,
    positions: Vec<DVec3>,
    uvs: Vec<DVec2>,
    faces: Vec<[u32; 3]>,
    /// Texture vertices of the corners; empty until the first one appears.
    face_uvs: Vec<[u32; 3]>,
    /// First face and name of every run.
    groups: Vec<(u32, String)>,
    materials: Vec<(u32, String)>,
    /// Largest vertex and texture index in use with their line: a face may come before its vertices.
    last_vertex: (u32, usize),
    last_uv: (u32, usize),
    polygon: Vec<(u32, u32)>,
}

pub(super) fn parse(bytes: &[u8]) -> Result<TriMesh, ReadError> {
    let mut reader = Reader {
        bytes,
        pos: 0,
        line: 1,
        positions: Vec::new(),
        uvs: Vec::new(),
        faces: Vec::new(),
        face_uvs: Vec::new(),
        groups: Vec::new(),
        materials: Vec::new(),
        last_vertex: (0, 0),
        last_uv: (0, 0),
        polygon: Vec::new(),
    };
    reader.lines()?;
    reader.finish()
}

impl Reader<'_> {
    fn lines(&mut self) -> Result<(), ReadError> {
        if self.bytes.starts_with(b"\xef\xbb\xbf") {
            self.pos = 3;
        }
        while self.pos < self.bytes.len() {
            self.skip_blanks();
            let rest = &self.bytes[self.pos..];
            let is = |word: &[u8]| {
                rest.starts_with(word) && rest.get(word.len()).is_none_or(|b| ends_token(*b) || *b == b'\\')
            };
            match rest.first() {
                Some(b'v') if is(b"v") => {
                    self.pos += 1;
                    let position = DVec3::new(self.coordinate()?, self.coordinate()?, self.coordinate()?);
                    self.positions.push(position);
                }
                Some(b'v') if is(b"vt") => {
                    self.pos += 2;
                    let u = self.coordinate()?;
                    // One-dimensional textures leave v out.
                    let v = if self.at_line_end() { 0.0 } else { self.coordinate()? };
                    self.uvs.push(DVec2::new(u, v));
                }
                Some(b'f') if is(b"f") => {
                    self.pos += 1;
                    self.face()?;
                }
                Some(b'g' | b'o') if is(b"g") || is(b"o") => {
                    self.pos += 1;
                    let name = self.name();
                    start_run(&mut self.groups, self.faces.len(), name);
                }
                Some(b'u') if is(b"usemtl") => {
                    self.pos += 6;
                    let name = self.name();
                    start_run(&mut self.materials, self.faces.len(), name);
                }
                _ => {}
            }
            self.skip_line();
        }
        check_room("vertices", self.positions.len())?;
        check_room("texture vertices", self.uvs.len())?;
        check_room("triangles", self.faces.len())
    }

    fn face(&mut self) -> Result<(), ReadError> {
        self.polygon.clear();
        loop {
            if self.at_line_end() {
                break;
            }
            let vertex = self.index(self.positions.len())?;
            self.last_vertex = self.last_vertex.max((vertex, self.line));
            let mut uv = NONE;
            if self.bytes.get(self.pos) == Some(&b'/') {
                self.pos += 1;
                if self.bytes.get(self.pos) != Some(&b'/')
                    && self.bytes.get(self.pos).is_some_and(|b| !ends_token(*b))
                {
                    uv = self.index(self.uvs.len())?;
                    self.last_uv = self.last_uv.max((uv, self.line));
                }
                // The normal's index is of no use here.
                while self.bytes.get(self.pos).is_some_and(|b| !ends_token(*b)) {
                    self.pos += 1;
                }
            } else if self.bytes.get(self.pos).is_some_and(|b| !ends_token(*b) && *b != b'\\') {
                return Err(self.bad_number());
            }
            self.polygon.push((vertex, uv));
        }
        if self.polygon.len() < 3 {
            return Err(ReadError::TooFewCorners {
                place: Place::Line(self.line),
                corners: self.polygon.len(),
            });
        }
        check_room("triangles", self.faces.len() + self.polygon.len())?;
        let has_uv = self.polygon.iter().any(|corner| corner.1 != NONE);
        if has_uv && self.face_uvs.is_empty() {
            self.face_uvs.resize(self.faces.len(), [NONE; 3]);
        }
        let keep_uvs = has_uv || !self.face_uvs.is_empty();
        let (apex, rest) = (self.polygon[0], &self.polygon[1..]);
        for side in rest.windows(2) {
            self.faces.push([apex.0, side[0].0, side[1].0]);
            if keep_uvs {
                self.face_uvs.push([apex.1, side[0].1, side[1].1]);
            }
        }
        Ok(())
    }

    /// A vertex reference at the cursor, as an index from 0 (not yet known to exist when it counts forward).
    #[inline]
    fn index(&mut self, count: usize) -> Result<u32, ReadError> {
        let Some(written) = integer(self.bytes, &mut self.pos) else { return Err(self.bad_number()) };
        let index = if written > 0 { written - 1 } else { written + count as i64 };
        if written == 0 || index < 0 || index >= i64::from(NONE) {
            let place = Place::Line(self.line);
            return Err(ReadError::IndexOutOfRange { place, index: written, count, first: 1 });
        }
        Ok(index as u32)
    }

    #[inline]
    fn coordinate(&mut self) -> Result<f64, ReadError> {
        self.skip_blanks();
        match float(self.bytes, &mut self.pos) {
            Some(value) if are_coordinates(&[value]) => Ok(value),
            Some(value) => Err(bad_coordinates(Place::Line(self.line), &[value])),
            None if self.pos >= self.bytes.len() => Err(ReadError::Truncated {
                place: Place::Line(self.line),
                expected: "a coordinate should follow".into(),
            }),
            None => Err(self.bad_number()),
        }
    }

    #[cold]
    fn bad_number(&self) -> ReadError {
        ReadError::BadNumber { place: Place::Line(self.line), text: excerpt(self.bytes, self.pos) }
    }

    /// Skips blanks and continued line ends, not the line's own end.
    #[inline]
    fn skip_blanks(&mut self) {
        loop {
            match self.bytes.get(self.pos) {
                Some(b' ' | b'\t' | b'\r') => self.pos += 1,
                Some(b'\\') if self.bytes[self.pos + 1..].starts_with(b"\n") => {
                    self.pos += 2;
                    self.line += 1;
                }
                Some(b'\\') if self.bytes[self.pos + 1..].starts_with(b"\r\n") => {
                    self.pos += 3;
                    self.line += 1;
                }
                _ => return,
            }
        }
    }

    #[inline]
    fn at_line_end(&mut self) -> bool {
        self.skip_blanks();
        self.bytes.get(self.pos).is_none_or(|b| matches!(b, b'\n' | b'#'))
    }

    #[inline]
    fn skip_line(&mut self) {
        while let Some(byte) = self.bytes.get(self.pos) {
            self.pos += 1;
            if *byte == b'\n' {
                self.line += 1;
                return;
            }
        }
    }

    /// The rest of the line without blanks around it.
    fn name(&mut self) -> String {
        let rest = &self.bytes[self.pos..];
        let end = rest.iter().position(|b| *b == b'\n').unwrap_or(rest.len());
        self.pos += end;
        String::from_utf8_lossy(&rest[..end]).trim().to_owned()
    }

    fn finish(self) -> Result<TriMesh, ReadError> {
        if self.positions.is_empty() && self.faces.is_empty() {
            return Err(no_obj(self.bytes));
        }
        let exists = |(index, line): (u32, usize), count: usize| {
            if (index as usize) < count || line == 0 {
                return Ok(());
            }
            let place = Place::Line(line);
            Err(ReadError::IndexOutOfRange { place, index: i64::from(index) + 1, count, first: 1 })
        };
        exists(self.last_vertex, self.positions.len())?;
        exists(self.last_uv, self.uvs.len())?;
        let complete = !self.face_uvs.is_empty() && self.face_uvs.as_flattened().iter().all(|uv| *uv != NONE);
        let corner_uvs =
            complete.then(|| self.face_uvs.iter().map(|face| face.map(|uv| self.uvs[uv as usize])).collect());
        let runs = if self.groups.is_empty() { self.materials } else { self.groups };
        let groups = groups_of_runs(runs, self.faces.len() as u32);
        Ok(TriMesh { positions: self.positions, faces: self.faces, groups, corner_uvs })
    }
}

/// What a file is that has neither vertices nor faces.
fn no_obj(bytes: &[u8]) -> ReadError {
    let wrong = |reason: String| ReadError::WrongMagic { format: Format::Obj, reason };
    if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") {
        return wrong("it is text in UTF-16; save it as UTF-8".to_owned());
    }
    if let Some(at) = bytes.iter().position(|b| *b == 0) {
        return wrong(format!("it is not text, by a zero at byte {at}"));
    }
    let mut lines = (1..).zip(bytes.split(|b| *b == b'\n')).map(|(k, line)| (k, line.trim_ascii()));
    match lines.find(|(_, line)| !line.is_empty() && !line.starts_with(b"#")) {
        Some((k, line)) => {
            let text = shortened(&String::from_utf8_lossy(&line[..line.len().min(400)]));
            wrong(format!(
                "it has neither nodes (lines v X Y Z) nor faces (lines f A B C); line {k} is '{text}'"
            ))
        }
        None if bytes.trim_ascii().is_empty() => wrong("it is empty".to_owned()),
        None => wrong("there are only comments in it".to_owned()),
    }
}

/// Notes that a run starts at `face`; a run that has no face yet is renamed (`o` followed by `g`).
fn start_run(runs: &mut Vec<(u32, String)>, face: usize, name: String) {
    let face = face as u32;
    match runs.last_mut() {
        Some(last) if last.0 == face => {
            // `o Shirt` and then a bare `g` or `g default`: the object's name says more.
            if !name.is_empty() && name != "default" || last.1.is_empty() {
                last.1 = name;
            }
        }
        Some(last) if last.1 == name => {}
        _ => runs.push((face, name)),
    }
}

fn groups_of_runs(runs: Vec<(u32, String)>, faces: u32) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::with_capacity(runs.len() + 1);
    if runs.first().is_some_and(|run| run.0 > 0) {
        groups.push(Group { name: String::new(), faces: 0..runs[0].0 });
    }
    let ends: Vec<u32> = runs.iter().skip(1).map(|run| run.0).chain([faces]).collect();
    for ((start, name), end) in runs.into_iter().zip(ends) {
        match groups.last_mut() {
            Some(last) if last.name == name => last.faces.end = end,
            _ if start < end => groups.push(Group { name, faces: start..end }),
            _ => {}
        }
    }
    groups
}

/// Elements that one thread writes at a time; fixed, so that the bytes do not depend on the number of threads.
const CHUNK: usize = 1 << 13;

pub(super) fn to_bytes(mesh: &TriMesh, options: &WriteOptions) -> Vec<u8> {
    let mut parts: Vec<Vec<u8>> = Vec::new();
    let mut head = Vec::new();
    for comment in options.comments.iter().flat_map(|c| c.lines()) {
        head.extend_from_slice(b"# ");
        head.extend_from_slice(comment.as_bytes());
        head.push(b'\n');
    }
    parts.push(head);
    parts.extend(vertices(b"v", &mesh.positions, options.decimals, |p| p.to_array()));

    let mut corner_numbers = None;
    if let Some(corner_uvs) = mesh.corner_uvs.as_ref().filter(|uvs| uvs.len() == mesh.faces.len()) {
        let mut welder = Welder::<2>::with_capacity(mesh.positions.len());
        let mut distinct = Vec::with_capacity(mesh.positions.len());
        let numbers: Vec<[u32; 3]> = corner_uvs
            .iter()
            .map(|corners| {
                corners.map(|uv| {
                    let (number, new) = welder.number([key(uv.x), key(uv.y)]);
                    if new {
                        distinct.push(uv);
                    }
                    number
                })
            })
            .collect();
        parts.extend(vertices(b"vt", &distinct, options.decimals, |uv| uv.to_array()));
        corner_numbers = Some(numbers);
    }

    let mut done = 0u32;
    let faces = mesh.faces.len() as u32;
    for group in &mesh.groups {
        let range = group.faces.start.clamp(done, faces)..group.faces.end.clamp(done, faces);
        parts.extend(face_lines(mesh, corner_numbers.as_deref(), done..range.start));
        parts.push([b"g ", one_line(&group.name).as_bytes(), b"\n"].concat());
        done = range.end.max(range.start);
        parts.extend(face_lines(mesh, corner_numbers.as_deref(), range));
    }
    parts.extend(face_lines(mesh, corner_numbers.as_deref(), done..faces));

    let mut first = mesh.positions.len() as u64 + 1;
    for line in &options.polylines {
        parts.push([b"g ", one_line(&line.name).as_bytes(), b"\n"].concat());
        parts.extend(vertices(b"v", &line.points, options.decimals, |p| p.to_array()));
        let mut text = b"l".to_vec();
        for _ in &line.points {
            text.push(b' ');
            push_integer(&mut text, first);
            first += 1;
        }
        text.push(b'\n');
        parts.push(text);
    }
    parts.concat()
}

/// A name that cannot break out of its line.
pub(super) fn one_line(name: &str) -> String {
    name.chars().map(|c| if c.is_control() { '_' } else { c }).collect()
}

fn vertices<P: Sync, const N: usize>(
    word: &[u8],
    points: &[P],
    decimals: Option<u8>,
    coordinates: impl Fn(&P) -> [f64; N] + Sync,
) -> Vec<Vec<u8>> {
    points
        .par_chunks(CHUNK)
        .map(|chunk| {
            let mut out = Vec::with_capacity(chunk.len() * (4 + N * 20));
            for point in chunk {
                out.extend_from_slice(word);
                for value in coordinates(point) {
                    out.push(b' ');
                    match decimals {
                        Some(places) => push_rounded(&mut out, value, places),
                        None => push_float(&mut out, value),
                    }
                }
                out.push(b'\n');
            }
            out
        })
        .collect()
}

fn face_lines(mesh: &TriMesh, uvs: Option<&[[u32; 3]]>, range: Range<u32>) -> Vec<Vec<u8>> {
    let starts: Vec<u32> = range.clone().step_by(CHUNK).collect();
    starts
        .into_par_iter()
        .map(|start| {
            let end = (start + CHUNK as u32).min(range.end);
            let mut out = Vec::with_capacity((end - start) as usize * if uvs.is_some() { 44 } else { 24 });
            for f in start as usize..end as usize {
                out.push(b'f');
                for (k, v) in mesh.faces[f].into_iter().enumerate() {
                    out.push(b' ');
                    push_integer(&mut out, u64::from(v) + 1);
                    if let Some(uvs) = uvs {
                        out.push(b'/');
                        push_integer(&mut out, u64::from(uvs[f][k]) + 1);
                    }
                }
                out.push(b'\n');
            }
            out
        })
        .collect()
}
