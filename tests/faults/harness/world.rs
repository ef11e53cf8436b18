//! Vehicle, network and program on one clock, and what goes wrong with them.

use std::collections::{BTreeMap, VecDeque};
use std::time::Duration;

use mavid::autopilot::Mode as Ours;
use mavid::fly::Key;
use mavid::sitl::{Beheld, Fault, Firmware, LinkId, Mode, Vehicle};
use mavid::wire::CrcSeeds;
use rand::RngExt;
use rand_pcg::Pcg64;
use tokio::runtime::{Builder, Runtime};

use super::forge::{self, Forger};
use super::host::{Host, Wish};
use super::lot::{Lot, Trouble, random};
use super::network::{Packet, Way};
use super::trace::{Observation, Trace};
use super::wire::Left;

/// Between two looks at the clock.
const STEP: Duration = Duration::from_millis(10);
/// No flight lasts longer.
pub const LONGEST: Duration = Duration::from_secs(330);
/// After the program has ended, until the vehicle is judged: PX4's failsafe acts within it.
const SETTLES: Duration = Duration::from_secs(3);
/// A pilot who took over lands after this.
const PILOT_LANDS: Duration = Duration::from_secs(5);
/// Of this share before it goes wrong.
const GENTLE: f64 = 0.1;
/// What the vehicle said is kept for replays.
const KEPT: Duration = Duration::from_secs(31);

/// Something that is done at an instant.
#[derive(Debug, Clone)]
enum Act {
    Begin(Trouble),
    Pilot(Mode),
    Estimate(bool),
    Forge(u32),
    Inject(Vec<u8>),
    /// another's frame that both the vehicle and the program hear
    Overheard(Vec<u8>),
    Wish(Wish),
    Connect,
}

/// All of one flight.
pub struct World {
    pub now: Duration,
    pub host: Host,
    pub trace: Trace,
    lot: Lot,
    vehicle: Vehicle,
    link: LinkId,
    up: Way,
    down: Way,
    beheld: Option<Beheld>,
    to_do: BTreeMap<(Duration, u64), Act>,
    count: u64,
    begun: bool,
    /// kinds of trouble that came
    pub came: Vec<&'static str>,
    is_cut: bool,
    taken: bool,
    said: VecDeque<(Duration, Vec<u8>)>,
    forger: Forger,
    seeds: CrcSeeds,
    random: Pcg64,
    pub runtime: Runtime,
}

fn seconds(s: f64) -> Duration {
    Duration::from_secs_f64(s)
}

impl World {
    pub fn new(lot: Lot, seed: u64, number: u64) -> Self {
        let runtime = Builder::new_current_thread().enable_time().start_paused(true).build().unwrap();
        let entered = runtime.enter();
        let mut vehicle = Vehicle::new(lot.vehicle()).unwrap();
        let link = vehicle.open_link(lot.role);
        let px4 = lot.kind == Firmware::PX4;
        let way = |part| Way::new(random(seed, number, part), !lot.datagrams);
        let (mut up, mut down) = (way(1), way(2));
        (up.quality, down.quality) = (lot.up.times(GENTLE), lot.down.times(GENTLE));
        let host = Host::new(lot.sortie(), lot.vehicle().vehicle, lot.datagrams, random(seed, number, 3));
        drop(entered);
        Self {
            now: Duration::ZERO,
            host,
            trace: Trace::default(),
            lot,
            vehicle,
            link,
            up,
            down,
            beheld: None,
            to_do: BTreeMap::new(),
            count: 0,
            begun: false,
            came: Vec::new(),
            is_cut: false,
            taken: false,
            said: VecDeque::new(),
            forger: Forger::new(px4),
            seeds: CrcSeeds::new(),
            random: random(seed, number, 4),
            runtime,
        }
    }

    fn later(&mut self, at: Duration, act: Act) {
        self.count += 1;
        self.to_do.insert((at, self.count), act);
    }

    /// Until the program has ended and the vehicle has settled.
    pub fn fly(&mut self) {
        let mut judged = LONGEST;
        while self.now < judged.min(LONGEST) {
            self.step();
            if self.host.outcome.is_some() && judged == LONGEST {
                judged = self.now + SETTLES;
            }
        }
    }

