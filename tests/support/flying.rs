//! A flight and the embedded vehicle on one clock, with what may lie between them. No sockets, no real time.

#![allow(dead_code, reason = "each test binary uses a part")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test ends where it fails")]

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Duration;

use mavid::autopilot::Autopilot;
use mavid::config::read_vehicle;
use mavid::fly::parameters::Parameters;
use mavid::fly::{
    Action, Around, Cause, Course, Event, Feeding, FirstQuestion, Flight, FollowLaw, Note, Outcome, Setpoint,
    SetpointBounds, Settings, Sortie, Streamed, Streamer,
};
use mavid::sitl::{Firmware, LinkId, LinkRole, Settings as VehicleSettings, Vehicle};
use mavid::trajectory::{FourierAxis, FourierTrajectory};
use mavid::vehicle::Limits;
use mavid::wire::{Frame, Nonce};
use mavlink::dialects::ardupilotmega::{MavMessage, TIMESYNC_DATA};
use mavlink::{MAVLinkV2MessageRaw, MavHeader};
use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use tracing_subscriber::layer::SubscriberExt;
use tracing_subscriber::util::SubscriberInitExt;

/// Between two looks at the clock.
const STEP: Duration = Duration::from_millis(10);

/// Events of flights are written by this program's subscriber; one for all of its tests.
pub fn write_events() {
    static SUBSCRIBER: std::sync::Once = std::sync::Once::new();
    SUBSCRIBER.call_once(|| tracing_subscriber::registry().with(mavid::fly::event_layer()).init());
}

/// What lies between two ends: loss, delay, and delay that differs from frame to frame.
pub struct Way {
    pub loss: f64,
    pub delay: Duration,
    pub jitter: Duration,
    random: Pcg64,
    under_way: BTreeMap<(Duration, u64), Vec<u8>>,
    count: u64,
}

impl Way {
    fn new(seed: u64) -> Self {
        Self {
            loss: 0.0,
            delay: Duration::ZERO,
            jitter: Duration::ZERO,
            random: Pcg64::seed_from_u64(seed),
            under_way: BTreeMap::new(),
            count: 0,
        }
    }

    pub fn reseed(&mut self, seed: u64) {
        self.random = Pcg64::seed_from_u64(seed);
    }

    fn give(&mut self, now: Duration, frame: Vec<u8>) {
        if self.random.random::<f64>() < self.loss {
            return;
        }
        self.count += 1;
        let arrives = now + self.delay + self.jitter.mul_f64(self.random.random::<f64>());
        self.under_way.insert((arrives, self.count), frame);
    }

    fn take(&mut self, now: Duration) -> Vec<Vec<u8>> {
        let later = self.under_way.split_off(&(now + Duration::from_nanos(1), 0));
        std::mem::replace(&mut self.under_way, later).into_values().collect()
    }
}

/// One flight.
pub struct Flying {
    pub flight: Flight,
    pub vehicle: Vehicle,
    pub now: Duration,
    pub notes: Vec<Note>,
    pub outcome: Option<Outcome>,
    /// with the time at which each was sent
    pub setpoints: Vec<(Duration, Setpoint)>,
    /// number and parameters of each command sent, with its time
    pub commands: Vec<(Duration, u32, [f32; 7])>,
    pub up: Way,
    pub down: Way,
    /// frames of these messages get lost on their way down
    pub swallowed: Vec<u32>,
    /// answers to TIMESYNC name a stranger as their addressee
    pub misaddressed: bool,
    /// what the stream has to tell the flight
    stalled: Option<Duration>,
    streamer: Streamer,
    link: LinkId,
    sequence: u8,
    /// of the vehicle's last frame
    pub heard_sequence: u8,
    /// MAV_STATE of its last HEARTBEAT
    pub system_status: u8,
}

const TIMESYNC: u32 = 111;

/// The same TIMESYNC with the addressee 5, 2.
fn to_a_stranger(bytes: &[u8]) -> Vec<u8> {
    let frame = Frame::at_start(bytes).unwrap();
    let (head, payload) = (frame.header(), frame.payload());
    let message = MavMessage::TIMESYNC(TIMESYNC_DATA {
        tc1: payload.u64(0).cast_signed(),
        ts1: payload.u64(8).cast_signed(),
        target_system: 5,
        target_component: 2,
    });
    let header =
        MavHeader { system_id: u32::from(bytes[5]), component_id: bytes[6], sequence: head.sequence };
    let mut raw = MAVLinkV2MessageRaw::new();
    raw.serialize_message(header, &message);
    raw.raw_bytes().to_vec()
}

