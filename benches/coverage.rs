//! How often the 95 % intervals of `identify` cover the truth, over synthetic flights of random vehicles.
//!
//! `cargo bench --bench coverage -- [--flights N] [--seed S] [--speeds] [--noise SCALE] [--out FILE]`: `--out` stores the
//! figures in the section `coverage` of a file, of which the book is made.
#![allow(clippy::print_stdout, clippy::unwrap_used, clippy::expect_used, reason = "a benchmark prints")]

mod support;

use mavid::estimate::{IdentifySettings, Method, NAMES, THETA, identify, scale_of, theta_of};
use mavid::signals::{ConditionSettings, condition};
use mavid::simulate::{FlightSettings, RandomTrajectory, Reference, Truth, random_vehicle, simulate_flight};
use rayon::prelude::*;
use support::Arguments;
use support::digits::{quantile, short};
use support::identification::{Coverage, MethodCoverage, ParameterCoverage};
use support::sections::store;

/// One flight: error, standard error, and size per parameter, for each method.
type Row = Vec<(Method, [(f64, f64, f64); THETA])>;

fn main() {
    let arguments = Arguments::of_process();
    let (flights, first): (u64, u64) = (arguments.number("--flights", 200), arguments.number("--seed", 1000));
    let (noise, speeds) = (arguments.number("--noise", 1.0), arguments.has("--speeds"));
    let seeds: Vec<u64> = (first..first + flights).collect();
    let outcomes: Vec<Option<(Row, Method)>> =
        seeds.par_iter().map(|&seed| fly(seed, speeds, noise)).collect();
    let failed = outcomes.iter().filter(|o| o.is_none()).count();
    let rows: Vec<(Row, Method)> = outcomes.into_iter().flatten().collect();
    println!("{} flights identified, {failed} not flown (trajectory beyond the vehicle)", rows.len());
    let of_method = |method: Method| {
        coverage(method.name(), &rows, |row, _| row.iter().find(|(m, _)| *m == method).map(|(_, r)| *r))
    };
    let mut methods: Vec<MethodCoverage> =
        [Method::Weak, Method::Ls, Method::Fmls].into_iter().map(of_method).collect();
    methods.push(coverage("best", &rows, |row, best| row.iter().find(|(m, _)| *m == best).map(|(_, r)| *r)));
    methods.iter().for_each(report);
    if let Some(file) = arguments.text("--out") {
        let command = arguments.command("coverage");
        let run = Coverage { command, flights: rows.len(), not_flown: failed, methods };
        store(&file, "coverage", &run);
    }
}

fn coverage(
    name: &str,
    rows: &[(Row, Method)],
    pick: impl Fn(&Row, Method) -> Option<[(f64, f64, f64); THETA]>,
) -> MethodCoverage {
    let picked: Vec<_> = rows.iter().filter_map(|(row, best)| pick(row, *best)).collect();
    let of_parameter = |(index, parameter): (usize, &&str)| {
        let column: Vec<(f64, f64, f64)> = picked.iter().map(|row| row[index]).collect();
        let n = column.len() as f64;
        let covered = column.iter().filter(|(e, s, _)| e.abs() < 1.96 * s).count();
        let squares = column.iter().map(|(e, s, _)| (e / s).powi(2)).sum::<f64>();
        let mean = column.iter().map(|(e, _, size)| 100.0 * e / size).sum::<f64>() / n;
        let mut errors: Vec<f64> = column.iter().map(|(e, _, size)| 100.0 * (e / size).abs()).collect();
        ParameterCoverage {
            name: (*parameter).to_owned(),
            covered,
            error_over_std: short((squares / n).sqrt()),
            median_error_percent: quantile(&mut errors, 0.5).map_or(f64::NAN, short),
            mean_error_percent: short(mean),
            high_error_percent: quantile(&mut errors, 0.9).map_or(f64::NAN, short),
        }
    };
    MethodCoverage {
        method: name.to_owned(),
        flights: picked.len(),
        parameters: NAMES.iter().enumerate().map(of_parameter).collect(),
    }
}

fn report(of: &MethodCoverage) {
    println!("\n{}: {} flights", of.method, of.flights);
    println!(
        "parameter  covered by 95 %   sd of error/std   median |error| %   mean error %   90th percentile |error| %"
    );
    for parameter in &of.parameters {
        println!(
            "{:9}  {:6.1} %           {:5.2}             {:7.3}            {:7.3}        {:7.3}",
            parameter.name,
            100.0 * parameter.covered as f64 / of.flights as f64,
            parameter.error_over_std,
            parameter.median_error_percent,
            parameter.mean_error_percent,
            parameter.high_error_percent
        );
    }
}

fn fly(seed: u64, speeds: bool, noise: f64) -> Option<(Row, Method)> {
    // three generators, three seeds: vehicle, trajectory and noise must not share their draws
    let pair = random_vehicle(seed.wrapping_mul(7919));
    let trajectory = RandomTrajectory::default().draw(seed.wrapping_mul(104_729)).ok()?;
    let reference = Reference { trajectory, hover_s: 4.0, ramp_s: 2.0 };
    let mut settings = FlightSettings { seed, ..FlightSettings::default() };
    settings.telemetry.noise_scale = noise;
    settings.telemetry.rates.rotor_speed_hz = speeds.then_some(62.5);
    let flight = simulate_flight(Truth::clean(pair.truth), &pair.nominal, &reference, &settings).ok()?;
    let signals = condition(&flight.recording, &pair.nominal, &ConditionSettings::default()).ok()?;
    let identified = identify(&[signals], &pair.nominal, &IdentifySettings::default()).ok()?;
    let truth = theta_of(&flight.truth.vehicle.body);
    let row = identified
        .methods
        .iter()
        .map(|result| {
            let entry = |i: usize| {
                let error = result.estimated.theta[i] - truth[i];
                (error, result.estimated.covariance[(i, i)].sqrt(), scale_of(&truth, i))
            };
            (result.method, std::array::from_fn(entry))
        })
        .collect();
    Some((row, identified.best.method))
}
