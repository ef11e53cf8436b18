//! What a reader gives out: a flight, one piece after the other.

use super::stream::StreamKey;
use crate::autopilot::Autopilot;

/// One piece of a flight, in the order of the log or link.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Event<'a> {
    /// which software flew, where a file says it; before the first sample
    Autopilot(Autopilot),
    /// one sample of a stream
    Sample {
        /// which stream
        stream: StreamKey,
        /// s of the vehicle's clock since the recording's start
        time_s: f64,
        /// SI, body FLU or world NWU; actuator channels at the end that are zero may be left out
        values: &'a [f64],
    },
    /// one of the vehicle's parameters
    Parameter {
        /// name
        name: &'a str,
        /// value in the autopilot's own unit
        value: f64,
    },
    /// what one of the vehicle's parameters is unless somebody sets it
    ParameterDefault {
        /// name
        name: &'a str,
        /// value in the autopilot's own unit
        value: f64,
    },
    /// what the vehicle said
    Text {
        /// s
        time_s: f64,
        /// MAV_SEVERITY: 0 emergency, 3 error, 4 warning, 6 information, 7 debugging
        severity: u8,
        /// whole text, put together from its chunks
        text: &'a str,
    },
    /// the vehicle's clock started anew
    ClockReset {
        /// s
        time_s: f64,
        /// s, the first stamp of the new clock: after a start anew the time since then
        stamp_s: f64,
    },
    /// the position estimate jumped (ODOMETRY.reset_counter)
    EstimatorReset {
        /// s
        time_s: f64,
    },
}
