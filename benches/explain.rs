//! What `explain` names on simulated flights: false names where nothing is concealed, right names where
//! something is, and the smallest sizes that it would have named.
//!
//! `cargo bench --bench explain -- [--clean N] [--each N] [--limits N] [--pairs N] [--seed S] [--only EFFECT] [--fed-back]
//! [--askew]`: `--fed-back` has the controller fly on the noise that is logged, `--askew` leans every thrust axis by
//! 0.2 degrees, which is no finding.
#![allow(clippy::print_stdout, clippy::unwrap_used, clippy::expect_used, reason = "a benchmark prints")]

mod support;

use mavid::diagnose::{ExplainSettings, Explanation, Verdict, explain};
use mavid::physics::ActiveEffect;
use mavid::signals::{ConditionSettings, ThrustPreference, condition};
use mavid::simulate::{FlightSettings, RandomTrajectory, Reference, Truth, random_vehicle, simulate_flight};
use mavid::vehicle::Vehicle;
use rayon::prelude::*;
use std::collections::BTreeMap;
use support::Arguments;

/// Name, value, and what it grows with, of each parameter.
type Sizes = &'static [(&'static str, f64, Scale)];

/// Effects at sizes that vehicles have; `m` is the mass, kg, `i` the mean of Ixx and Iyy.
const SIZES: &[(&str, Sizes)] = &[
    ("linear_drag", &[("dx", 0.3, Scale::Mass), ("dy", 0.3, Scale::Mass), ("dz", 0.0, Scale::One)]),
    ("quadratic_drag", &[("cx", 0.12, Scale::Mass), ("cy", 0.12, Scale::Mass), ("cz", 0.12, Scale::Mass)]),
    ("ground_effect", &[("rho", 4.0, Scale::One), ("ca", 0.0, Scale::One), ("cb", 1.0, Scale::One)]),
    ("thrust_curve", &[("curvature", 0.15, Scale::One)]),
    ("battery_sag", &[("exponent", 1.5, Scale::One), ("full_voltage", 16.8, Scale::One)]),
    ("weak_rotor", &[("rotor", 1.0, Scale::One), ("factor", 0.92, Scale::One)]),
    ("com_offset", &[("x", 0.005, Scale::One), ("y", -0.004, Scale::One), ("z", 0.0, Scale::One)]),
    ("thrust_tilt", &[("x", 0.025, Scale::One), ("y", -0.02, Scale::One)]),
    (
        "angular_damping",
        &[("bx", 0.8, Scale::Inertia), ("by", 0.8, Scale::Inertia), ("bz", 0.8, Scale::Inertia)],
    ),
    ("blade_flapping", &[("k", 0.5, Scale::Inertia)]),
    ("inflow", &[("kz", 0.4, Scale::Mass)]),
    ("translational_lift", &[("kh", 0.12, Scale::Mass)]),
    ("slung_load", &[("mass", 0.08, Scale::Mass), ("length", 0.8, Scale::One), ("damping", 0.3, Scale::One)]),
    ("mass_change", &[("time", 26.0, Scale::One), ("delta", -0.08, Scale::Mass)]),
    ("frame_misalignment", &[("x", 0.035, Scale::One), ("y", -0.026, Scale::One), ("z", 0.0, Scale::One)]),
    ("imu_misalignment", &[("x", 0.035, Scale::One), ("y", -0.026, Scale::One), ("z", 0.03, Scale::One)]),
    ("imu_offset", &[("x", 0.05, Scale::One), ("y", -0.03, Scale::One), ("z", 0.04, Scale::One)]),
    ("rotor_inertia", &[("jr", 0.0015, Scale::Inertia)]),
    (
        "tether",
        &[("line_mass", 0.03, Scale::Mass), ("stiffness", 0.0, Scale::One), ("length", 500.0, Scale::One)],
    ),
    ("ceiling_effect", &[("a1", 3.5, Scale::One), ("a2", 0.03, Scale::One), ("height", 2.35, Scale::One)]),
    ("vortex_ring", &[("loss", 2.0, Scale::One)]),
    ("gust", &[("sigma", 0.4, Scale::One), ("correlation_time", 1.0, Scale::One), ("seed", 7.0, Scale::One)]),
    ("steady_wind", &[("north", 2.5, Scale::One), ("west", 1.5, Scale::One), ("up", 0.0, Scale::One)]),
    ("motor_lag", &[("time_constant", 0.04, Scale::One)]),
    ("transport_delay", &[("delay", 0.03, Scale::One)]),
];

