//! The name of a lag or delay that is larger than on every vehicle.

use super::base::Base;
use super::fit::Newton;
use super::floors::FORM;
use super::latency::{FAST_MOTOR_S, LatencyFinding, with_latency};
use super::latency_distance::latency_distance;
use super::latency_kind::REFUSED;
use super::latency_parts::{held_s, is_delay, stated_lag_s};
use super::named::{Confusable, Named, NamedParameter, Strength};
use super::signature::LatencyKind;
use super::signatures::{latency_signature, signature_of};
use super::tested::Search;
use super::told_apart::LATENCY_APART;
use super::trace::Trace;
use crate::physics::{ActuationLatency, PhysicsError, RotorLag};
use crate::vehicle::Vehicle;

/// Standard errors that a delay has to have where the motor's own lag is not stated. The usual 95 %.
const CERTAIN: f64 = 2.0;

/// A lag or delay beyond that of sampling and a fast motor; `None` too where torques are not compared, because the commands
/// are then logged too seldom to tell.
pub(super) fn latency_name(traces: &[Trace], vehicle: &Vehicle, found: &Search) -> Option<Named> {
    if !traces.iter().any(|trace| trace.torques) {
        return None;
    }
    let LatencyFinding { total_s, std_s, parts, against_lag, against_delay, uneven_std, .. } = found.latency;
    let ordinary_s = ordinary_s(traces, vehicle);
    if total_s - ordinary_s < 4.0 * std_s.hypot(ORDINARY_STD_S) {
        return None;
    }
    // what every vehicle has beside it is known no better than that
    let std_s = std_s.hypot(unsure_s(traces)).hypot(ORDINARY_STD_S);
    let is_lag = parts.lag_s > parts.delay_s && !is_delay(parts, vehicle);
    let (lag, delay) = (latency_signature(LatencyKind::Lag)?, latency_signature(LatencyKind::Delay)?);
    let (kind, other) = if is_lag { (lag, delay) } else { (delay, lag) };
    let name = kind.effect.parameters().first()?.name;
    let (value, std) = if is_lag {
        (parts.lag_s, std_s.hypot(unseen_delay_s(total_s, (against_lag, against_delay))))
    } else if parts.lag_s > 0.0 {
        (parts.delay_s - held_s(traces), std_s)
    } else {
        // the motor, which also lags, and the command's hold are in the total
        let known = vehicle.propulsion.mean_time_constant_s().map(|known_s| (known_s, 0.0));
        let (motor_s, unsure_s) =
            known.unwrap_or_else(|| unstated_motor(total_s - held_s(traces), (against_lag, against_delay)));
        (parts.delay_s - held_s(traces) - motor_s, std_s.hypot(unsure_s))
    };
    let (own, others) = if is_lag { (against_lag, against_delay) } else { (against_delay, against_lag) };
    // how much of a delay is the motor's own lag is not known of a vehicle that states none
    let stated = is_lag || vehicle.propulsion.mean_time_constant_s().is_some();
    // the motor's own lag may be all of it
    if !stated && value < CERTAIN * std {
        return None;
    }
    let told_apart = stated && others > LATENCY_APART && own < 0.5 * REFUSED;
    let z = (total_s - ordinary_s) / found.latency.std_s.hypot(ORDINARY_STD_S);
    Some(Named {
        id: kind.id(),
        sentence: kind.effect.sentence(),
        parameters: parameters_of(parts, (name, value, std), uneven_std.filter(|_| is_lag)),
        strength: Strength { z, gain: 0.0, energy: z * z, count: 1 },
        confusable_with: if told_apart {
            Vec::new()
        } else {
            vec![Confusable {
                id: other.id(),
                // the same figure as that of the advice for the next flight
                distinguishability: latency_distance(traces, &found.after, kind.id())
                    .filter(|d| *d < LATENCY_APART),
            }]
        },
    })
}

/// Uncertainty of the inertial unit's delay, s: the largest of the flights.
fn unsure_s(traces: &[Trace]) -> f64 {
    traces.iter().map(|trace| trace.inertial_unsure_s).fold(0.0, f64::max)
}

