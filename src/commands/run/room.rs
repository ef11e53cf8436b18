//! The room: confirmed by a person, and written as the limits of every plan.

use std::fmt::Write;

use mavid::config::read_limits;
use mavid::plan::{Extremes, Reach, floor_m, with_room};
use mavid::text::{self, compact};
use mavid::units::deg_from_rad;
use mavid::vehicle::{Limits, Vehicle};

use super::ask::Ask;
use super::folder::Folder;
use crate::commands::{CommandError, output};

/// Where none is stated: length, width and height, m.
pub const USUAL_M: [f64; 3] = [4.0, 4.0, 3.0];
/// Lengths of rooms, m.
const SIDES_M: (f64, f64) = (0.5, 200.0);
/// Where the lowest point of a flight is, if the room is high enough, m.
const LOW_M: f64 = 1.0;
/// Lengths that are the same, m: the file has them to a tenth of a millimetre.
const SAME_M: f64 = 1e-3;
/// A flight has at least this much to climb and to sink, m, ...
const LEAST_HEIGHT_M: f64 = 0.3;
/// ... and this much to each side.
const LEAST_SIDE_M: f64 = 0.3;

/// Length, width and height, checked.
///
/// # Errors
/// What was expected.
pub fn sides(numbers: &[f64]) -> Result<[f64; 3], String> {
    sides_of(numbers).ok_or_else(|| format!("{}, got {}", expected(), came(numbers)))
}

fn sides_of(numbers: &[f64]) -> Option<[f64; 3]> {
    let [x, y, z] = *numbers else { return None };
    numbers.iter().all(|side| (SIDES_M.0..=SIDES_M.1).contains(side)).then_some([x, y, z])
}

fn expected() -> String {
    let (least, most) = SIDES_M;
    format!(
        "length, width and height as X,Y,Z, each of {least} to {most} m and large enough for the vehicle, such as 4,4,3"
    )
}

/// Numbers as they are typed.
fn came(numbers: &[f64]) -> String {
    if numbers.is_empty() {
        return "no three numbers".to_owned();
    }
    numbers.iter().map(ToString::to_string).collect::<Vec<_>>().join(",")
}

/// As it is typed, for this vehicle; whoever asks says what came.
fn typed(text: &str, vehicle: &Vehicle) -> Result<[f64; 3], String> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|side| side.trim().parse().ok()).collect();
    let expected = || {
        let (least, most) = (least_room(vehicle), SIDES_M.1);
        format!(
            "length, width and height as X,Y,Z, at least {least} for this vehicle and at most {most} m each"
        )
    };
    let sides_m = sides_of(&numbers.unwrap_or_default()).ok_or_else(expected)?;
    limits_in(sides_m, vehicle).map(|_| sides_m)
}

/// Length and width, and height, of the smallest room for a vehicle, m.
fn least_m(vehicle: &Vehicle) -> (f64, f64) {
    let reach = Reach::of(vehicle);
    (2.0 * (reach.side_m + LEAST_SIDE_M), floor_m(vehicle) + LEAST_HEIGHT_M + reach.up_m)
}

/// The smallest room for a vehicle as it is typed, rounded up to tenths.
fn least_room(vehicle: &Vehicle) -> String {
    let (side_m, height_m) = least_m(vehicle);
    let [side_m, height_m] = [side_m, height_m].map(|least_m| (10.0 * least_m - SAME_M).ceil() / 10.0);
    format!("{side_m:.1},{side_m:.1},{height_m:.1} m")
}

/// The limits inside a room for this vehicle, which stands in its middle.
///
/// # Errors
/// The room is too small: what was expected.
pub fn limits_in([x_m, y_m, z_m]: [f64; 3], vehicle: &Vehicle) -> Result<Limits, String> {
    let (reach, floor_m) = (Reach::of(vehicle), floor_m(vehicle));
    let (side_m, height_m) = least_m(vehicle);
    if x_m < side_m || y_m < side_m || z_m < height_m {
        return Err(format!(
            "a room of at least {} for this vehicle (its rotors reach {:.2} m to each side, and its lowest flight is at \
             {floor_m:.2} m)",
            least_room(vehicle),
            reach.side_m
        ));
    }
    let lowest = (z_m - reach.up_m - 2.0 * LEAST_HEIGHT_M).clamp(floor_m, LOW_M.max(floor_m));
    let room = Limits {
        x_max_m: Some(x_m / 2.0),
        y_max_m: Some(y_m / 2.0),
        z_min_m: Some(lowest),
        z_max_m: Some(z_m),
        ..Limits::default()
    };
    Ok(with_room(&room, vehicle).limits)
}

/// The height of the hover after takeoff, m: the middle between the lowest and the highest flight.
pub fn hover_m(limits: &Limits, vehicle: &Vehicle) -> f64 {
    let low_m = limits.z_min_m.unwrap_or(LOW_M);
    let high_m = limits.z_max_m.unwrap_or(USUAL_M[2]) - Reach::of(vehicle).up_m;
    (50.0 * (low_m + high_m)).round() / 100.0
}

