//! Latency between command and rotor: its size, and whether it is a lag or a delay.
//!
//! A first-order lag gives the command `M + tau M'` exactly, a pure delay `M + d M' + d^2/2 M'' ...`, where M is the
//! torque that the motion needs. The second-order term therefore distinguishes them. The size of the residual does not,
//! because a lag also smooths noise and has the smaller residual for that reason.

use super::base::Base;
use super::channels::{Channels, Nuisance, NuisanceColumn, SECOND, append, channels, nothing, per_step};
use super::evidence::Weighted;
use super::feedback_noise::{UNCONFIRMED_S, is_fed_back};
use super::fit::{Fitted, Newton, evaluate, fit};
use super::flight_rows::residuals;
use super::gyroscopic::left_out;
use super::hausman::{contradict, differ};
use super::latency_kind::of_kind;
use super::latency_parts::{held_s, is_delay, lag_of, stated_lag_s, stated_uneven};
use super::left_over::{of_left_over, of_tested};
use super::rows::Rows;
use super::signature::{EffectTerm, Signature};
use super::signatures::{ALL, with_role};
use super::torques_by_instruments::fit_by_instruments;
use super::trace::Trace;
use crate::physics::{ActuationLatency, PhysicsError, delayed_wrench};
use nalgebra::Vector4;

/// What the latency consists of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LatencyFinding {
    /// delay and lag together, s
    pub total_s: f64,
    /// its standard error, s
    pub std_s: f64,
    /// its division into delay and lag
    pub parts: ActuationLatency,
    /// standard deviations between the second-order term and that of a pure lag
    pub against_lag: f64,
    /// standard deviations between it and that of a pure delay
    pub against_delay: f64,
    /// standard error of [`ActuationLatency::uneven`], if the flight distinguishes rising from falling speed
    pub uneven_std: Option<f64>,
    /// no noise is fed back, or instruments determine it as well
    pub is_confirmed: bool,
}

impl LatencyFinding {
    /// Whether a flight determined it: commands and body rates were fast enough to compare torques, and the motion follows them.
    #[must_use]
    pub fn is_determined(&self) -> bool {
        self.std_s < LONGEST_S
    }

    /// Its standard error, s; infinite where no flight determined it.
    pub(super) fn told_std_s(&self) -> f64 {
        if self.is_determined() { self.std_s } else { f64::INFINITY }
    }
}

/// Why a latency is not determined.
pub const NO_LATENCY: &str = "commands or body rates are logged at too low a rate to compare torques, or the motion does not follow them, and forces alone do not determine it";

/// The kind of a shorter latency is not determined, s: sampling and a fast motor together are as long.
const LEAST_S: f64 = 0.010;
/// No flyable vehicle has a longer one, s: the slowest motors of large multirotors follow within 0.15 s, and an attitude loop with more does
/// not hold the vehicle. Where a fit goes beyond, the torques of the commands are not seen in the motion.
const LONGEST_S: f64 = 0.2;
/// Latency of sampling and a fast motor, s. A lag or delay is named if it is beyond it. With less every log would
/// have a lag.
pub(super) const FAST_MOTOR_S: f64 = 0.004;

