//! The run of `mavid demo`: `mavid run --sitl --yes` with something concealed.

use std::fs;
use std::path::{Path, PathBuf};

use mavid::config::parse_vehicle;
use mavid::study::effects_file;
use mavid::text;

use crate::cli::{DemoArgs, RunArgs, ShapeArgs};
use crate::commands::live::{self, Work};
use crate::commands::read_once::is_read_once;
use crate::commands::run::{COMMANDS, CONCEALED, Folder, Recipe, kept, story};
use crate::commands::sitl::DEFAULT_VEHICLE;
use crate::commands::standard_error::StandardError;
use crate::commands::{CommandError, Outcome, leftover, output};

/// What is concealed where nothing else is asked for.
const EFFECTS: &str = include_str!("../../../configs/demo/concealed.toml");
/// The room, and how lively it is flown.
const LIMITS: &str = include_str!("../../../configs/demo/limits.toml");
/// The folder where none is given.
const FOLDER: &str = "mavid-demo";
/// The last file of a demo.
const LAST: &str = "export/px4-aircraft.params";

/// Runs the verb.
pub fn run(json: bool, stderr: &StandardError, args: &DemoArgs) -> Result<Outcome, CommandError> {
    let (args, stderr) = (args.clone(), stderr.clone());
    live::run(move |work| run_demo((json, &stderr), &args, work))
}

fn run_demo(out: (bool, &StandardError), args: &DemoArgs, work: &Work) -> Result<Outcome, CommandError> {
    if let Some(file) = args.effects.as_ref().filter(|file| !is_read_once(file)) {
        // a file that cannot be used is told before the work
        let vehicle = parse_vehicle(DEFAULT_VEHICLE, "the vehicle within the program")?.vehicle;
        effects_file(file, &vehicle)?;
    }
    let folder = folder(args)?;
    let effects = concealed(args.effects.as_deref(), &folder)?;
    output::file(&folder.join("limits.toml"), LIMITS)?;
    output::message("a simulated X500 is flown by PX4; something about it is concealed");
    let run = RunArgs {
        connect: None,
        sitl: true,
        autopilot: None,
        effects: Some(effects),
        mass: None,
        shape: ShapeArgs::default(),
        vehicle: None,
        room: None,
        out: Some(folder),
        flights: Some(1),
        yes: true,
        arm: false,
        rehearse: false,
        set_logging: false,
        restart: false,
        tracking_max: None,
        system_id: None,
        plain: args.plain,
    };
    story(out, (&run, Recipe { is_demo: true }), work)
}

/// The file of what is concealed, of which the folder keeps a copy. A demo that is taken up conceals what it was begun with: its flights do
/// not show anything else.
fn concealed(given: Option<&Path>, folder: &Path) -> Result<PathBuf, CommandError> {
    let copy = folder.join(CONCEALED);
    let begun_with = if is_unfinished(folder) { fs::read_to_string(&copy).ok() } else { None };
    let file = given.map_or_else(|| Ok(copy.clone()), |file| kept(file, folder))?;
    if given.is_none() {
        output::file(&copy, EFFECTS)?;
    } else if file != copy {
        let content = fs::read_to_string(&file)
            .map_err(|error| CommandError::Input(format!("cannot read {}: {error}", text::path(&file))))?;
        output::file(&copy, &content)?;
    }
    match begun_with {
        Some(before) if fs::read_to_string(&copy).ok().as_ref() != Some(&before) => {
            output::file(&copy, &before)?;
            let copy = text::path(&copy);
            Err(CommandError::Input(format!(
                "expected the effects with which this demo was begun, those of {copy}, got others: give --effects {copy}, or another --out"
            )))
        }
        _ => Ok(file),
    }
}

/// Whether a demo was begun in this folder and did not come to its end: it is taken up.
fn is_unfinished(folder: &Path) -> bool {
    let limits = fs::read_to_string(folder.join("limits.toml")).unwrap_or_default();
    folder.join(COMMANDS).is_file() && limits.starts_with(LIMITS.trim_end()) && !folder.join(LAST).exists()
}

/// Creates the folder of the arguments, or the first that is free; one that is named and holds a demo that did not come to its end is
/// taken up again.
fn folder(args: &DemoArgs) -> Result<PathBuf, CommandError> {
    let numbered = (2_u32..).map(|number| PathBuf::from(format!("{FOLDER}-{number}")));
    let free = || std::iter::once(PathBuf::from(FOLDER)).chain(numbered).find(|path| !path.exists());
    let folder = args.out.clone().or_else(free).unwrap_or_else(|| PathBuf::from(FOLDER));
    Folder::at(folder.clone())?;
    if is_unfinished(&folder) {
        return Ok(folder);
    }
    leftover::make_way(Path::new(&folder.join("flight1")), leftover::STATION)?;
    Ok(folder)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_demo_that_did_not_come_to_its_end_is_taken_up_and_nothing_else() {
        let folder = std::env::temp_dir().join(format!("mavid-demo-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        assert!(!is_unfinished(&folder));
        fs::create_dir_all(&folder).unwrap();
        fs::write(folder.join(COMMANDS), "mavid sitl\n").unwrap();
        fs::write(folder.join("limits.toml"), "[limits]\nx_max_m = 3.0\n").unwrap();
        assert!(!is_unfinished(&folder), "a run of somebody's own room");
        fs::write(folder.join("limits.toml"), LIMITS).unwrap();
        assert!(is_unfinished(&folder));
        // what it was begun with stays concealed
        let copy = concealed(None, &folder).unwrap();
        let other = folder.join("other.toml");
        fs::write(&other, "[[effect]]\nid = \"motor_lag\"\ntime_constant = 0.05\n").unwrap();
        let why = concealed(Some(&other), &folder).unwrap_err().to_string();
        assert!(why.starts_with("expected the effects with which this demo was begun"), "{why}");
        assert_eq!(fs::read_to_string(&copy).unwrap(), EFFECTS);
        assert_eq!(concealed(Some(&copy), &folder).unwrap(), copy);
        fs::create_dir_all(folder.join("export")).unwrap();
        fs::write(folder.join(LAST), "").unwrap();
        assert!(!is_unfinished(&folder));
        assert_eq!(concealed(Some(&other), &folder).unwrap(), other);
        fs::remove_dir_all(folder).unwrap();
    }
}
