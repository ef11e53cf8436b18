//! What `explain` says of flights with nothing left out, with an effect of the library, and with what no
//! library holds: force fields of the room, gusts, trends.
//!
//! `cargo bench --bench beyond -- [--flights N] [--seed S] [--noise SCALE] [--each] [KIND...]`
#![allow(clippy::print_stdout, clippy::unwrap_used, clippy::expect_used, reason = "a benchmark prints")]

mod support;

use mavid::diagnose::{ExplainSettings, Explanation, explain};
use mavid::physics::effects::by_id;
use mavid::physics::{ActiveEffect, Wrench};
use mavid::signals::{ConditionSettings, condition};
use mavid::simulate::{
    Disturbance, FlightSettings, RandomTrajectory, Reference, Truth, random_vehicle, simulate_flight,
};
use nalgebra::{UnitQuaternion, Vector3};
use rayon::prelude::*;
use support::Arguments;

const KINDS: [&str; 13] = [
    "clean",
    "drag",
    "wind",
    "ground",
    "inflow",
    "sag",
    "mass",
    "gust",
    "gust_slow",
    "field",
    "field_x",
    "trend",
    "red",
];

fn main() {
    let arguments = Arguments::of_process();
    let (flights, first): (u64, u64) = (arguments.number("--flights", 12), arguments.number("--seed", 5000));
    let (noise, each) = (arguments.number("--noise", 1.0), arguments.has("--each"));
    let chosen: Vec<&str> = KINDS.iter().copied().filter(|kind| arguments.has(kind)).collect();
    let kinds = if chosen.is_empty() { KINDS.to_vec() } else { chosen };
    let seeds: Vec<u64> = (first..first + flights).collect();
    for kind in kinds {
        let outcomes: Vec<(u64, Explanation, Option<f64>)> = seeds
            .par_iter()
            .filter_map(|&seed| Some((seed, fly(kind, seed, noise)?)))
            .map(|(s, (e, c))| (s, e, c))
            .collect();
        if each {
            outcomes.iter().for_each(|(seed, explanation, center)| line(*seed, explanation, *center));
        }
        summary(kind, &outcomes);
    }
}

/// One flight with its concealed cause, explained; where on world x a field was put.
fn fly(kind: &str, seed: u64, noise: f64) -> Option<(Explanation, Option<f64>)> {
    let pair = random_vehicle(seed.wrapping_mul(7919));
    let draw = RandomTrajectory {
        height_m: if kind == "ground" { (0.3, 1.5) } else { (1.0, 2.2) },
        ..RandomTrajectory::default()
    };
    let trajectory = draw.draw(seed.wrapping_mul(104_729)).ok()?;
    let reference = Reference { trajectory, hover_s: 4.0, ramp_s: 2.0 };
    let share = (seed * 37 % 100) as f64 / 100.0;
    let place_m = -0.4 + 0.8 * share;
    let weight_n = pair.truth.body.mass_kg * 9.81;
    let mut truth = Truth::clean(pair.truth.clone());
    truth.effects = effects(kind, seed, (pair.truth.body.mass_kg, share));
    truth.disturbance = disturbance(kind, seed, (weight_n, place_m));
    let mut settings = FlightSettings { seed, ..FlightSettings::default() };
    settings.telemetry.noise_scale = noise;
    let mut flight = simulate_flight(truth, &pair.nominal, &reference, &settings).ok()?;
    if kind == "trend" {
        // with the voltage on record it would be the battery's
        flight.recording.streams.retain(|key, _| key.quantity != mavid::recording::Quantity::BatteryVoltage);
    }
    let conditioning = ConditionSettings { transient_s: Some(1.0), ..ConditionSettings::default() };
    let signals = condition(&flight.recording, &pair.nominal, &conditioning).ok()?;
    let center_m = kind.starts_with("field").then_some(place_m);
    Some((explain(&[signals], &pair.nominal, &ExplainSettings::default()).ok()?, center_m))
}

/// What of the library is concealed; `share` (0..1) is the seed's.
fn effects(kind: &str, seed: u64, (mass_kg, share): (f64, f64)) -> Vec<ActiveEffect> {
    let effect = |id: &str, values: &[f64]| ActiveEffect::new(by_id(id).unwrap(), values).unwrap();
    let drag = |d: f64| effect("linear_drag", &[d, d, 0.0]);
    match kind {
        "drag" => vec![drag(0.2 * mass_kg)],
        "wind" => vec![effect("steady_wind", &[2.0, -1.5 + share, 0.0]), drag(0.2 * mass_kg)],
        "ground" => vec![effect("ground_effect", &[3.0, 0.0, 1.0, 1.0])],
        "inflow" => vec![effect("inflow", &[0.2 * mass_kg])],
        "sag" => vec![effect("battery_sag", &[1.0, 16.4])],
        "mass" => vec![effect("mass_change", &[15.0 + 20.0 * share, -0.08 * mass_kg])],
        "gust" => vec![effect("gust", &[0.3, 1.0, seed as f64]), drag(0.3)],
        "gust_slow" => vec![effect("gust", &[0.3, 4.0, seed as f64]), drag(0.3)],
        _ => Vec::new(),
    }
}

