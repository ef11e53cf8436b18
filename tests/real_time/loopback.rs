//! `mavid fly` against `mavid sitl`, two processes in real time: both autopilots over UDP, TCP and a serial port, from
//! the plan to the explained flight. The flights run side by side and are asleep for most of their time.

use std::path::{Path, PathBuf};
use std::process::Output;
use std::thread;
use std::time::Duration;

use crate::lossy::{Faults, LossyProxy};
use crate::processes::{config, fly, folder, free_port, planned, vehicle};
use mavid::config::load_vehicle;
use mavid::log::TlogReader;
use mavid::wire::{Check, CrcSeeds};
use serde_json::Value;

const SET_POSITION_TARGET_LOCAL_NED: u32 = 84;
const PERIODS: u64 = 4;

/// Which end of a link waits for the other.
#[derive(Clone, Copy)]
enum Link {
    /// the vehicle listens, as ArduPilot's simulator does
    VehicleListens(&'static str),
    /// the ground station listens, and is started last
    GroundListens(&'static str),
    Serial,
}

fn flight(name: &str, autopilot: &str, link: Link, trajectory: &Path) -> (PathBuf, Output) {
    let folder = folder(name);
    let out = folder.join("flight");
    let (_vehicle, connect) = match link {
        Link::VehicleListens(kind) => {
            let (vehicle, listens) = vehicle(autopilot, &format!("{kind}in:127.0.0.1:0"));
            (vehicle, listens.replace("in:", "out:"))
        }
        Link::GroundListens(kind) => {
            let port = free_port();
            let (vehicle, _) = vehicle(autopilot, &format!("{kind}out:127.0.0.1:{port}"));
            (vehicle, format!("{kind}in:127.0.0.1:{port}"))
        }
        Link::Serial => {
            let path = folder.join("tty").display().to_string();
            (vehicle(autopilot, &format!("pty:{path}")).0, format!("serial:{path}:921600"))
        }
    };
    let output = fly(&out, &connect, trajectory, &[]);
    (out, output)
}

pub fn both_autopilots_fly_over_every_link_and_are_identified() {
    let trajectory = planned("plan", PERIODS);
    let flights = [
        ("px4_udp", "px4", Link::GroundListens("udp")),
        ("px4_tcp", "px4", Link::VehicleListens("tcp")),
        ("px4_serial", "px4", Link::Serial),
        ("ardupilot_udp", "ardupilot", Link::VehicleListens("udp")),
        ("ardupilot_tcp", "ardupilot", Link::GroundListens("tcp")),
        ("ardupilot_serial", "ardupilot", Link::Serial),
    ];
    thread::scope(|scope| {
        let trajectory = &trajectory;
        let under_way = flights.map(|(name, autopilot, link)| {
            (name, scope.spawn(move || flight(name, autopilot, link, trajectory)))
        });
        for (name, flight) in under_way {
            let (out, output) = flight.join().unwrap();
            let said = String::from_utf8_lossy(&output.stderr).into_owned();
            assert_eq!(output.status.code(), Some(0), "{name}: {said}");
            let document: Value = serde_json::from_slice(&output.stdout).unwrap();
            is_whole(&document, name);
            is_identified(&document, name);
            assert!(document["setpoints"]["sent"].as_u64().unwrap() > 24 * 50, "{name}: {said}");
            setpoints_are_new(&out.join("flight.tlog"), document["setpoints"]["sent"].as_u64().unwrap());
            for file in [
                "events.jsonl",
                "parameters.toml",
                "trajectory.toml",
                "vehicle.toml",
                "model.toml",
                "report.html",
                "report.md",
                "explanation.json",
                "rigid_body/model.toml",
                "rigid_body/report.html",
                "rigid_body/identification.txt",
                "rigid_body/identification.json",
                "rigid_body/parameters.svg",
            ] {
                assert!(out.join(file).exists(), "{name}: {file}");
            }
        }
    });
}

/// A fifth of the datagrams lost, a fifth of a second each way, one in ten held back, some twice.
pub fn over_a_bad_network_the_flight_ends_on_the_ground_and_nothing_of_its_log_is_lost() {
    let runtime = tokio::runtime::Builder::new_multi_thread().worker_threads(1).enable_all().build().unwrap();
    runtime.block_on(on_a_bad_network());
}

async fn on_a_bad_network() {
    let trajectory = planned("bad_network_plan", 1);
    let port = free_port();
    let faults = Faults {
        seed: 3,
        loss: 0.2,
        duplicate: 0.05,
        reorder: 0.1,
        held: Duration::from_millis(60),
        delay: Duration::from_millis(200),
    };
    let proxy = LossyProxy::start(0, format!("127.0.0.1:{port}").parse().unwrap(), faults).await;
    let out = folder("bad_network").join("flight");
    let output = tokio::task::spawn_blocking({
        let (out, address) = (out.clone(), proxy.address);
        move || {
            let _vehicle = vehicle("px4", &format!("udpout:{address}"));
            fly(&out, &format!("udpin:127.0.0.1:{port}"), &trajectory, &[])
        }
    })
    .await
    .unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(matches!(output.status.code(), Some(0 | 3)), "{said}");
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(document["flight"]["ending"]["id"], "landed", "{said}");
    assert_eq!(document["dropped_frames"], 0, "{said}");
    let bytes = std::fs::read(out.join("flight.tlog")).unwrap();
    let mut reader = TlogReader::new(bytes.as_slice());
    let mut records = 0_u64;
    while reader.next_record().unwrap().is_some() {
        records += 1;
    }
    assert_eq!(Some(records), document["recorded_frames"].as_u64(), "{said}");
    setpoints_are_new(&out.join("flight.tlog"), document["setpoints"]["sent"].as_u64().unwrap());
}

fn is_whole(document: &Value, name: &str) {
    assert_eq!(document["flight"]["ending"]["id"], "landed", "{name}");
    assert_eq!(document["flight"]["cause"], Value::Null, "{name}");
    assert_eq!(document["flight"]["flown"]["periods"], PERIODS, "{name}");
    assert_eq!(
        (&document["dropped_frames"], &document["setpoints"]["refused"]),
        (&0.into(), &0.into()),
        "{name}"
    );
    assert!(document["flight"]["flown"]["tracking_rms_m"].as_f64().unwrap() < 0.3, "{name}");
    // what verdict the explanation comes to is for its own tests
    assert!(document["explanation"]["verdict"].is_string(), "{name}");
}

/// The tolerances of the cases: mass within 0.5 %, moments within 3 %, products within 3 % of `sqrt(Iii Ijj)`.
pub fn is_identified(document: &Value, name: &str) {
    let truth = load_vehicle(Path::new(&config("x500.toml"))).unwrap().body;
    let found = |parameter: &str| {
        let value = &document["identification"]["best"]["parameters"][parameter]["value"];
        value.as_f64().unwrap_or_else(|| panic!("{name}: {parameter} is {value}"))
    };
    let mass = found("mass");
    assert!((mass / truth.mass_kg - 1.0).abs() < 0.005, "{name}: {mass} kg");
    let inertia = truth.inertia_kg_m2;
    for (parameter, i, j) in
        [("ixx", 0, 0), ("iyy", 1, 1), ("izz", 2, 2), ("ixy", 0, 1), ("ixz", 0, 2), ("iyz", 1, 2)]
    {
        let scale = (inertia[(i, i)] * inertia[(j, j)]).sqrt();
        let error = (found(parameter) - inertia[(i, j)]) / scale;
        assert!(error.abs() < 0.03, "{name}: {parameter} off by {:.1} %", 100.0 * error);
    }
}

/// Every setpoint that was counted is in the recording, each for a later instant than the one before: none was
/// repeated, none was stale.
fn setpoints_are_new(tlog: &Path, sent: u64) {
    let seeds = CrcSeeds::new();
    let bytes = std::fs::read(tlog).unwrap();
    let mut reader = TlogReader::new(bytes.as_slice());
    let mut times_ms = Vec::new();
    while let Some(record) = reader.next_record().unwrap() {
        if record.frame.header().message_id == SET_POSITION_TARGET_LOCAL_NED {
            assert_eq!(record.frame.check(&seeds), Check::Right);
            times_ms.push(record.frame.payload().u32(0));
        }
    }
    assert_eq!(times_ms.len() as u64, sent);
    assert!(times_ms.windows(2).all(|pair| pair[1] > pair[0]), "a setpoint is not newer than the one before");
}