/// Effects that show only through a drag, which is concealed with them.
const THROUGH_DRAG: [&str; 2] = ["gust", "steady_wind"];

/// Beside what the seed draws.
#[derive(Clone, Copy, Default)]
struct Conditions {
    /// the controller flies on the noise that is logged
    fed_back: bool,
    /// every thrust axis leans by 0.2 degrees
    askew: bool,
    /// 125 Hz, noise of 1, no skew
    plain: bool,
}

#[derive(Clone, Copy)]
enum Scale {
    One,
    Mass,
    Inertia,
}

fn main() {
    let arguments = Arguments::of_process();
    let (first, each) = (arguments.number("--seed", 1), arguments.number("--each", 6));
    let conditions =
        Conditions { fed_back: arguments.has("--fed-back"), askew: arguments.has("--askew"), plain: false };
    report_clean(first, arguments.number("--clean", 60), conditions);
    report_limits(first, arguments.number("--limits", 24));
    report_pairs(first, arguments.number("--pairs", 0));
    let only = arguments.text("--only");
    println!("\neffect               flights  named  set  others  verdicts; median relative size error %");
    for (id, values) in SIZES.iter().filter(|(id, _)| only.as_ref().is_none_or(|only| only == id)) {
        report_effect(id, values, first, each);
    }
}

/// Flights where nothing is concealed.
fn report_clean(first: u64, count: u64, with: Conditions) {
    let found: Vec<(u64, Verdict, Vec<&str>)> = (first..first + count)
        .into_par_iter()
        .filter_map(|seed| {
            let explanation = fly(seed, |_| Vec::new(), None, with)?;
            let names = explanation.named.iter().chain(&explanation.closest).map(|named| named.id).collect();
            Some((seed, explanation.verdict, names))
        })
        .collect();
    let mut verdicts: BTreeMap<&str, usize> = BTreeMap::new();
    for (seed, verdict, names) in &found {
        *verdicts.entry(verdict.name()).or_default() += 1;
        if *verdict != Verdict::NothingMissing {
            println!("false: seed {seed} {} {names:?} {}", verdict.name(), conditions(*seed));
        }
    }
    println!("{} clean flights: {verdicts:?}", found.len());
    let wrong = found.len() - verdicts.get(Verdict::NothingMissing.name()).copied().unwrap_or(0);
    let named = found
        .iter()
        .filter(|(_, verdict, names)| *verdict != Verdict::Unexplained && !names.is_empty())
        .count();
    println!("  named {named}, any finding {wrong} of {}", found.len());
}

/// What a study in another language reached at 125 Hz and noise of 1, at z = 4 (drag N/(m/s), quadratic N/(m/s)^2, tilt
/// rad, inflow N/(m/s), factor, m, N m s, N m/(m/s), kg m^2).
const MARKS: [(&str, &str, f64); 13] = [
    ("linear_drag", "dx", 0.0056),
    ("linear_drag", "dy", 0.0056),
    ("quadratic_drag", "cx", 0.0028),
    ("quadratic_drag", "cy", 0.0028),
    ("thrust_tilt", "x", 0.0005),
    ("thrust_curve", "curvature", 0.035),
    ("inflow", "kz", 0.025),
    ("weak_rotor", "factor", 0.0012),
    ("com_offset", "x", 0.000_09),
    ("com_offset", "y", 0.000_09),
    ("angular_damping", "bx", 0.0033),
    ("blade_flapping", "k", 0.0009),
    ("rotor_inertia", "jr", 1.7e-6),
];

