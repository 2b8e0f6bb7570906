//! What this library reads of a glTF 2.0 document: its JSON as structs, and the bytes of its accessors.

use serde::Deserialize;

use super::error::shortened;
use super::{Format, Place, ReadError};

#[derive(Deserialize)]
pub(super) struct Document {
    pub(super) asset: Asset,
    #[serde(default, rename = "extensionsRequired")]
    pub(super) extensions_required: Vec<String>,
    pub(super) scene: Option<usize>,
    #[serde(default)]
    pub(super) scenes: Vec<Scene>,
    #[serde(default)]
    pub(super) nodes: Vec<Node>,
    #[serde(default)]
    pub(super) meshes: Vec<Mesh>,
    #[serde(default)]
    pub(super) accessors: Vec<Accessor>,
    #[serde(default, rename = "bufferViews")]
    pub(super) views: Vec<View>,
    #[serde(default)]
    pub(super) buffers: Vec<Buffer>,
}

#[derive(Deserialize)]
pub(super) struct Asset {
    pub(super) version: String,
}

#[derive(Deserialize)]
pub(super) struct Scene {
    #[serde(default)]
    pub(super) nodes: Vec<usize>,
}

#[derive(Deserialize)]
pub(super) struct Node {
    pub(super) name: Option<String>,
    pub(super) mesh: Option<usize>,
    #[serde(default)]
    pub(super) children: Vec<usize>,
    pub(super) matrix: Option<[f64; 16]>,
    pub(super) translation: Option<[f64; 3]>,
    pub(super) rotation: Option<[f64; 4]>,
    pub(super) scale: Option<[f64; 3]>,
}

#[derive(Deserialize)]
pub(super) struct Mesh {
    pub(super) name: Option<String>,
    #[serde(default)]
    pub(super) primitives: Vec<Primitive>,
}

#[derive(Deserialize)]
pub(super) struct Primitive {
    pub(super) attributes: Attributes,
    pub(super) indices: Option<usize>,
    pub(super) mode: Option<u32>,
}

#[derive(Deserialize)]
pub(super) struct Attributes {
    #[serde(rename = "POSITION")]
    pub(super) position: Option<usize>,
    #[serde(rename = "TEXCOORD_0")]
    pub(super) texcoord: Option<usize>,
}

#[derive(Deserialize)]
pub(super) struct Accessor {
    #[serde(rename = "bufferView")]
    pub(super) view: Option<usize>,
    #[serde(default, rename = "byteOffset")]
    pub(super) offset: usize,
    #[serde(rename = "componentType")]
    pub(super) component: u32,
    #[serde(rename = "type")]
    pub(super) shape: String,
    pub(super) count: usize,
    #[serde(default)]
    pub(super) normalized: bool,
    pub(super) sparse: Option<serde::de::IgnoredAny>,
}

#[derive(Deserialize)]
pub(super) struct View {
    pub(super) buffer: usize,
    #[serde(default, rename = "byteOffset")]
    pub(super) offset: usize,
    #[serde(rename = "byteLength")]
    pub(super) length: usize,
    #[serde(rename = "byteStride")]
    pub(super) stride: Option<usize>,
}

#[derive(Deserialize)]
pub(super) struct Buffer {
    pub(super) uri: Option<String>,
    #[serde(rename = "byteLength")]
    pub(super) length: usize,
}

/// Something in the document that does not fit; accessors have no place in the file that would help.
pub(super) fn malformed(reason: String) -> ReadError {
    ReadError::Malformed { place: Place::Byte(0), reason }
}

/// The document's element `index` of a kind.
pub(super) fn get<'a, T>(all: &'a [T], index: usize, what: &str) -> Result<&'a T, ReadError> {
    all.get(index).ok_or_else(|| malformed(format!("{what} {index} does not exist, there are {}", all.len())))
}

/// Numbers of an accessor in place.
pub(super) struct Numbers<'a> {
    bytes: &'a [u8],
    stride: usize,
    component: u32,
    normalized: bool,
    width: usize,
    pub(super) count: usize,
}

impl Document {
    /// The accessor's numbers, `width` an element, checked to lie in the file.
    pub(super) fn numbers<'a>(
        &self,
        buffers: &'a [std::borrow::Cow<'a, [u8]>],
        accessor: usize,
        shape: &str,
        width: usize,
    ) -> Result<Numbers<'a>, ReadError> {
        let index = accessor;
        let accessor = get(&self.accessors, accessor, "accessor")?;
        if accessor.sparse.is_some() {
            return Err(ReadError::Unsupported { what: "a sparse glTF accessor".into() });
        }
        if accessor.shape != shape {
            return Err(malformed(format!(
                "accessor {index} is a {}, it should be a {shape}",
                shortened(&accessor.shape)
            )));
        }
        let size = match accessor.component {
            5120 | 5121 => 1,
            5122 | 5123 => 2,
            5125 | 5126 => 4,
            other => {
                return Err(malformed(format!("accessor {index} has the unknown component type {other}")));
            }
        };
        let view = accessor.view.ok_or_else(|| malformed(format!("accessor {index} has no buffer view")))?;
        let view = get(&self.views, view, "buffer view")?;
        let buffer = get(buffers, view.buffer, "buffer")?;
        let end = view.offset.checked_add(view.length);
        let cut = |room: usize| ReadError::CountTooLarge {
            place: Place::Byte(0),
            what: format!("elements of glTF accessor {index}"),
            count: accessor.count as u64,
            room,
        };
        let bytes = end.and_then(|end| buffer.get(view.offset..end)).ok_or_else(|| cut(buffer.len()))?;
        let bytes = bytes.get(accessor.offset..).ok_or_else(|| cut(bytes.len()))?;
        let stride = view.stride.unwrap_or(width * size);
        if stride < width * size {
            return Err(malformed(format!(
                "the buffer view of accessor {index} has a stride of {stride} bytes"
            )));
        }
        let needed = match accessor.count.checked_sub(1) {
            Some(steps) => steps.checked_mul(stride).and_then(|b| b.checked_add(width * size)),
            None => Some(0),
        };
        if needed.is_none_or(|needed| needed > bytes.len()) {
            return Err(cut(bytes.len()));
        }
        let normalized = accessor.normalized && accessor.component != 5126;
        Ok(Numbers { bytes, stride, component: accessor.component, normalized, width, count: accessor.count })
    }
}

