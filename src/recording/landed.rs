//! Values of [`Quantity::LandedState`](super::Quantity::LandedState) (MAV_LANDED_STATE), and what no vehicle on the ground does.

/// MAV_LANDED_STATE_UNDEFINED.
pub const UNDEFINED: f64 = 0.0;
/// MAV_LANDED_STATE_ON_GROUND.
pub const ON_GROUND: f64 = 1.0;
/// MAV_LANDED_STATE_IN_AIR.
pub const IN_AIR: f64 = 2.0;
/// MAV_LANDED_STATE_TAKEOFF.
pub const TAKEOFF: f64 = 3.0;

/// A vehicle that turns or moves faster than this does not stand, rad/s and m/s. Estimators of vehicles that stand drift by less; a
/// smaller value takes drift for flight, a larger one a calm hover for ground.
pub const MOVES: f64 = 0.3;
