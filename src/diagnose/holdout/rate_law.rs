//! An empirical law of the body rates, where the torques that the model has predict them worse than no change at all.
//!
//! In calm flight under a controller the commands answer to disturbances and to the noise of the sensors, and hardly any of their
//! torque is seen in the rates. What is left then predicts best with a share of that torque only, and with rates that decay as the
//! controller lets them. The law describes the vehicle under its controller as it was flown and is no mechanism.

use crate::physics::{
    ActiveEffect, Bounds, Condition, Effect, Hook, Model, Own, Parameter, PhysicsError, RigidBodyModel,
    Rotors, Wrench,
};
use crate::signals::{Grid, Signals};
use crate::vehicle::gyroscopic_torque_nm;
use nalgebra::{Matrix3, Vector3};

/// `I w' = s o tau - w x I w - b o w + c` for the torque `tau` of the model, with `o` axis by axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RateLaw {
    /// share of the model's torque that acts, 0..1, body x y z
    pub share: Vector3<f64>,
    /// decay of the rates, 1/s, body x y z
    pub decay_1_s: Vector3<f64>,
    /// constant angular acceleration, rad/s^2, body x y z
    pub offset_rad_s2: Vector3<f64>,
}

/// Fastest decay, 1/s: that of a rate loop.
const FASTEST_1_S: f64 = 50.0;
/// Decay to start from, 1/s. A start value.
const START_1_S: f64 = 2.0;
const PASSES: usize = 25;
/// A step below this share of the values' size ends the fit. A tolerance: the result is known to about this share, far
/// below the error of an empirical law.
const CONVERGED: f64 = 1e-4;

/// What the law is fitted to: a flight with the torque of the model along it (body FLU, N m, one an instant) and the body of that
/// model.
pub(super) struct Path<'a> {
    pub(super) signals: &'a Signals,
    pub(super) torques_nm: Vec<Vector3<f64>>,
    pub(super) body: RigidBodyModel,
}

impl RateLaw {
    /// Least squares over windows of a length (s), one each so many s, from measured rates, with shares from 0 to 1 and no growth.
    /// `None` where there is no window.
    pub(super) fn fit(paths: &[Path], windows: (f64, f64)) -> Option<Self> {
        let [x, y, z] = [0, 1, 2].map(|axis| OneAxis::fit(paths, axis, windows));
        let [x, y, z] = [x?, y?, z?];
        let of = |part: fn(&OneAxis) -> f64| Vector3::new(part(&x), part(&y), part(&z));
        Some(Self {
            share: of(|axis| axis.0[0]),
            decay_1_s: of(|axis| axis.0[1]),
            offset_rad_s2: of(|axis| axis.0[2]),
        })
    }

    /// The model with rates that follow the law, for open-loop predictions; kg m^2 come from its body.
    ///
    /// # Errors
    /// [`PhysicsError`] where a value is outside its bounds.
    pub fn acting_in(&self, model: &Model) -> Result<Model, PhysicsError> {
        model.with(ActiveEffect::new(&EmpiricalRates, &self.values(&model.body.inertia_kg_m2))?)
    }

    /// Values of [`EmpiricalRates`] for a body with this inertia, kg m^2.
    fn values(&self, inertia_kg_m2: &Matrix3<f64>) -> [f64; 9] {
        let moments = inertia_kg_m2.diagonal();
        let (damping, offset) =
            (self.decay_1_s.component_mul(&moments), self.offset_rad_s2.component_mul(&moments));
        let [s, b, c] = [self.share, damping, offset];
        [s.x, s.y, s.z, b.x, b.y, b.z, c.x, c.y, c.z]
    }
}

/// Share (-), decay (1/s) and offset (rad/s^2) about one axis.
struct OneAxis(Vector3<f64>);

/// One step along a window: rate at its end less that at its start comes from these, all in the middle of the step.
struct Step {
    /// rad/s, measured at the end
    measured: f64,
    /// angular acceleration by the model's torque, rad/s^2
    torque: f64,
    /// the same by the gyroscopic torque
    gyroscopic: f64,
}

impl OneAxis {
    fn fit(paths: &[Path], axis: usize, windows: (f64, f64)) -> Option<Self> {
        gauss_newton(|values| sums((paths, axis), windows, values)).map(Self)
    }
}

