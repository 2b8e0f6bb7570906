//! Lengths as people read and type them.

use serde::{Deserialize, Serialize};

/// The unit in which lengths are shown and, where none is typed, read. Inside everything is millimetres.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum LengthUnit {
    #[default]
    Millimetre,
    Centimetre,
    Inch,
}

impl LengthUnit {
    pub(crate) const ALL: [Self; 3] = [Self::Millimetre, Self::Centimetre, Self::Inch];

    /// Millimetres a unit.
    pub(crate) fn millimetres(self) -> f64 {
        match self {
            Self::Millimetre => 1.0,
            Self::Centimetre => 10.0,
            Self::Inch => 25.4,
        }
    }

    pub(crate) fn symbol(self) -> &'static str {
        match self {
            Self::Millimetre => "mm",
            Self::Centimetre => "cm",
            Self::Inch => "in",
        }
    }

    /// A length in millimetres as text: a tenth of a millimetre or about so.
    pub(crate) fn text(self, mm: f64) -> String {
        let decimals = if self == Self::Millimetre { 1 } else { 2 };
        format!("{:.decimals$} {}", mm / self.millimetres(), self.symbol())
    }

    /// Millimetres of typed text: `12`, `1.5 cm`, `3/8 in`, `2 1/4"`, `-4,5 mm`.
    pub(crate) fn parse(self, text: &str) -> Option<f64> {
        let text = text.trim().to_lowercase().replace(',', ".").replace('−', "-");
        let units = [
            ("mm", 1.0),
            ("cm", 10.0),
            ("inches", 25.4),
            ("inch", 25.4),
            ("in", 25.4),
            ("\"", 25.4),
            ("″", 25.4),
            ("m", 1000.0),
        ];
        let (number, unit) = units
            .iter()
            .find_map(|(symbol, mm)| Some((text.strip_suffix(symbol)?, *mm)))
            .unwrap_or((&text, self.millimetres()));
        Some(number_of(number.trim())? * unit).filter(|v| v.is_finite())
    }
}

/// A number, a fraction, or a whole number with a fraction.
fn number_of(text: &str) -> Option<f64> {
    let (negative, text) = text.strip_prefix('-').map_or((false, text), |rest| (true, rest.trim_start()));
    let mut sum = 0.0;
    let mut parts = 0;
    for part in text.split_whitespace() {
        sum += match part.split_once('/') {
            Some((above, below)) => {
                above.parse::<f64>().ok()? / below.parse::<f64>().ok().filter(|b| *b != 0.0)?
            }
            None => part.parse::<f64>().ok()?,
        };
        parts += 1;
    }
    (1..=2).contains(&parts).then_some(if negative { -sum } else { sum })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn typed_lengths_are_read() {
        let cases = [
            ("12", 12.0),
            ("1.5 cm", 15.0),
            ("1,5cm", 15.0),
            ("12 in", 304.8),
            ("3/8 in", 9.525),
            ("2 1/4\"", 57.15),
            ("-4 mm", -4.0),
            ("−1/2 in", -12.7),
            ("0.1 m", 100.0),
        ];
        for (text, mm) in cases {
            let read = LengthUnit::Millimetre.parse(text).unwrap();
            assert!((read - mm).abs() < 1e-9, "{text}: {read}");
        }
        assert_eq!(LengthUnit::Inch.parse("2"), Some(50.8));
        for text in ["", "cm", "1/0", "a", "1 2 3", "nan"] {
            assert_eq!(LengthUnit::Centimetre.parse(text), None, "{text}");
        }
    }

    #[test]
    fn lengths_are_shown_in_the_unit() {
        assert_eq!(LengthUnit::Millimetre.text(12.34), "12.3 mm");
        assert_eq!(LengthUnit::Inch.text(25.4), "1.00 in");
    }
}
