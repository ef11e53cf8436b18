//! ArduPilot's logs of many vehicles and years, held to what an independent reader finds in them.

use crate::support;

use std::collections::{BTreeMap, BTreeSet, HashSet};
use std::path::{Path, PathBuf};

use mavid::autopilot::VehicleKind;
use mavid::log::{self, DataflashReader, DataflashTextReader, Message, OpenOptions};
use mavid::recording::{Quantity, Stream, StreamKey};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use serde_json::Value;

/// What is found of the messages of one name.
#[derive(Debug, Default)]
struct Found {
    count: u64,
    first_time: f64,
    last_time: f64,
    /// least, greatest, sum and number of finite values, by field
    fields: BTreeMap<String, (f64, f64, f64, f64)>,
}

fn add(found: &mut BTreeMap<String, Found>, message: &Message<'_>) {
    let of_name = found.entry(message.definition.name.clone()).or_default();
    let time = ["TimeUS", "TimeMS"].into_iter().find_map(|name| message.definition.field(name));
    if let Some(time) = time.map(|field| message.number(field)) {
        if of_name.count == 0 {
            of_name.first_time = time;
        }
        of_name.last_time = time;
    }
    of_name.count += 1;
    for (index, field) in message.definition.fields.iter().enumerate() {
        let value = message.number(index);
        if value.is_finite() {
            let stats = of_name.fields.entry(field.name.clone()).or_insert((value, value, 0.0, 0.0));
            *stats = (stats.0.min(value), stats.1.max(value), stats.2 + value, stats.3 + 1.0);
        }
    }
}

fn binary(path: &Path) -> (BTreeMap<String, Found>, u64) {
    let mut reader = DataflashReader::new(std::fs::File::open(path).unwrap());
    let mut found = BTreeMap::new();
    while let Some(message) = reader.next_message().unwrap() {
        add(&mut found, &message);
    }
    let damage = reader.damage();
    assert_eq!(damage.bytes, std::fs::metadata(path).unwrap().len());
    (found, damage.skipped_bytes + damage.tail_bytes)
}

fn text(path: &Path) -> (BTreeMap<String, Found>, u64) {
    let file = std::io::BufReader::new(std::fs::File::open(path).unwrap());
    let mut reader = DataflashTextReader::new(file);
    let mut found = BTreeMap::new();
    while let Some(message) = reader.next_message().unwrap() {
        add(&mut found, &message);
    }
    (found, reader.damage().lines_unknown)
}

fn near(ours: f64, theirs: &Value, scale: f64) -> bool {
    let theirs = theirs.as_f64().unwrap();
    (ours - theirs).abs() <= 1e-9 * scale.max(theirs.abs()).max(1e-6)
}

fn compare(file: &str, found: &BTreeMap<String, Found>, expected: &Value) {
    let types = expected["types"].as_object().unwrap();
    let missing: Vec<_> = types.keys().filter(|name| !found.contains_key(*name)).collect();
    assert!(missing.is_empty(), "{file}: missing {missing:?}");
    for (name, ours) in found {
        let Some(theirs) = types.get(name) else { panic!("{file}: {name} is not expected") };
        assert_eq!(ours.count, theirs["count"].as_u64().unwrap(), "{file}: {name}");
        if theirs["first_time"].is_number() {
            assert!(near(ours.first_time, &theirs["first_time"], 0.0), "{file}: {name} {ours:?} {theirs}");
            assert!(near(ours.last_time, &theirs["last_time"], 0.0), "{file}: {name} {ours:?} {theirs}");
        }
        for (field, stats) in theirs["fields"].as_object().into_iter().flatten() {
            let Some(&(least, most, sum, number)) = ours.fields.get(field) else {
                assert!(stats["min"].is_null(), "{file}: {name}.{field} {stats}");
                continue;
            };
            let scale = least.abs().max(most.abs());
            assert!(near(least, &stats["min"], scale), "{file}: {name}.{field} {least} {stats}");
            assert!(near(most, &stats["max"], scale), "{file}: {name}.{field} {most} {stats}");
            assert!(near(sum / number, &stats["mean"], scale), "{file}: {name}.{field} {stats}");
        }
    }
}

