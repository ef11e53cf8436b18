//! What happens on a flight, drawn by lot: the same seed and number, the same flight.

use std::fmt;
use std::path::Path;
use std::sync::LazyLock;
use std::time::Duration;

use mavid::autopilot::Mode as Ours;
use mavid::config::read_vehicle;
use mavid::fly::{Around, Course, FirstQuestion, Key, Origin, Settings, Sortie};
use mavid::sitl::{Firmware, LinkRole, Mode, Settings as VehicleSettings};
use mavid::trajectory::{FourierAxis, FourierTrajectory};
use mavid::vehicle::Vehicle;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

use super::network::Quality;
use super::trace::Part;

static VEHICLE: LazyLock<Vehicle> = LazyLock::new(|| {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/x500.toml");
    read_vehicle(&file).unwrap().vehicle
});

/// Something that goes wrong.
#[derive(Debug, Clone, PartialEq)]
pub enum Trouble {
    /// nothing passes, down and up, for s; the pilot takes over after s of it
    Silence {
        down: bool,
        up: bool,
        lasts_s: f64,
        pilot: Option<f64>,
    },
    /// parts of the program stand still, each for s
    Stall {
        parts: Vec<(Part, f64)>,
        pilot: Option<f64>,
    },
    /// a pilot's switch; s later the mode of before again
    Pilot {
        mode: Mode,
        back_s: Option<f64>,
    },
    /// frames of somebody else, so many
    Forged(u32),
    /// what the vehicle said s ago, for s
    Replay {
        age_s: f64,
        lasts_s: f64,
    },
    /// frames a second of somebody else, for s
    Flood {
        rate_hz: f64,
        lasts_s: f64,
    },
    Reboot,
    /// of the position estimate, m
    Jump([f64; 3]),
    /// the position estimate is not good, for s
    Estimate(f64),
    /// its share
    Battery(f64),
    /// N, for s
    Push([f64; 3], f64),
    /// another station commands: with our ids, or by setpoints
    Station {
        heartbeat: bool,
        lasts_s: f64,
    },
    Key(Key),
    /// the program is told to end
    Stop,
    /// the connection is cut, for s
    Cut(f64),
}

impl Trouble {
    /// Every kind of it.
    pub const KINDS: [&str; 15] = [
        "silence", "stall", "pilot", "forged", "replay", "flood", "reboot", "jump", "estimate", "battery",
        "push", "station", "key", "stop", "cut",
    ];

    /// Which of [`Self::KINDS`].
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Silence { .. } => "silence",
            Self::Stall { .. } => "stall",
            Self::Pilot { .. } => "pilot",
            Self::Forged(_) => "forged",
            Self::Replay { .. } => "replay",
            Self::Flood { .. } => "flood",
            Self::Reboot => "reboot",
            Self::Jump(_) => "jump",
            Self::Estimate(_) => "estimate",
            Self::Battery(_) => "battery",
            Self::Push(..) => "push",
            Self::Station { .. } => "station",
            Self::Key(_) => "key",
            Self::Stop => "stop",
            Self::Cut(_) => "cut",
        }
    }
}

/// Phases of a flight from which on it goes wrong, some of them more often.
pub const PHASES: [&str; 12] = [
    "check",
    "engage",
    "arm",
    "take off",
    "take off",
    "go to start",
    "start gate",
    "trajectory",
    "trajectory",
    "trajectory",
    "trajectory",
    "land",
];

/// A flight before it is flown.
#[derive(Debug, Clone)]
pub struct Lot {
    pub kind: Firmware,
    pub role: LinkRole,
    /// one frame a datagram; else a stream that loses nothing
    pub datagrams: bool,
    pub up: Quality,
    pub down: Quality,
    /// from when on it goes wrong: a phase of the flight
    pub phase: &'static str,
    /// each so many s after the one before
    pub troubles: Vec<(f64, Trouble)>,
    pub origin: Origin,
    /// parameters are downloaded and checked
    pub clearance: bool,
    pub start_m: [f64; 2],
    pub vehicle_seed: u64,
}

/// The random numbers of a flight's part.
pub fn random(seed: u64, number: u64, part: u64) -> Pcg64 {
    let mixed = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ number.wrapping_mul(0xD1B5_4A32_D192_ED03) ^ part;
    Pcg64::seed_from_u64(mixed)
}

