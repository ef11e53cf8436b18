//! Flights that are too short for a part to be held back.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

fn scratch(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("short_flights");
    std::fs::create_dir_all(&folder).unwrap();
    folder.join(name)
}

fn mavid(arguments: &[&str]) -> Value {
    let output = Command::new(env!("CARGO_BIN_EXE_mavid")).arg("--json").args(arguments).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    serde_json::from_slice(&output.stdout).unwrap_or_else(|_| panic!("{said}"))
}

/// The beginning of a log, up to so many seconds after its first frame.
fn beginning(log: &Path, seconds: f64) -> Vec<u8> {
    let bytes = std::fs::read(log).unwrap();
    let stamp = |at: usize| u64::from_be_bytes(bytes[at..at + 8].try_into().unwrap()) as f64 / 1e6;
    let (first, mut at) = (stamp(0), 0);
    while at + 10 < bytes.len() && stamp(at) - first <= seconds {
        let (length, signed) = (usize::from(bytes[at + 9]), bytes[at + 10] & 1 == 1);
        at += 8 + match bytes[at + 8] {
            0xFD => 12 + length + if signed { 13 } else { 0 },
            _ => 8 + length,
        };
    }
    bytes[..at.min(bytes.len())].to_vec()
}

#[test]
fn a_short_flight_is_said_to_be_short_first_and_the_whole_one_is_not() {
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures");
    let (whole, vehicle) = (fixtures.join("p01_identify_0_25s.tlog"), fixtures.join("p01_vehicle.toml"));
    let explained =
        |log: &Path| mavid(&["explain", log.to_str().unwrap(), "--vehicle", vehicle.to_str().unwrap()]);
    let all = explained(&whole);
    assert!(!all["answer"].as_str().unwrap().contains("short"), "{}", all["answer"]);
    let part = scratch("part.tlog");
    std::fs::write(&part, beginning(&whole, 15.0)).unwrap();
    let short = explained(&part);
    let answer = short["answer"].as_str().unwrap();
    assert!(answer.starts_with("Doubtful: the flight is short ("), "{answer}");
    assert_eq!(short["effects"].as_array().unwrap().len(), 0, "{answer}");
}
