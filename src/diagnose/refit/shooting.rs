//! Multiple shooting from what an explanation found.

use super::error::RefitError;
use super::parameters::Unknowns;
use super::result::{Refit, Refitted};
use super::settings::RefitSettings;
use super::{segments, solve};
use crate::diagnose::explanation::Explanation;
use crate::diagnose::fit::Fitted;
use crate::diagnose::holdout::state_noise;
use crate::diagnose::trace::Trace;
use crate::physics::Airframe;
use crate::signals::Signals;
use crate::vehicle::Vehicle;

/// Refits what an explanation found on the flights that it was found in.
///
/// # Errors
/// [`RefitError`] where the flights do not allow it.
pub fn refit(
    explanation: &Explanation,
    flights: &[Signals],
    vehicle: &Vehicle,
    settings: &RefitSettings,
) -> Result<Refit, RefitError> {
    let traces: Vec<Trace> = flights
        .iter()
        .map(|signals| Trace::new(signals, vehicle, settings.half_width_s))
        .collect::<Result<_, _>>()?;
    if !traces.iter().all(|trace| trace.known.velocity && trace.known.attitude) {
        return Err(RefitError::NotMeasured);
    }
    let fitted = &explanation.search.after;
    let airframe = Airframe::new(&fitted.base.vehicle)?;
    if let Some(own) = fitted.base.present.iter().find(|of| of.effect().state_count(&airframe) > 0) {
        return Err(RefitError::OwnStates { id: own.id() });
    }
    let unknowns = Unknowns::of(&fitted.base).ok_or(RefitError::NoBody)?;
    let segments = segments::cut(&traces, settings);
    if segments.len() < LEAST_SEGMENTS {
        let (segments, segment_s) = (segments.len(), settings.segment_s);
        return Err(RefitError::TooShort { segments, segment_s, needed: LEAST_SEGMENTS });
    }
    let noise: Vec<_> = flights.iter().map(state_noise).collect();
    let solution = solve::solve((&traces, &noise), &segments, &unknowns, settings)?;
    let weak = weak_values(fitted, &unknowns);
    let values = unknowns.natural(&solution.point);
    let parameters = unknowns
        .names()
        .into_iter()
        .enumerate()
        .map(|(index, (name, unit))| Refitted {
            name,
            unit,
            weak: weak[index].0,
            weak_std: weak[index].1,
            shooting: values[index],
            shooting_std: solution.covariance[(index, index)].max(0.0).sqrt(),
        })
        .collect();
    Ok(Refit { parameters, segments: segments.len(), cost: solution.cost })
}

/// Values and standard errors of the weak form, in the order of the unknowns.
fn weak_values(fitted: &Fitted, unknowns: &Unknowns) -> Vec<(f64, f64)> {
    let start = unknowns.natural(&unknowns.start());
    let columns = unknowns.weak_columns(fitted);
    start
        .into_iter()
        .zip(columns)
        .map(|(value, column)| {
            let std = column.map_or(f64::INFINITY, |index| fitted.covariance[(index, index)].max(0.0).sqrt());
            (value, std)
        })
        .collect()
}

/// Least number of segments for a covariance of their scores. Chosen; not measured.
const LEAST_SEGMENTS: usize = 12;
