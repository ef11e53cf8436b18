//! What is given to a run does not contradict its folder.

use std::path::Path;

use mavid::autopilot::{Autopilot, Frame};
use mavid::config::read_vehicle;
use mavid::fly::PARAMETERS;
use mavid::text::{self, compact};
use mavid::vehicle::{Spin, Vehicle};

use super::folder::Folder;
use super::vehicle::autopilot_of;
use crate::cli::RunArgs;
use crate::commands::CommandError;

/// Masses that are the same.
const SAME: f64 = 1e-6;
/// Sizes that are the same: a file that was made has five digits of each place.
const SAME_SIZE: f64 = 1e-3;
/// Directions of a motor that are the same, degrees.
const SAME_DEG: f64 = 0.5;
/// What may be done instead.
const ANOTHER: &str = "give another folder with --out, or change the file";

/// What is given does not contradict the folder: its vehicle's file, if it has one, and the autopilot that was flown in it.
///
/// # Errors
/// It does, or the file cannot be read.
pub fn same_vehicle(folder: &Folder, args: &RunArgs) -> Result<(), CommandError> {
    same_autopilot(folder, args)?;
    let path = &folder.vehicle();
    if !path.exists() {
        return Ok(());
    }
    let shown = text::path(path);
    let known = read_vehicle(path)?.vehicle;
    let mass = known.body.mass_kg;
    if let Some(mass_kg) = args.mass.filter(|mass_kg| (mass_kg - mass).abs() > SAME * mass) {
        return refused(&format!(
            "--mass: expected the {mass} kg of {shown}, which is there, got {mass_kg}: {ANOTHER}"
        ));
    }
    let size = size_m(&known);
    if let Some(size_m) = args.shape.size.filter(|size_m| (size_m - size).abs() > SAME_SIZE * size) {
        let size = compact(size);
        return refused(&format!(
            "--size: expected the {size} m of {shown}, which is there, got {size_m}: {ANOTHER}"
        ));
    }
    if let Some(frame) = args.shape.frame.filter(|frame| !has_frame(&known, frame)) {
        return refused(&format!(
            "--frame: expected the frame of {shown}, which is there, got {}: {ANOTHER}",
            frame.id()
        ));
    }
    let differs = |file: &Path| std::fs::read(file).ok() != std::fs::read(path).ok();
    if let Some(file) = args.vehicle.as_deref().filter(|file| differs(file)) {
        return refused(&format!(
            "--vehicle: expected what is in {shown}, got {}: {ANOTHER}",
            text::path(file)
        ));
    }
    Ok(())
}

fn refused(what: &str) -> Result<(), CommandError> {
    Err(CommandError::Input(what.to_owned()))
}

/// The embedded vehicle is of the autopilot that was flown in the folder.
fn same_autopilot(folder: &Folder, args: &RunArgs) -> Result<(), CommandError> {
    if !args.sitl {
        return Ok(());
    }
    let flown = folder.flights();
    let mut flown = flown.iter().filter_map(|flight| autopilot_of(&flight.radio.with_file_name(PARAMETERS)));
    let known = autopilot_of(&folder.parameters()).or_else(|| flown.next()).and_then(Autopilot::stack);
    let given = args.autopilot.unwrap_or(Autopilot::Px4);
    let Some(known) = known.filter(|known| known.autopilot != given) else { return Ok(()) };
    let got = given.stack().map_or("another", |stack| stack.id);
    let by = if args.autopilot.is_none() { ", which --sitl has without it" } else { "" };
    refused(&format!(
        "--autopilot: expected {}, as in {}, got {got}{by}: give another folder with --out",
        known.id,
        text::path(folder.path())
    ))
}

/// From motor to motor across the centre, m, as `--size` gives it.
fn size_m(vehicle: &Vehicle) -> f64 {
    2.0 * vehicle.rotors.iter().map(|rotor| rotor.position_m.xy().norm()).fold(0.0, f64::max)
}

/// Whether the motors stand where those of a frame do, and turn as they do.
fn has_frame(vehicle: &Vehicle, frame: &Frame) -> bool {
    let same = |(motor, rotor): (&mavid::autopilot::FrameMotor, &mavid::vehicle::Rotor)| {
        let (forward, left) = motor.place();
        let place = rotor.position_m;
        let turn = (forward * place.y - left * place.x).atan2(forward * place.x + left * place.y);
        turn.to_degrees().abs() < SAME_DEG && motor.ccw == (rotor.spin == Spin::Ccw)
    };
    frame.motors.len() == vehicle.rotors.len() && frame.motors.iter().zip(&vehicle.rotors).all(same)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::{Cli, Verb};
    use clap::Parser;
    use mavid::fly::parameters::Parameters;

    fn said(folder: &Folder, words: &str) -> String {
        let all = ["mavid", "run", "--sitl"].into_iter().chain(words.split_whitespace());
        let Verb::Run(args) = Cli::try_parse_from(all).unwrap().verb else { panic!("{words}") };
        same_vehicle(folder, &args).err().map_or_else(String::new, |error| error.to_string())
    }

    #[test]
    fn another_vehicle_than_that_of_the_folder_is_refused() {
        let place = tempfile::tempdir().unwrap();
        let folder = Folder::at(place.path().to_owned()).unwrap();
        assert_eq!(said(&folder, "--autopilot ardupilot --mass 1.5 --size 0.4"), "");
        std::fs::copy("configs/x500.toml", folder.vehicle()).unwrap();
        let of = Parameters { autopilot: Autopilot::ArduPilot, ..Parameters::default() };
        std::fs::write(folder.parameters(), of.to_toml().unwrap()).unwrap();
        let same = "--autopilot ardupilot --mass 2.0643";
        assert_eq!(said(&folder, same), "");
        assert_eq!(said(&folder, &format!("{same} --size 0.4921 --frame quadrotor-x")), "");
        for (given, expected) in [
            ("--autopilot px4".to_owned(), "--autopilot: expected ardupilot"),
            (String::new(), "got px4, which --sitl has without it"),
            ("--autopilot ardupilot --mass 2".to_owned(), "--mass: expected the 2.0643 kg"),
            (format!("{same} --size 0.6"), "--size: expected the 0.4921 m"),
            (format!("{same} --frame quadrotor-plus"), "--frame: expected the frame"),
            (format!("{same} --frame hexarotor-x"), "got hexarotor-x"),
        ] {
            let said = said(&folder, &given);
            assert!(said.contains(expected), "{given}: {said}");
        }
    }
}