/// The smallest sizes that would have been named, on clean flights at 125 Hz and noise of 1.
fn report_limits(first: u64, count: u64) {
    let with = Conditions { plain: true, ..Conditions::default() };
    let found: Vec<Explanation> = (first..first + count)
        .into_par_iter()
        .filter_map(|seed| fly(seed, |_| Vec::new(), None, with))
        .collect();
    let mut limits: BTreeMap<(&str, &str, &str), Vec<f64>> = BTreeMap::new();
    for limit in found.iter().flat_map(|explanation| &explanation.limits) {
        limits.entry((limit.id, limit.parameter, limit.unit)).or_default().push(limit.limit);
    }
    println!(
        "\nsmallest size that is named (z = 4), median and 90th percentile of {} flights, over the mark:",
        found.len()
    );
    for ((id, parameter, unit), mut sizes) in limits {
        sizes.sort_by(f64::total_cmp);
        let (median, most) = (sizes[sizes.len() / 2], sizes[sizes.len() * 9 / 10]);
        let mark = MARKS.iter().find(|(mark, of, _)| (*mark, *of) == (id, parameter));
        let over = mark.map_or_else(String::new, |(.., mark)| format!("{:.2} of {mark:.2e}", median / mark));
        println!("  {id:20} {parameter:14} {median:10.3e} {most:10.3e} {unit:12} {over}");
    }
}

/// Two effects at once.
const PAIRS: [(&str, &str); 10] = [
    ("linear_drag", "ground_effect"),
    ("linear_drag", "weak_rotor"),
    ("linear_drag", "motor_lag"),
    ("linear_drag", "mass_change"),
    ("linear_drag", "thrust_tilt"),
    ("battery_sag", "linear_drag"),
    ("inflow", "motor_lag"),
    ("com_offset", "blade_flapping"),
    ("com_offset", "ground_effect"),
    ("quadratic_drag", "transport_delay"),
];

/// Seed, names, and the confusable set of each.
type Pair = (u64, Vec<&'static str>, Vec<Vec<&'static str>>);

/// Flights with two effects concealed: how often both are named and nothing else.
fn report_pairs(first: u64, count: u64) {
    for (one, other) in PAIRS.iter().filter(|_| count > 0) {
        let sizes = |id: &str| SIZES.iter().find(|(known, _)| *known == id).map(|(_, sizes)| *sizes);
        let (Some(of_one), Some(of_other)) = (sizes(one), sizes(other)) else { continue };
        let found: Vec<Pair> = (first..first + count)
            .into_par_iter()
            .filter_map(|seed| {
                let both = |vehicle: &Vehicle| {
                    let of = |id, sizes| {
                        ActiveEffect::named(id, &sized(sizes, vehicle)).expect("a possible effect")
                    };
                    vec![of(one, of_one), of(other, of_other)]
                };
                let id = if [one, other].contains(&&"ground_effect") { "ground_effect" } else { one };
                let explanation = fly(seed, both, Some(id), Conditions::default())?;
                let names = explanation.named.iter().map(|named| named.id).collect();
                let sets = explanation.named.iter();
                let sets = sets.map(|named| named.confusable_with.iter().map(|other| other.id).collect());
                Some((seed, names, sets.collect()))
            })
            .collect();
        let has = |names: &[&str], sets: &[Vec<&str>], id: &&str| {
            names.contains(id) || sets.iter().any(|set| set.contains(id))
        };
        let both = found.iter().filter(|(_, names, sets)| has(names, sets, one) && has(names, sets, other));
        let exact = both.clone().filter(|(_, names, _)| names.len() == 2);
        println!(
            "{:34} {:3} flights, both {:3}, and nothing else {:3}",
            format!("{one} + {other}"),
            found.len(),
            both.count(),
            exact.count()
        );
        for (seed, names, _) in found.iter().filter(|(_, names, sets)| {
            !(names.len() == 2 && has(names, sets, one) && has(names, sets, other))
        }) {
            println!("  seed {seed}: {names:?} {}", conditions(*seed));
        }
    }
}

/// Sizes for a vehicle.
fn sized(values: Sizes, vehicle: &Vehicle) -> Vec<(&'static str, f64)> {
    let inertia = vehicle.body.inertia_kg_m2;
    let scale = |scale: Scale| match scale {
        Scale::One => 1.0,
        Scale::Mass => vehicle.body.mass_kg,
        Scale::Inertia => 0.5 * (inertia[(0, 0)] + inertia[(1, 1)]),
    };
    values.iter().map(|(name, value, by)| (*name, value * scale(*by))).collect()
}

