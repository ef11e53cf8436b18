//! `mavid fly` at its process boundary, as far as it goes without a vehicle.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn config(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("configs").join(name).display().to_string()
}

fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("fly_command-{name}"));
    let _ = std::fs::remove_dir_all(&path);
    path
}

fn fly(out: &Path, connect: &str, further: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_mavid"))
        .args(["fly", "--connect", connect, "--trajectory", &config("trajectories/table2.toml")])
        .args(["--vehicle", &config("qball2.toml"), "--out", &out.display().to_string()])
        .args(further)
        .output()
        .unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

#[test]
fn wrong_input_is_told_before_anything_is_opened() {
    let out = folder("fly_wrong");
    for (connect, further, expected) in [
        ("udq:127.0.0.1:14550", &[][..], "udpin:HOST:PORT"),
        ("udpin:127.0.0.1:0", &["--tracking-max", "0"][..], "--tracking-max"),
        ("udpin:127.0.0.1:0", &["--hover-time", "-3"][..], "--hover-time"),
        ("udpin:127.0.0.1:0", &["--setpoint-hz", "5"][..], "20..=200"),
        ("udpin:127.0.0.1:0", &["--system-id", "0"][..], "1..=255"),
        ("udpin:127.0.0.1:0", &["--signing-key-file", "nowhere"][..], "nowhere"),
    ] {
        let output = fly(&out, connect, further);
        assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
        assert!(stderr(&output).contains(expected), "{}", stderr(&output));
        assert!(!out.exists());
    }
}

#[test]
fn a_recording_that_is_there_already_is_kept() {
    let out = folder("fly_again");
    std::fs::create_dir_all(&out).unwrap();
    std::fs::write(out.join("flight.tlog"), "kept").unwrap();
    let output = fly(&out, "udpin:127.0.0.1:0", &[]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("exists already"), "{}", stderr(&output));
    assert_eq!(std::fs::read(out.join("flight.tlog")).unwrap(), b"kept");
}

fn nobody(out: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_mavid"));
    command
        .args(["fly", "--connect", "udpin:127.0.0.1:0", "--plain"])
        .args(["--trajectory", &config("trajectories/table2.toml"), "--vehicle", &config("qball2.toml")])
        .args(["--out", &out.display().to_string()])
        .stderr(std::process::Stdio::piped());
    command
}

/// Whatever the log lines are: those of the events are written at once, and a kill tears none.
#[cfg(unix)]
#[test]
fn a_kill_loses_no_event_that_was_written() {
    for (name, flags, variable) in
        [("plain", &[][..], ""), ("quiet", &["-q"][..], "off"), ("verbose", &["-vvv"][..], "")]
    {
        let out = folder(&format!("fly_killed_{name}"));
        let mut child = nobody(&out).args(flags).env("RUST_LOG", variable).spawn().unwrap();
        let events = || std::fs::read_to_string(out.join("events.jsonl")).unwrap_or_default();
        let first = "\"kind\":\"link\",\"text\":\"udpin:127.0.0.1:0: waiting for a vehicle\"}\n";
        while !events().contains(first) {
            std::thread::sleep(std::time::Duration::from_millis(10));
        }
        child.kill().unwrap();
        child.wait().unwrap();
        for line in events().split_inclusive('\n') {
            let value: serde_json::Value = serde_json::from_str(line).unwrap();
            let keys: Vec<&String> = value.as_object().unwrap().keys().collect();
            assert_eq!(keys, ["kind", "level", "text", "time_s"], "{line}");
            assert!(line.starts_with("{\"time_s\":") && line.ends_with("}\n"), "{line}");
        }
    }
}

#[cfg(unix)]
#[test]
fn without_a_vehicle_it_ends_when_it_is_told_to() {
    let out = folder("fly_nobody");
    // results of an earlier flight would pass for those of this one
    std::fs::create_dir_all(out.join("rigid_body")).unwrap();
    let earlier =
        ["report.html", "report.md", "rigid_body/report.html", "mine.html"].map(|name| out.join(name));
    earlier.iter().for_each(|path| std::fs::write(path, "earlier").unwrap());
    let child = nobody(&out).spawn().unwrap();
    // its first event is written once the handlers of signals stand
    while !std::fs::read_to_string(out.join("events.jsonl")).is_ok_and(|text| !text.is_empty()) {
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    let id = child.id().to_string();
    assert!(Command::new("kill").args(["-TERM", &id]).status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
    assert!(stderr(&output).contains("not flown: ended by SIGTERM"), "{}", stderr(&output));
    assert!(std::fs::read_to_string(out.join("events.jsonl")).unwrap().contains("SIGTERM"));
    assert_eq!(earlier.map(|path| path.exists()), [false, false, false, true]);
}

/// What comes through a pipe can be read once: all that needs it reads the copy in the folder of the flight.
#[cfg(unix)]
#[test]
fn a_vehicle_and_a_trajectory_may_come_through_pipes() {
    let out = folder("fly_pipes");
    let place = folder("pipes");
    std::fs::create_dir_all(&place).unwrap();
    let pipe = |name: &str, file: &str| {
        let (pipe, content) = (place.join(name), std::fs::read(config(file)).unwrap());
        assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        let (end, whole) = (pipe.clone(), content.clone());
        (pipe.display().to_string(), content, std::thread::spawn(move || std::fs::write(end, whole).unwrap()))
    };
    let (vehicle, wanted_vehicle, writes_vehicle) = pipe("vehicle", "qball2.toml");
    let (trajectory, wanted_trajectory, writes_trajectory) = pipe("trajectory", "trajectories/table2.toml");
    let output = Command::new(env!("CARGO_BIN_EXE_mavid"))
        .args(["fly", "--plain", "--connect", "serial:/nonexistent/tty:57600"])
        .args(["--trajectory", &trajectory, "--vehicle", &vehicle, "--out", &out.display().to_string()])
        .output()
        .unwrap();
    // all of it was read by then
    assert!(stderr(&output).contains("cannot open"), "{}", stderr(&output));
    writes_vehicle.join().unwrap();
    writes_trajectory.join().unwrap();
    assert_eq!(std::fs::read(out.join("vehicle.toml")).unwrap(), wanted_vehicle);
    assert_eq!(std::fs::read(out.join("trajectory.toml")).unwrap(), wanted_trajectory);
}
