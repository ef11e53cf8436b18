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
    /// error of the flight that tells it best, by that flight
    single: f64,
    /// that flight's value
    best: f64,
    truth: Option<f64>,
}

/// Explains `flights` flights of each of `count` vehicles together, one vehicle after the other: the time is told.
pub fn run(seed: u64, count: u64, flights: u64) -> Pooled {
    let mut all: Vec<Estimate> = Vec::new();
    let (mut seconds, mut processor, mut vehicles) = (Vec::new(), Vec::new(), 0);
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
            let (began, used_s) = (Instant::now(), processor_s());
            let study = explain(&request, &Silent).map_err(|error| error.to_string())?;
            seconds.push(began.elapsed().as_secs_f64());
            processor.extend(used_s.zip(processor_s()).map(|(before, after)| after - before));
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
        "parameter, vehicles, smaller than the best single flight's, with a truth, covered, \
         covered by the best single flight, median error over best single"
    );
    for of in parameters.iter().chain([&whole]) {
        let PooledParameter { name, vehicles, smaller, known, covered, error_ratio, .. } = of;
        let single = of.covered_by_single;
        println!(
            "  {name:<18} {vehicles:>3} {smaller:>3} {known:>3} {covered:>3} {single:>3}  {error_ratio:.2}"
        );
    }
    spread("time for each vehicle's flights", &mut seconds);
    spread("processor time for each vehicle's flights, all cores", &mut processor);
    Pooled { command: String::new(), vehicles, flights, parameters, all: whole }
}

/// Processor time of this process, s; `None` where the system does not tell it so.
fn processor_s() -> Option<f64> {
    let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
    let fields: Vec<&str> = stat.rsplit(')').next()?.split_whitespace().collect();
    let ticks = |at: usize| fields.get(at)?.parse::<f64>().ok();
    // hundredths of a second: those of the program and those of the kernel for it
    Some((ticks(11)? + ticks(12)?) / 100.0)
}

fn spread(what: &str, seconds: &mut [f64]) {
    seconds.sort_by(f64::total_cmp);
    if let (Some(middle), Some(most)) = (seconds.get(seconds.len() / 2), seconds.last()) {
        println!("{what}: median {middle:.1} s, most {most:.1} s");
    }
}

fn estimates_of(seed: u64, case: &RealCase, study: &ExplainStudy) -> Vec<Estimate> {
    let Some(along) = &study.along else { return Vec::new() };
    let estimates: Vec<Estimate> = along
        .common()
        .filter_map(|track| {
            let (value, std) = track.pooled()?;
            let place = (0..track.values.len()).filter(|&flight| track.values[flight].is_some()).min_by(
                |&one, &other| {
                    let std = |flight: usize| track.values[flight].map(|(_, std)| std);
                    std(one).partial_cmp(&std(other)).unwrap()
                },
            )?;
            let (best, single) = track.values[place]?;
            let several = track.values.iter().flatten().count() > 1;
            let truth = truth(case, &track.name);
            several.then_some(Estimate { name: track.name.clone(), value, std, single, best, truth })
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

    /// Whether the best single flight's value is off by its own error.
    fn is_single_off(&self) -> bool {
        self.truth.is_some_and(|truth| (self.best - truth).abs() > 1.96 * self.single)
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
        covered_by_single: known.iter().filter(|estimate| !estimate.is_single_off()).count(),
        error_ratio: quantile(&mut ratios, 0.5).map_or(f64::NAN, short),
    }
}
