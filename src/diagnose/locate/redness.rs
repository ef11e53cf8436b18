//! Noise with more low-frequency power than a sensor's (red noise): a force or torque that drifts by itself.

use super::super::fit::Fitted;
use super::super::trace::Trace;
use super::lateral_drag::{axial_drag_n_s_m, lateral_drag};
use super::spectrum::{Ordinate, VELOCITY_SCALE_S2, noise_shapes, periodogram};
use super::view::View;
use crate::diagnose::materiality::{
    UNNAMED_CHANGE_OF_WIND, UNNAMED_FORCE, UNNAMED_LOSS_OF_THRUST, UNNAMED_OF_UNSURE_THRUST,
    UNNAMED_SIDEWAYS, UNNAMED_TORQUE, UNNAMED_WANDERING, WANDERING_ON_ARM, WANDERING_TORQUE,
};
use crate::stats::{Whittle, whittle};
use crate::text::significant;
use crate::trim::mean_arm_m;
use crate::vehicle::AXIS_NAMES;
use std::f64::consts::TAU;

/// Quantities that are looked at for trends and redness.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// gain of the rotors' thrust (-)
    Lift,
    /// force along body z, N
    BodyZ,
    /// force along world x (0) or y (1), N
    World(usize),
    /// torque about a body axis, N m
    Torque(usize),
}

/// Noise that is redder than white sensor noise behind the weak form.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Redness {
    /// of what
    pub of: Quantity,
    /// twice the logarithm of the likelihood ratio against sensor noise alone, harmonics left out
    pub statistic: f64,
    /// of the red part, N or N m
    pub rms: f64,
    /// correlation time of the red part, s
    pub correlation_s: f64,
    /// rms over the weight, or over the torque's rms
    pub relative: f64,
    /// rms over the weight; of a torque, over the weight on a mean arm (about z: over the weight times the torque per thrust)
    pub of_lift: f64,
    /// the same from which on something is missing: less is made by wind and by rotors
    pub least_of_lift: f64,
    /// N, what the velocity's own slow error makes of the drag (rms)
    pub of_velocity_n: f64,
    /// certain, large enough to be told, and more than the velocity's error makes
    pub certain: bool,
}

impl Redness {
    /// Size, axis and time in words: `0.59 N rms (4.0 % of the weight) along world y over 12 s`.
    #[must_use]
    pub fn words(&self) -> String {
        let (unit, scale, along) = match self.of {
            Quantity::World(axis) => ("N", "the weight", format!("along world {}", AXIS_NAMES[axis])),
            Quantity::Lift | Quantity::BodyZ => ("N", "the weight", "along body z".to_owned()),
            Quantity::Torque(2) => ("N m", "the weight's drag torque", "about body z".to_owned()),
            Quantity::Torque(axis) => {
                ("N m", "the weight on an arm", format!("about body {}", AXIS_NAMES[axis]))
            }
        };
        format!(
            "{} {unit} rms ({} % of {scale}) {along} over {} s",
            significant(self.rms, 2),
            significant(100.0 * self.of_lift, 2),
            significant(self.correlation_s, 2)
        )
    }

    /// Whether it is so large that something is missing: forces of wind and of rotors wander too, and with them their torques.
    #[must_use]
    pub fn is_lacking(&self) -> bool {
        let is_lacking = match self.of {
            Quantity::Torque(_) => self.relative > WANDERING_TORQUE,
            Quantity::Lift | Quantity::BodyZ | Quantity::World(_) => true,
        };
        self.certain && is_lacking && self.of_lift > self.least_of_lift
    }
}

pub(super) fn red_quantities(view: &View) -> Vec<(Quantity, Vec<f64>)> {
    let mut out = vec![(Quantity::BodyZ, view.residual[2].clone())];
    if let Some(world) = &view.world_force_n {
        out.extend([0, 1].map(|axis| (Quantity::World(axis), world[axis].clone())));
    }
    out.extend([0, 1, 2].map(|axis| (Quantity::Torque(axis), view.residual[3 + axis].clone())));
    out
}

/// Whether wind blows: where satellite receivers are.
pub(super) fn are_outdoors(traces: &[Trace]) -> bool {
    traces.iter().all(|trace| trace.velocity_error_m_s.is_some())
}

