//! Mutations of bytes, words and lines: what goes wrong with files on the way, and what a hostile writer puts in.

use crate::Random;

/// Longest input that is made. Sizes beyond it only repeat what shorter ones show.
pub const LONGEST: usize = 1 << 16;

/// Put in place of numbers and words of text.
pub(crate) const WORDS: [&str; 40] = [
    "nan",
    "NaN",
    "inf",
    "-inf",
    "Infinity",
    "1e999",
    "-1e999",
    "1e308",
    "-1.7976931348623157e308",
    "1e-400",
    "5e-324",
    "1e",
    "-0",
    "0",
    "00",
    "-1",
    "+1",
    "1",
    "2",
    "3",
    "0.5",
    ".5",
    "5.",
    "127",
    "128",
    "255",
    "256",
    "65535",
    "65536",
    "2147483647",
    "2147483648",
    "-2147483648",
    "4294967294",
    "4294967295",
    "4294967296",
    "9007199254740993",
    "18446744073709551615",
    "99999999999999999999999999",
    "0x1",
    "",
];

const BINARY: [u32; 12] = [
    0,
    1,
    2,
    3,
    0xff,
    0x0100_0000,
    0x7f7f_ffff,
    0x7f80_0000,
    0x7fc0_0000,
    0x7fff_ffff,
    0x8000_0000,
    0xffff_ffff,
];

/// Changes `bytes` once or a few times; `other` is a second input to take pieces from, `words` are the format's own.
pub(crate) fn mutate(bytes: &mut Vec<u8>, other: &[u8], words: &[&str], random: &mut Random) {
    for _ in 0..random.length(6) {
        once(bytes, other, words, random);
        bytes.truncate(LONGEST);
    }
}

fn once(bytes: &mut Vec<u8>, other: &[u8], words: &[&str], random: &mut Random) {
    if bytes.is_empty() {
        bytes.extend_from_slice(other);
        return;
    }
    let at = random.below(bytes.len());
    match random.below(20) {
        0 | 1 => bytes[at] ^= 1 << random.below(8),
        2 => bytes[at] = random.bits() as u8,
        3 => bytes.truncate(at),
        4 => {
            let end = (at + random.length(4096)).min(bytes.len());
            bytes.drain(at..end);
        }
        5 => {
            let piece = slice(bytes, random).to_vec();
            bytes.splice(at..at, piece);
        }
        6 => {
            let piece = slice(other, random).to_vec();
            let end = if random.one_in(2) { at } else { (at + piece.len()).min(bytes.len()) };
            bytes.splice(at..end, piece);
        }
        7 => {
            // The head of one and the tail of the other.
            let from = random.below(other.len());
            bytes.truncate(at);
            bytes.extend_from_slice(&other[from..]);
        }
        8..=10 => replace_word(bytes, at, words, random),
        11 => {
            // A word of the file in another one's place.
            let Some(source) = word_at(bytes, random.below(bytes.len())) else { return };
            let word = bytes[source].to_vec();
            let Some(target) = word_at(bytes, at) else { return };
            bytes.splice(target, word);
        }
        12..=14 => {
            let word = random.pick(&BINARY);
            let raw = if random.one_in(2) { word.to_le_bytes() } else { word.to_be_bytes() };
            for (to, byte) in bytes[at..].iter_mut().zip(raw) {
                *to = byte;
            }
        }
        15 if !words.is_empty() => {
            let word = random.pick(words).bytes();
            bytes.splice(at..at, word);
        }
        16..=18 => lines(bytes, random),
        _ => {
            // Many times the same.
            let piece = slice(bytes, random);
            let piece = &piece[..piece.len().min(64)];
            let many = piece.repeat(random.length(LONGEST / 64));
            bytes.splice(at..at, many);
        }
    }
}

fn slice<'a>(bytes: &'a [u8], random: &mut Random) -> &'a [u8] {
    let start = random.below(bytes.len());
    let end = (start + random.length(2048)).min(bytes.len());
    &bytes[start..end]
}

fn replace_word(bytes: &mut Vec<u8>, at: usize, words: &[&str], random: &mut Random) {
    let Some(range) = word_at(bytes, at) else { return };
    let word = if random.one_in(3) && !words.is_empty() { random.pick(words) } else { random.pick(&WORDS) };
    bytes.splice(range, word.bytes());
}

/// The next word or number from `at` on, whole.
fn word_at(bytes: &[u8], at: usize) -> Option<std::ops::Range<usize>> {
    let of_word = |b: &u8| b.is_ascii_alphanumeric() || matches!(b, b'.' | b'-' | b'+' | b'_');
    let start = at + bytes[at..].iter().take(256).position(of_word)?;
    let before = bytes[..start].iter().rev().take(256).take_while(|b| of_word(b)).count();
    let after = bytes[start..].iter().take(256).take_while(|b| of_word(b)).count();
    Some(start - before..start + after)
}

/// Lines left out, doubled, swapped, moved.
fn lines(bytes: &mut Vec<u8>, random: &mut Random) {
    let mut all: Vec<&[u8]> = bytes.split_inclusive(|b| *b == b'\n').collect();
    let (a, b) = (random.below(all.len()), random.below(all.len()));
    let end = (a + random.length(8)).min(all.len());
    match random.below(4) {
        0 => {
            all.drain(a..end);
        }
        1 => {
            let piece = all[a..end].to_vec();
            all.splice(b..b, piece);
        }
        2 => all.swap(a, b),
        _ => {
            let piece = all[a..end].repeat(random.length(64));
            all.splice(a..end, piece);
        }
    }
    *bytes = all.concat();
}
