//! The vehicle becomes lighter or heavier in flight.

use crate::physics::equation::documented;
use crate::physics::{Bounds, Condition, Effect, Hook, Own, Parameter, Rotors, Wrench};

documented! {
    /// From `time` on, the mass is `m + delta` with the same centre and inertia. The total force `F` then accelerates the
    /// vehicle by `F / (m + delta)`. For a body of mass `m` this is an additional force `-delta / (m + delta) F`.
    #[derive(Debug, Clone, Copy)]
    pub struct MassChange;
}

const PARAMETERS: &[Parameter] = &[
    Parameter { name: "time", unit: "s", bounds: Bounds::of(0.0, 1e5) },
    Parameter { name: "delta", unit: "kg", bounds: Bounds::of(-0.8, 2.0).by_mass() },
];

/// By how much the mass differs now, kg; never so much that less than a tenth is left.
fn changed_kg(at: &Condition, parameters: &[f64]) -> f64 {
    let delta_kg = parameters[1].max(-0.9 * at.airframe.mass_kg);
    if at.input.time_s >= parameters[0] { delta_kg } else { 0.0 }
}

impl Effect for MassChange {
    fn id(&self) -> &'static str {
        "mass_change"
    }

    fn sentence(&self) -> &'static str {
        "The mass changed in flight: from one instant on, the same thrust accelerates it more, or less."
    }

    fn equation(&self) -> &'static str {
        Self::EQUATION
    }

    fn parameters(&self) -> &'static [Parameter] {
        PARAMETERS
    }

    fn hooks(&self) -> &'static [Hook] {
        &[Hook::Reaction]
    }

    fn reaction(&self, at: &Condition, own: &mut Own, sum: &mut Wrench) {
        let share = changed_kg(at, own.parameters) / (at.airframe.mass_kg + changed_kg(at, own.parameters));
        sum.force_n -= sum.force_n * share;
    }

    fn has_regressor(&self) -> bool {
        true
    }

    fn regressor(&self, at: &Condition, rotors: &Rotors, parameters: &[f64], columns: &mut [Wrench]) {
        let [by_time, by_delta] = columns else { return };
        (*by_time, *by_delta) = (Wrench::zero(), Wrench::zero());
        if at.input.time_s >= parameters[0] {
            let now_kg = at.airframe.mass_kg + changed_kg(at, parameters);
            let slope = -at.airframe.mass_kg / (now_kg * now_kg);
            by_delta.force_n = at.thrust_wrench(&rotors.thrust_n).force_n * slope;
        }
    }
}
