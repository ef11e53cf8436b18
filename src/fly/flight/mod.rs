//! The flight as a state machine: messages and a clock in, messages out. It does no I/O.

mod air;
mod command;
mod gate;
mod ground;
mod leave;
mod listen;
mod phase;
mod stand;
mod status;
mod watch;

pub use status::Status;

use std::collections::VecDeque;
use std::time::Duration;

use mavlink::dialects::ardupilotmega::MavMessage;

use super::commander::Commander;
use super::health::BatteryLevel;
use super::lift::Lift;
use super::modes::{Mode, Stack};
use super::outcome::{Cause, Ending, Flown, Level, Note, Outcome, Response};
use super::roster::Roster;
use super::safety::{Doubted, Feeding, Guide, Lead, ModeKnowledge};
use super::setpoint::Place;
use super::sortie::Sortie;
use super::target::{Target, heartbeat};
use super::telemetry::Telemetry;
use crate::log::{self, CrcSeeds, Frame};
use crate::units::deg_from_rad;
use gate::Gate;
use phase::Phase;
use watch::Watch;

/// Between our own heartbeats.
const HEARTBEAT_PERIOD: Duration = Duration::from_secs(1);

/// What the flight hears.
#[derive(Debug, Clone, PartialEq)]
pub enum Event<'a> {
    /// a frame from the link
    Frame(Frame<'a>),
    /// time went on; wanted every 10 ms
    Tick,
    /// the operator
    Key(Key),
    /// parameters, message rates and limits are checked: whether the flight may go on, and how its outputs lift it
    Cleared(Result<Box<Lift>, String>),
    /// how setpoints are made from the reference, by what the vehicle does when they end
    Feed(Feeding),
    /// the program is told to end, by what
    Stop(String),
    /// the stream of setpoints stood still for so long, or this flight did, and it has ended
    Stalled(Duration),
    /// the link is lost (`false`) or there again
    Link(bool),
    /// the link's own task has ended: nothing will be heard any more
    LinkEnded,
}

/// What the operator wants.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Key {
    /// once: hold; twice: land; three times: return
    Abort,
    /// to hold, land or return, whatever was before
    To(Mode),
    /// motors off now, wherever the vehicle is; only after a typed word
    Kill,
    /// the word for arming, where it is waited for
    Arm,
}

/// What the flight wants done.
#[derive(Debug, Clone, PartialEq)]
pub enum Action {
    /// send it, in order
    Send(MavMessage),
    /// tell people and the log of events
    Note(Note),
    /// the flight is over
    Finished(Outcome),
}

/// The vehicle that was chosen.
#[derive(Debug)]
struct Contact {
    target: Target,
    telemetry: Telemetry,
}

/// A flight.
#[derive(Debug)]
pub struct Flight {
    sortie: Sortie,
    seeds: CrcSeeds,
    roster: Roster,
    told_others: bool,
    /// major and minor number of the autopilot's release, where it said so
    release: Option<(u8, u8)>,
    contact: Option<Contact>,
    commander: Commander,
    /// whether the vehicle's mode is known well enough to command it
    known: ModeKnowledge,
    /// what looks like another master, and the reports of the mode that had come by then
    suspected: Option<(Cause, u64)>,
    /// frames lie in the link that were not read yet: no command goes out before
    unread: bool,
    /// when it was last asked to go on
    stepped: Option<Duration>,
    phase: Phase,
    /// when the phase was entered
    entered: Duration,
    /// the mode in which it was found once all checks were passed
    found: Option<u32>,
    /// where it stood when it was armed
    stand: Option<Place>,
    /// what is sent came above the room's floor: from then on nothing below is sent
    climbed: bool,
    guide: Guide,
    watch: Watch,
    gate: Gate,
    actions: VecDeque<Action>,
    heartbeat_due: Duration,
    clearance: Option<Result<(), String>>,
    /// the word for arming, after the page before the flight
    word_given: bool,
    /// the order to arm left, and may act later than the vehicle says so
    arm_ordered: bool,
    /// by which the vehicle is weighed once it hovers
    lift: Option<Box<Lift>>,
    /// the mode in which the operator stopped the motors
    killed_in: Option<u32>,
    cause: Option<Cause>,
    flown: Flown,
    losses: Vec<String>,
}

impl Flight {
    /// A flight that begins at zero of the clock that it will be told.
    #[must_use]
    pub fn new(sortie: Sortie) -> Self {
        let watch = Watch::new(&sortie);
        let flown = Flown {
            tilt_planned_deg: deg_from_rad(sortie.course.tilt_max_rad(sortie.gravity_m_s2)),
            ..Flown::default()
        };
        Self {
            sortie,
            seeds: CrcSeeds::new(),
            roster: Roster::default(),
            told_others: false,
            release: None,
            contact: None,
            commander: Commander::default(),
            known: ModeKnowledge::default(),
            suspected: None,
            unread: false,
            stepped: None,
            phase: Phase::Connect,
            entered: Duration::ZERO,
            found: None,
            stand: None,
            climbed: false,
            guide: Guide::silent(Duration::ZERO),
            watch,
            gate: Gate::default(),
            actions: VecDeque::new(),
            heartbeat_due: Duration::ZERO,
            clearance: None,
            word_given: false,
            arm_ordered: false,
            lift: None,
            killed_in: None,
            cause: None,
            flown,
            losses: Vec::new(),
        }
    }

