//! What one rotor does to the vehicle.

use nalgebra::Vector3;

use super::AIR_DENSITY;
use super::hidden::{Ceiling, Ground, Hidden, Inflow};
use super::vehicle::Craft;

/// How a rotor stands in the air.
#[derive(Debug, Clone, Copy)]
pub struct Stance {
    /// rad/s
    pub speed: f64,
    /// rad/s^2
    pub spin_up: f64,
    /// m/s of its hub through the air, body
    pub through_air: Vector3<f64>,
    /// m/s of its hub from turning alone, body
    pub from_turning: Vector3<f64>,
    /// m above the ground
    pub height: f64,
}

/// Force and torque about its hub, body.
#[derive(Debug, Clone, Copy, Default)]
pub struct Load {
    /// N along the axis
    pub thrust: f64,
    /// N
    pub force: Vector3<f64>,
    /// N m
    pub torque: Vector3<f64>,
    /// kg m^2/s
    pub spin: Vector3<f64>,
}

/// Where the rotors' axes point, body.
pub fn axis(hidden: &Hidden) -> Vector3<f64> {
    let (about_x, about_y) = hidden.cant;
    Vector3::new(about_y.sin(), -about_x.sin() * about_y.cos(), about_x.cos() * about_y.cos())
}

/// Load of rotor `index`.
pub fn load(craft: &Craft, hidden: &Hidden, index: usize, stance: &Stance) -> Load {
    let axis = axis(hidden);
    let square = stance.speed * stance.speed;
    let climb = stance.through_air.dot(&axis);
    let along_disc = stance.through_air - climb * axis;
    let left = hidden.weak.map_or(1.0, |(weak, left)| if weak == index { left } else { 1.0 });
    let mut thrust = match hidden.inflow {
        None => craft.thrust_coefficient * square,
        Some(law) => with_inflow(craft, law, stance.speed, (climb, along_disc.norm())),
    };
    thrust -= hidden.damping.0 * stance.speed * stance.from_turning.z;
    thrust *= left * near_ground(hidden.ground, stance.height / craft.radius);
    thrust *= below_ceiling(hidden.ceiling, stance.height, craft.radius);
    let spin = craft.spins[index];
    let drag = -hidden.rotor_drag * stance.speed * along_disc;
    let mut torque = -spin * left * craft.torque_coefficient * square * axis;
    if hidden.rotor_inertia > 0.0 {
        torque -= spin * hidden.rotor_inertia * stance.spin_up * axis;
    }
    if hidden.flap > 0.0 {
        // the disc leans away from the wind by an angle in proportion to the advance ratio
        let advance = along_disc / (stance.speed * craft.radius).max(1.0);
        torque -= hidden.flap * axis.cross(&advance);
    }
    Load {
        thrust,
        force: thrust * axis + drag,
        torque,
        spin: spin * hidden.rotor_inertia * stance.speed * axis,
    }
}

/// Gain of thrust `radii` above the ground.
pub fn near_ground(ground: Option<Ground>, radii: f64) -> f64 {
    let radii = radii.max(0.5);
    match ground {
        None => 1.0,
        Some(Ground::Image(rho)) => 1.0 / (1.0 - (rho / (16.0 * radii * radii)).min(0.6)),
        Some(Ground::Exponential(a, b)) => 1.0 + a * (-b * radii).exp(),
    }
}

/// Gain of thrust below a ceiling.
pub fn below_ceiling(ceiling: Option<Ceiling>, height: f64, radius: f64) -> f64 {
    match ceiling {
        None => 1.0,
        Some(Ceiling::Suction(top, a1, a2)) => {
            let ratio = radius / ((top - height).max(0.0) + a2);
            1.0 / (1.0 - (ratio * ratio / a1).min(0.6))
        }
        Some(Ceiling::Exponential(top, a)) => 1.0 + a * (-(top - height).max(0.0) / radius).exp(),
    }
}

/// Thrust with air that comes in at `climb` along the axis and `along` the disc, m/s.
fn with_inflow(craft: &Craft, law: Inflow, speed: f64, (climb, along): (f64, f64)) -> f64 {
    let still = craft.thrust_coefficient * speed * speed;
    match law {
        Inflow::Linear(loss) => still - loss * speed * climb,
        Inflow::Axial(share) => induced(craft, share, speed, (climb, 0.0)),
        Inflow::Edgewise(share) => induced(craft, share, speed, (0.0, along)),
        Inflow::VortexRing(share) => {
            let hover = hover_flow(craft, speed);
            still * (1.0 - share * ring_excess(climb / hover))
        }
    }
}

/// m/s induced in hover at a rotor speed.
pub fn hover_flow(craft: &Craft, speed: f64) -> f64 {
    (craft.thrust_coefficient * speed * speed / (2.0 * AIR_DENSITY * disc(craft))).sqrt().max(0.1)
}

/// m^2
fn disc(craft: &Craft) -> f64 {
    std::f64::consts::PI * craft.radius * craft.radius
}

/// Blade element `T = A W^2 - B W (climb + induced)` and momentum `T = 2 rho D induced |flow|`, right in hover,
/// where the induced flow costs `share` of the thrust.
pub fn induced(craft: &Craft, share: f64, speed: f64, (climb, along): (f64, f64)) -> f64 {
    let still = craft.thrust_coefficient * speed * speed;
    let hover = hover_flow(craft, speed);
    let blade = |flow: f64| still * (1.0 + share * (1.0 - (climb + flow) / hover));
    let disc = 2.0 * AIR_DENSITY * disc(craft);
    // the blade's thrust falls with the flow, the momentum's grows: one crossing
    let (mut low, mut high) = (0.0, hover * (2.0 + 1.0 / share) + climb.abs());
    for _ in 0..40 {
        let flow = 0.5 * (low + high);
        let momentum = disc * flow * along.hypot(climb + flow);
        if momentum < blade(flow) { low = flow } else { high = flow }
    }
    blade(0.5 * (low + high))
}

/// Flow that a vortex ring induces beyond momentum theory, in units of hover's; `climb` in the same.
/// Leishman, Principles of Helicopter Aerodynamics, 2nd ed., (2.96); in hover and below -2 nothing.
pub fn ring_excess(climb: f64) -> f64 {
    if !(-2.0..0.0).contains(&climb) {
        return 0.0;
    }
    let x = climb;
    let measured = 1.15 + x * (-1.125 + x * (-1.372 + x * (-1.718 - 0.655 * x)));
    let momentum = (0.25 * x * x + 1.0).sqrt() - 0.5 * x;
    (measured - momentum - 0.15).max(0.0)
}