fn logs(ending: &str) -> Option<(Vec<PathBuf>, Value)> {
    let folder = support::shared()?.join("onboard/logs");
    let expected = std::fs::read_to_string(folder.join("expected.json")).unwrap();
    let mut logs: Vec<PathBuf> =
        std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    logs.retain(|path| path.extension().is_some_and(|extension| extension == ending));
    logs.sort();
    Some((logs, serde_json::from_str(&expected).unwrap()))
}

#[test]
fn every_message_of_binary_logs_is_read() {
    let Some((logs, expected)) = logs("bin") else { return };
    assert!(logs.len() > 12);
    for path in logs {
        let name = path.file_name().unwrap().to_str().unwrap();
        let (found, lost) = binary(&path);
        if name == "derived_corrupt.bin" {
            assert!((349..2000).contains(&lost), "{lost} bytes lost");
        } else {
            // the last message is cut off
            assert!(lost < 64, "{name}: {lost} bytes lost");
            compare(name, &found, &expected[name]);
        }
    }
}

#[test]
fn every_line_of_text_logs_is_read() {
    let Some((logs, expected)) = logs("log") else { return };
    assert!(logs.len() > 4);
    for path in logs {
        let name = path.file_name().unwrap().to_str().unwrap();
        let (found, unknown) = text(&path);
        compare(name, &found, &expected[name]);
        assert_eq!(unknown, expected[name]["lines_of_no_known_type"].as_u64().unwrap(), "{name}");
    }
}

/// Names of the parameters of a binary log, and its texts.
fn names_and_texts(path: &Path) -> (BTreeSet<String>, Vec<String>) {
    let mut reader = DataflashReader::new(std::fs::File::open(path).unwrap());
    let (mut names, mut texts) = (BTreeSet::new(), Vec::new());
    while let Some(message) = reader.next_message().unwrap() {
        let text =
            |field: &str| message.definition.field(field).map(|field| message.text(field).into_owned());
        match message.definition.name.as_str() {
            "PARM" => names.extend(text("Name")),
            "MSG" => texts.extend(text("Message")),
            _ => {}
        }
    }
    (names, texts)
}

#[test]
fn parameters_and_texts_are_those_of_another_reader() {
    let Some((logs, expected)) = logs("bin") else { return };
    for path in logs {
        let name = path.file_name().unwrap().to_str().unwrap();
        let expected = &expected[name];
        let (names, texts) = names_and_texts(&path);
        assert_eq!(names.len() as u64, expected["distinct_parameters"].as_u64().unwrap(), "{name}");
        let first: Vec<&str> =
            expected["first_texts"].as_array().unwrap().iter().map(|text| text.as_str().unwrap()).collect();
        assert_eq!(texts[..first.len()], first, "{name}");
        // and so in a recording, but for the simulator's truth
        let recording = log::open(&path, &OpenOptions::default()).unwrap().recording;
        let told = names.iter().filter(|name| !name.starts_with("SIM_"));
        assert!(told.eq(recording.parameters.keys()), "{name}");
        let said = recording.texts.iter().map(|(_, text)| text);
        let said: Vec<&String> = said.filter(|text| !text.starts_with("error of subsystem")).collect();
        assert!(said.into_iter().eq(&texts), "{name}");
        for (parameter, value) in expected["parameters_last_value"].as_object().unwrap() {
            assert!(near(recording.parameters[parameter], value, 0.0), "{name}: {parameter} {value}");
        }
    }
}

