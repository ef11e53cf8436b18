//! A vehicle on a link, and the conversation with it.

use crate::wire::heartbeat::{ARMED, BASE_MODE_AT, HEARTBEAT_PERIOD};
use crate::wire::message_id::HEARTBEAT;
use std::pin::Pin;
use std::time::Duration;

use super::OnboardError;
use crate::autopilot::Stack;
use crate::fetch::{Dialogue, Moment, Offer, Survey, Uptime};
use crate::fly::{Choice, Roster, heartbeat};
use crate::link::{Address, Link, LinkEvent, LinkOptions, LinkReader, LinkWriter, Received};
use crate::note::{About, Note};
use crate::wire::{Frame, SystemId, Vehicle};
use mavlink::dialects::ardupilotmega::MavMessage;
use tokio::time::{Instant, MissedTickBehavior, interval};

/// Between two looks at what is due.
const TICK: Duration = Duration::from_millis(5);
/// Between two words about how long a vehicle is waited for.
const STILL_WAITING: Duration = Duration::from_secs(6);
/// Whether a conversation goes on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Flow {
    /// it does
    On,
    /// enough
    Stop,
}

/// Until somebody asks for the end of the conversation; the name of the signal.
pub type Interrupt = Pin<Box<dyn Future<Output = String>>>;

/// With which vehicle one talks, and how.
pub struct SessionRequest {
    /// where it is
    pub address: Address,
    /// of the link
    pub options: LinkOptions,
    /// the vehicle; without it the only one on the link
    pub system: Option<SystemId>,
    /// how long its first HEARTBEAT_PERIOD is waited for
    pub patience: Duration,
    /// ends the conversation
    pub interrupt: Interrupt,
    /// takes what is to be known meanwhile
    pub tell: fn(&Note),
}

/// A vehicle on a link.
pub struct Session {
    reader: LinkReader,
    writer: LinkWriter,
    address: String,
    interrupt: Interrupt,
    tell: fn(&Note),
    start: Instant,
    /// as its last HEARTBEAT_PERIOD says
    armed: bool,
    /// nothing more is said to it once it is armed
    only_disarmed: bool,
    /// the vehicle
    pub vehicle: Vehicle,
    /// its autopilot
    pub stack: &'static Stack,
}

impl Session {
    /// Opens the link and waits for the vehicle. Nothing is sent but heartbeats.
    ///
    /// # Errors
    /// The link cannot be opened, no vehicle is heard in time, the vehicle is not the one that is meant, it is armed, or the
    /// interrupt came.
    pub async fn open(request: SessionRequest) -> Result<Self, OnboardError> {
        let SessionRequest { address, options, system, patience, mut interrupt, tell } = request;
        let (mut reader, writer) = Link::open(&address, options).await?;
        let start = Instant::now();
        let mut roster = Roster::default();
        let mut absent = None;
        let mut beats = interval(HEARTBEAT_PERIOD);
        let mut told = STILL_WAITING;
        loop {
            tokio::select! {
                received = reader.receive() => match received? {
                    Received::Frame(frame) => {
                        if let Some(frame) = Frame::at_start(frame.bytes()) {
                            roster.hear(start.elapsed(), frame);
                        }
                    }
                    Received::Event(event) => note_absence(&address, &event, &mut absent, tell),
                },
                _ = beats.tick() => {
                    // while nobody is there, there is nobody to tell
                    let _ = writer.send_message(&heartbeat());
                }
                signal = &mut interrupt => return Err(OnboardError::Ended(signal)),
            }
            match roster.choose(start.elapsed(), system) {
                Choice::Vehicle(vehicle, _, stack) => {
                    return Ok(Self {
                        reader,
                        writer,
                        address: address.to_string(),
                        interrupt,
                        tell,
                        start,
                        armed: false,
                        only_disarmed: false,
                        vehicle,
                        stack,
                    });
                }
                Choice::Refuse(why) => return Err(OnboardError::Refused(why)),
                Choice::Wait if start.elapsed() > patience => {
                    return Err(OnboardError::Absent {
                        address: address.to_string(),
                        within_s: patience.as_secs(),
                        heard: absent.map_or_else(|| roster.heard(), |why| format!("nobody ({why})")),
                    });
                }
                Choice::Wait if start.elapsed() >= told && told < patience => {
                    tell(&waiting(&address, told, patience));
                    told += STILL_WAITING;
                }
                Choice::Wait => {}
            }
        }
    }

    /// What the vehicle offers.
    ///
    /// # Errors
    /// Those of [`talk`](Self::talk).
    pub async fn offer(&mut self) -> Result<Offer, OnboardError> {
        let mut survey = Survey::new(self.vehicle);
        self.talk(&mut survey, |_| Ok(Flow::On)).await?;
        Ok(survey.offer())
    }

