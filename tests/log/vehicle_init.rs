//! `mavid vehicle init`, and `--mass` in place of a vehicle file.

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
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("vehicle_init-{name}"));
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

/// A table as a stand writes it: a rotor of 19 N at full command, 1.9e-5 N/(rad/s)^2, 0.012 m.
fn stand() -> String {
    let mut text =
        "Time (s),ESC signal (\u{b5}s),Thrust (gf),Torque (N\u{b7}m),Voltage (V),Motor Optical Speed (RPM)\n"
            .to_owned();
    for row in 0..100_u32 {
        let u = 0.05 + 0.0095 * f64::from(row);
        let thrust_n = 19.0 * (0.35 * u + 0.65 * u * u);
        let rpm = (thrust_n / 1.9e-5).sqrt() * 60.0 / std::f64::consts::TAU;
        let (pulse, grams, torque) = (1000.0 + 1000.0 * u, thrust_n / 9.806_65e-3, 0.012 * thrust_n);
        text += &format!("{row},{pulse},{grams},{torque},16.0,{rpm}\n");
    }
    text
}

#[test]
fn what_a_thrust_stand_measured_is_no_guess() {
    let (out, table) = (target("stand.toml"), target("stand.csv"));
    std::fs::write(&table, stand()).unwrap();
    let given = ["--mass", "3", "--size", "0.7", "--frame", "quadrotor-x", "--thrust-stand"];
    let run = |table: &str| {
        let tail = [table, "--out", out.to_str().unwrap()];
        mavid(&[&["vehicle", "init", "--from", &log()], &given[..], &tail].concat())
    };
    let output = run(table.to_str().unwrap());
    assert!(output.status.success(), "{}", said(&output));
    let vehicle = read_vehicle(&out).unwrap().vehicle;
    let propulsion = &vehicle.propulsion;
    assert!((propulsion.thrust_coefficient.unwrap() / 1.9e-5 - 1.0).abs() < 0.01);
    assert!((propulsion.torque_per_thrust_m - 0.012).abs() < 1e-4);
    for measured in [Guessed::ThrustMax, Guessed::Expo, Guessed::TorqueRatio] {
        assert!(vehicle.guesses.iter().all(|guess| guess.of != measured), "{measured:?}");
    }
    assert!(vehicle.guesses.iter().any(|guess| guess.of == Guessed::Inertia));
    let text = std::fs::read_to_string(&out).unwrap();
    assert!(text.contains("thrust coefficient 1.9") && text.contains("torque per thrust 0.012"), "{text}");
    // what is no table of a stand is refused, and the file is not written
    std::fs::remove_file(&out).unwrap();
    std::fs::write(&table, "a,b\n1,2\n").unwrap();
    let refused = run(table.to_str().unwrap());
    assert_eq!(refused.status.code(), Some(2));
    assert!(said(&refused).contains("expected a header with a column of thrust"), "{}", said(&refused));
    assert!(said(&run("no-such.csv")).contains("--thrust-stand: cannot read no-such.csv"));
    assert!(!out.exists());
}

