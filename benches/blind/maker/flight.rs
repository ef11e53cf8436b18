//! One flight: controller, body and air, tick by tick.

use nalgebra::{Matrix3, Vector3};
use rand::Rng;
use rand_distr::{Distribution, StandardNormal};

use super::body::{Drive, SIZE, State, place, put, rotation, straighten, terminals, three};
use super::controller::{Controller, Doubt, Tune};
use super::hidden::{Gust, Hidden};
use super::path::{Path, RequestedEffects};
use super::vehicle::Craft;
use super::{GRAVITY, dice, dopri};

/// s between two decisions of the controller
pub const TICK: f64 = 0.004;

/// What is true at a tick.
#[derive(Debug, Clone)]
pub struct Instant {
    /// m, world, of the centre of mass
    pub position: Vector3<f64>,
    /// m/s
    pub velocity: Vector3<f64>,
    /// body to world
    pub rotation: Matrix3<f64>,
    /// rad/s, body
    pub rates: Vector3<f64>,
    /// rad/s^2, body
    pub angular: Vector3<f64>,
    /// m/s^2, body, at the centre of mass
    pub specific_force: Vector3<f64>,
    /// rad/s
    pub speeds: [f64; 4],
    /// actuator values
    pub command: [f64; 4],
    /// V
    pub volts: f64,
    /// A
    pub amperes: f64,
    /// rad by which the load's cord leans
    pub swing: f64,
    /// what was asked for
    pub wanted: RequestedEffects,
}

/// Why a flight cannot be used.
#[derive(Debug, Clone, PartialEq)]
pub enum Lost {
    /// s, m off the path
    Strayed(f64, f64),
    /// s
    Ground(f64),
}

/// The state in which a flight begins: hovering where the path begins.
pub fn hovering(craft: &Craft, hidden: &Hidden, path: &Path) -> State {
    let mut state = [0.0; SIZE];
    let wanted = path.at(0.0);
    put(&mut state, place::POSITION, &wanted.position);
    let level = Matrix3::<f64>::identity();
    state[place::ROTATION..place::ROTATION + 9].copy_from_slice(level.as_slice());
    state[place::ROTORS..place::ROTORS + 4].fill(craft.hover_speed());
    if let Some(load) = hidden.load {
        put(&mut state, place::LOAD, &(wanted.position - Vector3::new(0.0, 0.0, load.length)));
    }
    state[place::ARM] = craft.mass * GRAVITY / 4.0;
    state[place::CHARGE] = 1.0;
    state
}

/// A vehicle in its air, whoever steers it.
pub struct Plant<'a> {
    drive: Drive<'a>,
    pub state: State,
    turbulence: Turbulence,
    /// actuator values, tick by tick
    sent: Vec<[f64; 4]>,
    /// whole ticks that a command waits, and s of another
    waiting: (usize, f64),
    hover: f64,
    step: f64,
}

impl<'a> Plant<'a> {
    /// Hovering where the path begins.
    pub fn new(craft: &'a Craft, hidden: &'a Hidden, path: &Path, seed: u64) -> Self {
        let (whole, part) = ((hidden.delay / TICK).floor(), hidden.delay.rem_euclid(TICK));
        let waiting = (0..).take_while(|&ticks| f64::from(ticks) < whole).count();
        Self {
            drive: Drive::new(craft, hidden),
            state: hovering(craft, hidden, path),
            turbulence: Turbulence::new(hidden.gust, seed),
            sent: Vec::new(),
            waiting: (waiting, part),
            hover: craft.hover_speed() / craft.speed_max,
            step: TICK,
        }
    }

    /// What was true at `time`, when `command` was given; a tick passes.
    pub fn tick(&mut self, time: f64, command: [f64; 4], path: &Path) -> Instant {
        self.sent.push(command);
        let (waiting, part) = self.waiting;
        let of = |back: usize| {
            self.sent.len().checked_sub(1 + back).map_or([self.hover; 4], |place| self.sent[place])
        };
        let (late, now) = (of(if part > 0.0 { waiting + 1 } else { waiting }), of(waiting));
        let Self { drive, state, step, turbulence, .. } = self;
        drive.gust = turbulence.next(TICK);
        drive.command = late;
        let instant = Instant { command, ..instant(drive, time, state, path) };
        let (split, end) = (time + part, time + TICK);
        dopri::advance(|time, state| drive.motion(time, state).slope, state, (time, split), step);
        drive.command = now;
        dopri::advance(|time, state| drive.motion(time, state).slope, state, (split, end), step);
        *step = step.min(TICK);
        straighten(state);
        instant
    }

