//! Each effect of the library is named where it is concealed in a flight that shows it.

#![allow(clippy::unwrap_used, reason = "a test ends where it fails")]

#[path = "support/concealed.rs"]
mod concealed;

use std::collections::BTreeSet;
use std::f64::consts::PI;

use concealed::Flight;
use mavid::diagnose::Explanation;
use mavid::physics::ActiveEffect;
use mavid::physics::effects::ALL;
use mavid::vehicle::Vehicle;
use rayon::prelude::*;

/// Hover, and three periods of the trajectory.
const DURATION_S: f64 = 34.0;
/// Of vehicle, trajectory and noise.
const SEED: u64 = 5;

/// An effect, and the flight that shows it.
struct Entry {
    id: &'static str,
    /// name and value of each parameter
    sizes: &'static [(&'static str, Size)],
    shown_by: ShownBy,
}

/// A parameter's value on an ordinary vehicle.
#[derive(Clone, Copy)]
enum Size {
    /// on every vehicle, in the parameter's unit
    Of(f64),
    /// per kg of the vehicle
    PerMass(f64),
    /// per kg m^2, of the mean of Ixx and Iyy
    PerInertia(f64),
}

/// What a flight must have for an effect to show.
#[derive(Clone, Copy)]
enum ShownBy {
    /// motion between 1 and 2.2 m
    Motion,
    /// low over the ground
    LowFlight,
    /// close below a ceiling
    Ceiling,
    /// slow motion, as loads are flown
    GentleMotion,
    /// long and fast descents, faster than the air that the rotors blow down
    Descent,
    /// a battery that runs down
    FallingVoltage,
    /// slow motors whose lag is stated
    StatedMotorLag,
    /// a drag through which the moving air acts, concealed as well
    Drag,
}

use ShownBy::{Ceiling, Descent, Drag, FallingVoltage, GentleMotion, LowFlight, Motion, StatedMotorLag};
use Size::{Of, PerInertia, PerMass};

/// Sizes are those of ordinary vehicles, as in `benches/explain.rs`.
const ENTRIES: &[Entry] = &[
    Entry {
        id: "linear_drag",
        sizes: &[("dx", PerMass(0.3)), ("dy", PerMass(0.3)), ("dz", Of(0.0))],
        shown_by: Motion,
    },
    Entry {
        id: "quadratic_drag",
        sizes: &[("cx", PerMass(0.12)), ("cy", PerMass(0.12)), ("cz", PerMass(0.12))],
        shown_by: Motion,
    },
    Entry {
        id: "ground_effect",
        sizes: &[("rho", Of(4.0)), ("ca", Of(0.0)), ("cb", Of(1.0))],
        shown_by: LowFlight,
    },
    Entry {
        id: "ceiling_effect",
        sizes: &[("a1", Of(3.5)), ("a2", Of(0.03)), ("height", Of(2.35))],
        shown_by: Ceiling,
    },
    Entry { id: "motor_lag", sizes: &[("time_constant", Of(0.04))], shown_by: Motion },
    Entry { id: "transport_delay", sizes: &[("delay", Of(0.03))], shown_by: Motion },
    Entry { id: "thrust_curve", sizes: &[("curvature", Of(0.15))], shown_by: Motion },
    Entry {
        id: "battery_sag",
        sizes: &[("exponent", Of(1.5)), ("full_voltage", Of(16.8))],
        shown_by: FallingVoltage,
    },
    Entry { id: "weak_rotor", sizes: &[("rotor", Of(1.0)), ("factor", Of(0.92))], shown_by: Motion },
    Entry {
        id: "com_offset",
        sizes: &[("x", Of(0.005)), ("y", Of(-0.004)), ("z", Of(0.0))],
        shown_by: Motion,
    },
    Entry { id: "thrust_tilt", sizes: &[("x", Of(0.025)), ("y", Of(-0.02))], shown_by: Motion },
    Entry { id: "rotor_inertia", sizes: &[("jr", PerInertia(0.0015))], shown_by: StatedMotorLag },
    Entry {
        id: "angular_damping",
        sizes: &[("bx", PerInertia(0.8)), ("by", PerInertia(0.8)), ("bz", PerInertia(0.8))],
        shown_by: Motion,
    },
    Entry { id: "blade_flapping", sizes: &[("k", PerInertia(0.5))], shown_by: Motion },
    Entry { id: "inflow", sizes: &[("kz", PerMass(0.4))], shown_by: Motion },
    Entry { id: "translational_lift", sizes: &[("kh", PerMass(0.12))], shown_by: Motion },
    Entry {
        id: "steady_wind",
        sizes: &[("north", Of(2.5)), ("west", Of(1.5)), ("up", Of(0.0))],
        shown_by: Drag,
    },
    Entry {
        id: "gust",
        sizes: &[("sigma", Of(0.4)), ("correlation_time", Of(1.0)), ("seed", Of(7.0))],
        shown_by: Drag,
    },
    Entry {
        id: "slung_load",
        sizes: &[("mass", PerMass(0.08)), ("length", Of(0.8)), ("damping", Of(0.3))],
        shown_by: GentleMotion,
    },
    Entry { id: "mass_change", sizes: &[("time", Of(20.0)), ("delta", PerMass(-0.08))], shown_by: Motion },
    Entry {
        id: "imu_misalignment",
        sizes: &[("x", Of(0.035)), ("y", Of(-0.026)), ("z", Of(0.03))],
        shown_by: Motion,
    },
    Entry {
        id: "imu_offset",
        sizes: &[("x", Of(0.05)), ("y", Of(-0.03)), ("z", Of(0.04))],
        shown_by: Motion,
    },
    Entry {
        id: "frame_misalignment",
        sizes: &[("x", Of(0.035)), ("y", Of(-0.026)), ("z", Of(0.0))],
        shown_by: Motion,
    },
    Entry {
        id: "tether",
        sizes: &[("line_mass", PerMass(0.03)), ("stiffness", Of(0.0)), ("length", Of(500.0))],
        shown_by: Motion,
    },
    Entry { id: "vortex_ring", sizes: &[("loss", Of(2.0))], shown_by: Descent },
];

