//! Flights to be made with an estimator in the loop.

use nalgebra::Vector3;
use rand::RngExt;

use super::super::catalogue::{Case, identifier};
use super::super::flight::Lost;
use super::super::hidden::Hidden;
use super::super::path::{Path, Room};
use super::super::vehicle::Craft;
use super::super::{AIR_DENSITY, dice};
use super::flight::{Flown, Senses, fly};
use super::inertial::Unit;
use super::position::{Source, Trust};
use super::streams::Streams;
use super::visibility::PLAIN;
use super::{spread, telemetry};

/// What is concealed here.
pub const EFFECTS: &[&str] = &[
    "linear_drag",
    "quadratic_drag",
    "ground_effect",
    "motor_lag",
    "transport_delay",
    "com_offset",
    "weak_rotor",
    "battery_sag",
    "thrust_curve",
    "inflow",
    "translational_lift",
    "steady_wind",
    "mass_change",
    "thrust_tilt",
    "rotor_inertia",
    "angular_damping",
    "blade_flapping",
];

/// Two and four at once.
pub const SEVERAL: &[&[&str]] = &[
    &["quadratic_drag", "weak_rotor"],
    &["linear_drag", "com_offset"],
    &["inflow", "mass_change"],
    &["thrust_tilt", "linear_drag"],
    &["linear_drag", "weak_rotor", "blade_flapping", "battery_sag"],
    &["quadratic_drag", "com_offset", "inflow", "transport_delay"],
    &["linear_drag", "com_offset", "mass_change", "angular_damping"],
    &["linear_drag", "weak_rotor", "inflow", "thrust_tilt"],
];

/// Of these an ordinary mission shows too little.
const NEED_MOTION: &[&str] = &[
    "quadratic_drag",
    "motor_lag",
    "transport_delay",
    "thrust_curve",
    "inflow",
    "translational_lift",
    "rotor_inertia",
    "angular_damping",
    "ground_effect",
];

/// A flight to be made.
#[derive(Debug, Clone)]
pub struct RealCase {
    pub case: Case,
    pub senses: Senses,
    pub streams: Streams,
    /// else a Fourier series
    pub mission: bool,
    /// which draw of the seed was taken
    pub draw: u64,
}

/// Draws of a seed before it is given up.
const DRAWS: u64 = 12;

