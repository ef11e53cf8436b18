//! The flights that can be compared: what is too short, or was never flown, is left out where enough others remain.

use super::request::CompareRequest;
use super::result::LeftOut;
use crate::signals::{ConditionSettings, STEP_FOR_EFFECTS_S, Signals, SignalsError, ThrustPreference};
use crate::study::flight::Flight;
use crate::study::flights::{EXPLAINED, Prepared, load_each, ready};
use crate::study::unflown::unflown_first;
use crate::study::vehicle_given::Known;
use crate::study::{Progress, Stage, StudyError, VehicleGiven};
use crate::trim::{Leg, legs};
use crate::vehicle::Vehicle;
use rayon::prelude::*;
use std::path::Path;

/// The flights that were given, as they were read.
pub(super) struct Given<'a> {
    request: &'a CompareRequest,
    vehicle: &'a VehicleGiven,
    /// before and after
    pub(super) groups: [Vec<Vec<Flight>>; 2],
    /// why logs are not among them
    refused: Vec<StudyError>,
}

/// The flights that are compared.
pub(super) struct Usable {
    pub(super) flights: Prepared,
    /// of each flight
    pub(super) legs: Vec<Vec<Leg>>,
    /// when each began, microseconds since 1970 UTC, where its log says so
    pub(super) starts_utc_us: Vec<Option<u64>>,
    /// so many of them are of before
    pub(super) first: usize,
    pub(super) left_out: Vec<LeftOut>,
}

/// A flight with what its balance rests on.
type Made = (Flight, (Signals, Vec<Leg>));

impl<'a> Given<'a> {
    /// Reads the logs.
    pub(super) fn load(request: &'a CompareRequest, vehicle: &'a VehicleGiven) -> Result<Self, StudyError> {
        let (mut before, mut refused) = load_each(&request.before, &request.read, &EXPLAINED)?;
        let (mut after, of_after) = load_each(&request.after, &request.read, &EXPLAINED)?;
        refused.extend(of_after);
        vehicle.own_units(&mut before);
        vehicle.own_units(&mut after);
        let mut given = Self { request, vehicle, groups: [before, after], refused };
        let left = given.groups.each_ref().map(Vec::len);
        given.refuse_too_few(left)?;
        Ok(given)
    }

    /// All flights, those before first.
    pub(super) fn each(&self) -> impl Iterator<Item = &Flight> + Clone {
        self.groups.iter().flatten().flatten()
    }

    /// Conditions the flights for the vehicle, and for the one that is drafted from the first flight that can be used, where it is drafted.
    pub(super) fn conditioned(
        mut self,
        known: Option<Known>,
        progress: &dyn Progress,
    ) -> Result<(Usable, Known), StudyError> {
        let mut known = self.known(known)?;
        progress.stage(Stage::Conditioning);
        loop {
            let first = self.each().next().map(|flight| flight.input.path.clone());
            let [before, after] = self.made(&known)?;
            self.refuse_too_few([before.len(), after.len()])?;
            let drafted_from = before.first().map(|(flight, _)| flight.input.path.clone());
            if known.draft.is_none() || drafted_from == first {
                return Ok((self.usable([before, after]), known));
            }
            let each_alone = |made: Vec<Made>| made.into_iter().map(|(flight, _)| vec![flight]).collect();
            self.groups = [each_alone(before), each_alone(after)];
            known = self.known(None)?;
        }
    }

    fn known(&self, known: Option<Known>) -> Result<Known, StudyError> {
        self.vehicle.of_flights(known, &self.groups[0]).map_err(|error| self.or_unflown(error))
    }

    /// The flights of both groups that can be used; why the others cannot is kept.
    fn made(&mut self, known: &Known) -> Result<[Vec<Made>; 2], StudyError> {
        let settings = ConditionSettings {
            transient_s: Some(self.request.transient_s),
            thrust: ThrustPreference::Commands,
            least_step_s: STEP_FOR_EFFECTS_S,
            ..ConditionSettings::default()
        };
        let vehicle = (&known.loaded.vehicle, known.origin.as_path());
        let make = |flight: &Flight| made(flight, vehicle, &settings);
        let groups = std::mem::take(&mut self.groups);
        let done = groups.map(|logs| logs.into_par_iter().map(|log| ready(log, make)).collect::<Vec<_>>());
        let mut out = [Vec::new(), Vec::new()];
        for (group, logs) in out.iter_mut().zip(done) {
            for log in logs {
                match log {
                    Ok(flights) => group.extend(flights),
                    Err(error) if is_of_the_flight(&error) => self.refused.push(error),
                    Err(error) => return Err(self.or_unflown(error)),
                }
            }
        }
        Ok(out)
    }

    /// Flights are left out where two others are left, and with groups one in each.
    fn refuse_too_few(&mut self, [before, after]: [usize; 2]) -> Result<(), StudyError> {
        let is_enough = before > 0 && before + after >= 2 && (after > 0 || self.request.after.is_empty());
        if is_enough || self.refused.is_empty() {
            return Ok(());
        }
        let first = self.refused.swap_remove(0);
        Err(self.or_unflown(first))
    }

    fn or_unflown(&self, error: StudyError) -> StudyError {
        if matches!(error, StudyError::NoBalance { .. }) {
            return error;
        }
        let paths: Vec<_> = self.request.before.iter().chain(&self.request.after).cloned().collect();
        unflown_first(error, &paths, &self.request.read)
    }

    fn usable(self, [before, after]: [Vec<Made>; 2]) -> Usable {
        let (mut flights, mut legs, mut starts_utc_us) = (Prepared::default(), Vec::new(), Vec::new());
        let first = before.len();
        for (flight, (signals, of_flight)) in before.into_iter().chain(after) {
            starts_utc_us.push(flight.start_utc_us);
            flights.recordings.push(flight.recording);
            flights.inputs.push(flight.input);
            flights.signals.push(signals);
            legs.push(of_flight);
        }
        Usable {
            flights,
            legs,
            starts_utc_us,
            first,
            left_out: self.refused.iter().map(LeftOut::of).collect(),
        }
    }
}

/// Conditioned, and cut into legs. A flight that ended early because an output left the mixer is told so.
fn made(
    flight: &Flight,
    vehicle: (&Vehicle, &Path),
    settings: &ConditionSettings,
) -> Result<(Signals, Vec<Leg>), StudyError> {
    let signals = flight.conditioned(vehicle, settings)?;
    let legs = legs(&signals, vehicle.0).map_err(|why| {
        let warnings = flight.input.notes.iter().filter(|note| note.is_warning());
        let all: Vec<String> =
            std::iter::once(why.to_string()).chain(warnings.map(|note| note.text.clone())).collect();
        StudyError::NoBalance { file: flight.input.path.clone(), why: all.join("; ") }
    })?;
    Ok((signals, legs))
}

/// Whether the flight itself cannot be used, and not the vehicle file with any flight.
fn is_of_the_flight(error: &StudyError) -> bool {
    match error {
        StudyError::NoBalance { .. } | StudyError::NoFlight { .. } => true,
        StudyError::Flight { source, .. } => {
            !matches!(**source, SignalsError::OtherRotors { .. } | SignalsError::ThrustTooLow { .. })
        }
        _ => false,
    }
}
