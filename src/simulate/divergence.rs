//! Beyond which distance a flight has diverged.

/// Farther from the reference, or from the origin, the flight is lost: crashed, or an unstable loop.
pub(super) const LOST_M: f64 = 100.0;
