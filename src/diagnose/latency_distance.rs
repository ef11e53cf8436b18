//! How far a latency is from the same latency of the other kind, in a set of flights.

use super::base::Base;
use super::evidence::Weighted;
use super::fit::Fitted;
use super::rows::Rows;
use super::signature::LatencyKind;
use super::signatures::latency_kind;
use super::trace::Trace;
use crate::physics::ActuationLatency;

/// Distance of the fitted latency, which has the name `named`, from the same latency of the other kind, standard deviations.
/// `None` where the rows of the other kind cannot be made.
#[must_use]
pub(super) fn latency_distance(traces: &[Trace], fitted: &Fitted, named: &str) -> Option<f64> {
    let other = turned(fitted.base.latency, named);
    let left = of_latency(traces, (&fitted.rows, &fitted.base), &fitted.weighted, other)?;
    Some(left / fitted.weighted.long_run_deviation())
}

/// The same latency, all of it of the other kind.
pub(super) fn turned(latency: ActuationLatency, named: &str) -> ActuationLatency {
    let (total_s, none) = (latency.total_s(), ActuationLatency::default());
    if latency_kind(named) == Some(LatencyKind::Lag) {
        ActuationLatency { delay_s: total_s, ..none }
    } else {
        ActuationLatency { lag_s: total_s, ..none }
    }
}

/// Norm of the part of another latency that the nuisances (a shift in time among them) do not explain, in standard deviations
/// of independent rows.
pub(super) fn of_latency(
    traces: &[Trace],
    (rows, base): (&Rows, &Base),
    weighted: &Weighted,
    latency: ActuationLatency,
) -> Option<f64> {
    let turned = Rows::new(traces, &Base { latency, ..base.clone() }).ok()?;
    let mut difference = turned.residual;
    for (difference, own) in difference.iter_mut().zip(&rows.residual) {
        difference.iter_mut().zip(own).for_each(|(difference, own)| *difference -= own);
    }
    Some(weighted.partialled(&[difference]).map_or(0.0, |(_, left)| left.norm()))
}
