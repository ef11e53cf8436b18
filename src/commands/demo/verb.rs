//! The run of `mavid demo`, from the plan to the comparison with what had been concealed.

use std::path::{Path, PathBuf};
use std::time::Instant;

use mavid::config::parse_vehicle;
use mavid::fly::{Ending, SETPOINT_HZ};
use mavid::report::explanation_answer;
use mavid::text;
use mavid::wire::SystemId;
use serde::Serialize;

use super::concealed::{Compared, compare, concealed, table};
use super::embedded::Embedded;
use super::progress::{self, Progress};
use crate::cli::{CriterionName, DemoArgs, DraftArgs, FlyArgs, OriginName, PlanArgs, ShapeArgs};
use crate::commands::after_flight::Analysis;
use crate::commands::live::{self, Work};
use crate::commands::sitl::DEFAULT_VEHICLE;
use crate::commands::standard_error::StandardError;
use crate::commands::words::Word;
use crate::commands::{CommandError, Outcome, fly, leftover, output, plan};

/// The room, and how lively it is flown.
const LIMITS: &str = include_str!("../../../configs/demo/limits.toml");
/// The system id of the demo's station.
const STATION: u32 = 255;
/// The folder where none is given.
const FOLDER: &str = "mavid-demo";

/// What was flown, what it says, and what had been concealed.
#[derive(Serialize)]
struct Document {
    #[serde(flatten)]
    flown: fly::Document,
    concealed: Vec<Compared>,
    /// wall clock
    took_s: f64,
}

/// Runs the verb.
pub fn run(json: bool, stderr: &StandardError, args: &DemoArgs) -> Result<Outcome, CommandError> {
    let (args, stderr) = (args.clone(), stderr.clone());
    live::run(move |work| show((json, &stderr), &args, work))
}

fn show(
    (json, stderr): (bool, &StandardError),
    args: &DemoArgs,
    work: &Work,
) -> Result<Outcome, CommandError> {
    let since = Instant::now();
    let vehicle = parse_vehicle(DEFAULT_VEHICLE, "the vehicle within the program")?.vehicle;
    // a file that cannot be used is told before the work
    concealed(args.effects.as_deref(), &vehicle)?;
    let folder = folder(args)?;
    let progress = Progress::new(stderr, !args.plain && stderr.can_draw());
    let done = story(args, &folder, (&progress, stderr, work));
    progress.end();
    let (record, analysis) = done?;
    fly::words(&record).iter().for_each(Word::say);
    // the verdict is written: only now is it read again what had been concealed
    let acting = concealed(args.effects.as_deref(), &vehicle)?;
    let explained = analysis.as_ref().and_then(|analysis| analysis.explained.as_ref().ok());
    let rows = compare(&acting, explained.map_or(&[], |study| study.effects.as_slice()));
    let took_s = since.elapsed().as_secs_f64();
    if json {
        let flown = fly::Document::new(&record, &folder, analysis.as_ref());
        output::json(&Document { flown, concealed: rows, took_s })?;
    } else {
        let report = analysis.as_ref().and_then(Analysis::report);
        let parts = [
            explained.map(explanation_answer),
            Some(table(&rows, &vehicle)),
            report.map(|path| format!("{took_s:.0} s; report: {}", text::path(&path))),
        ];
        output::text(&parts.into_iter().flatten().collect::<Vec<_>>().join("\n\n"))?;
    }
    let remarks = analysis.as_ref().map(Analysis::remarks).unwrap_or_default();
    remarks.iter().for_each(Word::say);
    fly::outcome(&record, analysis.as_ref())
}

/// Plans, flies and analyses.
fn story(
    args: &DemoArgs,
    folder: &Path,
    (progress, stderr, work): (&Progress, &StandardError, &Work),
) -> Result<(mavid::fly::Record, Option<Analysis>), CommandError> {
    let vehicle = folder.join("vehicle.toml");
    let (limits, trajectory) = (folder.join("limits.toml"), folder.join("trajectory.toml"));
    output::file(&vehicle, DEFAULT_VEHICLE)?;
    output::file(&limits, LIMITS)?;
    progress.stage("planning the identification trajectory", 0);
    plan::make(stderr, &plan_args(&vehicle, limits, &trajectory))?;
    let embedded = Embedded::start(args.effects.clone())?;
    let port = embedded.port;
    progress.say(&format!(
        "planned {}; a simulated X500 flown by PX4 listens on UDP port {port}, something about it is concealed",
        text::path(&trajectory)
    ));
    let mut ride = fly::ride(&fly_args(port, &vehicle, &trajectory, folder))?;
    ride.sortie.own_vehicle = Some(embedded.nonce);
    progress.stage("connecting", progress::PLANNED);
    let watched = progress.clone();
    let record = fly::fly_it(ride, work, move |pictures, _| watched.follow(pictures));
    embedded.stop();
    let (record, _) = record?;
    let landed = record.outcome.ending == Ending::Landed;
    progress.stage("identifying and explaining", progress::LANDED);
    let tell = &mut |word: Word| word.say();
    let analysis = Analysis::of((folder, landed, None), &vehicle, record.system, tell)?;
    Ok((record, analysis))
}

/// Creates the folder of the arguments, or the first that is free.
fn folder(args: &DemoArgs) -> Result<PathBuf, CommandError> {
    let numbered = (2_u32..).map(|number| PathBuf::from(format!("{FOLDER}-{number}")));
    let free = || std::iter::once(PathBuf::from(FOLDER)).chain(numbered).find(|path| !path.exists());
    let folder = args.out.clone().or_else(free).unwrap_or_else(|| PathBuf::from(FOLDER));
    leftover::make_way(&folder, SystemId(STATION))?;
    Ok(folder)
}

fn plan_args(vehicle: &Path, limits: PathBuf, trajectory: &Path) -> PlanArgs {
    PlanArgs {
        vehicle: Some(vehicle.to_owned()),
        draft: DraftArgs::default(),
        out: Some(trajectory.to_owned()),
        limits: Some(limits),
        criterion: CriterionName::DOpt,
        seed: 1,
        starts: 8,
        repeats: 4,
        period: 6.0,
        harmonics: 5,
        start: None,
        check: None,
        circle: None,
        takeoff: None,
        landing: None,
    }
}

fn fly_args(port: u16, vehicle: &Path, trajectory: &Path, folder: &Path) -> FlyArgs {
    FlyArgs {
        connect: format!("udpout:127.0.0.1:{port}"),
        trajectory: trajectory.to_owned(),
        vehicle: Some(vehicle.to_owned()),
        mass: None,
        shape: ShapeArgs::default(),
        out: folder.to_owned(),
        arm: false,
        yes: true,
        system_id: None,
        station_id: STATION,
        repeats: None,
        setpoint_hz: SETPOINT_HZ,
        origin: OriginName::Local,
        tracking_max: 1.0,
        tilt_max: None,
        hover_time: None,
        gate_distance: None,
        gate_speed: None,
        accept: Vec::new(),
        signing_key_file: None,
        set_logging: false,
        fetch_log: false,
        no_fetch_log: true,
        plain: true,
    }
}
