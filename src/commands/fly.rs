//! `mavid fly --connect ADDRESS --trajectory T --vehicle V --out DIR`: flies, records, identifies.

use std::io::IsTerminal;
use std::path::Path;
use std::sync::mpsc::{Receiver, sync_channel};
use std::thread;
use std::time::Duration;

use mavid::config::{StoredTrajectory, read_trajectory, read_vehicle};
use mavid::fly::view::{KeyCommand, ViewModel};
use mavid::fly::{
    self, Around, Console, Course, Ending, Origin, Outcome as FlightOutcome, Record, Ride, Sortie,
};
use mavid::link::Signing;
use mavid::plan::{Roomed, with_room};
use mavid::report::{ExplanationDocument, IdentificationDocument};
use mavid::text;
use mavid::units::rad_from_deg;
use mavid::vehicle::{Limits, Vehicle};
use mavid::wire::{ComponentId, SystemId};
use serde::Serialize;
use tokio::sync::mpsc::{UnboundedSender, unbounded_channel};

use super::after_flight::Analysis;
use super::explain::Explained;
use super::flight_view::{draw, tell};
use super::identify::Identified;
use super::leftover;
use super::live::{self, Work};
use super::standard_error::StandardError;
use super::{CommandError, Outcome, output};
use crate::cli::{CheckName, FlyArgs, OriginName};

/// A ground station's component id.
const STATION: ComponentId = ComponentId(190);
/// Log lines while the view is shown, in the folder of the flight.
const LOG: &str = "log.txt";
/// Pictures that may wait for a slow terminal.
const PICTURES: usize = 4;

/// What was flown and what it says.
#[derive(Serialize)]
pub struct Document {
    schema: u32,
    directory: String,
    flight: FlightOutcome,
    setpoints: fly::StreamFigures,
    /// frames of the recording, and those that it lost
    recorded_frames: u64,
    dropped_frames: u64,
    /// `None` where the flight says nothing
    identification: Option<IdentificationDocument>,
    identification_failure: Option<String>,
    explanation: Option<ExplanationDocument>,
    explanation_failure: Option<String>,
    report: Option<String>,
}

impl Document {
    /// Of a flight recorded in a folder; without an analysis it did not land.
    pub fn new(record: &Record, folder: &Path, analysis: Option<&Analysis>) -> Self {
        let identified = analysis.map(|analysis| &analysis.identified);
        let explained = analysis.map(|analysis| &analysis.explained);
        Self {
            schema: 1,
            directory: text::path(&folder),
            flight: record.outcome.clone(),
            setpoints: record.stream,
            recorded_frames: record.recorder.frames,
            dropped_frames: record.recorder.dropped,
            identification: identified.and_then(|done| done.as_ref().ok()).map(Identified::document),
            identification_failure: identified.and_then(|done| done.as_ref().err()).cloned(),
            explanation: explained.and_then(|done| done.as_ref().ok()).map(Explained::document),
            explanation_failure: explained.and_then(|done| done.as_ref().err()).cloned(),
            report: analysis.and_then(Analysis::report).map(|path| text::path(&path)),
        }
    }
}

/// Runs the verb.
pub fn run(json: bool, stderr: &StandardError, args: &FlyArgs) -> Result<Outcome, CommandError> {
    let (args, stderr) = (args.clone(), stderr.clone());
    live::run(move |work| fly((json, &stderr), &args, work))
}

