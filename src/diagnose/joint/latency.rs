//! Named lag and delay: the kind is kept, and their sum is estimated with everything else.

use super::requested::RequestedEffects;
use crate::diagnose::base::Base;
use crate::diagnose::fit::{Fitted, Newton, fit};
use crate::diagnose::latency::{LatencyFinding, lag_column};
use crate::diagnose::latency_parts::{held_s, stated_lag_s, stated_uneven};
use crate::diagnose::signature::LatencyKind;
use crate::diagnose::signatures::latency_kind;
use crate::diagnose::trace::Trace;
use crate::physics::{ActiveEffect, ActuationLatency, PhysicsError};
use crate::vehicle::Vehicle;

/// Least lag while it is estimated, s, so that its column does not vanish. Far below any motor's.
pub(super) const LEAST_LAG_S: f64 = 1e-4;
/// Largest number of passes over the share of the lag. A number of steps: only the time of a search and its last
/// digits depend on it.
const PASSES: usize = 8;
/// A share that moves by less than this many standard errors has converged. A twentieth of the error changes nothing
/// that is told.
const CONVERGED: f64 = 0.05;

/// Standard errors of lag and delay where both were named, s.
pub(super) type Split = Option<(f64, f64)>;

/// Start value of the latency, and how it is estimated. A kind that was not named has its stated value.
pub(super) fn held_as(
    wanted: &RequestedEffects,
    flights: &[Trace],
    (vehicle, known): (&Vehicle, &[ActiveEffect]),
    first: LatencyFinding,
    found: ActuationLatency,
) -> (ActuationLatency, Newton) {
    let of_file = |kind: LatencyKind| {
        let known = known.iter().find(|of| latency_kind(of.effect().id()) == Some(kind));
        // a lag's two time constants by their mean
        known.map(|of| of.parameters().iter().sum::<f64>() / of.parameters().len().max(1) as f64)
    };
    let held_s = held_s(flights);
    let uneven = stated_uneven(vehicle);
    let beyond_s = first.total_s - held_s;
    match (wanted.has_latency(LatencyKind::Lag), wanted.has_latency(LatencyKind::Delay)) {
        (false, false) => (found, Newton::Free),
        (true, false) => {
            let delay_s = of_file(LatencyKind::Delay).unwrap_or(0.0);
            let lag_s = (beyond_s - delay_s).max(10.0 * LEAST_LAG_S);
            (ActuationLatency { delay_s: delay_s + held_s, lag_s, uneven }, Newton::Free)
        }
        (false, true) => {
            let lag_s = of_file(LatencyKind::Lag).unwrap_or_else(|| stated_lag_s(vehicle));
            (ActuationLatency { delay_s: first.total_s - lag_s, lag_s, uneven }, Newton::Delay)
        }
        (true, true) => {
            let lag_s = (0.5 * beyond_s).max(10.0 * LEAST_LAG_S);
            (ActuationLatency { delay_s: first.total_s - lag_s, lag_s, uneven }, Newton::Delay)
        }
    }
}

/// Divides the sum if both kinds were named, by the smoothing that only a lag causes.
pub(super) fn split(
    flights: &[Trace],
    mut after: Fitted,
    wanted: &RequestedEffects,
) -> Result<(Fitted, Split), PhysicsError> {
    if !(wanted.has_latency(LatencyKind::Lag) && wanted.has_latency(LatencyKind::Delay)) {
        return Ok((after, None));
    }
    let mut lag_std_s = f64::INFINITY;
    for _ in 0..PASSES {
        let column = lag_column(flights, &after);
        let Some(evidence) = after.weighted.test(&[column]) else { break };
        lag_std_s = evidence.std(0);
        let before_s = after.base.latency.lag_s;
        let most_s = (after.base.latency.total_s() - held_s(flights)).max(LEAST_LAG_S);
        let lag_s = (before_s + evidence.theta[0]).clamp(LEAST_LAG_S, most_s);
        let latency =
            ActuationLatency { lag_s, delay_s: after.base.latency.total_s() - lag_s, ..after.base.latency };
        after = fit(flights, Base { latency, ..after.base }, Newton::Delay)?;
        if (lag_s - before_s).abs() < CONVERGED * lag_std_s {
            break;
        }
    }
    let total_std_s = crate::diagnose::latency::finding_of(&after).std_s;
    Ok((after, Some((lag_std_s, lag_std_s.hypot(total_std_s)))))
}