/// A lively trajectory of a few seconds.
pub fn series() -> FourierTrajectory {
    let axis = |a: f64, b: f64, c: f64| FourierAxis { a: vec![a, 0.3 * b], b: vec![b, -0.2 * a], c };
    FourierTrajectory {
        period_s: 6.0,
        axes: [axis(0.5, 0.3, 0.0), axis(-0.3, 0.6, 0.0), axis(0.2, 0.1, 1.5), axis(0.1, 0.1, 0.0)],
    }
}

pub const AROUND: Around = Around {
    takeoff: [0.0, 0.0, 1.5, 0.0],
    landing: [0.0, 0.0, 1.5, 0.0],
    to_start_s: 3.0,
    to_landing_s: 3.0,
};

pub fn vehicle_settings(kind: Firmware) -> VehicleSettings {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/x500.toml");
    let vehicle = read_vehicle(&file).unwrap().vehicle;
    VehicleSettings {
        warm_up: Some(Duration::from_secs(2)),
        nonce: Some(Nonce::random()),
        ..VehicleSettings::new(vehicle, kind)
    }
}

pub fn sortie(vehicle: &VehicleSettings) -> Sortie {
    let stated = vehicle.vehicle.limits;
    // its file's floor is above the series' lowest place, and its walls are too near
    let limits = Limits { x_max_m: Some(3.0), y_max_m: Some(3.0), z_min_m: Some(0.7), ..stated };
    let course = Course::new(&series(), 3, Some(&AROUND), &limits, &vehicle.vehicle).unwrap();
    Sortie {
        course,
        limits,
        gravity_m_s2: vehicle.vehicle.gravity_m_s2,
        system: None,
        may_arm: false,
        own_vehicle: vehicle.nonce,
        settings: Settings {
            ready_timeout: Duration::from_secs(30),
            first_question: FirstQuestion::of_seed(1),
            // the steps of this clock
            setpoint_period: Duration::from_millis(20),
            ..Settings::default()
        },
    }
}

impl Flying {
    pub fn new(settings: VehicleSettings, change: impl FnOnce(&mut Sortie)) -> Self {
        let mut sortie = sortie(&settings);
        change(&mut sortie);
        let mut vehicle = Vehicle::new(settings).unwrap();
        let link = vehicle.open_link(LinkRole::GroundStation);
        Self {
            streamer: Streamer::new(sortie.settings.setpoint_period),
            flight: Flight::new(sortie),
            vehicle,
            now: Duration::ZERO,
            notes: Vec::new(),
            outcome: None,
            setpoints: Vec::new(),
            commands: Vec::new(),
            up: Way::new(1),
            down: Way::new(2),
            swallowed: Vec::new(),
            misaddressed: false,
            stalled: None,
            link,
            sequence: 0,
            heard_sequence: 0,
            system_status: 0,
        }
    }

    /// Setpoints are places ahead, as the checks before a flight choose them for an ArduPilot in a small room.
    pub fn places_ahead(&mut self) {
        let values = [("WP_ACC".to_owned(), 2.5)].into();
        let parameters = Parameters { autopilot: Autopilot::ArduPilot, values, ..Parameters::default() };
        let law = FollowLaw::of(&parameters, None).remove(0);
        let room = SetpointBounds::room(&self.flight.sortie().limits, &Vector3::zeros());
        self.event(Event::Feed(Feeding::ahead(law, 0.0, room)));
    }

    pub fn of(kind: Firmware) -> Self {
        Self::new(vehicle_settings(kind), |_| {})
    }

    fn send(&mut self, message: &MavMessage) {
        if let MavMessage::COMMAND_LONG(data) = message {
            let parameters =
                [data.param1, data.param2, data.param3, data.param4, data.param5, data.param6, data.param7];
            self.commands.push((self.now, data.command as u32, parameters));
        }
        let mut raw = MAVLinkV2MessageRaw::new();
        let header = MavHeader { system_id: 255, component_id: 190, sequence: self.sequence };
        raw.serialize_message(header, message);
        self.sequence = self.sequence.wrapping_add(1);
        self.up.give(self.now, raw.raw_bytes().to_vec());
    }

    fn act(&mut self) {
        while let Some(action) = self.flight.next_action() {
            match action {
                Action::Send(message) => self.send(&message),
                Action::Note(note) => self.notes.push(note),
                Action::Finished(outcome) => self.outcome = Some(outcome),
            }
        }
    }

