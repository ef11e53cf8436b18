//! `mavid fly` against `mavid sitl` in real time: both autopilots, over UDP, TCP and a serial port. The
//! flights run side by side, most of the time asleep.

#![cfg(unix)]
#![allow(clippy::unwrap_used, reason = "a test ends where it fails")]

#[allow(dead_code)]
#[path = "support/flying.rs"]
mod flying;

use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::thread;

use mavid::config::{StoredTrajectory, StoredTransitions, trajectory_to_toml};
use mavid::vehicle::Limits;
use serde_json::Value;

const MAVID: &str = env!("CARGO_BIN_EXE_mavid");

struct Sitl(Child);

impl Drop for Sitl {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn x500() -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/x500.toml").display().to_string()
}

fn trajectory(folder: &Path) -> PathBuf {
    let around = flying::AROUND;
    let stored = StoredTrajectory {
        series: flying::series(),
        repeats: 3,
        limits: Limits::default(),
        criterion: None,
        margins: [].into(),
        standard_errors: [].into(),
        transitions: Some(StoredTransitions {
            takeoff: around.takeoff,
            landing: around.landing,
            to_start_s: around.to_start_s,
            to_landing_s: around.to_landing_s,
        }),
    };
    let path = folder.join("plan.toml");
    std::fs::write(&path, trajectory_to_toml(&stored).unwrap()).unwrap();
    path
}

/// One flight: the vehicle's end of the link, and the ground station's.
fn fly(name: &str, autopilot: &str, vehicle_end: &str, ground_end: &str) -> (PathBuf, Output) {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("fly_loopback_{name}"));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    let _sitl = Sitl(
        Command::new(MAVID)
            .args([
                "sitl",
                "--vehicle",
                &x500(),
                "--autopilot",
                autopilot,
                "--warm-up",
                "2",
                "--listen",
                vehicle_end,
            ])
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap(),
    );
    if let Some(port) = ground_end.strip_prefix("serial:").and_then(|rest| rest.strip_suffix(":921600")) {
        while !Path::new(port).exists() {
            thread::sleep(std::time::Duration::from_millis(10));
        }
    }
    let out = folder.join("flight");
    let output = Command::new(MAVID)
        .args(["--json", "fly", "--plain", "--connect", ground_end, "--vehicle", &x500()])
        .args(["--trajectory", &trajectory(&folder).display().to_string()])
        .args(["--out", &out.display().to_string()])
        .output()
        .unwrap();
    (out, output)
}

#[test]
fn a_flight_over_each_link_lands_and_is_identified() {
    let pty = Path::new(env!("CARGO_TARGET_TMPDIR")).join("fly_loopback_pty").display().to_string();
    let _ = std::fs::remove_file(&pty);
    let (pty_end, serial_end) = (format!("pty:{pty}"), format!("serial:{pty}:921600"));
    let flights = [
        ("px4_udp", "px4", "udpout:127.0.0.1:24550", "udpin:127.0.0.1:24550"),
        ("ardupilot_tcp", "ardupilot", "tcpout:127.0.0.1:24551", "tcpin:127.0.0.1:24551"),
        ("px4_serial", "px4", pty_end.as_str(), serial_end.as_str()),
    ];
    thread::scope(|scope| {
        let under_way: Vec<_> = flights
            .into_iter()
            .map(|(name, autopilot, vehicle, ground)| {
                (name, scope.spawn(move || fly(name, autopilot, vehicle, ground)))
            })
            .collect();
        for (name, flight) in under_way {
            let (out, output) = flight.join().unwrap();
            let said = String::from_utf8_lossy(&output.stderr).into_owned();
            assert_eq!(output.status.code(), Some(0), "{name}: {said}");
            let document: Value = serde_json::from_slice(&output.stdout).unwrap();
            assert_eq!(document["flight"]["ending"]["id"], "landed", "{name}: {said}");
            assert_eq!(document["flight"]["flown"]["periods"], 3, "{name}: {said}");
            assert_eq!(document["dropped_frames"], 0, "{name}: {said}");
            let mass_kg = document["identification"]["best"]["parameters"]["mass"]["value"].as_f64().unwrap();
            assert!((mass_kg - 2.0).abs() < 0.1, "{name}: {mass_kg} kg");
            for file in ["flight.tlog", "events.jsonl", "parameters.toml", "model.toml", "identification.txt"]
            {
                assert!(out.join(file).exists(), "{name}: {file}");
            }
        }
    });
}
