//! `mavid record` and `mavid replay` at their process boundary.

use crate::support;

use std::net::UdpSocket;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use mavid::wire::Frame;
use mavlink::dialects::ardupilotmega::MavMessage;
use serde_json::Value;
use support::{attitude, frames, header, heartbeat, read, tlog, unknown, v2};

const LONG: Duration = Duration::from_secs(30);

fn mavid(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_mavid"));
    command.args(arguments).stdin(Stdio::null());
    command
}

fn run(arguments: &[&str]) -> Output {
    mavid(arguments).output().unwrap()
}

fn file(what: &str) -> PathBuf {
    std::env::temp_dir().join(format!("mavid-{what}-{}.tlog", std::process::id()))
}

fn socket() -> (UdpSocket, String) {
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    socket.set_read_timeout(Some(LONG)).unwrap();
    let address = format!("udpout:{}", socket.local_addr().unwrap());
    (socket, address)
}

fn until(what: &str, mut done: impl FnMut() -> bool) {
    let deadline = Instant::now() + LONG;
    while !done() {
        assert!(Instant::now() < deadline, "{what}");
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// A recorder that listens on a free port.
fn listening(out: &Path, further: &[&str]) -> (Child, UdpSocket) {
    let port = UdpSocket::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
    let address = format!("udpin:127.0.0.1:{port}");
    let child = mavid(&["record", "--connect", &address, "--out", out.to_str().unwrap()])
        .args(further)
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let vehicle = UdpSocket::bind("127.0.0.1:0").unwrap();
    vehicle.connect(("127.0.0.1", port)).unwrap();
    vehicle.set_read_timeout(Some(LONG)).unwrap();
    (child, vehicle)
}

/// What the file holds is there although the program never came to close it.
#[test]
fn a_recording_survives_a_kill() {
    let out = file("killed");
    let (mut child, vehicle) = listening(&out, &["--force"]);
    let mut sent = Vec::new();
    let recorded = || std::fs::read(&out).unwrap_or_default();
    // until the program listens, datagrams are refused
    until("no recording", || {
        let frame = v2(header(1, u8::try_from(sent.len() % 256).unwrap()), &heartbeat());
        if vehicle.send(&frame).is_ok() {
            sent.push(frame);
        }
        !recorded().is_empty()
    });
    let first = frames(&read(&recorded()).0).len();
    for sequence in 0..50 {
        vehicle.send(&v2(header(1, sequence), &attitude(sequence.into()))).unwrap();
    }
    until("not within a second or so", || frames(&read(&recorded()).0).len() >= first + 50);
    for sequence in 50..100 {
        vehicle.send(&v2(header(1, sequence), &attitude(sequence.into()))).unwrap();
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let (records, report) = read(&recorded());
    assert_eq!((report.truncated_tail_bytes, report.resync_count, report.bad_crc), (0, 0, 0));
    let attitudes: Vec<_> =
        frames(&records).into_iter().filter(|frame| frame != &sent[0] && frame.len() > 30).collect();
    for (sequence, frame) in (0_u8..50).zip(&attitudes) {
        assert_eq!(frame, &v2(header(1, sequence), &attitude(sequence.into())));
    }
    assert!(attitudes.len() >= 50, "{}", attitudes.len());
    std::fs::remove_file(out).unwrap();
}

#[test]
fn a_recording_ends_with_its_time_and_says_what_it_holds() {
    let out = file("timed");
    let name = out.to_str().unwrap();
    let (child, vehicle) = listening(&out, &["--force", "--duration", "2", "--json"]);
    let strange = unknown(7, b"anything");
    until("no end", || {
        let _ = vehicle.send(&v2(header(1, 6), &heartbeat()));
        let _ = vehicle.send(&strange);
        std::fs::metadata(&out).is_ok_and(|found| found.len() > 0)
    });
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((document["schema"].as_u64(), document["log"].as_str()), (Some(1), Some(name)));
    assert_eq!(document["sent_frames"], 0, "nobody asked it to speak");
    let held = frames(&read(&std::fs::read(&out).unwrap()).0);
    assert_eq!(document["frames"].as_u64(), Some(held.len() as u64));
    assert!(held.contains(&strange));
    // a file that is there is not replaced without a word
    let again = run(&["record", "--connect", "udpin:127.0.0.1:0", "--out", name, "--duration", "1"]);
    assert_eq!(again.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&again.stderr).contains("--force"));
    assert_eq!(frames(&read(&std::fs::read(&out).unwrap()).0), held);
    std::fs::remove_file(out).unwrap();
}

#[test]
fn asked_to_speak_it_sends_heartbeats_and_requests_messages() {
    let (out, (vehicle, address)) = (file("spoken"), socket());
    let child = mavid(&["record", "--connect", &address, "--out", out.to_str().unwrap(), "--force"])
        .args(["--heartbeat", "--duration", "3", "--json"])
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut buffer = [0; 300];
    let mut ids = Vec::new();
    while ids.iter().filter(|id| **id == 76).count() < 5 {
        let (bytes, from) = vehicle.recv_from(&mut buffer).unwrap();
        let frame = Frame::at_start(&buffer[..bytes]).unwrap();
        ids.push(frame.header().message_id);
        vehicle.send_to(&v2(header(1, 0), &heartbeat()), from).unwrap();
    }
    assert_eq!(ids[0], 0);
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    let held = frames(&read(&std::fs::read(&out).unwrap()).0);
    let sent = held.iter().filter(|frame| Frame::at_start(frame).unwrap().header().system.0 == 255).count();
    assert_eq!(document["sent_frames"].as_u64(), Some(sent as u64));
    std::fs::remove_file(out).unwrap();
}

#[test]
fn a_replay_plays_telemetry_alone_and_tells_what_it_holds_back() {
    let (log, (station, address)) = (file("played"), socket());
    let command = MavMessage::COMMAND_LONG(Default::default());
    let sent = [
        v2(header(1, 0), &heartbeat()),
        v2(header(1, 1), &attitude(1)),
        unknown(2, b"new"),
        v2(header(1, 3), &command),
        v2(header(255, 0), &command),
    ];
    std::fs::write(&log, tlog(&sent)).unwrap();
    let name = log.to_str().unwrap();
    let output = run(&["replay", name, "--to", &address, "--speed", "0", "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((document["frames"].as_u64(), document["left_out"].as_u64()), (Some(2), Some(3)));
    for reason in ["not_of_an_autopilot", "unknown_messages", "not_telemetry"] {
        assert_eq!(document[reason].as_u64(), Some(1), "{reason}");
    }
    let mut buffer = [0; 300];
    for expected in &sent[..2] {
        let bytes = station.recv(&mut buffer).unwrap();
        assert_eq!(&buffer[..bytes], expected);
    }
    std::fs::remove_file(log).unwrap();
}

#[test]
fn wrong_input_is_told_with_what_was_expected() {
    let missing = "no/such.tlog";
    for (arguments, expected) in [
        (vec!["record", "--connect", "udp:1", "--out", "x.tlog"], "udpin:HOST:PORT"),
        (vec!["record", "--connect", "udpin:127.0.0.1:0", "--out", "x.tlog", "--duration", "0"], "above 0"),
        (vec!["replay", missing], missing),
        (vec!["replay", missing, "--speed", "-1"], "speed of 0"),
    ] {
        let output = run(&arguments);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {said}");
        assert!(said.contains(expected), "{arguments:?}: {said}");
    }
    assert!(!Path::new("x.tlog").exists(), "an address that cannot be used leaves no file");
}
