//! What never repeats, which the harmonic test cannot see: slow trends, noise redder than any sensor's, gusts;
//! and a lack of fit for flights without a period.

use super::super::channels::{AXES, Channels, SECOND};
use super::super::fit::Fitted;
use super::super::trace::Trace;
use super::Localisation;
use super::gust::{GustFound, axial_drag_n_s_m, gust, lateral_drag};
use super::spectrum::{Ordinate, VELOCITY_SCALE_S2, Whittle, noise_shapes, periodogram, whittle};
use super::view::{Followed, View};
use nalgebra::Vector3;
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

/// A slow trend.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trend {
    /// of what
    pub of: Quantity,
    /// per minute, in the quantity's unit
    pub per_min: f64,
    /// its standard error
    pub std_per_min: f64,
    /// normal deviate
    pub z: f64,
    /// change over the longest flight, of the weight (force, lift) or of the torque's rms
    pub relative: f64,
    /// certain and large enough to matter
    pub certain: bool,
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
    /// rms of the weight, or of the torque's rms
    pub relative: f64,
    /// N, what the velocity's own slow error makes of the drag (rms)
    pub of_velocity_n: f64,
    /// certain, large enough to matter, and more than the velocity's error makes
    pub certain: bool,
}

/// A state that the residual follows in a flight that repeats nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StateLack {
    /// index in [`super::super::CHANNEL_NAMES`]
    pub channel: usize,
    /// which state
    pub state: Followed,
    /// chance, times the number of channels and states
    pub p_value: f64,
    /// root mean square of what the state explains, N or N m
    pub rms: f64,
    /// certain and large enough to matter
    pub certain: bool,
}

/// The tests' outcome.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Aperiodic {
    /// the most certain trend
    pub trend: Option<Trend>,
    /// of each quantity
    pub redness: Vec<Redness>,
    /// where the drag is known and both horizontal axes are red alike
    pub gust: Option<GustFound>,
    /// only where no flight repeats
    pub state: Option<StateLack>,
}

impl Aperiodic {
    /// Without what was found of torques.
    #[must_use]
    pub fn of_forces(&self) -> Self {
        let is_force = |of: Quantity| !matches!(of, Quantity::Torque(_));
        let is_force_channel = |channel: usize| !(3..AXES).contains(&channel);
        Self {
            trend: self.trend.filter(|trend| is_force(trend.of)),
            redness: self.redness.iter().filter(|red| is_force(red.of)).copied().collect(),
            gust: self.gust,
            state: self.state.filter(|state| is_force_channel(state.channel)),
        }
    }

    /// Something certain is left that no gust accounts for.
    #[must_use]
    pub fn is_lacking(&self) -> bool {
        let horizontal = |of: Quantity| matches!(of, Quantity::World(_));
        let trend =
            self.trend.is_some_and(|trend| trend.certain && !(self.gust.is_some() && horizontal(trend.of)));
        let red = self.redness.iter().any(|red| red.certain && !(self.gust.is_some() && horizontal(red.of)));
        trend || red || self.state.is_some_and(|state| state.certain)
    }
}

/// Normal deviate of a trend; eight are tried, and nothing is exactly constant.
const TREND_Z: f64 = 5.5;
/// Change over a flight: of the weight.
const TREND_G: f64 = 0.005;
/// Likelihood ratio of redness.
pub(super) const RED_STATISTIC: f64 = 30.0;
/// Likelihood ratio beyond which a force wanders.
const WANDERING: f64 = 12.0;
/// Likelihood ratio of a redness in what the force's two readings contradict each other by.
const CONTRADICTION_STATISTIC: f64 = 10.0;
/// A red force is no force unless it is larger than this many times what the velocity's error makes.
pub(super) const CONTRADICTED: f64 = 2.0;
/// Least rms of a red force, of the weight.
const RED_G: f64 = 0.002;
/// Torque that forgets faster than this many of the rotors' lag is what commands did between two samples, behind the lag.
const OF_JITTER: f64 = 2.0;
/// Least torque of any kind, of the torque's rms.
const LEAST_TORQUE: f64 = 0.1;
/// Correlation times that are tried, s: from the kernel's width to half a minute.
const TIMES_S: [f64; 16] =
    [0.1, 0.15, 0.2, 0.3, 0.4, 0.6, 0.8, 1.1, 1.5, 2.1, 3.0, 4.2, 6.0, 8.5, 12.0, 20.0];
/// Time about a mass change that is left out, s.
const CHANGE_S: f64 = 2.5;
/// Chance below which a state is followed.
const STATE_P: f64 = 1e-6;
/// Least force that follows a state, of the weight.
const STATE_G: f64 = 0.002;

