//! Stanford PLY, text and binary of both byte orders.
//!
//! Read: `x y z` of `vertex`, the index list of `face` (or `tristrips`), flat coordinates per vertex (`s t`, `u v`,
//! `texture_u texture_v`) or per corner (list `texcoord`). All other elements and properties are passed over.

use glam::{DVec2, DVec3};

use super::error::{bad_coordinates, excerpt};
use super::number::{ends_token, float, push_float, push_integer, push_rounded};
use super::obj::one_line;
use super::{Encoding, Format, Place, ReadError, WriteOptions, are_coordinates, check_room};
use crate::TriMesh;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Layout {
    Text,
    Little,
    Big,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn named(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

/// What a property is good for here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Role {
    Position(usize),
    Flat(usize),
    Indices,
    Strips,
    CornerFlats,
    None,
}

#[derive(Clone, Debug)]
struct Property {
    role: Role,
    /// Type of the length of a list.
    length: Option<Scalar>,
    scalar: Scalar,
}

#[derive(Clone, Debug)]
struct Element {
    name: String,
    count: u64,
    line: usize,
    properties: Vec<Property>,
}

struct Reader<'a> {
    bytes: &'a [u8],
    pos: usize,
    line: usize,
    layout: Layout,
}

pub(super) fn parse(bytes: &[u8]) -> Result<TriMesh, ReadError> {
    let mut reader = Reader { bytes, pos: 0, line: 1, layout: Layout::Text };
    let elements = reader.header()?;
    let mut mesh = Contents::default();
    for element in &elements {
        reader.element(element, &mut mesh)?;
    }
    mesh.finish()
}

#[derive(Default)]
struct Contents {
    positions: Vec<DVec3>,
    vertex_flats: Option<Vec<DVec2>>,
    faces: Vec<[u32; 3]>,
    corner_flats: Option<Vec<[DVec2; 3]>>,
    /// Largest index in use and where.
    last: Option<(u32, Place)>,
}

impl Contents {
    fn finish(self) -> Result<TriMesh, ReadError> {
        let count = self.positions.len();
        if let Some((index, place)) = self.last.filter(|(index, _)| *index as usize >= count) {
            return Err(ReadError::IndexOutOfRange { place, index: i64::from(index), count, first: 0 });
        }
        let corner_flats = self.corner_flats.filter(|flats| flats.len() == self.faces.len());
        let by_vertex = |flats: Vec<DVec2>| self.faces.iter().map(|f| f.map(|v| flats[v as usize])).collect();
        let corner_uvs = corner_flats.or_else(|| self.vertex_flats.map(by_vertex));
        Ok(TriMesh { positions: self.positions, faces: self.faces, groups: Vec::new(), corner_uvs })
    }

    fn polygon(&mut self, indices: &[f64], flats: &[f64], place: Place) -> Result<(), ReadError> {
        if indices.len() < 3 {
            return Err(ReadError::TooFewCorners { place, corners: indices.len() });
        }
        let mut corners = Vec::with_capacity(indices.len());
        for index in indices {
            corners.push(self.index(*index, place)?);
        }
        check_room("triangles", self.faces.len() + corners.len())?;
        let with_flats = flats.len() == 2 * corners.len();
        if with_flats && self.faces.is_empty() {
            self.corner_flats = Some(Vec::new());
        }
        let flat = |k: usize| DVec2::new(flats[2 * k], flats[2 * k + 1]);
        for k in 1..corners.len() - 1 {
            self.faces.push([corners[0], corners[k], corners[k + 1]]);
            if let Some(all) = self.corner_flats.as_mut().filter(|_| with_flats) {
                all.push([flat(0), flat(k), flat(k + 1)]);
            }
        }
        Ok(())
    }

    /// A triangle strip; −1 starts a new one, every other triangle is turned.
    fn strip(&mut self, indices: &[f64], place: Place) -> Result<(), ReadError> {
        for strip in indices.split(|index| *index == -1.0) {
            for (k, window) in strip.windows(3).enumerate() {
                let [a, b, c] = [
                    self.index(window[0], place)?,
                    self.index(window[1], place)?,
                    self.index(window[2], place)?,
                ];
                if a != b && b != c && c != a {
                    self.faces.push(if k % 2 == 0 { [a, b, c] } else { [b, a, c] });
                }
            }
            check_room("triangles", self.faces.len())?;
        }
        Ok(())
    }

