//! `mavid simulate` and `mavid validate` together: a flight with a concealed effect, and the model that has it.

use mavid::log::{self, OpenOptions};
use mavid::simulate::{
    FlightSettings, RandomTrajectory, Reference, TelemetrySettings, Truth, random_vehicle, simulate_flight,
};
use mavid::wire::write_recording;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn mavid(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_mavid")).args(arguments).output().unwrap()
}

fn config(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("configs").join(name).display().to_string()
}

/// A fresh folder for one test.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("simulate_command-{name}"));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

const DRAG: &str = "[[effect]]\nid = \"linear_drag\"\ndx = 0.5\ndy = 0.5\ndz = 0.0\n";

#[test]
fn the_model_with_the_concealed_effect_fits_better_everywhere() {
    let folder = folder("simulate");
    let place = |name: &str| folder.join(name).display().to_string();
    std::fs::write(place("drag.toml"), DRAG).unwrap();
    let vehicle = std::fs::read_to_string(config("x500.toml")).unwrap();
    std::fs::write(place("bare.toml"), &vehicle).unwrap();
    std::fs::write(place("draggy.toml"), format!("{vehicle}\n{DRAG}")).unwrap();
    let (log, trajectory) = (place("flight.tlog"), config("trajectories/table2.toml"));
    let effects = place("drag.toml");
    let common = ["simulate", &place("bare.toml"), "--trajectory", &trajectory, "--effects", &effects];
    let simulated = mavid(&[&common[..], &["--noise", "0.1", "--out", &log, "--json"]].concat());
    assert!(simulated.status.success(), "{}", String::from_utf8_lossy(&simulated.stderr));
    let said: Value = serde_json::from_slice(&simulated.stdout).unwrap();
    assert_eq!(said["effects"], serde_json::json!(["linear_drag"]));
    assert!(said["frames"].as_u64().unwrap() > 10_000);

    let charts = place("charts");
    let (bare, draggy) = (place("bare.toml"), place("draggy.toml"));
    let arguments = ["validate", &log, "--model", &bare, "--model", &draggy, "--out", &charts, "--json"];
    let validated = mavid(&arguments);
    assert!(validated.status.success(), "{}", String::from_utf8_lossy(&validated.stderr));
    let said: Value = serde_json::from_slice(&validated.stdout).unwrap();
    let tables = said["flights"][0]["tables"].as_array().unwrap();
    assert_eq!(tables.len(), 6);
    for table in tables {
        assert!(table["missing"].as_array().unwrap().is_empty(), "{table}");
        assert!(table["rows"].as_array().unwrap().iter().all(|row| row["rms"][1].is_f64()), "{table}");
    }
    // flown again by another controller, its place and torques are closer; played back over half a second, its speed
    for (table, row, least) in [(0, 0, 5.0), (0, 1, 5.0), (0, 7, 10.0), (0, 8, 10.0), (4, 1, 10.0)] {
        let gain = tables[table]["rows"][row]["improvement_percent"][1].as_f64().unwrap();
        assert!(gain > least, "{} {row}: {gain} %", tables[table]["title"]);
    }
    // and the table says who flew it, and how far off its setpoints the flight was itself
    let notes: Vec<_> = tables[0]["notes"].as_array().unwrap().iter().filter_map(Value::as_str).collect();
    assert!(notes.len() == 2 && notes[0].contains("PX4's default gains, on exact states; it assumes bare"));
    assert!(notes[1].contains("itself was off its setpoints by 0.0"), "{notes:?}");
    let drawn = std::fs::read_to_string(Path::new(&charts).join("1-flight.svg")).unwrap();
    assert!(drawn.contains("tau_psi") && drawn.contains("draggy"));
}

#[test]
fn a_written_log_reads_back_as_what_was_simulated() {
    let folder = folder("round-trip");
    let trajectory = RandomTrajectory::default().draw(2).unwrap();
    let reference = Reference { trajectory, hover_s: 4.0, ramp_s: 2.0 };
    let vehicle = random_vehicle(2).truth;
    let telemetry = TelemetrySettings { loss: 0.0, ..TelemetrySettings::default() };
    let settings = FlightSettings { duration_s: 10.0, telemetry, ..FlightSettings::default() };
    let flight = simulate_flight(Truth::clean(vehicle.clone()), &vehicle, &reference, &settings).unwrap();
    let path = folder.join("flight.tlog");
    let file = std::fs::File::create(&path).unwrap();
    write_recording(&flight.recording, file, 1_700_000_000_000_000).unwrap();
    let read = log::open(&path, &OpenOptions::default()).unwrap().recording;
    for (key, sent) in &flight.recording.streams {
        let Some((_, came)) =
            read.streams.iter().find(|(k, _)| k.quantity == key.quantity && k.source == key.source)
        else {
            panic!("{key:?} is gone")
        };
        assert_eq!(came.len(), sent.len(), "{key:?}");
        for index in 0..sent.len() {
            assert!((came.time_s[index] - sent.time_s[index]).abs() < 2e-3, "{key:?}");
            for (a, b) in sent.sample(index).iter().zip(came.sample(index)) {
                assert!((a - b).abs() < 2e-3 * (1.0 + a.abs()), "{key:?}: {a} {b}");
            }
        }
    }
}

