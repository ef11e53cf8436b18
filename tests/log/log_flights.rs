//! The flights of one log: what divides them, and how much of a log is held.

use crate::support;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use mavid::log::{self, Flights, Hold, LogError, LogFlight, OpenOptions, open_flights};
use mavid::recording::{Quantity, Recording, Stream, StreamKey};
use mavid::wire::{CrcSeeds, SystemId, checksum};
use mavlink::dialects::ardupilotmega::{self as dialect, MavMessage};
use serde_json::Value;
use support::{header, heartbeat, record, v2};

/// What is kept of a log here.
const MOST: Hold = Hold { seconds: 1200.0, numbers: 1_000_000, short_s: 0.0 };

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures").join(name)
}

/// A file of this test alone.
fn written(name: &str, bytes: &[u8]) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("log_flights-{name}"));
    std::fs::write(&path, bytes).unwrap();
    path
}

fn mavid(verb: &str, log: &Path) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_mavid"));
    command.args(["--json", verb]).arg(log).arg("--vehicle").arg(fixture("p01_vehicle.toml"));
    command.output().unwrap()
}

fn document(output: &Output) -> Value {
    serde_json::from_slice(&output.stdout).unwrap()
}

fn key(quantity: Quantity) -> StreamKey {
    StreamKey { quantity, source: "TEST", instance: 0 }
}

/// A stream that moves.
fn stream(times_s: &[f64], width: usize) -> Stream {
    let values = times_s.iter().flat_map(|t| (0..width).map(move |channel| (t + channel as f64).sin()));
    Stream { time_s: times_s.to_vec(), width, values: values.collect() }
}

fn every(period_s: f64, spans_s: &[(f64, f64)]) -> Vec<f64> {
    let steps = |(from_s, to_s): &(f64, f64)| {
        let from_s = *from_s;
        let count = ((to_s - from_s) / period_s).round();
        std::iter::successors(Some(0.0), |index| Some(index + 1.0))
            .take_while(move |index| *index < count)
            .map(move |index| from_s + period_s * index)
    };
    spans_s.iter().flat_map(steps).collect()
}

/// Body rates and commands at 50 Hz in these spans, and whether the vehicle is armed each second of others.
fn recording(spans_s: &[(f64, f64)], armed_s: &[(f64, f64)], told_s: (f64, f64)) -> Recording {
    let flown = every(0.02, spans_s);
    let told = every(1.0, &[told_s]);
    let armed = |t: &f64| f64::from(u8::from(armed_s.iter().any(|(from, to)| (*from..*to).contains(t))));
    let said = Stream { width: 1, values: told.iter().map(armed).collect(), time_s: told };
    let mut recording = Recording::default();
    recording.streams.insert(key(Quantity::AngularRate), stream(&flown, 3));
    recording.streams.insert(key(Quantity::ActuatorCommand), stream(&flown, 4));
    recording.streams.insert(key(Quantity::Armed), said);
    recording
}

fn span_s(recording: &Recording) -> (f64, f64) {
    let rates = &recording.streams[&key(Quantity::AngularRate)];
    (rates.time_s[0], rates.time_s[rates.len() - 1])
}

#[test]
fn a_recording_of_one_flight_stays_as_it_is() {
    // a hole of half a minute is none between flights
    let one = recording(&[(0.0, 70.0), (100.0, 150.0)], &[(5.0, 145.0)], (0.0, 150.0));
    let flights = Flights::of(one.clone(), &MOST);
    assert_eq!(
        flights,
        Flights { flights: vec![LogFlight { recording: one, part_s: None }], left_out_s: 0.0 }
    );
}