    #[inline]
    fn index(&mut self, index: f64, place: Place) -> Result<u32, ReadError> {
        if !(0.0..f64::from(u32::MAX)).contains(&index) || index != index.trunc() {
            let count = self.positions.len();
            return Err(ReadError::IndexOutOfRange { place, index: index as i64, count, first: 0 });
        }
        let index = index as u32;
        if self.last.is_none_or(|last| index > last.0) {
            self.last = Some((index, place));
        }
        Ok(index)
    }
}

impl Reader<'_> {
    fn place(&self) -> Place {
        if self.layout == Layout::Text { Place::Line(self.line) } else { Place::Byte(self.pos) }
    }

    /// The next line of the header without blanks around it.
    fn header_line(&mut self) -> Result<String, ReadError> {
        let rest = &self.bytes[self.pos..];
        let Some(end) = rest.iter().position(|b| *b == b'\n') else {
            let expected = "the header should end with 'end_header'".into();
            return Err(ReadError::Truncated { place: Place::Line(self.line), expected });
        };
        self.pos += end + 1;
        self.line += 1;
        Ok(String::from_utf8_lossy(&rest[..end.min(4096)]).trim().to_owned())
    }

    fn header(&mut self) -> Result<Vec<Element>, ReadError> {
        let magic = |reason: &str| ReadError::WrongMagic { format: Format::Ply, reason: reason.into() };
        let starts = self.bytes.starts_with(b"ply") && self.bytes.get(3).is_none_or(|b| ends_token(*b));
        if !starts || self.header_line()? != "ply" {
            return Err(magic("it does not begin with the line 'ply'"));
        }
        let mut elements: Vec<Element> = Vec::new();
        let mut layout = None;
        loop {
            let line = self.line;
            let text = self.header_line()?;
            let words: Vec<&str> = text.split_ascii_whitespace().collect();
            let malformed = |reason: String| ReadError::Malformed { place: Place::Line(line), reason };
            let scalar = |name: &str| {
                Scalar::named(name)
                    .ok_or_else(|| malformed(format!("'{}' is no PLY type", excerpt(name.as_bytes(), 0))))
            };
            match words[..] {
                ["format", "ascii", _] => layout = Some(Layout::Text),
                ["format", "binary_little_endian", _] => layout = Some(Layout::Little),
                ["format", "binary_big_endian", _] => layout = Some(Layout::Big),
                ["element", name, count] => {
                    let count = count
                        .parse()
                        .map_err(|_| malformed(format!("'{}' is no count", excerpt(count.as_bytes(), 0))))?;
                    elements.push(Element { name: name.to_owned(), count, line, properties: Vec::new() });
                }
                ["property", "list", length, items, name] => {
                    let element =
                        elements.last_mut().ok_or_else(|| malformed("a property without element".into()))?;
                    let role = match (element.name.as_str(), name) {
                        ("face", "vertex_indices" | "vertex_index") => Role::Indices,
                        ("face", "texcoord") => Role::CornerFlats,
                        ("tristrips", "vertex_indices" | "vertex_index") => Role::Strips,
                        _ => Role::None,
                    };
                    element.properties.push(Property {
                        role,
                        length: Some(scalar(length)?),
                        scalar: scalar(items)?,
                    });
                }
                ["property", kind, name] => {
                    let element =
                        elements.last_mut().ok_or_else(|| malformed("a property without element".into()))?;
                    let role = match (element.name.as_str(), name) {
                        ("vertex", "x") => Role::Position(0),
                        ("vertex", "y") => Role::Position(1),
                        ("vertex", "z") => Role::Position(2),
                        ("vertex", "s" | "u" | "texture_u") => Role::Flat(0),
                        ("vertex", "t" | "v" | "texture_v") => Role::Flat(1),
                        _ => Role::None,
                    };
                    element.properties.push(Property { role, length: None, scalar: scalar(kind)? });
                }
                ["end_header"] => break,
                [] | ["comment" | "obj_info", ..] => {}
                _ => return Err(malformed(format!("'{}' is no header line", excerpt(text.as_bytes(), 0)))),
            }
        }
        self.layout = layout.ok_or_else(|| magic("it has no 'format' line"))?;
        let mut vertices = elements.iter().filter(|element| element.name == "vertex");
        let has = |e: &Element, axis| e.properties.iter().any(|p| p.role == Role::Position(axis));
        if !vertices.next().is_some_and(|element| (0..3).all(|axis| has(element, axis))) {
            return Err(magic("its vertices have no x, y and z"));
        }
        if let Some(again) = vertices.next() {
            let reason = "a second element 'vertex'; faces could mean either".to_owned();
            return Err(ReadError::Malformed { place: Place::Line(again.line), reason });
        }
        Ok(elements)
    }

    fn element(&mut self, element: &Element, mesh: &mut Contents) -> Result<(), ReadError> {
        // Every property takes at least a byte (or a digit and a blank): a count beyond that is a lie.
        let least: usize = match self.layout {
            Layout::Text => element.properties.len(),
            _ => element.properties.iter().map(|p| p.length.unwrap_or(p.scalar).size()).sum(),
        };
        let room = self.bytes.len() - self.pos;
        if least == 0 {
            return Ok(());
        }
        if element.count > (room / least) as u64 + 1 {
            let place = Place::Line(element.line);
            return Err(ReadError::CountTooLarge {
                place,
                what: element.name.clone(),
                count: element.count,
                room,
            });
        }
        let is_vertex = element.properties.iter().any(|p| matches!(p.role, Role::Position(_)));
        if is_vertex {
            check_room("vertices", mesh.positions.len() + element.count as usize)?;
            mesh.positions.reserve(element.count as usize);
        }
        let flats = (0..2).all(|axis| element.properties.iter().any(|p| p.role == Role::Flat(axis)));
        if is_vertex && flats {
            mesh.vertex_flats = Some(Vec::with_capacity(element.count as usize));
        }
        let (mut list, mut corner_flats) = (Vec::new(), Vec::new());
        for _ in 0..element.count {
            let place = self.place_of_next();
            let (mut position, mut flat) = ([0.0; 3], [0.0; 2]);
            let mut polygon = None;
            corner_flats.clear();
            for property in &element.properties {
                let Some(length) = property.length else {
                    let value = self.value(property.scalar)?;
                    match property.role {
                        Role::Position(axis) => position[axis] = value,
                        Role::Flat(axis) => flat[axis] = value,
                        _ => {}
                    }
                    continue;
                };
                let length = self.length(length, property.scalar)?;
                match property.role {
                    Role::None => self.skip(length, property.scalar)?,
                    Role::CornerFlats => self.list(length, property.scalar, &mut corner_flats)?,
                    role => {
                        self.list(length, property.scalar, &mut list)?;
                        polygon = Some(role);
                    }
                }
            }
            if is_vertex {
                if !are_coordinates(&position) {
                    return Err(bad_coordinates(place, &position));
                }
                if flats && !are_coordinates(&flat) {
                    return Err(bad_coordinates(place, &flat));
                }
                mesh.positions.push(DVec3::from_array(position));
                if let Some(all) = mesh.vertex_flats.as_mut() {
                    all.push(DVec2::from_array(flat));
                }
            }
            if !are_coordinates(&corner_flats) {
                return Err(bad_coordinates(place, &corner_flats));
            }
            match polygon {
                Some(Role::Indices) => mesh.polygon(&list, &corner_flats, place)?,
                Some(Role::Strips) => mesh.strip(&list, place)?,
                _ => {}
            }
        }
        Ok(())
    }

    fn place_of_next(&mut self) -> Place {
        if self.layout == Layout::Text {
            self.skip_blanks();
        }
        self.place()
    }

    fn skip_blanks(&mut self) {
        while let Some(byte) = self.bytes.get(self.pos).filter(|b| ends_token(**b)) {
            self.line += usize::from(*byte == b'\n');
            self.pos += 1;
        }
    }

    fn truncated(&self, what: &str) -> ReadError {
        ReadError::Truncated { place: self.place(), expected: format!("{what} should follow") }
    }

    #[inline]
    fn value(&mut self, scalar: Scalar) -> Result<f64, ReadError> {
        if self.layout == Layout::Text {
            self.skip_blanks();
            if self.pos >= self.bytes.len() {
                return Err(self.truncated("a number"));
            }
            return float(self.bytes, &mut self.pos).ok_or_else(|| ReadError::BadNumber {
                place: Place::Line(self.line),
                text: excerpt(self.bytes, self.pos),
            });
        }
        let size = scalar.size();
        let Some(raw) = self.bytes.get(self.pos..self.pos + size) else {
            return Err(self.truncated("a number"));
        };
        self.pos += size;
        let mut buffer = [0u8; 8];
        buffer[..size].copy_from_slice(raw);
        if self.layout == Layout::Big {
            buffer[..size].reverse();
        }
        let b = buffer;
        Ok(match scalar {
            Scalar::I8 => f64::from(b[0] as i8),
            Scalar::U8 => f64::from(b[0]),
            Scalar::I16 => f64::from(i16::from_le_bytes([b[0], b[1]])),
            Scalar::U16 => f64::from(u16::from_le_bytes([b[0], b[1]])),
            Scalar::I32 => f64::from(i32::from_le_bytes([b[0], b[1], b[2], b[3]])),
            Scalar::U32 => f64::from(u32::from_le_bytes([b[0], b[1], b[2], b[3]])),
            Scalar::F32 => f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]])),
            Scalar::F64 => f64::from_le_bytes(b),
        })
    }

    /// Length of a list, checked against what is left of the file.
    fn length(&mut self, kind: Scalar, items: Scalar) -> Result<usize, ReadError> {
        let place = self.place_of_next();
        let length = self.value(kind)?;
        if !(0.0..9e15).contains(&length) || length != length.trunc() {
            return Err(ReadError::Malformed { place, reason: format!("a list cannot have {length} items") });
        }
        let room = self.bytes.len() - self.pos;
        let size = if self.layout == Layout::Text { 2 } else { items.size() };
        if length > ((room + 1) / size) as f64 {
            let count = length as u64;
            return Err(ReadError::CountTooLarge { place, what: "list items".into(), count, room });
        }
        Ok(length as usize)
    }

    fn list(&mut self, length: usize, items: Scalar, list: &mut Vec<f64>) -> Result<(), ReadError> {
        list.clear();
        for _ in 0..length {
            list.push(self.value(items)?);
        }
        Ok(())
    }

    fn skip(&mut self, length: usize, items: Scalar) -> Result<(), ReadError> {
        for _ in 0..length {
            self.value(items)?;
        }
        Ok(())
    }
}

