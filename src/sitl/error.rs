//! Why a vehicle cannot be simulated.

use crate::physics::PhysicsError;
use crate::simulate::SimulateError;

/// Why a vehicle cannot be simulated.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SitlError {
    /// the vehicle or an effect is not physical
    #[error(transparent)]
    Physics(#[from] PhysicsError),
    /// the simulation or its controller cannot be set up
    #[error(transparent)]
    Simulate(#[from] SimulateError),
    /// a setting out of range
    #[error("{name}: expected {expected}, got {got}")]
    Setting {
        /// which
        name: String,
        /// the range
        expected: &'static str,
        /// what came
        got: String,
    },
}
