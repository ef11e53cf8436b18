//! The vehicle as a whole: the clock that drives it, and its links.

use crate::wire::heartbeat::HEARTBEAT_PERIOD;
use std::time::Duration;

use mavlink::dialects::ardupilotmega::{
    HEARTBEAT_DATA, MavAutopilot, MavModeFlag, MavSeverity, MavState, MavType,
};
use nalgebra::Vector3;

use super::autopilot::Autopilot;
use super::craft::Craft;
use super::files::{FileServer, LogSender};
use super::link::Link;
use super::logger::{Keeper, Now};
use super::message::Message;
use super::parameters::{Parameters, Pulses};
use super::telemetry::{PROTOCOL, Snapshot, Telemetry};
use super::tuning::Tuning;
use super::upload::Upload;
use super::{Fault, LinkId, LinkRole, Mode, Outgoing, Settings, SitlError};
use crate::link::{Signing, SigningKey, time_of};
use crate::physics::MAX_ROTORS;
use crate::wire::message_id::HEARTBEAT;
use crate::wire::{Check, CrcSeeds, Frame, Payload};

/// MAV_COMP_ID_AUTOPILOT1
const COMPONENT: u8 = 1;

/// What somebody who stands beside a vehicle sees of it, whatever its messages say.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Beheld {
    /// the number of the mode that it flies, as HEARTBEAT.custom_mode
    pub custom_mode: u32,
    /// its rotors may turn
    pub armed: bool,
    /// it stands on the ground
    pub landed: bool,
}

/// A simulated vehicle.
#[derive(Debug)]
pub struct Vehicle {
    pub(super) settings: Settings,
    pub(super) parameters: Parameters,
    pub(super) autopilot: Autopilot,
    pub(super) links: Vec<Link>,
    craft: Craft,
    telemetry: Telemetry,
    pulses: Pulses,
    seeds: CrcSeeds,
    /// time of the next loop period, since the vehicle was made
    next_loop: Duration,
    /// the latest time that was heard of
    clock: Duration,
    booted: Duration,
    silent_until: Duration,
    snapshot: Option<Snapshot>,
    /// mode flown and mode asked for, as the links were told last
    told_mode: Option<(Mode, Mode)>,
    pub(super) texts: u16,
    /// signs what goes out, and what comes in is to be signed
    signing: Option<Signing>,
    /// the log of its own
    pub(super) keeper: Keeper,
    pub(super) file_server: FileServer,
    pub(super) log_sender: LogSender,
    /// a fence that comes in
    pub(super) upload: Option<Upload>,
}

impl Vehicle {
    /// A vehicle that boots now, standing on the ground, with no link.
    ///
    /// # Errors
    /// If vehicle, effects or a setting are not possible.
    pub fn new(settings: Settings) -> Result<Self, SitlError> {
        settings.check()?;
        let kind = settings.autopilot;
        let parameters = Parameters::new(&settings)?;
        let pulses = Pulses::of(&settings.vehicle, kind);
        let autopilot = Autopilot::new(&settings, Tuning::of(kind, &parameters))?;
        let keeper = Keeper::new(&settings, &parameters);
        let step = kind.loop_period() / kind.steps_a_loop();
        Ok(Self {
            craft: Craft::new(&settings, step)?,
            telemetry: Telemetry::new(&settings),
            autopilot,
            parameters,
            pulses,
            links: Vec::new(),
            seeds: CrcSeeds::new(),
            next_loop: Duration::ZERO,
            clock: Duration::ZERO,
            booted: Duration::ZERO,
            silent_until: Duration::ZERO,
            snapshot: None,
            told_mode: None,
            texts: 0,
            upload: None,
            keeper,
            file_server: FileServer::new(kind.is_px4()),
            log_sender: LogSender::new(kind.is_px4()),
            signing: settings
                .signing_key
                .clone()
                .map(|key| Signing::with_key_at(key, time_of(settings.boot_unix_us))),
            settings,
        })
    }

    /// A new connection.
    pub fn open_link(&mut self, role: LinkRole) -> LinkId {
        let id = LinkId(self.links.len());
        self.links.push(Link::new(id, self.settings.autopilot, role));
        id
    }

    /// Takes bytes that came in on a link at a time since the vehicle was made. Bytes may be cut anywhere;
    /// what follows from them comes out of [`Self::advance`].
    pub fn receive(&mut self, link: LinkId, bytes: &[u8], at: Duration) {
        self.clock = self.clock.max(at);
        let Some(splitter) = self.links.get_mut(link.0).map(|link| &mut link.splitter) else { return };
        if self.clock < self.silent_until {
            return;
        }
        splitter.feed(bytes);
        let mut frames = Vec::new();
        while let Some(frame) = splitter.next_frame() {
            if frame.check(&self.seeds) == Check::Right {
                frames.push(frame.bytes().to_vec());
            }
        }
        let now = self.now();
        for frame in &frames {
            match Frame::at_start(frame) {
                Some(frame)
                    if frame.header().system.0 != u32::from(self.settings.system)
                        && self.believes(link, &frame) =>
                {
                    self.handle(link.0, &frame, now);
                }
                _ => {}
            }
        }
    }

