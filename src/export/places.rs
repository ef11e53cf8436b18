//! Which simulator has a place for which effect.

use super::format::Format;

use Format::{ArdupilotSitl, Mjcf, Px4Sih, Rotorpy, Sdf};

/// The effects for which a simulator has a place. What is not here has none in any of them, and is told as left out.
pub static PLACES: &[(&str, &[Format])] = &[
    ("linear_drag", &[Px4Sih, ArdupilotSitl, Sdf, Mjcf, Rotorpy]),
    ("quadratic_drag", &[ArdupilotSitl, Rotorpy]),
    ("motor_lag", &[Px4Sih, Sdf, Mjcf, Rotorpy]),
    ("com_offset", &[ArdupilotSitl, Sdf, Mjcf, Rotorpy]),
    ("angular_damping", &[Px4Sih, ArdupilotSitl, Mjcf]),
    ("blade_flapping", &[Rotorpy]),
    ("inflow", &[Px4Sih, ArdupilotSitl, Mjcf, Rotorpy]),
    ("translational_lift", &[Rotorpy]),
    ("steady_wind", &[Sdf, Rotorpy]),
    ("weak_rotor", &[Sdf, Mjcf]),
];

/// The simulators that have a place for an effect.
#[must_use]
pub fn places(id: &str) -> &'static [Format] {
    PLACES.iter().find(|(known, _)| *known == id).map_or(&[], |(_, formats)| *formats)
}
