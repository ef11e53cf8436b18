//! Climbing costs thrust.

use crate::physics::equation::documented;
use crate::physics::{Bounds, Condition, Effect, Hook, Own, Parameter, Rotors, Wrench};

documented! {
    /// `F_i = -(kz / N) n_i (v_air + w x r_i)_z e_z` at each hub, where `kz` is the coefficient of the whole vehicle at
    /// hover: the airspeed along the axis reduces the angle of attack of the blades. This is the same term as `dz` of
    /// `linear_drag`. A report gives it here. In the finer form the torque is multiplied by `at_hubs`, which is 0 for the
    /// drag of a body at the centre of mass.
    ///
    /// Bangura and Mahony 2012; Svacha et al. 2017.
    #[derive(Debug, Clone, Copy)]
    pub struct Inflow;
}

const PARAMETERS: &[Parameter] =
    &[Parameter { name: "kz", unit: "N/(m/s)", bounds: Bounds::of(0.0, 5.0).by_mass() }];

const FINER: &[Parameter] = &[Parameter { name: "at_hubs", unit: "-", bounds: Bounds::of(0.0, 1.0) }];

/// Force and torque for one N/(m/s).
fn per_coefficient(at: &Condition, rotors: &Rotors, parameters: &[f64]) -> Wrench {
    let lever = parameters.get(PARAMETERS.len()).copied().unwrap_or(1.0);
    let share = -1.0 / at.airframe.rotor_count() as f64;
    let mut sum = Wrench::zero();
    for ((arm, air), speed) in at.hubs().zip(&rotors.speed) {
        sum.lift_at(arm, speed * air.z);
    }
    Wrench { force_n: sum.force_n * share, torque_nm: sum.torque_nm * (share * lever) }
}

impl Effect for Inflow {
    fn id(&self) -> &'static str {
        "inflow"
    }

    fn sentence(&self) -> &'static str {
        "Climbing costs thrust: it falls with the airspeed along the rotor axis."
    }

    fn equation(&self) -> &'static str {
        Self::EQUATION
    }

    fn parameters(&self) -> &'static [Parameter] {
        PARAMETERS
    }

    fn finer_parameters(&self) -> &'static [Parameter] {
        FINER
    }

    fn hooks(&self) -> &'static [Hook] {
        &[Hook::Wrench]
    }

    fn wrench(&self, at: &Condition, rotors: &Rotors, own: &mut Own, sum: &mut Wrench) {
        *sum += per_coefficient(at, rotors, own.parameters) * own.parameters[0];
    }

    fn is_linear(&self) -> bool {
        true
    }

    fn regressor(&self, at: &Condition, rotors: &Rotors, parameters: &[f64], columns: &mut [Wrench]) {
        if let Some(column) = columns.first_mut() {
            *column = per_coefficient(at, rotors, parameters);
        }
    }
}