/// Values within their bounds, by normal matrices and right-hand sides.
fn gauss_newton(
    sums: impl Fn(&Vector3<f64>) -> Option<(Matrix3<f64>, Vector3<f64>)>,
) -> Option<Vector3<f64>> {
    let least = Vector3::new(0.0, 0.0, f64::NEG_INFINITY);
    let most = Vector3::new(1.0, FASTEST_1_S, f64::INFINITY);
    let mut values = Vector3::new(0.0, START_1_S, 0.0);
    for _ in 0..PASSES {
        let (normal, right) = sums(&values)?;
        let moved = bounded_step((&normal, &right), &values, (&least, &most))?;
        values += moved;
        let size = Vector3::new(1.0, START_1_S, values.z.abs().max(0.1));
        if moved.component_div(&size).amax() < CONVERGED {
            break;
        }
    }
    values.iter().all(|value| value.is_finite()).then_some(values)
}

/// Normal matrix and right-hand side of a Gauss-Newton step; `None` without a window.
fn sums(
    (paths, axis): (&[Path], usize),
    (window_s, stride_s): (f64, f64),
    values: &Vector3<f64>,
) -> Option<(Matrix3<f64>, Vector3<f64>)> {
    let (mut normal, mut right, mut any) = (Matrix3::zeros(), Vector3::zeros(), false);
    for path in paths {
        let Signals { grid, usable, rate: Some(rates), .. } = path.signals else { continue };
        let moment = path.body.inertia_kg_m2[(axis, axis)];
        let count = |time_s: f64| {
            (1..grid.count).take_while(|n| *n as f64 * grid.step_s <= time_s + 1e-9).count().max(1)
        };
        let (window, stride) = (count(window_s), count(stride_s));
        let step = |index: usize| {
            let rate = 0.5 * (rates[index] + rates[index + 1]);
            let gyroscopic =
                -gyroscopic_torque_nm(path.body.gyroscopic, &path.body.inertia_kg_m2, &rate)[axis] / moment;
            Step {
                measured: rates[index + 1][axis],
                torque: path.torques_nm[index][axis] / moment,
                gyroscopic,
            }
        };
        for run in Grid::runs(usable, window + 1) {
            for start in (run.start..run.end - window).step_by(stride) {
                any = true;
                let steps = (start..start + window).map(step);
                add_window((rates[start][axis], steps), (values, grid.step_s), (&mut normal, &mut right));
            }
        }
    }
    any.then_some((normal, right))
}

/// Adds one window, by the trapezoidal rule with the sensitivities along.
fn add_window(
    (mut rate, steps): (f64, impl Iterator<Item = Step>),
    (values, step_s): (&Vector3<f64>, f64),
    (normal, right): (&mut Matrix3<f64>, &mut Vector3<f64>),
) {
    let [share, decay, offset] = [values.x, values.y, values.z];
    let (ahead, back) = (1.0 + 0.5 * step_s * decay, 1.0 - 0.5 * step_s * decay);
    let mut slopes = Vector3::zeros();
    for Step { measured, torque, gyroscopic } in steps {
        let next = (back * rate + step_s * (share * torque + gyroscopic + offset)) / ahead;
        let by = Vector3::new(step_s * torque, -0.5 * step_s * (rate + next), step_s);
        slopes = (back * slopes + by) / ahead;
        rate = next;
        *normal += slopes * slopes.transpose();
        *right += slopes * (measured - rate);
    }
}

/// A Gauss-Newton step that stays within bounds: a value at its bound that would leave it is held.
fn bounded_step(
    (normal, right): (&Matrix3<f64>, &Vector3<f64>),
    values: &Vector3<f64>,
    (least, most): (&Vector3<f64>, &Vector3<f64>),
) -> Option<Vector3<f64>> {
    let mut held = [false; 3];
    for _ in 0..=held.len() {
        let (mut kept, mut moments) = (*normal, *right);
        for index in (0..3).filter(|&index| held[index] || normal[(index, index)] <= 0.0) {
            kept.row_mut(index).fill(0.0);
            kept.column_mut(index).fill(0.0);
            (kept[(index, index)], moments[index]) = (1.0, 0.0);
        }
        let by = kept.cholesky()?.solve(&moments);
        let leaves = |&index: &usize| {
            let at = values[index];
            !held[index] && (at <= least[index] && by[index] < 0.0 || at >= most[index] && by[index] > 0.0)
        };
        match (0..3).find(leaves) {
            Some(index) => held[index] = true,
            None => return Some((values + by).sup(least).inf(most) - values),
        }
    }
    None
}

