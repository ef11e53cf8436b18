//! The clock of signing.

use crate::link::clock::utc_us;

/// 2015-01-01 UTC in microseconds since 1970.
const EPOCH_US: u64 = 1_420_070_400_000_000;
/// Signing times of a second.
pub(super) const SECOND: u64 = 100_000;
/// A stream not heard before in this run may be this much behind: a minute.
pub(super) const STALE: u64 = 60 * SECOND;

/// The signing time of the wall clock.
pub(super) fn now() -> u64 {
    time_of(utc_us())
}

/// The signing time of microseconds since 1970 UTC.
pub(crate) fn time_of(utc_us: u64) -> u64 {
    utc_us.saturating_sub(EPOCH_US) / 10
}

/// What to say where signing times are ahead of this computer's clock by so much.
pub(super) fn clock_warning(ahead: u64) -> Option<String> {
    (ahead > STALE).then(|| {
        format!(
            "this computer's clock is {} s behind the last signing time: it was set back, or another's was ahead; \
             messages are signed from that time on; set the clock",
            ahead / SECOND
        )
    })
}
