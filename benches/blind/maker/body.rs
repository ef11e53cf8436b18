//! The rigid body, its rotors and what hangs on it: one right side for the integrator.

use nalgebra::{Matrix3, Vector3};

use super::hidden::{Battery, Hidden, Outside};
use super::rotors::{self, Stance};
use super::vehicle::Craft;
use super::{AIR_DENSITY, GRAVITY};

/// Numbers in a state: position, velocity, rotation by columns, body rates, rotor speeds, the load's position and
/// velocity, the ringing arm's force and its rate, what is left in the pack.
pub const SIZE: usize = 31;

/// Everything that moves.
pub type State = [f64; SIZE];

/// Where the parts of a [`State`] begin.
pub mod place {
    pub const POSITION: usize = 0;
    pub const VELOCITY: usize = 3;
    pub const ROTATION: usize = 6;
    pub const RATES: usize = 15;
    pub const ROTORS: usize = 18;
    pub const LOAD: usize = 22;
    pub const LOAD_VELOCITY: usize = 25;
    pub const ARM: usize = 28;
    pub const CHARGE: usize = 30;
}

/// Three numbers from `at` on.
pub fn three(state: &State, at: usize) -> Vector3<f64> {
    Vector3::new(state[at], state[at + 1], state[at + 2])
}

/// Puts three numbers from `at` on.
pub fn put(state: &mut State, at: usize, value: &Vector3<f64>) {
    state[at..at + 3].copy_from_slice(value.as_slice());
}

/// Body to world.
pub fn rotation(state: &State) -> Matrix3<f64> {
    Matrix3::from_column_slice(&state[place::ROTATION..place::ROTATION + 9])
}

/// Makes the columns orthonormal again (Gram and Schmidt from z on, the axis that matters).
pub fn straighten(state: &mut State) {
    let old = rotation(state);
    let z = old.column(2).normalize();
    let x = (old.column(0) - z * z.dot(&old.column(0))).normalize();
    let y = z.cross(&x);
    let columns = Matrix3::from_columns(&[x, y, z]);
    state[place::ROTATION..place::ROTATION + 9].copy_from_slice(columns.as_slice());
}

/// What drives the body over a stretch of time.
pub struct Drive<'a> {
    pub craft: &'a Craft,
    pub hidden: &'a Hidden,
    /// actuator values
    pub command: [f64; 4],
    /// turbulence now, m/s, world
    pub gust: Vector3<f64>,
    /// inverse of the inertia
    pub inverse: Matrix3<f64>,
}

/// A slope and what is worth knowing on the way.
pub struct Motion {
    pub slope: State,
    /// m/s^2, world
    pub acceleration: Vector3<f64>,
    /// rad/s^2, body
    pub angular: Vector3<f64>,
    /// V at the pack's terminals
    pub volts: f64,
    /// A
    pub amperes: f64,
}

/// Terminal voltage and current at a charge and the rotors' mechanical power, W.
pub fn terminals(battery: &Battery, charge: f64, power: f64) -> (f64, f64) {
    let (full, empty) = battery.open_circuit;
    let open = empty + (full - empty) * charge;
    let drawn = power / battery.efficiency;
    // V = E - R P / V
    let volts = 0.5 * (open + (open * open - 4.0 * battery.resistance * drawn).max(0.0).sqrt());
    (volts, drawn / volts)
}

impl<'a> Drive<'a> {
    pub fn new(craft: &'a Craft, hidden: &'a Hidden) -> Self {
        let inverse = craft.inertia.try_inverse().unwrap_or_else(Matrix3::identity);
        Self { craft, hidden, command: [0.0; 4], gust: Vector3::zeros(), inverse }
    }

    /// rad/s that an actuator value asks for at a pack's voltage.
    fn asked(&self, value: f64, volts: f64) -> f64 {
        let value = value.clamp(0.0, 1.0);
        let speed = match self.hidden.curve {
            None => value,
            Some(f) => {
                let hover = self.craft.hover_speed() / self.craft.speed_max;
                let law = |u: f64| (1.0 - f) * u + f * u * u;
                hover * (law(value) / law(hover)).sqrt()
            }
        };
        let battery = self.hidden.battery;
        if battery.exponent == 0.0 {
            return speed * self.craft.speed_max;
        }
        // as stated at the pack's voltage in the first hover
        let hover = 4.0 * self.craft.torque_coefficient * self.craft.hover_speed().powi(3);
        let (stated, _) = terminals(&battery, 1.0, hover);
        speed * self.craft.speed_max * (volts / stated).powf(0.5 * battery.exponent)
    }

    /// Air at a place, m/s, world.
    fn air(&self, at: &Vector3<f64>) -> Vector3<f64> {
        let mut air = self.hidden.wind + self.gust;
        if let Some(Outside::Updraft([x, y], width, speed)) = self.hidden.outside {
            air.z += speed * (-0.5 * ((at.x - x).powi(2) + (at.y - y).powi(2)) / (width * width)).exp();
        }
        air
    }

    /// Force of the room, N, world.
    fn room(&self, at: &Vector3<f64>) -> Vector3<f64> {
        match self.hidden.outside {
            Some(Outside::Region(axis, centre, width, force)) => {
                force * (-0.5 * ((at[axis] - centre) / width).powi(2)).exp()
            }
            Some(Outside::Wall(wall, strength)) => {
                let radii = ((wall - at.y) / self.craft.radius).max(1.0);
                Vector3::new(0.0, strength / (radii * radii), 0.0)
            }
            _ => Vector3::zeros(),
        }
    }