#[test]
fn every_effect_has_an_entry_and_every_entry_an_effect() {
    let known: BTreeSet<&str> = ALL.iter().map(|effect| effect.id()).collect();
    let entered: BTreeSet<&str> = ENTRIES.iter().map(|entry| entry.id).collect();
    let missing: Vec<_> = known.difference(&entered).collect();
    assert!(
        missing.is_empty(),
        "no flight shows {missing:?}: add to ENTRIES in {} an entry with the parameters of an ordinary vehicle and what \
         a flight must have to show them",
        file!()
    );
    let unknown: Vec<_> = entered.difference(&known).collect();
    assert!(
        unknown.is_empty(),
        "{unknown:?}: not in physics::effects::ALL, take the entry out of {}",
        file!()
    );
    assert_eq!(entered.len(), ENTRIES.len(), "an effect with two entries");
}

#[test]
fn each_effect_is_named_in_a_flight_that_shows_it() {
    let wrong: Vec<String> = ENTRIES.par_iter().filter_map(failure).collect();
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

/// What is wrong with the answer to an entry's flight.
fn failure(entry: &Entry) -> Option<String> {
    let found = fly(entry);
    (!stands_for(&found, entry.id)).then(|| format!("{}: {}", entry.id, answer(&found)))
}

/// Named, or in the confusable set of what is named.
fn stands_for(found: &Explanation, id: &str) -> bool {
    let set = found.named.iter().flat_map(|named| &named.confusable_with);
    found.named.iter().any(|named| named.id == id) || set.into_iter().any(|other| other.id == id)
}

/// Verdict and names, each with its confusable set.
fn answer(found: &Explanation) -> String {
    let names = found.named.iter().map(|named| {
        let set: Vec<_> = named.confusable_with.iter().map(|other| other.id).collect();
        format!("{} (confusable with {set:?})", named.id)
    });
    let closest: Vec<_> = found.closest.iter().map(|named| named.id).collect();
    format!("{}, named {:?}, closest {closest:?}", found.verdict.name(), names.collect::<Vec<_>>())
}

fn fly(entry: &Entry) -> Explanation {
    let mut flight = Flight::of_seed(SEED);
    flight.settings.duration_s = DURATION_S;
    let vehicle = flight.vehicle();
    let mut effects = vec![effect(entry.id, entry.sizes, &vehicle)];
    match entry.shown_by {
        Motion => {}
        LowFlight => flight.trajectory.height_m = (0.3, 1.2),
        Ceiling => flight.trajectory.height_m = (0.8, 2.0),
        GentleMotion => {
            (flight.trajectory.speed_max_m_s, flight.trajectory.acceleration_max_m_s2) = (1.0, 0.8);
        }
        Descent => {
            (flight.trajectory.height_m, flight.trajectory.harmonics) = ((2.0, 24.0), 3);
            flight.trajectory.speed_max_m_s = 1.2 * hover_flow_m_s(&vehicle);
            flight.trajectory.acceleration_max_m_s2 = 5.0;
        }
        FallingVoltage => flight.settings.battery_drop_v_s = 0.03,
        StatedMotorLag => {
            flight.settings.motor_time_constant_s = 0.02;
            flight.stated_lag_s = Some(0.02);
        }
        Drag => {
            let drag = [("dx", PerMass(0.3)), ("dy", PerMass(0.3)), ("dz", Of(0.0))];
            effects.push(effect("linear_drag", &drag, &vehicle));
        }
    }
    flight.explained(effects)
}

fn effect(id: &str, sizes: &[(&str, Size)], vehicle: &Vehicle) -> ActiveEffect {
    let inertia = vehicle.body.inertia_kg_m2;
    let value = |size: Size| match size {
        Of(value) => value,
        PerMass(per) => per * vehicle.body.mass_kg,
        PerInertia(per) => per * 0.5 * (inertia[(0, 0)] + inertia[(1, 1)]),
    };
    let values: Vec<(&str, f64)> = sizes.iter().map(|(name, size)| (*name, value(*size))).collect();
    ActiveEffect::named(id, &values).unwrap()
}

/// Speed of the air through the rotors in hover, by momentum theory.
fn hover_flow_m_s(vehicle: &Vehicle) -> f64 {
    const AIR_KG_M3: f64 = 1.225;
    let disc_m2 = vehicle.rotors.len() as f64 * PI * vehicle.propulsion.rotor_radius_m.unwrap().powi(2);
    (vehicle.body.mass_kg * vehicle.gravity_m_s2 / (2.0 * AIR_KG_M3 * disc_m2)).sqrt()
}