    /// With a key, what is signed with it. On its first link, where a cable is, ArduPilot believes everything.
    fn believes(&self, link: LinkId, frame: &Frame) -> bool {
        let Some(signing) = &self.signing else { return true };
        let trusted = !self.settings.autopilot.is_px4() && link.0 == 0;
        signing.verify_at(frame, self.signing_time()).is_ok() || trusted
    }

    fn signing_time(&self) -> u64 {
        let passed = u64::try_from(self.clock.as_micros()).unwrap_or(u64::MAX);
        time_of(self.settings.boot_unix_us.saturating_add(passed))
    }

    /// SETUP_SIGNING: ArduPilot takes the key from it, and none where it is zero; this PX4 has no signing to set up.
    pub(super) fn set_up_signing(&mut self, payload: Payload) {
        if self.settings.autopilot.is_px4() {
            return;
        }
        if self.autopilot.is_armed() {
            self.autopilot.say(MavSeverity::MAV_SEVERITY_WARNING, "ERROR: Won't setup signing when armed");
            return;
        }
        let key: [u8; 32] = std::array::from_fn(|byte| payload.u8(10 + byte));
        let begins = payload.u64(0);
        let is_key = begins != 0 || key.iter().any(|byte| *byte != 0);
        let time = begins.max(self.signing_time());
        self.signing = is_key.then(|| Signing::with_key_at(SigningKey::from_bytes(key), time));
    }

    /// Goes on until a time since the vehicle was made; returns what has arrived at the other ends by then,
    /// link by link in the order of its arrival. A time in the past changes nothing.
    pub fn advance(&mut self, to: Duration) -> Vec<Outgoing> {
        while self.next_loop <= to {
            self.clock = self.clock.max(self.next_loop);
            self.run_loop();
            self.next_loop += self.settings.autopilot.loop_period();
        }
        self.clock = self.clock.max(to);
        self.send_texts();
        let mut out = Vec::new();
        for link in &mut self.links {
            if self.clock < self.silent_until {
                link.drop_waiting();
            }
            link.arrived(self.clock, &mut out);
        }
        out
    }

    /// Time of the next loop period since the vehicle was made: nothing new happens by itself before.
    #[must_use]
    pub fn next_loop(&self) -> Duration {
        self.next_loop
    }

    /// The vehicle as it is now.
    #[must_use]
    pub fn beheld(&self) -> Beheld {
        Beheld {
            custom_mode: self.autopilot.mode.custom_mode(self.settings.autopilot).unwrap_or_default(),
            armed: self.autopilot.is_armed(),
            landed: self.autopilot.is_landed(),
        }
    }

    /// Something goes wrong from now on.
    pub fn fault(&mut self, fault: Fault) {
        let now = self.now();
        match fault {
            Fault::PilotTakesOver(mode) => {
                self.autopilot.safety.pilot_is_there();
                self.autopilot.set_mode(mode, now);
            }
            Fault::EstimatorJump(by_m) => {
                let by_m = Vector3::from(by_m);
                self.autopilot.estimator.jump(by_m);
                self.autopilot.guidance.shift(by_m);
            }
            Fault::EstimatorHealth(healthy) => self.autopilot.estimator.set_health(healthy),
            Fault::Battery(remaining) => self.autopilot.battery.set_remaining(remaining),
            Fault::RotorStops(rotor) => self.craft.stop_rotor(rotor),
            Fault::LinkSilence(duration) => self.silent_until = self.clock + duration,
            Fault::Reboot => self.reboot(),
            Fault::ForeignHeartbeat { system, component } => {
                let message = Message::from(HEARTBEAT_DATA {
                    custom_mode: 0,
                    mavtype: MavType::MAV_TYPE_GCS,
                    autopilot: MavAutopilot::MAV_AUTOPILOT_INVALID,
                    base_mode: MavModeFlag::empty(),
                    system_status: MavState::MAV_STATE_ACTIVE,
                    mavlink_version: PROTOCOL,
                });
                let frame = message.frame((0, system, component), None);
                self.pass_on(&frame, None);
            }
            Fault::Push { force_n, torque_nm, duration } => {
                self.craft.shove(force_n.into(), torque_nm.into(), duration.as_secs_f64());
            }
        }
    }

    /// Since boot.
    pub(super) fn now(&self) -> Duration {
        self.clock.saturating_sub(self.booted)
    }

