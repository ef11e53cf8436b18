//! Times of a flight's streams: the delay of the inertial unit, and the period of the commands.

use crate::recording::Quantity;
use crate::signals::Signals;

/// Delay of the inertial unit and its uncertainty, s: the common part if attitude and velocity are both early. If only
/// the attitude is early, its own time stamps may be the cause.
pub(super) fn inertial_late(signals: &Signals) -> (f64, f64) {
    let attitude_s = early_s(signals, Quantity::Attitude);
    match attitude_s.zip(early_s(signals, Quantity::Velocity)) {
        Some((attitude_s, velocity_s)) if attitude_s > 0.0 && velocity_s > 0.0 => {
            (attitude_s.min(velocity_s), (attitude_s - velocity_s).abs())
        }
        _ => (0.0, attitude_s.unwrap_or(0.0).max(0.0)),
    }
}

/// Advance of a quantity's time stamps relative to the inertial unit's, s, negative if they are late; `None` if the
/// offset was not corrected. An early quantity means that the gyroscopes are late.
fn early_s(signals: &Signals, of: Quantity) -> Option<f64> {
    let offset = signals.quality.offsets.iter().find(|(quantity, _)| *quantity == of);
    offset.filter(|(_, offset)| offset.repaired).map(|(_, offset)| -offset.late_s)
}

/// Sampling period of the stream from which the thrusts are computed, s.
pub(super) fn command_period_s(signals: &Signals) -> f64 {
    let of_thrust = |quantity: Quantity| matches!(quantity, Quantity::ActuatorCommand | Quantity::RotorSpeed);
    let rate_hz =
        signals.quality.sources.iter().find(|(quantity, ..)| of_thrust(*quantity)).map(|(.., rate)| *rate);
    rate_hz.filter(|rate_hz| *rate_hz > 0.0).map_or(signals.grid.step_s, |rate_hz| 1.0 / rate_hz)
}
