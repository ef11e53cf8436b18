//! A vehicle that was weighed: its mass is known, and the scale of its thrust is what a flight shows.

use std::path::{Path, PathBuf};
use std::process::Command;

use mavid::config::{load_vehicle, vehicle_to_toml};
use mavid::vehicle::{Anchor, Vehicle};
use serde_json::Value;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn scratch(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("weighed_vehicle");
    std::fs::create_dir_all(&folder).unwrap();
    folder.join(name)
}

fn mavid(arguments: &[&str]) -> Value {
    let output = Command::new(env!("CARGO_BIN_EXE_mavid")).arg("--json").args(arguments).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    serde_json::from_slice(&output.stdout).unwrap_or_else(|_| panic!("{said}"))
}

/// The vehicle with this share of its thrust, weighed.
fn weighed(vehicle: &Vehicle, share: f64) -> String {
    let mut vehicle = vehicle.clone();
    vehicle.anchor = Anchor::Mass;
    vehicle.propulsion = vehicle.propulsion.scaled(share);
    let file = scratch(&format!("weighed_{}_{share}.toml", vehicle.name));
    std::fs::write(&file, vehicle_to_toml(&vehicle).unwrap()).unwrap();
    file.display().to_string()
}

fn near(one: &Value, other: &Value, share: f64) {
    let (one, other) = (one.as_f64().unwrap(), other.as_f64().unwrap());
    assert!((one / other - 1.0).abs() < share, "{one} and {other}");
}

/// Two flights of a simulated vehicle with a drag, and its file.
fn flown() -> ([String; 2], Vehicle) {
    let effects = scratch("drag.toml");
    let logs = ["3", "4"].map(|seed| scratch(&format!("drag_{seed}.tlog")).display().to_string());
    std::fs::write(&effects, "[[effect]]\nid = \"linear_drag\"\ndx = 0.5\ndy = 0.5\ndz = 0.0\n").unwrap();
    let vehicle = root().join("configs/x500.toml");
    let trajectory = root().join("fixtures/at_bounds_trajectory.toml").display().to_string();
    for (log, seed) in logs.iter().zip(["3", "4"]) {
        let simulate = ["simulate", vehicle.to_str().unwrap(), "--trajectory", &trajectory];
        let with = ["--effects", effects.to_str().unwrap(), "--out", log, "--seed", seed];
        mavid(&[&simulate[..], &with].concat());
    }
    (logs, load_vehicle(&vehicle).unwrap())
}

#[test]
fn explain_takes_a_weighed_mass_as_known_whatever_the_file_says_of_the_thrust() {
    let ([one, other], vehicle) = flown();
    let explained = |share: f64| mavid(&["explain", &one, &other, "--vehicle", &weighed(&vehicle, share)]);
    let (right, half) = (explained(1.0), explained(0.5));
    for document in [&right, &half] {
        assert_eq!(document["parameters"]["mass"]["value"].as_f64().unwrap(), vehicle.body.mass_kg);
        assert_eq!(document["parameters"]["mass"]["std"].as_f64(), Some(0.0));
        assert!(document["effects"].to_string().contains("linear_drag"), "{}", document["answer"]);
    }
    near(&right["thrust"]["factor"]["value"], &Value::from(1.0), 0.02);
    near(&half["thrust"]["factor"]["value"], &Value::from(2.0), 0.02);
    near(&right["thrust"]["value"], &half["thrust"]["value"], 0.005);
    // forces have the scale of the weighed mass
    for name in ["ixx", "iyy", "izz"] {
        near(&right["parameters"][name]["value"], &half["parameters"][name]["value"], 0.02);
    }
    let drag = |document: &Value| {
        let effects = document["effects"].as_array().unwrap();
        let drag = effects.iter().find(|effect| effect["id"] == "linear_drag").unwrap();
        drag["parameters"][0]["value"].clone()
    };
    near(&drag(&right), &Value::from(0.5), 0.1);
    near(&drag(&right), &drag(&half), 0.02);
    // a file that is wrong by a factor makes the answer doubtful
    assert!(!right["answer"].as_str().unwrap().starts_with("Doubtful"), "{}", right["answer"]);
    let said = half["answer"].as_str().unwrap();
    assert!(said.starts_with("Doubtful: it contradicts the vehicle file, thrust_"), "{said}");
}

