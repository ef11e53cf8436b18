//! A flight with `--set-logging` and `--fetch-log`: what it sets it puts back, and the vehicle's own log holds what was set.

use std::path::{Path, PathBuf};

use crate::processes::{fly, folder, planned, vehicle};
use mavid::log::{self, OpenOptions};
use mavid::recording::Quantity;

/// Over UDP, where the vehicle listens and holds the address of the flight for some seconds.
pub fn a_flight_logs_as_it_is_set_and_its_log_is_fetched() {
    let trajectory = planned("own_log_plan", 1);
    let out = folder("own_log").join("flight");
    let (_vehicle, listens) = vehicle("ardupilot", "udpin:127.0.0.1:0");
    let output = fly(
        &out,
        &listens.replace("in:", "out:"),
        &trajectory,
        &["--set-logging", "--fetch-log", "--record-only"],
    );
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(said.contains("logging: LOG_BITMASK = 438271 instead of 176126; it is put back"), "{said}");
    assert!(said.contains("logging: LOG_BITMASK is 176126 again"), "{said}");
    let opened = log::open(&own_log(&out), &OpenOptions::default()).unwrap();
    assert!(opened.report.losses.is_empty(), "{:?}", opened.report.losses);
    assert_eq!(opened.recording.parameters.get("LOG_BITMASK"), Some(&438_271.0));
    let rates = opened.recording.streams.iter().filter(|(key, _)| key.quantity == Quantity::AngularRate);
    let fastest = rates
        .map(|(_, stream)| stream.len() as f64 / (stream.time_s[stream.len() - 1] - stream.time_s[0]))
        .fold(0.0, f64::max);
    // 25 Hz by default
    assert!(fastest > 100.0, "{fastest} Hz: {said}");
}

fn own_log(flight: &Path) -> PathBuf {
    let mut files = std::fs::read_dir(flight).unwrap().map(|entry| entry.unwrap().path());
    files.find(|path| path.extension().is_some_and(|end| end.eq_ignore_ascii_case("bin"))).unwrap()
}
