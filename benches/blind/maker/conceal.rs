//! What each effect of the catalogue conceals, in what sizes, and the room that shows it.

use nalgebra::{Rotation3, Vector3};
use rand::{Rng, RngExt};

use super::AIR_DENSITY;
use super::catalogue::{Case, identifier};
use super::hidden::{Ceiling, Ground, Gust, Inflow, Load, Outside};
use super::rotors::{hover_flow, induced};

impl Case {
    fn note(&mut self, id: &'static str, values: &[(&'static str, f64)]) {
        self.expect.push(id);
        self.truth.extend(values.iter().map(|&(name, value)| (id, name, value)));
    }

    /// A drag through which moving air shows.
    fn draggy(&mut self, dice: &mut impl Rng) {
        if self.hidden.rotor_drag == 0.0 {
            self.conceal("linear_drag", dice);
        }
    }

    /// Conceals one entry of the catalogue.
    pub fn conceal(&mut self, entry: &'static str, dice: &mut impl Rng) {
        let id = identifier(entry);
        let (mass, arm) = (self.craft.mass, self.craft.arm());
        // a sum over the rotors of what goes with their speed
        let all_speeds = 4.0 * self.craft.hover_speed();
        match id {
            "linear_drag" => {
                let size = mass * dice.random_range(0.1..0.5);
                self.hidden.rotor_drag = size / all_speeds;
                self.note(id, &[("dx", size), ("dy", size)]);
            }
            "quadratic_drag" => {
                let size = mass * dice.random_range(0.04..0.15);
                let shape = Vector3::new(1.0, dice.random_range(0.7..1.4), dice.random_range(0.8..1.8));
                self.hidden.drag_area = shape * size / (0.5 * AIR_DENSITY);
                self.room.speed = dice.random_range(2.0..4.0);
                self.note(id, &[("cx", size), ("cy", size * shape.y), ("cz", size * shape.z)]);
            }
            "ground_effect" => {
                let radius = self.craft.radius;
                self.room.heights = (1.4 * radius, 1.4 * radius + 0.9);
                let (law, values) = if entry.ends_with("exponential") {
                    let (a, b) = (dice.random_range(0.3..0.9), dice.random_range(0.7..1.4));
                    (Ground::Exponential(a, b), [("ca", a), ("cb", b)])
                } else {
                    let rho = dice.random_range(1.5..5.0);
                    (Ground::Image(rho), [("rho", rho), ("rho", rho)])
                };
                self.hidden.ground = Some(law);
                self.note(id, &values);
            }
            "ceiling_effect" => {
                // nearer, its suction draws the vehicle through it
                let top = self.room.heights.1 + dice.random_range(1.8..2.5) * self.craft.radius;
                self.hidden.ceiling = Some(if entry.ends_with("exponential") {
                    Ceiling::Exponential(top, dice.random_range(0.3..0.8))
                } else {
                    Ceiling::Suction(top, dice.random_range(3.0..6.0), 0.3 * self.craft.radius)
                });
                self.room.lively_climb = true;
                self.note(id, &[("height", top)]);
            }
            "motor_lag" => {
                let up = dice.random_range(0.02..0.07);
                let down = if entry.ends_with("asymmetric") { 1.6 * up } else { up };
                self.hidden.lag = (up, down);
                if down > up {
                    self.note(id, &[("time_constant", up), ("time_constant_down", down)]);
                } else {
                    self.note(id, &[("time_constant", up)]);
                }
            }
            "transport_delay" => {
                self.hidden.delay = dice.random_range(0.012..0.035);
                // beyond the motors' own 4 ms and the half tick that every flight has
                self.note(id, &[("delay", self.hidden.delay)]);
            }
            "com_offset" => {
                let size = arm * dice.random_range(0.015..0.06);
                let way: f64 = dice.random_range(0.0..std::f64::consts::TAU);
                self.hidden.centre = size * Vector3::new(way.cos(), way.sin(), 0.0);
                self.note(id, &[("x", self.hidden.centre.x), ("y", self.hidden.centre.y)]);
            }
            "weak_rotor" => {
                let (rotor, left) = (dice.random_range(0..4_usize), dice.random_range(0.85..0.96));
                self.hidden.weak = Some((rotor, left));
                self.weak = Some(self.craft.names[rotor]);
                self.note(id, &[("factor", left)]);
            }
            "battery_sag" => self.sag(id, dice),
            "thrust_curve" => {
                let f = dice.random_range(0.3..0.9);
                self.hidden.curve = Some(f);
                self.room.lively_climb = true;
                if entry.ends_with("stated") {
                    // the file has the same law with another number
                    let off = if dice.random_bool(0.5) { 0.25 } else { -0.25 };
                    self.craft.said_curve = Some((f + off).clamp(0.05, 0.95));
                }
                self.note(id, &[("slope", self.slope(f))]);
            }
            "inflow" => self.inflow(entry, dice),
            "translational_lift" => {
                self.hidden.inflow = Some(Inflow::Edgewise(dice.random_range(0.5..1.0)));
                self.room.speed = dice.random_range(2.0..4.0);
                self.note(id, &[]);
            }
            "vortex_ring" => {
                let share = dice.random_range(0.6..1.0);
                self.hidden.inflow = Some(Inflow::VortexRing(share));
                self.descents(dice);
                self.note(id, &[("share", share)]);
            }
            "steady_wind" | "gust" => {
                self.draggy(dice);
                self.windy(id, dice);
            }
            "nothing" => self.only_the_room(entry, dice),
            "mass_change" => {
                let (when, by) = (dice.random_range(15.0..40.0_f64), dice.random_range(-0.25..-0.05));
                let when = (when * 250.0).round() / 250.0;
                self.hidden.drop = Some((when, by * mass));
                self.note(id, &[("time", when), ("delta", by * mass)]);
            }
            _ => self.conceal_more(entry, dice),
        }
    }

    /// The second half of the list.
    fn conceal_more(&mut self, entry: &'static str, dice: &mut impl Rng) {
        let id = identifier(entry);
        let (mass, arm, hover) = (self.craft.mass, self.craft.arm(), self.craft.hover_speed());
        let roll = self.craft.roll_inertia();
        let sign = |dice: &mut dyn FnMut() -> bool| if dice() { 1.0 } else { -1.0 };
        let angles = |dice: &mut dyn FnMut(f64, f64) -> f64| {
            let (size, way) = (dice(0.025, 0.06), dice(0.0, std::f64::consts::TAU));
            (size * way.cos(), size * way.sin())
        };
        match id {
            "thrust_tilt" => {
                let (x, y) = angles(&mut |low, high| dice.random_range(low..high));
                self.hidden.cant = (x, y);
                self.note(id, &[("x", x), ("y", y)]);
            }
            "rotor_inertia" => {
                let size = self.craft.inertia[(2, 2)] * dice.random_range(0.4e-3..1.5e-3);
                self.hidden.rotor_inertia = size;
                self.note(id, &[("jr", size)]);
            }
            "angular_damping" => {
                let size = roll * dice.random_range(0.5..2.0);
                // sum of k W x^2 over the hubs
                let squares: f64 = self.craft.hubs.iter().map(|hub| hub.x * hub.x).sum();
                let around_z = size * dice.random_range(0.5..1.5);
                self.hidden.damping = (size / (hover * squares), around_z);
                self.note(id, &[("bx", size), ("by", size), ("bz", around_z)]);
            }
            "blade_flapping" => {
                let size = roll * dice.random_range(0.4..2.0);
                self.hidden.flap = size * hover * self.craft.radius / 4.0;
                self.note(id, &[("k", size)]);
            }
            "slung_load" => {
                let load = Load {
                    mass: mass * dice.random_range(0.06..0.15),
                    length: dice.random_range(0.5..1.1),
                    drag: 0.0,
                };
                let load = Load { drag: 0.1 * load.mass, ..load };
                self.hidden.load = Some(load);
                (self.room.speed, self.room.acceleration) = (1.2, 1.2);
                self.room.heights = (load.length + 0.3, load.length + 1.8);
                self.note(id, &[("mass", load.mass), ("length", load.length)]);
            }
            "tether" => {
                self.hidden.cable = mass * dice.random_range(0.02..0.06);
                self.room.heights = (0.8, 4.5);
                self.room.lively_climb = true;
                self.room.speed = 2.5;
                self.note(id, &[("line_mass", self.hidden.cable)]);
            }
            "imu_misalignment" => {
                let (x, y) = angles(&mut |low, high| dice.random_range(low..high));
                self.hidden.imu_turned = Rotation3::new(Vector3::new(x, y, 0.5 * (x + y)));
                self.hidden.rates_turned = entry == id;
                self.note(id, &[("x", x), ("y", y)]);
            }
            "frame_misalignment" => {
                let (x, y) = angles(&mut |low, high| dice.random_range(low..high));
                self.hidden.frame_turned = Rotation3::new(Vector3::new(x, y, 0.5 * (x - y)));
                self.hidden.attitude_in_frame = entry != id;
                self.note(id, &[("x", x), ("y", y)]);
            }
            "imu_offset" => {
                let mut one = || sign(&mut || dice.random_bool(0.5)) * dice.random_range(0.15..0.35) * arm;
                self.hidden.imu_at = Vector3::new(one(), one(), 0.5 * one());
                let [x, y, z] = [self.hidden.imu_at.x, self.hidden.imu_at.y, self.hidden.imu_at.z];
                self.note(id, &[("x", x), ("y", y), ("z", z)]);
            }
            _ => self.outside(id, dice),
        }
    }

    /// The room of an effect without the effect.
    fn only_the_room(&mut self, entry: &str, dice: &mut impl Rng) {
        let low = 1.4 * self.craft.radius;
        match entry {
            "nothing+fast" => self.descents(dice),
            "nothing+low" => self.room.heights = (low, low + 0.9),
            "nothing+gentle" => (self.room.speed, self.room.acceleration) = (1.2, 1.2),
            _ => (self.room.speed, self.room.lively_climb) = (2.5, true),
        }
    }

    /// Down fast, as a vortex ring takes.
    fn descents(&mut self, dice: &mut impl Rng) {
        let flow = hover_flow(&self.craft, self.craft.hover_speed());
        self.room.heights = (2.0, 40.0);
        self.room.speed = flow * dice.random_range(0.8..1.2);
        self.room.acceleration = 8.0;
        (self.room.lively_climb, self.room.plunge) = (true, true);
    }

    /// What no library has.
    fn outside(&mut self, id: &'static str, dice: &mut impl Rng) {
        let mass = self.craft.mass;
        let middle = dice.random_range(-0.4..0.4);
        self.hidden.outside = Some(match id {
            "updraft" => {
                self.conceal("inflow", dice);
                Outside::Updraft([middle, -middle], dice.random_range(0.3..0.6), dice.random_range(1.0..2.5))
            }
            "wall" => Outside::Wall(1.8, mass * dice.random_range(3.0..8.0)),
            "arm" => {
                let rate = std::f64::consts::TAU * dice.random_range(6.0..10.0);
                Outside::Arm(dice.random_range(0..4), rate, 0.12)
            }
            _ => {
                let size = mass * dice.random_range(0.5..1.5);
                let way = Rotation3::new(Vector3::new(dice.random_range(0.0..6.0), 0.0, middle));
                let force = way * Vector3::new(0.0, 0.0, size);
                Outside::Region(dice.random_range(0..2), middle, dice.random_range(0.15..0.35), force)
            }
        });
        self.expect.push("unexplained");
    }

    fn sag(&mut self, id: &'static str, dice: &mut impl Rng) {
        let hover = 4.0 * self.craft.torque_coefficient * self.craft.hover_speed().powi(3);
        let battery = &mut self.hidden.battery;
        // as much in a minute of hover
        let spent = dice.random_range(0.3..0.7);
        battery.per_joule = spent / (60.0 * hover / battery.efficiency);
        battery.resistance = 0.03 * battery.open_circuit.0.powi(2) / (hover / battery.efficiency);
        battery.exponent = dice.random_range(1.4..2.0);
        let exponent = battery.exponent;
        self.note(id, &[("exponent", exponent)]);
    }

    fn inflow(&mut self, entry: &'static str, dice: &mut impl Rng) {
        let (mass, hover) = (self.craft.mass, self.craft.hover_speed());
        self.room.speed = self.room.speed.max(1.5);
        self.room.lively_climb = true;
        let size = if entry.ends_with("momentum") {
            let share = dice.random_range(0.5..1.0);
            self.hidden.inflow = Some(Inflow::Axial(share));
            // slope in hover
            let thrust = |climb| induced(&self.craft, share, hover, (climb, 0.0));
            4.0 * (thrust(-0.1) - thrust(0.1)) / 0.2
        } else {
            let size = mass * dice.random_range(0.2..0.6);
            self.hidden.inflow = Some(Inflow::Linear(size / (4.0 * hover)));
            size
        };
        self.note(identifier(entry), &[("kz", size)]);
    }

    fn windy(&mut self, id: &'static str, dice: &mut impl Rng) {
        if id == "gust" {
            let gust = Gust { sigma: dice.random_range(0.5..1.2), time: dice.random_range(0.7..2.5) };
            self.hidden.gust = Some(gust);
            return self.note(id, &[("sigma", gust.sigma), ("correlation_time", gust.time)]);
        }
        let (size, way) = (dice.random_range(1.0..4.0_f64), dice.random_range(0.0..std::f64::consts::TAU));
        self.hidden.wind = size * Vector3::new(way.cos(), way.sin(), 0.0);
        self.note(id, &[("north", self.hidden.wind.x), ("west", self.hidden.wind.y)]);
    }

    /// d ln T / d ln u at hover.
    fn slope(&self, f: f64) -> f64 {
        let u = self.craft.hover_speed() / self.craft.speed_max;
        ((1.0 - f) * u + 2.0 * f * u * u) / ((1.0 - f) * u + f * u * u)
    }
}
