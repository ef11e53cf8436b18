//! What the vehicle does at one instant, and what its sensors show of it.

use std::time::Duration;

use crate::physics::{MAX_ROTORS, State};
use crate::sitl::autopilot::Autopilot;
use crate::sitl::craft::IdealSensors;

/// What the vehicle does at one instant.
#[derive(Debug, Clone, Copy)]
pub(in crate::sitl) struct Snapshot {
    /// since boot
    pub(in crate::sitl) now: Duration,
    pub(in crate::sitl) shown: IdealSensors,
    /// pulses that are put out, microseconds
    pub(in crate::sitl) pulses_us: [u16; MAX_ROTORS],
}

/// One message in the making.
pub(super) struct Scene<'a> {
    pub(super) at: &'a Snapshot,
    pub(super) autopilot: &'a Autopilot,
    /// what sensors show of the motion, with noise
    pub(super) measured: State,
}

impl Scene<'_> {
    /// Milliseconds since boot of a sample that is stamped late by `skew_s` (s).
    pub(super) fn ms(&self, skew_s: f64) -> u32 {
        u32::try_from(self.stamp(skew_s).as_millis()).unwrap_or(u32::MAX)
    }

    /// The same in microseconds.
    pub(super) fn us(&self, skew_s: f64) -> u64 {
        u64::try_from(self.stamp(skew_s).as_micros()).unwrap_or(u64::MAX)
    }

    fn stamp(&self, skew_s: f64) -> Duration {
        self.at.now + Duration::try_from_secs_f64(skew_s).unwrap_or_default()
    }
}