/// The law as what acts in a simulation, after all effects.
#[derive(Debug, Clone, Copy)]
struct EmpiricalRates;

const SHARE: Bounds = Bounds::of(0.0, 1.0);
const ANY: Bounds = Bounds::of(f64::NEG_INFINITY, f64::INFINITY);
const PARAMETERS: &[Parameter] = &[
    Parameter { name: "share_x", unit: "-", bounds: SHARE },
    Parameter { name: "share_y", unit: "-", bounds: SHARE },
    Parameter { name: "share_z", unit: "-", bounds: SHARE },
    Parameter { name: "damping_x", unit: "N m/(rad/s)", bounds: ANY },
    Parameter { name: "damping_y", unit: "N m/(rad/s)", bounds: ANY },
    Parameter { name: "damping_z", unit: "N m/(rad/s)", bounds: ANY },
    Parameter { name: "offset_x", unit: "N m", bounds: ANY },
    Parameter { name: "offset_y", unit: "N m", bounds: ANY },
    Parameter { name: "offset_z", unit: "N m", bounds: ANY },
];

impl Effect for EmpiricalRates {
    fn id(&self) -> &'static str {
        "empirical_rates"
    }

    fn sentence(&self) -> &'static str {
        "A share of the torques acts, and the rates decay: no mechanism, but what predicts the vehicle under its controller."
    }

    fn equation(&self) -> &'static str {
        "`tau = s tau_rotors - d w + o` on each axis"
    }

    fn parameters(&self) -> &'static [Parameter] {
        PARAMETERS
    }

    fn hooks(&self) -> &'static [Hook] {
        &[Hook::Wrench]
    }

    fn wrench(&self, at: &Condition, _rotors: &Rotors, own: &mut Own, sum: &mut Wrench) {
        let [share, damping, offset] =
            [0, 3, 6].map(|from| Vector3::from_column_slice(&own.parameters[from..from + 3]));
        let torque_nm = sum.torque_nm.component_mul(&share);
        sum.torque_nm = torque_nm - at.state.rates_rad_s.component_mul(&damping) + offset;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    /// Values from windows of rates that move by `by` under torques of many frequencies.
    fn found(by: impl Fn(f64, f64) -> f64) -> Vector3<f64> {
        const STEP_S: f64 = 0.01;
        let mut draw = Pcg64Mcg::seed_from_u64(5);
        let (mut rate, mut torque, mut windows) = (0.0, 0.0, Vec::new());
        for _ in 0..200 {
            let (first, mut steps) = (rate, Vec::new());
            for _ in 0..50 {
                torque += 0.1 * (draw.random_range(-30.0..30.0) - torque);
                // fine steps: the fit's own rule is not what makes the data
                for _ in 0..100 {
                    rate += 0.01 * STEP_S * by(rate, torque);
                }
                steps.push((rate, torque));
            }
            windows.push((first, steps));
        }
        let sums = |values: &Vector3<f64>| {
            let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
            for (first, steps) in &windows {
                let each = steps.iter().map(|&(measured, torque)| Step { measured, torque, gyroscopic: 0.0 });
                add_window((*first, each), (values, STEP_S), (&mut normal, &mut right));
            }
            Some((normal, right))
        };
        gauss_newton(sums).unwrap()
    }

    #[test]
    fn a_share_of_the_torque_and_a_decay_are_found() {
        let law = found(|rate, torque| 0.4 * torque - 3.0 * rate + 0.2);
        assert!((law - Vector3::new(0.4, 3.0, 0.2)).amax() < 0.01, "{law}");
    }

    #[test]
    fn torque_against_the_motion_is_none_and_nothing_grows() {
        let law = found(|rate, torque| -0.4 * torque - 3.0 * rate);
        assert!(law.x == 0.0 && law.y > 0.0, "{law}");
        let law = found(|rate, torque| torque + 0.1 * rate.clamp(-1.0, 1.0));
        assert!(law.x <= 1.0 && law.y >= 0.0, "{law}");
    }
}
