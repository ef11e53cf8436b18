//! `mavid simulate VEHICLE --trajectory T --out LOG.tlog`: a flight that never happened, as its log.

use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

use mavid::config::{read_trajectory, read_vehicle};
use mavid::recording::Recording;
use mavid::simulate::{FlightSettings, Reference, TelemetrySettings, Truth, simulate_flight};
use mavid::study::{with_further, with_stated_lag};
use mavid::text;
use mavid::vehicle::Vehicle;
use mavid::wire::write_recording;
use serde::Serialize;

use super::{CommandError, Outcome, output};
use crate::cli::SimulateArgs;

/// Host's time at the start of every simulated log, 2023-11-14 UTC: the same flight gives the same bytes.
const START_US: u64 = 1_700_000_000_000_000;
/// Hover before the trajectory, s. A convention of simulated flights, so that every log begins with a hover.
const HOVER_S: f64 = 4.0;
/// Change-over from hover to the trajectory, s. A convention of simulated flights: no jump of the setpoint.
const RAMP_S: f64 = 2.0;

/// What was flown.
#[derive(Debug, Serialize)]
struct Document {
    schema: u32,
    log: String,
    frames: u64,
    duration_s: f64,
    /// identifiers of the effects that acted
    effects: Vec<&'static str>,
    tracking_error_max_m: f64,
    /// share of the control periods with a command at a bound
    saturated: f64,
}

/// A vehicle farther off than this did not fly the trajectory, m.
const FOLLOWED_M: f64 = 1.0;

/// Runs the verb.
pub fn run(json: bool, args: &SimulateArgs) -> Result<Outcome, CommandError> {
    let input = |error: &dyn std::fmt::Display| CommandError::Input(error.to_string());
    let read = [&args.trajectory].into_iter().chain(&args.vehicle).chain(&args.effects).chain(&args.nominal);
    output::refuse_overwriting(&read.collect::<Vec<_>>(), &[&args.out])?;
    if args.out.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("csv")) {
        let name = text::path(&args.out);
        return Err(CommandError::Input(format!("--out: expected the name of a .tlog, got {name}")));
    }
    let (loaded, origin) = args.draft.given(args.vehicle.as_ref()).alone()?;
    output::warnings(&origin, &loaded.warnings);
    let vehicle = loaded.vehicle;
    let acting = with_further(&loaded.model.effects, &origin, args.effects.as_deref(), &vehicle)?;
    let nominal = match &args.nominal {
        Some(path) => read_vehicle(path)?.vehicle,
        None => vehicle.clone(),
    };
    let trajectory = read_trajectory(&args.trajectory)?;
    let duration_s = HOVER_S + f64::from(trajectory.repeats) * trajectory.series.period_s;
    let reference = Reference { trajectory: trajectory.series, hover_s: HOVER_S, ramp_s: RAMP_S };
    let settings = settings(args, &vehicle, duration_s);
    let ids = acting.iter().map(|active| active.effect().id()).collect();
    let acting = with_stated_lag(acting, &vehicle);
    let truth = Truth { vehicle, effects: acting, disturbance: None };
    let flight = simulate_flight(truth, &nominal, &reference, &settings).map_err(|error| input(&error))?;
    let frames = write(&args.out, &flight.recording)?;
    let document = Document {
        schema: 1,
        log: text::path(&args.out),
        frames,
        duration_s,
        effects: ids,
        tracking_error_max_m: flight.tracking_error_max_m,
        saturated: flight.saturated,
    };
    if flight.tracking_error_max_m > FOLLOWED_M {
        output::warning(&format!(
            "the vehicle could not follow {}: up to {:.1} m off it; plan with a longer --period, which needs less of \
             the rotors",
            text::path(&args.trajectory),
            flight.tracking_error_max_m
        ));
    }
    if json {
        output::json(&document)?;
    } else {
        output::text(&format!(
            "{}: {frames} frames, {duration_s} s, at most {:.3} m off the trajectory, a command at its bound in {:.2} % of the periods",
            document.log,
            document.tracking_error_max_m,
            100.0 * document.saturated
        ))?;
    }
    Ok(Outcome::Done)
}

fn settings(args: &SimulateArgs, vehicle: &Vehicle, duration_s: f64) -> FlightSettings {
    let base = FlightSettings::default();
    FlightSettings {
        seed: args.seed,
        duration_s,
        // where it is stated and not zero it is among the effects
        motor_time_constant_s: vehicle.propulsion.time_constant_s.unwrap_or(base.motor_time_constant_s),
        telemetry: TelemetrySettings { noise_scale: args.noise, ..base.telemetry },
        ..base
    }
}

/// Returns the number of frames.
fn write(path: &Path, recording: &Recording) -> Result<u64, CommandError> {
    let failed = |error| CommandError::Failure(format!("cannot write {}: {error}", text::path(&path)));
    output::folder_of(path)?;
    let file = BufWriter::new(File::create(path).map_err(failed)?);
    write_recording(recording, file, START_US).map_err(failed)
}