    fn step(&mut self) {
        self.now += STEP;
        // the link's own clock is tokio's
        self.runtime.block_on(tokio::time::advance(STEP));
        let now = self.now;
        let runtime = self.runtime.handle().clone();
        let _entered = runtime.enter();
        self.begin();
        while self.to_do.first_key_value().is_some_and(|((at, _), _)| *at <= now) {
            if let Some((_, act)) = self.to_do.pop_first() {
                self.act(act);
            }
        }
        for packet in self.up.take(now) {
            self.vehicle.receive(self.link, &packet.bytes, now);
        }
        self.listen();
        for packet in self.down.take(now) {
            self.host.arrive(now, packet, &mut self.trace);
        }
        let px4 = self.lot.kind == Firmware::PX4;
        for bytes in self.host.turn(now, &mut self.trace) {
            let left = Left::of(&self.seeds, px4, &bytes);
            self.trace.add(now, Observation::Left(left));
            if !self.is_cut {
                self.up.give(now, Packet { bytes, said: Some(now) });
            }
        }
    }

    /// The vehicle goes on, and what it says is on its way.
    fn listen(&mut self) {
        let now = self.now;
        for outgoing in self.vehicle.advance(now) {
            if outgoing.link != self.link {
                continue;
            }
            self.forger.sequence = outgoing.bytes[4];
            self.said.push_back((now, outgoing.bytes.clone()));
            if !self.is_cut {
                self.down.give(now, Packet { bytes: outgoing.bytes, said: Some(now) });
            }
        }
        while self.said.front().is_some_and(|(at, _)| now - *at > KEPT) {
            self.said.pop_front();
        }
        let beheld = self.vehicle.beheld();
        if self.beheld.replace(beheld) != Some(beheld) {
            self.trace.add(now, Observation::Vehicle(beheld));
        }
    }

    /// From the lot's phase on it goes wrong.
    fn begin(&mut self) {
        if self.begun || self.host.flight().status(self.now).phase != self.lot.phase {
            return;
        }
        self.begun = true;
        (self.up.quality, self.down.quality) = (self.lot.up, self.lot.down);
        let mut at = self.now;
        for (after_s, trouble) in self.lot.troubles.clone() {
            at += seconds(after_s);
            self.later(at, Act::Begin(trouble));
        }
    }

    fn act(&mut self, act: Act) {
        let now = self.now;
        match act {
            Act::Begin(trouble) => {
                self.trace.add(now, Observation::Fault(format!("{trouble:?}")));
                self.came.push(trouble.kind());
                self.trouble(trouble);
            }
            Act::Pilot(mode) => {
                self.trace.add(now, Observation::Fault(format!("the pilot chooses {mode:?}")));
                self.vehicle.fault(Fault::PilotTakesOver(mode));
                if !std::mem::replace(&mut self.taken, true) {
                    self.later(now + PILOT_LANDS, Act::Pilot(Mode::Land));
                }
            }
            Act::Estimate(good) => self.vehicle.fault(Fault::EstimatorHealth(good)),
            Act::Forge(count) => {
                for _ in 0..count {
                    let (what, bytes) = self.forger.make(&mut self.random);
                    if count < 30 {
                        self.trace.add(now, Observation::Fault(format!("forged: {what}")));
                    }
                    self.inject(bytes);
                }
            }
            Act::Inject(bytes) => self.inject(bytes),
            Act::Overheard(bytes) => {
                self.vehicle.receive(self.link, &bytes, now);
                self.inject(bytes);
            }
            Act::Wish(wish) => self.host.wish(wish),
            Act::Connect => {
                self.is_cut = false;
                self.host.connect(true);
            }
        }
    }

    fn inject(&mut self, bytes: Vec<u8>) {
        self.host.arrive(self.now, Packet { bytes, said: None }, &mut self.trace);
    }

