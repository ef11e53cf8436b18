//! How often the 95 % intervals of `identify` cover the truth, over synthetic flights of random vehicles.
//!
//! `cargo bench --bench coverage -- [--flights N] [--seed S] [--speeds] [--noise SCALE]`
#![allow(clippy::print_stdout, clippy::unwrap_used, clippy::expect_used, reason = "a benchmark prints")]

mod support;

use mavid::estimate::{IdentifySettings, Method, NAMES, THETA, identify, scale_of, theta_of};
use mavid::signals::{ConditionSettings, condition};
use mavid::simulate::{FlightSettings, RandomTrajectory, Reference, Truth, random_vehicle, simulate_flight};
use rayon::prelude::*;
use support::Arguments;

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
    for method in [Method::Weak, Method::Ls, Method::Fmls] {
        report(method.name(), &rows, |row, _| row.iter().find(|(m, _)| *m == method).map(|(_, r)| *r));
    }
    report("best", &rows, |row, best| row.iter().find(|(m, _)| *m == best).map(|(_, r)| *r));
}

fn report(
    name: &str,
    rows: &[(Row, Method)],
    pick: impl Fn(&Row, Method) -> Option<[(f64, f64, f64); THETA]>,
) {
    let picked: Vec<_> = rows.iter().filter_map(|(row, best)| pick(row, *best)).collect();
    println!("\n{name}: {} flights", picked.len());
    println!(
        "parameter  covered by 95 %   sd of error/std   median |error| %   mean error %   90th percentile |error| %"
    );
    for (index, parameter) in NAMES.iter().enumerate() {
        let column: Vec<(f64, f64, f64)> = picked.iter().map(|row| row[index]).collect();
        let n = column.len() as f64;
        let covered = column.iter().filter(|(e, s, _)| e.abs() < 1.96 * s).count() as f64 / n;
        let spread = (column.iter().map(|(e, s, _)| (e / s).powi(2)).sum::<f64>() / n).sqrt();
        let mean = column.iter().map(|(e, _, size)| 100.0 * e / size).sum::<f64>() / n;
        let mut errors: Vec<f64> = column.iter().map(|(e, _, size)| 100.0 * (e / size).abs()).collect();
        errors.sort_by(f64::total_cmp);
        let (median, high) = (errors[errors.len() / 2], errors[errors.len() * 9 / 10]);
        println!(
            "{parameter:9}  {:6.1} %           {spread:5.2}             {median:7.3}            {mean:7.3}        {high:7.3}",
            100.0 * covered
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
