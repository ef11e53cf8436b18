//! `inspect`: streaming against batch, bounded memory, damaged and incomplete logs, exit status.

use crate::flight_log;
use crate::support;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use mavid::config::read_vehicle;
use mavid::diagnose::LAW_OF_TORQUE;
use mavid::inspect::{Inspection, Reading, inspect, inspect_recording};
use mavid::log::{self, LogError, OpenOptions};
use mavid::recording::StreamStats;
use mavid::vehicle::Vehicle;
use mavid::wire::SystemId;
use support::{header, heartbeat, record, tlog, v2};

fn scratch(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("inspect-{name}"))
}

fn written(name: &str, bytes: &[u8]) -> PathBuf {
    let path = scratch(name);
    std::fs::write(&path, bytes).unwrap();
    path
}

fn x500() -> Vehicle {
    read_vehicle(&Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/x500.toml")).unwrap().vehicle
}

fn inspected(path: &Path, vehicle: Option<&Vehicle>) -> Inspection {
    inspect(path, &OpenOptions::default(), vehicle, &mut |_| ()).unwrap()
}

fn mavid(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_mavid")).args(arguments).output().unwrap()
}

#[test]
fn streaming_gives_what_the_whole_recording_gives() {
    let path = scratch("inspect-batch.tlog");
    flight_log::write_flight_log(&path, 2_500_000).unwrap();
    let vehicle = x500();
    let streamed = inspected(&path, Some(&vehicle));
    let opened = log::open(&path, &OpenOptions::default()).unwrap();
    let batch = inspect_recording(&opened, Some(&vehicle));
    assert_eq!(streamed.streams, batch.streams);
    assert_eq!(streamed.flight, batch.flight);
    assert_eq!(streamed.excitation, batch.excitation);
    assert_eq!(streamed.identifiability, batch.identifiability);
    assert_eq!(streamed.timeline, batch.timeline);
    assert_eq!(streamed.numbers_held_max, batch.numbers_held_max);
    for (key, stream) in &opened.recording.streams {
        let found = streamed
            .streams
            .iter()
            .find(|s| s.source == key.source && s.quantity == key.quantity.name())
            .unwrap();
        assert_eq!(found.rate_hz.to_bits(), StreamStats::of(stream).rate_hz.to_bits());
    }
    assert!((streamed.flight.segments[0].start_s - flight_log::GROUND_S).abs() < 1.5);
    assert!((streamed.excitation.unwrap().angular_acceleration_rms_rad_s2.unwrap()[0] - 1.03).abs() < 0.03);
}

#[test]
fn what_is_held_does_not_grow_with_the_log() {
    let held = |name: &str, bytes: u64| {
        let path = scratch(name);
        let length_s = flight_log::write_flight_log(&path, bytes).unwrap();
        let inspection = inspected(&path, None);
        std::fs::remove_file(&path).unwrap();
        (length_s, inspection)
    };
    let (_, small) = held("inspect-20.tlog", 20_000_000);
    let (length_s, large) = held("inspect-200.tlog", 200_000_000);
    // two minutes of 125 Hz: some 30 numbers a step
    assert!(large.numbers_held_max <= small.numbers_held_max + 100, "{}", large.numbers_held_max);
    assert!(large.numbers_held_max < 600_000, "{}", large.numbers_held_max);
    let cycles = (length_s / flight_log::CYCLE_S).ceil();
    assert_eq!(large.flight.segments.len() as f64, cycles);
    let whole = flight_log::CYCLE_S - flight_log::GROUND_S;
    assert!((large.flight.segments[1].end_s - large.flight.segments[1].start_s - whole).abs() < 2.0);
    assert!(large.losses.is_empty());
}

#[test]
fn windows_together_say_more_than_one_alone() {
    let vehicle = x500();
    let relative = |name: &str, bytes: u64| {
        let path = scratch(name);
        flight_log::write_flight_log(&path, bytes).unwrap();
        let inspection = inspected(&path, Some(&vehicle));
        std::fs::remove_file(&path).unwrap();
        (inspection.flight.usable_s, inspection.identifiability[1].std_relative.unwrap())
    };
    let (short_s, short) = relative("inspect-short.tlog", 2_900_000);
    let (long_s, long) = relative("inspect-long.tlog", 11_600_000);
    assert!(long_s > 4.0 * short_s, "{short_s} {long_s}");
    // the error of the torque law does not become less
    let by_noise = |relative: f64| (relative.powi(2) - LAW_OF_TORQUE[0].powi(2)).sqrt();
    let (ratio, expected) = (by_noise(long) / by_noise(short), (short_s / long_s).sqrt());
    assert!((ratio / expected - 1.0).abs() < 0.35, "{short} {long}, expected ratio {expected}");
}

#[test]
fn damage_is_counted_and_is_status_three() {
    let path = scratch("inspect-damaged.tlog");
    flight_log::write_flight_log(&path, 500_000).unwrap();
    let clean = mavid(&["inspect", path.to_str().unwrap(), "--json"]);
    assert_eq!(clean.status.code(), Some(0));
    let mut bytes = std::fs::read(&path).unwrap();
    bytes.truncate(bytes.len() - 10);
    let cut = written("inspect-cut.tlog", &bytes);
    bytes.splice(250_000..250_000, [0x55; 333]);
    bytes[100_000] ^= 0xff;
    let broken = written("inspect-broken.tlog", &bytes);
    for (path, losses) in [(cut, 1), (broken, 2)] {
        let output = mavid(&["inspect", path.to_str().unwrap(), "--json"]);
        assert_eq!(output.status.code(), Some(3), "{}", path.display());
        let document: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(document["schema"], 1);
        assert!(document["losses"].as_array().unwrap().len() >= losses, "{}", document["losses"]);
        assert_eq!(document["reading"]["format"], "tlog");
        let text = mavid(&["inspect", path.to_str().unwrap()]);
        assert!(String::from_utf8(text.stdout).unwrap().contains("! lost: "));
    }
}

#[test]
fn what_is_no_log_is_status_two_with_a_message() {
    let empty = written("inspect-empty.tlog", b"");
    let text = written("inspect-text.tlog", "this is no log\n".repeat(200).as_bytes());
    let table = written("inspect-text.csv", b"");
    let folder = env!("CARGO_TARGET_TMPDIR");
    let name = |path: &Path| path.display().to_string();
    for (argument, expected) in [
        (name(&empty), "empty"),
        (name(&text), "text that is no log and has no header of columns"),
        (name(&table), "empty file"),
        (folder.to_owned(), "folder"),
        ("absent.tlog".to_owned(), "absent.tlog"),
        ("absent".to_owned(), "cannot open"),
    ] {
        let output = mavid(&["inspect", &argument, "--json"]);
        assert_eq!(output.status.code(), Some(2), "{argument}");
        let document: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(document["error"]["exit_status"], 2, "{argument}");
        let message = String::from_utf8(output.stderr).unwrap();
        assert!(message.contains(expected), "{argument}: {message}");
    }
}

#[test]
fn two_vehicles_and_none_with_a_heartbeat_are_inspected() {
    let mut frames = Vec::new();
    for index in 0..60_u8 {
        let system = 1 + u32::from(index % 2);
        let message = if index < 2 { heartbeat() } else { support::attitude(1000 + u32::from(index) * 10) };
        frames.push(v2(header(system, index / 2), &message));
    }
    let path = written("inspect-two.tlog", &tlog(&frames));
    let first = inspected(&path, None);
    assert_eq!((first.vehicle.system, first.vehicle.others.as_slice()), (Some(1), [2].as_slice()));
    assert!(first.advice.iter().any(|advice| advice.contains("--system-id")));
    let options = OpenOptions { system: Some(SystemId(2)), ..OpenOptions::default() };
    let second = inspect(&path, &options, None, &mut |_| ()).unwrap();
    assert_eq!(second.vehicle.system, Some(2));
    let absent = OpenOptions { system: Some(SystemId(9)), ..OpenOptions::default() };
    assert!(matches!(
        inspect(&path, &absent, None, &mut |_| ()),
        Err(LogError::SystemAbsent { requested: SystemId(9), .. })
    ));

    let silent = written("inspect-silent.tlog", &tlog(&support::attitudes(100)));
    let inspection = inspected(&silent, None);
    assert!(inspection.vehicle.without_heartbeat);
    assert_eq!(inspection.streams.iter().map(|stream| stream.count).max(), Some(100));
    assert!(inspection.verdict.contains("no actuator outputs"), "{}", inspection.verdict);
}

#[test]
fn a_reboot_splits_the_flight_and_is_told() {
    let mut bytes = Vec::new();
    for (index, boot_ms) in
        (0..400_u32).map(|i| (i, 50_000 + i * 20)).chain((400..800).map(|i| (i, 500 + i * 20)))
    {
        let stamp_us = support::START_US + u64::from(index) * 20_000;
        let sequence = u8::try_from(index % 256).unwrap();
        if index.is_multiple_of(50) {
            bytes.extend(record(stamp_us, &v2(header(1, sequence), &heartbeat())));
        }
        bytes.extend(record(stamp_us, &v2(header(1, sequence), &support::attitude(boot_ms))));
    }
    let inspection = inspected(&written("inspect-reboot.tlog", &bytes), None);
    assert_eq!(inspection.clock.resets_s.len(), 1);
    assert!(inspection.streams.iter().any(|stream| stream.resets == 1));
}

#[test]
fn the_truth_of_a_simulator_is_counted_and_not_shown() {
    let simstate = mavlink::dialects::ardupilotmega::MavMessage::SIMSTATE(Default::default());
    let mut frames = vec![v2(header(1, 0), &heartbeat())];
    frames.extend((1..20).map(|index| v2(header(1, index), &simstate)));
    let path = written("inspect-truth.tlog", &tlog(&frames));
    let inspection = inspected(&path, None);
    let Reading::Tlog(reading) = &inspection.reading else { panic!("a tlog") };
    assert_eq!(reading.withheld_truth, 19);
    assert!(inspection.streams.iter().all(|stream| stream.source == "HEARTBEAT"));
}

#[test]
fn every_shared_flight_is_inspected_without_and_with_its_vehicle() {
    let Some(shared) = support::shared() else { return };
    let folders = ["cases", "noisy", "recordings/autopilots"].map(|folder| shared.join(folder));
    // of many flights of one kind a few do
    let few = |folder: &PathBuf| {
        let files = support::files(folder, "tlog");
        let step = 1 + files.len() / 20;
        files.into_iter().step_by(step)
    };
    for path in folders.iter().flat_map(few) {
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        let vehicle = match &name {
            name if name.starts_with("ap_") => path.with_file_name("ardupilot-quad.toml"),
            name if name.starts_with("px4_") => path.with_file_name("px4-sih.toml"),
            _ => path.with_file_name("vehicle.toml"),
        };
        let vehicle = read_vehicle(&vehicle).unwrap().vehicle;
        // a mission flown on an estimator's belief need not turn enough for inertia; without a vehicle file that is said
        let needs = if path.starts_with(shared.join("noisy")) { "mass" } else { "mass, Ixx" };
        let verdict = inspected(&path, None).verdict;
        let expected = format!("The log contains the data for identifying {needs}");
        assert!(verdict.starts_with(&expected), "{}: {verdict}", path.display());
        let inspection = inspected(&path, Some(&vehicle));
        // the stated torque per thrust of one vehicle is far from what it flew with, as `identify` says of it too
        let far =
            ["0.29", "0.3"].map(|by| format!("it contradicts the vehicle file, izz by a factor of {by}"));
        let far = far.iter().any(|far| inspection.verdict.contains(far));
        assert!(
            inspection.verdict.starts_with("This log is good for mass") || far && name.starts_with("ap_"),
            "{}: {}",
            path.display(),
            inspection.verdict
        );
        let mass = inspection.identifiability[0].std_relative.unwrap();
        assert!(mass < 0.05, "{name}: {mass}");
        assert!(inspection.losses.is_empty(), "{name}");
    }
}

#[test]
fn every_shared_log_of_a_simulator_with_a_log_on_board_is_inspected() {
    let Some(shared) = support::shared() else { return };
    let paths = support::files(&shared.join("onboard"), "tlog");
    let (mut turned, mut still) = (0, 0);
    for path in &paths {
        let inspection = inspected(path, None);
        let verdict = &inspection.verdict;
        let (needs, stood) = (
            "The log contains the data for identifying mass",
            "Nothing can be identified from this log: no stretch of flight can be used",
        );
        assert!(verdict.starts_with(needs) || verdict.starts_with(stood), "{}: {verdict}", path.display());
        // one takes off, stands in the air for 3 s and lands
        still += usize::from(verdict.starts_with(stood));
        assert!(inspection.losses.is_empty(), "{}: {:?}", path.display(), inspection.losses);
        turned +=
            usize::from(verdict.starts_with("The log contains the data for identifying mass, Ixx, Iyy, Izz"));
    }
    // some of the flights go straight
    assert!(paths.len() >= 32 && turned >= 24 && still <= 1, "{turned} and {still} of {}", paths.len());
}

#[test]
fn every_shared_table_is_inspected() {
    let Some(shared) = support::shared() else { return };
    for path in support::files(&shared.join("recordings"), "csv") {
        let vehicle = read_vehicle(&path.with_file_name("vehicle.toml")).unwrap().vehicle;
        let inspection = inspect(&path, &OpenOptions::default(), Some(&vehicle), &mut |_| ()).unwrap();
        assert!(!inspection.verdict.is_empty());
        let ixx = &inspection.identifiability[1];
        if path.display().to_string().contains("crazypad") {
            assert!(ixx.reason.as_ref().unwrap().starts_with("no body rates"), "{ixx:?}");
        }
    }
}