#[test]
fn flights_far_apart_are_flights_of_their_own_whatever_lies_between() {
    for apart_s in [100.0, 3600.0, 864_000.0] {
        let second_s = (60.0 + apart_s, 130.0 + apart_s);
        let mut log = recording(&[(0.0, 60.0), second_s], &[(0.0, 1e9)], (0.0, second_s.1));
        // a slow stream goes on all the time
        let slow = StreamKey { source: "SLOW", ..key(Quantity::AngularRate) };
        log.streams.insert(slow, stream(&every(10.0, &[(0.0, second_s.1)]), 3));
        let flights = Flights::of(log, &MOST).flights;
        assert_eq!(flights.len(), 2);
        for (flight, (from_s, to_s)) in flights.iter().zip([(0.0, 60.0), second_s]) {
            let part_s = flight.part_s.unwrap();
            let (first_s, last_s) = span_s(&flight.recording);
            assert!((part_s.0 + first_s - from_s).abs() < 1e-6, "{part_s:?} {first_s}");
            assert!((part_s.0 + last_s - to_s).abs() < 0.03, "{part_s:?} {last_s}");
            assert!(part_s.1 - part_s.0 < 200.0, "{part_s:?}");
        }
        // what it said last before the second flight holds in it
        assert!(flights[1].recording.streams[&key(Quantity::Armed)].time_s[0] <= 0.0);
    }
}

#[test]
fn margins_in_which_nothing_is_recorded_are_nothing_that_is_left_out() {
    let most = Hold { seconds: 480.0, numbers: 3_000_000, short_s: 0.0 };
    for count in [3_u8, 4, 8, 12] {
        let spans: Vec<(f64, f64)> =
            (0..count).map(|day| 86_400.0 * f64::from(day)).map(|from_s| (from_s, from_s + 20.0)).collect();
        let Flights { flights, left_out_s } = Flights::of(recording(&spans, &spans, (0.0, 20.0)), &most);
        assert_eq!((flights.len(), left_out_s), (usize::from(count), 0.0));
        for flight in &flights {
            let (first_s, last_s) = span_s(&flight.recording);
            assert!(last_s - first_s > 19.9, "{first_s} to {last_s}");
        }
    }
}

#[test]
fn a_stretch_on_the_ground_is_no_flight_beside_one_that_is() {
    let log = recording(&[(0.0, 60.0), (300.0, 400.0)], &[(305.0, 395.0)], (0.0, 400.0));
    let flights = Flights::of(log, &MOST).flights;
    assert_eq!(flights.len(), 1);
    assert_eq!(flights[0].part_s.unwrap().0, 300.0);
    // where nothing flies, what there is
    let log = recording(&[(0.0, 60.0), (300.0, 400.0)], &[], (0.0, 400.0));
    assert_eq!(Flights::of(log, &MOST).flights.len(), 2);
}

#[test]
fn of_hours_on_the_ground_the_flight_is_kept_and_of_hours_in_the_air_the_first_minutes() {
    let log = recording(&[(0.0, 9000.0)], &[(8000.0, 8300.0)], (0.0, 9000.0));
    let Flights { flights, left_out_s } = Flights::of(log, &MOST);
    let (from_s, to_s) = flights[0].part_s.unwrap();
    assert!((7980.0..=8000.0).contains(&from_s) && (8300.0..=8320.0).contains(&to_s), "{from_s} to {to_s}");
    assert_eq!((flights.len(), left_out_s), (1, 0.0));

    let log = recording(&[(0.0, 9000.0)], &[(0.0, 9000.0)], (0.0, 9000.0));
    let Flights { flights, left_out_s } = Flights::of(log, &MOST);
    let (from_s, to_s) = flights[0].part_s.unwrap();
    assert!(from_s == 0.0 && to_s < 2000.0 && left_out_s > 7000.0, "to {to_s}");
}

#[test]
fn times_that_are_no_numbers_and_a_log_of_nothing_divide_nothing() {
    assert_eq!(Flights::of(Recording::default(), &MOST).flights.len(), 1);
    let mut odd = recording(&[(0.0, 60.0)], &[], (0.0, 60.0));
    for (instance, time_s) in [(0, 1e300), (1, f64::INFINITY), (2, f64::NAN), (3, -1e300)] {
        let key = StreamKey { instance, ..key(Quantity::Mode) };
        odd.streams.insert(key, Stream { time_s: vec![time_s], width: 1, values: vec![1.0] });
    }
    let flights = Flights::of(odd, &MOST).flights;
    assert_eq!(flights.len(), 1);
    assert_eq!(flights[0].recording.streams[&key(Quantity::AngularRate)].len(), 3000);
}