/// Latency of sampling, sensors and a fast motor, or of the one that is stated, s: no name says so much.
fn ordinary_s(traces: &[Trace], vehicle: &Vehicle) -> f64 {
    let period_s = traces.iter().map(|trace| trace.command_period_s).fold(0.0, f64::max);
    let of_sensors_s = |trace: &Trace| trace.inertial_late_s + trace.inertial_unsure_s;
    let late_s = traces.iter().map(of_sensors_s).fold(0.0, f64::max);
    stated_lag_s(vehicle) + FAST_MOTOR_S + 0.5 * period_s + late_s
}

/// The vehicle's own latency by one flight where all of them gave it a name: delay and lag together, whatever the kind, without the
/// delay that the flight's log has.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FlightLatency {
    /// the name
    pub(super) id: &'static str,
    /// s, value and standard error
    pub(super) estimate: (f64, f64),
    /// s, part of that error which goes the same way in every flight
    pub(super) common_std: f64,
    /// s, up to which it is ordinary
    pub(super) ordinary_s: f64,
}

impl FlightLatency {
    /// `total_s` and its standard error with the delay `held_s` of the log in it, ordinary up to `ordinary_s`, where the delay of the
    /// inertial unit is uncertain by `unsure_s`, all s. What every vehicle has, how far the law of a lag holds and that delay are known
    /// no better from several flights.
    fn new(
        id: &'static str,
        (total_s, std_s): (f64, f64),
        held_s: f64,
        (ordinary_s, unsure_s): (f64, f64),
    ) -> Self {
        let common_std = ORDINARY_STD_S.hypot(FORM * total_s).hypot(unsure_s);
        let estimate = (total_s - held_s, std_s.hypot(common_std));
        Self { id, estimate, common_std, ordinary_s: ordinary_s - held_s }
    }
}

/// The latency of one flight, fitted alone to the model `base`. `None` where the flights' latency has no name, where the flight does not
/// determine it, and where it is from measured rotor speeds to the motion: no motor is in it then.
///
/// # Errors
/// [`PhysicsError`] where the base is not physical.
pub(super) fn flight_latency(
    (traces, base): (&[Trace], &Base),
    named: &[Named],
    vehicle: &Vehicle,
) -> Result<Option<FlightLatency>, PhysicsError> {
    let is_latency = |id| signature_of(id).is_some_and(|signature| signature.role.latency.is_some());
    let Some(id) = named.iter().map(|named| named.id).find(|id| is_latency(id)) else { return Ok(None) };
    if traces.iter().any(|trace| trace.measured_speeds) {
        return Ok(None);
    }
    let newton = if is_delay(base.latency, vehicle) { Newton::Delay } else { Newton::Free };
    let (_, own) = with_latency(traces, base.clone(), newton)?;
    let ordinary = (ordinary_s(traces, vehicle), unsure_s(traces));
    let of_flight = || FlightLatency::new(id, (own.total_s, own.std_s), held_s(traces), ordinary);
    Ok(own.is_determined().then(of_flight))
}

/// The latency of one flight as its explanation has it, named or not. `None` where the flight does not determine it, and where it is from
/// measured rotor speeds to the motion: no motor is in it then.
pub(super) fn latency_of(trace: &Trace, vehicle: &Vehicle, found: &LatencyFinding) -> Option<FlightLatency> {
    if !trace.torques || trace.measured_speeds || !found.is_determined() {
        return None;
    }
    let is_lag = found.parts.lag_s > found.parts.delay_s && !is_delay(found.parts, vehicle);
    let kind = latency_signature(if is_lag { LatencyKind::Lag } else { LatencyKind::Delay })?;
    let traces = std::slice::from_ref(trace);
    let ordinary = (ordinary_s(traces, vehicle), unsure_s(traces));
    Some(FlightLatency::new(kind.id(), (found.total_s, found.std_s), held_s(traces), ordinary))
}

/// Lag of motors of which nothing is stated, s, and its standard error: 12 to 50 ms in simulators' vehicles and on
/// thrust stands.
const UNSTATED_MOTOR_S: (f64, f64) = (0.025, 0.015);

