//! The fixed capacity for states.

/// Capacity of the state vector: rigid body and the effects' own states.
pub const PLANT_STATES: usize = 32;
