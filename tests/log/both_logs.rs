//! The log of the vehicle and the log of the ground station of one flight are one flight.

use crate::support;

use mavid::draft::Given;
use mavid::physics::Wrench;
use mavid::recording::{Quantity, Recording, StreamKey};
use mavid::signals::{ClockOffset, clock_offset};
use mavid::simulate::{
    Disturbance, FlightSettings, RandomTrajectory, Reference, Truth, random_vehicle, simulate_flight,
};
use mavid::study::{ExplainRequest, Silent, VehicleGiven, explain};
use nalgebra::Vector3;
use std::path::Path;
use std::process::{Command, Output};

/// A flight of one trajectory in wind that blows with this phase, rad.
fn flown(phase: f64) -> Recording {
    let pair = random_vehicle(5);
    let trajectory = RandomTrajectory::default().draw(5).unwrap();
    let reference = Reference { trajectory, hover_s: 4.0, ramp_s: 2.0 };
    let wind = Disturbance::new(move |time_s, _| Wrench {
        force_n: Vector3::new((0.9 * time_s + phase).sin(), (0.7 * time_s + phase).cos(), 0.0) * 0.4,
        torque_nm: Vector3::zeros(),
    });
    let truth = Truth { vehicle: pair.truth, effects: Vec::new(), disturbance: Some(wind) };
    let settings = FlightSettings { seed: 5, duration_s: 40.0, ..FlightSettings::default() };
    simulate_flight(truth, &pair.nominal, &reference, &settings).unwrap().recording
}

/// The recording as another clock stamps it, with every `thin`-th attitude.
fn on_another_clock(recording: &Recording, (late_s, drift): (f64, f64), thin: usize) -> Recording {
    let mut other = recording.clone();
    for (key, stream) in &mut other.streams {
        stream.time_s.iter_mut().for_each(|time_s| *time_s += late_s + drift * *time_s);
        if key.quantity == Quantity::Attitude {
            let kept: Vec<usize> = (0..stream.len()).step_by(thin).collect();
            stream.values = kept.iter().flat_map(|&index| stream.sample(index).to_vec()).collect();
            stream.time_s = kept.iter().map(|&index| stream.time_s[index]).collect();
        }
    }
    other
}

#[test]
fn another_log_of_a_flight_is_found_with_its_clock() {
    let flight = flown(0.0);
    for (late_s, thin) in [(0.0, 1), (2.1037, 1), (-31.4, 5), (7.77, 12)] {
        let ClockOffset { late_s: found_s, std_s, drift, .. } =
            clock_offset(&flight, &on_another_clock(&flight, (late_s, 0.0), thin)).unwrap();
        assert!((found_s - late_s).abs() < 2e-4 + 4.0 * std_s, "{late_s}: {found_s} +- {std_s}");
        assert!(std_s < 1e-3 && drift.abs() < 1e-4, "{std_s} {drift}");
    }
    let offset = clock_offset(&flight, &on_another_clock(&flight, (3.0, 2e-4), 2)).unwrap();
    assert!((offset.drift - 2e-4).abs() < 2e-5, "{offset:?}");
    for time_s in [5.0, 20.0, 35.0] {
        let back_s = offset.on_first(time_s + 3.0 + 2e-4 * time_s);
        assert!((back_s - time_s).abs() < 5e-4, "{time_s}: {back_s}");
    }
}

#[test]
fn the_same_trajectory_flown_twice_is_two_flights() {
    let (one, two) = (flown(0.0), flown(2.0));
    assert_eq!(clock_offset(&one, &two), None);
    assert_eq!(clock_offset(&one, &on_another_clock(&two, (1.0, 0.0), 1)), None);
    let mut blind = one.clone();
    blind.streams.retain(|key, _| key.quantity != Quantity::Attitude);
    assert_eq!(clock_offset(&one, &blind), None);
    let short = Recording {
        streams: one
            .streams
            .iter()
            .map(|(key, stream)| {
                let mut part = stream.clone();
                let count = part.time_s.partition_point(|time_s| time_s - stream.time_s[0] < 8.0);
                part.time_s.truncate(count);
                part.values.truncate(count * part.width);
                (*key, part)
            })
            .collect(),
        ..one.clone()
    };
    assert_eq!(clock_offset(&one, &short), None, "eight seconds are too few");
}

#[test]
fn streams_of_the_other_log_are_added_and_its_own_stay() {
    let key = |source| StreamKey { quantity: Quantity::Velocity, source, instance: 0 };
    let one = |source, at_s: f64, value: f64| {
        let stream = mavid::recording::Stream { time_s: vec![at_s], width: 1, values: vec![value] };
        Recording { streams: [(key(source), stream)].into(), ..Recording::default() }
    };
    let mut flight = one("ULOG", 1.0, 1.0);
    flight.parameters.insert("A".to_owned(), 1.0);
    let mut other = one("LINK", 11.0, 2.0);
    other.parameters.extend([("A".to_owned(), 2.0), ("B".to_owned(), 3.0)]);
    other.clock_resets_s.push(12.0);
    other.texts.push((13.0, "hello".to_owned()));
    flight.add_log(other, |time_s| time_s - 10.0);
    flight.add_log(one("ULOG", 5.0, 9.0), |time_s| time_s);
    assert_eq!(flight.streams[&key("ULOG")].values, [1.0]);
    assert_eq!(flight.streams[&key("LINK")].time_s, [1.0]);
    assert_eq!((flight.parameters["A"], flight.parameters["B"]), (1.0, 3.0));
    assert_eq!(flight.clock_resets_s, [2.0]);
    assert_eq!(flight.texts, [(3.0, "hello".to_owned())]);
}

