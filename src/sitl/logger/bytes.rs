//! Numbers as both formats store them: little-endian.

use crate::units::narrow;

/// How a number is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    U64,
    F32,
    F64,
}

/// The nearest whole number within bounds.
fn bounded(value: f64, (low, high): (f64, f64)) -> i64 {
    let held = value.round().clamp(low, high);
    // clamped to less than 2^53 either way; what is no number is nought
    #[expect(clippy::cast_possible_truncation, reason = "within the bounds of the field")]
    let number = held as i64;
    number
}

/// Largest whole number that a double holds exactly.
const MOST: f64 = 9_007_199_254_740_992.0;

impl Kind {
    /// Appends a value; whole numbers hold at their bounds.
    pub(super) fn put(self, into: &mut Vec<u8>, value: f64) {
        let whole = |low: f64, high: f64| bounded(value, (low, high)).to_le_bytes();
        match self {
            Self::I8 => into.extend(&whole(-128.0, 127.0)[..1]),
            Self::U8 => into.extend(&whole(0.0, 255.0)[..1]),
            Self::I16 => into.extend(&whole(-32_768.0, 32_767.0)[..2]),
            Self::U16 => into.extend(&whole(0.0, 65_535.0)[..2]),
            Self::I32 => into.extend(&whole(-2_147_483_648.0, 2_147_483_647.0)[..4]),
            Self::U32 => into.extend(&whole(0.0, 4_294_967_295.0)[..4]),
            Self::U64 => into.extend(&whole(0.0, MOST)),
            Self::F32 => into.extend(narrow(value).to_le_bytes()),
            Self::F64 => into.extend(value.to_le_bytes()),
        }
    }
}