/// Flights with one effect concealed.
fn report_effect(id: &'static str, values: Sizes, first: u64, count: u64) {
    let found: Vec<(u64, Explanation, Vec<f64>)> = (first..first + count)
        .into_par_iter()
        .filter_map(|seed| {
            let truth = sized(values, &random_vehicle(seed.wrapping_mul(7919)).truth);
            let explanation = fly(
                seed,
                |vehicle| vec![ActiveEffect::named(id, &sized(values, vehicle)).expect("a possible effect")],
                Some(id),
                Conditions::default(),
            )?;
            Some((seed, explanation, truth.iter().map(|(_, value)| *value).collect()))
        })
        .collect();
    let (mut named, mut within, mut others) = (0, 0, 0);
    let mut verdicts: BTreeMap<&str, usize> = BTreeMap::new();
    let mut errors = Vec::new();
    let mut strangers: BTreeMap<&str, usize> = BTreeMap::new();
    for (seed, explanation, truth) in &found {
        *verdicts.entry(explanation.verdict.name()).or_default() += 1;
        let is_it = |name: &&mavid::diagnose::Named| name.id == id;
        let companion =
            |name: &mavid::diagnose::Named| THROUGH_DRAG.contains(&id) && name.id == "linear_drag";
        let in_set = |name: &&mavid::diagnose::Named| name.confusable_with.iter().any(|other| other.id == id);
        if let Some(name) = explanation.named.iter().find(is_it) {
            named += 1;
            for parameter in &name.parameters {
                let place = values.iter().position(|(other, ..)| *other == parameter.name);
                if let Some(place) = place.filter(|&place| truth[place] != 0.0 && parameter.std > 0.0) {
                    errors.push(100.0 * (parameter.value / truth[place] - 1.0).abs());
                }
            }
        } else if explanation.named.iter().any(|name| in_set(&name)) {
            within += 1;
        }
        let ids: Vec<&str> =
            explanation.named.iter().chain(&explanation.closest).map(|name| name.id).collect();
        if explanation.verdict != Verdict::Explained || ids != [id] {
            println!(
                "  seed {seed}: {} {ids:?} {} {:?}",
                explanation.verdict.name(),
                conditions(*seed),
                explanation.search.latency
            );
        }
        if std::env::var("SHOW").is_ok_and(|want| want == seed.to_string()) {
            show_search(explanation);
        }
        for name in explanation.named.iter().filter(|name| name.id != id && !in_set(name) && !companion(name))
        {
            others += 1;
            *strangers.entry(name.id).or_default() += 1;
        }
    }
    errors.sort_by(f64::total_cmp);
    let median = errors.get(errors.len() / 2).copied().unwrap_or(f64::NAN);
    println!(
        "{id:20} {:7} {named:6} {within:4} {others:7}  {verdicts:?} {median:.1} % {strangers:?}",
        found.len()
    );
}

/// What the search took, and what was left.
fn show_search(explanation: &Explanation) {
    for step in &explanation.search.steps {
        println!(
            "    took {} {:?} e {:.0}",
            step.taken.candidate.id, step.taken.evidence.theta, step.taken.evidence.energy
        );
    }
    let mut last: Vec<_> = explanation.search.last.iter().collect();
    last.sort_by(|a, b| b.evidence.energy.total_cmp(&a.evidence.energy));
    println!("    {} candidates", last.len());
    for tested in last.iter().take(14) {
        let e = &tested.evidence;
        println!(
            "    {:18} {:?} theta {:?} std {:.3e} z {:.1} pc {:.1e} gain {:.4} e {:.1} rms {:?}",
            tested.candidate.id,
            tested.candidate.parts[0].values,
            e.theta,
            e.std(0),
            e.z,
            e.p_cluster,
            e.gain,
            e.energy,
            e.rms
        );
    }
    println!(
        "    sigma {:?} torque {:?} {:?}",
        explanation.search.after.weighted.sigma,
        explanation.search.after.rows.torque_rms,
        explanation.search.after.base.present
    );
}

/// Speed of the air through the rotors in hover, by momentum theory.
fn hover_inflow_m_s(vehicle: &Vehicle) -> f64 {
    const AIR_KG_M3: f64 = 1.225;
    let radius_m = vehicle.propulsion.rotor_radius_m.expect("a random vehicle has a rotor radius");
    let disc_m2 = vehicle.rotors.len() as f64 * std::f64::consts::PI * radius_m.powi(2);
    (vehicle.body.mass_kg * vehicle.gravity_m_s2 / (2.0 * AIR_KG_M3 * disc_m2)).sqrt()
}

