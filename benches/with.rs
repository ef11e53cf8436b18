//! What `identify --with` finds of effects that a simulated flight conceals: sizes against the truth.
//!
//! `cargo bench --bench with -- [--each N] [--seed S] [--only EFFECT,...] [--noise FACTOR] [--fed-back] [--show] [--out FILE]`
//!
//! `--fed-back`: the controller flies on the very noise that is logged. `--out` stores the figures in a section of a file, of
//! which the book is made: `joint`, or the effects of `--only`.
#![allow(clippy::print_stdout, clippy::unwrap_used, clippy::expect_used, reason = "a benchmark prints")]

mod support;

use mavid::diagnose::ExplainSettings;
use mavid::diagnose::joint::{Found, JointError, JointEstimate, RequestedEffects, identify_jointly};
use mavid::physics::ActiveEffect;
use mavid::signals::{ConditionSettings, ThrustPreference, condition};
use mavid::simulate::{FlightSettings, RandomTrajectory, Reference, Truth, random_vehicle, simulate_flight};
use mavid::vehicle::Vehicle;
use rayon::prelude::*;
use support::Arguments;
use support::digits::short;
use support::identification::{ConcealedEffect, Joint, JointSet};
use support::sections::store;

/// What a size grows with: nothing, the mass, or the mean of Ixx and Iyy.
#[derive(Clone, Copy)]
enum Scale {
    One,
    Mass,
    Inertia,
}

use Scale::{Inertia, Mass, One};

