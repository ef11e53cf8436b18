#![allow(clippy::all, clippy::print_stdout, clippy::unwrap_used, missing_docs)]
use mavid::*;
use std::path::Path;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let vehicle = config::load_vehicle(Path::new(&args[1])).unwrap();
    for log in &args[2..] {
        let t0 = std::time::Instant::now();
        let recording = if log.ends_with("csv") {
            log::csv::read_csv(Path::new(log), &config::default_csv_mapping().unwrap()).unwrap().0
        } else {
            log::load(Path::new(log), &log::LoadOptions::default()).unwrap().recording
        };
        let t1 = std::time::Instant::now();
        let mut cs = signals::ConditionSettings::default();
        if std::env::var("CMD").is_ok() {
            cs.thrust = signals::ThrustPreference::Commands;
        }
        let s = match signals::condition(&recording, &vehicle, &cs) {
            Ok(s) => s,
            Err(e) => {
                println!("{log}: {e}");
                continue;
            }
        };
        let t2 = std::time::Instant::now();
        let id = match estimate::identify(
            std::slice::from_ref(&s),
            &vehicle,
            &estimate::IdentifySettings::default(),
        ) {
            Ok(i) => i,
            Err(e) => {
                println!("{log}: {e}");
                continue;
            }
        };
        let t3 = std::time::Instant::now();
        println!("== {log} load {:?} cond {:?} ident {:?}", t1 - t0, t2 - t1, t3 - t2);
        println!("  step {} sources {:?}", s.grid.step_s, s.quality.sources);
        println!("  offsets {:?}", s.quality.offsets);
        println!("  usable {:?} notes {:?} {:?}", s.quality.usable, s.quality.notes, id.notes);
        println!(
            "  latency {:?} comp {:?} plain latency cut {} harm {:?} cond {:?} scaled {} trim {:?} res {:?} ivF {:?} accb {:?}",
            id.latency,
            id.compensated,
            id.cutoff_hz,
            id.highest_harmonic_hz,
            id.condition_number,
            id.scaled_condition_number,
            id.trim_torque_nm,
            id.residual,
            id.instrument_f,
            id.accelerometer_bias
        );
        println!("  best {:?} {} phys {}", id.best.method, id.best.why, id.best.made_physical);
        for m in &id.methods {
            print!("  {:12}", m.method.name());
            for i in 0..7 {
                print!(
                    " {}={:.5}+-{:.5}",
                    estimate::NAMES[i],
                    m.estimated.theta[i],
                    m.estimated.covariance[(i, i)].sqrt()
                );
            }
            println!();
        }
    }
}