#[test]
fn each_log_says_what_wrote_it() {
    use VehicleKind::{Helicopter, Multirotor, Plane, Rover, Submarine};
    let Some(shared) = support::shared() else { return };
    for (name, kind, firmware) in [
        ("copter_313_2014_quad.bin", Some(Multirotor), Some("ArduCopter V3.1.3 (92cdd2a3)")),
        ("copter_33dev_2015_quad.bin", Some(Multirotor), Some("APM:Copter V3.3-dev (ed577021)")),
        ("copter_35_2017_quad.bin", Some(Multirotor), None),
        ("copter_436_octaquad.bin", Some(Multirotor), Some("ArduCopter V4.3.6 (0c5e999c)")),
        ("plane_304_tiny.bin", Some(Plane), Some("ArduPlane V3.0.4-beta3 (8d7ef5df)")),
        ("plane_382dev_piece.bin", Some(Plane), Some("ArduPlane V3.8.2-dev (8178ab40)")),
        ("plane_45dev_sitl_esc.bin", Some(Plane), Some("ArduPlane V4.5.0-dev (fa0f089f)")),
        ("rover_246_2014.bin", Some(Rover), Some("ArduRover v2.46beta2 (d01fa3bf)")),
        ("sub_410.bin", Some(Submarine), Some("ArduSub V4.1.0 (89639005)")),
        ("text_copter_301_heli_brownout.log", Some(Helicopter), Some("ArduCopter V3.0.1")),
        ("text_copter_301_octo.log", Some(Multirotor), Some("ArduCopter V3.0.1 (5c6503e2)")),
        ("all_types.bin", None, None),
    ] {
        let path = shared.join("onboard/logs").join(name);
        let report = log::open(&path, &OpenOptions::default()).unwrap().report;
        let onboard = report.onboard().unwrap();
        assert_eq!((onboard.kind, onboard.firmware.as_deref()), (kind, firmware), "{name}");
    }
    let sdlog2 = shared.join("onboard/logs/px4_sdlog2_old.px4log");
    let refused = log::open(&sdlog2, &OpenOptions::default()).unwrap_err().to_string();
    assert!(refused.contains("a PX4 log of the format before ULog"), "{refused}");
}

/// All messages of a log as they stand, and how many bytes they are and were lost.
fn messages(bytes: &[u8]) -> (Vec<&[u8]>, u64, u64) {
    let mut reader = DataflashReader::new(bytes);
    let mut found = Vec::new();
    while let Some(message) = reader.next_message().unwrap() {
        let at = usize::try_from(message.offset).unwrap();
        found.push(&bytes[at..at + message.definition.bytes]);
    }
    let damage = reader.damage();
    (found, damage.messages, damage.skipped_bytes + damage.tail_bytes)
}

/// Damage at a random place: zeros, junk put in, bytes taken out, two pieces swapped, or an end.
fn damaged(whole: &[u8], random: &mut Pcg64) -> Vec<u8> {
    let mut bytes = whole.to_vec();
    let at = random.random_range(20_000..bytes.len() - 6000);
    // without a checksum, what is overwritten within one message cannot be told
    let length = random.random_range(256..3000);
    match random.random_range(0..5) {
        0 => bytes[at..at + length].fill(0),
        1 => {
            let junk: Vec<u8> = (0..length).map(|_| random.random()).collect();
            bytes.splice(at..at, junk);
        }
        2 => {
            bytes.drain(at..at + length);
        }
        3 => bytes[at..at + 2 * length].rotate_left(length),
        _ => bytes.truncate(at),
    }
    bytes
}

#[test]
fn damaged_logs_give_nothing_that_was_not_in_them() {
    let Some(shared) = support::shared() else { return };
    let whole = std::fs::read(shared.join("onboard/logs/copter_47dev_sitl_quad.bin")).unwrap();
    let (original, count, _) = messages(&whole);
    let original: HashSet<&[u8]> = original.into_iter().collect();
    let corrupt = std::fs::read(shared.join("onboard/logs/derived_corrupt.bin")).unwrap();
    let mut random = Pcg64::seed_from_u64(23);
    // the front of a message and the back of another of its kind, joined where both are the same far: no one can tell
    let mut joined = 0;
    let copies = (0..200).map(|_| damaged(&whole, &mut random));
    for (index, bytes) in std::iter::once(corrupt).chain(copies).enumerate() {
        let (found, told, lost) = messages(&bytes);
        let wrong = found.iter().filter(|message| !original.contains(*message)).count();
        assert!(wrong <= usize::from(index > 0), "copy {index}: {wrong}");
        joined += wrong;
        assert_eq!(told, found.len() as u64);
        let read: usize = found.iter().map(|message| message.len()).sum();
        assert_eq!(read as u64 + lost, bytes.len() as u64, "copy {index}: each byte is told");
        // what was touched costs no more than it and its neighbours
        let touched = 3000 + whole.len().abs_diff(bytes.len()) as u64;
        assert!(
            told > 50 && (lost < touched + 3500),
            "copy {index}: {told} of {count} messages, {lost} bytes lost"
        );
        if index % 10 == 0 {
            let opened =
                log::open(log::Input::Bytes { name: "copy", bytes: &bytes }, &OpenOptions::default());
            let losses = opened.unwrap().report.losses;
            assert!(!losses.is_empty() || lost == 0, "copy {index}: {losses:?}");
        }
    }
    assert!(joined <= 8, "{joined}");
}

