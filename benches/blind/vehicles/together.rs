//! Flights of one vehicle put together: errors against those of the best single flight, and against the truth.

use mavid::study::{ExplainRequest, ExplainStudy, Silent, VehicleGiven, explain};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::time::Instant;

use super::made::several;
use crate::maker::realistic::case::RealCase;

/// A parameter of the vehicle, put together.
struct Put {
    name: String,
    value: f64,
    std: f64,
    /// error of the flight that tells it best, by that flight
    single: f64,
    /// the same with what the scatter of all flights adds to it
    with_scatter: f64,
    /// that flight's value
    best: f64,
    truth: Option<f64>,
}

/// Puts `flights` flights of each of `count` vehicles together, one vehicle after the other: the time is told.
pub fn run(seed: u64, count: u64, flights: u64) {
    let mut all: Vec<Put> = Vec::new();
    let (mut seconds, mut processor): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    for seed in seed..seed + count {
        let folder = std::env::temp_dir().join(format!("mavid_together_{}_{seed}", std::process::id()));
        let made = several(&folder, seed, flights, None);
        let put = made.and_then(|made| {
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
            Ok(told(seed, &made.vehicle.case, &study))
        });
        let _ = std::fs::remove_dir_all(&folder);
        match put {
            Ok(put) => all.extend(put),
            Err(why) => println!("  seed {seed}: not flown or read: {why}"),
        }
    }
    figures(&all);
    spread("time for each vehicle's flights", &mut seconds);
    spread("processor time for each vehicle's flights, all cores", &mut processor);
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

fn told(seed: u64, case: &RealCase, study: &ExplainStudy) -> Vec<Put> {
    let Some(along) = &study.along else { return Vec::new() };
    let put: Vec<Put> = along
        .common()
        .filter_map(|track| {
            let (value, std) = track.pooled()?;
            let place = (0..track.values.len()).filter(|&flight| track.values[flight].is_some()).min_by(
                |&one, &other| {
                    let std = |flight: usize| track.values[flight].map(|(_, std)| std);
                    std(one).partial_cmp(&std(other)).unwrap()
                },
            )?;
            let ((best, single), (_, with_scatter)) = track.values[place].zip(track.alone(place))?;
            let several = track.values.iter().flatten().count() > 1;
            let truth = truth(case, &track.name);
            if std::env::var_os("BLIND_TELL").is_some() {
                println!(
                    "TRACK {seed} {} {truth:?} {value:e} {std:e} {:?} {:?}",
                    track.name, track.values, track.common_std
                );
            }
            several.then_some(Put { name: track.name.clone(), value, std, single, with_scatter, best, truth })
        })
        .collect();
    for one in put.iter().filter(|one| one.std >= one.single || one.is_off()) {
        println!(
            "  seed {seed}: {} {:.5e} +- {:.1e}, best single {:.1e}, with the scatter of all {:.1e}, truth {:?}",
            one.name, one.value, one.std, one.single, one.with_scatter, one.truth
        );
    }
    put
}

impl Put {
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

fn figures(all: &[Put]) {
    let mut by_name: BTreeMap<&str, Vec<&Put>> = BTreeMap::new();
    for put in all {
        by_name.entry(&put.name).or_default().push(put);
    }
    println!(
        "parameter, vehicles, smaller than the best single flight's, than that with the scatter of all, with a truth, covered, \
         covered by the best single flight, median error over best single"
    );
    for (name, put) in &by_name {
        tell(name, put);
    }
    tell("all", &all.iter().collect::<Vec<_>>());
}

fn tell(name: &str, put: &[&Put]) {
    let smaller = put.iter().filter(|put| put.std < put.single).count();
    let than_scattered = put.iter().filter(|put| put.std < put.with_scatter).count();
    let single = put.iter().filter(|put| put.truth.is_some() && !put.is_single_off()).count();
    let known = put.iter().filter(|put| put.truth.is_some()).count();
    let covered = put.iter().filter(|put| put.truth.is_some() && !put.is_off()).count();
    let mut ratios: Vec<f64> = put.par_iter().map(|put| put.std / put.single).collect();
    ratios.sort_by(f64::total_cmp);
    let ratio = ratios.get(ratios.len() / 2).copied().unwrap_or(f64::NAN);
    println!(
        "  {name:<18} {:>3} {smaller:>3} {than_scattered:>3} {known:>3} {covered:>3} {single:>3}  {ratio:.2}",
        put.len()
    );
}
