//! The letters of a format: how a value is stored, and what its scale is.

use std::ops::RangeInclusive;

/// How one field is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Letter {
    /// `b`
    I8,
    /// `B`, `M` (a mode)
    U8,
    /// `h`
    I16,
    /// `H`
    U16,
    /// `i`
    I32,
    /// `I`
    U32,
    /// `q`
    I64,
    /// `Q`
    U64,
    /// `g`
    F16,
    /// `f`
    F32,
    /// `d`
    F64,
    /// `c`: hundredths
    CentiI16,
    /// `C`: hundredths
    CentiU16,
    /// `e`: hundredths
    CentiI32,
    /// `E`: hundredths
    CentiU32,
    /// `L`: degrees of latitude or longitude, 1e-7
    Degrees,
    /// `a`: 32 values of 16 bits
    Array,
    /// `n`, `N`, `Z`: text of 4, 16 and 64 bytes
    Text(u8),
}

/// Values of a field of the letter `a`.
pub const ARRAY_VALUES: usize = 32;

/// Hundredths.
const CENTI: f64 = 0.01;
/// Of latitudes and longitudes.
const DEGREES: f64 = 1e-7;
/// Exponent bits that are all set in a number of 16 bits that is none.
const F16_SPECIAL: u16 = 31;

impl Letter {
    /// The field of a letter; `None` for one that no release of ArduPilot uses.
    #[must_use]
    pub fn of(letter: u8) -> Option<Self> {
        Some(match letter {
            b'b' => Self::I8,
            b'B' | b'M' => Self::U8,
            b'h' => Self::I16,
            b'H' => Self::U16,
            b'i' => Self::I32,
            b'I' => Self::U32,
            b'q' => Self::I64,
            b'Q' => Self::U64,
            b'g' => Self::F16,
            b'f' => Self::F32,
            b'd' => Self::F64,
            b'c' => Self::CentiI16,
            b'C' => Self::CentiU16,
            b'e' => Self::CentiI32,
            b'E' => Self::CentiU32,
            b'L' => Self::Degrees,
            b'a' => Self::Array,
            b'n' => Self::Text(4),
            b'N' => Self::Text(16),
            b'Z' => Self::Text(64),
            _ => return None,
        })
    }

    /// Bytes in a message.
    #[must_use]
    pub fn bytes(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 | Self::F16 | Self::CentiI16 | Self::CentiU16 => 2,
            Self::I32 | Self::U32 | Self::F32 | Self::CentiI32 | Self::CentiU32 | Self::Degrees => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
            Self::Array => 2 * ARRAY_VALUES,
            Self::Text(bytes) => bytes.into(),
        }
    }

    /// What the stored number is multiplied by.
    #[must_use]
    pub fn scale(self) -> f64 {
        match self {
            Self::CentiI16 | Self::CentiU16 | Self::CentiI32 | Self::CentiU32 => CENTI,
            Self::Degrees => DEGREES,
            _ => 1.0,
        }
    }

    /// A whole number without a scale.
    #[must_use]
    pub fn is_plain_integer(self) -> bool {
        matches!(self, Self::I8 | Self::U8 | Self::I16 | Self::U16 | Self::I32 | Self::U32)
    }

    /// The number that stands at the start of these bytes, scaled; NaN for texts and arrays, and where bytes are missing.
    #[must_use]
    pub fn number(self, bytes: &[u8]) -> f64 {
        self.scaled(bytes).unwrap_or(f64::NAN)
    }

    #[allow(clippy::cast_precision_loss)] // times in microseconds have less than 53 bits
    fn scaled(self, bytes: &[u8]) -> Option<f64> {
        Some(match self {
            Self::I8 => f64::from(i8::from_le_bytes(first(bytes)?)),
            Self::U8 => f64::from(u8::from_le_bytes(first(bytes)?)),
            Self::I16 => f64::from(i16::from_le_bytes(first(bytes)?)),
            Self::U16 => f64::from(u16::from_le_bytes(first(bytes)?)),
            Self::I32 => f64::from(i32::from_le_bytes(first(bytes)?)),
            Self::U32 => f64::from(u32::from_le_bytes(first(bytes)?)),
            Self::I64 => i64::from_le_bytes(first(bytes)?) as f64,
            Self::U64 => u64::from_le_bytes(first(bytes)?) as f64,
            Self::F16 => half(u16::from_le_bytes(first(bytes)?)),
            Self::F32 => f64::from(f32::from_le_bytes(first(bytes)?)),
            Self::F64 => f64::from_le_bytes(first(bytes)?),
            Self::CentiI16 => f64::from(i16::from_le_bytes(first(bytes)?)) * CENTI,
            Self::CentiU16 => f64::from(u16::from_le_bytes(first(bytes)?)) * CENTI,
            Self::CentiI32 => f64::from(i32::from_le_bytes(first(bytes)?)) * CENTI,
            Self::CentiU32 => f64::from(u32::from_le_bytes(first(bytes)?)) * CENTI,
            Self::Degrees => f64::from(i32::from_le_bytes(first(bytes)?)) * DEGREES,
            Self::Array | Self::Text(_) => return None,
        })
    }
}

fn first<const N: usize>(bytes: &[u8]) -> Option<[u8; N]> {
    bytes.first_chunk().copied()
}

/// A number of 16 bits (IEEE 754).
fn half(bits: u16) -> f64 {
    let sign = if bits >> 15 == 0 { 1.0 } else { -1.0 };
    let (exponent, fraction) = ((bits >> 10) & F16_SPECIAL, f64::from(bits & 0x3ff) / 1024.0);
    match exponent {
        0 => sign * fraction * 2.0_f64.powi(-14),
        F16_SPECIAL if fraction == 0.0 => sign * f64::INFINITY,
        F16_SPECIAL => f64::NAN,
        _ => sign * (1.0 + fraction) * 2.0_f64.powi(i32::from(exponent) - 15),
    }
}

/// Bytes of a message with its header: no definition can say more.
pub(super) const MESSAGE_BYTES: RangeInclusive<usize> = 3..=u8::MAX as usize;

#[cfg(test)]
mod tests {
    use super::{Letter, half};

    #[test]
    fn scaled_letters_are_scaled_and_missing_bytes_are_no_number() {
        let number = |letter: u8, bytes: &[u8]| Letter::of(letter).unwrap().number(bytes);
        assert_eq!(number(b'c', &(-123_i16).to_le_bytes()), -1.23);
        assert_eq!(number(b'E', &123_u32.to_le_bytes()), 1.23);
        assert!((number(b'L', &471_234_567_i32.to_le_bytes()) - 47.123_456_7).abs() < 1e-12);
        assert_eq!(number(b'f', &1.5_f32.to_le_bytes()), 1.5);
        assert!(number(b'f', &[0, 0, 0]).is_nan() && number(b'N', &[b'a'; 16]).is_nan());
        assert_eq!(Letter::of(b' '), None);
    }

    #[test]
    fn numbers_of_sixteen_bits_are_read() {
        assert_eq!([half(0x3c00), half(0xc000), half(0x3555)], [1.0, -2.0, 0.333_251_953_125]);
        assert_eq!(half(0x0001), 2.0_f64.powi(-24));
        assert!(half(0x7c00).is_infinite() && half(0x7e00).is_nan());
    }
}
