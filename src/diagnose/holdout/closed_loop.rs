//! Closed-loop simulation of the held-out flights from their setpoints, as in Table 4.

use super::bootstrap::{Blocks, Compared, Squares};
use super::ready::{Ready, model_of};
use super::settings::HoldoutSettings;
use crate::compare::{SIGNALS, TenSignals, autopilot_flight, divergence};
use crate::diagnose::base::Base;
use crate::diagnose::empirical::Empirical;
use crate::stats::white_level_of;
use crate::vehicle::Vehicle;

/// Errors of the ten signals against the recording. The autopilot's controller is not known. The simulator's own
/// controller flies both models, so only the difference of their errors is meaningful, not the size.
#[derive(Debug, Clone, PartialEq)]
pub struct ClosedLoop {
    /// in the order of [`SIGNALS`]; the floor is the recording's own white noise
    pub signals: Vec<Option<Compared>>,
}

/// Simulates both models for every flight; an error gives the reason if it is not possible.
pub(super) fn flown_again(
    ready: &[Ready],
    empirical: Option<&Empirical>,
    nominal: &Vehicle,
    settings: &HoldoutSettings,
) -> Result<ClosedLoop, String> {
    if empirical.is_some() {
        return Err("an empirical term is not simulated in closed loop".to_owned());
    }
    if ready.iter().any(|ready| !ready.trace.torques) {
        return Err("torques are not compared in flights that are logged so slowly".to_owned());
    }
    let mut blocks = Blocks::new(SIGNALS.len(), settings.block_s);
    let mut floors = [0.0; SIGNALS.len()];
    for (index, ready) in ready.iter().enumerate() {
        let named = |error: &dyn std::fmt::Display| format!("{}: {error}", ready.flight.name);
        let recording = ready
            .flight
            .recording
            .ok_or_else(|| named(&"part of a flight that was used is not simulated"))?;
        let recorded = TenSignals::of_signals(ready.flight.signals).map_err(|error| named(&error))?;
        let levels = noise_levels(&recorded);
        floors.iter_mut().zip(levels).for_each(|(floor, level)| *floor += level * level);
        let fly = |name: &str, base: &Base| -> Result<Vec<(f64, [f64; 10])>, String> {
            let model = model_of(base).map_err(|error| named(&error))?;
            let again = autopilot_flight(recording, &model, nominal).map_err(|error| named(&error))?;
            match divergence(&recorded, &again, span_s(ready)) {
                Some(how) => Err(named(&format!(
                    "the simulation of the {name} diverges from the flight: {how}; its errors say nothing about the model"
                ))),
                None => Ok(recorded.square_errors(&again, span_s(ready))),
            }
        };
        let (before, after) = ready.pair.predicting();
        let (before, after) =
            rayon::join(|| fly("rigid body alone", before), || fly("model with the effects", after));
        let from_s = ready.pair.predicted_from_s();
        for ((time_s, before), (_, after)) in
            before?.iter().zip(&after?).filter(|((time_s, _), _)| *time_s >= from_s)
        {
            let squares = Squares { unchanged: None, before, after, count: &[1.0; SIGNALS.len()] };
            blocks.add((index, *time_s), squares);
        }
    }
    if blocks.len() == 0 {
        return Err("recording and simulation share no instant".to_owned());
    }
    let mut signals = blocks.compared(settings.draws, settings.seed).0;
    let flights = ready.len() as f64;
    for (compared, floor) in signals.iter_mut().zip(floors) {
        if let Some(compared) = compared {
            compared.floor = Some((floor / flights).sqrt()).filter(|floor| floor.is_finite());
        }
    }
    Ok(ClosedLoop { signals })
}

/// Standard deviation of each signal's white noise in the recording, which no model can explain.
fn noise_levels(recorded: &TenSignals) -> [f64; SIGNALS.len()] {
    std::array::from_fn(|signal| {
        let series: Vec<f64> = recorded.values.iter().map(|values| values[signal]).collect();
        white_level_of(&series)
    })
}

/// From the first to the last usable instant.
fn span_s(ready: &Ready) -> (f64, f64) {
    let (usable, grid) = (&ready.trace.usable, &ready.trace.grid);
    let first = usable.iter().position(|usable| *usable).unwrap_or(0);
    let last = usable.iter().rposition(|usable| *usable).unwrap_or(0);
    (grid.time_s(first), grid.time_s(last))
}
