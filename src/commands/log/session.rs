//! A vehicle on a link, with which one talks.

use std::time::Duration;

use mavid::autopilot::Stack;
use mavid::fetch::{Dialogue, Moment, Offer, Survey, Uptime};
use mavid::fly::{Choice, Roster, heartbeat};
use mavid::link::{LinkEvent, LinkOptions, LinkReader, LinkWriter, Received, Signing};
use mavid::wire::{Frame, SystemId, Vehicle};
use tokio::time::{Instant, MissedTickBehavior, interval};

use crate::cli::VehicleLinkArgs;
use crate::commands::{CommandError, network, output};

/// Between two looks at what is due.
const TICK: Duration = Duration::from_millis(5);
const HEARTBEAT: Duration = Duration::from_secs(1);
/// HEARTBEAT, where its base mode is, and the bit of an armed vehicle.
const HEARTBEAT_ID: u32 = 0;
const BASE_MODE: usize = 6;
const ARMED: u8 = 128;
/// A vehicle that is not heard within this is not there.
const THERE_WITHIN: Duration = Duration::from_secs(30);

/// Whether a conversation goes on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Flow {
    /// it does
    On,
    /// enough
    Stop,
}

/// A vehicle on a link.
#[derive(Debug)]
pub struct Session {
    reader: LinkReader,
    writer: LinkWriter,
    signals: network::Signals,
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
    /// Opens the link and waits for the vehicle; one that is armed is refused. A host that refuses is not waited for.
    pub async fn open(args: &VehicleLinkArgs) -> Result<Self, CommandError> {
        Self::begin(args, LinkOptions::default(), THERE_WITHIN).await
    }

    /// The same by this station, for a vehicle that has to be heard within this time: its host may still refuse.
    pub async fn open_as(
        args: &VehicleLinkArgs,
        station: SystemId,
        patience: Duration,
    ) -> Result<Self, CommandError> {
        let options = LinkOptions { system: station, patient: true, ..LinkOptions::default() };
        Self::begin(args, options, patience).await
    }

    async fn begin(
        args: &VehicleLinkArgs,
        options: LinkOptions,
        patience: Duration,
    ) -> Result<Self, CommandError> {
        let address = network::address("--connect", &args.connect)?;
        let signing = args.signing_key_file.as_deref().map(Signing::open).transpose();
        let signing = signing.map_err(|error| CommandError::Input(error.to_string()))?;
        output::signing_warnings(signing.as_ref());
        let options = LinkOptions { signing, ..options };
        let (mut reader, writer) = network::open(&address, options).await?;
        let (start, mut signals) = (Instant::now(), network::Signals::new()?);
        let wanted = args.system_id.map(SystemId);
        let mut roster = Roster::default();
        let mut absent = None;
        let mut beats = interval(HEARTBEAT);
        loop {
            tokio::select! {
                received = reader.receive() => {
                    match received.map_err(|error| CommandError::Failure(error.to_string()))? {
                        Received::Frame(frame) => {
                            if let Some(frame) = Frame::at_start(frame.bytes()) {
                                roster.hear(start.elapsed(), frame);
                            }
                        }
                        Received::Event(event) => note_absence(&args.connect, &event, &mut absent),
                    }
                }
                _ = beats.tick() => {
                    // while nobody is there, there is nobody to tell
                    let _ = writer.send_message(&heartbeat());
                }
                name = signals.next() => return Err(interrupted(name?)),
            }
            match roster.choose(start.elapsed(), wanted) {
                Choice::Vehicle(vehicle, _, stack) => {
                    return Ok(Self {
                        reader,
                        writer,
                        signals,
                        start,
                        armed: false,
                        only_disarmed: false,
                        vehicle,
                        stack,
                    });
                }
                Choice::Refuse(why) => return Err(CommandError::Input(why)),
                Choice::Wait if start.elapsed() > patience => {
                    return Err(CommandError::Failure(format!(
                        "{}: expected a HEARTBEAT of a vehicle within {} s, heard {}",
                        args.connect,
                        patience.as_secs(),
                        absent.map_or_else(|| roster.heard(), |why| format!("nobody ({why})"))
                    )));
                }
                Choice::Wait => {}
            }
        }
    }

