//! `mavid prove` over a folder of cases made here.

use mavid::physics::ActiveEffect;
use mavid::physics::effects::by_id;
use mavid::simulate::{FlightSettings, RandomTrajectory, Reference, Truth, simulate_flight};
use mavid::wire::write_recording;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn mavid(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_mavid")).args(arguments).output().unwrap()
}

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("prove_command-{name}"));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// A flight of configs/x500.toml with these effects, as a log.
fn log(path: &Path, effects: &[(&str, &[f64])], (seed, duration_s): (u64, f64)) {
    let vehicle = mavid::config::read_vehicle(&x500()).unwrap().vehicle;
    let effects = effects.iter().map(|(id, values)| ActiveEffect::new(by_id(id).unwrap(), values).unwrap());
    let truth = Truth { vehicle: vehicle.clone(), effects: effects.collect(), disturbance: None };
    let bounds = RandomTrajectory { speed_max_m_s: 2.0, ..RandomTrajectory::default() };
    let reference = Reference { trajectory: bounds.draw(seed).unwrap(), hover_s: 4.0, ramp_s: 2.0 };
    let settings = FlightSettings { seed, duration_s, ..FlightSettings::default() };
    let flight = simulate_flight(truth, &vehicle, &reference, &settings).unwrap();
    let file = std::io::BufWriter::new(std::fs::File::create(path).unwrap());
    write_recording(&flight.recording, file, 1_700_000_000_000_000).unwrap();
}

fn x500() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/x500.toml")
}

#[test]
fn verdicts_are_sealed_and_scored() {
    let folder = folder("prove");
    let cases = folder.join("cases");
    for name in ["a-drag", "b-clean", "c-broken", "d-same"] {
        std::fs::create_dir_all(cases.join(name)).unwrap();
        std::fs::copy(x500(), cases.join(name).join("vehicle.toml")).unwrap();
    }
    let drag: &[(&str, &[f64])] = &[("linear_drag", &[0.3, 0.3, 0.0])];
    log(&cases.join("a-drag/identify.tlog"), drag, (1, 44.0));
    log(&cases.join("a-drag/holdout.tlog"), drag, (2, 24.0));
    log(&cases.join("b-clean/identify.tlog"), &[], (3, 44.0));
    std::fs::write(cases.join("c-broken/identify.tlog"), b"not a log").unwrap();
    for name in ["identify.tlog", "holdout.tlog"] {
        std::fs::copy(cases.join("b-clean/identify.tlog"), cases.join("d-same").join(name)).unwrap();
    }
    let answers = folder.join("answers.json");
    let text = r#"{"a-drag": {"expect": ["linear_drag"], "effects": {"linear_drag": 0.3}, "author": "x"},
        "b-clean": {"expect": []}, "e-gone": {"expect": []}}"#;
    std::fs::write(&answers, text).unwrap();
    let place = |path: &Path| path.display().to_string();
    let out = folder.join("out");
    let said =
        mavid(&["prove", &place(&cases), "--answers", &place(&answers), "--out", &place(&out), "--json"]);
    assert_eq!(said.status.code(), Some(3), "{}", String::from_utf8_lossy(&said.stderr));
    let document: Value = serde_json::from_slice(&said.stdout).unwrap();
    let summary = &document["summary"];
    assert_eq!((&summary["cases"], &summary["right"]), (&2.into(), &2.into()), "{document}");
    assert_eq!(summary["sizes_within_10_percent"], 2);
    assert_eq!(summary["holdouts_improved"], 1);
    assert!(document["cases"][0]["improvement_percent"].as_f64().unwrap() > 0.0);
    let notes = document["notes"].to_string();
    assert!(notes.contains("author") && notes.contains("e-gone"), "{notes}");
    // the broken log and the hold-out that is the identification flight are said
    let errors: Vec<String> =
        document["unscored"].as_array().unwrap().iter().map(|case| case["error"].to_string()).collect();
    assert!(errors.len() == 2 && errors[1].contains("hold-out is the flight"), "{errors:?}");
    // the seal is that of the files
    let sums = std::fs::read(out.join("SHA256SUMS")).unwrap();
    let hash: String =
        sha2::Digest::finalize(sha2::Digest::chain_update(<sha2::Sha256 as sha2::Digest>::new(), &sums))
            .iter()
            .map(|byte| format!("{byte:02x}"))
            .collect();
    assert_eq!(document["sealed_sha256"], hash);
    let verdict: Value = serde_json::from_slice(&std::fs::read(out.join("a-drag.json")).unwrap()).unwrap();
    assert_eq!(verdict["effects"][0]["id"], "linear_drag");
}

#[test]
fn bad_input_is_refused() {
    let folder = folder("prove-bad");
    let place = folder.display().to_string();
    let empty = mavid(&["prove", &place]);
    assert_eq!(empty.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&empty.stderr).contains("vehicle.toml"));
    assert!(empty.stdout.is_empty());
    std::fs::copy(x500(), folder.join("vehicle.toml")).unwrap();
    let no_answers = mavid(&["prove", &place, "--answers", "nowhere.json"]);
    assert_eq!(no_answers.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&no_answers.stderr).contains("nowhere.json"));
    let file = folder.join("plain");
    std::fs::write(&file, "x").unwrap();
    let into_file = mavid(&["prove", &place, "--out", &file.display().to_string()]);
    assert_eq!(into_file.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&into_file.stderr).contains("--out: expected a folder"));
    // answers to other cases, and answers that no effect has
    let out = folder.join("out").display().to_string();
    for (text, words) in [
        (r#"{"elsewhere": {"expect": []}}"#, "expected answers by the names of the cases"),
        (r#"{"prove-bad": {"expect": ["drag"]}}"#, "`expect` names `drag`"),
    ] {
        let answers = folder.join("answers.json");
        std::fs::write(&answers, text).unwrap();
        let said = mavid(&["prove", &place, "--answers", &answers.display().to_string(), "--out", &out]);
        assert_eq!(said.status.code(), Some(2));
        assert!(String::from_utf8_lossy(&said.stderr).contains(words), "{said:?}");
        assert!(said.stdout.is_empty());
    }
}
