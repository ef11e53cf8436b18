//! What is told of a log that the vehicle wrote itself.

use serde::Serialize;

use crate::log::{OnboardReport, ReadReport, Topic};

/// What was met in a log that the vehicle wrote itself.
#[derive(Debug, Clone, PartialEq, Serialize, Default)]
pub struct OnboardReading {
    /// which format
    pub name: &'static str,
    /// bytes read
    pub bytes: u64,
    /// messages read
    pub messages: u64,
    /// what is odd about it, in words; nothing is lost by it
    pub oddities: Vec<String>,
    /// each kind of message
    pub topics: Vec<TopicSummary>,
}

/// The messages of one name and instance.
#[derive(Debug, Clone, PartialEq, Serialize, Default)]
pub struct TopicSummary {
    /// as the log calls them
    pub name: String,
    /// 0 where there is one
    pub instance: u8,
    /// how many
    pub count: u64,
    /// messages a second; none below ten, within a tenth of a second, or without stamps
    pub rate_hz: Option<f64>,
    /// samples come from them
    pub is_used: bool,
    /// their meaning is known, used or not
    pub is_known: bool,
}

/// The report of a log that the vehicle wrote itself.
pub(super) fn onboard_reading(report: &ReadReport, onboard: &OnboardReport) -> OnboardReading {
    let summary = |topic: &Topic| TopicSummary {
        name: topic.name.clone(),
        instance: topic.instance,
        count: topic.count,
        rate_hz: topic.rate_hz(),
        is_used: topic.is_used,
        is_known: topic.is_known,
    };
    OnboardReading {
        name: report.format,
        bytes: onboard.bytes,
        messages: onboard.messages,
        oddities: report.oddities.iter().map(ToString::to_string).collect(),
        topics: onboard.topics.iter().map(summary).collect(),
    }
}