/// Least trend over a flight that matters without a name, as a share of what the quantity is measured by: the mean wind may change, and a
/// thrust `becomes_less`.
pub(super) fn least_trend(of: Quantity, becomes_less: bool, outdoors: bool) -> f64 {
    match of {
        Quantity::World(_) if outdoors => UNNAMED_CHANGE_OF_WIND,
        Quantity::World(_) => UNNAMED_WANDERING,
        Quantity::Lift if becomes_less => UNNAMED_LOSS_OF_THRUST,
        _ => least_unnamed(of),
    }
}

/// Least size that is told without a name, as a share of what the quantity is measured by.
pub(super) fn least_unnamed(of: Quantity) -> f64 {
    match of {
        Quantity::Torque(_) => UNNAMED_TORQUE,
        Quantity::World(_) => UNNAMED_SIDEWAYS,
        Quantity::Lift | Quantity::BodyZ => UNNAMED_FORCE,
    }
}

pub(super) fn redness(view: &View, fitted: &Fitted, of: Quantity, series: &[f64]) -> Option<Redness> {
    let ordinates = beside_harmonics(view, series);
    let (correlation_s, fit, statistic) = red_fit(view, &ordinates)?;
    let rms = fit.coefficients[2].sqrt();
    let relative = rms / scale(fitted, of).max(f64::MIN_POSITIVE);
    let least = least_unnamed(of);
    let of_velocity_n = force_of_velocity_error_n(view, fitted, (of, correlation_s));
    let of_jitter =
        matches!(of, Quantity::Torque(_)) && correlation_s < OF_JITTER * fitted.base.latency.lag_s;
    let of_noise = matches!(of, Quantity::World(_)) && correlation_s < LEAST_S;
    let certain = !of_noise
        && statistic > RED_STATISTIC
        && relative > least
        && rms > CONTRADICTED * of_velocity_n
        && !of_jitter;
    let of_lift = rms / lift_scale(fitted, of);
    let least_of_lift = match of {
        Quantity::Torque(_) => WANDERING_ON_ARM,
        Quantity::Lift | Quantity::BodyZ if view.thrust_is_unsure => UNNAMED_OF_UNSURE_THRUST,
        Quantity::Lift | Quantity::BodyZ | Quantity::World(_) => UNNAMED_WANDERING,
    };
    Some(Redness {
        of,
        statistic,
        rms,
        correlation_s,
        relative,
        of_lift,
        least_of_lift,
        of_velocity_n,
        certain,
    })
}

/// The correlation time that explains most, its fit, and the likelihood ratio against noise alone.
pub(super) fn red_fit(view: &View, ordinates: &[Ordinate]) -> Option<(f64, Whittle, f64)> {
    let power: Vec<f64> = ordinates.iter().map(|o| o.power).collect();
    let [force, velocity] = noise_shapes(view, ordinates);
    let plain = whittle(&power, &[&force, &velocity])?;
    TIMES_S
        .iter()
        .filter_map(|&correlation_s| {
            let red = red_shape(view, ordinates, &force, correlation_s);
            let fit = whittle(&power, &[&force, &velocity, &red])?;
            let ratio = 2.0 * (plain.deviance - fit.deviance);
            Some((correlation_s, fit, ratio))
        })
        .max_by(|a, b| a.2.total_cmp(&b.2))
}

/// What a first-order Gauss-Markov force of unit variance has behind the weak form.
pub(super) fn red_shape(view: &View, ordinates: &[Ordinate], kernel: &[f64], correlation_s: f64) -> Vec<f64> {
    ordinates
        .iter()
        .zip(kernel)
        .map(|(o, kernel)| {
            let turn = TAU * o.frequency_hz * correlation_s;
            2.0 * correlation_s / (1.0 + turn * turn) / view.step_s * kernel
        })
        .collect()
}

/// Ordinates that the trajectory does not reach.
pub(super) fn beside_harmonics(view: &View, series: &[f64]) -> Vec<Ordinate> {
    periodogram(view, series).into_iter().filter(|ordinate| !ordinate.harmonic).collect()
}