/// What no effect of the library is; a field's middle is at `place_m` on world x.
fn disturbance(kind: &str, seed: u64, (weight_n, place_m): (f64, f64)) -> Option<Disturbance> {
    let along = |attitude: &UnitQuaternion<f64>, world_n: Vector3<f64>| Wrench {
        force_n: attitude.inverse_transform_vector(&world_n),
        torque_nm: Vector3::zeros(),
    };
    match kind {
        "field" | "field_x" => {
            let width_m = 0.2;
            let force = if kind == "field" { Vector3::z() } else { Vector3::y() } * (-0.06 * weight_n);
            Some(Disturbance::new(move |_, state| {
                let off = (state.position_m.x - place_m) / width_m;
                along(&state.attitude, force * (-0.5 * off.powi(2)).exp())
            }))
        }
        "trend" => Some(Disturbance::new(move |time_s, _| Wrench {
            force_n: Vector3::z() * (-0.03 * weight_n * time_s / 60.0),
            torque_nm: Vector3::zeros(),
        })),
        "red" => {
            // a random push in the world that no drag carries
            let values = [1.0, 1.5, seed as f64];
            let wind = by_id("gust").unwrap();
            let push_n = 0.01 * weight_n;
            Some(Disturbance::new(move |time_s, state| {
                let input = mavid::physics::Input {
                    time_s,
                    speed_command: [0.0; mavid::physics::MAX_ROTORS],
                    speed_rate_1_s: [0.0; mavid::physics::MAX_ROTORS],
                    wind_m_s: Vector3::zeros(),
                    battery_voltage_v: None,
                };
                let own = mavid::physics::Own { parameters: &values, states: &[], rates: &mut [] };
                along(&state.attitude, wind.wind_m_s(&input, &own) * push_n)
            }))
        }
        _ => None,
    }
}

fn line(seed: u64, found: &Explanation, center: Option<f64>) {
    let red: Vec<String> = found
        .aperiodic
        .redness
        .iter()
        .map(|red| format!("{:?} {:.0}/{:.4}/{:.1}s", red.of, red.statistic, red.relative, red.correlation_s))
        .collect();
    let lives = |located: &Option<mavid::diagnose::locate::Localisation>| {
        located.as_ref().and_then(|located| {
            let follow = located.lives_on()?;
            Some(format!(
                "{}:{} {:.2} share {:.2}",
                follow.channel,
                follow.state.name(),
                follow.peak_at,
                follow.partial_share
            ))
        })
    };
    let names = |named: &[mavid::diagnose::Named]| -> String {
        named
            .iter()
            .map(|n| {
                format!(
                    "{} {:?} ",
                    n.id,
                    n.parameters.iter().map(|p| (p.value * 1e3).round() / 1e3).collect::<Vec<_>>()
                )
            })
            .collect()
    };
    println!("{seed} {} [{}] closest [{}]", found.verdict.name(), names(&found.named), names(&found.closest));
    println!("   red {}", red.join("; "));
    if let Some(t) = found.aperiodic.trend {
        println!("   trend {:?} z {:.1} relative {:.4} certain {}", t.of, t.z, t.relative, t.certain);
    }
    if let Some(s) = found.aperiodic.state {
        println!("   state {} {} p {:.1e} rms {:.3}", s.channel, s.state.name(), s.p_value, s.rms);
    }
    if let Some(f) = &found.field {
        println!(
            "   field {}|{} z {:.1} p {:.1e} gain {:.4} at {:.2} wide {:.2} {:.3} N energy {:.0} alone {:.0} certain {} beats {} uneven {:?} true {center:?}",
            f.component,
            f.along,
            f.z,
            f.p_cluster,
            f.gain,
            f.where_m,
            f.extent_m,
            f.force_n,
            f.energy,
            f.energy_alone,
            f.certain,
            f.beats_named,
            f.uneven
        );
    }
    println!("   lives before {:?} after {:?}", lives(&found.located_before), lives(&found.located_after));
}

fn summary(kind: &str, outcomes: &[(u64, Explanation, Option<f64>)]) {
    let count = |what: &dyn Fn(&Explanation) -> bool| outcomes.iter().filter(|(_, e, _)| what(e)).count();
    let verdicts: Vec<String> = ["nothing_missing", "explained", "partly_explained", "unexplained"]
        .iter()
        .map(|name| format!("{name} {}", count(&|e| e.verdict.name() == *name)))
        .collect();
    let most =
        |what: &dyn Fn(&Explanation) -> f64| outcomes.iter().map(|(_, e, _)| what(e)).fold(0.0, f64::max);
    let lack = count(&|e| e.lack_of_fit.as_ref().is_some_and(|l| l.p_least() < 1e-6));
    println!(
        "{kind:10} {} flights: {}; harmonic p < 1e-6 {lack}; field certain {} beats {} uneven {} (largest z {:.1}); trend {} (z {:.1}); red {} ; gust {}",
        outcomes.len(),
        verdicts.join(", "),
        count(&|e| e.field.as_ref().is_some_and(|f| f.certain)),
        count(&|e| e.field.as_ref().is_some_and(|f| f.beats_named)),
        count(&|e| e.field.as_ref().is_some_and(|f| !f.uneven.is_empty())),
        most(&|e| e.field.as_ref().map_or(0.0, |f| f.z)),
        count(&|e| e.aperiodic.trend.is_some_and(|t| t.certain)),
        most(&|e| e.aperiodic.trend.map_or(0.0, |t| t.z)),
        count(&|e| e.aperiodic.redness.iter().any(|r| r.certain)),
        count(&|e| e.aperiodic.gust.is_some()),
    );
    for index in 0..6 {
        let mut values: Vec<f64> =
            outcomes.iter().filter_map(|(_, e, _)| Some(e.aperiodic.redness.get(index)?.statistic)).collect();
        values.sort_by(f64::total_cmp);
        let mut sizes: Vec<f64> =
            outcomes.iter().filter_map(|(_, e, _)| Some(e.aperiodic.redness.get(index)?.relative)).collect();
        sizes.sort_by(f64::total_cmp);
        if let (Some(last), Some(size)) = (values.last(), sizes.last()) {
            println!(
                "      redness {index}: median {:.1}, largest {last:.1}; relative size at most {size:.4}",
                values[values.len() / 2]
            );
        }
    }
}
