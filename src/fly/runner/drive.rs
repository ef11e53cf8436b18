//! The flight with its clock, its view and its checks on the host.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{SyncSender, TrySendError};
use std::time::Duration;

use super::clearance::Cleared;
use super::clock::Clock;
use super::estimating::{Estimating, LiveNews};
use super::event_layer::emit;
use super::files::{EVENTS, PARAMETERS};
use super::journal::Journal;
use super::judging::Judging;
use super::stream::SharedGuide;
use super::supervisor::Supervisor;
use crate::autopilot::Mode;
use crate::fly::finding;
use crate::fly::flight::{Action, Event, Flight, Key};
use crate::fly::live::{LiveIdentification, LiveSettings};
use crate::fly::outcome::{Level, Note, Outcome};
use crate::fly::parameters::Parameters;
use crate::fly::requests::LinkKind;
use crate::fly::safety::Lead;
use crate::fly::view::{Attitude, Battery, KeyCommand, LinkView, Phase, TWIN, ViewModel};
use crate::link::{LinkEvent, LinkWriter, ReceivedFrame};
use crate::text;
use crate::units::deg_from_rad;
use crate::vehicle::Vehicle;
use crate::wire::{Frame, Record};

/// A terminal that accepts no picture for this time is reported.
const BLIND: Duration = Duration::from_secs(2);
/// Between two pictures of the state.
const SHOW: Duration = Duration::from_millis(200);

/// Places of the flight's records, and the vehicle.
#[derive(Debug)]
pub(super) struct Place {
    pub(super) dir: PathBuf,
    pub(super) vehicle: Vehicle,
    pub(super) link: LinkKind,
    pub(super) address: String,
}

/// A running flight.
#[derive(Debug)]
pub(super) struct Drive {
    supervisor: Supervisor,
    guide: SharedGuide,
    writer: LinkWriter,
    clock: Clock,
    dir: PathBuf,
    estimating: Estimating,
    judging: Judging,
    notes: Vec<Note>,
    model: ViewModel,
    shown: Duration,
    frames: (u64, u64),
    refused: u64,
    /// a file to be written
    to_keep: Option<(PathBuf, String)>,
    /// since when the terminal accepts no pictures
    unseen_since: Option<Duration>,
    /// whether that was reported
    told_blind: bool,
    /// setpoints go out
    streams: bool,
    outcome: Option<Outcome>,
}

impl Drive {
    pub(super) fn new(
        flight: Flight,
        guide: SharedGuide,
        writer: LinkWriter,
        clock: Clock,
        (place, estimating, judging): (Place, Estimating, Judging),
    ) -> Self {
        let is_twin = flight.sortie().settings.is_twin;
        let title =
            if is_twin { format!("{} (twin)", place.vehicle.name) } else { place.vehicle.name.clone() };
        let mut model = ViewModel { title, is_twin, ..ViewModel::default() };
        model.tracking.limit_m = Some(flight.sortie().settings.tracking_max_m);
        let waits = format!("{}: waiting for a vehicle", place.address);
        let notes = vec![Note::new(clock.elapsed(), Level::Information, "link", waits)];
        let Place { dir, vehicle, link, .. } = place;
        Self {
            supervisor: Supervisor::new(flight, vehicle, link).with_checks_aside(),
            guide,
            writer,
            clock,
            dir,
            estimating,
            judging,
            notes,
            model,
            shown: Duration::ZERO,
            frames: (0, 0),
            refused: 0,
            to_keep: None,
            unseen_since: None,
            told_blind: false,
            streams: false,
            outcome: None,
        }
    }

    /// Reports a warning to the operator.
    pub(super) fn warn(&mut self, kind: &'static str, text: &str) {
        self.notes.push(Note::new(self.clock.elapsed(), Level::Warning, kind, text));
    }

    pub(super) fn outcome(&self) -> Option<Outcome> {
        self.outcome.clone()
    }

    pub(super) fn handle(&mut self, event: Event<'_>) {
        let now = self.clock.elapsed();
        self.supervisor.handle(now, event);
        self.act(now);
    }

