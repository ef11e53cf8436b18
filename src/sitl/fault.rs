//! What can be made to go wrong, for whoever tests a ground station.

use std::time::Duration;

use super::Mode;

/// A fault from now on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fault {
    /// the pilot switches the mode by his transmitter
    PilotTakesOver(Mode),
    /// the position estimate jumps by this much, m north, west, up
    EstimatorJump([f64; 3]),
    /// the estimator's position is good (again) or not
    EstimatorHealth(bool),
    /// the battery is this full, 0..1
    Battery(f64),
    /// a rotor gets no power any more, counted from zero
    RotorStops(usize),
    /// nothing comes out and nothing goes in on any link
    LinkSilence(Duration),
    /// the autopilot restarts: its clock is zero, it is disarmed
    Reboot,
    /// another ground station's heartbeat is forwarded to every link
    ForeignHeartbeat {
        /// its system id
        system: u8,
        /// its component id
        component: u8,
    },
    /// pushes for a while
    Push {
        /// N north, west, up
        force_n: [f64; 3],
        /// N m about body forward, left, up
        torque_nm: [f64; 3],
        /// how long
        duration: Duration,
    },
}
