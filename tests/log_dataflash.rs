//! ArduPilot's logs of many vehicles and years, held to what an independent reader finds in them.

#![allow(clippy::unwrap_used)]

mod support;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use mavid::log::{DataflashReader, DataflashTextReader, Message};
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
