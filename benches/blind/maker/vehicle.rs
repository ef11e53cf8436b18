//! Random quadrotors, and what their maker says of them.

use std::fmt::Write;

use nalgebra::{Matrix3, Vector3};
use rand::RngExt;

use super::{GRAVITY, dice};

/// What a quadrotor is.
#[derive(Debug, Clone)]
pub struct Craft {
    /// kg
    pub mass: f64,
    /// kg m^2, about the centre of mass
    pub inertia: Matrix3<f64>,
    /// m from the drawing's origin
    pub hubs: [Vector3<f64>; 4],
    /// +1 counter-clockwise from above
    pub spins: [f64; 4],
    /// in the order of the actuators
    pub names: [&'static str; 4],
    /// m
    pub radius: f64,
    /// N/(rad/s)^2
    pub thrust_coefficient: f64,
    /// N m/(rad/s)^2
    pub torque_coefficient: f64,
    /// rad/s
    pub speed_max: f64,
    /// kg, as the maker says
    pub said_mass: f64,
    /// kg m^2, as the maker says, without products
    pub said_inertia: Vector3<f64>,
    /// how much of the thrust is quadratic in the actuator, as the maker says, where he states thrusts, not speeds
    pub said_curve: Option<f64>,
    /// s, the motors' lag where the maker says it
    pub said_lag: Option<f64>,
    /// whether the actuators are told as pulse widths
    pub pulses: bool,
}

/// kg, arm and rotor radius in m, N/(rad/s)^2, N m per N, kg m^2 about x: of four quadrotors.
const BASES: [[f64; 6]; 4] = [
    [0.50, 0.175, 0.087, 5.5e-6, 0.0215, 0.0043],
    [1.00, 0.245, 0.120, 5.3e-6, 0.0188, 0.0245],
    [1.78, 0.187, 0.113, 8.3e-6, 0.0495, 0.0118],
    [1.90, 0.250, 0.143, 9.6e-6, 0.0185, 0.0225],
];

/// Where rotors stand on a circle, clockwise from `first` rad.
fn hubs(arm: f64, first: f64) -> [Vector3<f64>; 4] {
    std::array::from_fn(|index| {
        let angle = first - std::f64::consts::FRAC_PI_2 * index as f64;
        Vector3::new(arm * angle.cos(), arm * angle.sin(), 0.0)
    })
}

impl Craft {
    /// The vehicle of a seed: 0.3 to 3 kg, X or plus.
    pub fn random(seed: u64) -> Self {
        let mut dice = dice(seed, 1);
        let mass = 0.3 * 10_f64.powf(dice.random_range(0.0..1.0));
        let arm = 0.22 * mass.powf(0.4) * dice.random_range(0.85..1.15);
        let radius = arm * dice.random_range(0.45..0.66);
        let hover_speed = dice.random_range(70.0..100.0) / radius;
        let thrust_coefficient = mass * GRAVITY / (4.0 * hover_speed * hover_speed);
        let torque_coefficient = thrust_coefficient * radius * dice.random_range(0.09..0.18);
        let speed_max = hover_speed / dice.random_range(0.55..0.7);
        let around_x = mass * arm * arm * dice.random_range(0.16..0.4);
        let around_y = around_x * dice.random_range(0.85..1.18);
        let around_z = (around_x + around_y) * dice.random_range(0.75..0.96);
        let mut product = || 0.035 * around_x * dice.random_range(-1.0..1.0);
        let (xy, xz, yz) = (product(), product(), product());
        let inertia = Matrix3::new(around_x, xy, xz, xy, around_y, yz, xz, yz, around_z);
        let plus = dice.random_bool(0.35);
        let first = if plus { 0.0 } else { std::f64::consts::FRAC_PI_4 };
        let names = if plus {
            ["front", "right", "rear", "left"]
        } else {
            ["front_left", "front_right", "rear_right", "rear_left"]
        };
        // clockwise from the front
        let hubs = hubs(arm, first);
        let turn = if dice.random_bool(0.5) { 1.0 } else { -1.0 };
        let mut wrong = |by: f64| 1.0 + by * dice.random_range(-1.0..1.0);
        let said_mass = mass * wrong(0.05);
        let mut said = Vector3::new(around_x * wrong(0.3), around_y * wrong(0.3), around_z * wrong(0.3));
        // no maker states what no body has
        said.z = said.z.clamp(1.02 * (said.x - said.y).abs(), 0.98 * (said.x + said.y));
        Self {
            mass,
            inertia,
            hubs,
            spins: [-turn, turn, -turn, turn],
            names,
            radius,
            thrust_coefficient,
            torque_coefficient,
            speed_max,
            said_mass,
            said_inertia: said,
            said_curve: None,
            said_lag: None,
            pulses: false,
        }
    }

