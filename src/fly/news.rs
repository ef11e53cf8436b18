//! What a frame brings that somebody must hear of at once.

use super::telemetry::FlightState;
use nalgebra::Vector3;

/// What a frame brought that somebody must hear of at once.
#[derive(Debug, Clone, PartialEq)]
pub enum Novelty {
    /// mode, arming or system status changed
    State {
        /// before; `None` for the first
        from: Option<FlightState>,
        /// now
        to: FlightState,
    },
    /// this mode, another than the one that is known, in a frame that was sent before: late, or the order is forged
    LateMode(u32),
    /// the vehicle said something: MAV_SEVERITY and text
    Text(u8, String),
    /// its clock started anew
    Reboot,
    /// its estimate jumped
    EstimatorReset(String),
    /// its estimate was reset by so little that it can be flown through
    EstimatorStep(String),
    /// it says that it flies to this place, m, world, or to none (POSITION_TARGET_LOCAL_NED)
    Target(Option<Vector3<f64>>),
}
