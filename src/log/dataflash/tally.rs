//! How many messages of which name there are.

use std::collections::BTreeMap;

use super::known::is_known;
use super::message::Message;
use super::routes::Routes;
use crate::log::onboard::{Topic, is_pause};

/// How many messages of which name there are.
#[derive(Debug, Default)]
pub(super) struct Tally {
    names: BTreeMap<(String, u8), usize>,
    counts: Vec<Count>,
    /// samples that are left out because their messages carry no time
    pub without_time: u64,
    /// commands of the motors are among them
    pub outputs_without_time: bool,
    /// samples that are left out because the log does not say in which unit they are
    pub unknown_unit: u64,
}

#[derive(Debug, Default)]
struct Count {
    count: u64,
    span_s: Option<(f64, f64)>,
    pauses: u64,
    paused_s: f64,
    is_used: bool,
}

impl Tally {
    /// Counts a message of an instance, written at `stamp_s` of the vehicle's clock.
    pub(super) fn count(
        &mut self,
        message: &Message<'_>,
        instance: u8,
        stamp_s: Option<f64>,
        routes: &mut Routes,
    ) {
        let known = routes.tallies.iter().find(|(known, _)| *known == instance).map(|(_, at)| *at);
        let at = known.unwrap_or_else(|| {
            let next = self.counts.len();
            let at = *self.names.entry((message.definition.name.clone(), instance)).or_insert(next);
            if at == next {
                self.counts.push(Count::default());
            }
            self.counts[at].is_used |= routes.special.is_some() || routes.gives_samples();
            routes.tallies.push((instance, at));
            at
        });
        let count = &mut self.counts[at];
        if let Some(stamp_s) = stamp_s {
            let (from_s, to_s) = count.span_s.unwrap_or((stamp_s, stamp_s));
            let step_s = stamp_s - to_s;
            if is_pause(step_s, to_s - from_s - count.paused_s, count.count) {
                count.pauses += 1;
                count.paused_s += step_s;
            }
            count.span_s = Some((from_s.min(stamp_s), to_s.max(stamp_s)));
        }
        count.count += 1;
    }

    /// By name.
    pub(super) fn topics(self) -> Vec<Topic> {
        let topic = |((name, instance), at): ((String, u8), usize)| {
            let Count { count, span_s, pauses, paused_s, is_used } = self.counts[at];
            let is_known = is_used || is_known(&name);
            Topic { name, instance, count, span_s, pauses, paused_s, is_used, is_known }
        };
        self.names.into_iter().map(topic).collect()
    }
}
