//! Which simulator has a place for which effect.

use super::format::Format;

use Format::{ArdupilotSitl, Mjcf, Px4Sih, Rotorpy, Sdf};

/// Each effect with the simulators that have a place for it. What stands in none is told as left out.
pub static PLACES: &[(&str, &[Format])] = &[
    ("linear_drag", &[Px4Sih, ArdupilotSitl, Sdf, Mjcf, Rotorpy]),
    ("quadratic_drag", &[ArdupilotSitl, Rotorpy]),
    ("ground_effect", &[]),
    ("ceiling_effect", &[]),
    ("motor_lag", &[Px4Sih, Sdf, Mjcf, Rotorpy]),
    ("transport_delay", &[]),
    ("thrust_curve", &[]),
    ("battery_sag", &[]),
    ("weak_rotor", &[]),
    ("com_offset", &[ArdupilotSitl, Sdf, Mjcf, Rotorpy]),
    ("thrust_tilt", &[]),
    ("rotor_inertia", &[]),
    ("angular_damping", &[Px4Sih, ArdupilotSitl, Mjcf]),
    ("blade_flapping", &[Rotorpy]),
    ("inflow", &[Px4Sih, ArdupilotSitl, Mjcf, Rotorpy]),
    ("translational_lift", &[Rotorpy]),
    ("steady_wind", &[Sdf, Rotorpy]),
    ("gust", &[]),
    ("slung_load", &[]),
    ("mass_change", &[]),
    ("imu_misalignment", &[]),
    ("imu_offset", &[]),
    ("frame_misalignment", &[]),
    ("tether", &[]),
    ("vortex_ring", &[]),
];

/// The simulators that have a place for an effect; `None` where the table does not know it.
#[must_use]
pub fn places(id: &str) -> Option<&'static [Format]> {
    PLACES.iter().find(|(known, _)| *known == id).map(|(_, formats)| *formats)
}
