//! Flights of one vehicle put down as logs.

use std::path::{Path, PathBuf};

use rand::RngExt;
use rayon::prelude::*;

use crate::maker::dice;
use crate::maker::realistic::one_vehicle::OneVehicle;

/// What is left of the rotor that is weak after.
pub const LEFT: f64 = 0.97;
/// Vehicles of a seed before it is given up.
const DRAWS: u64 = 8;

/// Logs of one vehicle, and its file.
#[derive(Debug)]
pub struct Logs {
    pub vehicle: OneVehicle,
    pub file: PathBuf,
    pub flights: Vec<PathBuf>,
    /// of a pair with a change
    pub weak: Option<usize>,
}

/// What the vehicle of a seed has beside the rigid body: every second one a drag, on which wind acts.
fn entries(seed: u64) -> &'static [&'static str] {
    if seed.is_multiple_of(2) { &[] } else { &["linear_drag"] }
}

/// A pair of flights of one vehicle: one rotor is weak in the second where `changed`.
pub fn pair(folder: &Path, seed: u64, changed: bool) -> Result<Logs, String> {
    let rotor = changed.then(|| dice(seed, 14).random_range(0..4_usize));
    several(folder, seed, 2, rotor)
}

/// So many flights of one vehicle, the last of them with a weak rotor where one is given.
pub fn several(folder: &Path, seed: u64, count: u64, rotor: Option<usize>) -> Result<Logs, String> {
    let made = several_with(folder, seed, count, &|flight| rotor.filter(|_| flight + 1 == count))?;
    Ok(Logs { weak: rotor, ..made })
}

/// So many flights of one vehicle; of each, `weak` says which rotor is weak in it.
pub fn several_with(
    folder: &Path,
    seed: u64,
    count: u64,
    weak: &(dyn Fn(u64) -> Option<usize> + Sync),
) -> Result<Logs, String> {
    let mut why = String::new();
    for draw in 0..DRAWS {
        let vehicle = OneVehicle::new(seed, draw, entries(seed));
        let of = |flight: u64| vehicle.fly(flight, weak(flight).map(|rotor| (rotor, LEFT)));
        std::fs::create_dir_all(folder).expect("a folder for the vehicle");
        // a flight is large in memory: it is put down at once
        let put = |flight: u64| {
            let path = folder.join(format!("flight_{}.tlog", flight + 1));
            let log = vehicle.log(&of(flight)?);
            std::fs::write(&path, log).expect("room for the flight");
            Ok::<PathBuf, String>(path)
        };
        let days: Result<Vec<PathBuf>, String> = (0..count).into_par_iter().map(put).collect();
        match days {
            Ok(flights) => {
                let file = folder.join("vehicle.toml");
                std::fs::write(&file, vehicle.case.case.craft.file("made")).expect("room for the vehicle");
                return Ok(Logs { vehicle, file, flights, weak: None });
            }
            Err(lost) => why = lost,
        }
    }
    Err(why)
}

/// Writes flights of one vehicle each into folders; of pairs, also those with a weak rotor.
pub fn write(folder: &Path, seed: u64, count: u64, flights: u64) {
    (seed..seed + count).into_par_iter().for_each(|seed| {
        for changed in [false, true].into_iter().take(if flights == 2 { 2 } else { 1 }) {
            let kind = if changed { "weak" } else { "same" };
            let at = folder.join(format!("{kind}_{seed}"));
            let made =
                if flights == 2 { pair(&at, seed, changed) } else { several(&at, seed, flights, None) };
            match made {
                Ok(made) => println!("{} {:?}", at.display(), made.weak),
                Err(why) => println!("{}: not flown: {why}", at.display()),
            }
        }
    });
}
