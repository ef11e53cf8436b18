//! Tests of causes that do not repeat and are therefore invisible to the harmonic test: slow trends, noise with more
//! low-frequency power than a sensor's (red noise), gusts; and lack of fit for flights without a period.

use super::super::channels::{AXES, Channels, SECOND};
use super::super::fit::{Fitted, evaluate};
use super::super::followed::Followed;
use super::super::measured_force::may_feel;
use super::super::signature::EffectTerm;
use super::super::trace::Trace;
use super::gust::{GustFound, gust};
use super::localisation::Localisation;
use super::redness::{
    Quantity, Redness, are_outdoors, beside_harmonics, least_trend, least_unnamed, red_fit, red_quantities,
    redness, scale,
};
use super::view::View;
use crate::diagnose::materiality::{
    UNNAMED_CHANGE_OF_WIND, UNNAMED_LOSS_OF_THRUST, UNNAMED_OF_UNSURE_THRUST, UNNAMED_SIDEWAYS,
    UNNAMED_TORQUE,
};
use crate::stats::median;
use nalgebra::Vector3;
use rayon::prelude::*;

/// A slow trend.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trend {
    /// quantity of the trend
    pub of: Quantity,
    /// per minute, in the quantity's unit
    pub per_min: f64,
    /// its standard error
    pub std_per_min: f64,
    /// normal deviate
    pub z: f64,
    /// change over the longest flight, as a share of the weight (force, lift) or of the rms of the torque
    pub relative: f64,
    /// certain and large enough to matter
    pub certain: bool,
}

/// A state on which the residual depends in a flight without a period.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StateLack {
    /// index in [`super::super::CHANNEL_NAMES`]
    pub channel: usize,
    /// which state
    pub state: Followed,
    /// p-value, times the number of channels and states
    pub p_value: f64,
    /// root mean square of the part that the state explains, N or N m
    pub rms: f64,
    /// certain and large enough to matter
    pub certain: bool,
}

/// The tests' outcome.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Aperiodic {
    /// the most certain trend
    pub trend: Option<Trend>,
    /// the redness of each quantity
    pub redness: Vec<Redness>,
    /// the gust, if the drag is known and both horizontal axes are equally red
    pub gust: Option<GustFound>,
    /// only if no flight is periodic
    pub state: Option<StateLack>,
}

impl Aperiodic {
    /// The results without those of torques.
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

    /// Forces and torques that wander by themselves, certain, and too small to count as missing. A gust has its own name.
    pub fn wandering(&self) -> impl Iterator<Item = &Redness> {
        let is_gust = |of: Quantity| self.gust.is_some() && matches!(of, Quantity::World(_));
        self.redness.iter().filter(move |red| red.certain && !red.is_lacking() && !is_gust(red.of))
    }

    /// A horizontal force that changes over the flight, or a thrust that becomes less, certain, and too little to count as missing.
    #[must_use]
    pub fn drifting(&self) -> Option<&Trend> {
        let is_told = |trend: &&Trend| {
            let matters = trend.z > TREND_Z && trend.relative > least_unnamed(trend.of);
            let is_by_wind =
                matches!(trend.of, Quantity::World(_)) && trend.relative <= UNNAMED_CHANGE_OF_WIND;
            let is_less = trend.of == Quantity::Lift && trend.per_min < 0.0;
            let is_by_battery = is_less && trend.relative <= UNNAMED_LOSS_OF_THRUST;
            matters && !trend.certain && (is_by_wind || is_by_battery)
        };
        self.trend.as_ref().filter(is_told)
    }

    /// Emits what is certain as tracing events.
    pub(in crate::diagnose) fn emit(&self) {
        for red in self.redness.iter().filter(|red| red.certain) {
            let Redness { of, statistic, rms, correlation_s, relative, .. } = red;
            tracing::debug!(?of, statistic, rms, correlation_s, relative, "red noise left");
        }
        if let Some(Trend { of, per_min, z, relative, .. }) = self.trend.filter(|trend| trend.certain) {
            tracing::debug!(?of, per_min, z, relative, "a trend left");
        }
        if let Some(StateLack { channel, state, p_value, rms, .. }) = self.state.filter(|state| state.certain)
        {
            tracing::debug!(channel, ?state, p_value, rms, "left along a state");
        }
    }

    /// Whether a significant result remains that is not a gust.
    #[must_use]
    pub fn is_lacking(&self) -> bool {
        let horizontal = |of: Quantity| matches!(of, Quantity::World(_));
        let gust = self.gust.is_some_and(|gust| !gust.is_slight());
        let trend = self.trend.is_some_and(|trend| trend.certain && !(gust && horizontal(trend.of)));
        let red = self.redness.iter().any(|red| red.is_lacking() && !(gust && horizontal(red.of)));
        trend || red || self.state.is_some_and(|state| state.certain)
    }
}

