//! The rotors are flywheels.

use nalgebra::Vector3;

use crate::physics::equation::documented;
use crate::physics::{Airframe, Bounds, Condition, Effect, Hook, Own, Parameter, Rotors, Wrench};

documented! {
    /// `tau = -(H' + w x H)` with `H = -jr sum s_i Omega_i e_z`: gyroscopic and spin-up torque together. `s_i` is the
    /// sign of the reaction torque of the rotor about +z (a rotor that turns about -z pushes the body about +z).
    ///
    /// Bangura and Mahony 2012.
    #[derive(Debug, Clone, Copy)]
    pub struct RotorInertia;
}

const PARAMETERS: &[Parameter] =
    &[Parameter { name: "jr", unit: "kg m^2", bounds: Bounds::of(0.0, 0.01).by_mass().by_arm(2) }];

/// The torque for one kg m^2.
fn per_inertia(at: &Condition, rotors: &Rotors) -> Wrench {
    let hover_rad_s = at.airframe.hover_speed_rad_s.unwrap_or(0.0);
    let (mut speed_rad_s, mut spin_up_rad_s2) = (0.0, 0.0);
    for (rotor, sign) in at.airframe.yaw_signs().iter().enumerate() {
        speed_rad_s -= sign * rotors.speed[rotor] * hover_rad_s;
        spin_up_rad_s2 -= sign * rotors.acceleration_1_s[rotor] * hover_rad_s;
    }
    let gyroscopic = at.state.rates_rad_s.cross(&Vector3::z()) * speed_rad_s;
    Wrench { force_n: Vector3::zeros(), torque_nm: -gyroscopic - Vector3::z() * spin_up_rad_s2 }
}

impl Effect for RotorInertia {
    fn id(&self) -> &'static str {
        "rotor_inertia"
    }

    fn sentence(&self) -> &'static str {
        "The rotors have inertia: a change of their speed yaws the vehicle, and a rotation of the vehicle causes \
         gyroscopic torques."
    }

    fn equation(&self) -> &'static str {
        Self::EQUATION
    }

    fn parameters(&self) -> &'static [Parameter] {
        PARAMETERS
    }

    fn hooks(&self) -> &'static [Hook] {
        &[Hook::Wrench]
    }

    fn missing(&self, airframe: &Airframe) -> Option<&'static str> {
        airframe.hover_speed_rad_s.is_none().then_some("thrust_coefficient (rotor speeds in rad/s)")
    }

    fn wrench(&self, at: &Condition, rotors: &Rotors, own: &mut Own, sum: &mut Wrench) {
        *sum += per_inertia(at, rotors) * own.parameters[0];
    }

    fn is_linear(&self) -> bool {
        true
    }

    fn regressor(&self, at: &Condition, rotors: &Rotors, _parameters: &[f64], columns: &mut [Wrench]) {
        if let Some(column) = columns.first_mut() {
            *column = per_inertia(at, rotors);
        }
    }
}
