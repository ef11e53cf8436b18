//! Drag in proportion to the airspeed: of the rotors, each held back at its hub by its own speed, or of the body.

use nalgebra::Vector3;

use crate::physics::equation::documented;
use crate::physics::{Bounds, Condition, Effect, Hook, Own, Parameter, Rotors, Wrench};

documented! {
    /// `F_i = -(D / N) n_i (v_air + w x r_i)` at each hub `r_i`, where `D = diag(dx, dy, dz)` is the drag of the whole
    /// vehicle at hover and `n_i` is the rotor speed over its hover speed. The torque is `r_i x F_i`. In the finer form
    /// the torque is multiplied by `at_hubs`, which is 0 for a drag at the centre of mass, and `n_i` becomes
    /// `1 + with_speed (n_i - 1)`: the drag of a body does not grow with the rotors' speed.
    ///
    /// Martin and Salaun 2010; Faessler et al. 2018 (arXiv 1712.02402).
    #[derive(Debug, Clone, Copy)]
    pub struct LinearDrag;
}

const PARAMETERS: &[Parameter] = &[
    Parameter { name: "dx", unit: "N/(m/s)", bounds: Bounds::of(0.0, 5.0).by_mass() },
    Parameter { name: "dy", unit: "N/(m/s)", bounds: Bounds::of(0.0, 5.0).by_mass() },
    Parameter { name: "dz", unit: "N/(m/s)", bounds: Bounds::of(0.0, 5.0).by_mass() },
];

const FINER: &[Parameter] = &[
    Parameter { name: "at_hubs", unit: "-", bounds: Bounds::of(0.0, 1.0) },
    Parameter { name: "with_speed", unit: "-", bounds: Bounds::of(0.0, 1.0) },
];

/// Share of the arm at which the drag acts.
fn at_hubs(parameters: &[f64]) -> f64 {
    parameters.get(PARAMETERS.len()).copied().unwrap_or(1.0)
}

/// By how much the drag at a hub grows at the relative speed of its rotor.
fn growth(parameters: &[f64], speed: f64) -> f64 {
    parameters.get(PARAMETERS.len() + 1).map_or(speed, |with_speed| 1.0 + with_speed * (speed - 1.0))
}

impl Effect for LinearDrag {
    fn id(&self) -> &'static str {
        "linear_drag"
    }

    fn sentence(&self) -> &'static str {
        "The rotors have drag: a force against the airspeed, in proportion to it and to the rotor speed."
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
        let drag = own.axes() * (-1.0 / at.airframe.rotor_count() as f64);
        let mut at_hub = Wrench::zero();
        for ((arm, air), speed) in at.hubs().zip(&rotors.speed) {
            at_hub.push_at(arm, &(air.component_mul(&drag) * growth(own.parameters, *speed)));
        }
        *sum += Wrench { torque_nm: at_hub.torque_nm * at_hubs(own.parameters), ..at_hub };
    }

    fn is_linear(&self) -> bool {
        true
    }

    fn regressor(&self, at: &Condition, rotors: &Rotors, parameters: &[f64], columns: &mut [Wrench]) {
        let lever = at_hubs(parameters);
        let share = -1.0 / at.airframe.rotor_count() as f64;
        for (axis, column) in columns.iter_mut().enumerate().take(PARAMETERS.len()) {
            *column = Wrench::zero();
            for ((arm, air), speed) in at.hubs().zip(&rotors.speed) {
                let mut force = Vector3::zeros();
                force[axis] = air[axis] * share * growth(parameters, *speed);
                column.push_at(&(arm * lever), &force);
            }
        }
    }
}