fn chance(random: &mut Pcg64, of: f64) -> bool {
    random.random::<f64>() < of
}

fn between(random: &mut Pcg64, from: f64, to: f64) -> f64 {
    from + (to - from) * random.random::<f64>()
}

fn one<T: Clone>(random: &mut Pcg64, of: &[T]) -> T {
    of[random.random_range(0..of.len())].clone()
}

impl Lot {
    pub fn draw(seed: u64, number: u64) -> Self {
        let mut random = random(seed, number, 0);
        let random = &mut random;
        let copter = [Firmware::ARDUPILOT_4_6, Firmware::ARDUPILOT_4_7, Firmware::ARDUPILOT_4_7];
        let kind = if chance(random, 0.5) { Firmware::PX4 } else { one(random, &copter) };
        let datagrams = chance(random, 0.7);
        let count = one(random, &[1, 1, 2, 2, 3, 4]);
        let mut troubles = Vec::new();
        for _ in 0..count {
            let after_s = one(random, &[(0.0, 0.3), (0.0, 3.0), (1.0, 6.0)]);
            troubles.push((between(random, after_s.0, after_s.1), trouble(random, kind)));
        }
        Self {
            kind,
            role: one(random, &[LinkRole::GroundStation, LinkRole::Onboard]),
            datagrams,
            up: quality(random, datagrams),
            down: quality(random, datagrams),
            phase: one(random, &PHASES),
            troubles,
            origin: one(random, &[Origin::Local, Origin::Local, Origin::Here]),
            clearance: chance(random, 0.03),
            start_m: [between(random, -0.3, 0.3), between(random, -0.3, 0.3)],
            vehicle_seed: random.random(),
        }
    }

    pub fn vehicle(&self) -> VehicleSettings {
        VehicleSettings {
            warm_up: Some(Duration::from_secs(2)),
            seed: self.vehicle_seed,
            start_m: self.start_m,
            ..VehicleSettings::new(VEHICLE.clone(), self.kind)
        }
    }

    pub fn sortie(&self) -> Sortie {
        let vehicle = &*VEHICLE;
        let limits = vehicle.limits;
        let course = Course::new(&series(), 1, Some(&AROUND), &limits, vehicle).unwrap();
        let s = Duration::from_secs;
        let settings = Settings {
            origin: self.origin,
            setpoint_period: Duration::from_millis(20),
            connect_timeout: s(10),
            ready_timeout: s(20),
            reach_timeout: s(15),
            hold_then_land: s(3),
            watch_max: s(20),
            await_clearance: self.clearance,
            first_question: FirstQuestion::of_seed(1),
            ..Settings::default()
        };
        let gravity_m_s2 = vehicle.gravity_m_s2;
        Sortie { course, limits, gravity_m_s2, system: None, may_arm: true, own_vehicle: None, settings }
    }
}

const AROUND: Around = Around {
    takeoff: [0.0, 0.0, 2.5, 0.0],
    landing: [0.0, 0.0, 2.5, 0.0],
    to_start_s: 2.5,
    to_landing_s: 2.5,
};

/// A lively trajectory of a few seconds in the middle of the room.
fn series() -> FourierTrajectory {
    let axis = |a: f64, b: f64, c: f64| FourierAxis { a: vec![a, 0.3 * b], b: vec![b, -0.2 * a], c };
    FourierTrajectory {
        period_s: 5.0,
        axes: [axis(0.5, 0.3, 0.0), axis(-0.3, 0.6, 0.0), axis(0.2, 0.1, 2.5), axis(0.1, 0.1, 0.0)],
    }
}

fn quality(random: &mut Pcg64, datagrams: bool) -> Quality {
    let mut most = |most: f64| if chance(random, 0.5) { between(random, 0.0, most) } else { 0.0 };
    let delay_s = most(0.15);
    if !datagrams {
        return Quality { delay_s, ..Quality::default() };
    }
    Quality { loss: most(0.25), delay_s, jitter_s: most(0.06), doubled: most(0.08), corrupted: most(0.05) }
}