/// Least normal deviate of a trend. It is above that of a name, because eight trends are tried and nothing is exactly
/// constant. Set by judgement; measured only together with all conditions of a finding (see `Gates`).
const TREND_Z: f64 = 5.5;
/// Likelihood ratio beyond which a force drifts by itself. Set by judgement; measured only together with all
/// conditions of a finding (see `Gates`).
const WANDERING: f64 = 12.0;
/// Time around a mass change that is left out, s. It is the width of the kernels and of the search's step around it.
const CHANGE_S: f64 = 2.5;
/// Share of what is left that a state must explain beside a force that wanders by itself. A half is most of it.
const MOST_OF_IT: f64 = 0.5;
/// Time before and after a mass change in which it must show, s.
const BESIDE_S: f64 = 10.0;
/// Least time that is looked at before and after, beyond [`CHANGE_S`], s.
const LEAST_BESIDE_S: f64 = 1.0;
/// The same as a share of the flight, if that is less: a quarter leaves other moments to compare with.
const BESIDE_SHARE: f64 = 0.25;
/// Least share of these seconds that must be usable. With less, the mean would be that of a moment.
const ENOUGH: f64 = 0.3;
/// Median of the size of a standard normal variable.
const MEDIAN_OF_NORMAL: f64 = 0.6745;
/// Time between the other moments that are looked at, s. A grid.
const ELSEWHERE_S: f64 = 1.0;
/// p-value below which the residual depends on a state. Set by judgement; measured only together with all conditions
/// of a finding (see `Gates`).
const STATE_P: f64 = 1e-6;

/// Tests the residual of a fit.
fn aperiodic(traces: &[Trace], fitted: &Fitted, located: &Localisation) -> Aperiodic {
    let Some(mut view) = View::new(traces, fitted) else { return Aperiodic::default() };
    quieten(&mut view, fitted);
    let redness: Vec<Redness> = red_quantities(&view)
        .into_iter()
        .filter_map(|(of, series)| redness(&view, fitted, of, &series))
        .collect();
    Aperiodic {
        trend: trend(traces, fitted, &view),
        gust: gust(&view, fitted, &redness),
        state: state_lack(&view, fitted, (located, &redness)),
        redness,
    }
}

/// The same of several flights: what does not repeat shows in one of them by itself, with the sensors' errors that are its own. What only
/// all of them together show is a difference between them.
#[must_use]
pub fn aperiodic_of_each(traces: &[Trace], fitted: &Fitted, located: &Localisation) -> Aperiodic {
    let mut found = aperiodic(traces, fitted, located);
    let is_red = found.gust.is_some() || found.redness.iter().any(|red| red.certain);
    if traces.len() < 2 || !is_red {
        return found;
    }
    let one = |trace: &Trace| {
        let own = evaluate(std::slice::from_ref(trace), fitted.base.clone()).ok()?;
        let mut view = View::new(std::slice::from_ref(trace), &own)?;
        quieten(&mut view, &own);
        let each = red_quantities(&view).into_iter();
        let redness: Vec<Redness> =
            each.filter_map(|(of, series)| redness(&view, &own, of, &series)).collect();
        Some((gust(&view, &own, &redness).is_some(), redness))
    };
    let each: Vec<(bool, Vec<Redness>)> = traces.par_iter().filter_map(one).collect();
    let shows =
        |of: Quantity| each.iter().any(|(_, redness)| redness.iter().any(|red| red.of == of && red.certain));
    found.gust = found.gust.filter(|_| each.iter().any(|(is_gust, _)| *is_gust));
    found.redness.retain(|red| !red.certain || shows(red.of));
    found
}

/// Standard error of a step of the mass, kg, if the force along body z drifts by itself: the effect of noise with long
/// correlation on the difference between before and after. Zero if the noise is not red.
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

/// A mass change as the seconds before and after it show it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepBeside {
    /// kg, by these seconds alone
    pub delta_kg: f64,
    /// kg, standard deviation of what the same seconds show at other moments of the flight
    pub elsewhere_kg: f64,
}

/// What the seconds before and after a mass change `delta_kg` in the fit of one flight show of it; `None` where it is too near to an end of the
/// flight, and for several flights.
#[must_use]
pub fn mass_step_beside(
    traces: &[Trace],
    fitted: &Fitted,
    (at_s, delta_kg): (f64, f64),
) -> Option<StepBeside> {
    let [_] = traces else { return None };
    let view = View::new(traces, fitted)?;
    beside(&view, (at_s, delta_kg), fitted.base.vehicle.gravity_m_s2)
}