/// Where a message keeps its time and in which unit, as far as the fixture has it.
fn clock(message_id: u32) -> Option<(bool, usize)> {
    match message_id {
        30 | 31 | 32 | 83 | 85 => Some((false, 0)),
        105 | 291 | 375 => Some((true, 0)),
        _ => None,
    }
}

/// The frame of a vehicle whose clock is further on.
fn later(frame: &[u8], by_us: u64) -> Vec<u8> {
    let id = u32::from_le_bytes([frame[7], frame[8], frame[9], 0]);
    let Some((micro, at)) = clock(id) else { return frame.to_vec() };
    let (mut body, size) = (frame[10..frame.len() - 2].to_vec(), if micro { 8 } else { 4 });
    body.resize(body.len().max(at + size), 0);
    if micro {
        let us = u64::from_le_bytes(body[at..at + 8].try_into().unwrap()) + by_us;
        body[at..at + 8].copy_from_slice(&us.to_le_bytes());
    } else {
        let ms = u32::from_le_bytes(body[at..at + 4].try_into().unwrap());
        let ms = ms.wrapping_add(u32::try_from(by_us / 1000).unwrap());
        body[at..at + 4].copy_from_slice(&ms.to_le_bytes());
    }
    let mut out = frame[..10].to_vec();
    out[1] = u8::try_from(body.len()).unwrap();
    out.extend(body);
    let sum = checksum(&out[1..], CrcSeeds::new().get(id).unwrap());
    out.extend(sum.to_le_bytes());
    out
}

/// The fixture's flight twice, so long apart; `goes_on`: the vehicle's clock did not start anew.
fn twice(apart_s: u64, goes_on: bool) -> Vec<u8> {
    let bytes = std::fs::read(fixture("p01_identify_0_25s.tlog")).unwrap();
    let (records, _) = support::read(&bytes);
    let by_us = records[records.len() - 1].0 - records[0].0 + apart_s * 1_000_000;
    let second = records.iter().flat_map(|(stamp_us, frame)| {
        record(stamp_us + by_us, &if goes_on { later(frame, by_us) } else { frame.clone() })
    });
    let mut all = bytes.clone();
    all.extend(second);
    all
}

#[test]
fn two_flights_of_a_log_are_identified_whatever_lies_between_them() {
    let alone = document(&mavid("identify", &fixture("p01_identify_0_25s.tlog")));
    let mass = |document: &Value| document["best"]["parameters"]["mass"]["value"].as_f64().unwrap();
    for (apart_s, goes_on) in [(3600, true), (86_400, false), (864_000, true), (864_000, false)] {
        let log = written(&format!("apart-{apart_s}-{goes_on}.tlog"), &twice(apart_s, goes_on));
        let output = mavid("identify", &log);
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        let both = document(&output);
        let flights = both["data_quality"]["flights"].as_array().unwrap();
        assert_eq!(flights.len(), 2);
        // the grid, and with it the memory, is that of the data
        let total_s: f64 = flights.iter().map(|flight| flight["total_s"].as_f64().unwrap()).sum();
        assert!((40.0..51.0).contains(&total_s), "{total_s} s");
        assert!((mass(&both) / mass(&alone) - 1.0).abs() < 0.01, "{} {}", mass(&both), mass(&alone));
        let inputs = both["data_quality"]["inputs"].as_array().unwrap();
        assert!(inputs[1]["path"].as_str().unwrap().contains("flight 2 of 2"), "{inputs:?}");
        let inspected = mavid("inspect", &log);
        assert_eq!(document(&inspected)["flight"]["segments"].as_array().unwrap().len(), 2);
    }
}

