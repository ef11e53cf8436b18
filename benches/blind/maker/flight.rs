//! One flight: controller, body and air, tick by tick.

use nalgebra::{Matrix3, Vector3};
use rand::Rng;
use rand_distr::{Distribution, StandardNormal};

use super::body::{Drive, SIZE, State, place, put, rotation, straighten, terminals, three};
use super::controller::{Controller, Doubt};
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

/// Flies a path.
pub fn fly(
    craft: &Craft,
    hidden: &Hidden,
    path: &Path,
    (seed, doubt): (u64, Doubt),
) -> Result<Vec<Instant>, Lost> {
    let mut noise = dice(seed, 3);
    let mut turbulence = Turbulence::new(hidden.gust, seed);
    let mut controller = Controller::new(craft, doubt);
    let mut drive = Drive::new(craft, hidden);
    let mut state = hovering(craft, hidden, path);
    let hover = craft.hover_speed() / craft.speed_max;
    let (whole, part) = ((hidden.delay / TICK).floor(), hidden.delay.rem_euclid(TICK));
    let waiting = (0..).take_while(|&ticks| f64::from(ticks) < whole).count();
    let mut sent: Vec<[f64; 4]> = Vec::new();
    let mut flown = Vec::new();
    let mut step = TICK;
    let ticks = (0..).take_while(|&tick| f64::from(tick) * TICK <= path.duration);
    for tick in ticks {
        let time = f64::from(tick) * TICK;
        let command = controller.outputs(path, (time, TICK), &state, &mut noise);
        sent.push(command);
        let of = |back: usize| sent.len().checked_sub(1 + back).map_or([hover; 4], |place| sent[place]);
        drive.gust = turbulence.next(TICK);
        drive.command = of(if part > 0.0 { waiting + 1 } else { waiting });
        flown.push(instant(&drive, time, &state, path));
        let split = time + part;
        dopri::advance(|time, state| drive.motion(time, state).slope, &mut state, (time, split), &mut step);
        drive.command = of(waiting);
        let end = time + TICK;
        dopri::advance(|time, state| drive.motion(time, state).slope, &mut state, (split, end), &mut step);
        step = step.min(TICK);
        straighten(&mut state);
        let at = three(&state, place::POSITION);
        let off = (at - path.at(end).position).norm();
        if off.is_nan() || off > 1.5 {
            return Err(Lost::Strayed(end, off));
        }
        if at.z < 0.4 * craft.radius {
            return Err(Lost::Ground(end));
        }
        if let Some(last) = flown.last_mut() {
            last.command = command;
        }
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
        (volts - 0.004 * time - 0.02 * (motion.amperes - amperes), motion.amperes)
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
