//! Of what a latency consists where the flight does not tell it: delays of the recording, and the lag that the vehicle file states.

use super::trace::Trace;
use crate::physics::ActuationLatency;
use crate::vehicle::Vehicle;

/// Most that is taken for the time between two motor commands, s: the control loops of PX4 and of ArduPilot's copters run at 400 Hz unless a parameter says
/// otherwise. A log that has commands at a lower rate leaves some out.
const LOOP_S: f64 = 1.0 / 400.0;

/// A lag after the delay of the recording itself.
pub(super) fn lag_of(flights: &[Trace], total_s: f64, uneven: f64) -> ActuationLatency {
    let delay_s = held_s(flights).min(0.5 * total_s);
    ActuationLatency { delay_s, lag_s: total_s - delay_s, uneven }
}

/// Delay that is not the vehicle's, s: a command is held until the next one, which delays it by half of the time between them at the
/// mean, and the filters of the inertial unit.
pub(super) fn held_s(flights: &[Trace]) -> f64 {
    let held = |trace: &Trace| 0.5 * trace.command_period_s.min(LOOP_S) + trace.inertial_late_s;
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
