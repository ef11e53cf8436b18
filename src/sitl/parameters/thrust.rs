//! The vehicle's thrust as parameters say it.

use crate::vehicle::{ThrustLaw, Vehicle as Description};

/// THR_MDL_FAC or MOT_THST_EXPO that straightens the vehicle's thrust law.
pub(super) fn expo(vehicle: &Description) -> f64 {
    match vehicle.propulsion.law {
        ThrustLaw::Curve { expo, .. } => expo,
        ThrustLaw::Speed { .. } => 1.0,
    }
}

/// Thrust of hover over full thrust.
pub(in crate::sitl) fn hover_share(vehicle: &Description) -> f64 {
    let hover_n = vehicle.body.mass_kg * vehicle.gravity_m_s2 / vehicle.rotors.len() as f64;
    hover_n / vehicle.propulsion.thrust_from_command_n(1.0)
}
