//! Whether flights that are compared can be those of one vehicle, and are different flights.

use crate::note::Note;
use crate::recording::Recording;
use crate::signals::{clock_offset, other_settings};
use crate::study::StudyError;
use crate::study::flight::Flight;
use crate::study::flights::shared;

/// Parameters that state where the motors are: another value is another vehicle, or the same rebuilt.
const FRAME: [&str; 3] = ["FRAME_CLASS", "FRAME_TYPE", "CA_ROTOR_COUNT"];

/// Logs of different autopilots number the motors differently, and so do different frames.
pub(super) fn refuse_others<'a>(mut flights: impl Iterator<Item = &'a Flight>) -> Result<(), StudyError> {
    let Some(first) = flights.next() else { return Ok(()) };
    for flight in flights {
        let Some((own, other)) = differ(&flight.recording, &first.recording) else { continue };
        return Err(StudyError::File {
            file: flight.input.path.clone(),
            why: format!(
                "expected flights of one vehicle, got a log of {own} beside one of {other} ({})",
                first.input.path
            ),
        });
    }
    Ok(())
}

/// What the logs say of their vehicles, where it is not the same.
fn differ(one: &Recording, other: &Recording) -> Option<(String, String)> {
    let stack = |recording: &Recording| recording.autopilot.stack().map(|stack| stack.name.to_owned());
    if let (Some(own), Some(others)) = (stack(one), stack(other))
        && own != others
    {
        return Some((own, others));
    }
    FRAME.into_iter().find_map(|name| {
        let value = |recording: &Recording| recording.parameters.get(name).copied();
        let (own, others) = (value(one)?, value(other)?);
        (own != others).then(|| (format!("a vehicle with {name} {own}"), format!("{name} {others}")))
    })
}

/// A flight before and after is the same flight where one holds a part of the other, or where the vehicle logged the one and the
/// ground station the other of one flight. Two flights of one trajectory are alike, and are no such thing.
pub(super) fn refuse_same_flight(before: &[Vec<Flight>], after: &[Vec<Flight>]) -> Result<(), StudyError> {
    for later in after.iter().flatten() {
        for earlier in before.iter().flatten() {
            let is_same = shared(&later.recording, &earlier.recording).is_some()
                || earlier.logged_by != later.logged_by
                    && clock_offset(&earlier.recording, &later.recording).is_some();
            if is_same {
                let why = format!(
                    "expected another flight, but {} is another log of the flight of {}",
                    later.input.path, earlier.input.path
                );
                return Err(StudyError::Setting { name: "with", why });
            }
        }
    }
    Ok(())
}

/// Parameters of thrust and build that are not those of the first flight: told, because a repair may have changed them.
pub(super) fn settings_notes(recordings: &[Recording]) -> Vec<Note> {
    let Some((first, others)) = recordings.split_first() else { return Vec::new() };
    let others = others.iter().enumerate();
    others.filter_map(|(index, other)| other_settings((first, 1), (other, index + 2))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::autopilot::Autopilot;

    #[test]
    fn another_frame_or_autopilot_is_another_vehicle() {
        let of = |autopilot, class: f64| Recording {
            autopilot,
            parameters: [("FRAME_CLASS".to_owned(), class)].into(),
            ..Recording::default()
        };
        let quad = of(Autopilot::ArduPilot, 1.0);
        assert_eq!(differ(&quad, &quad), None);
        let said = differ(&of(Autopilot::ArduPilot, 2.0), &quad);
        assert_eq!(said, Some(("a vehicle with FRAME_CLASS 2".to_owned(), "FRAME_CLASS 1".to_owned())));
        assert_eq!(differ(&of(Autopilot::Px4, 1.0), &quad), Some(("PX4".to_owned(), "ArduPilot".to_owned())));
        assert_eq!(differ(&Recording::default(), &quad), None);
    }
}