fn beside(view: &View, (at_s, delta_kg): (f64, f64), gravity_m_s2: f64) -> Option<StepBeside> {
    let (first_s, last_s) = (*view.time_s.first()?, *view.time_s.last()?);
    let most_s = BESIDE_S.min(BESIDE_SHARE * (last_s - first_s));
    let (back_s, on_s) = ((at_s - first_s).min(most_s), (last_s - at_s).min(most_s));
    if back_s.min(on_s) < CHANGE_S + LEAST_BESIDE_S {
        return None;
    }
    let mean = |from_s: f64, to_s: f64| {
        let from = view.time_s.partition_point(|time_s| *time_s < from_s);
        let to = view.time_s.partition_point(|time_s| *time_s < to_s);
        // the moment is known only to some seconds
        let known = (from..to).filter(|row| (view.time_s[*row] - at_s).abs() >= CHANGE_S);
        let (sum, count) = known.fold((0.0, 0usize), |(sum, n), row| (sum + view.residual[2][row], n + 1));
        let enough = count as f64 * view.step_s > ENOUGH * (to_s - from_s);
        enough.then(|| sum / count as f64)
    };
    // a mass that is missing in the model is weight: a force that is left downwards
    let step_kg = |at_s: f64| {
        let before_n = mean(at_s - back_s, at_s - CHANGE_S)?;
        Some((before_n - mean(at_s + CHANGE_S, at_s + on_s)?) / gravity_m_s2)
    };
    let here_kg = step_kg(at_s)?;
    let count = ((last_s - first_s - back_s - on_s) / ELSEWHERE_S).max(0.0);
    let moments =
        (0..).take_while(|n| f64::from(*n) <= count).map(|n| first_s + back_s + f64::from(n) * ELSEWHERE_S);
    let other = |moment_s: &f64| (moment_s - at_s).abs() > CHANGE_S + LEAST_BESIDE_S;
    let mut sizes: Vec<f64> = moments.filter(other).filter_map(step_kg).map(f64::abs).collect();
    // a second load that drops does not hide the first
    let elsewhere_kg = median(&mut sizes) / MEDIAN_OF_NORMAL;
    elsewhere_kg.is_finite().then_some(StepBeside { delta_kg: delta_kg + here_kg, elsewhere_kg })
}

/// Leaves out the time around a mass change, which is known only to some seconds: a step at a wrong time causes a large
/// error of short duration that is not noise.
fn quieten(view: &mut View, fitted: &Fitted) {
    let moment_s = |term: &EffectTerm| Some(term.values[term.signature.role.moment?]);
    for at_s in fitted.base.effects.iter().filter_map(moment_s) {
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
            let column = [trend_column(traces, view, of)];
            let evidence = fitted.weighted.test(&column)?;
            let per_min = evidence.theta[0];
            let relative = per_min.abs() * longest_s / 60.0 / scale(fitted, of).max(f64::MIN_POSITIVE);
            let least = least_trend(of, per_min < 0.0, are_outdoors(traces));
            let certain = evidence.z > TREND_Z && relative > least && may_feel(fitted, &column, &evidence);
            Some(Trend { of, per_min, std_per_min: evidence.std(0), z: evidence.z, relative, certain })
        })
        .max_by(|a, b| a.certain.cmp(&b.certain).then(a.z.total_cmp(&b.z)))
}

/// Column of a trend of one unit a minute.
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

/// The state on which the residual depends with the smallest p-value, if no flight is periodic. A controller answers a force that
/// wanders by itself, so the motion follows that force: beside one, a state has to explain most of what is left.
fn state_lack(
    view: &View,
    fitted: &Fitted,
    (located, redness): (&Localisation, &[Redness]),
) -> Option<StateLack> {
    if view.flights.iter().any(|(_, period_s)| period_s.is_some()) {
        return None;
    }
    let tested: Vec<_> = located
        .follows
        .iter()
        .filter(|follow| {
            // the commands' own noise is in the torques, and a controller answers a force across the rotors' axis by them
            let of_lift = follow.channel == 2;
            !(follow.state.is_slow() || !of_lift && follow.state.is_commanded())
        })
        .collect();
    let count = tested.len() as f64;
    let least = |channel: usize, state: Followed| match channel.checked_sub(3) {
        Some(axis) => UNNAMED_TORQUE * fitted.rows.torque_rms[axis],
        None if channel == 2 && state.is_commanded() && view.thrust_is_unsure => {
            UNNAMED_OF_UNSURE_THRUST * fitted.weight_n()
        }
        // along body z as across it: no thrust law holds to a hundredth
        None => UNNAMED_SIDEWAYS * fitted.weight_n(),
    };
    let wanders = |channel: usize| {
        let of_channel = |of: Quantity| match of {
            Quantity::World(_) => channel < 2,
            Quantity::BodyZ => channel == 2,
            Quantity::Torque(axis) => channel == 3 + axis,
            Quantity::Lift => false,
        };
        redness.iter().any(|red| red.certain && of_channel(red.of))
    };
    tested
        .into_iter()
        .map(|follow| {
            let rms = follow.share.sqrt() * located.axes[follow.channel % AXES].rms;
            let p_value = (follow.p_value * count).min(1.0);
            let is_most = follow.share > MOST_OF_IT || !wanders(follow.channel);
            let certain = p_value < STATE_P && rms > least(follow.channel, follow.state) && is_most;
            StateLack { channel: follow.channel, state: follow.state, p_value, rms, certain }
        })
        .max_by(|a, b| a.certain.cmp(&b.certain).then(b.p_value.total_cmp(&a.p_value)))
}
