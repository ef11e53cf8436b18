//! Counters by which the estimator says that its state jumped.

use super::schema::{Cell, Subscription};

/// Counters of a topic.
const COUNTERS: &[(&str, &[&str])] = &[(
    "vehicle_local_position",
    &["xy_reset_counter", "z_reset_counter", "vxy_reset_counter", "vz_reset_counter"],
)];

/// The counters of one topic, and what they showed last.
#[derive(Debug, Default)]
pub(super) struct ResetCounters {
    cells: Vec<(Cell, Option<f64>)>,
}

impl ResetCounters {
    /// Those that a topic has; none of most.
    pub(super) fn of(subscription: &Subscription) -> Self {
        let known = COUNTERS.iter().find(|(topic, _)| *topic == &*subscription.topic);
        let fields = known.map_or(&[][..], |(_, fields)| fields);
        let cells = fields.iter().filter_map(|field| subscription.layout.cell(field));
        Self { cells: cells.map(|cell| (cell, None)).collect() }
    }

    /// Whether a counter changed since the last message.
    #[inline]
    pub(super) fn jumped(&mut self, message: &[u8]) -> bool {
        let mut jumped = false;
        for (cell, last) in &mut self.cells {
            let now = cell.read(message);
            jumped |= last.replace(now).is_some_and(|last| last != now);
        }
        jumped
    }

    /// The vehicle started anew: its counters did so too.
    pub(super) fn forget(&mut self) {
        self.cells.iter_mut().for_each(|(_, last)| *last = None);
    }
}