#[test]
fn identify_and_inspect_say_that_the_file_is_wrong_by_a_factor() {
    let log = root().join("fixtures/p01_identify_0_25s.tlog").display().to_string();
    let vehicle = load_vehicle(&root().join("fixtures/p01_vehicle.toml")).unwrap();
    let file = weighed(&vehicle, 0.5);
    let identified = mavid(&["identify", &log, "--vehicle", &file]);
    let verdict = identified["verdict"].as_str().unwrap();
    assert!(verdict.starts_with("doubtful: it contradicts the vehicle file, thrust_"), "{verdict}");
    let explained = mavid(&["explain", &log, "--vehicle", &file]);
    near(&identified["thrust"]["value"], &explained["thrust"]["value"], 0.01);
    let mut heavy = vehicle;
    heavy.body.inertia_kg_m2 *= 100.0;
    let file = scratch("inertia.toml");
    std::fs::write(&file, vehicle_to_toml(&heavy).unwrap()).unwrap();
    for verb in ["inspect", "identify"] {
        let document = mavid(&[verb, &log, "--vehicle", file.to_str().unwrap()]);
        let verdict = document["verdict"].as_str().unwrap();
        assert!(
            verdict.to_lowercase().starts_with("doubtful") && verdict.contains("radius of gyration"),
            "{verdict}"
        );
    }
}

/// A flight of the vehicle whose thrust curve is linear, for a description that guesses an exponent of 0.6.
#[test]
fn a_guessed_thrust_curve_is_in_the_errors_until_the_flight_tells_it() {
    let log = scratch("linear.tlog").display().to_string();
    let vehicle = root().join("fixtures/px4-sih.toml").display().to_string();
    let trajectory = root().join("fixtures/at_bounds_trajectory.toml").display().to_string();
    mavid(&["simulate", &vehicle, "--trajectory", &trajectory, "--out", &log, "--seed", "5"]);
    let given = ["--mass", "1.06", "--size", "0.5657", "--frame", "quadrotor-x"];
    let identified = mavid(&[&["identify", &log], &given[..]].concat());
    let inspected = mavid(&[&["inspect", &log], &given[..]].concat());
    let with = mavid(&[&["identify", &log, "--with", "thrust_curve"], &given[..]].concat());
    let slow = scratch("calm.tlog").display().to_string();
    let table = root().join("configs/trajectories/table2.toml").display().to_string();
    mavid(&["simulate", &vehicle, "--trajectory", &table, "--out", &slow, "--seed", "5"]);
    let calm = mavid(&[&["identify", &slow, "--with", "thrust_curve"], &given[..]].concat());
    for name in ["ixx", "iyy"] {
        let of = |document: &Value| {
            let parameter = &document["methods"]["WEAK"][name];
            [parameter["value"].as_f64().unwrap(), parameter["std"].as_f64().unwrap()]
        };
        let [value, std] = of(&identified);
        assert!((value / 0.02 - 1.0).abs() > 0.2, "{name} {value}: the guess does not bear on it");
        assert!((value - 0.02).abs() < 2.0 * std, "{name} {value} +- {std}");
        let moment = |document: &Value| {
            let told = &document["with"]["parameters"][name];
            (told["value"].as_f64().unwrap(), told["std"].as_f64().unwrap())
        };
        // the outputs are at their end stops for half of the flight
        let (value, std) = moment(&with);
        assert!((value - 0.02).abs() < 2.0 * std && std < 0.002, "{name} {value} +- {std}");
        let (value, std) = moment(&calm);
        assert!((value / 0.02 - 1.0).abs() < 0.08 && std < 0.1 * value, "{name} {value} +- {std}");
    }
    let verdict = identified["verdict"].as_str().unwrap();
    // the flight shows its curve, and with it the moments; Izz still rests on the guessed torque per thrust
    assert_eq!(identified["best"]["beside"], serde_json::json!(["thrust_curve"]));
    for name in ["ixx", "iyy"] {
        let best = &identified["best"]["parameters"][name];
        let (value, std) = (best["value"].as_f64().unwrap(), best["std"].as_f64().unwrap());
        assert!((value - 0.02).abs() < 2.0 * std && std < 0.002, "{name} {value} +- {std}");
    }
    assert!(verdict.contains("good for thrust, ixx") && verdict.contains("not for izz"), "{verdict}");
    let verdict = inspected["verdict"].as_str().unwrap();
    assert!(verdict.contains("poor for") && !verdict.contains("good for Ixx"), "{verdict}");
    assert!(inspected["advice"].to_string().contains("--with thrust_curve"), "{}", inspected["advice"]);
    // the same rule for both: a stated inertia that is wrong by a factor of two
    let mut stated = load_vehicle(Path::new(&vehicle)).unwrap();
    stated.body.inertia_kg_m2 *= 2.2;
    let file = scratch("twice.toml");
    std::fs::write(&file, vehicle_to_toml(&stated).unwrap()).unwrap();
    for verb in ["inspect", "identify"] {
        let document = mavid(&[verb, &log, "--vehicle", file.to_str().unwrap()]);
        let verdict = document["verdict"].as_str().unwrap();
        assert!(
            verdict.to_lowercase().starts_with("doubtful")
                && verdict.contains("it contradicts the vehicle file, ixx by a factor of 0.4"),
            "{verb}: {verdict}"
        );
        assert!(!verdict.contains(" 0.00 %"), "{verdict}");
    }
}
