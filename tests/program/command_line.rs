//! The program at its process boundary: exit status, what goes to which stream, JSON.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn mavid(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_mavid")).args(arguments).output().unwrap()
}

fn config(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("configs").join(name).display().to_string()
}

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// A file of this test alone.
fn written(name: &str, text: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("command_line-{name}"));
    std::fs::write(&path, text).unwrap();
    path
}

#[test]
fn vehicle_says_what_a_file_means() {
    let output = mavid(&["vehicle", &config("qball2.toml")]);
    assert_eq!(output.status.code(), Some(0));
    // 1.79 * 9.81 / 34.4
    assert!(stdout(&output).contains("hover command u     0.5105"), "{}", stdout(&output));
    assert_eq!(stderr(&output), "");
}

#[test]
fn an_export_does_not_replace_its_model() {
    let text = std::fs::read_to_string(config("qball2.toml")).unwrap();
    let model = written("exported.toml", &text);
    let path = model.display().to_string();
    let output = mavid(&["export", &path, "--to", "rotorpy", "--out", &path]);
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    assert_eq!(std::fs::read_to_string(&model).unwrap(), text);
}

#[test]
fn json_is_one_document_and_messages_stay_off_it() {
    let weak = std::fs::read_to_string(config("qball2.toml")).unwrap().replace("mass = 1.79", "mass = 4.0");
    let path = written("weak.toml", &weak);
    let output = mavid(&["vehicle", path.to_str().unwrap(), "--json"]);
    assert_eq!(output.status.code(), Some(0));
    let document: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(document["schema"], 1);
    assert_eq!(document["hover_command"], serde_json::Value::Null);
    assert_eq!(document["rotors"][0]["wrench_per_thrust"][2], -0.2);
    assert!(stderr(&output).contains("does not lift the weight"), "{}", stderr(&output));
}

#[test]
fn a_missing_vehicle_is_told_with_both_ways_to_give_it() {
    for arguments in [
        &["identify", "x.tlog"][..],
        &["explain", "x.tlog"],
        &["fly", "--connect", "udpin:127.0.0.1:0", "--trajectory", "t.toml", "--out", "o"],
    ] {
        let output = mavid(arguments);
        assert_eq!(output.status.code(), Some(2));
        let said = stderr(&output);
        assert!(said.contains("--vehicle <FILE>") && said.contains("--mass <KG>"), "{said}");
    }
}

#[test]
fn a_vehicle_file_in_place_of_a_log_is_told_so() {
    let output = mavid(&["inspect", &config("x500.toml")]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("got a vehicle file or a model: give the log"), "{}", stderr(&output));
}

