//! Numbers in text files: correctly rounded in, shortest exact text out.

/// Powers of ten that are exact in binary.
const EXACT_TENS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18,
    1e19, 1e20, 1e21, 1e22,
];

/// Whether `byte` ends a token on a line.
#[inline]
pub(super) fn ends_token(byte: u8) -> bool {
    byte <= b' '
}

/// Reads the decimal number that starts at `pos` and moves `pos` past it; `None` (and `pos` unmoved) when the token
/// is no number. "nan" and "inf" are numbers here; callers refuse them with a better message.
///
/// Up to 19 digits with a mantissa below 2⁵³ and a power of ten within ±22 take one exact multiplication or division
/// (Clinger 1990: both operands exact, so the one rounding is the correct one); all else goes to the standard library.
#[inline]
pub(super) fn float(bytes: &[u8], pos: &mut usize) -> Option<f64> {
    let start = *pos;
    let mut i = start;
    let negative = match bytes.get(i) {
        Some(b'-') => {
            i += 1;
            true
        }
        Some(b'+') => {
            i += 1;
            false
        }
        _ => false,
    };
    let mut mantissa = 0u64;
    let first = i;
    while let Some(digit) = bytes.get(i).map(|b| b.wrapping_sub(b'0')).filter(|d| *d < 10) {
        mantissa = mantissa.wrapping_mul(10).wrapping_add(u64::from(digit));
        i += 1;
    }
    let mut digits = i - first;
    let mut exponent = 0i32;
    if bytes.get(i) == Some(&b'.') {
        i += 1;
        let fraction = i;
        while let Some(digit) = bytes.get(i).map(|b| b.wrapping_sub(b'0')).filter(|d| *d < 10) {
            mantissa = mantissa.wrapping_mul(10).wrapping_add(u64::from(digit));
            i += 1;
        }
        digits += i - fraction;
        exponent = fraction.wrapping_sub(i) as i32;
    }
    if digits > 0 && matches!(bytes.get(i), Some(b'e' | b'E')) {
        let mut j = i + 1;
        let minus = bytes.get(j) == Some(&b'-');
        if matches!(bytes.get(j), Some(b'-' | b'+')) {
            j += 1;
        }
        let from = j;
        let mut power = 0i32;
        while let Some(digit) = bytes.get(j).map(|b| b.wrapping_sub(b'0')).filter(|d| *d < 10) {
            power = power.saturating_mul(10).saturating_add(i32::from(digit)).min(100_000);
            j += 1;
        }
        if j > from {
            exponent = exponent.saturating_add(if minus { -power } else { power });
            i = j;
        }
    }
    let at_end = bytes.get(i).is_none_or(|b| ends_token(*b));
    if at_end && digits > 0 && digits <= 19 && mantissa < (1 << 53) && exponent.unsigned_abs() <= 22 {
        let value = mantissa as f64;
        let ten = EXACT_TENS[exponent.unsigned_abs() as usize];
        let value = if exponent < 0 { value / ten } else { value * ten };
        *pos = i;
        return Some(if negative { -value } else { value });
    }
    let end = start + bytes[start..].iter().position(|b| ends_token(*b)).unwrap_or(bytes.len() - start);
    let value = std::str::from_utf8(&bytes[start..end]).ok()?.parse().ok()?;
    *pos = end;
    Some(value)
}

/// Reads a decimal integer at `pos` and moves past it; stops at the first byte that is no digit. `None` without digits
/// or beyond 18 digits.
#[inline]
pub(super) fn integer(bytes: &[u8], pos: &mut usize) -> Option<i64> {
    let mut i = *pos;
    let negative = bytes.get(i) == Some(&b'-');
    if negative || bytes.get(i) == Some(&b'+') {
        i += 1;
    }
    let first = i;
    let mut value = 0i64;
    while let Some(digit) = bytes.get(i).map(|b| b.wrapping_sub(b'0')).filter(|d| *d < 10) {
        value = value.wrapping_mul(10).wrapping_add(i64::from(digit));
        i += 1;
    }
    if i == first || i - first > 18 {
        return None;
    }
    *pos = i;
    Some(if negative { -value } else { value })
}

