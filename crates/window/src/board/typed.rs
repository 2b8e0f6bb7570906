//! Numbers typed while drawing.

use glam::DVec2;

use crate::units::LengthUnit;

/// What was typed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Typed {
    /// `12 in`: so far, toward the pointer; a radius.
    Length(f64),
    /// `40 @ 30`: so far, in this direction (degrees from x), whatever the pointer does.
    Polar { length: f64, degrees: f64 },
    /// `40; 20`: a step across and up from the place before, or the first place itself.
    Step(DVec2),
}

impl Typed {
    /// Reads it; `None` for what is none of these.
    pub(crate) fn parse(text: &str, unit: LengthUnit) -> Option<Self> {
        if let Some((length, degrees)) = text.split_once('@') {
            let degrees = degrees.trim().trim_end_matches('°').trim().replace(',', ".");
            let degrees = degrees.parse::<f64>().ok().filter(|d| d.is_finite())?;
            return Some(Self::Polar { length: unit.parse(length)?, degrees });
        }
        if let Some((across, up)) = text.split_once(';') {
            return Some(Self::Step(DVec2::new(unit.parse(across)?, unit.parse(up)?)));
        }
        unit.parse(text).map(Self::Length)
    }

    /// The place that it means: from the place before, with the pointer at `toward`. A length alone has no first place.
    pub(crate) fn place(self, from: Option<DVec2>, toward: Option<DVec2>) -> Option<DVec2> {
        match (self, from) {
            (Self::Step(step), from) => Some(from.unwrap_or_default() + step),
            (Self::Polar { length, degrees }, from) => {
                Some(from.unwrap_or_default() + DVec2::from_angle(degrees.to_radians()) * length)
            }
            (Self::Length(length), Some(from)) => {
                let along = toward.and_then(|to| (to - from).try_normalize()).unwrap_or(DVec2::X);
                Some(from + along * length)
            }
            (Self::Length(_), None) => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_directions_and_steps_are_read() {
        let read = |text| Typed::parse(text, LengthUnit::Centimetre);
        assert_eq!(read("10 in"), Some(Typed::Length(254.0)));
        assert_eq!(read("4"), Some(Typed::Length(40.0)));
        assert_eq!(read("4 @ 30°"), Some(Typed::Polar { length: 40.0, degrees: 30.0 }));
        assert_eq!(read("-1; 2,5 mm"), Some(Typed::Step(DVec2::new(-10.0, 2.5))));
        for text in ["", "@", "4 @", ";", "1;", "a", "4 @ nan"] {
            assert_eq!(read(text), None, "{text}");
        }
    }

    #[test]
    fn a_length_goes_toward_the_pointer() {
        let from = Some(DVec2::new(10.0, 0.0));
        let up = Some(DVec2::new(10.0, 3.0));
        assert_eq!(Typed::Length(5.0).place(from, up), Some(DVec2::new(10.0, 5.0)));
        assert_eq!(Typed::Length(5.0).place(from, None), Some(DVec2::new(15.0, 0.0)));
        assert_eq!(Typed::Length(5.0).place(None, up), None);
        assert_eq!(Typed::Step(DVec2::ONE).place(from, up), Some(DVec2::new(11.0, 1.0)));
    }
}
