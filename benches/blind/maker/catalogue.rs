//! Flights to be made: vehicle, what is concealed, room, and how it is recorded.

use rand::RngExt;

use super::controller::Doubt;
use super::dice;
use super::flight::{Instant, Lost, fly};
use super::hidden::Hidden;
use super::path::{Path, Room};
use super::telemetry::{self, Conditions};
use super::vehicle::Craft;

/// Effects that the library knows; a name with `+` is another formula of the one before it.
pub const EFFECTS: &[&str] = &[
    "linear_drag",
    "quadratic_drag",
    "ground_effect",
    "ground_effect+exponential",
    "motor_lag",
    "motor_lag+asymmetric",
    "transport_delay",
    "com_offset",
    "weak_rotor",
    "battery_sag",
    "thrust_curve",
    "thrust_curve+stated",
    "inflow",
    "inflow+momentum",
    "steady_wind",
    "mass_change",
    "thrust_tilt",
    "rotor_inertia",
    "angular_damping",
    "blade_flapping",
    "translational_lift",
    "gust",
    "slung_load",
    "tether",
    "imu_misalignment",
    "imu_misalignment+acc",
    "imu_offset",
    "frame_misalignment",
    "frame_misalignment+attitude",
    "vortex_ring",
    "ceiling_effect",
    "ceiling_effect+exponential",
];

/// Nothing concealed, in the rooms of the effects that need one of their own.
pub const CONTROLS: &[&str] = &["nothing+fast", "nothing+climb", "nothing+low", "nothing+gentle"];

/// Of no library.
pub const OUTSIDE: &[&str] = &["force_region", "updraft", "wall", "arm"];

/// Two at once.
pub const PAIRS: &[[&str; 2]] = &[
    ["linear_drag", "com_offset"],
    ["linear_drag", "ground_effect+exponential"],
    ["motor_lag", "linear_drag"],
    ["weak_rotor", "linear_drag"],
    ["mass_change", "com_offset"],
    ["transport_delay", "quadratic_drag"],
    ["inflow+momentum", "linear_drag"],
    ["battery_sag", "weak_rotor"],
    ["thrust_curve", "com_offset"],
    ["motor_lag", "mass_change"],
];

/// A flight to be made.
#[derive(Debug, Clone)]
pub struct Case {
    pub seed: u64,
    /// identifiers as in the table of effects; empty: nothing is concealed
    pub expect: Vec<&'static str>,
    /// effect, parameter, value
    pub truth: Vec<(&'static str, &'static str, f64)>,
    /// which rotor is weak
    pub weak: Option<&'static str>,
    pub craft: Craft,
    pub hidden: Hidden,
    pub room: Room,
    pub conditions: Conditions,
}

/// Identifier of an entry of [`EFFECTS`].
pub fn identifier(entry: &'static str) -> &'static str {
    entry.split('+').next().unwrap_or(entry)
}

impl Case {
    /// The case of a seed with what `entries` name.
    pub fn new(seed: u64, entries: &[&'static str]) -> Self {
        let mut dice = dice(seed, 7);
        let craft = Craft::random(seed);
        let low = dice.random_range(0.7..1.2);
        let room = Room {
            speed: dice.random_range(0.8..3.0),
            acceleration: 4.5,
            heights: (low, low + dice.random_range(1.0..2.5)),
            climb: f64::INFINITY,
            lively_climb: false,
            plunge: false,
            fall: 1.0,
        };
        let conditions = Conditions::random(seed);
        let (hidden, expect, truth) = (Hidden::default(), Vec::new(), Vec::new());
        let mut case = Self { seed, expect, truth, weak: None, craft, hidden, room, conditions };
        for entry in entries {
            case.conceal(entry, &mut dice);
        }
        case
    }

    /// Flies it; `flight` 0 is the one to explain, 1 the one held out.
    pub fn fly(&self, flight: u64) -> Result<Vec<Instant>, Lost> {
        let seed = self.seed.wrapping_mul(2).wrapping_add(flight);
        let path = Path::random(seed, self.room, (flight > 0).then_some(3.0));
        fly(&self.craft, &self.hidden, &path, (seed, self.doubt()))
    }

    /// Its log.
    pub fn log(&self, flown: &[Instant], flight: u64) -> Vec<u8> {
        let seed = self.seed.wrapping_mul(2).wrapping_add(flight);
        telemetry::log(flown, &self.hidden, (seed, self.conditions))
    }

    /// What the controller's estimates are wrong by.
    fn doubt(&self) -> Doubt {
        let mut dice = dice(self.seed, 8);
        let size = dice.random_range(0.5..1.5);
        Doubt {
            position: 0.004 * size,
            velocity: 0.03 * size,
            attitude: 0.004 * size,
            rates: 0.03 * size,
            output: dice.random_range(0.002..0.02),
        }
    }
}