#[test]
fn a_file_that_exists_is_replaced_only_on_demand() {
    let out = target("twice.toml");
    let given = ["--mass", "3", "--size", "0.7", "--frame", "quadrotor-x", "--out", out.to_str().unwrap()];
    let run = |more: &[&str]| mavid(&[&["vehicle", "init", "--from", &log()], &given[..], more].concat());
    assert!(run(&[]).status.success());
    let refused = run(&[]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(said(&refused).contains("which exists; --force replaces it"), "{}", said(&refused));
    assert!(run(&["--force"]).status.success());
}

#[test]
fn what_contradicts_the_log_or_is_absurd_is_said() {
    let log = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/px4_flight.ulg").display().to_string();
    let warned = |given: &[&str]| {
        let out = target("absurd.toml");
        let output =
            mavid(&[&["vehicle", "init", "--from", &log, "--out", out.to_str().unwrap()], given].concat());
        assert!(output.status.success(), "{}", said(&output));
        said(&output)
    };
    let frame = warned(&["--mass", "1", "--size", "0.4", "--frame", "hexarotor-x"]);
    assert!(frame.contains("--frame: the given frame contradicts the autopilot's parameters: 4 "), "{frame}");
    let heavy = warned(&["--mass", "400", "--size", "0.1"]);
    assert!(heavy.contains("arms of 0.050 m on a vehicle of 400.000 kg"), "{heavy}");
    let plain = warned(&["--mass", "1", "--size", "0.4"]);
    assert!(!plain.contains("warning"), "{plain}");
}

#[test]
fn a_table_with_a_frame_makes_a_vehicle() {
    let (out, table) = (target("table.toml"), target("hover.csv"));
    let mut text =
        "time_s,motor_1_command,motor_2_command,motor_3_command,motor_4_command,specific_force_x_m_s2,\
                    specific_force_y_m_s2,specific_force_z_m_s2\n"
            .to_owned();
    for row in 0..500_u32 {
        let u = 0.5 + 0.001 * f64::from(row % 2);
        text +=
            &format!("{},{u},{u},{u},{u},0,0,{}\n", 0.01 * f64::from(row), 9.8 + 0.01 * f64::from(row % 3));
    }
    std::fs::write(&table, text).unwrap();
    let given = ["--mass", "1.5", "--size", "0.5", "--frame", "quadrotor-x", "--out", out.to_str().unwrap()];
    let output = mavid(&[&["vehicle", "init", "--from", table.to_str().unwrap()], &given[..]].concat());
    assert!(output.status.success(), "{}", said(&output));
    let vehicle = read_vehicle(&out).unwrap().vehicle;
    let hover_n = 4.0 * vehicle.propulsion.thrust_from_command_n(0.5005);
    assert!((hover_n / (1.5 * 9.81) - 1.0).abs() < 0.02, "{hover_n}");
    std::fs::remove_file(&out).unwrap();
    let bare = mavid(&[
        "vehicle",
        "init",
        "--from",
        table.to_str().unwrap(),
        "--mass",
        "1.5",
        "--out",
        out.to_str().unwrap(),
    ]);
    assert!(said(&bare).contains("--frame quadrotor-x"), "{}", said(&bare));
}

#[test]
fn mass_and_frame_stand_for_a_file_where_there_is_no_log() {
    let given = ["--mass", "1.5", "--size", "0.5", "--frame", "quadrotor-x"];
    let exported = mavid(&[&["export", "--to", "px4-sih"], &given[..]].concat());
    assert!(exported.status.success(), "{}", said(&exported));
    assert!(String::from_utf8_lossy(&exported.stdout).contains("SIH_MASS 1.5"));
    let trajectory = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/at_bounds_trajectory.toml");
    let out = target("drafted.tlog");
    let files = ["--trajectory", trajectory.to_str().unwrap(), "--out", out.to_str().unwrap()];
    let simulated = mavid(&[&["simulate"], &given[..], &files].concat());
    assert!(simulated.status.success() && out.exists(), "{}", said(&simulated));
    for verb in ["plan", "export"] {
        let neither = mavid(&[verb]);
        assert_eq!(neither.status.code(), Some(2), "{}", said(&neither));
    }
    let validated = mavid(&[
        "validate",
        &log(),
        "--transient",
        "0",
        "--mass",
        "3",
        "--size",
        "0.7",
        "--frame",
        "quadrotor-x",
    ]);
    assert!(validated.status.success(), "{}", said(&validated));
}

#[test]
fn what_is_given_out_of_range_is_told_by_its_option() {
    let log = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/px4_flight.ulg").display().to_string();
    for (given, expected) in [
        (["--mass", "1e9", "--size", "0.4"], "--mass: expected a mass from 0.005 to 500 kg, got 1000000000"),
        (["--mass", "1", "--size", "99"], "--size: expected a size from 0.03 to 10 m, got 99"),
    ] {
        for verb in ["identify", "inspect", "explain"] {
            let output = mavid(&[&[verb, &log], &given[..]].concat());
            assert!(said(&output).contains(expected), "{verb}: {}", said(&output));
        }
    }
}

#[test]
fn without_a_log_the_guesses_are_told_too() {
    let given = ["--mass", "1.5", "--size", "0.4", "--frame", "quadrotor-x"];
    let out = target("of_guesses.toml");
    let plan = mavid(&[&["plan", "--out", out.to_str().unwrap()], &given[..]].concat());
    let log = target("of_guesses.tlog");
    let trajectory = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/at_bounds_trajectory.toml");
    let [log, trajectory] = [log.display().to_string(), trajectory.display().to_string()];
    let simulate = mavid(&[&["simulate", "--trajectory", &trajectory, "--out", &log], &given[..]].concat());
    let folder = target("of_guesses_model");
    let export =
        mavid(&[&["export", "--to", "mjcf", "--out", folder.to_str().unwrap()], &given[..]].concat());
    for output in [plan, simulate, export] {
        let said = said(&output);
        assert!(said.contains("rests on guesses: the nominal moments of inertia +- 30 %"), "{said}");
    }
}
