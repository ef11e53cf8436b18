//! News in a frame that must be reported immediately.

use super::telemetry::FlightState;
use nalgebra::Vector3;

/// News in a frame that must be reported immediately.
#[derive(Debug, Clone, PartialEq)]
pub enum Novelty {
    /// mode, arming or system status changed
    State {
        /// before; `None` for the first
        from: Option<FlightState>,
        /// now
        to: FlightState,
    },
    /// a mode other than the known one, in a frame that was sent earlier: it is late, or the order is forged
    LateMode(u32),
    /// a text of the vehicle, with its MAV_SEVERITY
    Text(u8, String),
    /// its clock restarted
    Reboot,
    /// its estimate jumped
    EstimatorReset(String),
    /// its estimate was reset by a step that is small enough to continue
    EstimatorStep(String),
    /// it reports this target, m, world, or none (POSITION_TARGET_LOCAL_NED)
    Target(Option<Vector3<f64>>),
}
