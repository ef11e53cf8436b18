//! What `explain` names on simulated flights: false names where nothing is concealed, right names where
//! something is, and the smallest sizes that it would have named.
//!
//! `cargo bench --bench explain -- [--clean N] [--each N] [--seed S] [--only EFFECT]`
#![allow(clippy::print_stdout, clippy::unwrap_used, clippy::expect_used, reason = "a benchmark prints")]

use mavid::diagnose::{ExplainSettings, Explanation, Verdict, explain};
use mavid::physics::ActiveEffect;
use mavid::signals::{ConditionSettings, ThrustPreference, condition};
use mavid::simulate::{FlightSettings, RandomTrajectory, Reference, Truth, random_vehicle, simulate_flight};
use mavid::vehicle::Vehicle;
use rayon::prelude::*;
use std::collections::BTreeMap;

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
    ("rotor_inertia", &[("jr", 0.001, Scale::Inertia)]),
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

#[derive(Clone, Copy)]
enum Scale {
    One,
    Mass,
    Inertia,
}

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    let text = |name: &str| {
        let found = arguments.iter().position(|a| a == name);
        found.and_then(|i| arguments.get(i + 1)).cloned()
    };
    let number =
        |name: &str, default: u64| text(name).map_or(default, |t| t.parse().expect("a whole number"));
    let (clean, each, first) = (number("--clean", 60), number("--each", 6), number("--seed", 1));
    report_clean(first, clean);
    println!("\neffect               flights  named  set  others  verdicts; median relative size error %");
    for (id, values) in SIZES.iter().filter(|(id, _)| text("--only").is_none_or(|only| only == *id)) {
        report_effect(id, values, first, each);
    }
}

/// Flights where nothing is concealed.
fn report_clean(first: u64, count: u64) {
    let found: Vec<(u64, Explanation)> = (first..first + count)
        .into_par_iter()
        .filter_map(|seed| Some((seed, fly(seed, |_| Vec::new(), None)?)))
        .collect();
    let mut verdicts: BTreeMap<&str, usize> = BTreeMap::new();
    let mut limits: BTreeMap<(&str, &str, &str), Vec<f64>> = BTreeMap::new();
    for (seed, explanation) in &found {
        *verdicts.entry(explanation.verdict.name()).or_default() += 1;
        for limit in &explanation.limits {
            limits.entry((limit.id, limit.parameter, limit.unit)).or_default().push(limit.limit);
        }
        if explanation.verdict != Verdict::NothingMissing {
            let names: Vec<&str> =
                explanation.named.iter().chain(&explanation.closest).map(|n| n.id).collect();
            println!("false: seed {seed} {} {names:?} {}", explanation.verdict.name(), conditions(*seed));
        }
    }
    println!("{} clean flights: {verdicts:?}", found.len());
    println!("smallest size that is named (z = 4), median and 90th percentile of these flights:");
    for ((id, parameter, unit), mut sizes) in limits {
        sizes.sort_by(f64::total_cmp);
        println!(
            "  {id:20} {parameter:14} {:10.3e} {:10.3e} {unit}",
            sizes[sizes.len() / 2],
            sizes[sizes.len() * 9 / 10]
        );
    }
}

/// Flights with one effect concealed.
fn report_effect(id: &'static str, values: Sizes, first: u64, count: u64) {
    let found: Vec<(u64, Explanation, Vec<f64>)> = (first..first + count)
        .into_par_iter()
        .filter_map(|seed| {
            let sized = |vehicle: &Vehicle| -> Vec<(&'static str, f64)> {
                let inertia = vehicle.body.inertia_kg_m2;
                let scale = |scale: Scale| match scale {
                    Scale::One => 1.0,
                    Scale::Mass => vehicle.body.mass_kg,
                    Scale::Inertia => 0.5 * (inertia[(0, 0)] + inertia[(1, 1)]),
                };
                values.iter().map(|(name, value, by)| (*name, value * scale(*by))).collect()
            };
            let truth = sized(&random_vehicle(seed.wrapping_mul(7919)).truth);
            let explanation = fly(
                seed,
                |vehicle| vec![ActiveEffect::named(id, &sized(vehicle)).expect("a possible effect")],
                Some(id),
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
            if std::env::var("D").is_ok() {
                let mut last = explanation.search.last.clone();
                last.sort_by(|a, b| b.evidence.energy.total_cmp(&a.evidence.energy));
                for t in last.iter().take(8) {
                    println!(
                        "      {:16} z {:.1} pc {:.1e} gain {:.4} theta {:?} rms {:?}",
                        t.candidate.id,
                        t.evidence.z,
                        t.evidence.p_cluster,
                        t.evidence.gain,
                        t.evidence.theta,
                        t.evidence.rms
                    );
                }
                if let Some(l) = &explanation.lack_of_fit {
                    println!("      lack p {:?} excess {:?}", l.p_value, l.excess_rms);
                }
                if let Some(f) = &explanation.field {
                    println!("      field {} z {} gain {} force {}", f.certain, f.z, f.gain, f.force_n);
                }
                println!(
                    "      red {:?} trend {:?}",
                    explanation
                        .aperiodic
                        .redness
                        .iter()
                        .filter(|r| r.certain)
                        .map(|r| r.of)
                        .collect::<Vec<_>>(),
                    explanation.aperiodic.trend.filter(|t| t.certain)
                );
            }
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

fn fly(seed: u64, effects: impl Fn(&Vehicle) -> Vec<ActiveEffect>, id: Option<&str>) -> Option<Explanation> {
    let pair = random_vehicle(seed.wrapping_mul(7919));
    let mut random = RandomTrajectory::default();
    if id == Some("slung_load") {
        // gently, as loads are flown
        (random.speed_max_m_s, random.acceleration_max_m_s2) = (1.0, 0.8);
    }
    if id == Some("vortex_ring") {
        // down fast, as it takes
        random.height_m = (2.0, 14.0);
        (random.speed_max_m_s, random.acceleration_max_m_s2) = (5.0, 5.0);
    }
    if id == Some("ground_effect") {
        random.height_m = (0.3, 1.2);
    }
    let trajectory = random.draw(seed.wrapping_mul(104_729)).ok()?;
    let reference = Reference { trajectory, hover_s: 4.0, ramp_s: 2.0 };
    let mut settings = settings(seed);
    if id == Some("battery_sag") {
        settings.battery_drop_v_s = 0.03;
    }
    let mut effects = effects(&pair.truth);
    effects.extend(id.filter(|id| THROUGH_DRAG.contains(id)).map(|_| drag(&pair.truth)));
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
