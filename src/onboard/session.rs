//! A vehicle on a link, and the conversation with it.

use crate::wire::heartbeat::{ARMED, BASE_MODE_AT, HEARTBEAT_PERIOD};
use crate::wire::message_id::HEARTBEAT;
use std::pin::Pin;
use std::time::Duration;

use super::OnboardError;
use crate::autopilot::Stack;
use crate::fetch::{Dialogue, FetchError, Moment, Offer, Survey, Uptime};
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
/// A HEARTBEAT comes each second: of so many on a bad link one arrives.
const SILENT: Duration = Duration::from_secs(10);

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
    /// as its last HEARTBEAT says
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

    /// Who takes what is to be known meanwhile, and what it is about.
    pub(super) fn teller(&self) -> (fn(&Note), About) {
        (self.tell, About::Link(self.address.clone()))
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

    /// Waits for the vehicle to say from now on that it is disarmed: what an earlier HEARTBEAT said may be over.
    ///
    /// # Errors
    /// Those of [`talk`](Self::talk), [`OnboardError::Armed`] and [`OnboardError::Silent`].
    pub async fn expect_disarmed(&mut self) -> Result<(), OnboardError> {
        let system = self.vehicle.system;
        // what was received before tells of then
        while let Ok(Some(_)) = self.reader.try_receive() {}
        let until = self.start.elapsed() + SILENT;
        let mut listening = Listening { vehicle: self.vehicle, until, armed: None, is_over: false };
        self.talk(&mut listening, |_| Ok(Flow::On)).await?;
        match listening.armed {
            Some(false) => Ok(()),
            Some(true) => Err(OnboardError::Armed(system)),
            None => Err(OnboardError::Silent { system, within_s: SILENT.as_secs() }),
        }
    }

    /// Talks until the dialogue is done, and no longer than the vehicle is disarmed, which [`Self::expect_disarmed`] makes sure
    /// of before.
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
        if let Some(armed) = armed_by(self.vehicle, &frame) {
            self.armed = armed;
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

/// Whether the vehicle is armed, by a HEARTBEAT of its autopilot; `None` for another frame.
fn armed_by(vehicle: Vehicle, frame: &Frame<'_>) -> Option<bool> {
    let header = frame.header();
    let is_own = header.system == vehicle.system && header.component == vehicle.component;
    (is_own && header.message_id == HEARTBEAT).then(|| frame.payload().u8(BASE_MODE_AT) & ARMED != 0)
}

/// Listens for the vehicle's next HEARTBEAT.
struct Listening {
    vehicle: Vehicle,
    until: Duration,
    /// as it says
    armed: Option<bool>,
    is_over: bool,
}

impl Dialogue for Listening {
    fn poll(&mut self, now: Duration) -> Result<Option<MavMessage>, FetchError> {
        self.is_over |= now > self.until;
        Ok(None)
    }

    fn take(&mut self, _now: Duration, frame: &Frame<'_>) {
        self.armed = self.armed.or_else(|| armed_by(self.vehicle, frame));
    }

    fn is_done(&self) -> bool {
        self.is_over || self.armed.is_some()
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::autopilot::Autopilot;
    use crate::wire::{ComponentId, CrcSeeds, checksum};

    /// A HEARTBEAT of a multirotor: component, base mode.
    fn beat(component: u8, base_mode: u8) -> Vec<u8> {
        let mut frame = vec![0xFD, 9, 0, 0, 0, 1, component, 0, 0, 0];
        frame.extend([0, 0, 0, 0, 2, 3, base_mode, 3, 3]);
        let sum = checksum(&frame[1..], CrcSeeds::new().get(0).unwrap());
        frame.extend(sum.to_le_bytes());
        frame
    }

    /// What was heard of these within 10 s.
    fn heard(beats: &[Vec<u8>]) -> (Option<bool>, bool) {
        let vehicle = Vehicle {
            system: SystemId(1),
            component: ComponentId(1),
            autopilot: Autopilot::ArduPilot,
            kind: None,
        };
        let mut listening = Listening { vehicle, until: SILENT, armed: None, is_over: false };
        for beat in beats {
            assert_eq!(listening.poll(Duration::from_secs(9)), Ok(None), "nothing is asked");
            listening.take(Duration::from_secs(9), &Frame::at_start(beat).unwrap());
        }
        listening.poll(SILENT + TICK).unwrap();
        (listening.armed, listening.is_done())
    }

    #[test]
    fn parameters_are_set_only_after_the_vehicle_said_that_it_is_disarmed() {
        assert_eq!(heard(&[beat(1, 81)]), (Some(false), true));
        assert_eq!(heard(&[beat(1, 209)]), (Some(true), true));
        // another component's word does not count, and silence is no answer
        assert_eq!(heard(&[beat(9, 81), beat(1, 209)]), (Some(true), true));
        assert_eq!(heard(&[beat(9, 81)]), (None, true));
        let armed = OnboardError::Armed(SystemId(1)).to_string();
        assert!(armed.contains("Land and disarm it, then give the same command again"), "{armed}");
    }
}
