//! Flights of one vehicle explained together: errors against those of the best single flight, and against the truth.

use mavid::study::{ExplainRequest, ExplainStudy, Silent, VehicleGiven, explain};
use std::collections::BTreeMap;
use std::time::Instant;

use super::made::several;
use crate::maker::realistic::case::RealCase;
use crate::support::comparison::{Pooled, PooledParameter};
use crate::support::digits::{quantile, short};

/// A parameter of a vehicle over its flights.
struct Estimate {
    name: String,
    value: f64,
    std: f64,
    /// of the flight that tells it best
    single: f64,
    truth: Option<f64>,
}

/// Explains `flights` flights of each of `count` vehicles together, one vehicle after the other: the time is told.
pub fn run(seed: u64, count: u64, flights: u64) -> Pooled {
    let mut all: Vec<Estimate> = Vec::new();
    let (mut seconds, mut vehicles) = (Vec::new(), 0);
    for seed in seed..seed + count {
        let folder = std::env::temp_dir().join(format!("mavid_together_{}_{seed}", std::process::id()));
        let made = several(&folder, seed, flights, None);
        let estimates = made.and_then(|made| {
            let request = ExplainRequest {
                logs: made.flights.clone(),
                vehicle: VehicleGiven::File(made.file.clone()),
                transient_s: ExplainRequest::TRANSIENT_S,
                ..ExplainRequest::default()
            };
            let began = Instant::now();
            let study = explain(&request, &Silent).map_err(|error| error.to_string())?;
            seconds.push(began.elapsed().as_secs_f64());
            Ok(estimates_of(seed, &made.vehicle.case, &study))
        });
        let _ = std::fs::remove_dir_all(&folder);
        match estimates {
            Ok(estimates) => {
                vehicles += 1;
                all.extend(estimates);
            }
            Err(why) => println!("  seed {seed}: not flown or read: {why}"),
        }
    }
    let mut by_name: BTreeMap<&str, Vec<&Estimate>> = BTreeMap::new();
    all.iter().for_each(|estimate| by_name.entry(&estimate.name).or_default().push(estimate));
    let parameters: Vec<PooledParameter> =
        by_name.iter().map(|(name, of)| figures(name, of)).filter(|of| of.known > 0).collect();
    let whole = figures("all", &all.iter().collect::<Vec<_>>());
    println!(
        "parameter, vehicles, smaller than the best single flight's, with a truth, covered, median error over best single"
    );
    for of in parameters.iter().chain([&whole]) {
        let PooledParameter { name, vehicles, smaller, known, covered, error_ratio } = of;
        println!("  {name:<18} {vehicles:>3} {smaller:>3} {known:>3} {covered:>3}  {error_ratio:.2}");
    }
    let (middle, most) = (quantile(&mut seconds, 0.5), seconds.last());
    println!("time for each vehicle's flights: median {middle:.1?} s, most {most:.1?} s");
    Pooled { command: String::new(), vehicles, flights, parameters, all: whole }
}

fn estimates_of(seed: u64, case: &RealCase, study: &ExplainStudy) -> Vec<Estimate> {
    let Some(along) = &study.along else { return Vec::new() };
    let estimates: Vec<Estimate> = along
        .common()
        .filter_map(|track| {
            let (value, std) = track.pooled()?;
            let single = track.values.iter().flatten().map(|(_, std)| *std).fold(f64::INFINITY, f64::min);
            let several = track.values.iter().flatten().count() > 1;
            let truth = truth(case, &track.name);
            several.then_some(Estimate { name: track.name.clone(), value, std, single, truth })
        })
        .collect();
    for one in estimates.iter().filter(|one| one.std >= one.single || one.is_off()) {
        println!(
            "  seed {seed}: {} {:.5e} +- {:.1e}, best single {:.1e}, truth {:?}",
            one.name, one.value, one.std, one.single, one.truth
        );
    }
    estimates
}

impl Estimate {
    fn is_off(&self) -> bool {
        self.truth.is_some_and(|truth| (self.value - truth).abs() > 1.96 * self.std)
    }
}

fn truth(case: &RealCase, name: &str) -> Option<f64> {
    let inside = &case.case;
    let inertia = &inside.craft.inertia;
    let of = |id: &str, parameter: &str| {
        inside
            .truth
            .iter()
            .find(|(other, name, _)| *other == id && *name == parameter)
            .map(|(.., value)| *value)
    };
    match name {
        "mass" => Some(inside.craft.mass),
        "ixx" => Some(inertia[(0, 0)]),
        "iyy" => Some(inertia[(1, 1)]),
        "izz" => Some(inertia[(2, 2)]),
        "linear_drag.dx" => of("linear_drag", "dx"),
        "linear_drag.dy" => of("linear_drag", "dy"),
        _ => None,
    }
}

fn figures(name: &str, estimates: &[&Estimate]) -> PooledParameter {
    let known: Vec<&&Estimate> = estimates.iter().filter(|estimate| estimate.truth.is_some()).collect();
    let mut ratios: Vec<f64> = estimates.iter().map(|estimate| estimate.std / estimate.single).collect();
    PooledParameter {
        name: name.to_owned(),
        vehicles: estimates.len(),
        smaller: estimates.iter().filter(|estimate| estimate.std < estimate.single).count(),
        known: known.len(),
        covered: known.iter().filter(|estimate| !estimate.is_off()).count(),
        error_ratio: quantile(&mut ratios, 0.5).map_or(f64::NAN, short),
    }
}