/// Tests what the fit leaves.
#[must_use]
pub fn aperiodic(traces: &[Trace], fitted: &Fitted, located: &Localisation) -> Aperiodic {
    let Some(mut view) = View::new(traces, fitted) else { return Aperiodic::default() };
    quieten(&mut view, fitted);
    let redness: Vec<Redness> = red_quantities(&view)
        .into_iter()
        .filter_map(|(of, series)| redness(&view, fitted, of, &series))
        .collect();
    Aperiodic {
        trend: trend(traces, fitted, &view),
        gust: gust(&view, fitted, &redness),
        state: state_lack(&view, fitted, located),
        redness,
    }
}

/// Standard error of a step of the mass, kg, where the force along body z wanders: what noise of long
/// correlation makes of the difference between before and after. Zero where nothing is redder than sensors.
#[must_use]
pub fn mass_step_std_kg(traces: &[Trace], fitted: &Fitted, at_s: f64) -> f64 {
    let Some(mut view) = View::new(traces, fitted) else { return 0.0 };
    quieten(&mut view, fitted);
    let Some((correlation_s, fit, statistic)) = red_fit(&view, &beside_harmonics(&view, &view.residual[2]))
    else {
        return 0.0;
    };
    if statistic < WANDERING {
        return 0.0;
    }
    let count = |what: &dyn Fn(f64) -> bool| {
        view.time_s.iter().filter(|time_s| what(**time_s)).count() as f64 * view.step_s
    };
    let (before_s, after_s) = (count(&|t| t < at_s), count(&|t| t >= at_s));
    // the mean of a Gauss-Markov process over a time: 2 s^2 T / L, at most s^2
    let variance = fit.coefficients[2];
    let of_mean = |length_s: f64| (2.0 * variance * correlation_s / length_s.max(1e-3)).min(variance);
    (of_mean(before_s) + of_mean(after_s)).sqrt() / fitted.base.vehicle.gravity_m_s2
}

/// Leaves out the time about a mass change, which is known to some seconds only: a step at the wrong time is
/// a large push of short duration, and not noise.
fn quieten(view: &mut View, fitted: &Fitted) {
    let changes = fitted.base.present.iter().filter(|present| present.effect.id() == "mass_change");
    for at_s in changes.filter_map(|present| present.values.first()) {
        for row in 0..view.len() {
            if (view.time_s[row] - at_s).abs() < CHANGE_S {
                view.residual.iter_mut().for_each(|channel| channel[row] = 0.0);
                if let Some(world) = &mut view.world_force_n {
                    world.iter_mut().for_each(|axis| axis[row] = 0.0);
                }
            }
        }
    }
}

/// What a quantity is measured by: weight or the torque's rms.
fn scale(fitted: &Fitted, of: Quantity) -> f64 {
    match of {
        Quantity::Lift => 1.0,
        Quantity::Torque(axis) => fitted.rows.torque_rms[axis],
        Quantity::BodyZ | Quantity::World(_) => weight_n(fitted),
    }
}

fn weight_n(fitted: &Fitted) -> f64 {
    fitted.base.vehicle.body.mass_kg * fitted.base.vehicle.gravity_m_s2
}

/// The most certain of the trends.
fn trend(traces: &[Trace], fitted: &Fitted, view: &View) -> Option<Trend> {
    let longest_s = view
        .flights
        .iter()
        .filter_map(|(rows, _)| Some(view.time_s[rows.clone()].last()? - view.time_s[rows.clone()].first()?))
        .fold(0.0, f64::max);
    let mut quantities = vec![Quantity::Lift];
    if view.world_force_n.is_some() {
        quantities.extend([Quantity::World(0), Quantity::World(1)]);
    }
    quantities.extend([0, 1, 2].map(Quantity::Torque));
    quantities
        .into_iter()
        .filter_map(|of| {
            let column = trend_column(traces, view, of);
            let evidence = fitted.weighted.test(&[column])?;
            let per_min = evidence.theta[0];
            let relative = per_min.abs() * longest_s / 60.0 / scale(fitted, of).max(f64::MIN_POSITIVE);
            let least = if matches!(of, Quantity::Torque(_)) { LEAST_TORQUE } else { TREND_G };
            let certain = evidence.z > TREND_Z && relative > least;
            Some(Trend { of, per_min, std_per_min: evidence.std(0), z: evidence.z, relative, certain })
        })
        .max_by(|a, b| a.certain.cmp(&b.certain).then(a.z.total_cmp(&b.z)))
}

/// What one unit a minute does.
fn trend_column(traces: &[Trace], view: &View, of: Quantity) -> Channels {
    let mut out: Channels = std::array::from_fn(|_| vec![0.0; view.len()]);
    for (trace, (rows, _)) in traces.iter().zip(&view.flights) {
        let times = &view.time_s[rows.clone()];
        let middle_s = times.iter().sum::<f64>() / times.len().max(1) as f64;
        for (row, &center) in rows.clone().zip(&trace.centers) {
            let minutes = (view.time_s[row] - middle_s) / 60.0;
            let force = match of {
                Quantity::Lift => Vector3::z() * view.thrust_n.get(row).copied().unwrap_or(0.0),
                Quantity::BodyZ => Vector3::z(),
                Quantity::World(axis) => {
                    let direction = Vector3::from_fn(|i, _| if i == axis { 1.0 } else { 0.0 });
                    trace.states[center].attitude.inverse_transform_vector(&direction)
                }
                Quantity::Torque(axis) => {
                    out[3 + axis][row] = minutes;
                    continue;
                }
            };
            for axis in 0..3 {
                out[axis][row] = force[axis] * minutes;
                if trace.reads_force_twice() {
                    out[SECOND + axis][row] = force[axis] * minutes;
                }
            }
        }
    }
    out
}

