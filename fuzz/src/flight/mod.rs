//! The flight as a state machine, against a small vehicle: frames with right checksums, forged or not, pilots,
//! silences, stalls, keys, in any order.

mod laws;
mod vehicle;

use std::collections::VecDeque;
use std::sync::LazyLock;
use std::time::Duration;

use mavid::autopilot::{Autopilot, Mode};
use mavid::config::parse_vehicle;
use mavid::fly::parameters::Parameters;
use mavid::fly::{
    Action, Around, Course, Event, FirstQuestion, Flight, Key, Lift, Setpoint, Settings, Sortie, Streamed,
    Streamer,
};
use mavid::trajectory::{FourierAxis, FourierTrajectory};
use mavid::wire::Frame;
use mavlink::dialects::ardupilotmega::MavMessage;

use super::bytes::Bytes;
use super::frames::{From, VEHICLE, frame, v2};
use laws::Laws;
use vehicle::{SET_MODE, Vehicle, command_of, modes};

const STEP: Duration = Duration::from_millis(20);
/// No input goes on for longer.
const LONGEST: Duration = Duration::from_secs(150);
/// Message ids of which much is made: all that the flight reads.
const IDS: [u32; 20] = [0, 1, 22, 24, 30, 31, 32, 36, 77, 82, 84, 85, 86, 147, 148, 193, 230, 245, 253, 331];
const SENDERS: [(u8, u8); 5] = [VEHICLE, VEHICLE, (1, 2), (7, 1), (255, 190)];
const PHASES: [&str; 8] =
    ["connect", "check", "engage", "take off", "go to start", "trajectory", "trajectory", "land"];
const X500: &str = include_str!("../../../configs/x500.toml");

/// A flight as ordered, made once.
static SORTIE: LazyLock<(Sortie, Lift)> = LazyLock::new(|| {
    let vehicle = parse_vehicle(X500, "x500").expect("a vehicle of the project").vehicle;
    let axis = |a: f64, b: f64, c: f64| FourierAxis { a: vec![a], b: vec![b], c };
    let series = FourierTrajectory {
        period_s: 4.0,
        axes: [axis(0.3, 0.2, 0.0), axis(-0.2, 0.3, 0.0), axis(0.1, 0.1, 1.2), axis(0.1, 0.0, 0.0)],
    };
    let hover = [0.0, 0.0, 1.2, 0.0];
    let around = Around { takeoff: hover, landing: hover, to_start_s: 2.0, to_landing_s: 2.0 };
    let course = Course::new(&series, 3, Some(&around), &vehicle.limits, &vehicle).expect("a course");
    let settings = Settings {
        ready_timeout: Duration::from_secs(20),
        reach_timeout: Duration::from_secs(10),
        hold_then_land: Duration::from_secs(4),
        watch_max: Duration::from_secs(20),
        gone_after: Duration::from_secs(15),
        await_clearance: true,
        first_question: FirstQuestion::of_seed(1),
        ..Settings::default()
    };
    let lift = Lift::new(&vehicle, &Parameters::default());
    let (limits, gravity_m_s2) = (vehicle.limits, vehicle.gravity_m_s2);
    (Sortie { course, limits, gravity_m_s2, system: None, may_arm: true, own_vehicle: None, settings }, lift)
});

/// The whole of it.
struct World {
    flight: Flight,
    streamer: Streamer,
    vehicle: Vehicle,
    laws: Laws,
    now: Duration,
    over: bool,
    /// no frame comes down, none goes up, until then
    silent: [Duration; 2],
    /// what lies in the socket
    socket: VecDeque<Vec<u8>>,
    /// what the stream has to tell the supervisor
    stalled: Option<Duration>,
    cleared: bool,
    /// the last command that asked for a mode
    last: Option<MavMessage>,
    seeded: bool,
}

/// A phase to begin in, then whatever the script says.
pub fn run(data: &[u8], seeded: bool) {
    let mut script = Bytes::new(data);
    let first = script.u8();
    let stack = if first & 1 == 0 { Autopilot::Px4 } else { Autopilot::ArduPilot };
    let mut world = World::new(stack, seeded);
    let until = PHASES[usize::from(first >> 1) % PHASES.len()];
    while world.flight.status(world.now).phase != until && world.now < Duration::from_secs(60) {
        world.step(true, true);
    }
    assert!(world.now < Duration::from_secs(60), "no {until}: {:?}", world.flight.status(world.now));
    while !script.is_empty() && !world.over && world.now < LONGEST {
        world.happens(&mut script);
        world.step(true, true);
    }
    // what was begun goes on for a while
    for _ in 0..150 {
        world.step(true, true);
    }
}

impl World {
    fn new(stack: Autopilot, seeded: bool) -> Self {
        let sortie = SORTIE.0.clone();
        Self {
            streamer: Streamer::new(sortie.settings.setpoint_period),
            flight: Flight::new(sortie),
            vehicle: Vehicle::new(stack),
            laws: Laws::new(stack),
            now: Duration::ZERO,
            over: false,
            silent: [Duration::ZERO; 2],
            socket: VecDeque::new(),
            stalled: None,
            cleared: false,
            last: None,
            seeded,
        }
    }