/// Fits the rigid body alone with its latency. Damping and drag also act through the derivative of force and torque, so
/// their columns are in the fit as well.
///
/// # Errors
/// [`PhysicsError`] where the base is not physical.
pub fn fit_latency(flights: &[Trace], base: Base) -> Result<(Fitted, LatencyFinding), PhysicsError> {
    let mut allowed = base.clone();
    allowed.effects = look_alikes(flights);
    let (fitted, mut finding) = with_latency(flights, allowed, Newton::Free)?;
    let mut latency = fitted.base.latency;
    let total_s = finding.total_s;
    if total_s > LEAST_S.max(4.0 * finding.std_s)
        && let Some((against_lag, against_delay, delay_s)) = second_order(flights, &fitted)?
    {
        // fed back, the gyroscopes' noise moves commands and motion together, and the second order with them
        let fed_back = is_fed_back(flights);
        let uneven = stated_uneven(&fitted.base.vehicle);
        latency = if fed_back {
            lag_of(flights, total_s, uneven)
        } else {
            of_kind(flights, &fitted, total_s, (against_lag, against_delay, delay_s))?
        };
        let newton = if is_delay(latency, &fitted.base.vehicle) { Newton::Delay } else { Newton::Free };
        let base = Base { latency, ..fitted.base.clone() };
        // several of a long flight at a time take much memory
        drop(fitted);
        let (mut fitted, found) = with_latency(flights, base, newton)?;
        // what instruments confirmed stays where they confirm none of this kind
        if !finding.is_confirmed || found.is_confirmed {
            finding = found;
            if let Some((told, found)) = uneven_lag(flights, &mut fitted, uneven)? {
                finding = LatencyFinding { uneven_std: Some(told), ..found };
            }
            latency = fitted.base.latency;
        } else {
            finding = LatencyFinding { parts: latency, ..finding };
        }
        if !fed_back {
            finding = LatencyFinding { against_lag, against_delay, ..finding };
        }
    } else if finding.is_determined() && latency.lag_s == 0.0 {
        // its kind is not told: the lag that is stated
        let lag_s = stated_lag_s(&fitted.base.vehicle).clamp(0.0, total_s.max(0.0));
        latency =
            ActuationLatency { delay_s: total_s - lag_s, lag_s, uneven: stated_uneven(&fitted.base.vehicle) };
        drop(fitted);
    }
    let held = fit(flights, Base { latency, ..base.clone() }, Newton::Held)?;
    match left_out(flights, &held, &base) {
        Some(base) => {
            drop(held);
            fit_latency(flights, base)
        }
        None => Ok((held, finding)),
    }
}

/// Fits the latency with everything else: by instruments where they serve, else by least squares.
///
/// # Errors
/// [`PhysicsError`] where the estimate leaves what is physical.
pub(super) fn with_latency(
    flights: &[Trace],
    base: Base,
    newton: Newton,
) -> Result<(Fitted, LatencyFinding), PhysicsError> {
    let plain = fit(flights, base, newton)?;
    if plain.base.latency.total_s() > LONGEST_S {
        return without_latency(flights, plain);
    }
    let finding = finding_of(&plain);
    // where the noise is fed back, least squares may be wrong by what it differs from instruments, or by more than they tell
    let unsure = |by_s: Option<f64>| {
        let is_fed_back = is_fed_back(flights);
        let unsure_s = if is_fed_back { by_s.unwrap_or(UNCONFIRMED_S) } else { 0.0 };
        let is_confirmed = !is_fed_back || by_s.is_some();
        LatencyFinding { std_s: finding.std_s.hypot(unsure_s), is_confirmed, ..finding }
    };
    // of some flights they tell moments alone
    let by = fit_by_instruments(flights, &plain, newton)?.filter(|by| of_covariance(by).std_s > 0.0);
    let Some(by) = by else { return Ok((plain, unsure(None))) };
    let told = of_covariance(&by);
    tracing::debug!(
        least_squares_s = finding.total_s,
        least_squares_std_s = finding.std_s,
        by_instruments_s = told.total_s,
        by_instruments_std_s = told.std_s,
        "latency"
    );
    // without such noise least squares has nothing against it but a contradiction
    let refutes = if is_fed_back(flights) { differ } else { contradict };
    if told.total_s > LONGEST_S
        || !refutes(told.total_s - finding.total_s, finding.std_s.powi(2), told.std_s.powi(2))
    {
        let apart_s = Some((finding.total_s - told.total_s).abs()).filter(|_| told.std_s < UNCONFIRMED_S);
        return Ok((plain, unsure(apart_s)));
    }
    let base = Base { latency: by.base.latency, ..plain.base.clone() };
    // several of a long flight at a time take much memory
    drop((plain, by));
    Ok((fit(flights, base, Newton::Held)?, told))
}

