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

/// An effect at an ordinary size, and the flight that shows it.
#[derive(Clone, Copy)]
pub struct Ordinary {
    pub id: &'static str,
    /// name and value of each parameter
    pub sizes: &'static [(&'static str, Size)],
    pub shown_by: ShownBy,
}

/// A parameter's value on an ordinary vehicle.
#[derive(Clone, Copy)]
pub enum Size {
    /// on every vehicle, in the parameter's unit
    Of(f64),
    /// per kg of the vehicle
    PerMass(f64),
    /// per kg m^2, of the mean of Ixx and Iyy
    PerInertia(f64),
    /// what the effect's signature calls usual of the parameter of this name
    Usual(fn(&str, &Vehicle) -> Option<f64>, &'static str),
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
use Size::{Of, PerInertia, PerMass, Usual};

/// Every effect of the library: as [`STATED`], or else at the usual size of its signature and shown by any motion.
pub static ORDINARY: LazyLock<Vec<Ordinary>> = LazyLock::new(|| {
    let is_stated = |id: &str| STATED.iter().any(|entry| entry.id == id);
    let others = ALL.iter().filter(|effect| !is_stated(effect.id())).filter_map(|effect| {
        let usual = signature_of(effect.id())?.naming.usual;
        let sizes =
            effect.parameters().iter().map(|parameter| (parameter.name, Usual(usual, parameter.name)));
        let sizes: Vec<(&str, Size)> = sizes.collect();
        Some(Ordinary { id: effect.id(), sizes: sizes.leak(), shown_by: Motion })
    });
    STATED.iter().copied().chain(others).collect()
});

/// Effects with sizes of their own, or that need a flight of their own.
const STATED: &[Ordinary] = &[
    Ordinary {
        id: "linear_drag",
        sizes: &[("dx", PerMass(0.3)), ("dy", PerMass(0.3)), ("dz", Of(0.0))],
        shown_by: Motion,
    },
    Ordinary {
        id: "quadratic_drag",
        sizes: &[("cx", PerMass(0.12)), ("cy", PerMass(0.12)), ("cz", PerMass(0.12))],
        shown_by: Motion,
    },
    Ordinary {
        id: "ground_effect",
        sizes: &[("rho", Of(4.0)), ("ca", Of(0.0)), ("cb", Of(1.0))],
        shown_by: LowFlight,
    },
    Ordinary {
        id: "ceiling_effect",
        sizes: &[("a1", Of(3.5)), ("a2", Of(0.03)), ("height", Of(2.35))],
        shown_by: Ceiling,
    },
    Ordinary { id: "motor_lag", sizes: &[("time_constant", Of(0.04))], shown_by: Motion },
    Ordinary { id: "transport_delay", sizes: &[("delay", Of(0.03))], shown_by: Motion },
    Ordinary { id: "thrust_curve", sizes: &[("curvature", Of(0.15))], shown_by: Motion },
    Ordinary {
        id: "battery_sag",
        sizes: &[("exponent", Of(1.5)), ("full_voltage", Of(16.8))],
        shown_by: FallingVoltage,
    },
    Ordinary { id: "weak_rotor", sizes: &[("rotor", Of(1.0)), ("factor", Of(0.92))], shown_by: Motion },
    Ordinary {
        id: "com_offset",
        sizes: &[("x", Of(0.005)), ("y", Of(-0.004)), ("z", Of(0.0))],
        shown_by: Motion,
    },
    Ordinary { id: "thrust_tilt", sizes: &[("x", Of(0.025)), ("y", Of(-0.02))], shown_by: Motion },
    Ordinary { id: "rotor_inertia", sizes: &[("jr", PerInertia(0.0015))], shown_by: StatedMotorLag },
    Ordinary {
        id: "angular_damping",
        sizes: &[("bx", PerInertia(0.8)), ("by", PerInertia(0.8)), ("bz", PerInertia(0.8))],
        shown_by: Motion,
    },
    Ordinary { id: "blade_flapping", sizes: &[("k", PerInertia(0.5))], shown_by: Motion },
    Ordinary { id: "inflow", sizes: &[("kz", PerMass(0.4))], shown_by: Motion },
    Ordinary { id: "translational_lift", sizes: &[("kh", PerMass(0.12))], shown_by: Motion },
    Ordinary {
        id: "steady_wind",
        sizes: &[("north", Of(2.5)), ("west", Of(1.5)), ("up", Of(0.0))],
        shown_by: Drag,
    },
    Ordinary {
        id: "gust",
        sizes: &[("sigma", Of(0.4)), ("correlation_time", Of(1.0)), ("seed", Of(7.0))],
        shown_by: Drag,
    },
    Ordinary {
        id: "slung_load",
        sizes: &[("mass", PerMass(0.08)), ("length", Of(0.8)), ("damping", Of(0.3))],
        shown_by: GentleMotion,
    },
    Ordinary { id: "mass_change", sizes: &[("time", Of(26.0)), ("delta", PerMass(-0.08))], shown_by: Motion },
    Ordinary {
        id: "imu_misalignment",
        sizes: &[("x", Of(0.035)), ("y", Of(-0.026)), ("z", Of(0.03))],
        shown_by: Motion,
    },
    Ordinary {
        id: "imu_offset",
        sizes: &[("x", Of(0.05)), ("y", Of(-0.03)), ("z", Of(0.04))],
        shown_by: Motion,
    },
    Ordinary {
        id: "frame_misalignment",
        sizes: &[("x", Of(0.035)), ("y", Of(-0.026)), ("z", Of(0.0))],
        shown_by: Motion,
    },
    Ordinary {
        id: "tether",
        sizes: &[("line_mass", PerMass(0.03)), ("stiffness", Of(0.0)), ("length", Of(500.0))],
        shown_by: Motion,
    },
    Ordinary { id: "vortex_ring", sizes: &[("loss", Of(2.0))], shown_by: Descent },
];

/// The entry of an effect.
pub fn ordinary(id: &str) -> Option<&'static Ordinary> {
    ORDINARY.iter().find(|entry| entry.id == id)
}

impl Size {
    /// In the parameter's unit, on this vehicle.
    pub fn on(self, vehicle: &Vehicle) -> f64 {
        let inertia = vehicle.body.inertia_kg_m2;
        match self {
            Of(value) => value,
            PerMass(per) => per * vehicle.body.mass_kg,
            Usual(of, name) => {
                of(name, vehicle).unwrap_or_else(|| panic!("{name}: expected a usual size in the signature"))
            }
            PerInertia(per) => per * 0.5 * (inertia[(0, 0)] + inertia[(1, 1)]),
        }
    }
}

impl Ordinary {
    /// Name and value of each parameter on this vehicle.
    pub fn values(&self, vehicle: &Vehicle) -> Vec<(&'static str, f64)> {
        self.sizes.iter().map(|(name, size)| (*name, size.on(vehicle))).collect()
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