    /// What the vehicle offers.
    pub async fn offer(&mut self) -> Result<Offer, CommandError> {
        let mut survey = Survey::new(self.vehicle);
        self.talk(&mut survey, |_| Ok(Flow::On)).await?;
        Ok(survey.offer())
    }

    /// Now, with the vehicle's time since its start.
    pub async fn moment(&mut self) -> Result<Moment, CommandError> {
        let mut uptime = Uptime::new(self.vehicle);
        self.talk(&mut uptime, |_| Ok(Flow::On)).await?;
        Ok(Moment::now(uptime.up_s()))
    }

    /// Talks until the dialogue is done, or `each` has enough, which is asked again and again.
    pub async fn talk<D: Dialogue>(
        &mut self,
        dialogue: &mut D,
        mut each: impl FnMut(&mut D) -> Result<Flow, CommandError>,
    ) -> Result<Flow, CommandError> {
        let mut ticks = interval(TICK);
        ticks.set_missed_tick_behavior(MissedTickBehavior::Skip);
        let mut beat = None;
        loop {
            if self.only_disarmed && self.armed {
                let system = self.vehicle.system;
                return Err(CommandError::Failure(format!(
                    "system {system} was armed meanwhile: expected it disarmed while its parameters are set"
                )));
            }
            let now = self.start.elapsed();
            if beat.is_none_or(|beat| now.saturating_sub(beat) >= HEARTBEAT) {
                beat = Some(now);
                let _ = self.writer.send_message(&heartbeat());
            }
            while let Some(message) =
                dialogue.poll(now).map_err(|error| CommandError::Failure(error.to_string()))?
            {
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
                    let received = received.map_err(|error| CommandError::Failure(error.to_string()))?;
                    self.take(dialogue, received);
                    while let Ok(Some(received)) = self.reader.try_receive() {
                        self.take(dialogue, received);
                    }
                }
                _ = ticks.tick() => {}
                name = self.signals.next() => return Err(interrupted(name?)),
            }
        }
    }

    /// Talks until the dialogue is done, and no longer than the vehicle is disarmed.
    pub async fn talk_disarmed(&mut self, dialogue: &mut impl Dialogue) -> Result<(), CommandError> {
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
        if is_own && header.message_id == HEARTBEAT_ID {
            self.armed = frame.payload().u8(BASE_MODE) & ARMED != 0;
        }
        dialogue.take(self.start.elapsed(), &frame);
    }

    /// The last message of a conversation, which nobody answers.
    pub async fn say(&self, message: &mavlink::dialects::ardupilotmega::MavMessage) {
        let _ = self.writer.send_message(message);
        let _ = tokio::time::timeout(Duration::from_millis(500), self.writer.flush()).await;
    }

    /// By which name the vehicle is known from one run to the next: two simulated ones may say the same number.
    pub fn known_as(&self, offer: &Offer) -> String {
        let name = format!("{}-system-{}", self.stack.id, self.vehicle.system);
        offer.uid.iter().fold(name, |name, uid| format!("{name}-{uid}"))
    }

    /// Since the link was opened.
    pub fn elapsed(&self) -> Duration {
        self.start.elapsed()
    }
}

/// Says once that nobody is at the other end.
fn note_absence(connect: &str, event: &LinkEvent, absent: &mut Option<String>) {
    match event {
        LinkEvent::Waiting { why } => {
            if absent.is_none() {
                output::message(&format!("{connect}: {event}"));
            }
            *absent = Some(why.clone());
        }
        LinkEvent::Connected { .. } | LinkEvent::Restored { .. } => *absent = None,
        _ => {}
    }
}

fn interrupted(name: &str) -> CommandError {
    CommandError::Ended(format!("ended by {name}"))
}
