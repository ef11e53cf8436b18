//! Effects at sizes that ordinary vehicles have, and what a flight must have to show each.

#![allow(dead_code, clippy::unwrap_used, clippy::panic)] // no user uses all of it

use std::f64::consts::PI;
use std::sync::LazyLock;

use mavid::diagnose::signatures::signature_of;
use mavid::physics::ActiveEffect;
use mavid::physics::effects::ALL;
use mavid::simulate::{FlightSettings, RandomTrajectory};
use mavid::units::AIR_DENSITY_KG_M3;
use mavid::vehicle::Vehicle;

/// An effect, which has an ordinary size in its signature, and the flight that shows it.
#[derive(Clone, Copy)]
pub struct Ordinary {
    pub id: &'static str,
    pub shown_by: ShownBy,
}

/// What a flight must have for an effect to show.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum ShownBy {
    Motion,
    LowFlight,
    Ceiling,
    GentleMotion,
    Descent,
    FallingVoltage,
    StatedMotorLag,
    /// a drag through which the moving air acts is concealed as well
    Drag,
}

use ShownBy::{Ceiling, Descent, Drag, FallingVoltage, GentleMotion, LowFlight, Motion, StatedMotorLag};

/// Every effect of the library: shown by any motion, or as [`STATED`].
pub static ORDINARY: LazyLock<Vec<Ordinary>> = LazyLock::new(|| {
    let shown_by =
        |id: &str| STATED.iter().find(|entry| entry.id == id).map_or(Motion, |entry| entry.shown_by);
    ALL.iter().map(|effect| Ordinary { id: effect.id(), shown_by: shown_by(effect.id()) }).collect()
});

/// Effects that need a flight of their own.
pub const STATED: &[Ordinary] = &[
    Ordinary { id: "ground_effect", shown_by: LowFlight },
    Ordinary { id: "ceiling_effect", shown_by: Ceiling },
    Ordinary { id: "battery_sag", shown_by: FallingVoltage },
    Ordinary { id: "rotor_inertia", shown_by: StatedMotorLag },
    Ordinary { id: "steady_wind", shown_by: Drag },
    Ordinary { id: "gust", shown_by: Drag },
    Ordinary { id: "slung_load", shown_by: GentleMotion },
    Ordinary { id: "vortex_ring", shown_by: Descent },
];

/// The entry of an effect.
pub fn ordinary(id: &str) -> Option<&'static Ordinary> {
    ORDINARY.iter().find(|entry| entry.id == id)
}

impl Ordinary {
    /// Name and value of each parameter on this vehicle.
    pub fn values(&self, vehicle: &Vehicle) -> Vec<(&'static str, f64)> {
        let usual = signature_of(self.id).and_then(|signature| signature.usual_values(vehicle));
        usual.unwrap_or_else(|| panic!("{}: expected usual sizes in the signature", self.id))
    }

    /// The effect on this vehicle.
    pub fn effect(&self, vehicle: &Vehicle) -> ActiveEffect {
        ActiveEffect::named(self.id, &self.values(vehicle), &vehicle.size()).unwrap()
    }

    /// What is concealed beside it, so that it acts at all.
    pub fn companion(&self, vehicle: &Vehicle) -> Option<ActiveEffect> {
        ordinary("linear_drag").filter(|_| self.shown_by == Drag).map(|drag| drag.effect(vehicle))
    }
}

impl ShownBy {
    /// Makes a flight one that shows the effect; returns the motors' time constant (s) that the vehicle's file states.
    pub fn prepare(
        self,
        vehicle: &Vehicle,
        trajectory: &mut RandomTrajectory,
        settings: &mut FlightSettings,
    ) -> Option<f64> {
        match self {
            Motion | Drag => {}
            LowFlight => trajectory.height_m = (0.3, 1.2),
            Ceiling => trajectory.height_m = (0.8, 2.0),
            // as loads are flown
            GentleMotion => (trajectory.speed_max_m_s, trajectory.acceleration_max_m_s2) = (1.0, 0.8),
            Descent => {
                (trajectory.height_m, trajectory.harmonics) = ((2.0, 24.0), 3);
                trajectory.speed_max_m_s = 1.2 * hover_flow_m_s(vehicle);
                trajectory.acceleration_max_m_s2 = 5.0;
            }
            FallingVoltage => settings.battery_drop_v_s = 0.03,
            // known motors that spin up in that time, as rotors with inertia do
            StatedMotorLag => settings.motor_time_constant_s = 0.02,
        }
        (self == StatedMotorLag).then_some(settings.motor_time_constant_s)
    }

    /// What the flight must have, as a noun.
    pub fn words(self) -> &'static str {
        match self {
            Motion => "motion along all axes",
            LowFlight => "flight at 0.3 to 1.2 m above the ground",
            Ceiling => "flight up to 0.35 m below the ceiling",
            GentleMotion => "slow motion (1 m/s, 0.8 m/s^2), as loads are flown",
            Descent => "long descents at up to 1.2 times the induced velocity of hover",
            FallingVoltage => "a battery voltage that falls during the flight",
            StatedMotorLag => "motors whose time constant (20 ms) the vehicle file states",
            Drag => "a drag through which the moving air acts on the vehicle",
        }
    }
}

/// Speed of the air through the rotors in hover, by momentum theory.
fn hover_flow_m_s(vehicle: &Vehicle) -> f64 {
    let disc_m2 = vehicle.rotors.len() as f64 * PI * vehicle.propulsion.rotor_radius_m.unwrap().powi(2);
    (vehicle.body.mass_kg * vehicle.gravity_m_s2 / (2.0 * AIR_DENSITY_KG_M3 * disc_m2)).sqrt()
}
