//! Standard output and standard error on pipes that nobody reads, and disks that are full: what flies goes on flying,
//! what records ends when it is told to, and no count claims what is not there.

use std::net::UdpSocket;
use std::path::Path;
use std::process::{Command, Stdio};

use crate::processes::{Running, config, folder, planned, until, vehicle};
use crate::stuck::full_pipe;
use crate::support::{frames, header, heartbeat, read, v2};
use serde_json::Value;

const MAVID: &str = env!("CARGO_BIN_EXE_mavid");
fn record(out: &Path, port: u16) -> Command {
    let mut command = Command::new(MAVID);
    command.args(["--json", "record", "--connect", &format!("udpin:127.0.0.1:{port}"), "--force", "--out"]);
    command.arg(out).stdin(Stdio::null());
    command
}

/// A vehicle that sends heartbeats there.
struct Beats(UdpSocket, u8);

impl Beats {
    fn new(port: u16) -> Self {
        let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
        socket.connect(("127.0.0.1", port)).unwrap();
        Self(socket, 0)
    }

    /// Whether somebody took one more.
    fn beat(&mut self) -> bool {
        let sent = self.0.send(&v2(header(1, self.1), &heartbeat())).is_ok();
        self.1 = self.1.wrapping_add(1);
        sent
    }
}

fn held(out: &Path) -> usize {
    let bytes = std::fs::read(out).unwrap_or_default();
    if bytes.is_empty() { 0 } else { frames(&read(&bytes).0).len() }
}

pub fn a_recording_ends_on_sigterm_though_nobody_reads_what_it_says() {
    for (name, blocks_output) in [("stdout", true), ("stderr", false)] {
        let (out, port) = (folder(&format!("stuck_{name}")).join("r.tlog"), free_udp_port());
        let (_reader, writer) = full_pipe();
        let mut command = record(&out, port);
        match blocks_output {
            true => command.stdout(writer).stderr(Stdio::null()),
            false => command.stdout(Stdio::null()).stderr(writer),
        };
        let mut running = Running(command.spawn().unwrap());
        let mut vehicle = Beats::new(port);
        until("nothing is recorded", || {
            vehicle.beat();
            held(&out) >= 20
        });
        running.terminate();
        let status = running.ended(&format!("{name} holds it up"));
        // not all of its words went out
        assert_eq!(status, 1, "{name}");
        assert!(held(&out) >= 20);
    }
}

pub fn a_full_disk_is_told_and_no_frame_is_claimed_that_is_not_there() {
    let port = free_udp_port();
    let mut command = record(Path::new("/dev/full"), port);
    let mut running = Running(command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap());
    let mut vehicle = Beats::new(port);
    let mut taken = 0;
    until("nobody listens", || {
        taken += u32::from(vehicle.beat());
        taken >= 50
    });
    running.terminate();
    assert_eq!(running.ended("a full disk holds it up"), 1);
    let (mut said, mut told) = (String::new(), String::new());
    std::io::Read::read_to_string(running.0.stdout.as_mut().unwrap(), &mut said).unwrap();
    std::io::Read::read_to_string(running.0.stderr.as_mut().unwrap(), &mut told).unwrap();
    let document: Value = serde_json::from_str(&said).unwrap();
    assert_eq!(document["frames"], 0, "{said}");
    assert_eq!(document["dropped"], document["received_frames"], "{said}");
    assert!(document["dropped"].as_u64().unwrap() > 0);
    assert!(told.contains("cannot write /dev/full"), "{told}");
}

fn free_udp_port() -> u16 {
    UdpSocket::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port()
}

fn fly(out: &Path, connect: &str) -> Command {
    let mut command = Command::new(MAVID);
    command.args([
        "fly",
        "--plain",
        "--connect",
        connect,
        "--vehicle",
        &config("qball2.toml"),
        "--trajectory",
    ]);
    command.args([&config("trajectories/table2.toml"), "--out"]).arg(out).stdin(Stdio::null());
    command
}

pub fn after_a_connection_that_failed_the_same_command_begins_again() {
    let out = folder("retry").join("flight");
    let taken = UdpSocket::bind("127.0.0.1:0").unwrap();
    let nobody = UdpSocket::bind("127.0.0.1:0").unwrap();
    let busy = format!("udpin:{}", taken.local_addr().unwrap());
    let silent = format!("udpout:{}", nobody.local_addr().unwrap());
    let tlog = out.join("flight.tlog");
    let said = || std::fs::metadata(out.join("events.jsonl")).map_or(0, |events| events.len());
    for connect in ["serial:/nonexistent/tty:57600", &busy, "serial:/nonexistent/tty:57600"] {
        let output = fly(&out, connect).output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{said}");
        assert!(said.contains("cannot open") && !said.contains("exists"), "{said}");
    }
    for _ in 0..2 {
        // given up: there is nothing in the recording but what the station said to nobody
        let before = said();
        let mut running = Running(fly(&out, &silent).stderr(Stdio::null()).spawn().unwrap());
        // the recording of the try before is there until this one begins
        until("no heartbeat", || said() > before && held(&tlog) > 0);
        running.terminate();
        assert_eq!(running.ended("it does not end"), 3);
        assert!(held(&tlog) > 0);
    }
    // one frame of a vehicle, and nobody takes it away
    let mut recording = std::fs::read(&tlog).unwrap();
    recording.extend(crate::support::tlog(&[v2(header(1, 0), &heartbeat())]));
    std::fs::write(&tlog, &recording).unwrap();
    let output = fly(&out, &silent).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("exists already and holds a recording"), "{said}");
    assert_eq!(std::fs::read(&tlog).unwrap(), recording);
}

/// One flight in real time.
pub fn a_flight_goes_on_though_its_terminal_takes_nothing() {
    let (trajectory, out) = (planned("stuck_plan", 1), folder("stuck_flight").join("flight"));
    let (_vehicle, listens) = vehicle("px4", "udpin:127.0.0.1:0");
    let (reader, writer) = full_pipe();
    let mut running = Running(
        Command::new(MAVID)
            // every event becomes a log line, which nobody takes either
            .args(["-vvv", "--json", "fly", "--plain", "--arm", "--connect", &listens.replace("in:", "out:")])
            .args(["--vehicle", &config("x500.toml"), "--out"])
            .arg(&out)
            .arg("--trajectory")
            .arg(&trajectory)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(writer)
            .spawn()
            .unwrap(),
    );
    let events = || std::fs::read_to_string(out.join("events.jsonl")).unwrap_or_default();
    until("the flight does not end", || {
        events().contains("\"text\":\"over\"") || running.0.try_wait().unwrap().is_some()
    });
    assert!(events().contains("the terminal accepts no output"), "{}", events());
    // whoever waits to write hears that nobody reads
    drop(reader);
    let mut said = String::new();
    std::io::Read::read_to_string(running.0.stdout.as_mut().unwrap(), &mut said).unwrap();
    let status = running.ended("it does not end");
    let document: Value = serde_json::from_str(&said).unwrap();
    let flight = &document["flight"];
    assert_eq!((&flight["cause"], flight["ending"]["id"].as_str()), (&Value::Null, Some("landed")), "{said}");
    assert!(status == 0 || status == 3, "{status}: {said}");
}