/// The fit about the lag that is stated. The flight does not determine the latency: its error is as large as any that a vehicle has.
fn without_latency(flights: &[Trace], lost: Fitted) -> Result<(Fitted, LatencyFinding), PhysicsError> {
    let vehicle = &lost.base.vehicle;
    let lag_s = stated_lag_s(vehicle).min(LONGEST_S);
    let latency = ActuationLatency { delay_s: 0.0, lag_s, uneven: stated_uneven(vehicle) };
    tracing::debug!(lost_s = lost.base.latency.total_s(), "no latency that a vehicle can have fits");
    let base = Base { latency, ..lost.base.clone() };
    drop(lost);
    let held = fit(flights, base, Newton::Held)?;
    let finding = LatencyFinding { std_s: LONGEST_S, is_confirmed: false, ..finding_of(&held) };
    Ok((held, finding))
}

/// The rigid body with the latency that it is found to have, whatever its kind, and the latency's standard error, s: what
/// [`fit_latency`] begins with.
///
/// # Errors
/// [`PhysicsError`] where the base is not physical.
pub(super) fn with_any_latency(flights: &[Trace], base: Base) -> Result<(Fitted, f64), PhysicsError> {
    let mut allowed = base.clone();
    allowed.effects = look_alikes(flights);
    let (fitted, LatencyFinding { std_s, .. }) = with_latency(flights, allowed, Newton::Free)?;
    let Base { vehicle, latency, is_unbiased, .. } = fitted.base;
    Ok((evaluate(flights, Base { vehicle, latency, is_unbiased, ..base })?, std_s))
}

/// Effects whose columns resemble that of a latency.
fn look_alikes(flights: &[Trace]) -> Vec<EffectTerm> {
    let moving = flights.iter().all(|trace| trace.known.velocity && trace.known.attitude);
    let alike = ALL.iter().filter(|signature| moving || !signature.role.of_air);
    alike.filter_map(|signature| signature.role.like_latency).map(|term| term()).collect()
}

/// Total and standard error of a fit's latency. Where no torques are compared, the error is infinite: commands are logged so
/// seldom that what lies between two of them is no straight line, and the force follows it as little as the torque does.
#[must_use]
pub fn finding_of(fitted: &Fitted) -> LatencyFinding {
    let finding = of_covariance(fitted);
    let latency = |column: &NuisanceColumn| column.nuisance == Nuisance::Latency;
    let place = fitted.rows.nuisances.iter().position(latency);
    let left_over = place.map_or(0.0, |place| of_left_over(&fitted.weighted, place));
    LatencyFinding { std_s: finding.std_s.hypot(left_over.sqrt()), ..finding }
}

/// The same without what the torque that is left over may do to it.
fn of_covariance(fitted: &Fitted) -> LatencyFinding {
    let index = fitted.rows.nuisances.iter().position(|column| column.nuisance == Nuisance::Latency);
    let std_s = index
        .filter(|_| fitted.rows.compares_torques)
        .map_or(f64::INFINITY, |index| fitted.covariance[(index, index)].max(0.0).sqrt());
    LatencyFinding {
        total_s: fitted.base.latency.total_s(),
        std_s,
        parts: fitted.base.latency,
        against_lag: 0.0,
        against_delay: 0.0,
        uneven_std: None,
        is_confirmed: true,
    }
}

/// Standard errors by which rising and falling time constants must differ. With it, none of 12 flights with even rotors
/// was taken for uneven, and 8 of 12 with a ratio of 1.6 were found: `cargo bench --bench blind`, seeds 401 to 412.
const UNEVEN: f64 = 6.0;
/// Least natural logarithm of the falling over the rising time constant: a third. It only keeps the fit from running
/// away.
const UNEVEN_LEAST: f64 = -1.1;
/// Greatest natural logarithm of the falling over the rising time constant: four. It only keeps the fit from running
/// away.
const UNEVEN_MOST: f64 = 1.4;
/// Passes over this ratio. A number of steps: only the time of a search and its last digits depend on it.
const UNEVEN_PASSES: usize = 4;
/// Step of the ratio's logarithm. A number of steps: only the time of a search and its last digits depend on it.
const UNEVEN_STEP: f64 = 0.2;