    /// A vehicle within 25 % of one of four in all that makes it; the maker's mass and inertia are wrong.
    pub fn near_a_base(seed: u64, pulses: bool) -> Self {
        let mut dice = dice(seed, 1);
        let [mass, arm, radius, thrust, ratio, around_x] = BASES[dice.random_range(0..BASES.len())];
        let mut near = |value: f64, by: f64| value * dice.random_range(1.0 - by..1.0 + by);
        let (mass, arm, radius) = (near(mass, 0.2), near(arm, 0.2), near(radius, 0.2));
        let thrust_coefficient = near(thrust, 0.2);
        let torque_coefficient = thrust_coefficient * near(ratio, 0.15);
        let around_x = near(around_x, 0.2);
        let around_y = near(around_x, 0.12);
        let around_z = near(0.86 * (around_x + around_y), 0.08);
        let said_mass = near(mass, 0.06);
        let said_x = near(around_x, 0.4);
        let said_z = near(around_z, 0.3).clamp(0.2 * said_x, 1.96 * said_x);
        let hover_speed = (mass * GRAVITY / (4.0 * thrust_coefficient)).sqrt();
        let speed_max = hover_speed / near(0.61, 0.15);
        let mut product = || 0.035 * around_x * dice.random_range(-1.0..1.0);
        let (xy, xz, yz) = (product(), product(), product());
        let mut craft = Self::random(seed);
        craft.hubs = hubs(arm, std::f64::consts::FRAC_PI_4);
        craft.names = ["front_left", "front_right", "rear_right", "rear_left"];
        craft.spins = [-1.0, 1.0, -1.0, 1.0];
        craft.inertia = Matrix3::new(around_x, xy, xz, xy, around_y, yz, xz, yz, around_z);
        craft.said_inertia = Vector3::new(said_x, said_x, said_z);
        Self { mass, radius, thrust_coefficient, torque_coefficient, speed_max, said_mass, pulses, ..craft }
    }

    /// rad/s at which four rotors carry the vehicle
    pub fn hover_speed(&self) -> f64 {
        (self.mass * GRAVITY / (4.0 * self.thrust_coefficient)).sqrt()
    }

    /// Distance of a hub from the middle, m.
    pub fn arm(&self) -> f64 {
        self.hubs[0].norm()
    }

    /// Mean of Ixx and Iyy, kg m^2.
    pub fn roll_inertia(&self) -> f64 {
        0.5 * (self.inertia[(0, 0)] + self.inertia[(1, 1)])
    }

    /// What the maker says of the rotors: speeds, or thrusts that are right in hover.
    fn propulsion(&self) -> String {
        let lag = self.said_lag.map_or_else(String::new, |lag| format!("time_constant = {lag:.5}\n"));
        if self.pulses {
            return format!(
                "actuator = \"pwm\"\npwm_min = 1000\npwm_max = 2000\nthrust_max = {:.5}           # N\n\
                 thrust_expo = 1.0\ntorque_ratio = {:.6}         # N m per N\n{lag}",
                self.thrust_coefficient * self.speed_max * self.speed_max,
                self.torque_coefficient / self.thrust_coefficient,
            );
        }
        let Some(f) = self.said_curve else {
            return format!(
                "actuator = \"speed\"               # u in 0..1 commands the rotor speed u * speed_max\n\
                 speed_max = {:.3}             # rad/s\n\
                 thrust_coefficient = {:.6e}   # N/(rad/s)^2\n\
                 torque_coefficient = {:.6e}   # N m/(rad/s)^2\n{lag}",
                self.speed_max, self.thrust_coefficient, self.torque_coefficient,
            );
        };
        let hover = self.hover_speed() / self.speed_max;
        let most = 0.25 * self.mass * GRAVITY / ((1.0 - f) * hover + f * hover * hover);
        format!(
            "actuator = \"thrust\"              # thrust_max ((1 - thrust_expo) u + thrust_expo u^2)\n\
             thrust_max = {most:.5}           # N\nthrust_expo = {f:.4}\ntorque_ratio = {:.6}         # N m per N\n",
            self.torque_coefficient / self.thrust_coefficient,
        )
    }

    /// The maker's file.
    pub fn file(&self, name: &str) -> String {
        let said = self.said_inertia;
        let mut text = format!(
            "# Nominal vehicle: what its maker states. Body frame FLU (x forward, y left, z up).\n\
             name = \"{name}\"\n\n\
             [body]\nmass = {:.4}                 # kg\n\
             inertia = {{ xx = {:.6e}, yy = {:.6e}, zz = {:.6e} }}   # kg m^2\n\n\
             [propulsion]\n{}rotor_radius = {:.5}           # m\n",
            self.said_mass,
            said.x,
            said.y,
            said.z,
            self.propulsion(),
            self.radius,
        );
        for ((hub, spin), name) in self.hubs.iter().zip(self.spins).zip(self.names) {
            let spin = if spin > 0.0 { "ccw" } else { "cw" };
            let _ = write!(
                text,
                "\n[[rotor]]\nname = \"{name}\"\nposition = [{:.6}, {:.6}, {:.6}]\nspin = \"{spin}\"\n",
                hub.x, hub.y, hub.z
            );
        }
        text
    }
}
