//! What a run has made so far: it is told by the files that are there.

use std::fs::{self, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};

use mavid::fly::TLOG;
use mavid::text;

use super::phases::phases;
use crate::commands::{CommandError, leftover, output};

/// Every step as it is typed, in the order in which they were done.
pub const COMMANDS: &str = "commands.txt";
/// The file in the folder of a flight that says why it does not count.
const NOT_COUNTED: &str = "not_counted.txt";
/// Endings of the logs that a vehicle writes itself.
const ONBOARD: [&str; 2] = ["ulg", "bin"];
/// Endings of logs of which only a part is there.
const UNFINISHED: &str = "part";
/// The phase of a flight from which on there is something to explain.
const TRAJECTORY: &str = "trajectory";
/// The phase after which nothing more is recorded, ...
const OVER: &str = "over";
/// ... the one in which a vehicle stays in the air, ...
const HOLD: &str = "hold";
/// ... and those in which it comes down, or somebody else flies it.
const LEFT: [&str; 3] = ["land", "return", "hands off"];

/// The folder of a run.
#[derive(Debug, Clone)]
pub struct Folder(PathBuf);

/// A flight that was recorded.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Recorded {
    /// of the link
    pub radio: PathBuf,
    /// the vehicle's own log, if it was fetched
    pub onboard: Option<PathBuf>,
}

/// How far the recording of a flight goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Extent {
    /// it never reached its trajectory
    Before,
    /// the recording ends in the air: the program ended before the flight
    CutOff,
    /// until the flight was over
    Whole,
}

impl Folder {
    /// At this place, which is made.
    pub fn at(place: PathBuf) -> Result<Self, CommandError> {
        if place.exists() && !place.is_dir() {
            let got = text::path(&place);
            return Err(CommandError::Input(format!("--out: expected a folder, {got} is a file")));
        }
        output::silent_folder(&place)?;
        Ok(Self(place))
    }

    /// The folder itself.
    pub fn path(&self) -> &Path {
        &self.0
    }

    /// A file or a folder in it.
    pub fn of(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    /// Adds a step to those that made what is in the folder, unless it is one of them already.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn remember(&self, step: &str) -> Result<(), CommandError> {
        let path = self.of(COMMANDS);
        if fs::read_to_string(&path).is_ok_and(|text| text.lines().any(|known| known == step)) {
            return Ok(());
        }
        let opened = OpenOptions::new().create(true).append(true).open(&path);
        opened
            .and_then(|mut file| writeln!(file, "{step}"))
            .map_err(|error| CommandError::Failure(format!("cannot write {}: {error}", text::path(&path))))
    }

    /// Steps that made what is in the folder, those of earlier runs among them.
    pub fn remembered(&self) -> usize {
        fs::read_to_string(self.of(COMMANDS)).map_or(0, |text| text.lines().count())
    }

    /// The vehicle's file.
    pub fn vehicle(&self) -> PathBuf {
        self.of("vehicle.toml")
    }

    /// The parameters that the vehicle answered.
    pub fn parameters(&self) -> PathBuf {
        self.of("parameters.toml")
    }

    /// The room, and how lively it is flown.
    pub fn limits(&self) -> PathBuf {
        self.of("limits.toml")
    }

    /// The trajectory of the flight of this number, from 1.
    pub fn plan(&self, number: usize) -> PathBuf {
        if number == 1 { self.of("plan.toml") } else { self.of(&format!("plan{number}.toml")) }
    }

    /// The trajectory that separates best what the flights so far cannot separate.
    pub fn next(&self) -> PathBuf {
        self.of("next.toml")
    }

    /// Flights that reached their trajectory and were recorded until they were over, in their order.
    pub fn flights(&self) -> Vec<Recorded> {
        self.flown(Extent::Whole).map(|folder| Recorded::of(&folder)).collect()
    }

    /// Folders of flights that reached their trajectory, and in which the program ended before the flight.
    pub fn cut_off(&self) -> Vec<PathBuf> {
        self.flown(Extent::CutOff).collect()
    }

    /// Folders of whole flights of which the vehicle's own log was not fetched to its end.
    pub fn half_fetched(&self) -> Vec<PathBuf> {
        self.flown(Extent::Whole)
            .filter(|folder| Recorded::of(folder).onboard.is_none() && has_ending(folder, &[UNFINISHED]))
            .collect()
    }

    fn flown(&self, extent: Extent) -> impl Iterator<Item = PathBuf> {
        let folders = (1..).map(|number| self.flight(number)).take_while(|folder| folder.exists());
        folders.filter(move |folder| extent_of(folder) == extent)
    }

    /// The folder of the next flight: the first that holds no recording of a vehicle.
    pub fn new_flight(&self) -> PathBuf {
        let mut folders = (1..).map(|number| self.flight(number));
        folders.find(|folder| leftover::is_free(folder, leftover::STATION)).unwrap_or_default()
    }

    fn flight(&self, number: usize) -> PathBuf {
        self.of(&format!("flight{number}"))
    }
}

impl Recorded {
    fn of(folder: &Path) -> Self {
        let mut logs = with_ending(folder, &ONBOARD);
        logs.sort();
        Self { radio: folder.join(TLOG), onboard: logs.pop() }
    }
}

/// Files in a folder whose names have one of these endings.
fn with_ending(folder: &Path, endings: &[&str]) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let is_one = |path: &PathBuf| {
        let ending = path.extension().and_then(|ending| ending.to_str());
        ending.is_some_and(|ending| endings.iter().any(|known| ending.eq_ignore_ascii_case(known)))
    };
    entries.filter(is_one).collect()
}

