//! Fixed-step Runge-Kutta 4 and adaptive Dormand-Prince 5(4) over plain vectors; no allocation.

use nalgebra::SVector;

use super::SimulateError;

/// One classical Runge-Kutta step from `time_s` over `step_s` (s).
pub fn rk4_step<const N: usize>(
    derivative: &mut impl FnMut(f64, &SVector<f64, N>) -> SVector<f64, N>,
    time_s: f64,
    state: &SVector<f64, N>,
    step_s: f64,
) -> SVector<f64, N> {
    let half_s = step_s / 2.0;
    // entry by entry: no vector is copied on the way
    let along = |slope: &SVector<f64, N>, by_s: f64| state.zip_map(slope, |x, slope| x + slope * by_s);
    let k1 = derivative(time_s, state);
    let k2 = derivative(time_s + half_s, &along(&k1, half_s));
    let k3 = derivative(time_s + half_s, &along(&k2, half_s));
    let k4 = derivative(time_s + step_s, &along(&k3, step_s));
    SVector::from_fn(|i, _| state[i] + (k1[i] + (k2[i] + k3[i]) * 2.0 + k4[i]) * (step_s / 6.0))
}

/// What an adaptive integration has to keep: `|error| <= absolute + relative |state|`, each component.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerance {
    /// in the unit of each component
    pub absolute: f64,
    /// -
    pub relative: f64,
    /// first step tried, s
    pub first_step_s: f64,
    /// step below which the integration is given up, s
    pub least_step_s: f64,
}

impl Default for Tolerance {
    fn default() -> Self {
        Self { absolute: 1e-9, relative: 1e-9, first_step_s: 1e-3, least_step_s: 1e-12 }
    }
}