/// An effect at a size that vehicles have.
type Sizes = (&'static str, &'static [(&'static str, f64, Scale)]);

const DRAG: Sizes = ("linear_drag", &[("dx", 0.3, Mass), ("dy", 0.3, Mass), ("dz", 0.0, One)]);

/// What is concealed and asked for, set by set.
const SETS: &[&[Sizes]] = &[
    &[DRAG],
    &[("quadratic_drag", &[("cx", 0.12, Mass), ("cy", 0.12, Mass), ("cz", 0.12, Mass)])],
    &[("ground_effect", &[("rho", 4.0, One), ("ca", 0.0, One), ("cb", 1.0, One)])],
    &[("ceiling_effect", &[("a1", 5.0, One), ("a2", 0.0, One), ("height", 2.6, One)])],
    &[("motor_lag", &[("time_constant", 0.04, One)])],
    &[("transport_delay", &[("delay", 0.03, One)])],
    &[("thrust_curve", &[("curvature", 0.15, One)])],
    &[("battery_sag", &[("exponent", 1.5, One), ("full_voltage", 16.4, One)])],
    &[("weak_rotor", &[("rotor", 1.0, One), ("factor", 0.92, One)])],
    &[("com_offset", &[("x", 0.005, One), ("y", -0.004, One), ("z", 0.0, One)])],
    &[("thrust_tilt", &[("x", 0.025, One), ("y", -0.02, One)])],
    &[("rotor_inertia", &[("jr", 0.001, Inertia)])],
    &[("angular_damping", &[("bx", 0.8, Inertia), ("by", 0.8, Inertia), ("bz", 0.8, Inertia)])],
    &[("blade_flapping", &[("k", 0.5, Inertia)])],
    &[("inflow", &[("kz", 0.4, Mass)])],
    &[("translational_lift", &[("kh", 0.12, Mass)])],
    &[DRAG, ("steady_wind", &[("north", 2.0, One), ("west", -1.5, One), ("up", 0.0, One)])],
    &[("slung_load", &[("mass", 0.08, Mass), ("length", 0.8, One)])],
    &[("slung_load", &[("mass", 0.08, Mass), ("length", 0.8, One), ("damping", 0.2, One)])],
    &[("mass_change", &[("time", 26.0, One), ("delta", -0.08, Mass)])],
    &[("imu_misalignment", &[("x", 0.03, One), ("y", -0.02, One), ("z", 0.04, One)])],
    &[("imu_offset", &[("x", 0.04, One), ("y", -0.03, One), ("z", 0.02, One)])],
    &[("frame_misalignment", &[("x", 0.03, One), ("y", -0.02, One), ("z", 0.0, One)])],
    &[("tether", &[("line_mass", 0.03, Mass), ("stiffness", 0.0, One), ("length", 500.0, One)])],
    &[("vortex_ring", &[("loss", 3.0, One)])],
    &[("motor_lag", &[("time_constant", 0.04, One)]), ("transport_delay", &[("delay", 0.02, One)])],
    &[DRAG, ("com_offset", &[("x", 0.005, One), ("y", -0.004, One), ("z", 0.0, One)])],
    &[
        ("mass_change", &[("time", 26.0, One), ("delta", -0.08, Mass)]),
        ("weak_rotor", &[("rotor", 2.0, One), ("factor", 0.94, One)]),
    ],
];

fn main() {
    let arguments = Arguments::of_process();
    let (each, first) = (arguments.number("--each", 4), arguments.number("--seed", 1));
    let (only, noise) = (arguments.text("--only"), arguments.number("--noise", 1.0));
    let how = How { noise, fed_back: arguments.has("--fed-back"), show: arguments.has("--show") };
    println!(
        "set                            flights  determined  within 20 %  within 3 std  rms in std  z least; worst"
    );
    let named = |set: &&[Sizes]| only.as_ref().is_none_or(|only| ids(set) == *only);
    let chosen = SETS.iter().copied().filter(named);
    let sets: Vec<JointSet> = chosen.map(|set| report(set, (first, each), how)).collect();
    if let Some(file) = arguments.text("--out") {
        let section = only.unwrap_or_else(|| "joint".to_owned());
        store(&file, &section, &Joint { command: arguments.command("with"), sets });
    }
}

/// `linear_drag,com_offset`
fn ids(set: &[Sizes]) -> String {
    set.iter().map(|(id, _)| *id).collect::<Vec<_>>().join(",")
}

/// How flights are made and told.
#[derive(Clone, Copy)]
struct How {
    noise: f64,
    fed_back: bool,
    show: bool,
}

fn report(set: &'static [Sizes], (first, each): (u64, u64), how: How) -> JointSet {
    let found: Vec<(u64, Result<JointEstimate, JointError>, Vec<ActiveEffect>)> =
        (first..first + each).into_par_iter().filter_map(|seed| fly(seed, how, set)).collect();
    let mut tally = Tally { least: f64::INFINITY, ..Tally::default() };
    for (seed, estimate, truth) in &found {
        match estimate {
            Ok(estimate) => tally.add(*seed, estimate, truth, how.show),
            Err(error) => {
                tally.figures.failed += 1;
                println!("{}: seed {seed}: {error}", ids(set));
            }
        }
    }
    let figures = tally.figures(set, found.len());
    println!(
        "{:30} {:7} {:11} {:12} {:13} {:11.2}  {:6.1}; {:.1} %",
        ids(set),
        figures.flights,
        figures.determined,
        figures.near,
        figures.covered,
        figures.error_over_std,
        tally.least,
        figures.worst_error_percent
    );
    figures
}

/// Sizes against the truth, over flights.
#[derive(Default)]
struct Tally {
    figures: JointSet,
    /// squares of error over standard error
    squares: f64,
    least: f64,
}

impl Tally {
    fn add(&mut self, seed: u64, estimate: &JointEstimate, truth: &[ActiveEffect], show: bool) {
        for (effect, truth) in estimate.effects.iter().zip(truth) {
            self.least = self.least.min(effect.z);
            let id = effect.effect.id();
            for (slot, (parameter, &truth)) in effect.parameters.iter().zip(truth.parameters()).enumerate() {
                let what = format!("  seed {seed} {id}.{}", parameter.name);
                if show {
                    println!("{what} truth {truth:.5} {:?}", parameter.found);
                }
                let nothing = if id == "weak_rotor" && slot == 1 { 1.0 } else { 0.0 };
                self.weigh(&what, &parameter.found, (truth, truth - nothing));
            }
        }
    }

    /// `amount`: how far the truth is from no effect; where it is not at all, its size says nothing.
    fn weigh(&mut self, what: &str, found: &Found, (truth, amount): (f64, f64)) {
        if amount == 0.0 {
            return;
        }
        let figures = &mut self.figures;
        match found {
            Found::Determined { value, std } => {
                figures.determined += 1;
                let off = value - truth;
                figures.near += usize::from(off.abs() < 0.2 * amount.abs());
                figures.covered += usize::from(off.abs() < 3.0 * std);
                self.squares += (off / std).powi(2);
                figures.worst_error_percent = figures.worst_error_percent.max(100.0 * (off / amount).abs());
            }
            Found::NotDetermined { reason, .. } => {
                figures.not_determined += 1;
                println!("{what} not determined: {reason}");
            }
            Found::AtBound { value, unbounded, std } => {
                figures.at_bound += 1;
                println!("{what} at {value}: {unbounded} +- {std}");
            }
            _ => {}
        }
    }

    /// What is stored.
    fn figures(&mut self, set: &[Sizes], flown: usize) -> JointSet {
        let mut figures = std::mem::take(&mut self.figures);
        let parameters = |values: &[(&str, f64, Scale)]| {
            let of_size = values.iter().filter(|(_, value, _)| *value != 0.0);
            of_size.map(|(name, ..)| (*name).to_owned()).collect()
        };
        figures.effects = set
            .iter()
            .map(|(id, values)| ConcealedEffect { id: (*id).to_owned(), parameters: parameters(values) })
            .collect();
        figures.flights = flown - figures.failed;
        figures.error_over_std = short((self.squares / (figures.determined as f64).max(1.0)).sqrt());
        figures.worst_error_percent = short(figures.worst_error_percent);
        figures
    }
}

fn fly(
    seed: u64,
    how: How,
    set: &'static [Sizes],
) -> Option<(u64, Result<JointEstimate, JointError>, Vec<ActiveEffect>)> {
    let pair = random_vehicle(seed.wrapping_mul(7919));
    let effects: Vec<ActiveEffect> = set.iter().map(|sizes| sized(sizes, &pair.truth)).collect();
    let has = |id: &str| set.iter().any(|(other, _)| *other == id);
    let mut random = RandomTrajectory::default();
    if has("ground_effect") {
        random.height_m = (0.3, 1.2);
    }
    if has("vortex_ring") {
        (random.height_m, random.speed_max_m_s, random.acceleration_max_m_s2) = ((1.0, 9.0), 5.0, 5.0);
    }
    if has("rotor_inertia") {
        (random.yaw_max_rad, random.yaw_rate_max_rad_s) = (1.0, 3.0);
    }
    let trajectory = random.draw(seed.wrapping_mul(104_729)).ok()?;
    let reference = Reference { trajectory, hover_s: 4.0, ramp_s: 2.0 };
    let mut settings = FlightSettings { seed, ..FlightSettings::default() };
    settings.telemetry.noise_scale = how.noise;
    settings.telemetry.share_controller_noise = how.fed_back;
    if has("battery_sag") {
        settings.battery_drop_v_s = 0.03;
    }
    if has("rotor_inertia") {
        // the yaw loop of slower rotors swings by their inertia
        settings.motor_time_constant_s = 0.02;
    }
    let mut nominal = pair.nominal;
    // what is not asked for is stated
    nominal.propulsion.time_constant_s = Some(settings.motor_time_constant_s);
    let truth = Truth { vehicle: pair.truth, effects: effects.clone(), disturbance: None };
    let flight = simulate_flight(truth, &nominal, &reference, &settings).ok()?;
    let names: Vec<String> = set.iter().map(|(id, _)| (*id).to_owned()).collect();
    let requested = RequestedEffects::of(&names).expect("known effects");
    let conditions = ConditionSettings {
        transient_s: Some(1.0),
        thrust: if requested.need_commands() {
            ThrustPreference::Commands
        } else {
            ThrustPreference::Measured
        },
        askew: requested.has("imu_misalignment"),
        ..ConditionSettings::default()
    };
    let signals = condition(&flight.recording, &nominal, &conditions).ok()?;
    let half_width_s = ExplainSettings::default().half_width_s;
    Some((seed, identify_jointly(&[signals], (&nominal, &[]), &requested, half_width_s), effects))
}

fn sized((id, values): &Sizes, vehicle: &Vehicle) -> ActiveEffect {
    let inertia = vehicle.body.inertia_kg_m2;
    let scale = |scale: Scale| match scale {
        One => 1.0,
        Mass => vehicle.body.mass_kg,
        Inertia => 0.5 * (inertia[(0, 0)] + inertia[(1, 1)]),
    };
    let sized: Vec<(&str, f64)> =
        values.iter().map(|(name, value, by)| (*name, value * scale(*by))).collect();
    ActiveEffect::named(id, &sized, &vehicle.size()).expect("a possible effect")
}
