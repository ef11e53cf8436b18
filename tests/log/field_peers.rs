//! Field by field, vehicles' own logs are what pyulog and pymavlink read of them: which streams, how many samples, their values
//! and their stamps.

use std::collections::BTreeMap;
use std::path::PathBuf;

use mavid::log::{self, OpenOptions};
use mavid::recording::{Quantity, Recording, Stream};
use serde::Deserialize;
use serde_json::json;

use crate::{python, support};

/// Weights of the samples' places begin again after so many, as in `streams_of_logs.py`.
const PLACES: usize = 97;
/// Of the sum of magnitudes: the order of additions, and angles by other functions.
const SAME: f64 = 1e-7;
/// s a sample: the stamps' last digit.
const SAME_S: f64 = 2e-6;
/// One short flight of each folder and autopilot, with rotor speeds where the folder has them.
const SOME: [&str; 5] = [
    "sitl/px02.ulg",
    "sitl/px09.ulg",
    "sitl/ap11.bin",
    "propeller_cut/flight_01.BIN",
    "motor_fault_sim/flight_01.bin",
];

/// A stream as another reader sees it.
#[derive(Deserialize)]
struct Seen {
    count: usize,
    /// of each value: sum, sum weighted by place, sum of magnitudes; none where values are not told
    sums: Vec<[f64; 3]>,
    first_s: f64,
    /// sum of the times after the first
    after_s: f64,
}

/// Four entries of the rotation matrix of w x y z.
fn entries([w, x, y, z]: [f64; 4]) -> [f64; 4] {
    [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y), 2.0 * (y * z + w * x)]
}

fn sums(quantity: Quantity, stream: &Stream) -> Vec<[f64; 3]> {
    let mut sums = vec![[0.0; 3]; stream.width];
    for place in 0..stream.len() {
        let mut sample = stream.sample(place).to_vec();
        if matches!(quantity, Quantity::Attitude | Quantity::AttitudeSetpoint) {
            sample = entries(*sample.first_chunk().unwrap()).to_vec();
        }
        for (sums, value) in sums.iter_mut().zip(sample).filter(|(_, value)| value.is_finite()) {
            sums[0] += value;
            sums[1] += value * (1 + place % PLACES) as f64;
            sums[2] += value.abs();
        }
    }
    sums
}

/// Where a recording is not what the other reader saw.
fn differences(recording: &Recording, mut seen: BTreeMap<String, Seen>) -> Vec<String> {
    let mut wrong = Vec::new();
    // the recording's clock begins with its first message; the readers have the vehicle's
    let mut starts_s = Vec::new();
    for (key, stream) in &recording.streams {
        // ArduPilot's states are made of events
        if key.source == "EV" {
            continue;
        }
        let name = format!("{} {} {}", key.quantity.name(), key.source, key.instance);
        let Some(seen) = seen.remove(&name) else {
            wrong.push(format!("{name}: {} samples, the other reader has none", stream.len()));
            continue;
        };
        if stream.len() != seen.count {
            wrong.push(format!("{name}: {} samples, the other reader has {}", stream.len(), seen.count));
            continue;
        }
        let after_s: f64 = stream.time_s.iter().map(|time_s| time_s - stream.time_s[0]).sum();
        if (after_s - seen.after_s).abs() > SAME_S * stream.len() as f64 {
            wrong.push(format!(
                "{name}: times after the first {after_s}, the other reader has {}",
                seen.after_s
            ));
        }
        starts_s.push((seen.first_s - stream.time_s[0], name.clone()));
        if seen.sums.is_empty() {
            continue;
        }
        let own = sums(key.quantity, stream);
        if own.len() != seen.sums.len() {
            wrong.push(format!("{name}: {} values, the other reader has {}", own.len(), seen.sums.len()));
        }
        for (value, (own, seen)) in own.iter().zip(&seen.sums).enumerate() {
            let near = |at: usize, most: f64| (own[at] - seen[at]).abs() <= SAME * most + 1e-12;
            if !(near(0, seen[2]) && near(1, seen[2] * PLACES as f64) && near(2, seen[2])) {
                wrong.push(format!("{name}, value {value}: sums {own:?}, the other reader has {seen:?}"));
            }
        }
    }
    wrong.extend(seen.into_keys().map(|name| format!("{name}: not in the recording")));
    let start_s = starts_s.first().map_or(0.0, |(start_s, _)| *start_s);
    let early = starts_s.iter().filter(|(other_s, _)| (other_s - start_s).abs() > SAME_S);
    wrong.extend(
        early.map(|(other_s, name)| format!("{name}: its clock begins at {other_s} s, others at {start_s}")),
    );
    wrong
}

fn hold(files: &[PathBuf]) {
    let arguments: Vec<&str> = files.iter().map(|file| file.to_str().unwrap()).collect();
    let answer = match python::ask("streams_of_logs.py", &arguments, &json!(null)) {
        Ok(answer) => answer,
        Err(missing) => return support::skip(support::Needed::Peers, &missing),
    };
    let mut seen: BTreeMap<String, BTreeMap<String, Seen>> = serde_json::from_value(answer).unwrap();
    let mut wrong = Vec::new();
    for file in arguments {
        let opened = log::open(file, &OpenOptions::default()).unwrap();
        let seen = seen.remove(file).unwrap();
        assert!(seen.len() > 15, "{file}: {} streams", seen.len());
        let of_file = differences(&opened.recording, seen);
        wrong.extend(of_file.into_iter().map(|difference| format!("{file}: {difference}")));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn some_flights_are_what_other_readers_see() {
    let Some(shared) = support::shared() else { return };
    hold(&SOME.map(|file| shared.join("onboard").join(file)));
}

/// 45 flights, half a minute.
#[test]
#[ignore = "all flights take half a minute; .ci/slow runs them"]
fn all_flights_are_what_other_readers_see() {
    let Some(shared) = support::shared() else { return };
    let mut files = Vec::new();
    for folder in ["sitl", "propeller_cut", "motor_fault_sim"] {
        let entries = std::fs::read_dir(shared.join("onboard").join(folder)).unwrap();
        let logs = entries.map(|entry| entry.unwrap().path()).filter(|path| {
            path.extension().is_some_and(|end| end.eq_ignore_ascii_case("bin") || end == "ulg")
        });
        files.extend(logs);
    }
    files.sort();
    assert!(files.len() > 40, "{} logs", files.len());
    hold(&files);
}
