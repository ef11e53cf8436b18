//! Geometric tracking control on SE(3) (Lee, Leok, McClamroch, CDC 2010) on noisy estimates.

use nalgebra::{Matrix3, Matrix4, Rotation3, Vector3, Vector4};
use rand::Rng;
use rand_distr::{Distribution, StandardNormal};

use super::GRAVITY;
use super::body::{State, place, rotation, three};
use super::path::{Path, RequestedEffects};
use super::vehicle::Craft;

/// What the estimates are wrong by, one sigma, anew each time.
#[derive(Debug, Clone, Copy)]
pub struct Doubt {
    /// m
    pub position: f64,
    /// m/s
    pub velocity: f64,
    /// rad
    pub attitude: f64,
    /// rad/s
    pub rates: f64,
    /// of an actuator value
    pub output: f64,
}

/// What the controller holds for true.
#[derive(Debug, Clone, Copy)]
pub struct Belief {
    /// m, world
    pub position: Vector3<f64>,
    /// m/s, world
    pub velocity: Vector3<f64>,
    /// body to world
    pub rotation: Matrix3<f64>,
    /// rad/s, body
    pub rates: Vector3<f64>,
}

/// A controller that believes the maker.
pub struct Controller {
    mass: f64,
    inertia: Matrix3<f64>,
    /// from thrust and torque to the rotors' squared speeds
    mix: Matrix4<f64>,
    speed_max: f64,
    /// m s
    sum: Vector3<f64>,
    tune: Tune,
}

/// How a controller is set up.
#[derive(Debug, Clone, Copy)]
pub struct Tune {
    /// tangent of the steepest lean that is asked for
    pub steepest: f64,
    /// kg m^2 about the body's axes that it holds for true
    pub inertia: Vector3<f64>,
    /// how quickly it turns: 1 as the gains say
    pub quickness: f64,
    /// of what it does about z, as a share of what it does about the others
    pub yaw: f64,
}

impl Tune {
    /// By the maker's file alone.
    pub fn by_file(craft: &Craft) -> Self {
        Self { steepest: f64::INFINITY, inertia: craft.said_inertia, quickness: 1.0, yaw: 0.25 }
    }

    /// As somebody who flies the vehicle sets it: slow motors are not driven to ring, quick ones are used.
    pub fn in_flight(craft: &Craft, lag: f64) -> Self {
        let quickness = (0.8 / (lag + 0.02) / GAINS[4]).min(1.8);
        Self { steepest: STEEPEST.to_radians().tan(), inertia: craft.inertia.diagonal(), quickness, yaw: 0.5 }
    }
}

/// Degrees of lean that a vehicle is allowed.
const STEEPEST: f64 = 36.0;

/// Gains: position 1/s^2, velocity 1/s, the sum 1/s^3, attitude 1/s^2, rates 1/s.
const GAINS: [f64; 5] = [4.0, 3.4, 1.0, 55.0, 12.0];

impl Controller {
    pub fn new(craft: &Craft, tune: Tune) -> Self {
        let columns: [_; 4] = std::array::from_fn(|rotor| {
            let (hub, thrust) = (craft.hubs[rotor], craft.thrust_coefficient);
            Vector4::new(
                thrust,
                thrust * hub.y,
                -thrust * hub.x,
                -craft.spins[rotor] * craft.torque_coefficient,
            )
        });
        let mix = Matrix4::from_columns(&columns).try_inverse().unwrap_or_else(Matrix4::identity);
        Self {
            mass: craft.said_mass,
            inertia: Matrix3::from_diagonal(&tune.inertia),
            mix,
            speed_max: craft.speed_max,
            sum: Vector3::zeros(),
            tune,
        }
    }

