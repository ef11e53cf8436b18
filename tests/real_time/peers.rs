//! `mavid fly` with a vehicle that pymavlink plays, and its log as pymavlink reads it. Skipped, with a message, where
//! Python or pymavlink is missing (`tests/peers/setup.sh` installs it).

use std::fmt::Write;
use std::path::Path;
use std::process::Command;
use std::thread;

use crate::processes::{fly, folder, free_port, planned};
use crate::support::Needed;
use mavid::log::TlogReader;
use serde_json::{Value, json};

const RATE_HZ: u32 = 50;
const VEHICLE: &str = "vehicle_with_pymavlink.py";

pub fn a_vehicle_played_by_pymavlink_is_flown_to_the_ground_and_its_log_is_read_by_pymavlink_to_the_byte() {
    if let Err(why) = crate::python::ask(VEHICLE, &["--check"], &json!(null)) {
        return crate::support::skip(Needed::Peers, &why);
    }
    let trajectory = planned("peer_plan", 2);
    let out = folder("peer").join("flight");
    let port = free_port();
    let connect = format!("udpin:127.0.0.1:{port}");
    let rate = RATE_HZ.to_string();
    // it keeps no log of its own
    let further = ["--setpoint-hz", &rate, "--no-fetch-log"];
    let (output, seen) = thread::scope(|scope| {
        let flight = scope.spawn(|| fly(&out, &connect, &trajectory, &further));
        let seen =
            crate::python::ask(VEHICLE, &[&format!("udpout:127.0.0.1:{port}"), &rate], &json!(null)).unwrap();
        (flight.join().unwrap(), seen)
    });
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    let document: Value = serde_json::from_slice(&output.stdout).unwrap_or_else(|_| json!(said));
    assert_eq!(document["flight"]["ending"]["id"], "landed", "{said}");
    assert_eq!(document["flight"]["cause"], Value::Null, "{said}");
    assert_eq!(document["flight"]["flown"]["periods"], 2, "{said}");
    assert_eq!(document["dropped_frames"], 0, "{said}");

    let events = std::fs::read_to_string(out.join("events.jsonl")).unwrap();
    for ready in ["ok: home", "ok: estimate", "ok: pre-arm", "ok: health"] {
        assert!(events.contains(ready), "{ready}: {events}");
    }
    assert!(!events.contains("refusal:"), "{events}");

    assert_eq!(seen["modes"], json!(["HOLD", "OFFBOARD", "LAND", "HOLD"]), "{seen}");
    assert_eq!(seen["losses"], 0, "{seen}");
    assert!(seen["highest_m"].as_f64().unwrap() > 1.0, "{seen}");
    setpoints_come_at_their_rate_and_fresh(&seen, &document["setpoints"]);
    pymavlink_reads(&out.join("flight.tlog"), document["recorded_frames"].as_u64().unwrap());
}

/// By the vehicle's count: nothing repeated, next to nothing missing, and most of them young. How punctual they are is for
/// the benchmark.
fn setpoints_come_at_their_rate_and_fresh(seen: &Value, sent: &Value) {
    let count = |key: &str| seen[key].as_u64().unwrap();
    assert_eq!(Some(count("setpoints")), sent["sent"].as_u64(), "{seen} {sent}");
    assert_eq!(seen["newer_each"], true, "{seen}");
    assert!(100 * count("slots_filled") > 95 * count("slots"), "{seen}");
    // more than a dozen seconds along the trajectory
    assert!(count("moving") > 12 * u64::from(RATE_HZ), "{seen}");
    // a stalled flight sends no setpoint that is older
    assert!(seen["age_ms"]["median"].as_f64().unwrap() < 100.0, "{seen}");
}

fn pymavlink_reads(tlog: &Path, recorded: u64) {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/peers/read_with_pymavlink.py");
    let output =
        Command::new(crate::python::interpreter()).arg(script).arg("--records").arg(tlog).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let theirs = String::from_utf8(output.stdout).unwrap();
    let bytes = std::fs::read(tlog).unwrap();
    let mut reader = TlogReader::new(bytes.as_slice());
    let (mut ours, mut records) = (String::new(), 0);
    while let Some(record) = reader.next_record().unwrap() {
        write!(ours, "{} ", record.stamp_us).unwrap();
        for byte in record.frame.bytes() {
            write!(ours, "{byte:02x}").unwrap();
        }
        ours.push('\n');
        records += 1;
    }
    assert_eq!(records, recorded);
    assert!(ours == theirs, "pymavlink reads other stamps or bytes");
}