#[test]
fn two_flights_of_a_log_are_explained() {
    let log = written("apart-explained.tlog", &twice(864_000, true));
    let output = mavid("explain", &log);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let document = document(&output);
    assert_eq!(document["verdict"], "nothing_missing");
    assert_eq!(document["data_quality"]["inputs"].as_array().unwrap().len(), 2);
}

fn beat(system: u32, armed: bool) -> Vec<u8> {
    let MavMessage::HEARTBEAT(mut data) = heartbeat() else { panic!() };
    data.base_mode.set(dialect::MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED, armed);
    v2(header(system, 0), &MavMessage::HEARTBEAT(data))
}

/// The fixture's flight with what others send from its beginning on, each every second.
fn among(others: &[Vec<u8>]) -> Vec<u8> {
    let bytes = std::fs::read(fixture("p01_identify_0_25s.tlog")).unwrap();
    let (records, _) = support::read(&bytes);
    let mut out = Vec::new();
    let mut due_us = records[0].0;
    for (stamp_us, frame) in &records {
        if *stamp_us >= due_us {
            others.iter().for_each(|other| out.extend(record(*stamp_us, other)));
            due_us += 1_000_000;
        }
        out.extend(record(*stamp_us, frame));
    }
    out
}

#[test]
fn heartbeats_of_others_do_not_hide_who_flew() {
    let others =
        [beat(2, true), beat(7, true), beat(33, false), v2(header(250, 0), &support::ground_heartbeat())];
    let log = written("foreign.tlog", &among(&others));
    let alone = log::open(&fixture("p01_identify_0_25s.tlog"), &OpenOptions::default()).unwrap().recording;
    let loaded = open_flights(&log, &OpenOptions::default(), &MOST).unwrap();
    assert_eq!(loaded.flights.flights.len(), 1);
    assert_eq!(loaded.flights.flights[0].recording.streams, alone.streams);
    assert_eq!(loaded.report.vehicle.unwrap().system, SystemId(1));
    assert_eq!(loaded.report.others, [SystemId(2), SystemId(7), SystemId(33)]);
    for verb in ["identify", "explain", "inspect"] {
        let output = mavid(verb, &log);
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{verb}: {told}");
        let said = if verb == "inspect" { document(&output)["advice"].to_string() } else { told };
        assert!(said.contains("system 1") && said.contains("2, 7, 33"), "{verb}: {said}");
    }
}

#[test]
fn of_two_vehicles_the_one_that_was_armed_and_moved_is_taken_and_of_two_that_were_none() {
    let turning = |system, time_ms| {
        let data = dialect::ATTITUDE_DATA { time_boot_ms: time_ms, yawspeed: 1.0, ..Default::default() };
        v2(header(system, 0), &MavMessage::ATTITUDE(data))
    };
    let log = |armed: [bool; 2]| {
        let steps = (0..100_u32).flat_map(|step| {
            let frames = (1..=2_u32)
                .zip(armed)
                .flat_map(move |(system, armed)| [beat(system, armed), turning(system, 1000 + 20 * step)]);
            frames.flat_map(move |frame| record(support::START_US + u64::from(step) * 20_000, &frame))
        });
        steps.collect::<Vec<u8>>()
    };
    // the first that speaks stands; the second flew
    let second = written("second-flew.tlog", &log([false, true]));
    assert_eq!(
        open_flights(&second, &OpenOptions::default(), &MOST).unwrap().report.vehicle.unwrap().system,
        SystemId(2)
    );
    for (armed, they) in [([true, true], "all flew"), ([false, false], "none of which flew")] {
        let refused =
            open_flights(&written("both.tlog", &log(armed)), &OpenOptions::default(), &MOST).unwrap_err();
        assert!(matches!(&refused, LogError::SeveralVehicles { systems, .. } if systems.len() == 2));
        let said = refused.to_string();
        assert!(said.contains(they) && said.contains("--system-id"), "{said}");
    }
}
