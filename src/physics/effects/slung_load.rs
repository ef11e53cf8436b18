//! A load hangs below on a cord.

use crate::units::STANDARD_GRAVITY_M_S2;
use nalgebra::Vector3;

use crate::physics::equation::documented;
use crate::physics::{Airframe, Bounds, Condition, Effect, Hook, Own, Parameter, Rotors, Wrench};

documented! {
    /// The load is a point mass on a taut massless cord of fixed length from the centre of mass. The states are the unit
    /// vector `q` from vehicle to load and its rate, in world axes. With `F` the total force on the vehicle (world,
    /// without gravity), the cord pulls with `T = M m / (M + m) (L |q'|^2 - q . F / M)` along `q`, and
    /// `L q'' = -(T q / m) - (F + T q) / M`. In the finer form the air damps the swing: `damping q'` is subtracted from
    /// `q''`.
    ///
    /// Sreenath, Lee and Kumar 2013, without torque, because the cord is at the centre of mass.
    #[derive(Debug, Clone, Copy)]
    pub struct SlungLoad;
}

const PARAMETERS: &[Parameter] = &[
    Parameter { name: "mass", unit: "kg", bounds: Bounds::of(0.0, 5.0).by_mass() },
    Parameter { name: "length", unit: "m", bounds: Bounds::of(0.05, 20.0) },
];

const FINER: &[Parameter] = &[Parameter { name: "damping", unit: "1/s", bounds: Bounds::of(0.0, 10.0) }];

/// Direction and its rate.
const STATES: usize = 6;

impl SlungLoad {
    /// Damping ratio (-) of the swing on a cord of this length (m) below a heavy vehicle: the damping over twice the frequency of a
    /// pendulum, `damping sqrt(L / g) / 2`.
    #[must_use]
    pub fn damping_ratio(length_m: f64, damping_1_s: f64) -> f64 {
        0.5 * damping_1_s * (length_m / STANDARD_GRAVITY_M_S2).sqrt()
    }
}

impl Effect for SlungLoad {
    fn id(&self) -> &'static str {
        "slung_load"
    }

    fn sentence(&self) -> &'static str {
        "A load swings below on a cord: it pulls sideways after each stop, at its own frequency."
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
        &[Hook::Reaction]
    }

    fn state_count(&self, _airframe: &Airframe) -> usize {
        STATES
    }

    fn initial_states(&self, _at: &Condition, _rotors: &Rotors, states: &mut [f64]) {
        // hanging still
        states.fill(0.0);
        states[2] = -1.0;
    }

    fn reaction(&self, at: &Condition, own: &mut Own, sum: &mut Wrench) {
        let [load_kg, length_m] = [own.parameters[0], own.parameters[1]];
        let damping_1_s = own.parameters.get(PARAMETERS.len()).copied().unwrap_or(0.0);
        let vehicle_kg = at.airframe.mass_kg;
        let cord = Vector3::from_column_slice(&own.states[..3]).normalize();
        let swing = Vector3::from_column_slice(&own.states[3..]);
        let swing = swing - cord * cord.dot(&swing);
        let force_n = at.state.attitude * sum.force_n;
        // per kilogram of load: a load of nothing swings all the same
        let tension_m_s2 = vehicle_kg / (vehicle_kg + load_kg)
            * (length_m * swing.norm_squared() - cord.dot(&force_n) / vehicle_kg);
        let pull_n = cord * (tension_m_s2 * load_kg);
        let turning =
            (cord * -tension_m_s2 - (force_n + pull_n) / vehicle_kg) / length_m - swing * damping_1_s;
        own.rates[..3].copy_from_slice(swing.as_slice());
        own.rates[3..].copy_from_slice(turning.as_slice());
        sum.force_n += at.state.attitude.inverse_transform_vector(&pull_n);
    }
}