    /// Actuator values `time` s into the flight on a state that is doubted; `step` s since the last.
    pub fn outputs(
        &mut self,
        path: &Path,
        (time, step): (f64, f64),
        (state, doubt): (&State, Doubt),
        dice: &mut impl Rng,
    ) -> [f64; 4] {
        let mut noise = |sigma: f64| {
            Vector3::from_fn(|_, _| {
                let drawn: f64 = StandardNormal.sample(dice);
                sigma * drawn
            })
        };
        let belief = Belief {
            position: three(state, place::POSITION) + noise(doubt.position),
            velocity: three(state, place::VELOCITY) + noise(doubt.velocity),
            rotation: rotation(state) * Rotation3::new(noise(doubt.attitude)).matrix(),
            rates: three(state, place::RATES) + noise(doubt.rates),
        };
        let drawn = noise(doubt.output);
        let fourth = noise(doubt.output).x;
        let decided = self.decide(path, (time, step), &belief);
        std::array::from_fn(|rotor| {
            let extra = if rotor < 3 { drawn[rotor] } else { fourth };
            (decided[rotor] + extra).clamp(0.05, 1.0)
        })
    }

    /// Actuator values on what is believed, without bounds.
    pub fn decide(&mut self, path: &Path, (time, step): (f64, f64), belief: &Belief) -> [f64; 4] {
        let wanted = path.at(time);
        let Belief { position, velocity, rotation: turn, rates } = belief;
        let quick = self.tune.quickness;
        let [kp, kv, ki, kr, kw] = GAINS;
        let slow = quick.min(1.0);
        let [kp, kv, ki] = [kp * slow * slow, kv * slow, ki * slow.powi(3)];
        let off = position - wanted.position;
        self.sum = (self.sum + off * step).map(|sum| sum.clamp(-2.0, 2.0));
        let push = up(&wanted) - kp * off - kv * (velocity - wanted.velocity) - ki * self.sum;
        let push = self.leaned(push);
        let thrust = self.mass * push.dot(&turn.column(2)).max(0.2 * GRAVITY);
        let to = attitude(&push, wanted.yaw);
        // how the reference itself turns, from what it asks for a little later
        let soon = path.at(time + 0.01);
        let asked = |wanted: &RequestedEffects| attitude(&self.leaned(up(wanted)), wanted.yaw);
        let between = asked(&wanted).transpose() * asked(&soon);
        let ahead = Rotation3::from_matrix_unchecked(between).scaled_axis() / 0.01;
        let skew = 0.5 * (to.transpose() * turn - turn.transpose() * to);
        let lean = Vector3::new(skew[(2, 1)], skew[(0, 2)], skew[(1, 0)]);
        let turning = rates - turn.transpose() * to * ahead;
        let mut answer = -kr * quick * quick * lean - kw * quick * turning;
        answer.z *= self.tune.yaw;
        let torque = self.inertia * answer + rates.cross(&(self.inertia * rates));
        let squares = self.mix * Vector4::new(thrust, torque.x, torque.y, torque.z);
        std::array::from_fn(|rotor| squares[rotor].max(0.0).sqrt() / self.speed_max)
    }

    /// A push no steeper than is allowed.
    fn leaned(&self, push: Vector3<f64>) -> Vector3<f64> {
        let most = self.tune.steepest * push.z.max(0.3 * GRAVITY);
        let level = push.xy().norm();
        let share = if level > most { most / level } else { 1.0 };
        Vector3::new(push.x * share, push.y * share, push.z)
    }
}

/// Specific force that a reference asks for, m/s^2, world.
fn up(wanted: &RequestedEffects) -> Vector3<f64> {
    wanted.acceleration + Vector3::new(0.0, 0.0, GRAVITY)
}

/// Body to world with z along a push and x towards a yaw.
fn attitude(push: &Vector3<f64>, yaw: f64) -> Matrix3<f64> {
    let z = push.normalize();
    let ahead = Vector3::new(yaw.cos(), yaw.sin(), 0.0);
    let y = z.cross(&ahead).normalize();
    Matrix3::from_columns(&[y.cross(&z), y, z])
}
