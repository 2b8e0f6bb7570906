//! Geomview OFF, text; the variants with colours, normals and texture coordinates are read for their positions.

use glam::DVec3;

use super::error::{bad_coordinates, excerpt};
use super::number::{ends_token, float, integer, push_float, push_integer, push_rounded};
use super::obj::one_line;
use super::{Format, Place, ReadError, WriteOptions, are_coordinates, check_room};
use crate::TriMesh;

struct Reader<'a> {
    bytes: &'a [u8],
    pos: usize,
    line: usize,
}

pub(super) fn parse(bytes: &[u8]) -> Result<TriMesh, ReadError> {
    let mut reader = Reader { bytes, pos: 0, line: 1 };
    reader.skip_blank_lines();
    let magic = reader.word();
    let plain = magic.strip_suffix(b"OFF").ok_or_else(|| ReadError::WrongMagic {
        format: Format::Off,
        reason: "it does not begin with 'OFF'".into(),
    })?;
    let has_four = plain.contains(&b'4') || plain.contains(&b'n');
    if has_four || !plain.iter().all(|b| b"STCN".contains(b)) {
        return Err(ReadError::Unsupported { what: format!("the OFF variant '{}'", excerpt(magic, 0)) });
    }
    if reader.rest_of_line().starts_with(b"BINARY") {
        return Err(ReadError::Unsupported { what: "binary OFF".into() });
    }
    reader.skip_blank_lines();
    let head = reader.line;
    let (vertices, faces) = (reader.count("a number of vertices")?, reader.count("a number of faces")?);
    reader.next_line();
    for (what, count, least) in [("vertices", vertices, 6), ("faces", faces, 4)] {
        let room = bytes.len() - reader.pos;
        if count > room / least + 1 {
            let place = Place::Line(head);
            return Err(ReadError::CountTooLarge { place, what: what.into(), count: count as u64, room });
        }
        check_room(what, count)?;
    }
    let mut mesh = TriMesh::default();
    mesh.positions.reserve(vertices);
    for _ in 0..vertices {
        reader.skip_blank_lines();
        let p = [reader.coordinate()?, reader.coordinate()?, reader.coordinate()?];
        mesh.positions.push(DVec3::from_array(p));
        reader.next_line();
    }
    mesh.faces.reserve(faces);
    let mut polygon = Vec::new();
    for _ in 0..faces {
        reader.skip_blank_lines();
        let corners = reader.count("a number of corners")?;
        let place = Place::Line(reader.line);
        if corners < 3 {
            return Err(ReadError::TooFewCorners { place, corners });
        }
        let room = bytes.len() - reader.pos;
        if corners > room / 2 + 1 {
            return Err(ReadError::CountTooLarge {
                place,
                what: "corners".into(),
                count: corners as u64,
                room,
            });
        }
        polygon.clear();
        for _ in 0..corners {
            let index = reader.whole("an index")?;
            if index < 0 || index >= vertices as i64 {
                return Err(ReadError::IndexOutOfRange { place, index, count: vertices, first: 0 });
            }
            polygon.push(index as u32);
        }
        check_room("triangles", mesh.faces.len() + corners)?;
        mesh.faces.extend(polygon[1..].windows(2).map(|side| [polygon[0], side[0], side[1]]));
        reader.next_line();
    }
    Ok(mesh)
}

impl<'a> Reader<'a> {
    fn skip_blanks(&mut self) {
        while self.bytes.get(self.pos).is_some_and(|b| ends_token(*b) && *b != b'\n') {
            self.pos += 1;
        }
    }

    fn next_line(&mut self) {
        while let Some(byte) = self.bytes.get(self.pos) {
            self.pos += 1;
            if *byte == b'\n' {
                self.line += 1;
                return;
            }
        }
    }

    /// Skips blanks, empty lines and comments.
    fn skip_blank_lines(&mut self) {
        loop {
            self.skip_blanks();
            match self.bytes.get(self.pos) {
                Some(b'\n' | b'#') => self.next_line(),
                _ => return,
            }
        }
    }

    fn word(&mut self) -> &'a [u8] {
        let rest = &self.bytes[self.pos..];
        let end = rest.iter().position(|b| ends_token(*b)).unwrap_or(rest.len());
        self.pos += end;
        &rest[..end]
    }

    fn rest_of_line(&mut self) -> &'a [u8] {
        self.skip_blanks();
        let rest = &self.bytes[self.pos..];
        &rest[..rest.iter().position(|b| *b == b'\n').unwrap_or(rest.len())]
    }

    fn bad(&self, what: &str) -> ReadError {
        let place = Place::Line(self.line);
        match self.bytes.get(self.pos) {
            None => ReadError::Truncated { place, expected: format!("{what} should follow") },
            Some(b'\n') => {
                ReadError::Malformed { place, reason: format!("the line ends where {what} should be") }
            }
            Some(_) => ReadError::BadNumber { place, text: excerpt(self.bytes, self.pos) },
        }
    }

    fn coordinate(&mut self) -> Result<f64, ReadError> {
        self.skip_blanks();
        match float(self.bytes, &mut self.pos) {
            Some(value) if are_coordinates(&[value]) => Ok(value),
            Some(value) => Err(bad_coordinates(Place::Line(self.line), &[value])),
            None => Err(self.bad("a coordinate")),
        }
    }

    fn whole(&mut self, what: &str) -> Result<i64, ReadError> {
        self.skip_blanks();
        let start = self.pos;
        let value = integer(self.bytes, &mut self.pos);
        if self.bytes.get(self.pos).is_some_and(|b| !ends_token(*b)) {
            self.pos = start;
            return Err(self.bad(what));
        }
        value.ok_or_else(|| self.bad(what))
    }

    fn count(&mut self, what: &str) -> Result<usize, ReadError> {
        let place = Place::Line(self.line);
        let value = self.whole(what)?;
        usize::try_from(value)
            .map_err(|_| ReadError::Malformed { place, reason: format!("{value} is no count") })
    }
}

pub(super) fn to_bytes(mesh: &TriMesh, options: &WriteOptions) -> Vec<u8> {
    let mut out = Vec::with_capacity(50 * mesh.positions.len() + 24 * mesh.faces.len());
    out.extend_from_slice(b"OFF\n");
    for comment in options.comments.iter().flat_map(|c| c.lines()) {
        out.extend_from_slice(format!("# {}\n", one_line(comment)).as_bytes());
    }
    out.extend_from_slice(format!("{} {} 0\n", mesh.positions.len(), mesh.faces.len()).as_bytes());
    for p in &mesh.positions {
        for (k, value) in p.to_array().into_iter().enumerate() {
            match options.decimals {
                Some(places) => push_rounded(&mut out, value, places),
                None => push_float(&mut out, value),
            }
            out.push(if k == 2 { b'\n' } else { b' ' });
        }
    }
    for face in &mesh.faces {
        out.push(b'3');
        for v in face {
            out.push(b' ');
            push_integer(&mut out, u64::from(*v));
        }
        out.push(b'\n');
    }
    out
}