impl RealCase {
    /// The first draw of a seed that flies both flights and shows what it conceals, with its flights.
    pub fn flown(seed: u64, entries: &[&'static str]) -> Result<(Self, [Flown; 2]), String> {
        let mut why = String::new();
        for draw in 0..DRAWS {
            let case = Self::new(seed, draw, entries);
            match case.fly(0) {
                Err(lost) => why = format!("{lost:?}"),
                Ok(first) if entries.len() == 1 && first.visibility.whole() < PLAIN => {
                    why = format!("shows only {:.1}", first.visibility.whole());
                }
                Ok(first) => match case.fly(1) {
                    Err(lost) => why = format!("hold-out: {lost:?}"),
                    Ok(second) => return Ok((case, [first, second])),
                },
            }
        }
        Err(why)
    }

    /// One draw of a seed.
    pub fn new(seed: u64, draw: u64, entries: &[&'static str]) -> Self {
        let own = seed.wrapping_mul(64).wrapping_add(draw);
        let mut dice = dice(own, 11);
        let ardupilot = dice.random_bool(0.5);
        let low = entries.iter().any(|entry| identifier(entry) == "ground_effect");
        // nobody flies centimetres above the ground by a receiver
        let motion_capture = dice.random_bool(0.41) || low;
        let needs = entries.iter().any(|entry| NEED_MOTION.contains(entry));
        let mission = dice.random_bool(0.5) && !needs;
        let unit = Unit::random(&mut dice);
        let source = Source::random(motion_capture, &mut dice);
        let trust = Trust::random(unit.white, &source, &mut dice);
        let senses = Senses { unit, source, trust, waits: dice.random_range(0..4_usize) };
        let streams = Streams::random(ardupilot, &mut dice);
        let mut case = Case::new(own, &[]);
        case.seed = own;
        case.craft = Craft::near_a_base(own, ardupilot);
        case.room = room(motion_capture, &mut dice);
        let lag = dice.random_range(0.012..0.035);
        case.hidden.lag = (lag, lag);
        case.hidden.battery.fall = spread(0.006, 0.03, &mut dice);
        let said = dice.random_bool(0.72);
        for entry in entries {
            case.conceal(entry, &mut dice);
            adjust(&mut case, identifier(entry), &mut dice);
        }
        let slow = entries.iter().any(|entry| identifier(entry) == "motor_lag");
        case.craft.said_lag = (said && !slow).then_some(lag);
        Self { case, senses, streams, mission, draw }
    }

    /// Whether a lag may be named beside what is concealed: the file does not state it.
    pub fn lag_may_be_named(&self) -> bool {
        self.case.craft.said_lag.is_none() && !self.case.expect.contains(&"motor_lag")
    }

    /// Flies it; `flight` 0 is the one to explain, 1 the one held out.
    pub fn fly(&self, flight: u64) -> Result<Flown, Lost> {
        let duration = if flight > 0 { 30.0 } else { 54.0 };
        self.fly_as((self.seed_of(flight), duration), &self.case.hidden, &self.senses)
    }

    /// Flies a path of its own seed, for so many s, with what is concealed and measured on that day.
    pub fn fly_as(
        &self,
        (seed, duration): (u64, f64),
        hidden: &Hidden,
        senses: &Senses,
    ) -> Result<Flown, Lost> {
        let Case { craft, room, .. } = &self.case;
        let path = if self.mission {
            let reach = if senses.source.motion_capture { 2.2 } else { 7.0 };
            Path::mission(seed, (*room, reach), duration)
        } else {
            let period = dice(seed, 12).random_range(10.5..14.5);
            Path::of_period(seed, *room, (period, duration))
        };
        fly((craft, hidden), &path, senses, seed)
    }

    /// Its log.
    pub fn log(&self, flown: &Flown, flight: u64) -> Vec<u8> {
        telemetry::log(flown, &self.streams, self.seed_of(flight))
    }

    fn seed_of(&self, flight: u64) -> u64 {
        self.case.seed.wrapping_mul(2).wrapping_add(flight)
    }
}

/// Indoors or in the open.
fn room(motion_capture: bool, dice: &mut impl rand::Rng) -> Room {
    let mut between = |low: f64, high: f64| dice.random_range(low..high);
    let (speed, acceleration, heights, fall) = if motion_capture {
        (between(1.6, 3.3), between(3.8, 7.5), (between(0.8, 1.0), between(1.9, 2.3)), 0.5)
    } else {
        (between(3.2, 6.2), between(5.5, 9.5), (between(1.5, 1.8), between(3.4, 4.6)), 1.0)
    };
    let climb = dice.random_range(0.6..1.5);
    Room { speed, acceleration, heights, climb, lively_climb: false, plunge: false, fall }
}

/// Sizes and rooms where they are others with an estimator in the loop.
fn adjust(case: &mut Case, id: &'static str, dice: &mut impl rand::Rng) {
    let replaced = |case: &mut Case, name: &str, value: f64| {
        let found = case.truth.iter_mut().find(|(other, parameter, _)| *other == id && *parameter == name);
        if let Some(entry) = found {
            entry.2 = value;
        }
    };
    // nobody climbs for the sake of an effect
    case.room.lively_climb = false;
    match id {
        // beyond what motors have
        "motor_lag" => {
            let lag = dice.random_range(0.042..0.075);
            case.hidden.lag = (lag, lag);
            replaced(case, "time_constant", lag);
        }
        "quadratic_drag" => {
            let size = case.hidden.drag_area.x * 0.5 * AIR_DENSITY;
            case.hidden.drag_area = Vector3::new(1.0, 1.0, 1.5) * case.hidden.drag_area.x;
            for (name, value) in [("cx", size), ("cy", size), ("cz", 1.5 * size)] {
                replaced(case, name, value);
            }
            case.room.speed = case.room.speed.max(2.5);
        }
        "translational_lift" => case.room.speed = case.room.speed.max(2.5),
        _ => {}
    }
}
