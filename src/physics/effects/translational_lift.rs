//! Flying sideways gives thrust.

use crate::physics::equation::documented;
use crate::physics::{Bounds, Condition, Effect, Hook, Own, Parameter, Rotors, Wrench};

documented! {
    /// `F_i = (kh / N) ((v_air + w x r_i)_x^2 + (..)_y^2) e_z` at each hub, where `kh` is the coefficient of the whole
    /// vehicle.
    ///
    /// Faessler et al. 2018 (arXiv 1712.02402); Svacha et al. 2017.
    #[derive(Debug, Clone, Copy)]
    pub struct TranslationalLift;
}

const PARAMETERS: &[Parameter] =
    &[Parameter { name: "kh", unit: "N/(m/s)^2", bounds: Bounds::of(0.0, 1.0).by_mass() }];

/// Force and torque for one N/(m/s)^2.
fn per_coefficient(at: &Condition) -> Wrench {
    let share = 1.0 / at.airframe.rotor_count() as f64;
    let mut sum = Wrench::zero();
    for (arm, air) in at.hubs() {
        sum.lift_at(arm, air.xy().norm_squared());
    }
    sum * share
}

impl Effect for TranslationalLift {
    fn id(&self) -> &'static str {
        "translational_lift"
    }

    fn sentence(&self) -> &'static str {
        "Sideways flight increases the thrust: it grows with the square of the airspeed across the rotor axis."
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

    fn wrench(&self, at: &Condition, _rotors: &Rotors, own: &mut Own, sum: &mut Wrench) {
        *sum += per_coefficient(at) * own.parameters[0];
    }

    fn is_linear(&self) -> bool {
        true
    }

    fn regressor(&self, at: &Condition, _rotors: &Rotors, _parameters: &[f64], columns: &mut [Wrench]) {
        if let Some(column) = columns.first_mut() {
            *column = per_coefficient(at);
        }
    }
}