fn fly((json, stderr): (bool, &StandardError), args: &FlyArgs, work: &Work) -> Result<Outcome, CommandError> {
    let drawn = !args.plain && is_attended();
    if stderr.is_quiet() && !drawn && asks_for_the_word(args) {
        let expected = "--quiet: expected --yes beside --arm and --plain: nothing would ask for the word";
        return Err(CommandError::Input(expected.to_owned()));
    }
    let ride = ride(args)?;
    // lines of a script that did not ask for it are the script's
    let typed = args.plain || std::io::stdin().is_terminal();
    let (stderr, log) = (stderr.clone(), args.out.join(LOG));
    let record = fly_it(ride, work, move |pictures, pressed| match (drawn, typed) {
        (true, _) => draw((&stderr, log), pictures, pressed),
        (false, true) => tell(pictures, Some(pressed)),
        (false, false) => tell(pictures, None),
    })?;
    say(&record);
    let landed = matches!(record.outcome.ending, Ending::Landed | Ending::Fell);
    let system = record.system.map(|system| system.0);
    let analysis = Analysis::of((&args.out, landed), &args.vehicle, system)?;
    if json {
        output::json(&Document::new(&record, &args.out, analysis.as_ref()))?;
    } else if let Some(analysis) = &analysis {
        output::text(&analysis.page())?;
    }
    outcome(&record, analysis.as_ref())
}

/// How a flight and what was made of it end the program.
pub fn outcome(record: &Record, analysis: Option<&Analysis>) -> Result<Outcome, CommandError> {
    let outcome = &record.outcome;
    if outcome.ending == Ending::NotFlown {
        let why = outcome.cause.as_ref().map_or("no reason given".to_owned(), ToString::to_string);
        return Err(CommandError::Failure(format!("not flown: {why}")));
    }
    let whole = outcome.is_whole()
        && outcome.losses.is_empty()
        && record.recorder.is_whole()
        && record.events_failure.is_none();
    match analysis.map(Analysis::outcome) {
        Some(Err(failure)) if outcome.is_whole() => Err(failure),
        Some(Ok(outcome)) if whole => Ok(outcome),
        // it was told to fly where nothing can be identified
        None if whole => Ok(Outcome::Done),
        _ => Ok(Outcome::DoneWithLoss),
    }
}

/// Everything that is read and checked before the link is opened.
pub fn ride(args: &FlyArgs) -> Result<Ride, CommandError> {
    let input = |error: &dyn std::fmt::Display| CommandError::Input(error.to_string());
    if args.system_id == Some(args.station_id) {
        let got = args.station_id;
        return Err(input(&format!(
            "--station-id: expected another id than the vehicle's, got {got} for both"
        )));
    }
    let address = args.connect.parse().map_err(|error| input(&error))?;
    let loaded = read_vehicle(&args.vehicle)?;
    output::warnings(&args.vehicle, &loaded.warnings);
    let trajectory = read_trajectory(&args.trajectory)?;
    let sortie = sortie(args, &trajectory, &loaded.vehicle)?;
    let signing =
        args.signing_key_file.as_deref().map(Signing::open).transpose().map_err(|error| input(&error))?;
    output::signing_warnings(signing.as_ref());
    leftover::make_way(&args.out, SystemId(args.station_id))?;
    copy(&args.trajectory, &args.out.join("trajectory.toml"))?;
    copy(&args.vehicle, &args.out.join("vehicle.toml"))?;
    let parking = fly::Parking::default();
    Ok(Ride { sortie, vehicle: loaded.vehicle, address, signing, dir: args.out.clone(), parking })
}

fn copy(from: &Path, to: &Path) -> Result<(), CommandError> {
    let failed = |error| {
        CommandError::Input(format!("cannot copy {} to {}: {error}", text::path(&from), text::path(&to)))
    };
    if output::is_same(from, to) {
        return Ok(());
    }
    let text = std::fs::read(from).map_err(failed)?;
    std::fs::write(to, text).map_err(failed)
}