    /// Takes what happened at `now` and goes on.
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
            Event::Key(Key::Arm) => self.word_given = true,
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

    /// What is to be done next; ask until `None`.
    pub fn next_action(&mut self) -> Option<Action> {
        self.actions.pop_front()
    }

    /// What is to be streamed. It is as old as the last [`Flight::handle`].
    #[must_use]
    pub fn guide(&self) -> &Guide {
        &self.guide
    }

    /// The flight is over.
    #[must_use]
    pub fn is_over(&self) -> bool {
        matches!(self.phase, Phase::Done)
    }

    /// The vehicle, once it is found.
    #[must_use]
    pub fn target(&self) -> Option<(Target, Stack)> {
        self.contact.as_ref().map(|contact| (contact.target, contact.telemetry.stack()))
    }

    /// The vehicle as the log knows it, once it is found.
    #[must_use]
    pub fn vehicle(&self) -> Option<log::Vehicle> {
        self.contact.as_ref().map(|contact| contact.telemetry.vehicle())
    }

    /// Major and minor number of the autopilot's release, where it said so.
    #[must_use]
    pub fn release(&self) -> Option<(u8, u8)> {
        self.release
    }

    /// What tells a known message by its checksum.
    #[must_use]
    pub fn seeds(&self) -> &CrcSeeds {
        &self.seeds
    }

    /// What is flown.
    #[must_use]
    pub fn sortie(&self) -> &Sortie {
        &self.sortie
    }

    /// The flight's own message requests are done and it waits for [`Event::Cleared`].
    #[must_use]
    pub fn wants_clearance(&self) -> bool {
        matches!(&self.phase, Phase::Check(checking) if checking.has_asked()) && self.clearance.is_none()
    }

    /// Says whether frames lie in the link that may say more: until they are read, no command goes out.
    pub fn set_unread(&mut self, unread: bool) {
        self.unread = unread;
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
        if now >= self.heartbeat_due {
            self.heartbeat_due = (self.heartbeat_due + HEARTBEAT_PERIOD).max(now);
            self.actions.push_back(Action::Send(heartbeat()));
        }
    }

    fn enter(&mut self, now: Duration, phase: Phase) {
        self.note(now, Level::Information, "phase", phase.name());
        self.phase = phase;
        self.entered = now;
    }

    fn note(&mut self, now: Duration, level: Level, kind: &'static str, text: impl Into<String>) {
        self.actions.push_back(Action::Note(Note::new(now, level, kind, text)));
    }

    /// Ends the flight for a cause. The first counts, unless a later one takes our hands off.
    fn end(&mut self, now: Duration, cause: Cause) {
        if matches!(self.phase, Phase::Watch | Phase::Done) {
            return;
        }
        let response = cause.response();
        let leaving = matches!(self.phase, Phase::Leave(_));
        if leaving && !matches!(response, Response::HandsOff | Response::Wait) {
            return;
        }
        if matches!((&self.phase, response), (Phase::Lost, Response::Hold | Response::Land | Response::Wait))
        {
            return;
        }
        self.note(now, Level::Error, "abort", cause.to_string());
        self.cause.get_or_insert(cause);
        if !self.phase.is_airborne() && !self.is_armed() && !self.arm_ordered {
            self.finish(now, Ending::NotFlown);
            return;
        }
        match response {
            Response::HandsOff => self.hands_off(now),
            Response::Wait => self.lose(now),
            Response::Hold => self.begin_hold(now),
            Response::Land => self.begin_landing(now),
        }
    }

    fn is_armed(&self) -> bool {
        self.contact.as_ref().is_some_and(|contact| contact.telemetry.is_armed())
    }

    fn finish(&mut self, now: Duration, ending: Ending) {
        self.guide.lead = Lead::Silent;
        self.commander.clear();
        let (rms_m, max_m) = self.watch.tracking.figures_m();
        let flown = Flown {
            tracking_rms_m: rms_m,
            tracking_max_m: max_m,
            tilt_max_deg: deg_from_rad(self.watch.envelope.greatest_tilt_rad()),
            ..self.flown.clone()
        };
        self.enter(now, Phase::Done);
        let (cause, losses) = (self.cause.clone(), self.losses.clone());
        self.actions.push_back(Action::Finished(Outcome { cause, ending, flown, losses }));
    }

    fn battery_level(&self) -> BatteryLevel {
        self.contact.as_ref().map_or(BatteryLevel::Good, |contact| contact.telemetry.battery_level())
    }
}