/// Estimates different time constants for rising and falling speed if the flight contradicts the stated ratio by more
/// than a thrust curve would, and refits with them. Returns the standard error.
fn uneven_lag(
    flights: &[Trace],
    fitted: &mut Fitted,
    stated: f64,
) -> Result<Option<(f64, LatencyFinding)>, PhysicsError> {
    let latency = fitted.base.latency;
    if latency.lag_s <= latency.delay_s || is_delay(latency, &fitted.base.vehicle) {
        return Ok(None);
    }
    let even = fitted.clone();
    let mut told = None;
    for _ in 0..UNEVEN_PASSES {
        let mut further = fitted.base.clone();
        further.latency.uneven += UNEVEN_STEP;
        let column = per_step(residuals(flights, &further)?, &fitted.rows.residual, UNEVEN_STEP);
        let curve = with_role(|role| role.bends_thrust.is_some()).map(Signature::whole_finer);
        let mut columns = match curve {
            Some(curve) => fitted.rows.columns_of(flights, &fitted.base, &curve)?,
            None => Vec::new(),
        };
        columns.push(column);
        let last = columns.len() - 1;
        let Some(evidence) = fitted.weighted.test(&columns) else { break };
        let (by, std) = (evidence.theta[last], evidence.std(last));
        let uneven = (fitted.base.latency.uneven + by).clamp(UNEVEN_LEAST, UNEVEN_MOST);
        if (uneven - stated).abs() < UNEVEN * std {
            told = None;
            break;
        }
        let moved = (uneven - fitted.base.latency.uneven).abs();
        let mut base = fitted.base.clone();
        base.latency.uneven = uneven;
        let (again, found) = with_latency(flights, base, Newton::Free)?;
        *fitted = again;
        told = Some((std, found));
        if moved < 0.3 * std {
            break;
        }
    }
    let at_bound = [UNEVEN_LEAST, UNEVEN_MOST].contains(&fitted.base.latency.uneven);
    if told.is_none() || at_bound || fitted.misfit() >= even.misfit() {
        *fitted = even;
        return Ok(None);
    }
    Ok(told)
}

/// Standard deviations from a pure lag and from a pure delay, and the delay (s) if the latency is a sum of both.
fn second_order(flights: &[Trace], fitted: &Fitted) -> Result<Option<(f64, f64, f64)>, PhysicsError> {
    let mut base = fitted.base.clone();
    // beyond the delay that every recording has
    let held_s = held_s(flights);
    base.latency = ActuationLatency { delay_s: held_s, ..ActuationLatency::default() };
    let mut rows = Rows::new(flights, &base)?;
    let Some(place) = rows.nuisances.iter().position(|column| column.nuisance == Nuisance::Latency) else {
        return Ok(None);
    };
    let mut first = rows.nuisances.remove(place).values;
    first[2].fill(0.0);
    first[SECOND + 2].fill(0.0);
    let second = torque_rows(flights, |trace| {
        // -K(M'')
        turning(trace, &base, 2, ActuationLatency::default())
    });
    let weighted = Weighted::new(&rows);
    let Some(evidence) = weighted.test(&[first, second]) else { return Ok(None) };
    let (c1, c2) = (evidence.theta[0], evidence.theta[1]);
    let left_over = of_tested(&weighted, &evidence, 1);
    let (s1, s2) = (evidence.std(0), evidence.std(1).hypot(left_over));
    // c2 - c1^2/2 takes its error from both
    let spread = (s2 * s2 + c1 * c1 * s1 * s1 - 2.0 * c1 * evidence.covariance[(0, 1)]).max(1e-30).sqrt();
    let delay_s = held_s + c1 - (c1 * c1 - 2.0 * c2).max(0.0).sqrt();
    Ok(Some(((c2 / s2).abs(), ((c2 - 0.5 * c1 * c1) / spread).abs(), delay_s)))
}

