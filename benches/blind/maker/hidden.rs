//! What may be concealed in a flight.

use nalgebra::{Rotation3, Vector3};

/// Thrust near the ground.
#[derive(Debug, Clone, Copy)]
pub enum Ground {
    /// `1 / (1 - rho (R / 4z)^2)` of each rotor's height
    Image(f64),
    /// `1 + a exp(-b z / R)` of each rotor's height
    Exponential(f64, f64),
}

/// Thrust below a ceiling.
#[derive(Debug, Clone, Copy)]
pub enum Ceiling {
    /// height, a1, a2 of `1 / (1 - (R / (z + a2))^2 / a1)`
    Suction(f64, f64, f64),
    /// height, a of `1 + a exp(-z / R)`
    Exponential(f64, f64),
}

/// How thrust falls with the air that comes in.
#[derive(Debug, Clone, Copy)]
pub enum Inflow {
    /// N/(m/s) per rad/s of each rotor
    Linear(f64),
    /// blade element against momentum theory; what part of the hover thrust the induced flow costs
    Axial(f64),
    /// the same with flow along the disc alone
    Edgewise(f64),
    /// what a vortex ring induces beyond momentum theory (Leishman's polynomial)
    VortexRing(f64),
}

/// A pack with an open-circuit voltage and a resistance.
#[derive(Debug, Clone, Copy)]
pub struct Battery {
    /// V when full and when empty
    pub open_circuit: (f64, f64),
    /// ohm
    pub resistance: f64,
    /// of full to empty per joule
    pub per_joule: f64,
    /// thrust goes with this power of the voltage; 0: the controllers hold the speed
    pub exponent: f64,
    /// share of electric power that turns the rotors
    pub efficiency: f64,
    /// V/s by which it falls where the controllers hold the speed
    pub fall: f64,
}

/// A load on a cord from the centre of mass.
#[derive(Debug, Clone, Copy)]
pub struct Load {
    /// kg
    pub mass: f64,
    /// m
    pub length: f64,
    /// N/(m/s) of the load in the air
    pub drag: f64,
}

/// Turbulence after Dryden: one sigma and time constant for all three directions.
#[derive(Debug, Clone, Copy)]
pub struct Gust {
    /// m/s
    pub sigma: f64,
    /// s
    pub time: f64,
}

/// What no library of vehicle effects has.
#[derive(Debug, Clone, Copy)]
pub enum Outside {
    /// a force in a slab of the room: axis, centre, width, force
    Region(usize, f64, f64, Vector3<f64>),
    /// a column in which the air rises: centre, width, speed
    Updraft([f64; 2], f64, f64),
    /// a wall at a distance along world y that draws: N at one radius
    Wall(f64, f64),
    /// an arm that rings: which, rad/s, damping ratio
    Arm(usize, f64, f64),
}

/// Everything that a rigid body with exact thrust has not. The default is nothing.
#[derive(Debug, Clone)]
pub struct Hidden {
    /// N/(m/s) per rad/s of each rotor, at its hub
    pub rotor_drag: f64,
    /// m^2 along each body axis
    pub drag_area: Vector3<f64>,
    /// near the ground
    pub ground: Option<Ground>,
    /// near the ceiling
    pub ceiling: Option<Ceiling>,
    /// s, rotors that speed up and that slow down
    pub lag: (f64, f64),
    /// s
    pub delay: f64,
    /// thrust goes as `(1 - f) u + f u^2`, right at hover
    pub curve: Option<f64>,
    /// which rotor and what is left of it
    pub weak: Option<(usize, f64)>,
    /// m from the drawing's origin
    pub centre: Vector3<f64>,
    /// rad about x and y by which every rotor leans
    pub cant: (f64, f64),
    /// kg m^2 of one rotor
    pub rotor_inertia: f64,
    /// N/(m/s) per rad/s that a blade loses by the hub's motion from turning, and N m/(rad/s) about z
    pub damping: (f64, f64),
    /// N m rad: stiffness of the hub times flap angle per advance ratio
    pub flap: f64,
    /// what air that comes in costs
    pub inflow: Option<Inflow>,
    /// m/s, world
    pub wind: Vector3<f64>,
    /// turbulence
    pub gust: Option<Gust>,
    /// a load on a cord
    pub load: Option<Load>,
    /// s and kg
    pub drop: Option<(f64, f64)>,
    /// kg/m of a cable that is lifted from the ground
    pub cable: f64,
    /// how the inertial unit sits in the body
    pub imu_turned: Rotation3<f64>,
    /// whether the attitude message's rates come from that unit
    pub rates_turned: bool,
    /// m from the centre of mass
    pub imu_at: Vector3<f64>,
    /// how the position reference sits in the world
    pub frame_turned: Rotation3<f64>,
    /// whether that reference tells the attitude as well, as motion capture does
    pub attitude_in_frame: bool,
    /// the pack
    pub battery: Battery,
    /// of no library
    pub outside: Option<Outside>,
}

impl Default for Hidden {
    fn default() -> Self {
        Self {
            rotor_drag: 0.0,
            drag_area: Vector3::zeros(),
            ground: None,
            ceiling: None,
            // as the practice cases say of their motors
            lag: (0.004, 0.004),
            delay: 0.0,
            curve: None,
            weak: None,
            centre: Vector3::zeros(),
            cant: (0.0, 0.0),
            rotor_inertia: 0.0,
            damping: (0.0, 0.0),
            flap: 0.0,
            inflow: None,
            wind: Vector3::zeros(),
            gust: None,
            load: None,
            drop: None,
            cable: 0.0,
            imu_turned: Rotation3::identity(),
            rates_turned: false,
            imu_at: Vector3::zeros(),
            frame_turned: Rotation3::identity(),
            attitude_in_frame: false,
            battery: Battery {
                open_circuit: (16.6, 13.6),
                resistance: 0.0,
                per_joule: 0.0,
                exponent: 0.0,
                efficiency: 0.6,
                fall: 0.004,
            },
            outside: None,
        }
    }
}