/// The drag through which the air's motion acts.
fn drag(vehicle: &Vehicle) -> ActiveEffect {
    let d = 0.3 * vehicle.body.mass_kg;
    ActiveEffect::named("linear_drag", &[("dx", d), ("dy", d), ("dz", 0.0)]).expect("a possible effect")
}

fn conditions(seed: u64) -> String {
    let settings = settings(seed);
    format!(
        "rate {} Hz, noise {:.2}, position late {:.1} ms",
        settings.telemetry.rates.actuator_hz,
        settings.telemetry.noise_scale,
        1e3 * settings.telemetry.skew.position_s
    )
}

/// Rates 50 to 250 Hz, noise 0.5 to 3 times, streams up to 10 ms late: by the seed.
fn settings(seed: u64) -> FlightSettings {
    let share = |by: u64| (seed.wrapping_mul(by) % 1009) as f64 / 1008.0;
    let mut settings = FlightSettings { seed, ..FlightSettings::default() };
    let rate_hz = [50.0, 100.0, 125.0, 250.0][(seed % 4) as usize];
    let rates = &mut settings.telemetry.rates;
    (rates.attitude_hz, rates.imu_hz, rates.actuator_hz) = (rate_hz, rate_hz, rate_hz);
    settings.telemetry.noise_scale = 0.5 * 6.0_f64.powf(share(617));
    settings.telemetry.skew.position_s = 0.010 * share(331);
    settings
}

fn fly(
    seed: u64,
    effects: impl Fn(&Vehicle) -> Vec<ActiveEffect>,
    id: Option<&str>,
    with: Conditions,
) -> Option<Explanation> {
    let mut pair = random_vehicle(seed.wrapping_mul(7919));
    let mut random = RandomTrajectory::default();
    if id == Some("slung_load") {
        // gently, as loads are flown
        (random.speed_max_m_s, random.acceleration_max_m_s2) = (1.0, 0.8);
    }
    if with.plain {
        // slow and fast flights, as the marks' own
        random.speed_max_m_s = [0.8, 1.6, 3.0][(seed % 3) as usize];
        (random.acceleration_max_m_s2, random.height_m) = (4.5, (0.5, 4.0));
    }
    if id == Some("vortex_ring") {
        // down long and fast, as it takes
        (random.height_m, random.harmonics) = ((2.0, 24.0), 3);
        (random.speed_max_m_s, random.acceleration_max_m_s2) = (1.2 * hover_inflow_m_s(&pair.truth), 5.0);
    }
    if id == Some("ceiling_effect") {
        // below it
        random.height_m = (0.8, 2.0);
    }
    if id == Some("ground_effect") {
        random.height_m = (0.3, 1.2);
    }
    let trajectory = random.draw(seed.wrapping_mul(104_729)).ok()?;
    let reference = Reference { trajectory, hover_s: 4.0, ramp_s: 2.0 };
    let mut settings =
        if with.plain { FlightSettings { seed, ..FlightSettings::default() } } else { settings(seed) };
    if id == Some("rotor_inertia") {
        // motors as rotors of some inertia have them: known, and what spins up does so in that time
        settings.motor_time_constant_s = 0.02;
        pair.nominal.propulsion.time_constant_s = Some(0.02);
    }
    settings.telemetry.share_controller_noise = with.fed_back;
    if id == Some("battery_sag") {
        settings.battery_drop_v_s = 0.03;
    }
    let mut effects = effects(&pair.truth);
    effects.extend(id.filter(|id| THROUGH_DRAG.contains(id)).map(|_| drag(&pair.truth)));
    if with.askew {
        let lean = ActiveEffect::named("thrust_tilt", &[("x", 0.0025), ("y", -0.0025)]);
        effects.push(lean.expect("a possible effect"));
    }
    let truth = Truth { vehicle: pair.truth, effects, disturbance: None };
    let flight = simulate_flight(truth, &pair.nominal, &reference, &settings).ok()?;
    let how = ConditionSettings {
        transient_s: Some(1.0),
        thrust: ThrustPreference::Commands,
        ..ConditionSettings::default()
    };
    let signals = condition(&flight.recording, &pair.nominal, &how).ok()?;
    explain(&[signals], &pair.nominal, &ExplainSettings::default()).ok()
}
