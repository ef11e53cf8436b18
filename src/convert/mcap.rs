//! Series as MCAP: JSON messages, with Foxglove's well-known schemas where there is one.

use std::collections::BTreeMap;
use std::io::Cursor;

use super::series::TimeSeries;
use crate::text;
use mcap::records::MessageHeader;
use mcap::{WriteOptions, Writer};
use serde_json::{Value, json};

/// Why there is no file.
#[derive(Debug, thiserror::Error)]
pub enum ConvertError {
    /// the format refuses something
    #[error("MCAP: {0}")]
    Mcap(#[from] mcap::McapError),
    /// a value has no form in JSON
    #[error("MCAP: {0}")]
    Json(#[from] serde_json::Error),
}

/// Name of the schema of a pose, and what of it is filled in.
const POSE: &str = "foxglove.PoseInFrame";
/// Name of the schema of a line of a log.
const LOG: &str = "foxglove.Log";
/// World and body frame.
const WORLD: &str = "world";

/// All series and texts as one file. Times count from `start_ns`, nanoseconds since 1970 UTC.
///
/// # Errors
/// [`ConvertError`].
pub fn to_mcap(all: &[TimeSeries], texts: &[(f64, String)], start_ns: u64) -> Result<Vec<u8>, ConvertError> {
    let options = WriteOptions::new().compression(None).library(crate::fleet::program());
    let mut file = File { writer: options.create(Cursor::new(Vec::new()))?, start_ns, sequence: 0 };
    for series in all {
        file.series(series)?;
    }
    file.poses(all)?;
    let lines: Vec<(f64, Value)> = texts
        .iter()
        .map(|(time_s, said)| {
            (
                *time_s,
                json!({ "timestamp": file.stamp(*time_s), "level": 2, "message": said, "name": "vehicle" }),
            )
        })
        .collect();
    file.write("/log", (LOG, &log_schema()), &lines)?;
    file.writer.finish()?;
    Ok(file.writer.into_inner().into_inner())
}

struct File {
    writer: Writer<Cursor<Vec<u8>>>,
    start_ns: u64,
    sequence: u32,
}

impl File {
    fn nanoseconds(&self, time_s: f64) -> u64 {
        let since = std::time::Duration::try_from_secs_f64(time_s.max(0.0)).unwrap_or_default();
        self.start_ns.saturating_add(u64::try_from(since.as_nanos()).unwrap_or(u64::MAX))
    }

    /// As Foxglove's schemas have it.
    fn stamp(&self, time_s: f64) -> Value {
        let all = self.nanoseconds(time_s);
        json!({ "sec": all / 1_000_000_000, "nsec": all % 1_000_000_000 })
    }

    fn series(&mut self, series: &TimeSeries) -> Result<(), ConvertError> {
        let schema = values_schema(series);
        let message = |index: usize| {
            let values = series.columns.iter().zip(series.sample(index));
            let mut object: serde_json::Map<String, Value> =
                values.map(|(name, value)| (name.clone(), json!(value))).collect();
            object.insert("timestamp".to_owned(), self.stamp(series.time_s[index]));
            (series.time_s[index], Value::Object(object))
        };
        let messages: Vec<(f64, Value)> = (0..series.time_s.len()).map(message).collect();
        let topic = format!("/{}", series.name.replace(' ', "_"));
        let name = format!("mavid.{}", series.file_name());
        self.write(&topic, (&name, &schema), &messages)
    }

    /// Where the vehicle is and how it is turned, at the stamps of its attitude.
    fn poses(&mut self, all: &[TimeSeries]) -> Result<(), ConvertError> {
        let of = |quantity: &str| {
            let found = all.iter().filter(|series| series.name.split('/').next() == Some(quantity));
            found.max_by_key(|series| series.time_s.len())
        };
        let (Some(attitude), Some(position)) = (of("attitude"), of("position")) else { return Ok(()) };
        let mut poses = Vec::new();
        for (index, time_s) in attitude.time_s.iter().enumerate() {
            let before = position.time_s.partition_point(|stamp_s| stamp_s <= time_s);
            let (&[w, x, y, z], Some(&[px, py, pz])) =
                (attitude.sample(index), before.checked_sub(1).map(|place| position.sample(place)))
            else {
                continue;
            };
            let pose = json!({
                "timestamp": self.stamp(*time_s),
                "frame_id": WORLD,
                "pose": {
                    "position": { "x": px, "y": py, "z": pz },
                    "orientation": { "x": x, "y": y, "z": z, "w": w },
                },
            });
            poses.push((*time_s, pose));
        }
        self.write("/pose", (POSE, &pose_schema()), &poses)
    }

    fn write(
        &mut self,
        topic: &str,
        (name, schema): (&str, &Value),
        messages: &[(f64, Value)],
    ) -> Result<(), ConvertError> {
        if messages.is_empty() {
            return Ok(());
        }
        let schema = self.writer.add_schema(name, "jsonschema", text::json_line(schema)?.as_bytes())?;
        let channel = self.writer.add_channel(schema, topic, "json", &BTreeMap::new())?;
        for (time_s, message) in messages {
            let at = self.nanoseconds(*time_s);
            let header = MessageHeader {
                channel_id: channel,
                sequence: self.sequence,
                log_time: at,
                publish_time: at,
            };
            self.sequence = self.sequence.wrapping_add(1);
            self.writer.write_to_known_channel(&header, text::json_line(message)?.as_bytes())?;
        }
        Ok(())
    }
}

fn time_schema() -> Value {
    json!({ "type": "object", "title": "time", "properties": {
        "sec": { "type": "integer", "minimum": 0 }, "nsec": { "type": "integer", "minimum": 0, "maximum": 999_999_999 },
    } })
}

fn values_schema(series: &TimeSeries) -> Value {
    let described = |name: &String| (name.clone(), json!({ "type": "number", "description": series.unit }));
    let mut properties: serde_json::Map<String, Value> = series.columns.iter().map(described).collect();
    properties.insert("timestamp".to_owned(), time_schema());
    json!({ "type": "object", "title": format!("mavid.{}", series.file_name()), "properties": properties })
}

fn pose_schema() -> Value {
    let of = |names: &[&str]| {
        let each = names.iter().map(|name| ((*name).to_owned(), json!({ "type": "number" })));
        json!({ "type": "object", "properties": each.collect::<serde_json::Map<_, _>>() })
    };
    json!({ "type": "object", "title": POSE, "properties": {
        "timestamp": time_schema(),
        "frame_id": { "type": "string" },
        "pose": { "type": "object", "title": "foxglove.Pose", "properties": {
            "position": of(&["x", "y", "z"]), "orientation": of(&["x", "y", "z", "w"]),
        } },
    } })
}

fn log_schema() -> Value {
    json!({ "type": "object", "title": LOG, "properties": {
        "timestamp": time_schema(),
        "level": { "type": "integer" },
        "message": { "type": "string" },
        "name": { "type": "string" },
    } })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_reads_back_with_every_sample() {
        let series = |name: &str, columns: &[&str]| TimeSeries {
            name: name.to_owned(),
            columns: columns.iter().map(|column| (*column).to_owned()).collect(),
            unit: "",
            time_s: vec![0.0, 0.25],
            values: vec![1.0; 2 * columns.len()],
        };
        let all = [series("attitude/A", &["w", "x", "y", "z"]), series("position/P", &["x", "y", "z"])];
        let bytes = to_mcap(&all, &[(0.1, "armed".to_owned())], 1_700_000_000_000_000_000).unwrap();
        let messages: Vec<mcap::Message<'_>> =
            mcap::MessageStream::new(&bytes).unwrap().collect::<Result<_, _>>().unwrap();
        let of = |topic: &str| {
            messages.iter().filter(|message| message.channel.topic == topic).collect::<Vec<_>>()
        };
        assert_eq!((of("/attitude/A").len(), of("/pose").len(), of("/log").len()), (2, 2, 1));
        assert_eq!(of("/pose")[1].log_time, 1_700_000_000_250_000_000);
        assert_eq!(of("/pose")[0].channel.schema.as_ref().unwrap().name, "foxglove.PoseInFrame");
        let pose: Value = serde_json::from_slice(&of("/pose")[0].data).unwrap();
        assert_eq!(pose["pose"]["orientation"]["w"], 1.0);
    }
}
