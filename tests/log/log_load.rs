//! Whole logs: whose messages they hold, and what a recording of them is.

use crate::python;
use crate::support;

use std::path::{Path, PathBuf};
use std::process::Command;

use mavid::autopilot::Autopilot;
use mavid::log::{self, LogError, Oddity, OpenOptions};
use mavid::recording::{Quantity, StreamKey, StreamTally};
use mavid::wire::SystemId;
use mavlink::dialects::ardupilotmega::{MavMessage, SYS_STATUS_DATA};
use support::{Needed, START_US, attitude, ground_heartbeat, header, heartbeat, record, tlog, v2};

const ATTITUDE: StreamKey = StreamKey { quantity: Quantity::Attitude, source: "ATTITUDE", instance: 0 };

/// A log under a name of its own in the temporary folder; removed when dropped.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str, bytes: &[u8]) -> Self {
        let path = std::env::temp_dir().join(format!("mavid-{}-{name}", std::process::id()));
        std::fs::write(&path, bytes).unwrap();
        Self(path)
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.0);
    }
}

fn of_system(system: u32) -> OpenOptions {
    OpenOptions { system: Some(SystemId(system)), ..OpenOptions::default() }
}

/// Two vehicles (1 and 2), and a ground station (255) between them.
fn two_vehicles() -> Vec<u8> {
    let mut frames = Vec::new();
    for step in 0..50_u8 {
        let time_ms = 5000 + u32::from(step) * 20;
        frames.push(v2(header(255, step), &ground_heartbeat()));
        for system in [1, 2] {
            frames.push(v2(header(system, 2 * step), &heartbeat()));
            frames.push(v2(header(system, 2 * step + 1), &attitude(time_ms + system * 100_000)));
        }
    }
    tlog(&frames)
}

#[test]
fn several_vehicles_are_named_and_one_is_chosen() {
    let log = Scratch::new("two.tlog", &two_vehicles());
    let refused = log::open(&log.0, &OpenOptions::default()).unwrap_err();
    assert!(
        matches!(&refused, LogError::SeveralVehicles { systems, .. } if *systems == [SystemId(1), SystemId(2)])
    );
    assert!(refused.to_string().contains("1, 2"), "{refused}");
    for system in [1, 2] {
        let recording = log::open(&log.0, &of_system(system)).unwrap().recording;
        assert_eq!(recording.streams[&ATTITUDE].len(), 50);
        assert_eq!(recording.streams[&ATTITUDE].time_s[49], 0.98);
        assert_eq!(recording.autopilot, Autopilot::Px4);
    }
    let refused = log::open(&log.0, &of_system(3)).unwrap_err();
    assert!(matches!(refused, LogError::SystemAbsent { requested: SystemId(3), .. }), "{refused}");
}

#[test]
fn a_log_of_a_ground_station_alone_holds_no_vehicle() {
    let log = Scratch::new("ground.tlog", &tlog(&[v2(header(255, 0), &ground_heartbeat())]));
    let refused = log::open(&log.0, &OpenOptions::default()).unwrap_err();
    assert!(refused.to_string().contains("255"), "{refused}");
}

#[test]
fn a_vehicle_without_a_heartbeat_is_read_when_it_is_named() {
    let log = Scratch::new("silent.tlog", &tlog(&support::attitudes(20)));
    assert!(matches!(log::open(&log.0, &OpenOptions::default()), Err(LogError::NoVehicle { .. })));
    assert_eq!(log::open(&log.0, &of_system(1)).unwrap().recording.streams[&ATTITUDE].len(), 20);
}

#[test]
fn a_log_that_is_not_there_is_named() {
    let refused = log::open("absent.tlog", &OpenOptions::default()).unwrap_err();
    assert!(refused.to_string().contains("absent.tlog"), "{refused}");
}

#[test]
fn doubled_and_late_samples_are_put_in_order_and_counted() {
    let times_ms = [1000, 1020, 1020, 1060, 1040, 1080, 1060];
    let mut frames = vec![v2(header(1, 0), &heartbeat())];
    frames.extend(times_ms.map(|time_ms| v2(header(1, 0), &attitude(time_ms))));
    let log = Scratch::new("order.tlog", &tlog(&frames));
    let loaded = log::open(&log.0, &OpenOptions::default()).unwrap();
    assert_eq!(loaded.recording.streams[&ATTITUDE].time_s, [0.0, 0.02, 0.04, 0.06, 0.08]);
    let repair = loaded.report.streams[&ATTITUDE];
    assert_eq!((repair.duplicates, repair.out_of_order), (2, 2));
}

#[test]
fn streamed_samples_are_those_of_the_recording() {
    let log = Scratch::new("streamed.tlog", &two_vehicles());
    let mut tally = StreamTally::default();
    log::stream(&log.0, &of_system(2), &mut |_, event| {
        if let mavid::recording::Event::Sample { stream, time_s, values } = event
            && stream == ATTITUDE
        {
            tally.add(time_s, values);
        }
    })
    .unwrap();
    let recording = log::open(&log.0, &of_system(2)).unwrap().recording;
    assert_eq!(tally.stats(), mavid::recording::StreamStats::of(&recording.streams[&ATTITUDE]));
}

