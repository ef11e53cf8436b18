//! When a vehicle flew, and how much of that can be used.

use serde::Serialize;

use crate::signals::Usable;

/// When it flew and how much of that can be used.
#[derive(Debug, Clone, PartialEq, Serialize, Default)]
pub struct FlightSummary {
    /// from what the time in the air is known
    pub airborne_from: &'static str,
    /// s in the air
    pub airborne_s: f64,
    /// s left for identification: in the air, exciting, no actuator at its end stop, no gap, no output off the mixer
    pub usable_s: f64,
    /// s of flight left out as transient at the beginning
    pub transient_s: f64,
    /// s of flight without excitation
    pub idle_s: f64,
    /// s with an actuator at its end stop
    pub saturated_s: f64,
    /// s inside gaps of a stream
    pub gap_s: f64,
    /// s of flight from when on an output no longer followed the mixer
    pub off_mixer_s: f64,
    /// each flight
    pub segments: Vec<Segment>,
    /// segments beyond those kept
    pub segments_dropped: u64,
}

/// A time in the air.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Segment {
    /// s
    pub start_s: f64,
    /// s
    pub end_s: f64,
    /// s of it that can be used
    pub usable_s: f64,
}

impl FlightSummary {
    /// Adds what a window's mask left out; what is not flight counts for nothing here.
    pub(super) fn add(&mut self, used: &Usable) {
        self.transient_s += used.transient_s;
        self.idle_s += used.idle_s;
        self.saturated_s += used.saturated_s;
        self.gap_s += used.gap_s;
    }

    /// Adds what of these spans in the air (s) comes after an output left the mixer, at `left_s`.
    pub(super) fn add_off_mixer(&mut self, flown_s: &[(f64, f64)], left_s: f64) {
        let after = |(start_s, end_s): &(f64, f64)| (end_s - start_s.max(left_s)).max(0.0);
        self.off_mixer_s += flown_s.iter().map(after).sum::<f64>();
    }

    /// Of a log whose samples are out of order: no time is known.
    pub(super) fn out_of_order() -> Self {
        Self { airborne_from: "nothing: its samples are out of order", ..Self::default() }
    }

    /// Of a vehicle that does not fly, whatever its motors did.
    pub(super) fn on_the_ground() -> Self {
        Self { airborne_from: "the kind of vehicle", ..Self::default() }
    }
}
