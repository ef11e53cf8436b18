//! Which vehicle is flown: that of a file, or one drafted from the parameters that the vehicle has on the link.

use std::path::{Path, PathBuf};

use mavid::config::read_vehicle;
use mavid::draft::parameters_of;
use mavid::files::write_whole;
use mavid::study::{check_given, draft_from_parameters, draft_text};
use mavid::text;
use mavid::vehicle::Vehicle;
use mavid::wire::SystemId;

use crate::cli::FlyArgs;
use crate::commands::log::{link_of, parameters_of_vehicle};
use crate::commands::read_once::{is_read_once, keep};
use crate::commands::{CommandError, leftover, output};

/// The vehicle, and its file until it lies in the folder of the flight.
pub(super) struct FlightVehicle {
    pub(super) vehicle: Vehicle,
    file: File,
}

enum File {
    At(PathBuf),
    Drafted(String),
}

/// Where the vehicle's file of a flight lies: as it was given, or in the folder of the flight, where it was drafted.
pub(super) fn file_of(args: &FlyArgs) -> PathBuf {
    args.vehicle.clone().unwrap_or_else(|| args.out.join(NAME))
}

const NAME: &str = "vehicle.toml";
/// Name of the trajectory in the folder of a flight.
pub(super) const TRAJECTORY: &str = "trajectory.toml";

/// The arguments with the copies in the folder of the flight in the place of what can be read once only.
///
/// # Errors
/// Nothing comes of it, or the folder holds a flight.
pub(super) fn kept(args: &FlyArgs) -> Result<FlyArgs, CommandError> {
    let mut kept = args.clone();
    if let Some(file) = args.vehicle.as_ref().filter(|file| is_read_once(file)) {
        leftover::make_way(&args.out, SystemId(args.station_id))?;
        kept.vehicle = Some(args.out.join(NAME));
        keep(file, &args.out.join(NAME))?;
    }
    if is_read_once(&args.trajectory) {
        leftover::make_way(&args.out, SystemId(args.station_id))?;
        kept.trajectory = args.out.join(TRAJECTORY);
        keep(&args.trajectory, &kept.trajectory)?;
    }
    Ok(kept)
}

/// The vehicle of the file, or, with a mass in its place, one of the parameters that the vehicle has. For these it is spoken
/// to; nothing on it is changed.
///
/// # Errors
/// The file is wrong, the vehicle does not answer, or its parameters do not say enough.
pub(super) fn vehicle_of(args: &FlyArgs) -> Result<FlightVehicle, CommandError> {
    if let Some(path) = &args.vehicle {
        let loaded = read_vehicle(path)?;
        output::warnings(path, &loaded.warnings);
        return Ok(FlightVehicle { vehicle: loaded.vehicle, file: File::At(path.clone()) });
    }
    let Some(mass_kg) = args.mass else {
        return Err(CommandError::Input("expected --vehicle or --mass, got neither".to_owned()));
    };
    // what is there already is told before anybody is waited for
    leftover::make_way(&args.out, SystemId(args.station_id))?;
    let given = args.shape.given(mass_kg);
    check_given(&given)?;
    let link = link_of(args, args.system_id);
    let found = parameters_of_vehicle(&link, |_, _| {}, |stack, known| parameters_of(stack, &given, known))?;
    let draft = draft_from_parameters((found.autopilot, found.parameters), &given, &args.connect)?;
    let guesses = draft.vehicle.guesses.len();
    output::message(&format!(
        "the vehicle is drafted from its parameters, with {guesses} guess{}: {}",
        if guesses == 1 { "" } else { "es" },
        text::path(&file_of(args))
    ));
    Ok(FlightVehicle { file: File::Drafted(draft_text(&draft)?), vehicle: draft.vehicle })
}

/// Copies a file into the folder of the flight, unless it lies there.
pub(super) fn copy(from: &Path, to: &Path) -> Result<(), CommandError> {
    let failed = |error| {
        CommandError::Input(format!("cannot copy {} to {}: {error}", text::path(&from), text::path(&to)))
    };
    if output::is_same(from, to) {
        return Ok(());
    }
    let text = std::fs::read(from).map_err(failed)?;
    write_whole(to, &text).map_err(failed)
}

impl FlightVehicle {
    /// Puts its file into the folder of the flight, which is there.
    pub(super) fn put(self, args: &FlyArgs) -> Result<Vehicle, CommandError> {
        let to = args.out.join(NAME);
        match self.file {
            File::At(from) => copy(&from, &to)?,
            File::Drafted(text) => output::file(&to, &text)?,
        }
        Ok(self.vehicle)
    }
}
