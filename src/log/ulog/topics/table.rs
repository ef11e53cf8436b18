//! All streams, and those of one topic.

use super::row::{Bound, Row};
use super::{actuators, motion, setpoints, states};
use crate::log::ulog::schema::Subscription;

/// All streams that are read.
const ROWS: [&[Row]; 4] = [motion::ROWS, actuators::ROWS, setpoints::ROWS, states::ROWS];

fn rows() -> impl Iterator<Item = &'static Row> {
    ROWS.iter().copied().flatten()
}

/// The streams that a topic's messages hold.
pub(in crate::log::ulog) fn streams_of(subscription: &Subscription) -> Vec<Bound> {
    let Subscription { topic, instance, layout, .. } = subscription;
    rows().filter_map(|row| row.bind(topic, *instance, layout)).collect()
}

/// Whether streams are read from a topic of this name.
pub(in crate::log::ulog) fn is_read(topic: &str) -> bool {
    rows().any(|row| row.is_of(topic))
}
