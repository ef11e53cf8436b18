//! Whether logs that are given together hold one flight twice.

use super::flight::Flight;
use super::{InputFile, StudyError};
use crate::recording::{Overlap, Quantity, Recording};
use crate::signals::{ReportedState, clock_offset, off_ground, spans};
use rayon::prelude::*;

/// Share of a flight's samples that may be in another one: none are, but for chance. A flight that shares more is the same flight, or
/// another part of it: as a hold-out it would be predicted from itself, beside the other it would count twice.
const MOST_SHARED: f64 = 0.02;

/// What a recording in the air is known by. On the ground does not count: a simulator repeats the noise of its sensors from its start.
fn in_the_air(of: &Recording) -> Overlap {
    let said = ReportedState::of(of);
    // before its first word nothing is said
    let first_word_s =
        said.words().and_then(|words| words.time_s.first()).copied().unwrap_or(f64::NEG_INFINITY);
    let may_fly = |t_s: f64| t_s >= first_word_s && said.may_be_off_ground(t_s);
    let inertial = of.streams.iter().filter(|(key, _)| key.quantity == Quantity::AngularRate);
    let time_s = inertial.map(|(_, stream)| &stream.time_s).max_by_key(|time_s| time_s.len());
    let flown =
        time_s.map_or_else(Vec::new, |time_s| off_ground(of, spans(time_s, |index| may_fly(time_s[index]))));
    let counts =
        |t_s: f64| flown.is_empty() || flown.iter().any(|(from_s, to_s)| (*from_s..*to_s).contains(&t_s));
    Overlap::of(of, counts)
}

/// The share (0..1) of a recording in the air that the other holds as well, where it is more than chance.
pub(super) fn shared(of: &Recording, other: &Recording) -> Option<f64> {
    Some(in_the_air(of).share_in(&in_the_air(other))).filter(|share| *share > MOST_SHARED)
}

/// The same flight twice is refused: the same file, one that holds a part of the flight of another, or of two logs that a vehicle and a
/// ground station wrote of one flight the one that was not put together with the other. `logs` are the flights of each. Two flights of
/// one trajectory are alike, and are no such thing.
pub(super) fn refuse_same_flight<'a>(
    logs: impl Iterator<Item = &'a Vec<Flight>> + Clone,
) -> Result<(), StudyError> {
    refuse_twins(logs.clone())?;
    // the flights of one log follow each other
    let (of_log, flights): (Vec<usize>, Vec<&Flight>) =
        logs.enumerate().flat_map(|(log, flights)| flights.iter().map(move |flight| (log, flight))).unzip();
    let overlaps: Vec<Overlap> = flights.par_iter().map(|flight| in_the_air(&flight.recording)).collect();
    let is_same = |one: usize, other: usize| {
        if of_log[one] == of_log[other] {
            return false;
        }
        let (own, others) = (&overlaps[one], &overlaps[other]);
        own.share_in(others).max(others.share_in(own)) > MOST_SHARED
            || flights[one].logged_by != flights[other].logged_by
                && clock_offset(&flights[one].recording, &flights[other].recording).is_some()
    };
    let twin =
        |&later: &usize| (0..later).find(|earlier| is_same(*earlier, later)).map(|earlier| (earlier, later));
    match (0..flights.len()).collect::<Vec<_>>().par_iter().find_map_first(twin) {
        None => Ok(()),
        Some((earlier, later)) => {
            let name = |place: usize| flights[place].input.path.clone();
            Err(StudyError::OneFlight { one: name(earlier), other: name(later) })
        }
    }
}

/// The same file twice is refused; `logs` are the flights of each.
pub(super) fn refuse_twins<'a>(logs: impl Iterator<Item = &'a Vec<Flight>>) -> Result<(), StudyError> {
    let inputs: Vec<&InputFile> = logs.filter_map(|log| log.first()).map(|flight| &flight.input).collect();
    for (index, input) in inputs.iter().enumerate() {
        if let Some(twin) = inputs[..index].iter().find(|other| other.sha256 == input.sha256) {
            return Err(StudyError::Twins { one: twin.path.clone(), other: input.path.clone() });
        }
    }
    Ok(())
}