/// What the velocity's own slow error makes of the drag, N (rms): an estimated velocity that wanders does not
/// follow from the accelerometer, and the two readings of the force contradict each other by the error's rate. A satellite receiver
/// shows the error itself.
fn force_of_velocity_error_n(view: &View, fitted: &Fitted, (of, correlation_s): (Quantity, f64)) -> f64 {
    let (axis, across) = match of {
        Quantity::World(axis) => (axis, true),
        Quantity::BodyZ => (2, false),
        Quantity::Lift | Quantity::Torque(_) => return 0.0,
    };
    let mass_kg = fitted.base.vehicle.body.mass_kg;
    let (drag_n_s_m, by_receiver_m_s) = if across {
        let drag_n_s_m = lateral_drag(view, fitted).map_or(0.0, |(drag_n_s_m, _)| drag_n_s_m);
        (drag_n_s_m, view.velocity_error_m_s)
    } else {
        (axial_drag_n_s_m(fitted), 0.0)
    };
    let Some(contradiction) = &view.contradiction_n else { return drag_n_s_m * by_receiver_m_s };
    let ordinates = beside_harmonics(view, &contradiction[axis]);
    // an error whose rate wanders, and one that is itself a first-order Gauss-Markov process as a gust is
    let of_rate_m_s = red_fit(view, &ordinates)
        .filter(|(.., statistic)| *statistic > CONTRADICTION_STATISTIC)
        .map_or(0.0, |(correlation_s, fit, _)| fit.coefficients[2].sqrt() * correlation_s / mass_kg);
    let of_process_m_s = velocity_error_m_s(view, &ordinates, correlation_s).unwrap_or(0.0) / mass_kg;
    drag_n_s_m * of_rate_m_s.max(of_process_m_s).max(by_receiver_m_s)
}

/// Standard deviation, times the mass (kg m/s), of a velocity's Gauss-Markov error that the contradiction shows
/// with certainty.
fn velocity_error_m_s(view: &View, ordinates: &[Ordinate], correlation_s: f64) -> Option<f64> {
    let power: Vec<f64> = ordinates.iter().map(|o| o.power).collect();
    let [force, velocity] = noise_shapes(view, ordinates);
    let plain = whittle(&power, &[&force, &velocity])?;
    let rate = red_shape(view, ordinates, &velocity, correlation_s);
    let fit = whittle(&power, &[&force, &velocity, &rate])?;
    let certain = 2.0 * (plain.deviance - fit.deviance) > CONTRADICTION_STATISTIC;
    certain.then(|| (fit.coefficients[2] * VELOCITY_SCALE_S2).sqrt())
}

/// What a quantity is measured by: weight or the torque's rms.
pub(super) fn scale(fitted: &Fitted, of: Quantity) -> f64 {
    match of {
        Quantity::Lift => 1.0,
        Quantity::Torque(axis) => fitted.rows.torque_rms[axis],
        Quantity::BodyZ | Quantity::World(_) => fitted.weight_n(),
    }
}

/// What the rotors make of the weight: the weight, and its torques.
fn lift_scale(fitted: &Fitted, of: Quantity) -> f64 {
    let vehicle = &fitted.base.vehicle;
    let arm_m = match of {
        Quantity::Torque(2) => vehicle.propulsion.torque_per_thrust_m,
        Quantity::Torque(_) => mean_arm_m(vehicle),
        Quantity::Lift | Quantity::BodyZ | Quantity::World(_) => 1.0,
    };
    (arm_m * fitted.weight_n()).max(f64::MIN_POSITIVE)
}

/// Least likelihood ratio of a red spectrum against a white one. Set by judgement; measured only together with all
/// conditions of a finding (see `Gates`).
pub(super) const RED_STATISTIC: f64 = 30.0;

/// A red force must be this many times the force that the velocity's error causes. Set by judgement; measured only
/// together with all conditions of a finding (see `Gates`).
pub(super) const CONTRADICTED: f64 = 2.0;

/// Least likelihood ratio of a red spectrum in the difference of the two measurements of force. Set by judgement;
/// measured only together with all conditions of a finding (see `Gates`).
const CONTRADICTION_STATISTIC: f64 = 10.0;

/// A torque whose correlation time is shorter than this many time constants of the rotors comes from commands between
/// two samples. With it, 0 of 10 simulated flights of `configs/crazyflie.toml` without effects were unexplained; 6 of
/// 20 without it.
const OF_JITTER: f64 = 2.0;

/// A horizontal force whose correlation time is shorter comes from the sensors' filters and from the estimator: air
/// moves more slowly, s.
pub(super) const LEAST_S: f64 = 0.3;

/// Correlation times that are tried, s: from the kernel's width to twenty seconds.
const TIMES_S: [f64; 16] =
    [0.1, 0.15, 0.2, 0.3, 0.4, 0.6, 0.8, 1.1, 1.5, 2.1, 3.0, 4.2, 6.0, 8.5, 12.0, 20.0];
