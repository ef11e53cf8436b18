//! PX4's own logs among the other formats.

use super::craft::Craft;
use super::decode::Decoder;
use super::reader::UlogReader;
use super::report::{TopicCount, UlogReport};
use super::topics::is_read;
use super::whole::Whole;
use crate::autopilot::{Autopilot, ULOG_MAGIC};
use crate::log::error::LogError;
use crate::log::format::{Certainty, Format, Place, Sink};
use crate::log::input::Input;
use crate::log::loss::Oddity;
use crate::log::onboard::{OnboardReport, Topic};
use crate::log::options::OpenOptions;
use crate::log::report::{Details, ReadReport};
use crate::recording::{Event, RecordingBuilder};
use crate::units::seconds_from_us;

/// PX4's own logs.
pub(in crate::log) const FORMAT: Format = Format {
    name: "PX4 log (.ulg)",
    ending: "ulg",
    takes_system: false,
    takes_columns: false,
    sniff,
    read,
    read_whole: Some(read_whole),
};

fn sniff(head: &[u8]) -> Option<Certainty> {
    head.starts_with(&ULOG_MAGIC).then_some(Certainty::Certain)
}

fn read(input: &Input<'_>, _: &OpenOptions, sink: &mut Sink<'_>) -> Result<ReadReport, LogError> {
    let mut reader = UlogReader::new(input.open()?);
    let mut decoder = Decoder::default();
    let mut craft = Craft::default();
    let mut autopilot = Autopilot::Unknown;
    while let Some(entry) = reader.next_message()? {
        let place = Place { offset: entry.offset, arrival_us: None };
        craft.take(&entry.message);
        decoder.decode(entry.message, &mut |event| {
            if let Event::Autopilot(told) = event {
                autopilot = told;
            }
            sink(place, event);
        });
    }
    let at_end = Place { offset: reader.report().bytes, arrival_us: None };
    decoder.finish(&mut |event| sink(at_end, event));
    Ok(read_report(reader.into_report(), &decoder, &craft, autopilot))
}

fn read_whole(
    input: &Input<'_>,
    _: &OpenOptions,
    builder: &mut RecordingBuilder,
) -> Result<ReadReport, LogError> {
    // on a thread of the pool: it takes its part of every run
    rayon::scope(|_| {
        let mut reader = UlogReader::whole(input.open()?);
        let mut decoder = Decoder::default();
        let mut craft = Craft::default();
        let mut autopilot = Autopilot::Unknown;
        let mut whole = Whole::default();
        loop {
            whole.decode(&mut reader, &mut decoder, builder)?;
            let Some(entry) = reader.next_message()? else { break };
            craft.take(&entry.message);
            decoder.decode(entry.message, &mut |event| {
                if let Event::Autopilot(told) = event {
                    autopilot = told;
                }
                builder.add(event);
            });
        }
        decoder.finish(&mut |event| builder.add(event));
        Ok(read_report(reader.into_report(), &decoder, &craft, autopilot))
    })
}

/// What was met while reading.
fn read_report(report: UlogReport, decoder: &Decoder, craft: &Craft, autopilot: Autopilot) -> ReadReport {
    let stale = decoder.report().stale_stamps;
    let (count, most_us) = decoder.report().ran_back;
    let mut oddities = report.oddities();
    oddities.extend((count > 0).then_some(Oddity::VehicleClockBack { count, most_us }));
    let onboard = OnboardReport {
        bytes: report.bytes,
        messages: report.messages,
        kind: craft.kind(),
        firmware: craft.firmware(),
        start_utc_us: decoder.date.began_us(),
        topics: topics(&report),
    };
    ReadReport {
        format: FORMAT.name,
        vehicle: craft.vehicle(autopilot),
        losses: report.losses(stale),
        oddities,
        details: Details::Onboard(Box::new(onboard)),
        ..ReadReport::default()
    }
}

/// Each topic that has messages, by name.
fn topics(report: &UlogReport) -> Vec<Topic> {
    let seconds = |stamp_us: u64| seconds_from_us(stamp_us as f64);
    let topic = |topic: &TopicCount| Topic {
        name: topic.topic.to_string(),
        instance: topic.instance,
        count: topic.count,
        span_s: topic.stamps_us.map(|(first, last)| (seconds(first), seconds(last))),
        pauses: topic.paused_us.0,
        paused_s: seconds(topic.paused_us.1),
        is_used: is_read(&topic.topic),
        is_known: is_read(&topic.topic),
    };
    let mut topics: Vec<Topic> = report.topics.iter().filter(|topic| topic.count > 0).map(topic).collect();
    topics.sort_by(|a, b| (&a.name, a.instance).cmp(&(&b.name, b.instance)));
    topics
}
