//! The flights that can be compared: what is too short, or was never flown, is left out where enough others remain.

use super::order::by_start_times;
use super::request::CompareRequest;
use super::result::LeftOut;
use crate::signals::{
    ConditionSettings, Differing, RotorDifference, STEP_FOR_EFFECTS_S, Signals, SignalsError,
    ThrustPreference, rotor_difference,
};
use crate::study::flight::Flight;
use crate::study::flights::{EXPLAINED, Prepared, load_each, ready};
use crate::study::unflown::unflown_first;
use crate::study::vehicle_given::{DRAFTED, Known};
use crate::study::{Progress, Stage, StudyError, VehicleGiven};
use crate::text;
use crate::trim::{LEAST_LEGS, LEG_S, Leg, TrimError, legs};
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
    /// they were given in another order than that of their start times
    pub(super) reordered: bool,
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
        let states_places = match self.vehicle {
            VehicleGiven::File(_) => true,
            VehicleGiven::Weighed(given) => given.frame.is_some(),
        };
        let make = |flight: &Flight| {
            if states_places {
                refuse_other_places(flight, vehicle)?;
            }
            made(flight, vehicle, &settings)
        };
        let groups = std::mem::take(&mut self.groups);
        let done = groups.map(|logs| logs.into_par_iter().map(|log| ready(log, make)).collect::<Vec<_>>());
        let mut out = [Vec::new(), Vec::new()];
        for (group, logs) in out.iter_mut().zip(done) {
            for log in logs {
                match log {
                    Ok(flights) => group.extend(flights),
                    Err(error) if is_of_the_flight(&error) => self.refused.push(error),
                    Err(error) => return Err(self.or_unflown(of_draft(error))),
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

    fn usable(self, [mut before, after]: [Vec<Made>; 2]) -> Usable {
        let (mut flights, mut legs, mut starts_utc_us) = (Prepared::default(), Vec::new(), Vec::new());
        let first = before.len();
        let has_one_clock = have_one_clock(before.iter().chain(&after));
        let start_utc_us = |flight: &Flight| flight.start_utc_us.filter(|_| has_one_clock);
        let reordered = after.is_empty() && by_start_times(&mut before, |(flight, _)| start_utc_us(flight));
        for (flight, (signals, of_flight)) in before.into_iter().chain(after) {
            starts_utc_us.push(start_utc_us(&flight));
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
            reordered,
            left_out: self.refused.iter().map(LeftOut::of).collect(),
        }
    }
}

/// Whether the start times of flights can be compared: the clock of a simulated vehicle is not that of the ground station.
fn have_one_clock<'a>(flights: impl Iterator<Item = &'a Made> + Clone) -> bool {
    let is_simulated = flights.clone().any(|(_, (signals, _))| signals.quality.simulated);
    let mut loggers = flights.map(|(flight, _)| flight.logged_by);
    let first = loggers.next();
    !is_simulated || loggers.all(|other| Some(other) == first)
}

/// Refuses a flight whose autopilot states other places, another order or other turning directions of the motors than the given vehicle has:
/// a rotor would be named by a place at which another one is.
fn refuse_other_places(flight: &Flight, (vehicle, file): (&Vehicle, &Path)) -> Result<(), StudyError> {
    let recording = &flight.recording;
    let difference = rotor_difference(recording.autopilot, &recording.parameters, vehicle);
    let is_of_place =
        |other: &RotorDifference| matches!(other.of, Differing::Order | Differing::Place | Differing::Spin);
    let Some(RotorDifference { file: has, stated, .. }) = difference.filter(is_of_place) else {
        return Ok(());
    };
    let why = format!(
        "the rotors contradict the autopilot's parameters: {stated}, the given vehicle (its file, or --frame) has {has}. Expected the rotors in \
         the order of the autopilot's motors, at their places and turning their way: give the file of the vehicle that flew (`mavid vehicle \
         init` drafts one from its log), correct its [[rotor]] entries, or leave --frame out"
    );
    Err(StudyError::File { file: format!("{} with {}", flight.input.path, text::path(&file)), why })
}

/// Conditioned, and cut into legs. A flight that ended early because an output left the mixer is told so.
fn made(
    flight: &Flight,
    vehicle: (&Vehicle, &Path),
    settings: &ConditionSettings,
) -> Result<(Signals, Vec<Leg>), StudyError> {
    let signals = flight.conditioned(vehicle, settings)?;
    let begins_s = signals.quality.airborne_s.first().map_or(f64::NEG_INFINITY, |(lifts_s, _)| *lifts_s);
    let begun = (begins_s, signals.grid.step_s);
    let legs = legs(&signals, vehicle.0)
        .map_err(|why| why.to_string())
        .and_then(|legs| without_beginning(legs, begun, settings.transient_s.unwrap_or_default()))
        .map_err(|why| {
            let warnings = flight.input.notes.iter().filter(|note| note.is_warning());
            let all: Vec<String> =
                std::iter::once(why).chain(warnings.map(|note| note.text.clone())).collect();
            StudyError::NoBalance { file: flight.input.path.clone(), why: all.join("; ") }
        })?;
    Ok((signals, legs))
}

/// The legs of a flight without those in its first `transient_s` after lift-off at `begins_s`, both s; a leg's middle is known to a step of the
/// grid, s. Otherwise why too few are left.
fn without_beginning(
    mut legs: Vec<Leg>,
    (begins_s, step_s): (f64, f64),
    transient_s: f64,
) -> Result<Vec<Leg>, String> {
    legs.retain(|leg| leg.time_s - 0.5 * LEG_S + step_s >= begins_s + transient_s);
    if legs.len() < LEAST_LEGS {
        let why = TrimError::TooShort { found: legs.len(), needed: LEAST_LEGS };
        return Err(format!(
            "{why} after the {transient_s} s that are left out at the beginning (--transient)"
        ));
    }
    Ok(legs)
}

/// A drafted vehicle by which nothing was flown has another mass than that which was given, or assumed.
fn of_draft(error: StudyError) -> StudyError {
    match error {
        StudyError::Flight { flight, vehicle, source, .. }
            if vehicle == DRAFTED && matches!(*source, SignalsError::ThrustTooLow { .. }) =>
        {
            let why = "the drafted vehicle contradicts the log: by it the rotors give less than its weight in this flight, and the log \
                       shows a flight. Give --mass (kg, with battery) and --size of the vehicle that flew, or --vehicle";
            StudyError::File { file: flight, why: why.to_owned() }
        }
        other => other,
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Ten legs one after the other from 3 s on, their middles at 4, 6, ... 22 s.
    fn ten() -> Vec<Leg> {
        let leg = |place: u32| Leg {
            time_s: 4.0 + LEG_S * f64::from(place),
            lean: [0.0; 3],
            felt: [0.0; 2],
            turning: [0.0; 3],
            rate: [0.0; 3],
            shares: vec![0.25; 4],
            lift: None,
            voltage_v: None,
        };
        (0..10).map(leg).collect()
    }

    #[test]
    fn legs_in_the_time_that_is_left_out_at_the_beginning_are_left_out() {
        let left = |transient_s: f64| without_beginning(ten(), (2.0, 0.02), transient_s);
        // lift-off at 2 s: with 1 s the first leg just counts, with 5 s that from 7 s on
        assert_eq!(left(1.0).unwrap().len(), 10);
        let legs = left(5.0).unwrap();
        assert!(legs.len() == 8 && legs[0].time_s == 8.0);
        let why = left(11.0).unwrap_err();
        assert!(
            why.contains("at least 6 legs of 2 s")
                && why.ends_with("got 5 after the 11 s that are left out at the beginning (--transient)")
        );
    }

    #[test]
    fn a_drafted_vehicle_that_does_not_lift_asks_for_the_mass_and_not_for_its_file() {
        let error = |vehicle: &str| StudyError::Flight {
            flight: "a.bin".to_owned(),
            vehicle: vehicle.to_owned(),
            source: Box::new(SignalsError::ThrustTooLow { most_n: 5.0, weight_n: 9.8, share: 0.5 }),
            losses: Vec::new(),
        };
        let said = of_draft(error(DRAFTED)).to_string();
        assert!(
            said.starts_with("a.bin: the drafted vehicle contradicts the log") && said.contains("--mass"),
            "{said}"
        );
        assert!(!said.contains("vehicle file"), "{said}");
        assert!(of_draft(error("own.toml")).to_string().contains("the vehicle file contradicts the log"));
    }
}
