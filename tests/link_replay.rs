//! A recorded flight played back.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test ends where it fails")]

mod support;

use std::path::PathBuf;
use std::time::Duration;

use mavid::link::{Link, LinkError, LinkEvent, LinkOptions, Received, Replay, ReplayError};
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
        (150, unknown(3, b"something new")),
        (9_000_000, v2(header(1, 4), &attitude(2))),
        (9_000_400, v2(header(1, 5), &attitude(3))),
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
        assert_eq!((replay.frames(), replay.duration()), (8, Duration::from_millis(700)));
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
    let counts = replay.play(&mut reader, &writer, |number| last = number).await.unwrap();
    assert_eq!(start.elapsed().as_millis(), 700);
    assert_eq!((counts.frames, counts.left_out, counts.unsent, counts.discarded), (5, 3, 0, 3));
    assert_eq!(last, 8);
    for (index, _) in PLAYED {
        let Received::Frame(frame) = vehicle.receive().await.unwrap() else { panic!("no frame") };
        assert_eq!(frame.bytes(), frames[index].1);
    }
    std::fs::remove_file(path).unwrap();
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