/// The value of one channel at a time, on a straight line between two samples.
fn at(stream: &Stream, channel: usize, time_s: f64) -> f64 {
    let next = stream.time_s.partition_point(|t| *t < time_s).clamp(1, stream.len() - 1);
    let (from_s, to_s) = (stream.time_s[next - 1], stream.time_s[next]);
    let share = ((time_s - from_s) / (to_s - from_s)).clamp(0.0, 1.0);
    let (a, b) = (stream.sample(next - 1)[channel], stream.sample(next)[channel]);
    a + share * (b - a)
}

/// Attitudes as the body's x and z axes in the world: a quaternion has two signs.
fn axes(quantity: Quantity, stream: Stream) -> Stream {
    if quantity != Quantity::Attitude {
        return stream;
    }
    let axes = |q: &[f64]| {
        let (w, x, y, z) = (q[0], q[1], q[2], q[3]);
        [
            1.0 - 2.0 * (y * y + z * z),
            2.0 * (x * y + w * z),
            2.0 * (x * z - w * y),
            2.0 * (x * z + w * y),
            2.0 * (y * z - w * x),
            1.0 - 2.0 * (x * x + y * y),
        ]
    };
    Stream { values: stream.values.chunks_exact(4).flat_map(axes).collect(), width: 6, time_s: stream.time_s }
}

/// Root mean square of the difference of two streams, the second `later_s` behind the first.
fn apart(ours: &Stream, theirs: &Stream, later_s: f64, every: usize) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    let (from_s, to_s) = (ours.time_s[0] + 10.0, ours.time_s[ours.len() - 1] - 5.0);
    for index in (0..ours.len()).step_by(every).filter(|index| (from_s..to_s).contains(&ours.time_s[*index]))
    {
        for channel in 0..ours.width.min(theirs.width) {
            let difference = ours.sample(index)[channel] - at(theirs, channel, ours.time_s[index] + later_s);
            sum += difference * difference;
            count += 1.0;
        }
    }
    f64::sqrt(sum / f64::max(count, 1.0))
}

#[test]
fn both_logs_of_one_flight_agree() {
    let Some(shared) = support::shared() else { return };
    for (name, slow) in [("ap01", false), ("ap05", true), ("ap07", false), ("ap11", true)] {
        let open = |ending: &str| {
            let path = shared.join(format!("onboard/sitl/{name}.{ending}"));
            log::open(&path, &OpenOptions::default()).unwrap()
        };
        let (onboard, telemetry) = (open("bin"), open("tlog"));
        assert!(onboard.report.losses.is_empty(), "{name}: {:?}", onboard.report.losses);
        let of = |opened: &'_ log::Opened, quantity, source| {
            opened.recording.streams[&StreamKey { quantity, source, instance: 0 }].clone()
        };
        let velocity = of(&onboard, Quantity::Velocity, "XKF1");
        let sent = of(&telemetry, Quantity::Velocity, "LOCAL_POSITION_NED");
        let nearest = |from: i32, step_s: f64, about_s: f64| {
            let lags = (-from..=from).map(|lag| about_s + f64::from(lag) * step_s);
            lags.min_by(|a, b| apart(&velocity, &sent, *a, 10).total_cmp(&apart(&velocity, &sent, *b, 10)))
                .unwrap()
        };
        let later_s = nearest(20, 0.01, nearest(500, 0.2, 50.0));
        for (quantity, ours, theirs, most) in [
            (Quantity::Velocity, "XKF1", "LOCAL_POSITION_NED", 0.05),
            (Quantity::Position, "XKF1", "LOCAL_POSITION_NED", 0.1),
            (Quantity::Attitude, "ATT", "ATTITUDE_QUATERNION", 0.01),
            (Quantity::AngularRate, "IMU", "RAW_IMU", 0.05),
            (Quantity::SpecificForce, "IMU", "RAW_IMU", 0.3),
            (Quantity::ActuatorCommand, "RCOU", "SERVO_OUTPUT_RAW", if slow { 12.0 } else { 8.0 }),
            (Quantity::BatteryVoltage, "BAT", "BATTERY_STATUS", 0.1),
        ] {
            let (ours, theirs) = (of(&onboard, quantity, ours), of(&telemetry, quantity, theirs));
            let far = apart(&axes(quantity, ours), &axes(quantity, theirs), later_s, 1);
            assert!(far < most, "{name}: {} {far}", quantity.name());
        }
        let force = of(&onboard, Quantity::SpecificForce, "IMU");
        let mean = force.values.iter().skip(2).step_by(3).sum::<f64>() / force.len() as f64;
        assert!((mean - 9.9).abs() < 0.3, "{name}: {mean} m/s^2 up");
        assert_eq!(onboard.recording.autopilot, telemetry.recording.autopilot);
        for parameter in ["MOT_THST_EXPO", "FRAME_CLASS", "SERVO1_FUNCTION"] {
            assert_eq!(onboard.recording.parameters[parameter], telemetry.recording.parameters[parameter]);
        }
    }
}

