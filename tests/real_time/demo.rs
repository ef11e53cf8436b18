//! `mavid demo` as it is run from a clone: the whole story in real time, and a run that takes its folder up again.

use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

fn demo(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_mavid"))
        .args(["--json", "demo", "--plain"])
        .args(arguments)
        .output()
        .unwrap()
}

pub fn the_demo_names_what_it_conceals_with_its_size() {
    let out = Path::new(env!("CARGO_TARGET_TMPDIR")).join("demo");
    let _ = std::fs::remove_dir_all(&out);
    let output = demo(&["--out", &out.display().to_string()]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "{said}");
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(document["flight"]["ending"]["id"], "landed", "{said}");
    assert_eq!(document["explanation"]["verdict"], "explained");
    assert_eq!(document["explanation"]["effects"][0]["id"], "weak_rotor");
    let concealed = document["concealed"].as_array().unwrap();
    assert_eq!(concealed.len(), 2);
    for row in concealed {
        let [was, found] = ["concealed", "found"].map(|key| row[key].as_f64().unwrap());
        assert!((found - was).abs() < 0.01, "{row}");
    }
    let improvement = &document["explanation"]["fit"]["holdout"]["improvement_percent"];
    assert!(improvement.as_f64().unwrap() > 60.0, "{improvement}");
    let report = std::fs::read_to_string(document["report"].as_str().unwrap()).unwrap();
    assert!(report.contains("Motor 2 (rear left) is weak"));
    // what flies and explains was told nothing
    let told = ["vehicle.toml", "plan.toml", "limits.toml", "flight1/parameters.toml"];
    assert!(told.iter().all(|file| !std::fs::read_to_string(out.join(file)).unwrap().contains("weak")));
    // one report and one model at the root, the rigid body in an appendix
    for file in [
        "report.html",
        "report.md",
        "model.toml",
        "rigid_body/model.toml",
        "export/model.sdf",
        "export/px4-aircraft.params",
    ] {
        assert!(out.join(file).is_file(), "{file}");
    }
    assert!(!out.join("flight1/report.html").exists() && !out.join("flight1/model.toml").exists());
    is_taken_up(&out, &document);
    let again = demo(&["--out", &out.display().to_string()]);
    assert_eq!(again.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&again.stderr).contains("exists already"));
}

/// Neither is a flight flown again, nor is a vehicle needed; and the lines that were said are commands.
fn is_taken_up(out: &Path, first: &Value) {
    let lines: Vec<&str> = first["commands"].as_array().unwrap().iter().filter_map(Value::as_str).collect();
    for verb in ["sitl", "plan", "fly", "explain", "identify", "export"] {
        let begin = format!("mavid {verb} ");
        assert!(lines.iter().any(|line| line.starts_with(&begin)), "{verb}: {lines:?}");
    }
    let flight = lines.iter().find(|line| line.starts_with("mavid fly ")).unwrap();
    assert!(flight.contains(" --record-only ") && flight.ends_with(" --arm --yes"), "{flight}");
    let said = out.join("flight1/flight.tlog");
    let recorded = std::fs::metadata(&said).unwrap().modified().unwrap();
    let answer = &first["explanation"]["answer"];
    let output = Command::new(env!("CARGO_BIN_EXE_mavid"))
        .args(["--json", "run", "--sitl", "--yes", "--flights", "1", "--out", &out.display().to_string()])
        .output()
        .unwrap();
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "{told}");
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((&document["explanation"]["answer"], &document["flights"]), (answer, &1.into()), "{told}");
    assert_eq!(document["flight"], Value::Null, "{told}");
    assert!(!told.contains("$ mavid fly ") && !out.join("flight2").exists(), "{told}");
    assert_eq!(std::fs::metadata(&said).unwrap().modified().unwrap(), recorded);
    // alone, the line does what was done
    let line = lines.iter().find(|line| line.starts_with("mavid explain ")).unwrap();
    let alone = Command::new(env!("CARGO_BIN_EXE_mavid"))
        .args(line.split(' ').skip(1))
        .arg("--json")
        .output()
        .unwrap();
    let document: Value = serde_json::from_slice(&alone.stdout).unwrap();
    assert_eq!(&document["answer"], answer, "{line}");
}

pub fn what_cannot_be_concealed_is_refused_before_anything_flies() {
    let out = Path::new(env!("CARGO_TARGET_TMPDIR")).join("demo_wrong");
    let _ = std::fs::remove_dir_all(&out);
    let effects = Path::new(env!("CARGO_TARGET_TMPDIR")).join("demo_wrong.toml");
    std::fs::write(&effects, "[[effect]]\nid = \"phlogiston\"\n").unwrap();
    let output = demo(&["--out", &out.display().to_string(), "--effects", &effects.display().to_string()]);
    assert_eq!(output.status.code(), Some(2));
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(said.contains("phlogiston") && said.contains("demo_wrong.toml"), "{said}");
    assert!(!out.join("flight1").exists());
}
