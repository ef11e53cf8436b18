//! `mavid sitl` as a program, commanded by pymavlink and by MAVSDK over UDP and TCP. Skipped, with a message, where Python
//! or the package is missing (`tests/peers/setup.sh` installs them).

use std::io::{BufRead, BufReader};
use std::net::{TcpListener, UdpSocket};
use std::process::{Child, Command, Stdio};

use crate::support::Needed;
use mavid::log::{Input, OpenOptions};
use mavid::recording::Quantity;
use mavid::wire::file_transfer::FileSum;
use serde_json::{Value, json};

/// The running program; ended when the test is.
struct Sitl(Child);

impl Sitl {
    /// Starts it and waits until its links are open.
    fn start(arguments: &[&str]) -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_mavid"))
            .args(["sitl", "--seed", "3"])
            .args(arguments)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut first = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut first).unwrap();
        assert!(first.contains("x500"), "{first}");
        Self(child)
    }

    /// Ctrl-C: its exit status and what it said.
    fn interrupt(mut self) -> (Option<i32>, String) {
        let pid = self.0.id().to_string();
        assert!(Command::new("kill").args(["-INT", &pid]).status().unwrap().success());
        let status = self.0.wait().unwrap();
        let said = std::io::read_to_string(self.0.stderr.take().unwrap()).unwrap();
        (status.code(), said)
    }
}

