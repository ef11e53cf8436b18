//! Flights with commands at their bounds: what no effect did is named of none, however many flights there are.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

fn mavid() -> Command {
    Command::new(env!("CARGO_BIN_EXE_mavid"))
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn simulated(seed: u32) -> PathBuf {
    let log = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("at_bounds_{seed}.tlog"));
    let status = mavid()
        .args(["simulate", "--json", "--seed", &seed.to_string(), "--trajectory"])
        .arg(root().join("fixtures/at_bounds_trajectory.toml"))
        .arg("--out")
        .arg(&log)
        .arg(root().join("configs/x500.toml"))
        .output()
        .unwrap()
        .status;
    assert!(status.success());
    log
}

/// The latency of three such flights together was taken for a delay, and its lag then for a bent thrust curve.
#[test]
fn three_flights_with_commands_at_their_bounds_lack_nothing() {
    let output = mavid()
        .args(["explain", "--json"])
        .args((1..=3).map(simulated))
        .arg("--vehicle")
        .arg(root().join("configs/x500.toml"))
        .output()
        .unwrap();
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(document["verdict"], "nothing_missing", "{}", document["answer"]);
    let lag_s = document["latency"]["lag_s"].as_f64().unwrap();
    let delay_s = document["latency"]["delay_s"].as_f64().unwrap();
    assert!(lag_s > 4.0 * delay_s, "lag {lag_s} s, delay {delay_s} s");
}
