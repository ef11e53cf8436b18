//! Reads PX4's own logs and holds them to what another reader finds in them.

#![allow(clippy::unwrap_used)]

mod support;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use mavid::autopilot::VehicleKind;
use mavid::log::ulog::{Message, UlogReader, UlogReport};
use mavid::log::{self, Input, LogError, Loss, OpenOptions, Opened};
use mavid::recording::{Quantity, Stream, StreamKey};
use serde_json::Value;

/// What the values of one field are.
#[derive(Debug, Default)]
struct Tally {
    count: u64,
    sum: f64,
    min: f64,
    max: f64,
    not_finite: u64,
}

impl Tally {
    fn add(&mut self, value: f64) {
        if !value.is_finite() {
            self.not_finite += 1;
            return;
        }
        (self.min, self.max) =
            if self.count == 0 { (value, value) } else { (self.min.min(value), self.max.max(value)) };
        self.count += 1;
        self.sum += value;
    }
}

/// What a file holds, by the reader beneath all.
#[derive(Debug, Default)]
struct Raw {
    report: UlogReport,
    /// by `topic[instance]`: field and its values
    fields: BTreeMap<String, Vec<(String, Tally)>>,
    parameters: usize,
    texts: usize,
    start_us: u64,
}

fn raw(bytes: &[u8]) -> Raw {
    let mut raw = Raw::default();
    let mut reader = UlogReader::new(bytes);
    while let Some(entry) = reader.next_message().unwrap() {
        match entry.message {
            Message::Begin { start_us } => raw.start_us = start_us,
            Message::Parameter { .. } => raw.parameters += 1,
            Message::Text { .. } => raw.texts += 1,
            Message::Data { subscription, bytes } => {
                let key = format!("{}[{}]", subscription.topic, subscription.instance);
                let fields = raw.fields.entry(key).or_insert_with(|| {
                    let paths = subscription.layout.paths().filter(|path| path != "timestamp");
                    paths.map(|path| (path, Tally::default())).collect()
                });
                for (path, tally) in fields {
                    tally.add(subscription.layout.cell(path).unwrap().read(bytes));
                }
            }
            _ => {}
        }
    }
    raw.report = reader.into_report();
    raw
}

fn logs() -> Option<PathBuf> {
    support::shared().map(|shared| shared.join("onboard/logs"))
}

/// Each log and what is expected of it.
fn expected(folder: &Path) -> Vec<(String, Value)> {
    let text = std::fs::read_to_string(folder.join("expected.json")).unwrap();
    let all: BTreeMap<String, Value> = serde_json::from_str(&text).unwrap();
    all.into_iter().filter(|(name, _)| name.ends_with(".ulg")).collect()
}

fn close(found: f64, expected: f64, scale: f64) -> bool {
    (found - expected).abs() <= 1e-6 * scale.max(expected.abs()).max(1e-9)
}

#[test]
fn topics_counts_stamps_and_values_are_those_of_another_reader() {
    let Some(folder) = logs() else { return };
    let all = expected(&folder);
    assert!(all.len() >= 12);
    for (name, expected) in all.iter().filter(|(name, _)| name != "derived_corrupt.ulg") {
        let raw = raw(&std::fs::read(folder.join(name)).unwrap());
        assert_eq!(raw.start_us, expected["start_us"].as_u64().unwrap(), "{name}");
        let topics = expected["topics"].as_object().unwrap();
        let found: BTreeMap<String, (u64, Option<(u64, u64)>)> = raw
            .report
            .topics
            .iter()
            .filter(|topic| topic.count > 0)
            .map(|topic| (format!("{}[{}]", topic.topic, topic.instance), (topic.count, topic.stamps_us)))
            .collect();
        assert_eq!(found.keys().collect::<Vec<_>>(), topics.keys().collect::<Vec<_>>(), "{name}");
        for (key, topic) in topics {
            let (count, stamps_us) = found[key];
            let stamps = (topic["first_us"].as_u64().unwrap(), topic["last_us"].as_u64().unwrap());
            assert_eq!((count, stamps_us), (topic["count"].as_u64().unwrap(), Some(stamps)), "{name} {key}");
            for (field, values) in topic["fields"].as_object().unwrap() {
                let Some((_, tally)) = raw.fields[key].iter().find(|(path, _)| path == field) else {
                    assert!(field.contains("_padding"), "{name} {key}.{field}");
                    continue;
                };
                let number = |name: &str| values[name].as_f64();
                assert_eq!(
                    tally.not_finite,
                    values["not_finite"].as_u64().unwrap_or(0),
                    "{name} {key}.{field}"
                );
                let (Some(min), Some(max), Some(mean)) = (number("min"), number("max"), number("mean"))
                else {
                    assert_eq!(tally.count, 0, "{name} {key}.{field}");
                    continue;
                };
                let scale = max.abs().max(min.abs());
                let found = [(tally.min, min), (tally.max, max), (tally.sum / tally.count as f64, mean)];
                assert!(
                    found.iter().all(|(found, expected)| close(*found, *expected, scale)),
                    "{name} {key}.{field}: {tally:?}, expected {values}"
                );
            }
        }
    }
}

#[test]
fn parameters_texts_and_dropouts_are_those_of_another_reader() {
    let Some(folder) = logs() else { return };
    for (name, expected) in expected(&folder) {
        let raw = raw(&std::fs::read(folder.join(&name)).unwrap());
        let number = |key: &str| expected[key].as_u64().unwrap();
        let length = |key: &str| expected[key].as_array().unwrap().len() as u64;
        let parameters = number("initial_parameters") + number("changed_parameters");
        assert_eq!(raw.parameters as u64, parameters, "{name}");
        assert_eq!(raw.texts as u64, number("logged_messages") + number("tagged_messages"), "{name}");
        assert_eq!(raw.report.dropouts, length("dropouts"), "{name}");
    }
}