    /// kg without load and cable, `time` s into the flight.
    pub fn mass(&self, time: f64) -> f64 {
        self.craft.mass + self.hidden.drop.map_or(0.0, |(when, by)| if time >= when { by } else { 0.0 })
    }

    /// How everything moves.
    pub fn motion(&self, time: f64, state: &State) -> Motion {
        let (craft, hidden) = (self.craft, self.hidden);
        let [at, velocity, rates] =
            [place::POSITION, place::VELOCITY, place::RATES].map(|place| three(state, place));
        let turn = rotation(state);
        let air = turn.transpose() * (velocity - self.air(&at));
        let speeds: [f64; 4] = std::array::from_fn(|rotor| state[place::ROTORS + rotor]);
        let power: f64 = speeds.iter().map(|speed| craft.torque_coefficient * speed.abs().powi(3)).sum();
        let charge = state[place::CHARGE];
        let (volts, amperes) = terminals(&hidden.battery, charge, power);
        let mut slope = [0.0; SIZE];
        slope[place::CHARGE] = -hidden.battery.per_joule * power / hidden.battery.efficiency;
        let (mut force, mut torque) = (Vector3::zeros(), Vector3::zeros());
        let mut spin = Vector3::zeros();
        for (rotor, &speed) in speeds.iter().enumerate() {
            let asked = self.asked(self.command[rotor], volts);
            let lag = if asked > speed { hidden.lag.0 } else { hidden.lag.1 };
            let spin_up = (asked - speed) / lag;
            slope[place::ROTORS + rotor] = spin_up;
            let arm = craft.hubs[rotor] - hidden.centre;
            let from_turning = rates.cross(&arm);
            let stance = Stance {
                speed,
                spin_up,
                through_air: air + from_turning,
                from_turning,
                height: at.z + (turn * arm).z,
            };
            let mut load = rotors::load(craft, hidden, rotor, &stance);
            if let Some(Outside::Arm(soft, rate, damping)) = hidden.outside.filter(|_| speed > 0.0)
                && soft == rotor
            {
                // the body feels the arm's root, which follows the thrust as a mass on a spring does
                let (felt, change) = (state[place::ARM], state[place::ARM + 1]);
                slope[place::ARM] = change;
                slope[place::ARM + 1] = rate * rate * (load.thrust - felt) - 2.0 * damping * rate * change;
                load.force += (felt - load.thrust) * rotors::axis(hidden);
            }
            force += load.force;
            torque += arm.cross(&load.force) + load.torque;
            spin += load.spin;
        }
        let area = hidden.drag_area;
        force -= 0.5 * AIR_DENSITY * air.norm() * area.component_mul(&air);
        torque.z -= hidden.damping.1 * rates.z;
        let momentum = craft.inertia * rates + spin;
        let angular = self.inverse * (torque - rates.cross(&momentum));
        let acceleration = self.acceleration(time, state, turn * force + self.room(&at), &mut slope);
        put(&mut slope, place::POSITION, &velocity);
        put(&mut slope, place::VELOCITY, &acceleration);
        put(&mut slope, place::RATES, &angular);
        let turning = turn * rates.cross_matrix();
        slope[place::ROTATION..place::ROTATION + 9].copy_from_slice(turning.as_slice());
        Motion { slope, acceleration, angular, volts, amperes }
    }

    /// What a force, N, world, does to the vehicle with its load and cable; the load's slopes.
    fn acceleration(&self, time: f64, state: &State, force: Vector3<f64>, slope: &mut State) -> Vector3<f64> {
        let mass = self.mass(time);
        let down = Vector3::new(0.0, 0.0, -GRAVITY);
        let (at, velocity) = (three(state, place::POSITION), three(state, place::VELOCITY));
        if let Some(load) = self.hidden.load {
            let (hung, swing) = (three(state, place::LOAD), three(state, place::LOAD_VELOCITY));
            let (cord, apart) = (hung - at, swing - velocity);
            let stretch = cord.norm();
            let along = cord / stretch;
            let pull = -load.drag * swing / load.mass + down;
            let free = force / mass + down;
            // d^2/dt^2 of the cord's length is nothing, with a spring against drift
            let rate = apart.dot(&along);
            let turning = (apart.norm_squared() - rate * rate) / stretch;
            let drift = 40.0 * rate + 400.0 * (stretch - load.length);
            let tension = ((pull - free).dot(&along) + turning + drift) / (1.0 / load.mass + 1.0 / mass);
            put(slope, place::LOAD, &swing);
            put(slope, place::LOAD_VELOCITY, &(pull - tension / load.mass * along));
            return free + tension / mass * along;
        }
        let mut acceleration = force / mass + down;
        if self.hidden.cable > 0.0 {
            // the lifted piece weighs, has to be accelerated, and more of it when rising
            let lifted = self.hidden.cable * at.z.max(0.0);
            let gathered = self.hidden.cable * velocity.z * velocity.z.max(0.0);
            acceleration.z = (force.z - gathered) / (mass + lifted) - GRAVITY;
        }
        acceleration
    }
}
