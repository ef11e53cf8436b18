//! One step of a flight: what happened, then the safety rules, then the phase.

use crate::wire::heartbeat::HEARTBEAT_PERIOD;
use std::time::Duration;

use super::action::Action;
use super::event::{Event, Key};
use super::phase::Phase;
use super::state::Flight;
use crate::fly::outcome::{Cause, Level};
use crate::fly::safety::Doubted;
use crate::fly::target::heartbeat;

impl Flight {
    /// Takes an event at `now` and continues.
    pub fn handle(&mut self, now: Duration, event: Event<'_>) {
        if matches!(self.phase, Phase::Done) {
            return;
        }
        self.note_time(now);
        // an order of the operator is no look at the vehicle
        if matches!(event, Event::Tick | Event::Frame(_)) {
            self.guide.issued = now;
        }
        match event {
            Event::Frame(frame) => self.hear(now, frame),
            Event::Tick => {}
            // one that nobody waited for was no answer
            Event::Key(Key::Arm) => self.word_given |= self.awaits_word(),
            Event::Key(key) => self.key(now, key),
            Event::Cleared(verdict) => {
                self.clearance = Some(verdict.map(|lift| {
                    self.lift = Some(lift);
                }));
            }
            Event::Feed(feeding) => self.guide.feeding = feeding,
            Event::Stop(by) => self.stop(now, &by),
            Event::Stalled(gap) => self.stalled(now, gap),
            Event::LinkEnded => self.end(now, Cause::LinkLost("the program's own link has ended".to_owned())),
            Event::Link(up) => {
                self.known.doubt(now, Doubted::Silence);
                let (level, text) =
                    if up { (Level::Information, "link is up") } else { (Level::Warning, "link is down") };
                self.note(now, level, "link", text);
            }
        }
        self.step(now);
    }

    /// One step of time: the safety rules first, then the phase, then what is to be sent.
    fn step(&mut self, now: Duration) {
        self.supervise(now);
        match &self.phase {
            Phase::Connect => self.connect(now),
            Phase::Check(_) => self.check(now),
            Phase::Prime => self.prime(now),
            Phase::Engage => self.engage(now),
            Phase::Ready => self.ready(now),
            Phase::Arm => self.arm(now),
            Phase::Climb => self.climb(now),
            Phase::Transfer => self.transfer(now),
            Phase::Gate => self.gate(now),
            Phase::Course => self.fly_course(now),
            Phase::Leave(_) => self.leave(now),
            Phase::Lost => self.wait_for_word(now),
            Phase::Watch => self.watch_others(now),
            Phase::Done => {}
        }
        // nothing follows the end
        if matches!(self.phase, Phase::Done) {
            return;
        }
        self.follow(now);
        self.hold_back(now);
        self.command(now);
        // a command that is given up may have ended it
        let is_over = matches!(self.phase, Phase::Done);
        if now >= self.heartbeat_due && !is_over {
            self.heartbeat_due = (self.heartbeat_due + HEARTBEAT_PERIOD).max(now);
            self.actions.push_back(Action::Send(heartbeat()));
        }
    }
}
