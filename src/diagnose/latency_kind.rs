//! What a latency consists of, by its second order: a lag, a delay, or both.

use super::base::Base;
use super::fit::{Fitted, Newton, fit};
use super::latency_parts::{lag_of, stated_lag_s, stated_uneven};
use super::trace::Trace;
use crate::physics::{ActuationLatency, PhysicsError};

/// A split into delay and lag is rejected if a lag alone has a larger log-likelihood by this much a row. Something
/// else then caused the second-order term, for example commands at a bound. In rows of half a second, flights with
/// both kinds of latency differ by less than 0.15 either way, and a flight with half of its commands at a bound by
/// 2.2.
const SPLIT_REFUTED: f64 = 0.5;
/// A kind of latency is rejected beyond this many standard deviations. Set by judgement; measured only together with
/// all conditions of a name (see `Gates`).
pub(super) const REFUSED: f64 = 6.0;

/// Delay and lag of a latency of this total, s, by its second order: standard deviations against a lag and against a delay, and the delay of both
/// together, s.
///
/// # Errors
/// [`PhysicsError`] where the base is not physical.
pub(super) fn of_kind(
    flights: &[Trace],
    fitted: &Fitted,
    total_s: f64,
    (against_lag, against_delay, delay_s): (f64, f64, f64),
) -> Result<ActuationLatency, PhysicsError> {
    let both = against_lag > REFUSED && against_delay > REFUSED && (0.0..total_s).contains(&delay_s);
    // of two kinds that both serve, the one that the description states; where it states none, motors have a lag
    let uneven = stated_uneven(&fitted.base.vehicle);
    let propulsion = &fitted.base.vehicle.propulsion;
    let has_lag = propulsion.time_constant_down_s.is_some() || propulsion.mean_time_constant_s().is_none();
    let lag = lag_of(flights, total_s, uneven);
    if both {
        let split = ActuationLatency { delay_s, lag_s: total_s - delay_s, uneven };
        return not_refuted(split, lag, flights, fitted);
    }
    if against_lag < against_delay || (has_lag && against_lag < REFUSED) {
        return Ok(lag);
    }
    // behind the lag that is stated
    let lag_s = stated_lag_s(&fitted.base.vehicle).min(total_s);
    Ok(ActuationLatency { delay_s: total_s - lag_s, lag_s, uneven })
}

/// The split into delay and lag, or the lag alone if it explains the flight far better.
fn not_refuted(
    split: ActuationLatency,
    lag: ActuationLatency,
    flights: &[Trace],
    fitted: &Fitted,
) -> Result<ActuationLatency, PhysicsError> {
    let misfit = |latency| -> Result<f64, PhysicsError> {
        Ok(fit(flights, Base { latency, ..fitted.base.clone() }, Newton::Held)?.misfit())
    };
    let worse = misfit(split)? - misfit(lag)?;
    Ok(if worse > SPLIT_REFUTED * fitted.rows.len() as f64 { lag } else { split })
}