pub(super) fn to_bytes(mesh: &TriMesh, options: &WriteOptions) -> Vec<u8> {
    let text = options.encoding == Encoding::Ascii;
    let flats = mesh.corner_uvs.as_ref().filter(|flats| flats.len() == mesh.faces.len());
    let mut out = Vec::new();
    out.extend_from_slice(b"ply\nformat ");
    out.extend_from_slice(if text { b"ascii 1.0\n" as &[u8] } else { b"binary_little_endian 1.0\n" });
    for comment in options.comments.iter().flat_map(|c| c.lines()) {
        out.extend_from_slice(format!("comment {}\n", one_line(comment)).as_bytes());
    }
    out.extend_from_slice(
        format!(
            "element vertex {}\nproperty double x\nproperty double y\nproperty double z\nelement face {}\n\
             property list uchar uint vertex_indices\n{}end_header\n",
            mesh.positions.len(),
            mesh.faces.len(),
            if flats.is_some() { "property list uchar double texcoord\n" } else { "" },
        )
        .as_bytes(),
    );
    let number = |out: &mut Vec<u8>, value: f64| match (text, options.decimals) {
        (false, _) => out.extend_from_slice(&value.to_le_bytes()),
        (true, Some(places)) => push_rounded(out, value, places),
        (true, None) => push_float(out, value),
    };
    let end = |out: &mut Vec<u8>, byte: u8| {
        if text {
            out.push(byte);
        }
    };
    out.reserve(mesh.positions.len() * if text { 50 } else { 24 } + mesh.faces.len() * 24);
    for p in &mesh.positions {
        for (k, value) in p.to_array().into_iter().enumerate() {
            number(&mut out, value);
            end(&mut out, if k == 2 { b'\n' } else { b' ' });
        }
    }
    for (f, face) in mesh.faces.iter().enumerate() {
        out.push(if text { b'3' } else { 3 });
        for v in face {
            end(&mut out, b' ');
            if text {
                push_integer(&mut out, u64::from(*v));
            } else {
                out.extend_from_slice(&v.to_le_bytes());
            }
        }
        if let Some(flats) = flats {
            end(&mut out, b' ');
            out.push(if text { b'6' } else { 6 });
            for value in flats[f].iter().flat_map(|uv| uv.to_array()) {
                end(&mut out, b' ');
                number(&mut out, value);
            }
        }
        end(&mut out, b'\n');
    }
    out
}