    /// Time advanced; whether the link has something that was not taken.
    pub(super) fn tick(&mut self, waiting: usize) {
        let now = self.clock.elapsed();
        self.supervisor.tick(now, waiting);
        match self.judging.answer() {
            Some(Ok(answer)) => self.supervisor.answer(now, *answer),
            Some(Err(why)) => self.supervisor.handle(now, Event::Cleared(Err(why.to_owned()))),
            None => {}
        }
        self.act(now);
    }

    pub(super) fn frame(&mut self, received: ReceivedFrame) {
        if let Some(frame) = Frame::at_start(received.bytes()) {
            let now = self.clock.elapsed();
            // whether it is known is told by its checksum, later
            let record = Record { stamp_us: received.stamp.utc_us, offset: 0, known: false, frame };
            self.supervisor.frame(now, &record);
            self.act(now);
        }
        self.estimating.frame(received);
    }

    /// Executes the actions of the supervisor.
    fn act(&mut self, now: Duration) {
        self.guide.set(self.supervisor.flight().guide(), self.supervisor.known_until());
        self.tell_stream();
        while let Some(action) = self.supervisor.next_action() {
            match action {
                Action::Send(message) => {
                    self.refused += u64::from(self.writer.send_message(&message).is_err())
                }
                Action::Note(note) => self.notes.push(note),
                Action::Finished(outcome) => self.outcome = Some(outcome),
            }
        }
        if let Some(question) = self.supervisor.take_question() {
            self.judging.ask(question);
        }
        if let Some(cleared) = self.supervisor.take_cleared() {
            self.cleared(now, cleared);
        }
    }

    /// Emits an event when setpoints start or stop. The threads that send setpoints emit none: a subscriber may block.
    fn tell_stream(&mut self) {
        let guide = self.supervisor.flight().guide();
        let streams = guide.lead != Lead::Silent && !guide.held_back;
        if std::mem::replace(&mut self.streams, streams) == streams {
            return;
        }
        if streams {
            let period = self.supervisor.flight().sortie().settings.setpoint_period;
            tracing::info!(period_s = period.as_secs_f64(), "setpoints started");
        } else {
            tracing::info!(held_back = guide.held_back, "setpoints stopped");
        }
    }

    pub(super) fn link_event(&mut self, event: &LinkEvent) {
        let now = self.clock.elapsed();
        self.supervisor.link_event(now, event);
        self.act(now);
    }

    pub(super) fn key(&mut self, key: KeyCommand) {
        let event = match key {
            KeyCommand::Hold => Event::Key(Key::To(Mode::Hold)),
            KeyCommand::Land => Event::Key(Key::To(Mode::Land)),
            KeyCommand::Return => Event::Key(Key::To(Mode::Return)),
            KeyCommand::Kill => Event::Key(Key::Kill),
            KeyCommand::Arm => Event::Key(Key::Arm),
            KeyCommand::Quit => Event::Stop("the operator".to_owned()),
        };
        self.handle(event);
    }

    /// The checks are over: parameters are kept, and the identification under way begins.
    fn cleared(&mut self, now: Duration, cleared: Cleared) {
        self.keep_parameters(now, &cleared.parameters);
        let vehicle = self.supervisor.vehicle();
        let live = LiveIdentification::new(vehicle, &cleared.parameters, &LiveSettings::default());
        if let Some(decoder) = cleared.decoder {
            self.estimating.begin(decoder, live);
        }
        let of = self.model.is_twin.then(|| format!("what flies now is {TWIN}"));
        self.model.page = Some(Arc::new(cleared.page.said_of(of)));
    }

    fn keep_parameters(&mut self, now: Duration, parameters: &Parameters) {
        let path = self.dir.join(PARAMETERS);
        match parameters.to_toml() {
            Ok(text) => self.to_keep = Some((path, text)),
            Err(error) => {
                let text = format!("cannot write {}: {error}", text::path(&path));
                self.notes.push(Note::new(now, Level::Error, "file", text));
            }
        }
    }

