//! The explained model and the rigid body on hold-out flights, and on those that were used.

use super::bootstrap::Interval;
use super::carried::{carried_over, pair};
use super::error::HoldoutError;
use super::open_loop::OpenLoop;
use super::ready::{Ready, trace_of};
use super::settings::{HeldOut, HoldoutSettings};
use super::shown::HoldoutFit;
use super::{closed_loop, open_loop, other_vehicle, weak};
use crate::diagnose::empirical::Empirical;
use crate::diagnose::explanation::Explanation;
use crate::vehicle::Vehicle;

/// Compares the explained model with the rigid body alone on hold-out flights. `empirical` acts in addition to the
/// better model if no mechanism was found.
///
/// # Errors
/// [`HoldoutError`] where a flight lacks streams or is too short.
pub fn on_holdout(
    (explanation, empirical): (&Explanation, Option<&Empirical>),
    flights: &[HeldOut],
    vehicle: &Vehicle,
    settings: &HoldoutSettings,
) -> Result<HoldoutFit, HoldoutError> {
    let _stage = tracing::info_span!("predict", holdout = true, flights = flights.len()).entered();
    let mut ready = Vec::with_capacity(flights.len());
    for flight in flights {
        let trace = trace_of(flight, vehicle, settings)?;
        let pair = carried_over((explanation, empirical), (flight, &trace), vehicle, settings)?;
        ready.push(Ready { flight, trace, pair });
    }
    if ready.is_empty() {
        return Err(HoldoutError::NoFlight);
    }
    let mut notes: Vec<String> = ready.iter().flat_map(|ready| ready.pair.notes.clone()).collect();
    // what cannot be played back still has its residuals
    let (open_loop, improvement_percent, blocks, no_open_loop) =
        match open_loop::open_loop(&ready, empirical, settings) {
            Ok((open_loop, improvement, blocks)) => (open_loop, improvement, blocks, None),
            Err(why @ HoldoutError::Compare { .. }) => (Vec::new(), None, 0, Some(why.to_string())),
            Err(other) => return Err(other),
        };
    let weak = weak::residuals(&ready, explanation, empirical, settings)?;
    let (agreement, other_vehicle) = other_vehicle::judged(&ready, explanation, &weak, settings.same_flight)?;
    let closed_loop = closed_loop::flown_again(&ready, empirical, vehicle, settings);
    let improvement = improvement_percent.map(|improvement| improvement.value);
    let another = other_vehicle.is_some();
    tracing::info!(improvement_percent = improvement, blocks, other_vehicle = another, "hold-out predicted");
    notes.push(
        "the floor is the error that white noise of the sensors and of the logged commands would cause with the right \
         model; noise that an autopilot's estimator has smoothed is not included"
            .to_owned(),
    );
    Ok(HoldoutFit {
        flights: ready.len(),
        blocks,
        open_loop,
        no_open_loop,
        improvement_percent,
        weak: weak.compared,
        closed_loop,
        agreement,
        other_vehicle,
        notes,
    })
}

/// The same open-loop errors on the flights that were used, for comparison.
///
/// # Errors
/// [`HoldoutError`] where a flight cannot be played back.
pub fn on_identification(
    (explanation, empirical): (&Explanation, Option<&Empirical>),
    flights: &[HeldOut],
    vehicle: &Vehicle,
    settings: &HoldoutSettings,
) -> Result<(Vec<OpenLoop>, Option<Interval>), HoldoutError> {
    let _stage = tracing::info_span!("predict", holdout = false, flights = flights.len()).entered();
    let mut ready = Vec::with_capacity(flights.len());
    for flight in flights {
        let trace = trace_of(flight, vehicle, settings)?;
        let pair = pair((explanation, empirical), vehicle, trace.command_period_s);
        ready.push(Ready { flight, trace, pair });
    }
    let (open_loop, improvement, _) = open_loop::open_loop(&ready, empirical, settings)?;
    Ok((open_loop, improvement))
}