fn has_ending(folder: &Path, endings: &[&str]) -> bool {
    !with_ending(folder, endings).is_empty()
}

/// The flight in this folder is not explained, and is flown again: a file in it says why.
///
/// # Errors
/// The file cannot be written.
pub fn set_aside(folder: &Path, why: &str) -> Result<(), CommandError> {
    output::file(&folder.join(NOT_COUNTED), &format!("{why}\n"))
}

fn extent_of(folder: &Path) -> Extent {
    if folder.join(NOT_COUNTED).exists() {
        return Extent::Before;
    }
    let phases: Vec<String> = phases(folder).into_iter().map(|begun| begun.name).collect();
    let reached =
        phases.iter().rposition(|phase| phase == TRAJECTORY).filter(|_| folder.join(TLOG).is_file());
    let Some(reached) = reached else { return Extent::Before };
    let after: Vec<&str> = phases.iter().skip(reached + 1).map(String::as_str).collect();
    // one that is over while it holds was left in the air
    let is_over = after.ends_with(&[OVER]) && !after.ends_with(&[HOLD, OVER]);
    if is_over || after.iter().any(|phase| LEFT.contains(phase)) { Extent::Whole } else { Extent::CutOff }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mavid::fly::EVENTS;

    fn made(name: &str) -> Folder {
        let place = std::env::temp_dir().join(format!("mavid-run-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&place);
        Folder::at(place).unwrap()
    }

    fn flown(folder: &Path, phases: &[&str]) {
        fs::create_dir_all(folder).unwrap();
        fs::write(folder.join(TLOG), "recorded").unwrap();
        let line = |phase: &&str| {
            format!("{{\"time_s\":1.0,\"level\":\"information\",\"kind\":\"phase\",\"text\":\"{phase}\"}}\n")
        };
        fs::write(folder.join(EVENTS), phases.iter().map(line).collect::<String>()).unwrap();
    }

    #[test]
    fn a_flight_that_is_recorded_counts_and_what_never_flew_does_not() {
        let folder = made("state");
        assert_eq!(folder.flights(), []);
        // of a run that is taken up no step stands there twice
        let steps = ["mavid plan v.toml", "mavid fly", "mavid plan v.toml", "mavid fly"];
        steps.iter().for_each(|step| folder.remember(step).unwrap());
        assert_eq!(fs::read_to_string(folder.of(COMMANDS)).unwrap(), "mavid plan v.toml\nmavid fly\n");
        assert_eq!(folder.remembered(), 2);
        fs::create_dir_all(folder.of("flight1")).unwrap();
        assert_eq!(folder.new_flight(), folder.of("flight1"), "an empty folder blocks nothing");
        flown(&folder.of("flight1"), &["connect", "check", "over"]);
        assert_eq!((folder.flights().len(), folder.new_flight()), (0, folder.of("flight2")));
        flown(&folder.of("flight2"), &["connect", "check", "take off", "trajectory", "land", "over"]);
        fs::write(folder.of("flight2/log_4.ulg.part"), "").unwrap();
        assert_eq!(folder.half_fetched(), [folder.of("flight2")]);
        fs::write(folder.of("flight2/log_3.ulg"), "").unwrap();
        let flights = folder.flights();
        assert_eq!((flights.len(), folder.half_fetched(), folder.cut_off()), (1, vec![], vec![]));
        assert_eq!(flights[0].onboard, Some(folder.of("flight2/log_3.ulg")));
        fs::create_dir_all(folder.of("flight3")).unwrap();
        fs::write(folder.of("flight3").join(TLOG), "").unwrap();
        assert_eq!(folder.new_flight(), folder.of("flight3"), "nobody was there");
        fs::remove_dir_all(folder.path()).unwrap();
    }

    #[test]
    fn a_flight_in_which_the_program_ended_is_not_taken_for_a_whole_one() {
        let folder = made("cut");
        for (number, end) in [(1, &["trajectory"][..]), (2, &["trajectory", "hold", "over"])] {
            let flight = folder.of(&format!("flight{number}"));
            flown(&flight, &[&["connect", "check", "take off"], end].concat());
            assert_eq!((folder.flights(), folder.cut_off().pop()), (vec![], Some(flight)), "{end:?}");
        }
        flown(&folder.of("flight3"), &["take off", "trajectory", "hold", "land", "over"]);
        assert_eq!((folder.flights().len(), folder.cut_off().len()), (1, 2));
        assert_eq!(folder.new_flight(), folder.of("flight4"));
        fs::remove_dir_all(folder.path()).unwrap();
    }

    #[test]
    fn a_flight_that_was_set_aside_does_not_count_and_is_flown_again() {
        let folder = made("aside");
        flown(&folder.of("flight1"), &["take off", "trajectory", "hands off", "over"]);
        assert_eq!(folder.flights().len(), 1);
        set_aside(&folder.of("flight1"), "this computer was too busy").unwrap();
        assert_eq!((folder.flights(), folder.cut_off()), (vec![], vec![]));
        assert_eq!(folder.new_flight(), folder.of("flight2"));
        fs::remove_dir_all(folder.path()).unwrap();
    }

    #[test]
    fn a_file_is_no_folder() {
        let folder = made("file");
        let file = folder.of("file");
        fs::write(&file, "").unwrap();
        assert!(Folder::at(file).unwrap_err().to_string().contains("is a file"));
        fs::remove_dir_all(folder.path()).unwrap();
    }
}