fn sortie(args: &FlyArgs, trajectory: &StoredTrajectory, vehicle: &Vehicle) -> Result<Sortie, CommandError> {
    // a guard beyond these would guard nothing
    let ranges = [
        ("--tracking-max", Some(args.tracking_max), 10.0),
        ("--tilt-max", args.tilt_max, 90.0),
        ("--hover-time", args.hover_time, 1e5),
        ("--gate-distance", args.gate_distance, 10.0),
        ("--gate-speed", args.gate_speed, 10.0),
    ];
    for (name, value, most) in ranges {
        if let Some(value) = value.filter(|value| !(*value > 0.0 && *value <= most)) {
            let expected = format!("expected a number above 0 and at most {most}");
            return Err(CommandError::Input(format!("{name}: {expected}, got {value}")));
        }
    }
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
fn is_attended() -> bool {
    std::io::stdin().is_terminal() && std::io::stderr().is_terminal()
}

/// The flight waits for somebody to type the word for arming.
fn asks_for_the_word(args: &FlyArgs) -> bool {
    args.arm && !args.yes && is_attended()
}

fn check(name: CheckName) -> fly::Check {
    match name {
        CheckName::HoverThrust => fly::Check::HoverThrust,
        CheckName::Rotors => fly::Check::Rotors,
    }
}

/// The flight, watched by another thread: neither a slow terminal nor a key holds it up.
pub fn fly_it(
    ride: Ride,
    work: &Work,
    watch: impl FnOnce(&Receiver<ViewModel>, &UnboundedSender<KeyCommand>) + Send + 'static,
) -> Result<Record, CommandError> {
    let failed = |error: &dyn std::fmt::Display| CommandError::Failure(error.to_string());
    // the link's tasks carry the setpoints
    let runtime = tokio::runtime::Builder::new_multi_thread()
        .enable_all()
        .on_thread_start(|| {
            // the thread of setpoints says where this is refused
            let _ = fly::raise_priority();
        })
        .build()
        .map_err(|error| failed(&error))?;
    let (show, pictures) = sync_channel(PICTURES);
    let (pressed, keys) = unbounded_channel();
    let viewer = thread::Builder::new()
        .name("view".into())
        .spawn(move || watch(&pictures, &pressed))
        .map_err(|error| failed(&error))?;
    work.flies();
    let record = runtime.block_on(fly::run(ride, Console { show, keys }));
    work.ends_itself();
    // its pictures have ended with the flight
    let _ = viewer.join();
    record.map_err(|error| failed(&error))
}

/// Says how it went.
pub fn say(record: &Record) {
    let FlightOutcome { cause, ending, flown, losses } = &record.outcome;
    let how = match ending {
        Ending::NotFlown => "not flown".to_owned(),
        Ending::Landed => "landed".to_owned(),
        Ending::Fell => "fallen".to_owned(),
        Ending::InTheAir(mode) => format!("left in the air, mode {mode}"),
    };
    let why = cause.as_ref().map_or_else(String::new, |cause| format!(": {cause}"));
    let said = format!("{how}{why}");
    if record.outcome.is_whole() {
        output::message(&said)
    } else {
        output::error(&said)
    }
    output::message(&format!(
        "{} periods, {:.3} m rms off the reference, {:.3} m at most; tilt {:.1} degrees, planned {:.1}",
        flown.periods, flown.tracking_rms_m, flown.tracking_max_m, flown.tilt_max_deg, flown.tilt_planned_deg
    ));
    let stream = &record.stream;
    output::message(&format!(
        "{} setpoints, {} of them more than 3 ms late, {} overtaken by the next, {} refused by the link; {} frames \
         recorded, {} lost",
        stream.sent,
        stream.late,
        stream.overtaken,
        stream.refused,
        record.recorder.frames,
        record.recorder.dropped
    ));
    for loss in losses {
        output::warning(loss);
    }
    if let Some(failure) = &record.events_failure {
        output::warning(&format!("{}: {failure}", fly::EVENTS));
    }
    if let Some(failure) = &record.recorder.failure {
        output::warning(&format!("{}: cannot write: {failure}", fly::TLOG));
    }
    if record.recorder.doubtful > 0 {
        let count = record.recorder.doubtful;
        output::warning(&format!("the system could not confirm that {count} frames are on the disk"));
    }
}
