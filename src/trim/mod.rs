//! What flights show of the balance of a vehicle: where the thrust that it commands acts, and what turns it about the vertical.
//!
//! Means over seconds, in shares of thrust and arm: commands at 10 Hz are enough, and neither mass nor lengths are needed.

mod balance;
mod legs;
mod rotors;

pub use balance::{AIR_LEVER_SPREAD, Balance, FlightBalance, WANDER, balance};
pub use legs::{AXES, LEAST_LEGS, LEG_S, Leg, TrimError, legs, mean_arm_m};
pub use rotors::{RotorTrack, TORQUE_SPREAD, rotor_tracks};