// Butcher tableau, Dormand and Prince 1980.
const NODES: [f64; 7] = [0.0, 1.0 / 5.0, 3.0 / 10.0, 4.0 / 5.0, 8.0 / 9.0, 1.0, 1.0];
const STAGES: [[f64; 6]; 7] = [
    [0.0; 6],
    [1.0 / 5.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0, 0.0],
    [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0, 0.0],
    [19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0, 0.0, 0.0],
    [9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0, 0.0],
    // the fifth-order solution itself: the last stage is the next step's first
    [35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
];
/// Fifth- minus fourth-order weights.
const ERROR: [f64; 7] =
    [71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339200.0, 22.0 / 525.0, -1.0 / 40.0];

/// Integrates from `span_s.0` to `span_s.1` with Dormand-Prince 5(4).
///
/// # Errors
/// If the tolerance cannot be met with a step above the least one.
pub fn dormand_prince<const N: usize>(
    derivative: &mut impl FnMut(f64, &SVector<f64, N>) -> SVector<f64, N>,
    span_s: (f64, f64),
    start: &SVector<f64, N>,
    tolerance: &Tolerance,
) -> Result<SVector<f64, N>, SimulateError> {
    let (mut time_s, end_s) = span_s;
    let mut state = *start;
    let mut step_s = tolerance.first_step_s;
    let mut first = derivative(time_s, &state);
    while time_s < end_s {
        let last = time_s + step_s >= end_s;
        let trial_s = if last { end_s - time_s } else { step_s };
        let (next, slopes) = dormand_prince_trial(derivative, time_s, &state, (first, trial_s));
        let error = scaled_error(&slopes, trial_s, (&state, &next), tolerance);
        // a non-finite error rejects the step as a large one does
        let accepted = error <= 1.0;
        if accepted {
            time_s = if last { end_s } else { time_s + trial_s };
            state = next;
            first = slopes[6];
        }
        let factor =
            if error.is_finite() { (0.9 * error.max(1e-10).powf(-0.2)).clamp(0.2, 5.0) } else { 0.2 };
        if !(accepted && last) {
            step_s = trial_s * if accepted { factor } else { factor.min(0.9) };
        }
        if step_s < tolerance.least_step_s {
            return Err(SimulateError::StepTooSmall { time_s, least_s: tolerance.least_step_s });
        }
    }
    Ok(state)
}

/// The fifth-order solution over one step and its seven slopes.
fn dormand_prince_trial<const N: usize>(
    derivative: &mut impl FnMut(f64, &SVector<f64, N>) -> SVector<f64, N>,
    time_s: f64,
    state: &SVector<f64, N>,
    (first, step_s): (SVector<f64, N>, f64),
) -> (SVector<f64, N>, [SVector<f64, N>; 7]) {
    let mut slopes = [SVector::zeros(); 7];
    slopes[0] = first;
    let mut at = *state;
    for stage in 1..7 {
        at = *state;
        for (slope, weight) in slopes.iter().zip(STAGES[stage]).take(stage) {
            at += slope * (weight * step_s);
        }
        slopes[stage] = derivative(time_s + NODES[stage] * step_s, &at);
    }
    (at, slopes)
}

/// Root mean square of the local error over its allowance.
fn scaled_error<const N: usize>(
    slopes: &[SVector<f64, N>; 7],
    step_s: f64,
    (before, after): (&SVector<f64, N>, &SVector<f64, N>),
    tolerance: &Tolerance,
) -> f64 {
    let mut error = SVector::<f64, N>::zeros();
    for (slope, weight) in slopes.iter().zip(ERROR) {
        error += slope * (weight * step_s);
    }
    let mut sum = 0.0;
    for ((e, a), b) in error.iter().zip(before.iter()).zip(after.iter()) {
        let allowed = tolerance.absolute + tolerance.relative * a.abs().max(b.abs());
        sum += (e / allowed).powi(2);
    }
    (sum / N as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::{RIGID_STATES, RigidBodyModel, State, Wrench};
    use crate::vehicle::RigidBody;
    use nalgebra::{Matrix3, UnitQuaternion, Vector3};

    type Vector = SVector<f64, RIGID_STATES>;

    fn body() -> RigidBodyModel {
        let inertia = Matrix3::new(0.012, -0.0008, 0.0001, -0.0008, 0.015, -0.0006, 0.0001, -0.0006, 0.022);
        let body = RigidBody {
            mass_kg: 1.8,
            inertia_kg_m2: inertia,
            center_of_mass_m: Vector3::zeros(),
            gyroscopic: 1.0,
        };
        RigidBodyModel::new(&body, 9.81).unwrap()
    }

    fn free(model: RigidBodyModel) -> impl FnMut(f64, &Vector) -> Vector {
        move |_, vector| {
            let mut out = Vector::zeros();
            model.derivative(&State::read(vector), &Wrench::zero()).write(&mut out);
            out
        }
    }

    fn tumbling() -> Vector {
        let state = State {
            position_m: Vector3::new(0.0, 0.0, 100.0),
            velocity_m_s: Vector3::new(1.0, -2.0, 3.0),
            attitude: UnitQuaternion::from_euler_angles(0.2, -0.4, 1.0),
            rates_rad_s: Vector3::new(0.1, 6.0, -0.2),
        };
        let mut vector = Vector::zeros();
        state.write(&mut vector);
        vector
    }

    fn rk4(from: &Vector, end_s: f64, steps: u32) -> Vector {
        let mut f = free(body());
        let step_s = end_s / f64::from(steps);
        (0..steps).fold(*from, |state, step| rk4_step(&mut f, f64::from(step) * step_s, &state, step_s))
    }

    #[test]
    fn free_fall_is_a_parabola() {
        let end = State::read(&rk4(&tumbling(), 2.0, 200));
        // 100 + 3 * 2 - 9.81 * 2^2 / 2
        assert!((end.position_m - Vector3::new(2.0, -4.0, 86.38)).norm() < 1e-9);
        assert!((end.velocity_m_s - Vector3::new(1.0, -2.0, 3.0 - 19.62)).norm() < 1e-9);
    }

    #[test]
    fn torque_free_tumbling_keeps_energy_and_angular_momentum() {
        let model = body();
        let energy = |s: &State| s.rates_rad_s.dot(&(model.inertia_kg_m2 * s.rates_rad_s)) / 2.0;
        let momentum = |s: &State| s.attitude * (model.inertia_kg_m2 * s.rates_rad_s);
        let start = State::read(&tumbling());
        let end = State::read(&rk4(&tumbling(), 5.0, 5000));
        assert!((energy(&end) / energy(&start) - 1.0).abs() < 1e-8);
        assert!((momentum(&end) - momentum(&start)).norm() / momentum(&start).norm() < 1e-7);
        // about the middle axis it does tumble: the rates did change
        assert!((end.rates_rad_s - start.rates_rad_s).norm() > 0.5);
    }

    #[test]
    fn rk4_is_of_fourth_order() {
        let exact = rk4(&tumbling(), 1.0, 4096);
        let error = |steps| (rk4(&tumbling(), 1.0, steps) - exact).norm();
        let order = (error(64) / error(128)).log2();
        assert!((order - 4.0).abs() < 0.3, "order {order}");
    }

    #[test]
    fn dormand_prince_agrees_with_rk4() {
        let tolerance = Tolerance { absolute: 1e-11, relative: 1e-11, ..Tolerance::default() };
        let adaptive = dormand_prince(&mut free(body()), (0.0, 2.0), &tumbling(), &tolerance).unwrap();
        assert!((adaptive - rk4(&tumbling(), 2.0, 8000)).norm() < 1e-8);
    }

    #[test]
    fn dormand_prince_follows_an_exponential_to_its_tolerance() {
        let mut decay = |_: f64, x: &SVector<f64, 1>| x * -3.0;
        for tolerance in [1e-6, 1e-9, 1e-12] {
            let settings = Tolerance { absolute: tolerance, relative: tolerance, ..Tolerance::default() };
            let end = dormand_prince(&mut decay, (0.0, 1.0), &SVector::from([1.0]), &settings).unwrap();
            assert!((end[0] - (-3.0_f64).exp()).abs() < 10.0 * tolerance);
        }
    }

    #[test]
    fn dormand_prince_gives_up_at_a_pole() {
        // x' = x^2 from 1 ends at t = 1
        let mut blow_up = |_: f64, x: &SVector<f64, 1>| x.component_mul(x);
        let end = dormand_prince(&mut blow_up, (0.0, 2.0), &SVector::from([1.0]), &Tolerance::default());
        assert!(matches!(end, Err(SimulateError::StepTooSmall { .. })));
    }
}