/// The room that is given does not contradict the file `limits.toml`, if the folder has one.
///
/// # Errors
/// It does, or the file cannot be read.
pub fn same_room(folder: &Folder, given: Option<&[f64]>) -> Result<(), CommandError> {
    let path = folder.limits();
    let (Some(given), true) = (given, path.exists()) else { return Ok(()) };
    let known = sides_in(&read_limits(&path)?);
    let is_same = |(known, given): (&Option<f64>, &f64)| known.is_some_and(|m| (m - given).abs() < SAME_M);
    if known.iter().zip(given).all(is_same) {
        return Ok(());
    }
    let side = |side: &Option<f64>| side.map_or_else(|| "unbounded".to_owned(), compact);
    let known = known.iter().map(side).collect::<Vec<_>>().join(",");
    Err(CommandError::Input(format!(
        "--room: expected the {known} m of {}, which is there, got {}: give another folder with --out, or remove limits.toml \
         and plan.toml, so that a flight in the other room is planned",
        text::path(&path),
        came(given)
    )))
}

/// Length, width and height of the room of these limits, m.
fn sides_in(limits: &Limits) -> [Option<f64>; 3] {
    let twice = |half: f64| 2.0 * half;
    [limits.x_max_m.map(twice), limits.y_max_m.map(twice), limits.z_max_m]
}

/// Along a trajectory with these extremes the rotors keep walls and ceiling of the limits.
///
/// # Errors
/// Which of them they do not keep.
pub fn holds(limits: &Limits, extremes: &Extremes, vehicle: &Vehicle) -> Result<(), String> {
    let reach = Reach::of(vehicle);
    let side_m = |axis: usize| extremes.high_m[axis].max(-extremes.low_m[axis]) + reach.side_m;
    let bounds = [
        ("x_max_m", limits.x_max_m, side_m(0)),
        ("y_max_m", limits.y_max_m, side_m(1)),
        ("z_max_m", limits.z_max_m, extremes.high_m[2] + reach.up_m),
    ];
    for (name, bound_m, needed_m) in bounds {
        if let Some(bound_m) = bound_m.filter(|bound_m| needed_m > bound_m + SAME_M) {
            return Err(format!("{name} is {}, and its rotors reach {needed_m:.2} m", compact(bound_m)));
        }
    }
    Ok(())
}

/// The room in the file `limits.toml` of the folder: that of `given`, or the one that is agreed to. A file that is there stays.
///
/// # Errors
/// The room is too small, or nobody states one where nobody can be asked.
pub fn of_folder(
    (folder, ask): (&Folder, Ask),
    given: Option<&[f64]>,
    vehicle: &Vehicle,
    is_simulated: bool,
) -> Result<(), CommandError> {
    let path = folder.limits();
    if path.exists() {
        output::message(&format!("room: {}, which is there", text::path(&path)));
        return Ok(());
    }
    let option = |why: String| CommandError::Input(format!("--room: expected {why}"));
    let sides_m = match given {
        Some(numbers) => sides(numbers).map_err(option)?,
        None => asked(ask, vehicle, is_simulated)?,
    };
    output::file(&path, &text_of(&fits(sides_m, vehicle)?))
}

/// The limits inside the room of the option for this vehicle.
///
/// # Errors
/// The room is too small.
pub fn fits(sides_m: [f64; 3], vehicle: &Vehicle) -> Result<Limits, CommandError> {
    limits_in(sides_m, vehicle)
        .map_err(|why| CommandError::Input(format!("--room: expected {why}, got {}", came(&sides_m))))
}

fn asked(ask: Ask, vehicle: &Vehicle, is_simulated: bool) -> Result<[f64; 3], CommandError> {
    let [x, y, z] = USUAL_M;
    let question = format!(
        "Free room round the vehicle: length, width, height in m? At least {} for this vehicle [{x},{y},{z}]",
        least_room(vehicle)
    );
    let alone = || {
        match is_simulated {
        true => Ok(None),
        false => Err(CommandError::Input(
            "--room: expected the free room round the vehicle as X,Y,Z in m, got none: with --yes nobody confirms one"
                .to_owned(),
        )),
    }
    };
    Ok(ask.value((&question, " with --room"), |text| typed(text, vehicle), alone)?.unwrap_or(USUAL_M))
}