impl Drop for Sitl {
    fn drop(&mut self) {
        // it may have ended already
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn flown(answer: &Value, autopilot: u8, parameter: f64) {
    assert_eq!(answer["autopilot"], autopilot);
    assert_eq!(answer["parameter"], parameter);
    assert!(answer["parameters"].as_u64().unwrap() > 100);
    assert_eq!(answer["bad"], 0);
    let there = crate::python::numbers(&answer["there"]);
    assert!((there[0] - 1.5).abs() < 0.35 && (there[1] - 1.0).abs() < 0.35, "{there:?}");
    let landed_at = crate::python::numbers(&answer["landed_at"]);
    assert!(landed_at[2].abs() < 0.2, "{landed_at:?}");
}

pub fn pymavlink_flies_px4_offboard_in_lockstep_over_udp() {
    let port = UdpSocket::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
    let listen = format!("udpout:127.0.0.1:{port}");
    let sitl = Sitl::start(&["--lockstep", "--listen", &listen]);
    let connection = format!("udpin:127.0.0.1:{port}");
    match crate::python::ask("fly_with_pymavlink.py", &[&connection, "px4"], &json!(null)) {
        Ok(answer) => flown(&answer, 12, 1.0),
        Err(why) => return crate::support::skip(Needed::Peers, &why),
    }
    let (status, said) = sitl.interrupt();
    assert_eq!(status, Some(0), "{said}");
    assert!(said.contains("stopped after"), "{said}");
}

pub fn pymavlink_flies_ardupilot_guided_fast_over_tcp() {
    let port = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
    let listen = format!("tcpin:127.0.0.1:{port}");
    let options =
        ["--autopilot", "ardupilot", "--speed", "10", "--warm-up", "5", "--listen", listen.as_str()];
    let sitl = Sitl::start(&options);
    let connection = format!("tcp:127.0.0.1:{port}");
    match crate::python::ask("fly_with_pymavlink.py", &[&connection, "ardupilot"], &json!(null)) {
        Ok(answer) => flown(&answer, 3, 3.0),
        Err(why) => return crate::support::skip(Needed::Peers, &why),
    }
    assert_eq!(sitl.interrupt().0, Some(0));
}

/// Real time: MAVSDK has clocks of its own.
pub fn mavsdk_finds_px4_healthy_stores_a_fence_and_flies_offboard() {
    let port = UdpSocket::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
    let listen = format!("udpout:127.0.0.1:{port}");
    let sitl = Sitl::start(&["--warm-up", "2", "--listen", &listen]);
    let connection = format!("udpin://127.0.0.1:{port}");
    let answer = match crate::python::ask("fly_with_mavsdk.py", &[&connection], &json!(null)) {
        Ok(answer) => answer,
        Err(why) => return crate::support::skip(Needed::Mavsdk, &why),
    };
    assert_eq!((&answer["autopilot"], &answer["version"]), (&json!("PX4"), &json!([1, 16])));
    let health = answer["health"].as_object().unwrap();
    assert!(health.len() >= 7 && health.values().all(|ok| ok == true), "{health:?}");
    assert!(answer["parameters"].as_u64().unwrap() > 100);
    assert_eq!(answer["fence"], json!([4, 60.0]));
    assert_eq!((&answer["mission"], &answer["early"]), (&json!("UNSUPPORTED"), &json!("NO_SETPOINT_SET")));
    assert_eq!(answer["in_air"], json!([true, "IN_AIR"]));
    let there = crate::python::numbers(&answer["there"]);
    assert!((there[0] - 1.5).abs() < 0.35 && (there[1] - 1.0).abs() < 0.35, "{there:?}");
    let drifted = crate::python::numbers(&answer["drifted"]);
    assert!(drifted[1] > 3.2 && (drifted[2] + 3.0).abs() < 0.7, "{drifted:?}");
    let landed_at = crate::python::numbers(&answer["landed_at"]);
    assert!(landed_at[1] > 3.2 && landed_at[2].abs() < 0.2, "{landed_at:?}");
    let texts = answer["texts"].to_string();
    assert!(texts.contains("Takeoff detected") && texts.contains("Disarmed by landing"), "{texts}");
    assert_eq!(sitl.interrupt().0, Some(0));
}

/// The log of the flight: what pymavlink downloads is whole, and tells the flight.
fn fetched(answer: &Value, begins: &str, ends: &str) {
    let path = answer["path"].as_str().unwrap();
    assert!(path.starts_with(begins) && path.ends_with(ends), "{path}");
    let hex = answer["log"].as_str().unwrap();
    let bytes: Vec<u8> =
        (0..hex.len() / 2).map(|at| u8::from_str_radix(&hex[2 * at..2 * at + 2], 16).unwrap()).collect();
    assert_eq!(answer["listed"], json!(bytes.len()));
    assert_eq!(answer["sum"], json!(FileSum::of(&bytes)));
    let input = Input::Bytes { name: path, bytes: &bytes };
    let opened = mavid::log::open(input, &OpenOptions::default()).unwrap();
    assert!(opened.report.losses.is_empty(), "{:?}", opened.report.losses);
    let position = opened.recording.streams.iter().find(|(key, _)| key.quantity == Quantity::Position);
    let (_, position) = position.unwrap();
    let highest_m = position.values.iter().skip(2).step_by(3).copied().fold(f64::MIN, f64::max);
    assert!(highest_m > 0.3, "{highest_m}");
}

pub fn pymavlink_fetches_the_log_of_a_flight_of_px4() {
    let port = UdpSocket::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
    let listen = format!("udpout:127.0.0.1:{port}");
    let sitl = Sitl::start(&["--warm-up", "2", "--listen", &listen]);
    let connection = format!("udpin:127.0.0.1:{port}");
    match crate::python::ask("fetch_with_pymavlink.py", &[&connection, "px4"], &json!(null)) {
        Ok(answer) => fetched(&answer, "/fs/microsd/log/", ".ulg"),
        Err(why) => return crate::support::skip(Needed::Peers, &why),
    }
    assert_eq!(sitl.interrupt().0, Some(0));
}

pub fn pymavlink_fetches_the_log_of_a_flight_of_ardupilot() {
    let port = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
    let listen = format!("tcpin:127.0.0.1:{port}");
    let options = ["--autopilot", "ardupilot", "--speed", "3", "--warm-up", "2", "--listen", listen.as_str()];
    let sitl = Sitl::start(&options);
    let connection = format!("tcp:127.0.0.1:{port}");
    match crate::python::ask("fetch_with_pymavlink.py", &[&connection, "ardupilot"], &json!(null)) {
        Ok(answer) => fetched(&answer, "/APM/LOGS/", ".BIN"),
        Err(why) => return crate::support::skip(Needed::Peers, &why),
    }
    assert_eq!(sitl.interrupt().0, Some(0));
}

/// The vehicle writes on its log meanwhile: what comes later is longer.
pub fn mavsdk_fetches_a_log_by_both_protocols() {
    let folder = crate::processes::folder("fetched_by_mavsdk");
    let port = UdpSocket::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
    let listen = format!("udpout:127.0.0.1:{port}");
    let sitl = Sitl::start(&["--warm-up", "2", "--param", "SDLOG_MODE=2", "--listen", &listen]);
    let connection = format!("udpin://127.0.0.1:{port}");
    let arguments = [connection.as_str(), folder.to_str().unwrap()];
    let answer = match crate::python::ask("fetch_with_mavsdk.py", &arguments, &json!(null)) {
        Ok(answer) => answer,
        Err(why) => return crate::support::skip(Needed::Mavsdk, &why),
    };
    let read = |key: &str| std::fs::read(answer[key].as_str().unwrap()).unwrap();
    let (by_messages, by_transfer) = (read("log"), read("ftp"));
    assert_eq!(answer["entries"], json!([by_messages.len()]));
    assert!(!by_messages.is_empty() && by_transfer.starts_with(&by_messages));
    let path = answer["path"].as_str().unwrap();
    let input = Input::Bytes { name: path, bytes: &by_transfer };
    let opened = mavid::log::open(input, &OpenOptions::default()).unwrap();
    assert!(opened.recording.streams.keys().any(|key| key.quantity == Quantity::AngularRate));
    assert_eq!(sitl.interrupt().0, Some(0));
}

/// A fifth of the datagrams is lost both ways.
pub fn a_log_that_pymavlink_serves_by_messages_is_fetched_over_a_lossy_link() {
    let folder = crate::processes::folder("served_by_pymavlink");
    let log = folder.join("log.bin");
    let bytes: Vec<u8> = (0..60_000_u32).map(|at| at.wrapping_mul(2_654_435_761).to_be_bytes()[0]).collect();
    std::fs::write(&log, &bytes).unwrap();
    let port = UdpSocket::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
    let (served, fetched) = std::thread::scope(|scope| {
        let arguments = [format!("udpout:127.0.0.1:{port}"), log.display().to_string(), "0.2".to_owned()];
        let served = scope.spawn(move || {
            let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
            crate::python::ask("logs_with_pymavlink.py", &arguments, &json!(null))
        });
        let mut child = Command::new(env!("CARGO_BIN_EXE_mavid"));
        child.args(["--json", "log", "fetch", "--connect", &format!("udpin:127.0.0.1:{port}"), "--out"]);
        let fetched = child.arg(folder.join("out")).output().unwrap();
        (served.join().unwrap(), fetched)
    });
    let served = match served {
        Ok(served) => served,
        Err(why) => return crate::support::skip(Needed::Peers, &why),
    };
    assert!(fetched.status.success(), "{}", String::from_utf8_lossy(&fetched.stderr));
    let document: Value = serde_json::from_slice(&fetched.stdout).unwrap();
    assert_eq!((&document["protocol"], &document["bytes"]), (&json!("log"), &json!(bytes.len())));
    assert_eq!(std::fs::read(document["log"].as_str().unwrap()).unwrap(), bytes);
    assert!(served["requests"].as_u64().unwrap() > 1, "{served}");
}