    /// One thing of the script.
    fn happens(&mut self, script: &mut Bytes<'_>) {
        let modes = modes(self.vehicle.stack);
        match script.u8() % 16 {
            0..=3 => (0..script.u8() % 64).for_each(|_| self.step(true, true)),
            4 | 5 => self.forge(script),
            6 => self.vehicle.mode = script.one_of(&modes.pilot),
            7 => self.silent[0] = self.now + Duration::from_millis(40) * script.u8().into(),
            8 => self.silent[1] = self.now + Duration::from_millis(40) * script.u8().into(),
            9 => self.stall(script),
            10 => self.key(script.u8()),
            11 => self.link(script.u8() & 1 == 0),
            12 => match script.u8() % 4 {
                0 => self.vehicle.armed = false,
                1 => self.vehicle.jump_m += f64::from(script.u8()) / 16.0 - 8.0,
                2 => self.vehicle.booted = self.now,
                _ => self.vehicle.battery_percent = script.u8() % 101,
            },
            13 if script.u8().is_multiple_of(4) => self.event(Event::Stop("a signal".to_owned())),
            14 => {
                self.vehicle.mode =
                    [modes.hold, modes.land, modes.home, modes.external][usize::from(script.u8() % 4)]
            }
            _ => self.vehicle.position_m.x += f64::from(script.u8()) / 32.0 - 4.0,
        }
    }

    /// A frame with a right checksum that somebody made.
    fn forge(&mut self, script: &mut Bytes<'_>) {
        let sender = script.one_of(&SENDERS);
        let id = match script.u8() {
            255 => script.u32() & 0xFF_FFFF,
            index => IDS[usize::from(index) % IDS.len()],
        };
        let odd_number = script.u8();
        let payload = script.piece();
        let bytes = if sender == VEHICLE && odd_number < 240 {
            self.vehicle.say(id, payload)
        } else {
            self.laws.out_of_order |= sender == VEHICLE;
            v2(id, From { sender, sequence: odd_number }, payload)
        };
        self.socket.push_back(bytes);
    }

    /// The program, or its supervisor alone, stands still.
    fn stall(&mut self, script: &mut Bytes<'_>) {
        let (steps, what) = (script.u8() % 100, script.u8());
        if what & 4 != 0 {
            self.vehicle.mode = script.one_of(&modes(self.vehicle.stack).pilot);
        }
        (0..steps).for_each(|_| self.step(false, what & 1 == 0));
    }

    fn key(&mut self, key: u8) {
        self.laws.ordered(self.now, key % 8 > 6);
        let key = match key % 8 {
            0..=3 => Key::Abort,
            4 => Key::To(Mode::Hold),
            5 => Key::To(Mode::Land),
            6 => Key::To(Mode::Return),
            _ => Key::Kill,
        };
        self.event(Event::Key(key));
    }

    /// The link is lost or there again. The seeded bug: with its loss the last command goes out once more.
    fn link(&mut self, up: bool) {
        self.event(Event::Link(up));
        if let Some(last) = self.last.clone().filter(|_| self.seeded && !up) {
            self.send(&last);
        }
    }

    fn event(&mut self, event: Event<'_>) {
        self.flight.handle(self.now, event);
        self.act();
    }

    fn act(&mut self) {
        while let Some(action) = self.flight.next_action() {
            assert!(!self.over || matches!(action, Action::Note(_)), "{action:?} after the end");
            match action {
                Action::Send(message) => self.send(&message),
                Action::Note(_) => {}
                Action::Finished(outcome) => {
                    self.over = true;
                    assert!(self.flight.is_over() && outcome.flown.tilt_max_deg.is_finite());
                }
            }
        }
        let status = self.flight.status(self.now);
        self.laws.phase(status.phase);
    }

    fn send(&mut self, message: &MavMessage) {
        self.laws.sent(self.now, message);
        if let MavMessage::TIMESYNC(question) = message
            && self.now >= self.silent[1]
        {
            let answer = self.vehicle.answer(question.ts1);
            self.arrive(vec![answer]);
        }
        let Some(command) = command_of(message) else { return };
        if command.command as u32 == SET_MODE {
            self.laws.asked_for(self.vehicle.asked_for(command));
            self.last = Some(message.clone());
        }
        if self.now < self.silent[1] {
            return;
        }
        let answers = self.vehicle.obey(command);
        self.arrive(answers);
    }

    fn arrive(&mut self, frames: Vec<Vec<u8>>) {
        if self.now >= self.silent[0] {
            self.socket.extend(frames);
        }
    }

    /// One step of time; the supervisor and the stream are looked after where they are alive.
    fn step(&mut self, supervised: bool, streamed: bool) {
        if self.over {
            return;
        }
        self.now += STEP;
        let said = self.vehicle.advance(self.now, STEP);
        self.arrive(said);
        if supervised {
            if let Some(gap) = self.stalled.take() {
                self.event(Event::Stalled(gap));
            }
            while let Some(bytes) = self.socket.pop_front() {
                self.hear(&frame(&bytes));
            }
            self.event(Event::Tick);
            if !self.cleared && self.flight.wants_clearance() {
                self.cleared = true;
                self.event(Event::Cleared(Ok(Box::new(SORTIE.1.clone()))));
            }
        }
        if streamed && !self.over {
            self.stream();
        }
    }

    fn hear(&mut self, frame: &Frame<'_>) {
        if self.over {
            return;
        }
        let header = frame.header();
        if (header.system.0, header.component.0) == (VEHICLE.0.into(), VEHICLE.1) {
            self.laws.reported(self.now, frame);
        }
        self.event(Event::Frame(*frame));
    }

    fn stream(&mut self) {
        match self.streamer.poll(self.now, self.flight.guide()) {
            Some(Streamed::Setpoint(setpoint, message)) => self.send_setpoint(&setpoint, &message),
            Some(Streamed::Stalled(gap)) => self.stalled = Some(gap),
            // nothing is sent; the flight finds the same and ends
            Some(Streamed::Unfit(_)) | None => {}
        }
    }

    fn send_setpoint(&mut self, setpoint: &Setpoint, message: &MavMessage) {
        Laws::made(setpoint);
        self.laws.sent(self.now, message);
        if self.now >= self.silent[1] {
            self.vehicle.follow(setpoint);
        }
    }
}