/// What the Python reader prints; `None`, with a message, where it cannot run.
fn pymavlink(what: &str, log: &Path) -> Option<String> {
    let python = python::interpreter();
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/peers/read_with_pymavlink.py");
    let Ok(output) = Command::new(&python).arg(script).arg(what).arg(log).output() else {
        support::skip(Needed::Peers, &format!("{} does not run", python.display()));
        return None;
    };
    if output.status.code() == Some(77) {
        support::skip(Needed::Peers, &format!("pymavlink is missing (looked for by {})", python.display()));
        return None;
    }
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Some(String::from_utf8(output.stdout).unwrap())
}

#[test]
fn pymavlink_reads_what_the_writer_wrote_to_the_byte() {
    let mut writer = mavid::wire::TlogWriter::new(Vec::new());
    let mut wanted = String::new();
    for step in 0..200_u8 {
        let frame = match step % 4 {
            0 => v2(header(1, step), &heartbeat()),
            1 => support::v1(header(1, step), &attitude(u32::from(step))),
            2 => support::unknown(step, &[step; 17]),
            _ => v2(header(255, step), &ground_heartbeat()),
        };
        let stamp_us = START_US + u64::from(step) * 3333;
        let written = writer.write(stamp_us, support::frame(&frame)).unwrap();
        let hexadecimal: String = frame.iter().map(|byte| format!("{byte:02x}")).collect();
        wanted.push_str(&format!("{written} {hexadecimal}\n"));
    }
    let log = Scratch::new("peer.tlog", &writer.into_inner());
    let Some(theirs) = pymavlink("--records", &log.0) else { return };
    assert_eq!(theirs, wanted);
}

#[test]
fn pymavlink_counts_the_same_messages_in_recorded_flights() {
    let Some(shared) = support::shared() else { return };
    let flights = ["recordings/autopilots/ap_baseline.tlog", "recordings/autopilots/px4_baseline.tlog"];
    let cases = ["cases/p01-nothing-missing/identify.tlog", "cases/p04-motor-lag/holdout.tlog"];
    for path in flights.into_iter().chain(cases).map(|name| shared.join(name)) {
        let Some(theirs) = pymavlink("--counts", &path) else { return };
        let report = log::open(&path, &OpenOptions::default()).unwrap().report;
        let mut counts = std::collections::BTreeMap::<u32, u64>::new();
        let senders = &report.telemetry().unwrap().senders;
        for (id, count) in senders.iter().flat_map(|sender| sender.messages.iter()) {
            *counts.entry(id).or_default() += count;
        }
        let ours: String = counts.iter().map(|(id, count)| format!("{id} {count}\n")).collect();
        assert_eq!(ours, theirs, "{}", path.display());
    }
}

/// The recording computer's clock is set by ten years, and back, while the vehicle flies: samples stand where the
/// vehicle's clock says, those of messages without a stamp too, and the recording is no longer than the flight.
#[test]
fn a_host_clock_that_is_set_in_flight_moves_no_sample() {
    const TEN_YEARS_US: u64 = 10 * 365 * 86_400 * 1_000_000;
    let mut bytes = Vec::new();
    let (mut sequence, mut powers) = (0_u8, 0);
    let mut add = |host_us: u64, message: &MavMessage| {
        bytes.extend(record(host_us, &v2(header(1, sequence), message)));
        sequence = sequence.wrapping_add(1);
    };
    for step in 0..400_u32 {
        let set_us = if (200..300).contains(&step) { TEN_YEARS_US } else { 0 };
        let host_us = START_US + 100_000 * u64::from(step) + set_us;
        // what has no stamp of its own comes first, before any stamp could tell of the leap
        if step % 10 == 0 {
            add(host_us, &heartbeat());
            add(
                host_us + 1000,
                &MavMessage::SYS_STATUS(SYS_STATUS_DATA { voltage_battery: 15_000, ..Default::default() }),
            );
            powers += 1;
        }
        add(host_us + 50_000, &attitude(5000 + 100 * step));
    }
    let log = Scratch::new("set.tlog", &bytes);
    let loaded = log::open(&log.0, &OpenOptions::default()).unwrap();
    let attitudes = &loaded.recording.streams[&ATTITUDE];
    assert_eq!(attitudes.len(), 400);
    for (key, stream) in &loaded.recording.streams {
        let (first, last) = (stream.time_s[0], stream.time_s[stream.len() - 1]);
        assert!(first > -1.0 && last < 41.0, "{key:?}: {first} to {last} s");
    }
    let (key, power) = loaded.recording.streams.iter().find(|(key, _)| key.source == "SYS_STATUS").unwrap();
    assert_eq!(power.len(), powers, "{key:?}");
    for (index, time_s) in power.time_s.iter().enumerate() {
        assert!((time_s - (index as f64 - 0.049)).abs() < 0.15, "{index}: {time_s}");
    }
    assert_eq!(loaded.report.telemetry().unwrap().decode.host_steps, 2);
    let [Oddity::BackwardStamps { count: 1, .. }, oddity @ Oddity::HostClockSet { count: 2 }] =
        loaded.report.oddities.as_slice()
    else {
        panic!("{:?}", loaded.report.oddities)
    };
    let told = oddity.to_string();
    assert!(told.contains("clock was set 2 times while the vehicle's went on"), "{told}");
    assert!(loaded.report.losses.is_empty());
}