/// Column of a larger lag with an equally smaller delay, per s: `-K(M')` behind the lag in the torque rows, from the
/// measured motion, and `-K(T')` behind it in the force rows, from the smoothed commands.
pub(super) fn lag_column(flights: &[Trace], fitted: &Fitted) -> Channels {
    let behind = ActuationLatency { delay_s: 0.0, ..fitted.base.latency };
    let mut out = Channels::default();
    for (index, trace) in flights.iter().enumerate() {
        let mut force = nothing(trace);
        if let Some(commanded) = fitted.rows.commanded(index) {
            let thrust: Vec<Vector4<f64>> = commanded
                .thrust_n
                .each()
                .map(|thrusts| Vector4::new(thrusts.iter().sum(), 0.0, 0.0, 0.0))
                .collect();
            let late = delayed_wrench(&thrust, trace.grid.step_s, behind);
            force[2] = trace.weak(1, &late.iter().map(|thrust| -thrust[0]).collect::<Vec<f64>>());
        }
        append(&mut out, &channels(trace, force, turning(trace, &fitted.base, 1, behind)));
    }
    out
}

/// Columns that are zero in the force rows.
fn torque_rows(flights: &[Trace], columns: impl Fn(&Trace) -> [Vec<f64>; 3]) -> Channels {
    let mut out = Channels::default();
    for trace in flights {
        append(&mut out, &channels(trace, nothing(trace), columns(trace)));
    }
    out
}

/// `-K` of the derivative of this order of the torque that the measured motion needs, behind a latency.
fn turning(trace: &Trace, base: &Base, order: usize, behind: ActuationLatency) -> [Vec<f64>; 3] {
    let torque = trace.turning_torque(&base.vehicle.body);
    let torque: Vec<Vector4<f64>> = torque.iter().map(|t| Vector4::new(t.x, t.y, t.z, 0.0)).collect();
    let late = delayed_wrench(&torque, trace.grid.step_s, behind);
    [0, 1, 2].map(|axis| trace.weak(order, &late.iter().map(|t| -t[axis]).collect::<Vec<f64>>()))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test ends where it fails")]
    use super::*;
    use crate::diagnose::ExplainSettings;
    use crate::diagnose::instruments::Instruments;
    use crate::diagnose::made_flights::flown;
    use crate::simulate::RandomTrajectory;
    use std::sync::Arc;

    /// Noise is fed back.
    #[test]
    fn instruments_that_do_not_tell_a_latency_do_not_confirm_it() {
        let (signals, vehicle) = flown(23, &RandomTrajectory::default(), |_, _| ());
        let mut trace = Trace::new(&signals, &vehicle, ExplainSettings::default().half_width_s).unwrap();
        trace.gyro_noise_rad_s = 0.2;
        let all = trace.instruments.clone().unwrap();
        let found = |trace: Trace| with_latency(&[trace], Base::anchored(&vehicle), Newton::Free).unwrap().1;
        let by_all = found(trace.clone());
        assert!(by_all.is_confirmed && by_all.std_s < UNCONFIRMED_S, "{by_all:?}");
        // of three axes at most one has more than half of what the latency does
        let alone = |axis: usize| {
            let mut torques = [None, None, None];
            torques[axis].clone_from(&all.torques[axis]);
            let instruments = Some(Arc::new(Instruments { torques, thrust: None }));
            let mut of = trace.clone();
            of.instruments = instruments;
            found(of)
        };
        let unsure: Vec<_> = (0..3).map(alone).filter(|found| !found.is_confirmed).collect();
        assert!(unsure.len() >= 2 && unsure.iter().all(|found| found.std_s >= UNCONFIRMED_S), "{unsure:?}");
    }
}