#[test]
fn mapped_streams_hold_every_sample_in_its_range() {
    let mut compared = 0;
    for ending in ["bin", "log"] {
        let Some((logs, expected)) = logs(ending) else { return };
        for path in logs {
            let name = path.file_name().unwrap().to_str().unwrap();
            let log::Opened { recording, report } = log::open(&path, &OpenOptions::default()).unwrap();
            for (message, quantity, field, channel, sign) in [
                ("IMU", Quantity::AngularRate, "GyrX", 0, 1.0),
                ("IMU", Quantity::AngularRate, "GyrY", 1, -1.0),
                ("IMU", Quantity::SpecificForce, "", 0, 1.0),
                ("IMU2", Quantity::AngularRate, "GyrZ", 2, -1.0),
                ("ATT", Quantity::Attitude, "", 0, 1.0),
                ("XKF1", Quantity::Velocity, "", 0, 1.0),
                ("NKF1", Quantity::Position, "", 0, 1.0),
                ("RCOU", Quantity::ActuatorCommand, "C1", 0, 1.0),
                ("RCOU", Quantity::ActuatorCommand, "C2", 1, 1.0),
                ("BARO", Quantity::BarometricHeight, "Alt", 0, 1.0),
                ("BAT", Quantity::BatteryVoltage, "Volt", 0, 1.0),
            ] {
                let of = |key: &&StreamKey| key.quantity == quantity && key.source == message;
                let keys: Vec<&StreamKey> = recording.streams.keys().filter(of).collect();
                let theirs = &expected[name]["types"][message];
                if keys.is_empty() || name == "derived_corrupt.bin" {
                    continue;
                }
                let streams = || keys.iter().map(|key| &recording.streams[*key]);
                let doubled: u64 = keys.iter().map(|key| report.streams[*key].duplicates).sum();
                let count = streams().map(|stream| stream.len() as u64).sum::<u64>() + doubled;
                assert_eq!(count, theirs["count"].as_u64().unwrap(), "{name}: {message}");
                compared += 1;
                if theirs["fields"][field]["min"].is_null() {
                    continue;
                }
                let values =
                    streams().flat_map(|stream| stream.values.iter().skip(channel).step_by(stream.width));
                let (least, most) = values
                    .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), value| {
                        (least.min(sign * value), most.max(sign * value))
                    });
                let bounds = &theirs["fields"][field];
                assert!(
                    near(least, &bounds["min"], most.abs()),
                    "{name}: {message}.{field} {least} {bounds}"
                );
                assert!(near(most, &bounds["max"], least.abs()), "{name}: {message}.{field} {most} {bounds}");
            }
        }
    }
    assert!(compared > 60, "{compared}");
}
