//! Values as the fields of messages hold them.

use std::time::Duration;

/// A value in a field of sixteen bits with sign; holds at its bounds.
pub(super) fn short(value: f64) -> i16 {
    let whole = crate::units::whole(value).clamp(i16::MIN.into(), i16::MAX.into());
    i16::try_from(whole).unwrap_or_default()
}

/// The same without sign.
pub(super) fn ushort(value: f64) -> u16 {
    u16::try_from(crate::units::whole(value).clamp(0, u16::MAX.into())).unwrap_or_default()
}

/// Nanoseconds since boot.
pub(super) fn nanoseconds(now: Duration) -> i64 {
    i64::try_from(now.as_nanos()).unwrap_or(i64::MAX)
}