    fn trouble(&mut self, trouble: Trouble) {
        let now = self.now;
        match trouble {
            Trouble::Silence { down, up, lasts_s, pilot } => {
                for (way, silent) in [(&mut self.down, down), (&mut self.up, up)] {
                    if silent {
                        way.silent_until = way.silent_until.max(now + seconds(lasts_s));
                    }
                }
                self.pilot_within(pilot);
            }
            Trouble::Stall { parts, pilot } => {
                for (part, lasts_s) in parts {
                    let until = now + seconds(lasts_s);
                    self.trace.add(now, Observation::Parked(part, until));
                    self.host.park(part, until);
                }
                self.pilot_within(pilot);
            }
            Trouble::Pilot { mode, back_s } => {
                self.later(now, Act::Pilot(mode));
                if let Some(back_s) = back_s {
                    self.later(now + seconds(back_s), Act::Pilot(Mode::Guided));
                }
            }
            Trouble::Forged(count) => self.later(now, Act::Forge(count)),
            Trouble::Replay { age_s, lasts_s } => self.replay(seconds(age_s), seconds(lasts_s)),
            Trouble::Flood { rate_hz, lasts_s } => {
                let each = (rate_hz * STEP.as_secs_f64()).ceil() as u32;
                let mut at = now;
                while at < now + seconds(lasts_s) {
                    self.later(at, Act::Forge(each));
                    at += STEP;
                }
            }
            Trouble::Cut(lasts_s) => {
                self.is_cut = true;
                self.up.cut();
                self.down.cut();
                self.host.connect(false);
                self.later(now + seconds(lasts_s), Act::Connect);
            }
            Trouble::Estimate(lasts_s) => {
                self.later(now, Act::Estimate(false));
                self.later(now + seconds(lasts_s), Act::Estimate(true));
            }
            Trouble::Station { heartbeat, lasts_s } => self.station(heartbeat, seconds(lasts_s)),
            Trouble::Reboot => self.vehicle.fault(Fault::Reboot),
            Trouble::Jump(by_m) => {
                self.trace.add(now, Observation::Jumped(by_m[2]));
                self.vehicle.fault(Fault::EstimatorJump(by_m));
            }
            Trouble::Battery(share) => self.vehicle.fault(Fault::Battery(share)),
            Trouble::Push(force_n, lasts_s) => {
                let (torque_nm, duration) = ([0.0; 3], seconds(lasts_s));
                self.vehicle.fault(Fault::Push { force_n, torque_nm, duration });
            }
            Trouble::Key(key) => {
                self.host.wish(Wish::Key(key));
                // he who took it brings it down
                for after_s in [6.0, 30.0] {
                    self.later(now + seconds(after_s), Act::Wish(Wish::Key(Key::To(Ours::Land))));
                }
            }
            Trouble::Stop => self.host.wish(Wish::Stop),
        }
    }

    fn pilot_within(&mut self, pilot: Option<f64>) {
        if let Some(after_s) = pilot {
            let modes: &[Mode] = &[Mode::Position, Mode::Altitude, Mode::Hold, Mode::Return];
            let mode = modes[self.random.random_range(0..modes.len())];
            self.later(self.now + seconds(after_s), Act::Pilot(mode));
        }
    }

    /// What the vehicle said a while ago comes again, at its pace.
    fn replay(&mut self, age: Duration, lasts: Duration) {
        let now = self.now;
        let from = now.saturating_sub(age);
        let again: Vec<(Duration, Vec<u8>)> =
            self.said.iter().filter(|(at, _)| (from..from + lasts).contains(at)).cloned().collect();
        for (at, bytes) in again {
            self.later(now + (at - from), Act::Inject(bytes));
        }
    }

    /// Its heartbeats with our ids, or its setpoints, which the vehicle hears as well.
    fn station(&mut self, heartbeat: bool, lasts: Duration) {
        let now = self.now;
        if heartbeat {
            self.vehicle.fault(Fault::ForeignHeartbeat { system: 255, component: 190 });
            return;
        }
        let mut body: Vec<u8> = 1_u32.to_le_bytes().to_vec();
        for value in [0.5_f32, 0.5, -2.5, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0] {
            body.extend(value.to_le_bytes());
        }
        body.extend(0xdf8_u16.to_le_bytes());
        body.extend([1, 1, 1]);
        let mut at = now;
        while at < now + lasts {
            self.later(at, Act::Overheard(forge::frame(&self.seeds, 84, &body, (254, 190), 1)));
            at += Duration::from_millis(50);
        }
    }

    /// It came to the phase from which it goes wrong.
    pub fn began(&self) -> bool {
        self.begun
    }
}