    /// Something happens to the flight now.
    pub fn event(&mut self, event: Event<'_>) {
        self.flight.handle(self.now, event);
        self.act();
    }

    /// Ten milliseconds; the flight is not looked after where `alive` is false.
    pub fn step(&mut self, alive: bool) {
        self.now += STEP;
        for bytes in self.up.take(self.now) {
            self.vehicle.receive(self.link, &bytes, self.now);
        }
        for outgoing in self.vehicle.advance(self.now) {
            let id = Frame::at_start(&outgoing.bytes).unwrap().header().message_id;
            if outgoing.link == self.link && !self.swallowed.contains(&id) {
                let is_answer = self.misaddressed && id == TIMESYNC;
                let bytes = if is_answer { to_a_stranger(&outgoing.bytes) } else { outgoing.bytes };
                self.down.give(outgoing.time, bytes);
            }
        }
        if alive {
            if let Some(gap) = self.stalled.take() {
                self.event(Event::Stalled(gap));
            }
            for bytes in self.down.take(self.now) {
                let frame = Frame::at_start(&bytes).unwrap();
                self.heard_sequence = frame.header().sequence;
                if frame.header().message_id == 0 {
                    self.system_status = frame.payload().u8(7);
                }
                self.event(Event::Frame(frame));
            }
            self.event(Event::Tick);
        }
        self.stream();
    }

    /// A message of the vehicle that somebody else asked for, and that comes down beside ours.
    pub fn overhear(&mut self, message: &MavMessage) {
        let mut raw = MAVLinkV2MessageRaw::new();
        let header =
            MavHeader { system_id: 1, component_id: 1, sequence: self.heard_sequence.wrapping_add(1) };
        raw.serialize_message(header, message);
        self.down.give(self.now, raw.raw_bytes().to_vec());
    }

    fn stream(&mut self) {
        match self.streamer.poll(self.now, self.flight.guide()) {
            Some(Streamed::Setpoint(setpoint, message)) => {
                self.setpoints.push((self.now, setpoint));
                self.send(&message);
            }
            Some(Streamed::Stalled(gap)) => self.stalled = Some(gap),
            Some(Streamed::Unfit(why)) => panic!("{why}"),
            None => {}
        }
    }

    /// Time goes on until `done`, at most by so many seconds.
    pub fn until(&mut self, seconds: f64, what: &str, mut done: impl FnMut(&Self) -> bool) {
        let end = self.now + Duration::from_secs_f64(seconds);
        while !done(self) {
            assert!(self.now < end, "{what} not within {seconds} s: {}", self.story());
            self.step(true);
        }
    }

    pub fn wait(&mut self, seconds: f64) {
        let end = self.now + Duration::from_secs_f64(seconds);
        while self.now < end {
            self.step(true);
        }
    }

    pub fn phase(&self) -> &'static str {
        self.flight.status(self.now).phase
    }

    /// Until `seconds` into the trajectory.
    pub fn fly_into_the_trajectory(&mut self, seconds: f64) {
        self.until(120.0, "trajectory", |flying| flying.phase() == "trajectory");
        self.wait(seconds);
        assert_eq!(self.phase(), "trajectory", "{}", self.story());
    }

    /// Until the flight is over.
    pub fn finish(&mut self) -> Outcome {
        self.until(400.0, "an end", |flying| flying.outcome.is_some());
        self.outcome.clone().unwrap()
    }

    pub fn cause(&self) -> Cause {
        self.outcome.clone().and_then(|outcome| outcome.cause).unwrap()
    }

    /// All that was noted.
    pub fn story(&self) -> String {
        let lines: Vec<String> = self
            .notes
            .iter()
            .map(|note| format!("{:7.2} {:?} {}: {}", note.time_s, note.level, note.kind, note.text))
            .collect();
        format!("at {:?}\n{}\n{:?}", self.now, lines.join("\n"), self.flight.status(self.now))
    }

    /// Commands of a kind sent after a time.
    pub fn commands_since(&self, number: u32, since: Duration) -> usize {
        self.commands.iter().filter(|(at, command, _)| *at > since && *command == number).count()
    }

    /// Setpoints sent after a time.
    pub fn setpoints_since(&self, since: Duration) -> usize {
        self.setpoints.iter().filter(|(at, _)| *at > since).count()
    }
}
