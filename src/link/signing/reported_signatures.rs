//! What is told of signatures, once for each sender.

use std::collections::BTreeSet;

use super::clock::{SECOND, STALE};
use super::distrust::Distrust;
use super::signer::Signing;
use crate::link::event::LinkEvent;
use crate::wire::{ComponentId, Frame, SystemId};

/// Senders and reasons that are told; further ones are only counted, so that noise does not flood who listens.
const MOST_REPORTED: usize = 32;

/// What is told of a sender, apart from the figures in it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Topic {
    Trusted,
    Unchecked,
    Unsigned,
    Downgraded,
    Wrong,
    Replayed,
    Old,
}

/// Remembers what was told.
#[derive(Debug, Default)]
pub(in crate::link) struct ReportedSignatures {
    reported: BTreeSet<(SystemId, ComponentId, Topic)>,
    clock: bool,
}

impl ReportedSignatures {
    /// What is to be told of a frame's signature, the first time that it is so.
    pub fn events(
        &mut self,
        frame: &Frame<'_>,
        signing: Option<&Signing>,
        verdict: Result<(), Distrust>,
    ) -> Vec<LinkEvent> {
        let header = frame.header();
        let (system, component) = (header.system, header.component);
        let mut events = Vec::new();
        match (signing, verdict) {
            (_, Err(why)) if self.is_new(frame, topic(why)) => {
                events.push(LinkEvent::Distrusted { system, component, why });
            }
            (Some(signing), Ok(())) if header.is_signed() => {
                if self.is_new(frame, Topic::Trusted) {
                    events.push(LinkEvent::Trusted { system, component });
                }
                let ahead_s = signing.ahead_s();
                if ahead_s > STALE / SECOND && !std::mem::replace(&mut self.clock, true) {
                    events.push(LinkEvent::ClockBehind { seconds: ahead_s });
                }
            }
            (None, Ok(())) if header.is_signed() && self.is_new(frame, Topic::Unchecked) => {
                events.push(LinkEvent::Unchecked { system, component });
            }
            _ => {}
        }
        events
    }

    fn is_new(&mut self, frame: &Frame<'_>, topic: Topic) -> bool {
        let header = frame.header();
        self.reported.len() < MOST_REPORTED && self.reported.insert((header.system, header.component, topic))
    }
}

fn topic(why: Distrust) -> Topic {
    match why {
        Distrust::Unsigned => Topic::Unsigned,
        Distrust::Downgraded => Topic::Downgraded,
        Distrust::Wrong => Topic::Wrong,
        Distrust::Replayed => Topic::Replayed,
        Distrust::Old { .. } => Topic::Old,
    }
}
