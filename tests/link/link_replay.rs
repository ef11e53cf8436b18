//! A recorded flight played back.

use crate::support;

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use std::time::Duration;

use mavid::link::{Link, LinkError, LinkEvent, LinkOptions, Received};
use mavid::replay::{HeldBack, Replay, ReplayError};
use mavid::wire::{CrcSeeds, checksum};
use mavlink::MavHeader;
use mavlink::dialects::ardupilotmega::MavMessage;
use support::{START_US, attitude, ground_heartbeat, header, heartbeat, record, unknown, v2};
use tokio::time::Instant;

/// A log in which a vehicle and a ground station speak; stamps in milliseconds from the start.
fn log(what: &str) -> (PathBuf, Vec<(u64, Vec<u8>)>) {
    let command = MavMessage::COMMAND_LONG(Default::default());
    let frames = vec![
        (0, v2(header(1, 0), &heartbeat())),
        (100, v2(header(255, 0), &ground_heartbeat())),
        (200, v2(header(1, 1), &attitude(1))),
        (250, v2(header(255, 1), &command)),
        (300, v2(header(1, 2), &command)),
        // a step back, then the seam of another log
        (150, v2(header(1, 3), &attitude(9))),
        (9_000_000, v2(header(1, 4), &attitude(2))),
        (9_000_400, v2(header(1, 5), &attitude(3))),
        // nobody knows what it says; the vehicle's own companion speaks; an estimator would fuse it
        (9_000_400, unknown(6, b"something new")),
        (9_000_400, v2(MavHeader { component_id: 191, ..header(1, 7) }, &attitude(4))),
        (9_000_400, v2(header(1, 8), &MavMessage::ODOMETRY(Default::default()))),
    ];
    let bytes: Vec<u8> =
        frames.iter().flat_map(|(at_ms, frame)| record(START_US + 1000 * at_ms, frame)).collect();
    let path = std::env::temp_dir().join(format!("mavid-{what}-{}.tlog", std::process::id()));
    std::fs::write(&path, bytes).unwrap();
    (path, frames)
}

/// Of the log above, what is played, and when at the log's own pace, ms.
const PLAYED: [(usize, u64); 5] = [(0, 0), (2, 200), (5, 300), (6, 300), (7, 700)];

#[tokio::test(start_paused = true)]
async fn frames_come_at_the_pace_of_their_stamps() {
    let (path, frames) = log("paced");
    for (speed, pace) in [(1.0, 1.0), (2.5, 0.4), (0.0, 0.0)] {
        let replay = Replay::open(&path, speed).unwrap();
        assert_eq!((replay.frames(), replay.duration()), (11, Duration::from_millis(700)));
        let start = Instant::now();
        let mut reader = replay.start();
        assert!(matches!(reader.receive().await.unwrap(), Received::Event(LinkEvent::Connected { .. })));
        for (index, due_ms) in PLAYED {
            let Received::Frame(frame) = reader.receive().await.unwrap() else { panic!("no frame") };
            assert_eq!(frame.bytes(), frames[index].1);
            assert_eq!(frame.stamp.utc_us, START_US + 1000 * frames[index].0);
            let late = start.elapsed().as_secs_f64() - pace * due_ms as f64 / 1e3;
            assert!((0.0..0.002).contains(&late), "speed {speed}, frame {index}: {late} s late");
        }
        assert!(matches!(reader.receive().await, Err(LinkError::Closed)));
    }
    std::fs::remove_file(path).unwrap();
}

#[tokio::test(start_paused = true)]
async fn a_replay_commands_nothing_and_obeys_nobody() {
    let (path, frames) = log("sent");
    let ((mut reader, writer), (mut vehicle, pilot)) =
        Link::pair(LinkOptions::default(), LinkOptions::default());
    assert!(matches!(vehicle.receive().await.unwrap(), Received::Event(_)));
    for _ in 0..3 {
        pilot.send_message(&MavMessage::COMMAND_LONG(Default::default())).unwrap();
    }
    let replay = Replay::open(&path, 1.0).unwrap();
    let start = Instant::now();
    let mut last = 0;
    let counts = replay.play(&mut reader, &writer, |number, _| last = number).await.unwrap();
    assert_eq!(start.elapsed().as_millis(), 700);
    assert_eq!((counts.frames, counts.unsent, counts.discarded), (5, 0, 3));
    let held_back = HeldBack { not_of_an_autopilot: 3, unknown: 1, not_telemetry: 2 };
    assert_eq!((counts.held_back, held_back.total()), (held_back, 6));
    assert_eq!(last, 8);
    for (index, _) in PLAYED {
        let Received::Frame(frame) = vehicle.receive().await.unwrap() else { panic!("no frame") };
        assert_eq!(frame.bytes(), frames[index].1);
    }
    std::fs::remove_file(path).unwrap();
}