fn mavid(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_mavid")).current_dir(folder).args(arguments).output().unwrap()
}

#[test]
fn both_logs_of_px4_are_one_flight_and_the_better_streams_of_each_are_used() {
    let Some(shared) = support::shared() else { return };
    let folder = shared.join("onboard/sitl");
    let vehicle = ["--vehicle", "px4-v1.toml"];
    let ran = mavid(&folder, &[&["identify", "px02.tlog", "px02.ulg", "--json"], &vehicle[..]].concat());
    let document: serde_json::Value = serde_json::from_slice(&ran.stdout).unwrap();
    let flights = document["data_quality"]["inputs"].as_array().unwrap();
    assert_eq!(flights.len(), 1, "{document:#}");
    let told = String::from_utf8_lossy(&ran.stderr);
    assert!(told.contains("px02.ulg: px02.tlog holds the same flight. Its clock is 2108.0"), "{told}");
    assert!(told.contains("From it come actuator command (SERVO_OUTPUT_RAW, 50 Hz)"), "{told}");
    // by the log on board alone it is 8 % too small
    let ixx = document["methods"]["WEAK"]["ixx"]["value"].as_f64().unwrap();
    assert!((ixx / 0.025 - 1.0).abs() < 0.03, "{ixx}");

    let other = mavid(&folder, &[&["identify", "px02.ulg", "px03.tlog", "--json"], &vehicle[..]].concat());
    let document: serde_json::Value = serde_json::from_slice(&other.stdout).unwrap();
    assert_eq!(document["data_quality"]["inputs"].as_array().unwrap().len(), 2);

    // a telemetry log that ends with the link says nothing about the rest
    let ended = ["identify", "ap11.bin", "ap11.tlog", "--vehicle", "ardupilot-quad-a.toml"];
    let ran = mavid(&folder, &ended);
    let told = String::from_utf8_lossy(&ran.stderr);
    assert!(ran.status.success() && told.contains("only a part of the flight is left out"), "{told}");

    // the vehicle's own words of taking off and landing stand: over the link they are others
    let usable_s = |logs: &[&str]| {
        let ran = mavid(&folder, &[&["identify", "--json"], logs, &vehicle[..]].concat());
        let document: serde_json::Value = serde_json::from_slice(&ran.stdout).unwrap();
        document["data_quality"]["flights"][0]["usable_s"].as_f64().unwrap()
    };
    let (own_s, both_s) = (usable_s(&["px09.ulg"]), usable_s(&["px09.ulg", "px09.tlog"]));
    assert!(both_s > own_s - 1.0, "{both_s} of {own_s}");
    // most of this flight is taking off and landing
    let short = mavid(&folder, &["identify", "ap11.tlog", "--vehicle", "ardupilot-quad-a.toml"]);
    assert!(short.status.success(), "{}", String::from_utf8_lossy(&short.stderr));

    let held = mavid(&folder, &[&["explain", "px02.ulg", "--holdout", "px02.tlog"], &vehicle[..]].concat());
    let told = String::from_utf8_lossy(&held.stderr);
    assert!(
        !held.status.success() && told.contains("px02.tlog is another log of the flight of px02.ulg"),
        "{told}"
    );
}

#[test]
fn logs_of_two_autopilots_are_refused_at_once() {
    let fixture = |name: &str| format!("{}/fixtures/{name}", env!("CARGO_MANIFEST_DIR"));
    let logs = [fixture("px4_baseline_40_46s.tlog"), fixture("ap_baseline_70_79s.tlog")];
    for verb in ["explain", "identify"] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_mavid"));
        command.arg(verb).args(&logs).args(["--mass", "1", "--size", "0.5"]);
        let Output { status, stderr, .. } = command.output().unwrap();
        let said = String::from_utf8_lossy(&stderr);
        let is_told = said.contains("got a log of ArduPilot beside one of PX4");
        assert!(status.code() == Some(2) && is_told, "{verb}: {said}");
    }
}

#[test]
fn commands_in_another_unit_are_read_beside_those_from_which_the_vehicle_is_drafted() {
    let Some(shared) = support::shared() else { return };
    let log = |name: &str| shared.join("onboard/sitl").join(name);
    let given = Given { mass_kg: 1.0, size_m: Some(0.4), frame: None };
    // pulses beside commands in 0..1: both are conditioned, and then the other log of a flight shows nothing of it
    let request = ExplainRequest {
        vehicle: VehicleGiven::Weighed(given),
        logs: vec![log("px04.ulg")],
        holdout: vec![log("px04.tlog")],
        ..ExplainRequest::default()
    };
    let refusal = explain(&request, &Silent).err().unwrap().to_string();
    assert!(refusal.contains("is another log of the flight of"), "{refusal}");
}