/// Lag of the motors within a latency behind the delay of the recording, s, and its standard error, if none is stated. Its square is
/// what the second order of the latency lacks of a pure delay's, which is `against_delay` standard errors; a pure lag is
/// `against_lag` of them away.
fn unstated_motor(behind_s: f64, (against_lag, against_delay): (f64, f64)) -> (f64, f64) {
    let told_s = if against_lag > 0.0 {
        behind_s * ((against_delay + WITHIN) / against_lag).sqrt()
    } else {
        f64::INFINITY
    };
    let most_s = told_s.min(behind_s).max(0.0);
    if most_s < 2.0 * UNSTATED_MOTOR_S.0 { (0.5 * most_s, most_s / 12_f64.sqrt()) } else { UNSTATED_MOTOR_S }
}

/// Root mean square of the delay that may be in a latency that goes as a lag, s: from none to what its second order allows.
fn unseen_delay_s(total_s: f64, (against_lag, against_delay): (f64, f64)) -> f64 {
    let told =
        if against_delay > 0.0 { ((against_lag + WITHIN) / against_delay).sqrt() } else { f64::INFINITY };
    (total_s * told.min(1.0)).min(USUAL_DELAY_S) / 3_f64.sqrt()
}

/// Delays of ordinary vehicles beside that of sampling are no longer, s. A period of 40 Hz: no control loop is
/// slower.
const USUAL_DELAY_S: f64 = 0.025;

/// Standard errors by which the second order may be off. The usual 95 %.
const WITHIN: f64 = 2.0;

/// Parameters of a lag by its rising and falling time constants if they are distinguished, otherwise by the latency as
/// a whole.
fn parameters_of(
    parts: ActuationLatency,
    (name, value, std): (&'static str, f64, f64),
    uneven_std: Option<f64>,
) -> Vec<NamedParameter> {
    let Some(uneven_std) = uneven_std else {
        return vec![NamedParameter { name, value, std, unit: "s" }];
    };
    let RotorLag { rising_s, falling_s } = parts.rotor_lag();
    // both of the mean's standard error and of the logarithm's of their ratio
    let by_uneven_s = rising_s * falling_s / (2.0 * parts.lag_s) * uneven_std;
    let of = |name, value: f64| {
        let std = (value / parts.lag_s * std).hypot(by_uneven_s);
        NamedParameter { name, value, std, unit: "s" }
    };
    vec![of(name, rising_s), of("time_constant_down", falling_s)]
}

/// Standard error of the latency that every vehicle has, s: low-passes of gyroscopes at 30 to 80 Hz delay by 2 to 7 ms.
const ORDINARY_STD_S: f64 = 0.0025;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flights_latency_is_the_vehicles_and_not_that_of_its_log() {
        // the same motors in two logs, one of which holds commands and gyroscopes back by 8 ms more
        let [fast, slow] = [0.002, 0.010].map(|held_s| {
            FlightLatency::new("motor_lag", (0.04 + held_s, 0.001), held_s, (0.02 + held_s, 0.003))
        });
        for found in [fast, slow] {
            assert!((found.estimate.0 - 0.04).abs() < 1e-12 && (found.ordinary_s - 0.02).abs() < 1e-12);
            assert!((found.estimate.1 - 0.001_f64.hypot(found.common_std)).abs() < 1e-12);
        }
        // sqrt(2.5^2 + (0.02 * 42)^2 + 3^2) ms
        assert!((fast.common_std - 0.003_994_6).abs() < 1e-6, "{}", fast.common_std);
    }

    #[test]
    fn the_lag_of_unstated_motors_is_at_most_the_latency_and_what_its_second_order_allows() {
        let near = |(lag_s, std_s): (f64, f64), expected: (f64, f64)| {
            assert!(
                (lag_s - expected.0).abs() < 1e-6 && (std_s - expected.1).abs() < 1e-6,
                "{lag_s} {std_s}"
            );
        };
        // the second order is not told: what motors have, or half of a short latency
        near(unstated_motor(0.08, (0.0, 0.0)), UNSTATED_MOTOR_S);
        near(unstated_motor(0.02, (0.0, 0.0)), (0.01, 0.005_773_503));
        // 0.04 sqrt((0 + 2) / 200) = 0.004
        near(unstated_motor(0.04, (200.0, 0.0)), (0.002, 0.001_154_701));
        // 0.04 sqrt((6 + 2) / 200) = 0.008
        near(unstated_motor(0.04, (200.0, 6.0)), (0.004, 0.002_309_401));
    }
}
