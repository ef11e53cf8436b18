//! What is flown, from the arguments and their files.

use std::io::IsTerminal;
use std::time::Duration;

use mavid::config::{StoredTrajectory, read_trajectory};
use mavid::fly::{self, Around, Course, Origin, Ride, Sortie};
use mavid::link::Signing;
use mavid::plan::{Roomed, with_room};
use mavid::text;
use mavid::units::rad_from_deg;
use mavid::vehicle::{Limits, Vehicle};
use mavid::wire::{ComponentId, SystemId};

use super::vehicle::{TRAJECTORY, copy, vehicle_of};
use crate::cli::{CheckName, FlyArgs, OriginName};
use crate::commands::{CommandError, leftover, network, output};

/// A ground station's component id.
const STATION: ComponentId = ComponentId(190);

/// Everything that is read and checked before the link is opened.
pub fn ride(args: &FlyArgs) -> Result<Ride, CommandError> {
    let input = |error: &dyn std::fmt::Display| CommandError::Input(error.to_string());
    if args.system_id == Some(args.station_id) {
        let got = args.station_id;
        return Err(input(&format!(
            "--station-id: expected another id than the vehicle's, got {got} for both"
        )));
    }
    let address = network::address("--connect", &args.connect)?;
    let trajectory = read_trajectory(&args.trajectory)?;
    let flown = vehicle_of(args)?;
    let sortie = sortie(args, &trajectory, &flown.vehicle)?;
    let signing =
        args.signing_key_file.as_deref().map(Signing::open).transpose().map_err(|error| input(&error))?;
    output::signing_warnings(signing.as_ref());
    leftover::make_way(&args.out, SystemId(args.station_id))?;
    copy(&args.trajectory, &args.out.join(TRAJECTORY))?;
    let vehicle = flown.put(args)?;
    let parking = fly::Parking::default();
    Ok(Ride { sortie, vehicle, address, signing, dir: args.out.clone(), parking })
}

/// Largest distance from the reference that can be asked for, m. A guard beyond it would guard nothing.
pub const TRACKING_MOST_M: f64 = 10.0;

/// Refuses the value of an option that is not above zero and at most as large as stated.
pub fn within((name, value, most): (&str, Option<f64>, f64)) -> Result<(), CommandError> {
    match value.filter(|value| !(*value > 0.0 && *value <= most)) {
        Some(value) => Err(CommandError::Input(format!(
            "{name}: expected a number above 0 and at most {most}, got {value}"
        ))),
        None => Ok(()),
    }
}

fn sortie(args: &FlyArgs, trajectory: &StoredTrajectory, vehicle: &Vehicle) -> Result<Sortie, CommandError> {
    // a guard beyond these would guard nothing
    let ranges = [
        ("--tracking-max", Some(args.tracking_max), TRACKING_MOST_M),
        ("--tilt-max", args.tilt_max, 90.0),
        ("--hover-time", args.hover_time, 1e5),
        ("--gate-distance", args.gate_distance, 10.0),
        ("--gate-speed", args.gate_speed, 10.0),
    ];
    ranges.into_iter().try_for_each(within)?;
    let around = trajectory.transitions.map(|stored| Around {
        takeoff: stored.takeoff,
        landing: stored.landing,
        to_start_s: stored.to_start_s,
        to_landing_s: stored.to_landing_s,
    });
    // those that it was planned for, where it says so
    let stated = if trajectory.limits == Limits::default() { vehicle.limits } else { trajectory.limits };
    let Roomed { limits, notes } = with_room(&stated, vehicle);
    output::warnings(&args.trajectory, &notes);
    let repeats = args.repeats.unwrap_or(trajectory.repeats);
    trajectory
        .series
        .check_size(repeats)
        .map_err(|error| CommandError::Input(format!("{}: {error}", text::path(&args.trajectory))))?;
    let course = Course::new(&trajectory.series, repeats, around.as_ref(), &limits, vehicle)
        .map_err(|error| CommandError::Input(format!("{}: {error}", text::path(&args.trajectory))))?;
    Ok(Sortie {
        course,
        limits,
        gravity_m_s2: vehicle.gravity_m_s2,
        system: args.system_id.map(SystemId),
        may_arm: args.arm,
        own_vehicle: None,
        settings: fly::Settings {
            station: (SystemId(args.station_id), STATION),
            setpoint_period: Duration::from_secs(1) / args.setpoint_hz,
            origin: match args.origin {
                OriginName::Local => Origin::Local,
                OriginName::Here => Origin::Here,
            },
            tracking_max_m: args.tracking_max,
            tilt_max_rad: args.tilt_max.map(rad_from_deg),
            hover_time_s: args.hover_time,
            gate_m: args.gate_distance,
            gate_m_s: args.gate_speed,
            await_clearance: true,
            await_word: asks_for_the_word(args),
            accepted: args.accept.iter().map(|name| check(*name)).collect(),
            ..fly::Settings::default()
        },
    })
}

/// Somebody sits at a terminal.
pub fn is_attended() -> bool {
    std::io::stdin().is_terminal() && std::io::stderr().is_terminal()
}

/// Somebody sees a view, and not lines.
pub fn is_drawn(args: &FlyArgs) -> bool {
    !args.plain && is_attended()
}

/// The flight waits for somebody to type the word for arming.
pub fn asks_for_the_word(args: &FlyArgs) -> bool {
    args.arm && !args.yes && is_attended()
}

fn check(name: CheckName) -> fly::Check {
    match name {
        CheckName::HoverThrust => fly::Check::HoverThrust,
        CheckName::Rotors => fly::Check::Rotors,
    }
}