    /// Passes on notes and pictures of the state, without waiting.
    pub(super) fn report(&mut self, journal: &Journal, view: &SyncSender<ViewModel>) {
        let now = self.clock.elapsed();
        self.model.elapsed_s = now.as_secs_f64();
        if let Some((path, text)) = self.to_keep.take() {
            journal.keep(path, text);
        }
        if let Some(trouble) = journal.news() {
            self.notes.push(Note::new(now, Level::Warning, "file", format!("{EVENTS}: {trouble}")));
        }
        for note in std::mem::take(&mut self.notes) {
            emit(&note);
            let level = match note.level {
                Level::Information => finding::Level::Ok,
                Level::Warning => finding::Level::Warning,
                Level::Error => finding::Level::Refusal,
            };
            self.model.event(level, format!("{}: {}", note.kind, note.text));
        }
        if now.saturating_sub(self.shown) < SHOW && self.outcome.is_none() {
            return;
        }
        self.picture(now);
        self.shown = now;
        // nobody has to watch
        let unseen = matches!(view.try_send(self.model.clone()), Err(TrySendError::Full(_)));
        self.tell_view(now, unseen);
    }

    /// Reports a terminal that accepts nothing for a while in the log of events.
    fn tell_view(&mut self, now: Duration, unseen: bool) {
        if !unseen {
            self.unseen_since = None;
            if std::mem::take(&mut self.told_blind) {
                self.warn("view", "the terminal accepts output again");
            }
            return;
        }
        let since = *self.unseen_since.get_or_insert(now);
        if now.saturating_sub(since) >= BLIND && !std::mem::replace(&mut self.told_blind, true) {
            self.warn(
                "view",
                &format!("the terminal accepts no output: the flight continues, its events are in {EVENTS}"),
            );
        }
    }

    fn picture(&mut self, now: Duration) {
        let flight = self.supervisor.flight();
        let status = flight.status(now);
        let follows = flight.guide().lead != Lead::Silent;
        let stats = self.writer.stats();
        let passed_s = now.saturating_sub(self.shown).as_secs_f64().max(1e-3);
        let hz = |total: u64, before: u64| total.saturating_sub(before) as f64 / passed_s;
        let model = &mut self.model;
        model.link = LinkView {
            age_s: status.link_age_s,
            frames_hz: hz(stats.received_frames, self.frames.0),
            bytes_s: hz(stats.received_bytes, self.frames.1),
            loss: None,
        };
        self.frames = (stats.received_frames, stats.received_bytes);
        model.phase = match (status.aborted, status.airborne) {
            (true, _) => Phase::Aborted,
            (false, true) => Phase::Flying,
            (false, false) if status.phase == "over" => Phase::Done,
            (false, false) => Phase::Preparing,
        };
        model.stall_s = status.stall_s;
        model.state = status.phase.to_owned();
        model.mode = status.mode.unwrap_or_default();
        model.armed = status.armed;
        model.awaits_word = status.awaits_word;
        model.progress_s = status.progress_s;
        let motion = status.position_m.zip(status.velocity_m_s);
        model.moves(status.euler_rad.zip(motion).map(|(euler_rad, (position_m, velocity_m_s))| {
            let [roll_deg, pitch_deg, yaw_deg] = euler_rad.map(deg_from_rad);
            Attitude { roll_deg, pitch_deg, yaw_deg, position_m, velocity_m_s }
        }));
        model.battery = Battery {
            percent: status.battery_percent.map(f64::from),
            voltage_v: status.battery_v,
            is_low: status.battery_is_low,
        };
        if follows && status.airborne {
            model.track(status.tracking_m);
        }
        self.estimating.set_active(status.progress_s.is_some());
        match self.estimating.latest() {
            Some(LiveNews::Estimate(estimate)) => model.estimate(&estimate),
            Some(LiveNews::Waits(what)) => model.parameters_await = Some(what),
            None => {}
        }
    }
}
