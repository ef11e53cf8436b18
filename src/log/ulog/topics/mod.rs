//! What PX4's topics mean: a table of streams, from the names of today back to those of 2016.

mod actuators;
mod motion;
mod row;
mod setpoints;
mod states;
mod turns;

pub(super) use row::Bound;

use super::schema::Subscription;
use row::Row;

/// All streams that are read.
const ROWS: [&[Row]; 4] = [motion::ROWS, actuators::ROWS, setpoints::ROWS, states::ROWS];

/// The streams that a topic's messages hold.
pub(super) fn streams_of(subscription: &Subscription) -> Vec<Bound> {
    let Subscription { topic, instance, layout, .. } = subscription;
    ROWS.iter().copied().flatten().filter_map(|row| row.bind(topic, *instance, layout)).collect()
}

/// Whether streams are read from a topic of this name.
pub(super) fn is_read(topic: &str) -> bool {
    ROWS.iter().copied().flatten().any(|row| row.is_of(topic))
}