/// A pilot's mode.
fn pilots(random: &mut Pcg64, kind: Firmware) -> Mode {
    let modes = [
        Mode::Position,
        Mode::Position,
        Mode::Altitude,
        Mode::Stabilize,
        Mode::Hold,
        Mode::Return,
        Mode::Land,
        Mode::Brake,
    ];
    loop {
        let mode = one(random, &modes);
        if mode.custom_mode(kind).is_some() {
            return mode;
        }
    }
}

/// How long it lasts, s: short, middling or long.
fn length(random: &mut Pcg64, long_s: f64) -> f64 {
    let (from, to) = one(random, &[(0.05, 0.5), (0.2, 0.8), (0.5, 3.0), (3.0_f64.min(long_s), long_s)]);
    between(random, from, to)
}

fn stall(random: &mut Pcg64) -> Vec<(Part, f64)> {
    use Part::{Link, Setpoints, Supervisor, Telemetry};
    let of: &[Part] = match random.random_range(0..8) {
        0..=3 => &[Link, Supervisor, Setpoints],
        4 => &[Supervisor],
        5 => &[Setpoints],
        6 => &[Link],
        _ => &[Telemetry],
    };
    let lasts_s = length(random, 4.0);
    // the system wakes one after the other
    of.iter()
        .map(|part| (*part, lasts_s + if of.len() == 3 { between(random, 0.0, 0.04) } else { 0.0 }))
        .collect()
}

fn trouble(random: &mut Pcg64, kind: Firmware) -> Trouble {
    match random.random_range(0..100) {
        0..20 => {
            let lasts_s = length(random, 7.0);
            let (down, up) = one(random, &[(true, true), (true, true), (true, false), (false, true)]);
            Trouble::Silence { down, up, lasts_s, pilot: within(random, lasts_s) }
        }
        20..42 => {
            let parts = stall(random);
            let pilot = within(random, parts[0].1);
            Trouble::Stall { parts, pilot }
        }
        42..56 => {
            let back_s = chance(random, 0.3).then(|| between(random, 0.05, 4.0));
            Trouble::Pilot { mode: pilots(random, kind), back_s }
        }
        56..66 => Trouble::Forged(one(random, &[1, 1, 1, 2, 5, 20])),
        66..71 => Trouble::Replay { age_s: between(random, 0.1, 30.0), lasts_s: between(random, 0.1, 2.0) },
        71..75 => {
            Trouble::Flood { rate_hz: between(random, 100.0, 3000.0), lasts_s: between(random, 0.2, 1.5) }
        }
        75..77 => Trouble::Reboot,
        77..81 => {
            let size_m = one(random, &[0.3, 1.0, 3.0]);
            Trouble::Jump(std::array::from_fn(|_| between(random, -size_m, size_m)))
        }
        81..83 => Trouble::Estimate(between(random, 0.3, 4.0)),
        83..86 => Trouble::Battery(one(random, &[0.12, 0.03])),
        86..88 => {
            let force_n = std::array::from_fn(|_| between(random, -12.0, 12.0));
            Trouble::Push(force_n, between(random, 0.3, 4.0))
        }
        88..91 => Trouble::Station { heartbeat: chance(random, 0.5), lasts_s: between(random, 0.1, 3.0) },
        91..94 => Trouble::Key(one(
            random,
            &[Key::Abort, Key::To(Ours::Hold), Key::To(Ours::Land), Key::To(Ours::Return)],
        )),
        94..96 => Trouble::Stop,
        _ => Trouble::Cut(length(random, 6.0)),
    }
}

fn within(random: &mut Pcg64, lasts_s: f64) -> Option<f64> {
    chance(random, 0.5).then(|| between(random, 0.02_f64.min(lasts_s), 0.95 * lasts_s))
}

impl fmt::Display for Lot {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let link = if self.datagrams { "datagrams" } else { "stream" };
        let checks = if self.clearance { ", with the parameters' download" } else { "" };
        let Self { kind, role, up, down, phase, origin, .. } = self;
        writeln!(f, "{kind:?} {role:?} by {link}, origin {origin:?}{checks}; from '{phase}' on")?;
        writeln!(f, "  up: {up}\n  down: {down}")?;
        for (after_s, trouble) in &self.troubles {
            writeln!(f, "  after {after_s:.2} s: {trouble:?}")?;
        }
        Ok(())
    }
}
