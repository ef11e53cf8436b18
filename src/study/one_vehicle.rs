//! Whether flights that are given together can be those of one vehicle.

use super::StudyError;
use super::flight::Flight;
use crate::autopilot::RotorPlace;
use crate::note::{About, Note};
use crate::recording::Recording;

/// Parameters that state where the motors are: another value is another vehicle, or the same rebuilt.
const FRAME: [&str; 3] = ["FRAME_CLASS", "FRAME_TYPE", "CA_ROTOR_COUNT"];

/// Parameters that say how a vehicle is built: two vehicles that differ in one of them are of different types.
pub const AIRFRAME: [&str; 6] =
    ["SYS_AUTOSTART", "CA_AIRFRAME", "CA_ROTOR_COUNT", "MAV_TYPE", "FRAME_CLASS", "FRAME_TYPE"];
/// Parameters that say which one of a type it is.
pub const SERIAL: [&str; 5] =
    ["BRD_SERIAL_NUM", "CAL_ACC0_ID", "CAL_GYRO0_ID", "COMPASS_DEV_ID", "INS_ACC_ID"];
/// The same by the part that each is of: accelerometer and gyroscope are one.
const PARTS: [&[&str]; 3] =
    [&["BRD_SERIAL_NUM"], &["CAL_ACC0_ID", "CAL_GYRO0_ID", "INS_ACC_ID"], &["COMPASS_DEV_ID"]];

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

/// Flights of one answer are of one build: a log whose parameters put the rotors elsewhere is of another vehicle, or of the same
/// after it was rebuilt.
pub(super) fn refuse_other_builds<'a>(
    mut flights: impl Iterator<Item = &'a Flight> + Clone,
) -> Result<(), StudyError> {
    refuse_others(flights.clone())?;
    let Some(first) = flights.next() else { return Ok(()) };
    for flight in flights {
        if !are_elsewhere(&flight.recording, &first.recording) {
            continue;
        }
        return Err(StudyError::File {
            file: flight.input.path.clone(),
            why: format!(
                "expected flights of one vehicle, got a log whose parameters put the rotors elsewhere than those of {}: `mavid compare` \
                 says what changed between flights before and after",
                first.input.path
            ),
        });
    }
    Ok(())
}

/// A warning for each flight whose log states another airframe or other serial numbers than that of the first: such flights may be of
/// two vehicles, or of one that was rebuilt.
pub(super) fn doubt_one_vehicle<'a>(mut flights: impl Iterator<Item = &'a Flight>) -> Vec<Note> {
    let Some(first) = flights.next() else { return Vec::new() };
    flights.filter_map(|flight| other_parts(flight, first, |others| !others.is_empty())).collect()
}

/// The first of these warnings by which more than one part has another serial number: one that was replaced is no other vehicle.
pub(super) fn serials_apart<'a>(mut flights: impl Iterator<Item = &'a Flight>) -> Option<Note> {
    let first = flights.next()?;
    flights.find_map(|flight| other_parts(flight, first, |others| parts(others) > 1))
}

/// The warning that a flight's log states other parts than that of `first`, if those are `enough`.
fn other_parts(flight: &Flight, first: &Flight, enough: impl Fn(&[&str]) -> bool) -> Option<Note> {
    let others = stated_otherwise(&flight.recording, &first.recording);
    let text = || {
        format!(
            "{} not as in {}: these flights are of two vehicles, or parts were replaced between them",
            others.join(", "),
            first.input.path
        )
    };
    enough(&others).then(|| Note::warning(About::File(flight.input.path.clone()), text()))
}

/// Parts of which these are serial numbers.
fn parts(names: &[&str]) -> usize {
    PARTS.iter().filter(|part| names.iter().any(|name| part.contains(name))).count()
}

/// What identifies a vehicle and is stated in both logs, otherwise in `one` than in `other`.
fn stated_otherwise(one: &Recording, other: &Recording) -> Vec<&'static str> {
    let is_other = |name: &&str| {
        let value = |recording: &Recording| recording.parameters.get(*name).copied();
        value(one).zip(value(other)).is_some_and(|(one, other)| one != other)
    };
    AIRFRAME.into_iter().chain(SERIAL).filter(is_other).collect()
}

/// The rotors of both are stated, and not at the same places.
fn are_elsewhere(one: &Recording, other: &Recording) -> bool {
    let layout = |recording: &Recording| {
        let stack = recording.autopilot.stack()?;
        stack.geometry.layout(&|name| recording.parameters.get(name).copied(), None).ok()
    };
    let Some((one, other)) = layout(one).zip(layout(other)) else { return false };
    let is_same = |(a, b): (&RotorPlace, &RotorPlace)| {
        a.ccw == b.ccw && a.place.iter().zip(b.place).all(|(a, b)| (a - b).abs() < SAME)
    };
    one.unit == other.unit
        && !(one.rotors.len() == other.rotors.len() && one.rotors.iter().zip(&other.rotors).all(is_same))
}

/// Places in single precision that differ by less are the same, m or shares.
const SAME: f64 = 1e-6;

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

    #[test]
    fn another_serial_number_is_told_and_one_that_is_not_stated_is_not() {
        let of = |values: &[(&str, f64)]| Recording {
            parameters: values.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect(),
            ..Recording::default()
        };
        let one = of(&[("SYS_AUTOSTART", 4001.0), ("CAL_ACC0_ID", 1.0), ("MPC_THR_HOVER", 0.5)]);
        let same = of(&[("SYS_AUTOSTART", 4001.0), ("CAL_GYRO0_ID", 7.0), ("MPC_THR_HOVER", 0.4)]);
        let other = of(&[("SYS_AUTOSTART", 4500.0), ("CAL_ACC0_ID", 2.0)]);
        assert_eq!(stated_otherwise(&one, &same), Vec::<&str>::new());
        assert_eq!(stated_otherwise(&other, &one), ["SYS_AUTOSTART", "CAL_ACC0_ID"]);
    }

    #[test]
    fn a_compass_that_was_replaced_is_one_part_and_with_an_accelerometer_it_is_two() {
        assert_eq!(parts(&["COMPASS_DEV_ID"]), 1);
        assert_eq!(parts(&["CAL_ACC0_ID", "CAL_GYRO0_ID"]), 1);
        assert_eq!(parts(&["SYS_AUTOSTART", "COMPASS_DEV_ID"]), 1);
        assert_eq!(parts(&["COMPASS_DEV_ID", "INS_ACC_ID"]), 2);
    }

    #[test]
    fn rotors_that_stand_elsewhere_are_another_build() {
        let of = |x_m: f64| {
            let count = [("CA_ROTOR_COUNT".to_owned(), 2.0)];
            let rotors = (0..2_u8).flat_map(|rotor| {
                let side = f64::from(rotor) - 0.5;
                let value = [("PX", x_m * side), ("PY", side), ("KM", 0.05)];
                value.map(|(end, value)| (format!("CA_ROTOR{rotor}_{end}"), value))
            });
            let parameters = count.into_iter().chain(rotors).collect();
            Recording { autopilot: Autopilot::Px4, parameters, ..Recording::default() }
        };
        assert!(!are_elsewhere(&of(0.2), &of(0.2)));
        assert!(are_elsewhere(&of(0.2), &of(0.25)));
        assert!(!are_elsewhere(&of(0.2), &Recording { autopilot: Autopilot::Px4, ..Recording::default() }));
    }
}