    /// The host's time at the last boot, microseconds since 1970.
    fn boot_unix_us(&self) -> u64 {
        let booted = u64::try_from(self.booted.as_micros()).unwrap_or(u64::MAX);
        self.settings.boot_unix_us.saturating_add(booted)
    }

    fn run_loop(&mut self) {
        let now = self.next_loop.saturating_sub(self.booted);
        let kind = self.settings.autopilot;
        let period_s = kind.loop_period().as_secs_f64();
        self.craft.set_battery_v(self.autopilot.battery.volts());
        let wanted = self.autopilot.tick(&self.craft.motion(), now, period_s);
        let (pulses_us, outputs) = self.put_out(&wanted);
        let shown = self.craft.step(&outputs);
        for _ in 1..kind.steps_a_loop() {
            self.craft.step(&outputs);
        }
        let snapshot = Snapshot { now, shown, pulses_us };
        self.keeper.take(&Now {
            autopilot: &self.autopilot,
            snapshot: &snapshot,
            parameters: &self.parameters,
            boot_unix_us: self.boot_unix_us(),
        });
        self.snapshot = Some(snapshot);
        self.pursue_upload(now);
        let mode = (self.autopilot.mode, self.autopilot.intended);
        if self.told_mode.replace(mode) != Some(mode) {
            self.links.iter_mut().for_each(|link| link.streams.mode_changed());
        }
        self.send_texts();
        self.send_due(now);
        self.send_files();
    }

    /// Whole microseconds, and what the rotors make of them.
    fn put_out(&self, wanted: &[f64; MAX_ROTORS]) -> ([u16; MAX_ROTORS], [f64; MAX_ROTORS]) {
        let armed = self.autopilot.is_armed();
        let pulses = &self.pulses;
        let pulses_us = wanted.map(|u| if armed { pulses.pulse_us(u) } else { pulses.off_pulse_us() });
        let outputs = pulses_us.map(|pulse| if armed { pulses.output(pulse) } else { 0.0 });
        (pulses_us, outputs)
    }

    fn send_due(&mut self, now: Duration) {
        let beats = now.as_micros().is_multiple_of(HEARTBEAT_PERIOD.as_micros());
        for link in 0..self.links.len() {
            if beats {
                self.send_now(link, HEARTBEAT);
            }
            let downloading = self.links[link].is_downloading();
            for index in self.links[link].next_parameters(self.parameters.len()) {
                if let Some(message) = self.parameters.message(index) {
                    self.send(link, &message);
                }
            }
            for id in self.links[link].streams.due(now, downloading) {
                self.send_now(link, id);
            }
        }
    }

    /// The message of this id as it is now.
    pub(super) fn send_now(&mut self, link: usize, id: u32) {
        let Some(snapshot) = &self.snapshot else { return };
        if let Some(message) = self.telemetry.message(id, snapshot, &self.autopilot) {
            self.send(link, &message);
        }
    }

    pub(super) fn send(&mut self, link: usize, message: &Message) {
        let lost = self.settings.loss > 0.0 && self.telemetry.chance() < self.settings.loss;
        let time = self.signing_time();
        let Some(link) = self.links.get_mut(link) else { return };
        if lost {
            link.lose();
            return;
        }
        let arrives = self.clock + self.settings.latency;
        let signing = self.signing.as_ref().map(|signing| (signing, time));
        link.send(message, arrives, (self.settings.system, COMPONENT), signing);
    }

    pub(super) fn broadcast(&mut self, message: &Message) {
        for link in 0..self.links.len() {
            self.send(link, message);
        }
    }

    /// Passes a frame of another system on to every link but the one that it came from.
    pub(super) fn pass_on(&mut self, frame: &[u8], from: Option<usize>) {
        let arrives = self.clock + self.settings.latency;
        for (index, link) in self.links.iter_mut().enumerate() {
            if from != Some(index) {
                link.pass_on(frame, arrives);
            }
        }
    }

    /// The target of a message is this autopilot, or everyone.
    pub(super) fn is_for_us(&self, (system, component): (u8, u8)) -> bool {
        (system == 0 || system == self.settings.system) && (component == 0 || component == COMPONENT)
    }

    /// Parameters have changed.
    pub(super) fn retune(&mut self) {
        self.autopilot.tuning = Tuning::of(self.settings.autopilot, &self.parameters);
    }

    /// The autopilot restarts from the next loop period; parameters and the vehicle's motion stay.
    pub(super) fn reboot(&mut self) {
        let tuning = self.autopilot.tuning;
        // what could be built once can be built again
        if let Ok(autopilot) = Autopilot::new(&self.settings, tuning) {
            self.autopilot = autopilot;
        }
        self.booted = self.next_loop;
        self.upload = None;
        self.keeper.reboot(&self.parameters);
        for link in &mut self.links {
            link.restart(self.settings.autopilot);
        }
    }
}