/// Whatever ids a log holds, as MAVLink 1 and 2: what is not on the list of telemetry does not come out.
#[tokio::test(start_paused = true)]
async fn nothing_but_telemetry_comes_out_of_a_hostile_log() {
    let seeds = CrcSeeds::new();
    let mut bytes = record(START_US, &v2(header(1, 0), &heartbeat()));
    let mut held_back = 0;
    for id in (1..20_000).chain([51_001, 120_000, 0x00FF_FFFF]) {
        let seed = seeds.get(id).unwrap_or(7);
        bytes.extend(record(START_US, &raw_v2(id, seed)));
        held_back += 1;
        if let Ok(id) = u8::try_from(id) {
            bytes.extend(record(START_US, &raw_v1(id, seed)));
            held_back += 1;
        }
    }
    let path = std::env::temp_dir().join(format!("mavid-hostile-{}.tlog", std::process::id()));
    std::fs::write(&path, bytes).unwrap();
    let mut reader = Replay::open(&path, 0.0).unwrap().start();
    let mut played = BTreeMap::<u32, u32>::new();
    while let Ok(received) = reader.receive().await {
        if let Received::Frame(frame) = received {
            *played.entry(frame.header.message_id).or_default() += 1;
        }
    }
    assert!(played.contains_key(&0) && played.contains_key(&30), "{played:?}");
    assert!(played.len() < 100 && held_back > 20_000, "{played:?}");
    let names: BTreeSet<u32> = played.keys().copied().filter(|id| STEERS.contains(id)).collect();
    assert!(names.is_empty(), "came out: {names:?}");
    std::fs::remove_file(path).unwrap();
}

/// SET_MODE, PARAM_SET, MISSION_ITEM and _INT, COMMAND_LONG and _INT, SET_ATTITUDE_TARGET, SET_POSITION_TARGET_*, HIL_*,
/// VISION_*, VICON, ATT_POS_MOCAP, ODOMETRY, GPS_INPUT, GPS_RTCM_DATA, CAN_FRAME, SETUP_SIGNING, SYSTEM_TIME, TUNNEL.
const STEERS: [u32; 28] = [
    2, 11, 23, 39, 73, 75, 76, 82, 84, 86, 90, 91, 92, 93, 101, 102, 103, 104, 107, 113, 115, 138, 232, 233,
    256, 331, 385, 386,
];

/// A frame of system 1 with any body.
fn raw_v2(id: u32, seed: u8) -> Vec<u8> {
    let [low, middle, high, _] = id.to_le_bytes();
    let mut frame = vec![0xFD, 8, 0, 0, 1, 1, 1, low, middle, high];
    frame.extend([1, 2, 3, 4, 5, 6, 7, 8]);
    let sum = checksum(&frame[1..], seed);
    frame.extend(sum.to_le_bytes());
    frame
}

/// The same in MAVLink 1.
fn raw_v1(id: u8, seed: u8) -> Vec<u8> {
    let mut frame = vec![0xFE, 8, 1, 1, 1, id];
    frame.extend([1, 2, 3, 4, 5, 6, 7, 8]);
    let sum = checksum(&frame[1..], seed);
    frame.extend(sum.to_le_bytes());
    frame
}

#[test]
fn what_cannot_be_played_is_told() {
    let missing = PathBuf::from("no/such.tlog");
    assert!(matches!(Replay::open(&missing, 1.0), Err(ReplayError::Log { .. })));
    for speed in [-1.0, f64::NAN, f64::INFINITY] {
        let error = Replay::open(&missing, speed).unwrap_err().to_string();
        assert!(error.contains("speed of 0"), "{error}");
    }
}
