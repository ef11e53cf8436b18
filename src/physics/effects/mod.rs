//! One file an effect; the identifiers are those of reports and files.

mod angular_damping;
mod linear_drag;
mod motor_lag;
mod steady_wind;

pub use angular_damping::AngularDamping;
pub use linear_drag::LinearDrag;
pub use motor_lag::MotorLag;
pub use steady_wind::SteadyWind;

use super::Effect;

/// All effects that the program knows.
pub static ALL: &[&dyn Effect] = &[&LinearDrag, &MotorLag, &AngularDamping, &SteadyWind];

/// The effect of this identifier.
#[must_use]
pub fn by_id(id: &str) -> Option<&'static dyn Effect> {
    ALL.iter().copied().find(|effect| effect.id() == id)
}

#[cfg(test)]
mod tests;
