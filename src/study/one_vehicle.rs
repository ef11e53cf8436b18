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
pub(super) fn refuse_others<'a>(flights: impl Iterator<Item = &'a Flight>) -> Result<(), StudyError> {
    let flights: Vec<&Flight> = flights.collect();
    let Some((place, earlier, (own, other))) = first_pair(&recordings(&flights), differ) else {
        return Ok(());
    };
    Err(StudyError::File {
        file: flights[place].input.path.clone(),
        why: format!(
            "expected flights of one vehicle, got a log of {own} beside one of {other} ({})",
            flights[earlier].input.path
        ),
    })
}

/// Flights of one answer are of one build: a log whose parameters put the rotors elsewhere is of another vehicle, or of the same
/// after it was rebuilt.
pub(super) fn refuse_other_builds<'a>(
    flights: impl Iterator<Item = &'a Flight> + Clone,
) -> Result<(), StudyError> {
    refuse_others(flights.clone())?;
    let flights: Vec<&Flight> = flights.collect();
    let elsewhere = |one: &Recording, other: &Recording| are_elsewhere(one, other).then_some(());
    let Some((place, earlier, ())) = first_pair(&recordings(&flights), elsewhere) else { return Ok(()) };
    Err(StudyError::File {
        file: flights[place].input.path.clone(),
        why: format!(
            "expected flights of one vehicle, got a log whose parameters put the rotors elsewhere than those of {}: `mavid compare` \
             says what changed between flights before and after",
            flights[earlier].input.path
        ),
    })
}

/// The first flight that differs from one before it, that one, and how: a log that states nothing differs from none, so the first flight
/// does not speak for all.
fn first_pair<T>(
    flights: &[&Recording],
    differ: impl Fn(&Recording, &Recording) -> Option<T>,
) -> Option<(usize, usize, T)> {
    (1..flights.len()).find_map(|place| {
        (0..place).find_map(|earlier| Some((place, earlier, differ(flights[place], flights[earlier])?)))
    })
}

fn recordings<'a>(flights: &[&'a Flight]) -> Vec<&'a Recording> {
    flights.iter().map(|flight| &flight.recording).collect()
}

/// A warning for each flight whose log states another airframe or other serial numbers than a flight before it: such flights may be of
/// two vehicles, or of one that was rebuilt.
pub(super) fn doubt_one_vehicle<'a>(flights: impl Iterator<Item = &'a Flight>) -> Vec<Note> {
    let flights: Vec<&Flight> = flights.collect();
    (1..flights.len()).filter_map(|place| other_parts(&flights, place, |others| !others.is_empty())).collect()
}

/// The first of these warnings by which more than one part has another serial number: one that was replaced is no other vehicle.
pub(super) fn serials_apart<'a>(flights: impl Iterator<Item = &'a Flight>) -> Option<Note> {
    let flights: Vec<&Flight> = flights.collect();
    (1..flights.len()).find_map(|place| other_parts(&flights, place, |others| parts(others) > 1))
}

/// The warning that a flight's log states other parts than the flights before it, if those are `enough`.
fn other_parts(flights: &[&Flight], place: usize, enough: impl Fn(&[&str]) -> bool) -> Option<Note> {
    let flight = flights[place];
    let others = stated_otherwise(&recordings(&flights[..=place]));
    let names: Vec<&str> = others.iter().map(|(name, _)| *name).collect();
    let text = || {
        let mut paths: Vec<&str> = Vec::new();
        for (_, stated_in) in &others {
            let path = flights[*stated_in].input.path.as_str();
            if !paths.contains(&path) {
                paths.push(path);
            }
        }
        format!(
            "{} not as in {}: these flights are of two vehicles, or parts were replaced between them",
            names.join(", "),
            paths.join(" and ")
        )
    };
    enough(&names).then(|| Note::warning(About::File(flight.input.path.clone()), text()))
}

/// Parts of which these are serial numbers.
fn parts(names: &[&str]) -> usize {
    PARTS.iter().filter(|part| names.iter().any(|name| part.contains(name))).count()
}

/// What identifies a vehicle and is stated otherwise in the last of these logs than in the first one that states it, with the place of
/// that one.
fn stated_otherwise(flights: &[&Recording]) -> Vec<(&'static str, usize)> {
    let value = |flight: &Recording, name: &str| flight.parameters.get(name).copied();
    let is_other = |name: &'static str| {
        let own = value(flights.last()?, name)?;
        let mut stated =
            flights.iter().enumerate().filter_map(|(place, flight)| Some((place, value(flight, name)?)));
        stated.next().filter(|(_, first)| *first != own).map(|(place, _)| (name, place))
    };
    AIRFRAME.into_iter().chain(SERIAL).filter_map(is_other).collect()
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
        // behind a log that states nothing
        let (none, hexa) = (Recording::default(), of(Autopilot::ArduPilot, 2.0));
        let found = first_pair(&[&none, &quad, &none, &hexa, &quad], differ);
        assert_eq!(found.map(|(place, earlier, _)| (place, earlier)), Some((3, 1)));
        assert!(first_pair(&[&none, &quad, &quad], differ).is_none());
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
        assert_eq!(stated_otherwise(&[&one, &same]), []);
        assert_eq!(stated_otherwise(&[&one, &other]), [("SYS_AUTOSTART", 0), ("CAL_ACC0_ID", 0)]);
        // the first that states it counts, and a flight like that one is no other
        let (none, gyro) = (Recording::default(), of(&[("CAL_GYRO0_ID", 8.0)]));
        assert_eq!(stated_otherwise(&[&none, &one, &other]), [("SYS_AUTOSTART", 1), ("CAL_ACC0_ID", 1)]);
        assert_eq!(stated_otherwise(&[&one, &other, &one]), []);
        assert_eq!(stated_otherwise(&[&one, &same, &gyro]), [("CAL_GYRO0_ID", 1)]);
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
