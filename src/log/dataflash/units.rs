//! From what a field's number is in to SI.

use super::letter::Letter;
use crate::units::{rad_from_deg, rad_s_from_rpm};

/// What a field's number is in where the log does not say: releases before 2018 do not, and never changed it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Unit {
    /// a number without one
    Plain,
    Degrees,
    DegreesPerSecond,
    RadiansPerSecond,
    Metres,
    MetresPerSecond,
    MetresPerSecondSquared,
    Microseconds,
    /// 1/min; thousands of them in a whole number of 16 bits with hundredths
    RevolutionsPerMinute,
    /// m, m/s or m/s^2 downwards; upwards where the log says hundredths of them, as Copter did before 4.7
    Downwards,
    /// V; hundredths in a plain whole number
    Volts,
    /// A; hundredths in a plain whole number
    Amperes,
}

/// Units as logs write them (UNIT), and what of them is one in SI.
const WRITTEN: &[(&str, Unit, f64)] = &[
    ("rad", Unit::Degrees, 1.0),
    ("rad/s", Unit::DegreesPerSecond, 1.0),
    ("rad/s", Unit::RadiansPerSecond, 1.0),
];

/// A multiplier may be in single precision.
fn is_hundredth(multiplier: f64) -> bool {
    (multiplier - 0.01).abs() < 1e-6
}

impl Unit {
    /// What turns a field's number into SI. `written` is its unit and multiplier as the log says them. A letter that has a
    /// scale of its own has used it already: the log's multiplier says the same once more.
    pub(super) fn factor(self, letter: Letter, written: (Option<&str>, Option<f64>)) -> f64 {
        let (unit, multiplier) = written;
        let said = unit.and_then(|unit| WRITTEN.iter().find(|(name, of, _)| *name == unit && *of == self));
        let own = said.map_or_else(|| self.si(letter), |(.., si)| *si);
        let own = if self == Self::Downwards && multiplier.is_some_and(is_hundredth) { -own } else { own };
        let is_scaled = letter.scale() != 1.0;
        match multiplier {
            Some(multiplier) if !is_scaled && unit.is_some() && multiplier > 0.0 => own * multiplier,
            _ => own,
        }
    }

    fn si(self, letter: Letter) -> f64 {
        match self {
            Self::Degrees | Self::DegreesPerSecond => rad_from_deg(1.0),
            // tenths of revolutions were too many for it
            Self::RevolutionsPerMinute if letter == Letter::CentiI16 => rad_s_from_rpm(1000.0),
            Self::RevolutionsPerMinute => rad_s_from_rpm(1.0),
            Self::Volts | Self::Amperes if letter.is_plain_integer() => 0.01,
            _ => 1.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Letter, Unit};

    #[test]
    fn the_logs_own_unit_comes_first_and_no_scale_is_used_twice() {
        let deg = Unit::Degrees.factor(Letter::F32, (Some("deg"), Some(1.0)));
        assert!((deg - 0.017_453_292_5).abs() < 1e-9);
        assert_eq!(Unit::Degrees.factor(Letter::F32, (Some("rad"), None)), 1.0);
        assert_eq!(Unit::Degrees.factor(Letter::CentiI16, (Some("deg"), Some(0.01))), deg);
        assert_eq!(Unit::Metres.factor(Letter::F32, (Some("m"), Some(0.01))), 0.01);
        assert_eq!(Unit::Metres.factor(Letter::F32, (None, Some(0.01))), 1.0);
        assert_eq!(Unit::Volts.factor(Letter::I16, (None, None)), 0.01);
        assert_eq!(Unit::Volts.factor(Letter::F32, (Some("V"), Some(0.0))), 1.0);
        assert_eq!(Unit::Downwards.factor(Letter::F32, (Some("m"), Some(0.01))), -0.01);
        assert_eq!(Unit::Downwards.factor(Letter::F32, (Some("m"), Some(1.0))), 1.0);
    }
}
