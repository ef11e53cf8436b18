//! Of what a latency consists where the flight does not tell it: delays of the recording, and the lag that the vehicle file states.

use super::latency_name::{is_long, ordinary_s};
use super::trace::Trace;
use crate::physics::ActuationLatency;
use crate::vehicle::Vehicle;

/// Delay of the mean command, as a share of the log's period. A command is held until the next one, and the control
/// loop runs faster than the log.
const HELD: f64 = 0.25;
/// A lag after the delay of the recording itself.
pub(super) fn lag_of(flights: &[Trace], total_s: f64, uneven: f64) -> ActuationLatency {
    let delay_s = held_s(flights).min(0.5 * total_s);
    ActuationLatency { delay_s, lag_s: total_s - delay_s, uneven }
}

/// The latency where noise that is fed back hides its kind. With a stated lag, an ordinary rest is that of stamps, filters and sampling: a
/// delay. For a lag in its place moments of inertia come out too small, by the lag times that delay times the square of the motion's
/// frequency. What is longer than ordinary is the motors'.
pub(super) fn not_told(
    flights: &[Trace],
    (total_s, std_s): (f64, f64),
    vehicle: &Vehicle,
) -> ActuationLatency {
    let (stated_s, uneven) = (stated_lag_s(vehicle), stated_uneven(vehicle));
    if stated_s > 0.0 && !is_long((total_s, std_s), ordinary_s(flights, vehicle)) {
        let lag_s = stated_s.min(total_s);
        return ActuationLatency { delay_s: total_s - lag_s, lag_s, uneven };
    }
    lag_of(flights, total_s, uneven)
}

/// Delay that is not the vehicle's, s: held commands and the filters of the inertial unit.
pub(super) fn held_s(flights: &[Trace]) -> f64 {
    let held = |trace: &Trace| HELD * trace.command_period_s + trace.inertial_late_s;
    flights.iter().map(held).fold(0.0, f64::max)
}

/// [`ActuationLatency::uneven`] by the vehicle file.
pub(super) fn stated_uneven(vehicle: &Vehicle) -> f64 {
    vehicle.propulsion.falling_over_rising().ln()
}

/// Mean of the stated time constants, s; 0 where none is stated.
pub(super) fn stated_lag_s(vehicle: &Vehicle) -> f64 {
    vehicle.propulsion.mean_time_constant_s().unwrap_or(0.0)
}

/// Whether the latency is a delay: its lag is not larger than the stated one.
pub(super) fn is_delay(latency: ActuationLatency, vehicle: &Vehicle) -> bool {
    latency.lag_s <= stated_lag_s(vehicle)
}
