//! Reads the recorded flights and holds them to what is known of them.

use crate::support;

use std::path::{Path, PathBuf};

use mavid::autopilot::Autopilot;
use mavid::log::{self, OpenOptions, Opened};
use mavid::recording::{Quantity, StreamKey, StreamStats};

fn key(quantity: Quantity, source: &'static str) -> StreamKey {
    StreamKey { quantity, source, instance: 0 }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn read(path: &Path) -> Opened {
    log::open(path, &OpenOptions::default()).unwrap()
}

fn undamaged(loaded: &Opened) {
    let report = loaded.report.telemetry().unwrap();
    assert_eq!((report.bad_crc, report.resync_count, report.truncated_tail_bytes), (0, 0, 0));
    assert_eq!(report.decode.stale_stamps, 0);
    assert!(loaded.recording.clock_resets_s.is_empty());
    for (key, stream) in &loaded.recording.streams {
        assert!(stream.time_s.windows(2).all(|pair| pair[0] < pair[1]), "{key:?}");
        assert_eq!(stream.values.len(), stream.len() * stream.width);
    }
}

fn cases(shared: &Path) -> Vec<PathBuf> {
    let mut logs: Vec<PathBuf> = std::fs::read_dir(shared.join("cases"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.is_dir())
        .flat_map(|case| [case.join("identify.tlog"), case.join("holdout.tlog")])
        .collect();
    logs.sort();
    logs
}

#[test]
fn simulated_cases_read_whole() {
    let Some(shared) = support::shared() else { return };
    for path in cases(&shared) {
        let loaded = read(&path);
        undamaged(&loaded);
        let recording = &loaded.recording;
        assert_eq!(recording.autopilot, Autopilot::Px4);
        for (quantity, source, period_s) in [
            (Quantity::Attitude, "ATTITUDE_QUATERNION", 0.008),
            (Quantity::SpecificForce, "HIGHRES_IMU", 0.008),
            (Quantity::ActuatorCommand, "ACTUATOR_OUTPUT_STATUS", 0.008),
            (Quantity::Position, "LOCAL_POSITION_NED", 0.020),
            (Quantity::PositionSetpoint, "POSITION_TARGET_LOCAL_NED", 0.040),
        ] {
            let stream = &recording.streams[&key(quantity, source)];
            assert!((StreamStats::of(stream).median_period_s - period_s).abs() < 1e-4, "{source}");
        }
        let imu = &recording.streams[&key(Quantity::SpecificForce, "HIGHRES_IMU")];
        let hover = (0..imu.len()).filter(|&i| imu.time_s[i] < 3.0).map(|i| imu.sample(i)[2]).collect();
        assert!((median(hover) - 9.81).abs() < 0.3);
        assert_eq!(recording.streams[&key(Quantity::ActuatorCommand, "ACTUATOR_OUTPUT_STATUS")].width, 4);
    }
}

#[test]
fn flights_of_real_autopilots_read_whole() {
    let Some(shared) = support::shared() else { return };
    let folder = shared.join("recordings/autopilots");
    for (name, autopilot) in [
        ("ap_baseline", Autopilot::ArduPilot),
        ("ap_wind5E", Autopilot::ArduPilot),
        ("px4_baseline", Autopilot::Px4),
        ("px4_motor1_85", Autopilot::Px4),
    ] {
        let loaded = read(&folder.join(name).with_extension("tlog"));
        undamaged(&loaded);
        assert_eq!(loaded.recording.autopilot, autopilot);
        let imu = &loaded.recording.streams[&key(Quantity::SpecificForce, "HIGHRES_IMU")];
        let upward = median((0..imu.len()).map(|index| imu.sample(index)[2]).collect());
        assert!((upward - 9.81).abs() < 0.3, "{name}: {upward}");
    }
}
