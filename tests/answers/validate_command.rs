//! `mavid validate` at its process boundary: what cannot be compared, and what lies in its folder.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

fn mavid(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_mavid")).args(arguments).output().unwrap()
}

fn shipped(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name).display().to_string()
}

/// A fresh folder for one test.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("validate_command-{name}"));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Body rates, acceleration and four commands at 100 Hz, and nothing else; `commands` gives their cells.
fn flight(rows: u32, commands: impl Fn(u32, f64) -> String) -> String {
    let mut text = "time_s".to_owned();
    for axis in ["x", "y", "z"] {
        let _ = write!(text, ",rate_{axis}_rad_s,specific_force_{axis}_m_s2");
    }
    text.push_str(",motor_1_command,motor_2_command,motor_3_command,motor_4_command\n");
    for row in 0..rows {
        let t = f64::from(row) * 0.01;
        let u = 0.77 + 0.05 * (3.0 * t).sin();
        let (sin, cos) = (t.sin(), t.cos());
        let up = 9.81 + 0.1 * sin;
        let _ = writeln!(text, "{t},{sin},0.0,{cos},0.1,0.1,{up},{}", commands(row, u));
    }
    text
}

/// All rotors alike.
fn alike(_: u32, u: f64) -> String {
    format!("{u},{u},{u},{u}")
}

#[test]
fn refusals_name_log_and_model_and_what_came() {
    let folder = folder("validate-refusals");
    let place = |name: &str| folder.join(name).display().to_string();
    let hexa: String = ["left", "right"].iter().fold(shipped_text("configs/x500.toml"), |text, side| {
        format!("{text}\n[[rotor]]\nname = \"{side}\"\nposition = [0.0, 0.2, 0.0]\nspin = \"cw\"\n")
    });
    std::fs::write(place("hexa.toml"), hexa).unwrap();
    let short = |row, u| if row < 4 { alike(row, u) } else { format!("{u},{u},{u},") };
    let broken = |row, u| if row < 5 { alike(row, u) } else { "broken,1,1,1".to_owned() };
    for (name, text) in [
        ("nine.csv", flight(9, alike)),
        ("one_rotor_short.csv", flight(2000, short)),
        ("broken.csv", flight(900, broken)),
        ("still.csv", flight(2000, |row, _| alike(row, 0.77))),
        ("whole.csv", flight(2000, alike)),
    ] {
        std::fs::write(place(name), text).unwrap();
    }
    let x500 = shipped("configs/x500.toml");
    for (log, models, words) in [
        (
            "nine.csv",
            vec![&x500],
            vec![
                "nine.csv with ",
                "x500.toml: CSV holds 9 usable samples of actuator_command: at least 10 are needed",
            ],
        ),
        ("one_rotor_short.csv", vec![&x500], vec!["CSV holds 4 usable samples of actuator_command"]),
        (
            "broken.csv",
            vec![&x500],
            vec![
                "CSV holds 5 usable samples",
                "not read of the log: 895 of 900 rows rejected, the first in line 7",
            ],
        ),
        ("still.csv", vec![&x500], vec!["no actuator outputs for 4 rotors", "0.770, which does not move"]),
        (
            "whole.csv",
            vec![&x500, &place("hexa.toml")],
            vec!["whole.csv with ", "hexa.toml: no actuator outputs for 6 rotors", "CSV (4 channels"],
        ),
    ] {
        let log = place(log);
        let mut arguments = vec!["validate", &log];
        for model in models {
            arguments.extend(["--model", model.as_str()]);
        }
        let output = mavid(&arguments);
        let said = said(&output);
        assert_eq!(output.status.code(), Some(2), "{log}: {said}");
        assert!(output.stdout.is_empty());
        for word in words {
            assert!(said.contains(word), "{log}: {word}: {said}");
        }
    }
}

fn shipped_text(name: &str) -> String {
    std::fs::read_to_string(shipped(name)).unwrap()
}

#[test]
fn what_cannot_be_shown_is_said_once_and_nothing_old_passes_for_new() {
    let folder = folder("validate-old");
    let place = |name: &str| folder.join(name).display().to_string();
    let (log, out) = (place("flown.csv"), folder.join("out"));
    std::fs::write(&log, flight(2000, alike)).unwrap();
    let (first, second) = (place("a_long_name_of_before.toml"), place("a_long_name_of_another.toml"));
    for model in [&first, &second] {
        std::fs::copy(shipped("configs/x500.toml"), model).unwrap();
    }
    // an earlier run draws its flight
    let (recorded, vehicle) =
        (shipped("fixtures/p01_identify_0_25s.tlog"), shipped("fixtures/p01_vehicle.toml"));
    let into = ["--out", out.to_str().unwrap()];
    let earlier = mavid(&[&["validate", recorded.as_str(), "--model", &vehicle][..], &into].concat());
    assert!(earlier.status.success(), "{}", said(&earlier));
    let figure = out.join("1-p01_identify_0_25s.svg");
    assert!(std::fs::read_to_string(&figure).unwrap().starts_with("<svg"));
    // the same name as this run's, and files that are not mavid's
    let same_name = out.join("1-flown.svg");
    std::fs::copy(&figure, &same_name).unwrap();
    let others = ["2-mine.svg", "notes.txt"].map(|name| out.join(name));
    others.iter().for_each(|path| std::fs::write(path, "<svg/>").unwrap());

    let output =
        mavid(&[&["validate", log.as_str(), "--model", &first, "--model", &second][..], &into].concat());
    assert!(output.status.success(), "{}", said(&output));
    assert!(!figure.exists() && !same_name.exists() && others.iter().all(|path| path.exists()));
    assert!(said(&output).contains("1-flown.svg, of an earlier run"), "{}", said(&output));
    let page = String::from_utf8(output.stdout).unwrap();
    assert!(
        page.starts_with("a_long\u{2026}_before is a_long_name_of_before\na_long\u{2026}another is"),
        "{page}"
    );
    let why = "a_long_name_of_before, a_long_name_of_another: the recording holds no position";
    assert!(page.contains(", 10 to 20 s: none\n") && page.contains(why), "{page}");
    assert!(!page.contains("x (m)") && !page.contains("controller:") && !page.contains(" -\n"), "{page}");
    assert!(page.contains("1: F_z (N)"), "{page}");
    let report = std::fs::read_to_string(out.join("report.html")).unwrap();
    assert!(report.contains("flown.csv") && !report.contains("p01_identify") && report.contains(why));

    let json = mavid(&["validate", &log, "--model", &first, "--json"]);
    let document: Value = serde_json::from_slice(&json.stdout).unwrap();
    let table = &document["flights"][0]["tables"][0];
    assert!(table["rows"][0]["rms"][0].is_null() && table["notes"].as_array().unwrap().is_empty(), "{table}");
    assert!(table["missing"][0].as_str().unwrap().contains("no position"), "{table}");
}
