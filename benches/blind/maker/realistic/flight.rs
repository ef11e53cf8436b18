//! One flight with an estimator in the loop.

use std::collections::VecDeque;

use nalgebra::{Matrix3, Vector3};
use rand::Rng;

use super::super::body::{State, place, rotation, three};
use super::super::controller::{Belief, Controller, Tune};
use super::super::dice;
use super::super::flight::{Instant, Lost, Plant, TICK};
use super::super::hidden::Hidden;
use super::super::path::Path;
use super::super::vehicle::Craft;
use super::drawn_three;
use super::estimator::Estimator;
use super::inertial::{Inertial, Sample, Unit};
use super::position::{Fix, Positions, Source, Trust};
use super::visibility::{Visibility, Watch};

/// What the vehicle measures and believes with.
#[derive(Debug, Clone)]
pub struct Senses {
    pub unit: Unit,
    pub source: Source,
    pub trust: Trust,
    /// ticks after which attitude, velocity and position leave the estimator
    pub waits: usize,
}

/// What is true, believed and measured at a tick.
#[derive(Debug, Clone)]
pub struct Tick {
    pub truth: Instant,
    pub belief: Belief,
    pub sample: Sample,
}

/// Root mean squares of the estimator's errors.
#[derive(Debug, Clone, Copy, Default)]
pub struct Errors {
    /// m/s along world axes
    pub velocity: Vector3<f64>,
    /// degrees
    pub attitude: f64,
    pub tilt: f64,
    /// m
    pub position: f64,
    /// rad/s an axis
    pub rates: f64,
    /// mean squares of innovations over their variances: position, velocity, height, yaw
    pub innovations: [f64; 4],
}

/// A flight.
#[derive(Debug, Clone)]
pub struct Flown {
    pub ticks: Vec<Tick>,
    /// as the receiver told them
    pub fixes: Vec<Fix>,
    pub errors: Errors,
    /// what the concealed effects did
    pub visibility: Visibility,
}

/// s on the ground's readings before the recording begins.
const WARM: f64 = 12.0;

/// m off the path beyond which a flight is given up: a receiver wanders.
const ASTRAY: f64 = 5.0;

/// Estimator and sensors together.
struct Mind {
    inertial: Inertial,
    positions: Positions,
    estimator: Estimator,
    fixes: Vec<Fix>,
}

impl Mind {
    /// A tick at the end of which the vehicle is in `now`; before it was in `before`.
    fn tick(&mut self, time: f64, (before, now): (&State, &State), noise: &mut impl Rng) -> Sample {
        let of = |state: &State| (three(state, place::VELOCITY), rotation(state));
        let ((v0, r0), (v1, r1)) = (of(before), of(now));
        let speeds: [f64; 4] = std::array::from_fn(|rotor| now[place::ROTORS + rotor]);
        let sample = self.inertial.next(([v0, v1], [r0, r1]), &speeds, noise);
        let at = three(now, place::POSITION);
        let reached = self.positions.next(time, (&at, &v1, &r1), noise);
        if time >= 0.0 {
            self.fixes.extend(reached.fix);
        }
        self.estimator.tick(time, (&sample.force, &sample.rates), &reached);
        sample
    }

    fn belief(&self, sample: &Sample) -> Belief {
        let Estimator { position, velocity, rotation, bias_rates, .. } = &self.estimator;
        Belief {
            position: *position,
            velocity: *velocity,
            rotation: *rotation,
            rates: sample.slow_rates - bias_rates,
        }
    }
}

/// Flies a path.
pub fn fly(
    (craft, hidden): (&Craft, &Hidden),
    path: &Path,
    senses: &Senses,
    seed: u64,
) -> Result<Flown, Lost> {
    let mut noise = dice(seed, 9);
    let mut plant = Plant::new(craft, hidden, path, seed);
    let mut controller = Controller::new(craft, Tune::in_flight(craft, hidden.lag.0));
    let mut before = plant.state;
    let (mut mind, mut late) = awake((craft, &before), senses, &mut noise);
    let mut watch = Watch::new(craft, hidden);
    let mut ticks: Vec<Tick> = Vec::new();
    for count in (0..).take_while(|&tick| f64::from(tick) * TICK <= path.duration) {
        let time = f64::from(count) * TICK;
        let sample = mind.tick(time, (&before, &plant.state), &mut noise);
        let belief = mind.belief(&sample);
        late.push_back(belief);
        let left = late.pop_front().unwrap_or(belief);
        let known = Belief { rates: belief.rates, ..left };
        let command = controller.decide(path, (time, TICK), &known).map(|value| value.clamp(0.05, 1.0));
        before = plant.state;
        watch.tick(time, &before, &command);
        let truth = plant.tick(time, command, path);
        plant.check(time + TICK, path, ASTRAY)?;
        ticks.push(Tick { truth, belief, sample });
    }
    let errors = errors(&ticks, &mind.estimator);
    Ok(Flown { ticks, fixes: mind.fixes, errors, visibility: watch.visibility() })
}

/// An estimator that has settled in hover, and its last beliefs.
fn awake(
    (craft, state): (&Craft, &State),
    senses: &Senses,
    noise: &mut impl Rng,
) -> (Mind, VecDeque<Belief>) {
    let Senses { unit, source, trust, waits } = senses;
    let doubt = [0.003, 0.12];
    let first = (unit.bias[1] + drawn_three(doubt[0], noise), unit.bias[0] + drawn_three(doubt[1], noise));
    let at = three(state, place::POSITION);
    let mut mind = Mind {
        inertial: Inertial::new(unit, craft.hover_speed(), noise),
        positions: Positions::new(source, -WARM, noise),
        estimator: Estimator::new(at, first, doubt, (*trust, source.believed_late)),
        fixes: Vec::new(),
    };
    let mut late = VecDeque::new();
    for back in (1..=3000_u32).rev() {
        let sample = mind.tick(-f64::from(back) * TICK, (state, state), noise);
        if usize::try_from(back).is_ok_and(|back| back <= *waits) {
            late.push_back(mind.belief(&sample));
        }
    }
    mind.estimator.innovations = [(0.0, 0.0); 4];
    (mind, late)
}

fn errors(ticks: &[Tick], estimator: &Estimator) -> Errors {
    let mut sums = Errors::default();
    for Tick { truth, belief, .. } in ticks {
        let off = belief.velocity - truth.velocity;
        sums.velocity += off.component_mul(&off);
        let turned: Matrix3<f64> = truth.rotation.transpose() * belief.rotation;
        let whole = nalgebra::Rotation3::from_matrix_unchecked(turned).angle();
        let lean = truth.rotation.row(2).transpose().angle(&belief.rotation.row(2).transpose());
        sums.attitude += whole * whole;
        sums.tilt += lean * lean;
        sums.position += (belief.position - truth.position).norm_squared() / 3.0;
        sums.rates += (belief.rates - truth.rates).norm_squared() / 3.0;
    }
    let count = ticks.len() as f64;
    Errors {
        velocity: (sums.velocity / count).map(f64::sqrt),
        attitude: (sums.attitude / count).sqrt().to_degrees(),
        tilt: (sums.tilt / count).sqrt().to_degrees(),
        position: (sums.position / count).sqrt(),
        rates: (sums.rates / count).sqrt(),
        innovations: estimator.innovations.map(|(sum, count)| sum / f64::max(count, 1.0)),
    }
}
