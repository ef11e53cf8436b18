//! The fixed capacity for rotors.

/// Fixed capacity for rotors, so that no step of a simulation allocates.
pub const MAX_ROTORS: usize = 8;
