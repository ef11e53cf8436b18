//! The excitation problem of the paper: how good and how fast over 100 seeds, beside SciPy's SLSQP.
//!
//! `cargo bench --bench plan [-- SEEDS [SECONDS]]`: SECONDS is the time given to SLSQP (default 60).
//! `MAVID_PYTHON` names a Python that has scipy (default `python3`).

use std::error::Error;
use std::io::Write;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

use mavid::config::read_vehicle;
use mavid::plan::{PlanRequest, StartPlace, plan};
use mavid::vehicle::{Limits, Vehicle};

fn main() -> Result<(), Box<dyn Error>> {
    let mut numbers = std::env::args().skip(1).filter_map(|argument| argument.parse::<u64>().ok());
    let (seeds, slsqp_s) = (numbers.next().unwrap_or(100), numbers.next().unwrap_or(60));
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let vehicle = read_vehicle(&root.join("configs/qball2.toml"))?.vehicle;
    let floor = StartPlace { z_m: vehicle.limits.z_min_m, ..StartPlace::default() };
    over_seeds("height of the start chosen", &vehicle, seeds, StartPlace::default())?;
    over_seeds("start on the floor, as in the paper", &vehicle, seeds, floor)?;
    let mut out = std::io::stdout().lock();
    match slsqp(&vehicle.limits, slsqp_s) {
        Ok(found) => {
            writeln!(
                out,
                "SciPy SLSQP, height of the start chosen, numeric gradients, one core, {slsqp_s} s"
            )?;
            let mut best = f64::INFINITY;
            for (condition, violation, after_s) in found {
                if violation <= 0.0 && condition < best {
                    best = condition;
                    writeln!(out, "  cond(W) {condition:.4} after {after_s:.1} s, bounds kept")?;
                }
            }
            if best.is_infinite() {
                writeln!(out, "  no start ended with every bound kept")?;
            }
        }
        Err(error) => writeln!(out, "SciPy SLSQP not measured: {error}")?,
    }
    Ok(())
}

fn over_seeds(title: &str, vehicle: &Vehicle, seeds: u64, start: StartPlace) -> Result<(), Box<dyn Error>> {
    let (mut conditions, mut times_s, mut failures) = (Vec::new(), Vec::new(), Vec::new());
    for seed in 0..seeds {
        let request = PlanRequest { seed, start, ..PlanRequest::default() };
        let began = Instant::now();
        match plan(vehicle, &vehicle.limits, &request, &|| {}) {
            Ok(plan) => {
                times_s.push(began.elapsed().as_secs_f64());
                conditions.push(plan.assessment.condition_number);
            }
            Err(error) => failures.push(format!("seed {seed}: {error}")),
        }
    }
    let mut out = std::io::stdout().lock();
    for failure in &failures {
        writeln!(out, "{title}: {failure}")?;
    }
    if conditions.is_empty() {
        return Ok(());
    }
    let reached = conditions.iter().filter(|condition| **condition <= 16.20).count();
    writeln!(out, "{title}: {seeds} seeds, {} starts each, every bound kept", PlanRequest::default().starts)?;
    writeln!(out, "  cond(W) at most 16.20 in {reached} of {seeds}")?;
    for (name, values) in [("cond(W)", &mut conditions), ("seconds", &mut times_s)] {
        values.sort_by(f64::total_cmp);
        let at = |percent: usize| values[(values.len() - 1) * percent / 100];
        write!(out, "  {name}:")?;
        for percent in [0, 10, 50, 90, 100] {
            write!(out, "  {percent} % {:.4}", at(percent))?;
        }
        writeln!(out)?;
    }
    Ok(())
}

/// Condition number, violation and time.
type Figures = (f64, f64, f64);

/// Each start of the rival.
fn slsqp(limits: &Limits, seconds: u64) -> Result<Vec<Figures>, Box<dyn Error>> {
    let python = std::env::var("MAVID_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/peers/plan_with_slsqp.py");
    let problem = serde_json::json!({
        "roll": limits.roll_max_rad, "pitch": limits.pitch_max_rad, "yaw_rate": limits.yaw_rate_max_rad_s,
        "x": limits.x_max_m, "y": limits.y_max_m, "z_min": limits.z_min_m, "z_max": limits.z_max_m,
        "speed": limits.speed_max_m_s, "period": PlanRequest::default().period_s,
        "harmonics": PlanRequest::default().harmonics,
    });
    let output = Command::new(python)
        .arg(script)
        .args(["plan", &seconds.to_string(), &problem.to_string()])
        .output()?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into());
    }
    let found: Vec<serde_json::Value> = serde_json::from_slice(&output.stdout)?;
    let number = |entry: &serde_json::Value, key: &str| entry[key].as_f64().unwrap_or(f64::NAN);
    Ok(found
        .iter()
        .map(|entry| {
            (number(entry, "condition_number"), number(entry, "violation"), number(entry, "after_s"))
        })
        .collect())
}