impl Numbers<'_> {
    /// Component `k` of element `element`.
    #[inline]
    pub(super) fn float(&self, element: usize, k: usize) -> f64 {
        debug_assert!(k < self.width);
        let b = &self.bytes[element * self.stride..];
        let scale = |value: f64, most: f64| if self.normalized { (value / most).max(-1.0) } else { value };
        match self.component {
            5120 => scale(f64::from(b[k] as i8), 127.0),
            5121 => scale(f64::from(b[k]), 255.0),
            5122 => scale(f64::from(i16::from_le_bytes([b[2 * k], b[2 * k + 1]])), 32767.0),
            5123 => scale(f64::from(u16::from_le_bytes([b[2 * k], b[2 * k + 1]])), 65535.0),
            5125 => f64::from(u32::from_le_bytes([b[4 * k], b[4 * k + 1], b[4 * k + 2], b[4 * k + 3]])),
            _ => f64::from(f32::from_le_bytes([b[4 * k], b[4 * k + 1], b[4 * k + 2], b[4 * k + 3]])),
        }
    }

    /// Whether the components may be indices.
    pub(super) fn is_unsigned(&self) -> bool {
        matches!(self.component, 5121 | 5123 | 5125) && !self.normalized
    }
}

/// The JSON and the binary chunk of a container; of plain JSON just the former.
pub(super) fn chunks(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), ReadError> {
    let start = bytes.iter().position(|b| !b.is_ascii_whitespace()).unwrap_or(bytes.len());
    if bytes.get(start) == Some(&b'{') {
        return Ok((&bytes[start..], None));
    }
    let magic = |reason: &str| ReadError::WrongMagic { format: Format::Glb, reason: reason.into() };
    let word = |at: usize| {
        bytes.get(at..at + 4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])).ok_or_else(|| {
            ReadError::Truncated { place: Place::Byte(bytes.len()), expected: "a chunk should follow".into() }
        })
    };
    if !bytes.starts_with(b"glTF") {
        return Err(magic("it begins neither with 'glTF' nor with '{'"));
    }
    let version = word(4)?;
    if version != 2 {
        return Err(ReadError::Unsupported { what: format!("glTF container version {version}") });
    }
    let length = word(8)? as usize;
    if length > bytes.len() {
        let expected = format!("its header announces {length} bytes");
        return Err(ReadError::Truncated { place: Place::Byte(bytes.len()), expected });
    }
    let mut at = 12;
    let (mut json, mut binary) = (None, None);
    while at + 8 <= length {
        let (size, kind) = (word(at)? as usize, word(at + 4)?);
        let chunk = at.checked_add(8 + size).and_then(|end| bytes.get(at + 8..end)).ok_or_else(|| {
            let expected = format!("a chunk of {size} bytes is announced");
            ReadError::Truncated { place: Place::Byte(bytes.len()), expected }
        })?;
        match kind {
            0x4e4f_534a if json.is_none() => json = Some(chunk),
            0x004e_4942 if binary.is_none() => binary = Some(chunk),
            _ => {}
        }
        at += 8 + size;
    }
    Ok((json.ok_or_else(|| magic("it has no JSON chunk"))?, binary))
}

/// The bytes behind a `data:` address.
pub(super) fn data_uri(uri: &str) -> Result<Vec<u8>, ReadError> {
    let Some((head, body)) = uri.strip_prefix("data:").and_then(|rest| rest.split_once(',')) else {
        let what = "a glTF buffer in a file of its own".to_owned();
        return Err(ReadError::Unsupported { what });
    };
    if !head.ends_with(";base64") {
        return Err(ReadError::Unsupported { what: "a data address that is not base64".into() });
    }
    let mut out = Vec::with_capacity(body.len() / 4 * 3);
    let (mut bits, mut held) = (0u32, 0);
    for byte in body.bytes().filter(|b| *b != b'=') {
        let six = match byte {
            b'A'..=b'Z' => byte - b'A',
            b'a'..=b'z' => byte - b'a' + 26,
            b'0'..=b'9' => byte - b'0' + 52,
            b'+' | b'-' => 62,
            b'/' | b'_' => 63,
            _ => return Err(malformed("a data address holds something that is not base64".into())),
        };
        bits = (bits << 6 | u32::from(six)) & 0x00ff_ffff;
        held += 6;
        if held >= 8 {
            held -= 8;
            out.push((bits >> held) as u8);
        }
    }
    Ok(out)
}
