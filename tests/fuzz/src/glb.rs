//! Mutations inside a glTF container whose lengths stay right, so that they get past its head.

use crate::{Random, bytes, json};

const JSON: [u8; 4] = *b"JSON";

/// Changes the document or the binary chunk of a container and writes the container anew; `None` where it is none.
pub(crate) fn mutate(file: &[u8], other: &[u8], words: &[&str], random: &mut Random) -> Option<Vec<u8>> {
    let (text, mut binary) = split(file)?;
    let (other_text, other_binary) = split(other).unwrap_or((other.to_vec(), Vec::new()));
    let mut text = if random.one_in(4) { text } else { json::mutate(&text, &other_text, words, random)? };
    if random.one_in(3) {
        bytes::mutate(&mut binary, &other_binary, &[], random);
    }
    text.resize(text.len().next_multiple_of(4), b' ');
    binary.resize(binary.len().next_multiple_of(4), 0);
    let mut out = b"glTF\x02\0\0\0".to_vec();
    out.extend(((12 + 8 + text.len() + 8 + binary.len()) as u32).to_le_bytes());
    for (kind, chunk) in [(JSON, text), (*b"BIN\0", binary)] {
        out.extend((chunk.len() as u32).to_le_bytes());
        out.extend(kind);
        out.extend(chunk);
    }
    Some(out)
}

fn split(file: &[u8]) -> Option<(Vec<u8>, Vec<u8>)> {
    let word = |at: usize| Some(u32::from_le_bytes(file.get(at..at + 4)?.try_into().ok()?) as usize);
    let length = word(12)?;
    let text = file.get(20..20usize.checked_add(length)?).filter(|_| file[16..20] == JSON)?;
    let binary = file.get(20 + length + 8..).unwrap_or_default();
    Some((text.to_vec(), binary.to_vec()))
}
