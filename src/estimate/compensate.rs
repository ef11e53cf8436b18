//! Compensation of the commands for an estimated latency.

use super::weak::{Latency, LatencyKind};
use crate::physics::{ActuationLatency, delayed_thrusts_n, delayed_wrench};
use crate::signals::{Signals, ThrustSource};
use crate::vehicle::Vehicle;
use nalgebra::{DVector, Vector4};

/// Standard errors within which an estimated latency agrees with the stated lag. Two are too few: the stated lag has
/// an error that is not stated.
const AGREES: f64 = 4.0;
/// The same for a latency whose kind the flight does not determine. The usual 95 %.
const LEANS: f64 = 2.0;
/// Largest contribution of the log's sampling to both, s. Half a period of 100 Hz.
const SAMPLED_S: f64 = 0.005;

/// Division of a latency into delay and lag. A lag that agrees with the one of the vehicle file has its ratio of rising
/// and falling time constants. If the two kinds cannot be distinguished, the one that the file states is taken.
pub(super) fn compensation(found: &Latency, vehicle: &Vehicle) -> ActuationLatency {
    let none = ActuationLatency::default();
    let stated_s = vehicle.propulsion.mean_time_constant_s().unwrap_or(0.0);
    let as_stated = (found.total_s - stated_s).abs() < AGREES * found.std_s + SAMPLED_S;
    let uneven = if as_stated { vehicle.propulsion.falling_over_rising().ln() } else { 0.0 };
    match found.kind {
        LatencyKind::Lag => ActuationLatency { lag_s: found.total_s, uneven, ..none },
        LatencyKind::Undetermined if uneven != 0.0 && found.total_s > 0.0 => {
            ActuationLatency { lag_s: found.total_s, uneven, ..none }
        }
        LatencyKind::Both { delay_s } => {
            ActuationLatency { delay_s, lag_s: (found.total_s - delay_s).max(0.0), uneven }
        }
        LatencyKind::Delay | LatencyKind::Undetermined => ActuationLatency { delay_s: found.total_s, ..none },
    }
}

/// The lag of the vehicle file, if thrust is from commands and the flight neither shows a latency nor contradicts the
/// stated lag; none otherwise.
pub(super) fn as_stated(found: &Latency, vehicle: &Vehicle, flights: &[Signals]) -> ActuationLatency {
    let none = ActuationLatency::default();
    let by_commands = flights.iter().all(|signals| signals.quality.thrust_source == ThrustSource::Command);
    match vehicle.propulsion.mean_time_constant_s() {
        Some(lag_s) if by_commands && (found.total_s - lag_s).abs() < LEANS * found.std_s + SAMPLED_S => {
            ActuationLatency { lag_s, uneven: vehicle.propulsion.falling_over_rising().ln(), ..none }
        }
        _ => none,
    }
}

/// Delays the commands by the latency: the wrench is then that on the body.
pub(super) fn take_out(signals: &mut Signals, vehicle: &Vehicle, latency: ActuationLatency) {
    let step_s = signals.grid.step_s;
    if let Some(jitter) = &mut signals.jitter_wrench {
        *jitter = delayed_wrench(jitter, step_s, latency).into();
    }
    signals.wrench = uneven_wrench(signals, vehicle, latency)
        .unwrap_or_else(|| delayed_wrench(&signals.wrench, step_s, latency))
        .into();
}

/// Wrench of rotors that slow down more slowly than they speed up, minus half of that of the jitter, which is behind
/// the latency already (N, N m). `None` for symmetric rotors, or if the log has no rotor commands.
fn uneven_wrench(
    signals: &Signals,
    vehicle: &Vehicle,
    latency: ActuationLatency,
) -> Option<Vec<Vector4<f64>>> {
    let rotors = vehicle.rotors.len();
    if latency.uneven == 0.0 || latency.lag_s <= 0.0 || signals.rotor_thrust_n.is_empty() {
        return None;
    }
    let mixer = vehicle.mixer();
    let thrusts_n = delayed_thrusts_n(&signals.rotor_thrust_n, rotors, signals.grid.step_s, latency);
    let wrench = thrusts_n.chunks_exact(rotors).enumerate().map(|(index, thrusts_n)| {
        let all = &mixer.matrix * DVector::from_column_slice(thrusts_n);
        let half = signals.jitter_wrench.as_ref().map_or_else(Vector4::zeros, |jitter| 0.5 * jitter[index]);
        Vector4::new(all[0], all[1], all[2], all[3]) - half
    });
    Some(wrench.collect())
}
