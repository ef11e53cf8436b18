//! Armed, in the air, modes: from state messages to spans.

use super::inspection::{ModeChange, Timeline};
use crate::autopilot::Autopilot;
use crate::recording::Quantity;
use crate::recording::landed::ON_GROUND;
use crate::units::whole_unsigned;

/// Entries kept of each list; a log with more is counted.
const KEPT: usize = 1000;

/// Collects spans.
#[derive(Debug, Clone, Default)]
pub(super) struct TimelineTally {
    armed: Spans,
    in_air: Spans,
    modes: Vec<(f64, f64)>,
    dropped: u64,
    /// whether it was ever armed, where it tells
    armed_ever: Option<bool>,
}

/// Spans in which a state holds.
#[derive(Debug, Clone, Default)]
struct Spans {
    closed: Vec<(f64, f64)>,
    open: Option<(f64, f64)>,
    dropped: u64,
}

impl Spans {
    fn say(&mut self, time_s: f64, holds: bool) {
        match (&mut self.open, holds) {
            (None, true) => self.open = Some((time_s, time_s)),
            (Some(open), true) => open.1 = open.1.max(time_s),
            (Some((start, _)), false) => {
                let span = (*start, time_s);
                self.open = None;
                self.close(span);
            }
            (None, false) => {}
        }
    }

    fn close(&mut self, span: (f64, f64)) {
        if self.closed.len() < KEPT { self.closed.push(span) } else { self.dropped += 1 }
    }

    fn finish(mut self) -> (Vec<(f64, f64)>, u64) {
        if let Some(span) = self.open.take() {
            self.close(span);
        }
        (self.closed, self.dropped)
    }
}

impl TimelineTally {
    /// Takes a sample of a state stream; others say nothing here.
    pub(super) fn add(&mut self, quantity: Quantity, time_s: f64, values: &[f64]) {
        let Some(&value) = values.first() else { return };
        match quantity {
            Quantity::Armed => {
                self.armed_ever = Some(self.armed_ever.unwrap_or(false) || value > 0.5);
                self.armed.say(time_s, value > 0.5);
            }
            Quantity::LandedState => self.in_air.say(time_s, value > ON_GROUND),
            Quantity::Mode if self.modes.last().is_none_or(|(_, last)| last.to_bits() != value.to_bits()) => {
                if self.modes.len() < KEPT {
                    self.modes.push((time_s, value));
                } else {
                    self.dropped += 1;
                }
            }
            _ => {}
        }
    }

    /// The vehicle restarted: no span goes across.
    pub(super) fn reset(&mut self, time_s: f64) {
        self.armed.say(time_s, false);
        self.in_air.say(time_s, false);
    }

    /// Whether it was ever armed; `None` where it does not tell.
    pub(super) fn armed_ever(&self) -> Option<bool> {
        self.armed_ever
    }

    /// Time in the air by the autopilot's own words, s.
    pub(super) fn said_in_air_s(&self) -> f64 {
        self.in_air.closed.iter().chain(&self.in_air.open).map(|(from_s, to_s)| to_s - from_s).sum()
    }

    /// What was collected.
    pub(super) fn summary(self, autopilot: Autopilot) -> Timeline {
        let (armed_s, armed_dropped) = self.armed.finish();
        let (in_air_s, in_air_dropped) = self.in_air.finish();
        let named = |(time_s, number)| ModeChange { time_s, number, name: mode_name(autopilot, number) };
        Timeline {
            armed_s,
            in_air_s,
            modes: self.modes.into_iter().map(named).collect(),
            dropped: self.dropped + armed_dropped + in_air_dropped,
        }
    }
}

fn mode_name(autopilot: Autopilot, number: f64) -> Option<&'static str> {
    let stack = autopilot.stack()?;
    let number = number.is_finite().then(|| whole_unsigned(number))?;
    // a sub mode that is not known has its main mode's name
    let (main, _) = stack.numbering.parts(number);
    let mode = stack.mode(number).or_else(|| stack.mode(stack.numbering.number(main, 0)))?;
    Some(mode.name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spans_open_and_close_and_modes_are_named() {
        let mut tally = TimelineTally::default();
        for (time_s, state) in [(0.0, 1.0), (1.0, 3.0), (2.0, 2.0), (3.0, 4.0), (4.0, 1.0), (5.0, 2.0)] {
            tally.add(Quantity::LandedState, time_s, &[state]);
        }
        tally.add(Quantity::Mode, 0.0, &[f64::from(6 << 16)]);
        tally.add(Quantity::Mode, 1.0, &[f64::from(6 << 16)]);
        tally.add(Quantity::Armed, 0.5, &[1.0]);
        tally.reset(6.0);
        let timeline = tally.summary(Autopilot::Px4);
        assert_eq!(timeline.in_air_s, [(1.0, 4.0), (5.0, 6.0)]);
        assert_eq!(timeline.armed_s, [(0.5, 6.0)]);
        assert_eq!(timeline.modes.len(), 1);
        assert_eq!(timeline.modes[0].name, Some("OFFBOARD"));
    }

    #[test]
    fn a_flood_of_changes_is_counted_not_kept() {
        let mut tally = TimelineTally::default();
        for index in 0..5000_u32 {
            tally.add(Quantity::Armed, f64::from(index), &[f64::from(index % 2)]);
        }
        let timeline = tally.summary(Autopilot::Unknown);
        assert_eq!((timeline.armed_s.len(), timeline.dropped), (KEPT, 1500));
    }
}