    /// Whether the vehicle is where it may be at `time`.
    pub fn check(&self, time: f64, path: &Path, most: f64) -> Result<(), Lost> {
        let at = three(&self.state, place::POSITION);
        let off = (at - path.at(time).position).norm();
        if off.is_nan() || off > most {
            return Err(Lost::Strayed(time, off));
        }
        if at.z < 0.4 * self.drive.craft.radius { Err(Lost::Ground(time)) } else { Ok(()) }
    }
}

/// Flies a path.
pub fn fly(
    craft: &Craft,
    hidden: &Hidden,
    path: &Path,
    (seed, doubt): (u64, Doubt),
) -> Result<Vec<Instant>, Lost> {
    let mut noise = dice(seed, 3);
    let mut controller = Controller::new(craft, Tune::by_file(craft));
    let mut plant = Plant::new(craft, hidden, path, seed);
    let mut flown = Vec::new();
    let ticks = (0..).take_while(|&tick| f64::from(tick) * TICK <= path.duration);
    for tick in ticks {
        let time = f64::from(tick) * TICK;
        let command = controller.outputs(path, (time, TICK), (&plant.state, doubt), &mut noise);
        flown.push(plant.tick(time, command, path));
        plant.check(time + TICK, path, 1.5)?;
    }
    Ok(flown)
}

/// What is true now.
fn instant(drive: &Drive, time: f64, state: &State, path: &Path) -> Instant {
    let motion = drive.motion(time, state);
    let turn = rotation(state);
    let (volts, amperes) = if drive.hidden.battery.exponent == 0.0 {
        // a pack that sags as packs do, of which the speed controllers know nothing
        let (volts, amperes) = terminals(&drive.hidden.battery, state[place::CHARGE], 0.0);
        (volts - drive.hidden.battery.fall * time - 0.02 * (motion.amperes - amperes), motion.amperes)
    } else {
        (motion.volts, motion.amperes)
    };
    Instant {
        position: three(state, place::POSITION),
        velocity: three(state, place::VELOCITY),
        rotation: turn,
        rates: three(state, place::RATES),
        angular: motion.angular,
        specific_force: turn.transpose() * (motion.acceleration + Vector3::new(0.0, 0.0, GRAVITY)),
        speeds: std::array::from_fn(|rotor| state[place::ROTORS + rotor]),
        command: drive.command,
        volts,
        amperes,
        swing: drive.hidden.load.map_or(0.0, |_| {
            let cord = three(state, place::LOAD) - three(state, place::POSITION);
            cord.xy().norm().atan2(-cord.z)
        }),
        wanted: path.at(time),
    }
}

/// Dryden's forms (MIL-F-8785C) as filters of white noise: the first order along, the second order across.
struct Turbulence {
    gust: Option<Gust>,
    dice: rand_pcg::Pcg64Mcg,
    first: Vector3<f64>,
    second: Vector3<f64>,
}

impl Turbulence {
    fn new(gust: Option<Gust>, seed: u64) -> Self {
        let mut this = Self { gust, dice: dice(seed, 4), first: Vector3::zeros(), second: Vector3::zeros() };
        // long enough to forget where it began
        for _ in 0..4000 {
            this.next(2.0 * TICK);
        }
        this
    }

    fn next(&mut self, step: f64) -> Vector3<f64> {
        let Some(Gust { sigma, time }) = self.gust else { return Vector3::zeros() };
        let keep = (-step / time).exp();
        let fresh = (1.0 - keep * keep).sqrt();
        for axis in 0..3 {
            self.first[axis] = keep * self.first[axis] + fresh * drawn(&mut self.dice);
            self.second[axis] = keep * self.second[axis] + (1.0 - keep) * self.first[axis];
        }
        let across = |axis: usize| {
            let root = 3_f64.sqrt();
            (root * self.first[axis] + (1.0 - root) * self.second[axis]) / 2_f64.sqrt()
        };
        sigma * Vector3::new(self.first.x, across(1), across(2))
    }
}

fn drawn(dice: &mut impl Rng) -> f64 {
    StandardNormal.sample(dice)
}