/// Appends the shortest text that reads back as exactly `value`; whole numbers without a fraction.
pub(super) fn push_float(out: &mut Vec<u8>, value: f64) {
    if value == value.trunc() && value.abs() < 1e15 {
        if value < 0.0 {
            out.push(b'-');
        }
        push_integer(out, value.abs() as u64);
    } else if serde_json::to_writer(&mut *out, &value).is_err() || !value.is_finite() {
        // serde_json writes the shortest digits; it has no word for NaN and writes `null`.
        debug_assert!(!value.is_finite());
    }
}

/// Appends `value` rounded to `decimals` places, without trailing zeros.
pub(super) fn push_rounded(out: &mut Vec<u8>, value: f64, decimals: u8) {
    let scale = EXACT_TENS[usize::from(decimals.min(12))];
    let scaled = (value * scale).round();
    if scaled.is_nan() || scaled.abs() >= 9e15 {
        return push_float(out, value);
    }
    let units = scaled.abs() as u64;
    if scaled < 0.0 {
        out.push(b'-');
    }
    let scale = scale as u64;
    push_integer(out, units / scale);
    let mut rest = units % scale;
    if rest > 0 {
        let mut places = usize::from(decimals.min(12));
        while rest.is_multiple_of(10) {
            rest /= 10;
            places -= 1;
        }
        let mut digits = [b'0'; 12];
        for digit in digits[..places].iter_mut().rev() {
            *digit = b'0' + (rest % 10) as u8;
            rest /= 10;
        }
        out.push(b'.');
        out.extend_from_slice(&digits[..places]);
    }
}

/// Appends a whole number.
#[inline]
pub(super) fn push_integer(out: &mut Vec<u8>, mut value: u64) {
    let mut digits = [0u8; 20];
    let mut at = digits.len();
    loop {
        at -= 1;
        digits[at] = b'0' + (value % 10) as u8;
        value /= 10;
        if value == 0 {
            break;
        }
    }
    out.extend_from_slice(&digits[at..]);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn floats_read_as_the_standard_library_reads_them() {
        let mut state = 7u64;
        let mut next = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            state >> 11
        };
        let mut texts: Vec<String> = [
            "0",
            "-0",
            "1.",
            ".5",
            "-.5e3",
            "1e400",
            "1e-400",
            "9007199254740993",
            "00000000000000000000001.5",
            "+7",
        ]
        .map(String::from)
        .to_vec();
        for _ in 0..20_000 {
            let digits = next() % 10u64.pow(1 + (next() % 17) as u32);
            let point = next() % 18;
            texts.push(format!("{}", digits as f64 / 10f64.powi(point as i32)));
            texts.push(format!("-{digits}.{}e{}", next() % 100_000, next() as i64 % 40 - 20));
        }
        for text in &texts {
            let mut pos = 0;
            let got = float(text.as_bytes(), &mut pos).unwrap();
            let want: f64 = text.parse().unwrap();
            assert_eq!(got.to_bits(), want.to_bits(), "{text}");
            assert_eq!(pos, text.len());
        }
        for text in ["", "-", ".", "x", "1.2.3", "1e", "1,5", "--1", "0x10"] {
            assert_eq!(float(text.as_bytes(), &mut 0), None, "{text}");
        }
    }

    #[test]
    fn floats_come_back_exactly() {
        for value in [0.0, 1.0, -1.5, 0.1, 1.0 / 3.0, 1e-300, 123456.789e200, -2e15, 5e-324, f64::MAX] {
            let mut out = Vec::new();
            push_float(&mut out, value);
            assert_eq!(float(&out, &mut 0), Some(value));
        }
        let rounded = |value, decimals| {
            let mut out = Vec::new();
            push_rounded(&mut out, value, decimals);
            String::from_utf8(out).unwrap()
        };
        assert_eq!(rounded(1.23456, 3), "1.235");
        assert_eq!(rounded(-0.5004, 3), "-0.5");
        assert_eq!(rounded(-0.0001, 3), "0");
        assert_eq!(rounded(7.0, 3), "7");
    }
}
