//! `mavid vehicle init`, and `--mass` in place of a vehicle file.

#![allow(clippy::unwrap_used, reason = "a test ends where it fails")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use mavid::config::read_vehicle;
use mavid::vehicle::{Anchor, Guessed, Spin};
use serde_json::Value;

fn mavid(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_mavid")).args(arguments).output().unwrap()
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// ArduCopter, 3 kg, quadrotor X of 0.7 m; without its parameters of the frame.
fn log() -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/ap_baseline_70_79s.tlog").display().to_string()
}

fn target(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("vehicle_init").join(name);
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    let _ = std::fs::remove_file(&path);
    path
}

#[test]
fn a_log_a_mass_and_a_size_make_a_vehicle_file() {
    let out = target("vehicle.toml");
    let given = ["--mass", "3", "--size", "0.7", "--frame", "quadrotor-x", "--out"];
    let output =
        mavid(&[&["vehicle", "init", "--from", &log()], &given[..], &[out.to_str().unwrap()]].concat());
    assert!(output.status.success(), "{}", said(&output));
    let vehicle = read_vehicle(&out).unwrap().vehicle;
    assert_eq!((vehicle.anchor, vehicle.rotors.len()), (Anchor::Mass, 4));
    // front right, counter-clockwise, 0.35 m from the centre
    let first = &vehicle.rotors[0];
    assert!(first.position_m.x > 0.0 && first.position_m.y < 0.0 && first.spin == Spin::Ccw);
    assert!((first.position_m.norm() - 0.35).abs() < 1e-4);
    // the flight carries its weight: near the truth of 18.86 N, as far as the default curve goes
    let full_n = vehicle.propulsion.thrust_from_command_n(1.0);
    assert!((10.0..30.0).contains(&full_n), "{full_n}");
    let guessed = |of| vehicle.guesses.iter().any(|guess| guess.of == of);
    assert!(guessed(Guessed::TorqueRatio) && guessed(Guessed::ThrustMax) && !guessed(Guessed::Arms));
    // it says on itself what was not measured
    assert!(std::fs::read_to_string(&out).unwrap().starts_with("# A first description of the vehicle."));
}

#[test]
fn without_a_size_what_needs_the_arms_is_not_determined() {
    let output =
        mavid(&["--json", "identify", &log(), "--mass", "3", "--frame", "quadrotor-x", "--transient", "0"]);
    let document: Value =
        serde_json::from_slice(&output.stdout).unwrap_or_else(|_| panic!("{}", said(&output)));
    let text = document.to_string();
    assert!(text.contains("the length of the arms is a guess"), "{text}");
    assert!(text.contains("the rotors' torque per thrust is a guess"), "{text}");
}

#[test]
fn what_is_missing_or_wrong_is_said() {
    let out = target("refused.toml");
    let out = out.to_str().unwrap();
    for (given, expected) in [
        (&["--mass", "3"][..], "--frame quadrotor-x"),
        (&["--mass", "3", "--frame", "biplane"], "expected one of quadrotor-plus, quadrotor-x"),
        (&["--mass", "0", "--frame", "quadrotor-x"], "expected a mass from 0.005 to 500 kg, got 0"),
        (
            &["--mass", "3", "--size", "40", "--frame", "quadrotor-x"],
            "expected a size from 0.03 to 10 m, got 40",
        ),
        (&["--size", "0.5"], "--mass"),
    ] {
        let output = mavid(&[&["vehicle", "init", "--from", &log(), "--out", out], given].concat());
        assert!(!output.status.success());
        assert!(said(&output).contains(expected), "{given:?}: {}", said(&output));
    }
    assert!(!Path::new(out).exists());
    let both = mavid(&["identify", &log(), "--vehicle", "v.toml", "--mass", "3"]);
    assert!(said(&both).contains("cannot be used with"), "{}", said(&both));
    let neither = mavid(&["explain", &log()]);
    assert!(said(&neither).contains("--vehicle <FILE>"), "{}", said(&neither));
}