fn red_quantities(view: &View) -> Vec<(Quantity, Vec<f64>)> {
    let mut out = vec![(Quantity::BodyZ, view.residual[2].clone())];
    if let Some(world) = &view.world_force_n {
        out.extend([0, 1].map(|axis| (Quantity::World(axis), world[axis].clone())));
    }
    out.extend([0, 1, 2].map(|axis| (Quantity::Torque(axis), view.residual[3 + axis].clone())));
    out
}

/// Ordinates that the trajectory does not reach.
pub(super) fn beside_harmonics(view: &View, series: &[f64]) -> Vec<Ordinate> {
    periodogram(view, series).into_iter().filter(|ordinate| !ordinate.harmonic).collect()
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

fn redness(view: &View, fitted: &Fitted, of: Quantity, series: &[f64]) -> Option<Redness> {
    let ordinates = beside_harmonics(view, series);
    let (correlation_s, fit, statistic) = red_fit(view, &ordinates)?;
    let rms = fit.coefficients[2].sqrt();
    let relative = rms / scale(fitted, of).max(f64::MIN_POSITIVE);
    let least = if matches!(of, Quantity::Torque(_)) { LEAST_TORQUE } else { RED_G };
    let of_velocity_n = force_of_velocity_error_n(view, fitted, (of, correlation_s));
    let of_jitter =
        matches!(of, Quantity::Torque(_)) && correlation_s < OF_JITTER * fitted.base.latency.lag_s;
    let certain =
        statistic > RED_STATISTIC && relative > least && rms > CONTRADICTED * of_velocity_n && !of_jitter;
    Some(Redness { of, statistic, rms, correlation_s, relative, of_velocity_n, certain })
}

/// What the velocity's own slow error makes of the drag, N (rms): an estimated velocity that wanders does not
/// follow from the accelerometer, and the two readings of the force contradict each other by the error's rate.
fn force_of_velocity_error_n(view: &View, fitted: &Fitted, (of, correlation_s): (Quantity, f64)) -> f64 {
    let (axis, across) = match of {
        Quantity::World(axis) => (axis, true),
        Quantity::BodyZ => (2, false),
        Quantity::Lift | Quantity::Torque(_) => return 0.0,
    };
    let Some(contradiction) = &view.contradiction_n else { return 0.0 };
    let ordinates = beside_harmonics(view, &contradiction[axis]);
    let mass_kg = fitted.base.vehicle.body.mass_kg;
    let drag_n_s_m = if across {
        lateral_drag(view, fitted).map_or(0.0, |(drag_n_s_m, _)| drag_n_s_m)
    } else {
        axial_drag_n_s_m(fitted)
    };
    // an error whose rate wanders, and one that is itself a first-order Gauss-Markov process as a gust is
    let of_rate_m_s = red_fit(view, &ordinates)
        .filter(|(.., statistic)| *statistic > CONTRADICTION_STATISTIC)
        .map_or(0.0, |(correlation_s, fit, _)| fit.coefficients[2].sqrt() * correlation_s / mass_kg);
    let of_process_m_s = velocity_error_m_s(view, &ordinates, correlation_s).unwrap_or(0.0) / mass_kg;
    drag_n_s_m * of_rate_m_s.max(of_process_m_s)
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

/// The state that the residual follows most surely, where no flight repeats.
fn state_lack(view: &View, fitted: &Fitted, located: &Localisation) -> Option<StateLack> {
    if view.flights.iter().any(|(_, period_s)| period_s.is_some()) {
        return None;
    }
    let tested: Vec<_> = located.follows.iter().filter(|follow| !follow.state.is_slow()).collect();
    let count = tested.len() as f64;
    let least = |channel: usize| {
        if channel < 3 {
            STATE_G * weight_n(fitted)
        } else {
            LEAST_TORQUE * fitted.rows.torque_rms[channel - 3]
        }
    };
    tested
        .into_iter()
        .map(|follow| {
            let rms = follow.share.sqrt() * located.axes[follow.channel % AXES].rms;
            let p_value = (follow.p_value * count).min(1.0);
            let certain = p_value < STATE_P && rms > least(follow.channel);
            StateLack { channel: follow.channel, state: follow.state, p_value, rms, certain }
        })
        .max_by(|a, b| a.certain.cmp(&b.certain).then(b.p_value.total_cmp(&a.p_value)))
}