    /// Now, with the vehicle's time since its start.
    ///
    /// # Errors
    /// Those of [`talk`](Self::talk).
    pub async fn moment(&mut self) -> Result<Moment, OnboardError> {
        let mut uptime = Uptime::new(self.vehicle);
        self.talk(&mut uptime, |_| Ok(Flow::On)).await?;
        Ok(Moment::now(uptime.up_s()))
    }

    /// Talks until the dialogue is done, or `each` has enough, which is asked again and again.
    ///
    /// # Errors
    /// The dialogue or `each` fails, the link is lost, or the interrupt came.
    pub async fn talk<D: Dialogue>(
        &mut self,
        dialogue: &mut D,
        mut each: impl FnMut(&mut D) -> Result<Flow, OnboardError>,
    ) -> Result<Flow, OnboardError> {
        let mut ticks = interval(TICK);
        ticks.set_missed_tick_behavior(MissedTickBehavior::Skip);
        let mut beat = None;
        loop {
            if self.only_disarmed && self.armed {
                return Err(OnboardError::Armed(self.vehicle.system));
            }
            let now = self.start.elapsed();
            if beat.is_none_or(|beat| now.saturating_sub(beat) >= HEARTBEAT_PERIOD) {
                beat = Some(now);
                let _ = self.writer.send_message(&heartbeat());
            }
            while let Some(message) = dialogue.poll(now)? {
                // one that does not leave is asked again as one that gets lost
                let _ = self.writer.send_message(&message);
            }
            if each(dialogue)? == Flow::Stop {
                return Ok(Flow::Stop);
            }
            if dialogue.is_done() {
                return Ok(Flow::On);
            }
            tokio::select! {
                received = self.reader.receive() => {
                    self.take(dialogue, received?);
                    while let Ok(Some(received)) = self.reader.try_receive() {
                        self.take(dialogue, received);
                    }
                }
                _ = ticks.tick() => {}
                signal = &mut self.interrupt => return Err(OnboardError::Ended(signal)),
            }
        }
    }

    /// Talks until the dialogue is done, and no longer than the vehicle is disarmed.
    ///
    /// # Errors
    /// Those of [`talk`](Self::talk), and [`OnboardError::Armed`].
    pub async fn talk_disarmed(&mut self, dialogue: &mut impl Dialogue) -> Result<(), OnboardError> {
        self.only_disarmed = true;
        let done = self.talk(dialogue, |_| Ok(Flow::On)).await;
        self.only_disarmed = false;
        done.map(|_| ())
    }

    fn take(&mut self, dialogue: &mut impl Dialogue, received: Received) {
        let Received::Frame(received) = received else { return };
        let Some(frame) = Frame::at_start(received.bytes()) else { return };
        let header = frame.header();
        let is_own = header.system == self.vehicle.system && header.component == self.vehicle.component;
        if is_own && header.message_id == HEARTBEAT {
            self.armed = frame.payload().u8(BASE_MODE_AT) & ARMED != 0;
        }
        dialogue.take(self.start.elapsed(), &frame);
    }

    /// The last message of a conversation, which nobody answers.
    pub async fn say(&self, message: &MavMessage) {
        let _ = self.writer.send_message(message);
        let _ = tokio::time::timeout(Duration::from_millis(500), self.writer.flush()).await;
    }

    /// Tells what is to be known of the vehicle.
    pub(super) fn warn(&self, text: String) {
        (self.tell)(&Note::warning(About::Link(self.address.clone()), text));
    }

    /// By which name the vehicle is known from one run to the next: two simulated ones may say the same number.
    #[must_use]
    pub fn known_as(&self, offer: &Offer) -> String {
        let name = format!("{}-system-{}", self.stack.id, self.vehicle.system);
        offer.uid.iter().fold(name, |name, uid| format!("{name}-{uid}"))
    }

    /// Since the link was opened.
    #[must_use]
    pub fn elapsed(&self) -> Duration {
        self.start.elapsed()
    }
}

/// How long a vehicle was waited for, of how long.
fn waiting(address: &Address, waited: Duration, patience: Duration) -> Note {
    let text = format!("no vehicle yet: waiting {} of {} s", waited.as_secs(), patience.as_secs());
    Note::remark(About::Link(address.to_string()), text)
}

/// Says once that nobody is at the other end.
fn note_absence(address: &Address, event: &LinkEvent, absent: &mut Option<String>, tell: fn(&Note)) {
    match event {
        LinkEvent::Waiting { why } => {
            if absent.is_none() {
                tell(&Note::remark(About::Link(address.to_string()), event.to_string()));
            }
            *absent = Some(why.clone());
        }
        LinkEvent::Connected { .. } | LinkEvent::Restored { .. } => *absent = None,
        _ => {}
    }
}
