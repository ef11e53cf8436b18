//! The flight and the checks before it: frames, events and a clock in, messages and notes out. It does no I/O, so
//! that a simulated link drives it as a real one does.

use std::collections::VecDeque;
use std::time::Duration;

use super::clearance::{Clearance, Cleared};
use super::question::{Answer, Question};
use crate::fly::finding;
use crate::fly::flight::{Action, Event, Flight};
use crate::fly::lift::Lift;
use crate::fly::outcome::{Level, Note};
use crate::fly::requests::LinkKind;
use crate::link::LinkEvent;
use crate::vehicle::Vehicle;
use crate::wire::{Check, Record};

/// A flight with the checks that clear it. Times are those of the flight's clock.
#[derive(Debug)]
pub struct Supervisor {
    flight: Flight,
    vehicle: Vehicle,
    link: LinkKind,
    clearance: Option<Clearance>,
    /// the checks are not made here
    aside: bool,
    question: Option<Box<Question>>,
    cleared: Option<Cleared>,
    actions: VecDeque<Action>,
    /// it was told that the vehicle's position is waited for
    told_waiting: bool,
    /// something of the link was taken since the last tick
    took: bool,
    /// when something of the link was last taken, or nothing waited
    known_until: Duration,
    /// frames and events that waited at a tick before and are not taken yet
    to_read: usize,
}

impl Supervisor {
    /// Of a flight of `vehicle` over a link of this kind.
    #[must_use]
    pub fn new(flight: Flight, vehicle: Vehicle, link: LinkKind) -> Self {
        Self {
            flight,
            vehicle,
            link,
            clearance: None,
            aside: false,
            question: None,
            cleared: None,
            actions: VecDeque::new(),
            told_waiting: false,
            took: true,
            known_until: Duration::ZERO,
            to_read: 0,
        }
    }

    /// The checks are made elsewhere: of [`Self::take_question`], for [`Self::answer`].
    pub(super) fn with_checks_aside(self) -> Self {
        Self { aside: true, ..self }
    }

    /// What is to be judged, once.
    pub(super) fn take_question(&mut self) -> Option<Box<Question>> {
        self.question.take()
    }

    /// Takes what the checks came to.
    pub(super) fn answer(&mut self, now: Duration, answer: Answer) {
        let clearance = self.clearance.as_mut().filter(|_| self.flight.wants_clearance());
        if let Some(cleared) = clearance.and_then(|clearance| clearance.finish(&self.flight, answer)) {
            self.finish_checks(now, cleared);
        }
    }

    /// The flight as it is.
    #[must_use]
    pub fn flight(&self) -> &Flight {
        &self.flight
    }

    /// What flies, as its file says.
    #[must_use]
    pub fn vehicle(&self) -> &Vehicle {
        &self.vehicle
    }

    /// Takes a frame that the link delivered, with the host's stamp of its arrival.
    pub fn frame(&mut self, now: Duration, record: &Record<'_>) {
        self.took(now);
        self.handle(now, Event::Frame(record.frame));
        let known = record.frame.check(self.flight.seeds()) == Check::Right;
        if let Some(clearance) = &mut self.clearance {
            clearance.take(&Record { known, ..*record });
        }
    }

    /// Time advanced; `waiting` frames and events of the link were not taken yet. Where there are some, and nothing was taken
    /// since the last tick, the way from the link stands still: a supervisor that does not see renews nothing. Commands go
    /// out once all that waited at an earlier tick is read: the next frame may say that the pilot took over.
    pub fn tick(&mut self, now: Duration, waiting: usize) {
        if waiting == 0 {
            self.known_until = now;
        }
        if std::mem::replace(&mut self.took, false) || waiting == 0 {
            self.flight.set_unread(self.to_read > 0 && waiting > 0);
            self.handle(now, Event::Tick);
        }
        if self.to_read == 0 || waiting == 0 {
            self.to_read = waiting;
        }
        self.flight.set_unread(true);
    }

    /// Until when all is known that the link brought. What is to be sent is not renewed by anything that happens later.
    #[must_use]
    pub fn known_until(&self) -> Duration {
        self.known_until
    }

    fn took(&mut self, now: Duration) {
        (self.took, self.known_until) = (true, now);
        self.to_read = self.to_read.saturating_sub(1);
    }

    /// Takes what else happened.
    pub fn handle(&mut self, now: Duration, event: Event<'_>) {
        self.flight.handle(now, event);
        while let Some(action) = self.flight.next_action() {
            self.actions.push_back(action);
        }
        self.clear(now);
    }

    /// Takes what the link says of itself.
    pub fn link_event(&mut self, now: Duration, event: &LinkEvent) {
        self.took(now);
        let (up, level) = match event {
            LinkEvent::Connected { .. } => (Some(true), Level::Information),
            LinkEvent::Restored { .. } => (Some(true), Level::Warning),
            LinkEvent::Lost { .. } => (Some(false), Level::Warning),
            LinkEvent::Trusted { .. } => (None, Level::Information),
            _ => (None, Level::Warning),
        };
        self.note(now, level, "link", event.to_string());
        if let Some(up) = up {
            self.handle(now, Event::Link(up));
        }
    }

    /// What is to be done next, in order; ask until `None`.
    pub fn next_action(&mut self) -> Option<Action> {
        self.actions.pop_front()
    }

    /// What the checks came to, once, when they are over.
    pub(super) fn take_cleared(&mut self) -> Option<Cleared> {
        self.cleared.take()
    }

    /// The checks before the flight, once it waits for them.
    fn clear(&mut self, now: Duration) {
        if !self.flight.wants_clearance() {
            return;
        }
        let Some(who) = self.flight.vehicle() else { return };
        let rotors = self.vehicle.rotors.len();
        let link = self.link;
        let clearance = self.clearance.get_or_insert_with(|| Clearance::new(who, rotors, link));
        while let Some(message) = clearance.poll(now) {
            self.actions.push_back(Action::Send(message));
        }
        let question = clearance.question(&self.flight, &self.vehicle, now);
        let waits = clearance.waits_for_position();
        if waits && !std::mem::replace(&mut self.told_waiting, waits) {
            let text = "waiting for the vehicle's position estimate; all else is checked";
            self.note(now, Level::Information, "check", text);
        }
        match question.map(Box::new) {
            Some(question) if self.aside => self.question = Some(question),
            Some(question) => self.answer(now, question.answer()),
            None => {}
        }
    }

    fn finish_checks(&mut self, now: Duration, cleared: Cleared) {
        for line in &cleared.lines {
            self.note(now, Level::Information, "rate", line.clone());
        }
        for finding in &cleared.findings {
            let level = match finding.level {
                finding::Level::Ok | finding::Level::Awaited => Level::Information,
                _ => Level::Warning,
            };
            let finding::Finding { subject, expected, came, remedy, .. } = finding;
            let found = finding.level.name();
            tracing::debug!(subject, level = found, expected, came, remedy, "checked before the flight");
            let text = match finding.level {
                // the line says it
                finding::Level::Warning => finding.words(),
                _ => finding.to_string(),
            };
            self.note(now, level, "check", text);
        }
        let lift = Lift::new(&self.vehicle, &cleared.parameters);
        let verdict = cleared.verdict().map(|()| Box::new(lift));
        let feeding = cleared.feeding;
        self.cleared = Some(cleared);
        self.handle(now, Event::Feed(feeding));
        self.handle(now, Event::Cleared(verdict));
    }

    fn note(&mut self, now: Duration, level: Level, kind: &'static str, text: impl Into<String>) {
        self.actions.push_back(Action::Note(Note::new(now, level, kind, text)));
    }
}
