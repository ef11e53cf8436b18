//! What tells held-out flights of another vehicle.

use super::agreement::Agreement;

/// The reason why the held-out flights are not of the identified vehicle.
#[derive(Debug, Clone, PartialEq)]
pub struct OtherVehicle {
    /// the most significant difference
    pub by: Difference,
    /// in full
    pub reason: String,
}

/// A difference between flights of different vehicles.
#[derive(Debug, Clone, PartialEq)]
pub enum Difference {
    /// a parameter
    Parameter(Agreement),
    /// the residual of a channel after its own fit
    Residual {
        /// as in [`CHANNEL_NAMES`](crate::diagnose::channels::CHANNEL_NAMES)
        channel: &'static str,
        /// ratio to the residual of the identified flights
        ratio: f64,
    },
    /// a rotor that differs from the others in the flights explained alone
    Rotor {
        /// the effect, in brief, with its size
        name: String,
    },
}
