//! What one of several flights of a vehicle has its own.

use std::sync::Arc;

/// What one of several flights of a vehicle has its own. A flight by itself has nothing.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct OwnOfFlight {
    /// kg beyond the mass of the vehicle in the other flights
    pub payload_kg: f64,
    /// what other flights have and this one has not
    pub lacks: Arc<[Lacking]>,
    /// what it has and the others have not: identifiers of effects with their values, SI
    pub has: Arc<[(&'static str, Vec<f64>)]>,
}

impl OwnOfFlight {
    /// Nothing is its own.
    #[must_use]
    pub fn is_none(&self) -> bool {
        self.payload_kg == 0.0 && self.lacks.is_empty() && self.has.is_empty()
    }
}

/// An effect that a flight has not.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lacking {
    /// its identifier
    pub effect: &'static str,
    /// of an effect that each rotor may have: which one
    pub which: Option<f64>,
}