/// The limits as a file, to be read and changed by people.
fn text_of(limits: &Limits) -> String {
    let mut text = String::from(
        "# The free room round the place of takeoff, and how lively it is flown. Every plan of this folder keeps it.\n[limits]\n",
    );
    let mut line = |name: &str, value: Option<f64>, comment: &str| {
        if let Some(value) = value {
            let value = (1e4 * value).round() / 1e4;
            // writing to a String cannot fail
            let _ = writeln!(text, "{name} = {value:?}{comment}");
        }
    };
    line("x_max_m", limits.x_max_m, "   # half the length, south to north");
    line("y_max_m", limits.y_max_m, "   # half the width, west to east");
    line("z_min_m", limits.z_min_m, "   # lowest flight");
    line("z_max_m", limits.z_max_m, "   # ceiling");
    line("speed_max_m_s", limits.speed_max_m_s, "");
    line("roll_max_deg", limits.roll_max_rad.map(deg_from_rad), "");
    line("pitch_max_deg", limits.pitch_max_rad.map(deg_from_rad), "");
    line("yaw_rate_max_deg_s", limits.yaw_rate_max_rad_s.map(deg_from_rad), "");
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use mavid::config::parse_limits;
    use mavid::simulate::random_vehicle;

    #[test]
    fn a_room_is_written_as_it_is_read() {
        let vehicle = random_vehicle(1).truth;
        let limits = limits_in([6.0, 4.0, 5.0], &vehicle).unwrap();
        let read = parse_limits(&text_of(&limits), "limits.toml").unwrap();
        assert_eq!((read.x_max_m, read.y_max_m, read.z_max_m), (Some(3.0), Some(2.0), Some(5.0)));
        assert_eq!(with_room(&read, &vehicle).notes, []);
        let hover_m = hover_m(&read, &vehicle);
        assert!(hover_m > read.z_min_m.unwrap() && hover_m < 5.0);
    }

    #[test]
    fn a_folder_has_one_room() {
        let place = std::env::temp_dir().join(format!("mavid-room-{}", std::process::id()));
        let folder = Folder::at(place).unwrap();
        let vehicle = random_vehicle(1).truth;
        assert!(same_room(&folder, Some(&[9.0, 9.0, 9.0])).is_ok(), "nothing is there");
        let limits = limits_in([4.0, 4.0, 3.0], &vehicle).unwrap();
        std::fs::write(folder.limits(), text_of(&limits)).unwrap();
        assert!(same_room(&folder, None).is_ok() && same_room(&folder, Some(&[4.0, 4.0, 3.0])).is_ok());
        let other = same_room(&folder, Some(&[2.0, 2.0, 2.0])).unwrap_err();
        assert_eq!(other.status(), 2);
        let said = other.to_string();
        assert!(
            said.contains("expected the 4,4,3 m of") && said.contains("got 2,2,2: give another"),
            "{said}"
        );
        std::fs::write(folder.limits(), "[limits]\nx_max_m = 2.0\n").unwrap();
        let said = same_room(&folder, Some(&[4.0, 4.0, 3.0])).unwrap_err().to_string();
        assert!(said.contains("expected the 4,unbounded,unbounded m of"), "{said}");
        std::fs::remove_dir_all(folder.path()).unwrap();
    }

    #[test]
    fn a_trajectory_of_a_larger_room_is_not_held() {
        let vehicle = random_vehicle(1).truth;
        let limits = limits_in([4.0, 4.0, 3.0], &vehicle).unwrap();
        let reach = |side: f64| Extremes {
            low_m: [-side, -side, 1.0],
            high_m: [side, side, 1.5],
            ..Extremes::default()
        };
        assert_eq!(holds(&limits, &reach(1.0), &vehicle), Ok(()));
        let said = holds(&limits, &reach(1.95), &vehicle).unwrap_err();
        assert!(said.contains("x_max_m is 2, and its rotors reach"), "{said}");
    }

    #[test]
    fn a_room_that_is_too_small_says_what_is_needed() {
        let vehicle = random_vehicle(1).truth;
        let said = limits_in([0.5, 4.0, 3.0], &vehicle).unwrap_err();
        assert!(said.contains("a room of at least") && said.contains("rotors reach"), "{said}");
        assert!(limits_in([4.0, 4.0, 0.6], &vehicle).is_err());
        assert!(sides(&[4.0, 4.0]).is_err() && sides(&[4.0, -4.0, 3.0]).is_err());
        assert_eq!(typed("4, 5,3", &vehicle), Ok([4.0, 5.0, 3.0]));
        // whoever asks says what came
        let large = typed("large", &vehicle).unwrap_err();
        assert!(!large.contains("got") && !said.contains("got"), "{said}");
        // what is asked for is what is checked
        let least = least_room(&vehicle);
        assert!(large.contains(&least) && said.contains(&least), "{large}, {said}");
        assert!(typed(least.trim_end_matches(" m"), &vehicle).is_ok(), "{least}");
        assert!(sides(&[4.0]).unwrap_err().ends_with(", got 4"));
        let small = fits([1.0, 1.0, 1.0], &vehicle).unwrap_err().to_string();
        assert!(small.ends_with(", got 1,1,1") && small.matches("got").count() == 1, "{small}");
    }
}
