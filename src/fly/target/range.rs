//! Values of message fields that cannot be out of range.
//!
//! An autopilot converts what it is sent without a look: one `MAV_CMD_DO_SET_MODE` with a number that its cast has
//! no room for stops ArduCopter's simulator (ArduPilot/ardupilot#33410).

use mavlink::MessageData;
use std::ops::RangeInclusive;

use crate::units::narrow;

/// A value that a message's field cannot carry.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{what}: expected {expected}, got {got}; nothing was sent")]
pub struct OutOfRange {
    /// of what
    pub what: &'static str,
    /// the range, with its unit
    pub expected: String,
    /// what came
    pub got: String,
}

/// A value to a message's precision, where it is within a range.
///
/// # Errors
/// It is not a number or out of the range; `unit` is for the message alone.
pub fn within(
    what: &'static str,
    unit: &str,
    value: f64,
    range: RangeInclusive<f32>,
) -> Result<f32, OutOfRange> {
    let single = narrow(value);
    if range.contains(&single) {
        return Ok(single);
    }
    let (least, greatest) = (range.start(), range.end());
    Err(OutOfRange { what, expected: format!("{least} to {greatest} {unit}"), got: value.to_string() })
}

/// The id of a MAVLink message: at most 24 bits, which a 32-bit float holds exactly.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MessageId(u32);

impl MessageId {
    const MAX: u32 = 0x00FF_FFFF;

    /// An id of MAVLink 2.
    ///
    /// # Errors
    /// It has more than 24 bits.
    pub fn new(id: u32) -> Result<Self, OutOfRange> {
        let error = || OutOfRange {
            what: "a message's id",
            expected: format!("0 to {}", Self::MAX),
            got: id.to_string(),
        };
        (id <= Self::MAX).then_some(Self(id)).ok_or_else(error)
    }

    /// Of a message of MAVLink's definitions.
    #[must_use]
    pub const fn of<M: MessageData>() -> Self {
        Self(M::ID)
    }

    /// As a command's parameter.
    pub(super) fn parameter(self) -> f32 {
        // exact: 24 bits
        self.0 as f32
    }
}

impl From<u16> for MessageId {
    fn from(id: u16) -> Self {
        Self(id.into())
    }
}

/// The time between two messages of a stream, whole microseconds: 1 ms, below which ArduPilot has no stream, to
/// 16.7 s, above which a 32-bit float skips numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Period(u32);

impl Period {
    const MIN_US: u32 = 1_000;
    const MAX_US: u32 = 0x00FF_FFFF;

    /// Of so many messages a second, Hz.
    ///
    /// # Errors
    /// The rate is below 0.06 Hz or above 1000 Hz, or no number.
    pub fn of_rate(rate_hz: f64) -> Result<Self, OutOfRange> {
        let (least, greatest) = (f64::from(Self::MIN_US), f64::from(Self::MAX_US));
        let us = (1e6 / rate_hz).round();
        if !(least..=greatest).contains(&us) {
            let expected = format!("{:.2} to 1000 Hz", 1e6 / greatest);
            return Err(OutOfRange { what: "a message's rate", expected, got: rate_hz.to_string() });
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "whole and in range")]
        Ok(Self(us as u32))
    }

    /// Of a whole number of messages a second, Hz, held within 1 and 1000.
    #[must_use]
    pub const fn of_whole_rate(rate_hz: u16) -> Self {
        let rate_hz = match rate_hz {
            0 => 1,
            1..=1000 => rate_hz as u32,
            _ => 1000,
        };
        // to the nearest
        Self((1_000_000 + rate_hz / 2) / rate_hz)
    }

    /// As a command's parameter.
    pub(super) fn parameter(self) -> f32 {
        // exact: 24 bits
        self.0 as f32
    }
}

/// The height of a takeoff above home, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TakeoffHeight(f32);

impl TakeoffHeight {
    /// Above home, m.
    ///
    /// # Errors
    /// It is not above the ground, above 1000 m or no number.
    pub fn new(height_m: f64) -> Result<Self, OutOfRange> {
        within("the height of a takeoff", "m", height_m, 0.01..=1000.0).map(Self)
    }

    /// As a command's parameter.
    pub(super) fn parameter(self) -> f32 {
        self.0
    }
}

/// The name of a parameter: 1 to 16 of the characters that autopilots use.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ParameterName(String);

impl ParameterName {
    const LENGTH_MAX: usize = 16;

    /// A name.
    ///
    /// # Errors
    /// It is empty, longer than `PARAM_REQUEST_READ` has room for, or has other characters than letters, digits and
    /// `_`.
    pub fn new(name: &str) -> Result<Self, OutOfRange> {
        let fits = (1..=Self::LENGTH_MAX).contains(&name.len());
        if fits && name.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_') {
            return Ok(Self(name.to_owned()));
        }
        let expected = format!("1 to {} letters, digits and `_`", Self::LENGTH_MAX);
        Err(OutOfRange { what: "a parameter's name", expected, got: format!("{name:?}") })
    }

    /// The name.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_out_of_range_says_so() {
        assert_eq!(
            TakeoffHeight::new(f64::NAN).unwrap_err().to_string(),
            "the height of a takeoff: expected 0.01 to 1000 m, got NaN; nothing was sent"
        );
        for height_m in [-1.0, 0.0, 1e4, f64::INFINITY] {
            assert!(TakeoffHeight::new(height_m).is_err(), "{height_m}");
        }
        for rate_hz in [0.0, -1.0, 0.05, 1001.0, f64::NAN, f64::INFINITY] {
            assert!(Period::of_rate(rate_hz).is_err(), "{rate_hz}");
        }
        assert!(MessageId::new(1 << 24).is_err());
        assert!(MessageId::new(u32::MAX).is_err());
        for name in ["", "SEVENTEEN_LETTERS", "a b", "x\n", "\u{e4}"] {
            assert!(ParameterName::new(name).is_err(), "{name:?}");
        }
        assert!(ParameterName::new("SIXTEEN_LETTERS_").is_ok());
    }

    #[test]
    fn a_rate_is_the_nearest_period() {
        assert_eq!(Period::of_rate(27.0).unwrap(), Period::of_whole_rate(27));
        assert_eq!(Period::of_whole_rate(27).parameter(), 37_037.0);
        assert_eq!(Period::of_whole_rate(0), Period::of_whole_rate(1));
        assert_eq!(Period::of_whole_rate(u16::MAX), Period::of_whole_rate(1000));
    }
}
