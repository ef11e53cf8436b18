//! A vehicle file whose rotors are not those that flew.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use toml::{Table, Value};

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures").join(name)
}

/// The fixture's vehicle with other places of its rotors, m.
fn vehicle(name: &str, place: impl Fn(usize) -> [f64; 2]) -> String {
    let mut file: Table = fs::read_to_string(fixture("p04_vehicle.toml")).unwrap().parse().unwrap();
    for (index, rotor) in file["rotor"].as_array_mut().unwrap().iter_mut().enumerate() {
        let [forward, left] = place(index);
        rotor["position"] = Value::Array([forward, left, 0.0].map(Value::Float).to_vec());
    }
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("wrong_rotors-{name}.toml"));
    fs::write(&path, file.to_string()).unwrap();
    path.to_str().unwrap().to_owned()
}

/// The first lines of what a command says.
fn answer(verb: &str, vehicle: &str) -> String {
    let mut command = Command::new(env!("CARGO_BIN_EXE_mavid"));
    let done =
        command.arg(verb).arg(fixture("p04_identify_10_22s.tlog")).args(["--vehicle", vehicle]).output();
    let said = String::from_utf8(done.unwrap().stdout).unwrap();
    said.lines().take(3).collect::<Vec<_>>().join(" ").to_lowercase()
}

#[test]
fn rotors_that_are_turned_or_exchanged_make_an_answer_doubtful() {
    const ARM_M: f64 = 0.17;
    let places = [[ARM_M, ARM_M], [ARM_M, -ARM_M], [-ARM_M, -ARM_M], [-ARM_M, ARM_M]];
    let far_m = ARM_M * 2.0_f64.sqrt();
    let turned = [[0.0, far_m], [far_m, 0.0], [0.0, -far_m], [-far_m, 0.0]];
    let as_flown = vehicle("as-flown", |rotor| places[rotor]);
    let by_45_degrees = vehicle("turned", |rotor| turned[rotor]);
    let one_further = vehicle("exchanged", |rotor| places[(rotor + 1) % 4]);
    let doubt = "the recorded motion does not go with the rotors of the vehicle file";
    for verb in ["explain", "identify"] {
        assert!(!answer(verb, &as_flown).contains(doubt), "{verb}: {}", answer(verb, &as_flown));
        for wrong in [&by_45_degrees, &one_further] {
            let said = answer(verb, wrong);
            assert!(said.contains("doubtful") && said.contains(doubt), "{verb} {wrong}: {said}");
        }
    }
    assert!(answer("inspect", &by_45_degrees).contains("doubtful with this vehicle"));
}

#[test]
fn compare_refuses_rotors_at_other_places_than_the_autopilot_states() {
    let file = fs::read_to_string(fixture("px4-sih.toml")).unwrap();
    let turned = [
        ("[0.2, -0.2, 0.0]", "[0.28, 0.0, 0.0]"),
        ("[-0.2, 0.2, 0.0]", "[-0.28, 0.0, 0.0]"),
        ("[0.2, 0.2, 0.0]", "[0.0, 0.28, 0.0]"),
        ("[-0.2, -0.2, 0.0]", "[0.0, -0.28, 0.0]"),
    ];
    let plus = turned.iter().fold(file, |file, (from, to)| {
        assert!(file.contains(from), "{file}");
        file.replace(from, to)
    });
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("wrong_rotors-plus.toml");
    fs::write(&path, plus).unwrap();
    let path = path.display().to_string();
    let logs = ["px4_flight.ulg", "px4_baseline_40_46s.tlog"].map(|name| fixture(name).display().to_string());
    for given in [vec!["--vehicle", &path], vec!["--frame", "quadrotor-plus"]] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_mavid"));
        let refused = command.args(["compare", &logs[0], "--with", &logs[1]]).args(&given).output().unwrap();
        let why = String::from_utf8(refused.stderr).unwrap();
        assert_eq!(refused.status.code(), Some(2), "{given:?}: {why}");
        assert!(
            why.contains("px4_flight.ulg with ")
                && why.contains("the rotors contradict the autopilot's parameters: motor 1 is front right (")
                && why.contains("Expected the rotors in the order of the autopilot's motors"),
            "{given:?}: {why}"
        );
    }
}
