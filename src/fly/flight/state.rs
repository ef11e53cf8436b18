//! The state of a flight.

use std::collections::VecDeque;
use std::time::Duration;

use super::action::Action;
use super::gate::Gate;
use super::phase::Phase;
use super::watch::Watch;
use crate::autopilot::Stack;
use crate::fly::commander::Commander;
use crate::fly::health::BatteryLevel;
use crate::fly::lift::Lift;
use crate::fly::outcome::{Cause, FlightStatistics, Level, Note};
use crate::fly::roster::Roster;
use crate::fly::safety::{Guide, ModeKnowledge};
use crate::fly::setpoint::Place;
use crate::fly::sortie::Sortie;
use crate::fly::target::Target;
use crate::fly::telemetry::Telemetry;
use crate::units::deg_from_rad;
use crate::wire::{self, CrcSeeds};

/// A flight.
#[derive(Debug)]
pub struct Flight {
    pub(super) sortie: Sortie,
    pub(super) seeds: CrcSeeds,
    pub(super) roster: Roster,
    pub(super) told_others: bool,
    /// major and minor number of the autopilot's release, where it said so
    pub(super) release: Option<(u8, u8)>,
    pub(super) contact: Option<Contact>,
    pub(super) commander: Commander,
    /// whether the vehicle's mode is known well enough to command it
    pub(super) known: ModeKnowledge,
    /// a suspected second station, and the number of reports of the mode at that time
    pub(super) suspected: Option<(Cause, u64)>,
    /// the link holds unread frames: no command is sent before they are read
    pub(super) unread: bool,
    /// time of the last step
    pub(super) stepped: Option<Duration>,
    /// the last stall of this program or its computer: when it ended, and how long it was
    pub(super) stall: Option<(Duration, Duration)>,
    /// when the last stall ended that was counted: the stream and the flight itself report one and the same
    pub(super) stalls_until: Option<Duration>,
    pub(super) phase: Phase,
    /// when the phase was entered
    pub(super) entered: Duration,
    /// the mode in which it was found once all checks were passed
    pub(super) found: Option<u32>,
    /// its place when it was armed
    pub(super) stand: Option<Place>,
    /// setpoints have been above the room's floor: from then on none below is sent
    pub(super) climbed: bool,
    pub(super) guide: Guide,
    pub(super) watch: Watch,
    pub(super) gate: Gate,
    pub(super) actions: VecDeque<Action>,
    pub(super) heartbeat_due: Duration,
    pub(super) clearance: Option<Result<(), String>>,
    /// the word for arming, after the page before the flight
    pub(super) word_given: bool,
    /// the order to arm was sent, and may act before the vehicle reports it
    pub(super) arm_ordered: bool,
    /// thrust of the outputs, for the comparison with the weight in hover
    pub(super) lift: Option<Box<Lift>>,
    /// the mode in which the operator stopped the motors
    pub(super) killed_in: Option<u32>,
    pub(super) cause: Option<Cause>,
    pub(super) flown: FlightStatistics,
    pub(super) losses: Vec<String>,
}

/// The vehicle that was chosen.
#[derive(Debug)]
pub(super) struct Contact {
    pub(super) target: Target,
    pub(super) telemetry: Telemetry,
}

impl Flight {
    /// A flight that begins at time zero of its clock.
    #[must_use]
    pub fn new(sortie: Sortie) -> Self {
        let watch = Watch::new(&sortie);
        let flown = FlightStatistics {
            tilt_planned_deg: deg_from_rad(sortie.course.tilt_max_rad(sortie.gravity_m_s2)),
            ..FlightStatistics::default()
        };
        let known = ModeKnowledge::new(sortie.settings.first_question);
        Self {
            sortie,
            seeds: CrcSeeds::new(),
            roster: Roster::default(),
            told_others: false,
            release: None,
            contact: None,
            commander: Commander::default(),
            known,
            suspected: None,
            unread: false,
            stepped: None,
            stall: None,
            stalls_until: None,
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

    /// The next action; call it until it returns `None`.
    pub fn next_action(&mut self) -> Option<Action> {
        self.actions.pop_front()
    }

    /// The setpoints to be streamed, as of the last [`Flight::handle`].
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
    pub fn target(&self) -> Option<(Target, &'static Stack)> {
        self.contact.as_ref().map(|contact| (contact.target, contact.telemetry.stack()))
    }

    /// The vehicle as the log knows it, once it is found.
    #[must_use]
    pub fn vehicle(&self) -> Option<wire::Vehicle> {
        self.contact.as_ref().map(|contact| contact.telemetry.vehicle())
    }

    /// Major and minor number of the autopilot's release, where it said so.
    #[must_use]
    pub fn release(&self) -> Option<(u8, u8)> {
        self.release
    }

    /// Seeds of the checksums of known messages.
    #[must_use]
    pub fn seeds(&self) -> &CrcSeeds {
        &self.seeds
    }

    /// The sortie that is flown.
    #[must_use]
    pub fn sortie(&self) -> &Sortie {
        &self.sortie
    }

    /// Whether the flight's own message requests are done and it waits for [`Event::Cleared`](super::Event::Cleared).
    #[must_use]
    pub fn wants_clearance(&self) -> bool {
        matches!(&self.phase, Phase::Check(checking) if checking.has_asked()) && self.clearance.is_none()
    }

    /// Notes whether the link holds unread frames: until they are read, no command is sent.
    pub fn set_unread(&mut self, unread: bool) {
        self.unread = unread;
    }

    pub(super) fn enter(&mut self, now: Duration, phase: Phase) {
        tracing::info!(phase = phase.name(), left = self.phase.name(), "phase entered");
        self.note(now, Level::Information, "phase", phase.name());
        self.phase = phase;
        self.entered = now;
    }

    pub(super) fn note(&mut self, now: Duration, level: Level, kind: &'static str, text: impl Into<String>) {
        self.actions.push_back(Action::Note(Note::new(now, level, kind, text)));
    }

    pub(super) fn is_armed(&self) -> bool {
        self.contact.as_ref().is_some_and(|contact| contact.telemetry.is_armed())
    }

    pub(super) fn battery_level(&self) -> BatteryLevel {
        self.contact.as_ref().map_or(BatteryLevel::Good, |contact| contact.telemetry.battery_level())
    }
}