#[test]
fn bad_effects_are_refused_with_what_was_expected() {
    let folder = folder("bad-effects");
    let place = |name: &str| folder.join(name).display().to_string();
    let (log, trajectory) = (place("flight.tlog"), config("trajectories/table2.toml"));
    for (text, expected) in [
        ("[[effect]]\nid = \"no_such\"\n", "expected one of"),
        ("[[effect]]\nid = \"inflow\"\nkz = -3.0\n", "0 to 20.64 N/(m/s) for a vehicle of 2.064 kg"),
        ("[[effect]]\nid = \"inflow\"\nkz = \"much\"\n", "expected a number"),
        ("[[effect]]\nid = \"inflow\"\n", "kz"),
        (
            "[[effect]]\nid = \"weak_rotor\"\nrotor = 7\nfactor = 0.9\n",
            "a rotor: 0 to 3, or its name (front_right",
        ),
        ("[[effect]]\nid = \"weak_rotor\"\nrotor = \"none\"\nfactor = 0.9\n", "a rotor: 0 to 3, or its name"),
        ("[[wrong]]\n", "wrong"),
        ("", "expected a file in TOML with [[effect]] tables and nothing else, got an empty file"),
        (
            include_str!("../../configs/x500.toml"),
            "effects.toml: expected a file in TOML with [[effect]] tables and nothing else, got a vehicle file (",
        ),
        ("\u{0}", "expected a file in TOML with [[effect]] tables and nothing else: "),
    ] {
        let effects = place("effects.toml");
        std::fs::write(&effects, text).unwrap();
        let vehicle = config("x500.toml");
        let output =
            mavid(&["simulate", &vehicle, "--trajectory", &trajectory, "--effects", &effects, "--out", &log]);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{text}: {said}");
        assert!(said.contains(expected), "{text}: {said}");
    }
    let (vehicle, binary) = (config("x500.toml"), place("effects.bin"));
    std::fs::write(&binary, [0xfd, 0x80, 0xff]).unwrap();
    let output =
        mavid(&["simulate", &vehicle, "--trajectory", &trajectory, "--effects", &binary, "--out", &log]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("tables and nothing else, got a file that is not text"), "{said}");
}

#[test]
fn a_log_overwrites_nothing_that_is_read_and_is_a_tlog() {
    let folder = folder("bad-out");
    let place = |name: &str| folder.join(name).display().to_string();
    let (vehicle, trajectory) = (place("vehicle.toml"), place("trajectory.toml"));
    std::fs::copy(config("x500.toml"), &vehicle).unwrap();
    std::fs::copy(config("trajectories/table2.toml"), &trajectory).unwrap();
    let before = std::fs::read_to_string(&vehicle).unwrap();
    for (out, expected) in [
        (vehicle.clone(), "is an input"),
        (trajectory.clone(), "is an input"),
        (place("flight.csv"), "expected the name of a .tlog"),
    ] {
        let output = mavid(&["simulate", &vehicle, "--trajectory", &trajectory, "--out", &out]);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{out}: {said}");
        assert!(said.contains(expected), "{out}: {said}");
    }
    assert_eq!(std::fs::read_to_string(&vehicle).unwrap(), before);
    assert!(!folder.join("flight.csv").exists());
}

/// A plan may go to the rotors' bounds: the vehicle then keeps upright and near it.
#[test]
fn a_vehicle_flies_its_own_plan() {
    let folder = folder("own_plan");
    let path = |name: &str| folder.join(name).display().to_string();
    let (plan, log, vehicle) = (path("plan.toml"), path("log.tlog"), config("x500.toml"));
    let planned = mavid(&["plan", &vehicle, "--takeoff", "0,0,1.5", "--out", &plan]);
    assert!(planned.status.success(), "{}", String::from_utf8_lossy(&planned.stderr));
    let flown = mavid(&["simulate", &vehicle, "--trajectory", &plan, "--out", &log, "--json"]);
    assert!(flown.status.success(), "{}", String::from_utf8_lossy(&flown.stderr));
    let document: Value = serde_json::from_slice(&flown.stdout).unwrap();
    let off_m = document["tracking_error_max_m"].as_f64().unwrap();
    assert!(off_m < 1.0, "{off_m} m off");
}