#[test]
fn bad_input_and_bad_usage_are_status_two_with_nothing_on_stdout() {
    let path = written("typo.toml", "nmae = \"x\"\n");
    let typo = path.to_str().unwrap();
    for arguments in [
        vec!["vehicle", "no-such-file.toml"],
        vec!["vehicle", typo],
        vec!["vehicle"],
        vec!["vehicle", typo, "--unknown"],
        vec!["fly-away"],
        vec![],
    ] {
        let output = mavid(&arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert_eq!(stdout(&output), "", "{arguments:?}");
        assert!(!stderr(&output).is_empty(), "{arguments:?}");
    }
    let message = stderr(&mavid(&["vehicle", typo]));
    assert!(message.contains("typo.toml") && message.contains("unknown field `nmae`"), "{message}");
}

/// A script that asks for a document gets one, also where the command fails: its message is that of standard error.
#[test]
fn a_failure_with_json_is_one_document_with_the_message_and_the_status() {
    let path = written("typo_json.toml", "nmae = \"x\"\n");
    let typo = path.to_str().unwrap();
    for (arguments, expected) in [
        (vec!["vehicle", "no-such-file.toml", "--json"], "no-such-file.toml"),
        (vec!["--json", "vehicle", typo], "unknown field `nmae`"),
        (vec!["vehicle", typo, "--unknown", "--json"], "--unknown"),
        (vec!["--json", "fly-away"], "fly-away"),
        (vec!["--json", "sitl", "--speed", "0"], "--speed"),
        (vec!["--json", "identify", "no-such-log.tlog", "--mass", "2"], "no-such-log.tlog"),
        (vec!["--json", "explain", "no-such-log.tlog", "--mass", "2"], "no-such-log.tlog"),
        (vec!["--json", "compare", "no-such-log.tlog", "--mass", "2"], "two flights"),
        (vec!["--json", "inspect", "no-such-log.tlog"], "no-such-log.tlog"),
        (
            vec!["--json", "run", "--connect", "udq:127.0.0.1:9", "--mass", "2", "--room", "4,4,3", "--yes"],
            "udq",
        ),
    ] {
        let output = mavid(&arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", stderr(&output));
        let document: serde_json::Value =
            serde_json::from_slice(&output.stdout).unwrap_or_else(|error| panic!("{arguments:?}: {error}"));
        assert_eq!((&document["schema"], &document["error"]["exit_status"]), (&1.into(), &2.into()));
        let message = document["error"]["message"].as_str().unwrap();
        assert!(message.contains(expected) && !message.starts_with("mavid"), "{arguments:?}: {message}");
        assert!(stderr(&output).contains(message.split("; ").next().unwrap()), "{arguments:?}: {message}");
    }
}

/// Where a document was printed already, a failure after it adds none.
#[test]
fn a_failure_after_the_document_adds_none() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let fixture = |name: &str| root.join("fixtures").join(name).display().to_string();
    let (log, vehicle) = (fixture("p01_identify_0_25s.tlog"), fixture("p01_vehicle.toml"));
    let no_folder = written("no_folder", "");
    let model = no_folder.join("model.toml").display().to_string();
    let output = mavid(&["--json", "identify", &log, "--vehicle", &vehicle, "--out", &model]);
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    let document: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(document["error"].is_null() && document["methods"].is_object());
}

#[test]
fn help_and_version_succeed() {
    let help = mavid(&["--help"]);
    for example in ["  mavid demo", "  mavid explain flight.ulg --mass 2.0", "  mavid run --connect"] {
        assert!(stdout(&help).lines().any(|line| line.starts_with(example)), "{example}");
    }
    assert_eq!(help.status.code(), Some(0));
    assert!(
        stdout(&help).contains("Exit status: 0 done, 1 failure, 2 bad usage or input, 3 done with loss or ended by a signal, 4 done and something changed (compare, fleet report).")
    );
    let version = mavid(&["--version"]);
    assert_eq!(stdout(&version), format!("mavid {}\n", env!("CARGO_PKG_VERSION")));
}

/// The book shows what the program prints (the demo's flight is in real time, and no two are the same to the last digit).
#[test]
fn the_books_example_is_what_is_printed() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let chapter = std::fs::read_to_string(root.join("docs/src/log.md")).unwrap();
    let example = &chapter[chapter.find("cargo run --release -- identify").unwrap()..];
    let command = example.lines().next().unwrap().trim_start_matches("cargo run --release -- ");
    let shown = example.split("```text\n").nth(1).unwrap().split("```").next().unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_mavid"))
        .args(command.split_whitespace())
        .current_dir(root)
        .output()
        .unwrap();
    assert!(output.status.success());
    assert_eq!(String::from_utf8(output.stdout).unwrap(), shown);
}

#[test]
fn sitl_says_what_runs_and_nothing_of_what_is_concealed() {
    let effects =
        written("concealed.toml", "[[effect]]\nid = \"linear_drag\"\ndx = 0.3\ndy = 0.3\ndz = 0.0\n");
    let effects = effects.to_str().unwrap();
    let listen = "udpout:127.0.0.1:9";
    let output = mavid(&[
        "sitl",
        "--json",
        "--effects",
        effects,
        "--listen",
        listen,
        "--speed",
        "100",
        "--duration",
        "1",
    ]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let document: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(document["autopilot"], "px4");
    assert_eq!(document["listen"], serde_json::json!([listen]));
    assert!(!stdout(&output).contains("drag") && !stderr(&output).contains("drag"));
}

#[test]
fn sitl_refuses_what_it_cannot_run() {
    let unknown = written("unknown-effect.toml", "[[effect]]\nid = \"phlogiston\"\n");
    let missing = written("missing-parameter.toml", "[[effect]]\nid = \"linear_drag\"\ndx = 0.3\n");
    let stray = written("stray-key.toml", "wind = 3\n");
    for (arguments, said) in [
        (vec!["--listen", "udq:127.0.0.1:9"], "udpin:HOST:PORT"),
        (vec!["--speed", "0"], "--speed"),
        (vec!["--speed", "2", "--lockstep"], "cannot be used with"),
        (vec!["--loss", "1.5"], "loss"),
        (vec!["--duration", "-1"], "--duration"),
        (vec!["--autopilot", "betaflight"], "px4"),
        (vec!["--effects", unknown.to_str().unwrap()], "phlogiston"),
        (vec!["--effects", missing.to_str().unwrap()], "dy"),
        (vec!["--effects", stray.to_str().unwrap()], "wind"),
        (vec!["--vehicle", "no-such-file.toml"], "no-such-file.toml"),
    ] {
        let output = mavid(&[&["sitl"], &arguments[..]].concat());
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(said), "{arguments:?}: {}", stderr(&output));
        assert_eq!(stdout(&output), "");
    }
}
