//! The flight flown again in closed loop by each model.

use super::comparisons::closed_loop_table;
use super::error_table::ErrorTable;
use super::model::Contender;
use crate::compare::{TenSignals, autopilot_flight, divergence, recorded_tracking_m, resimulated};
use crate::note::{About, Note};
use crate::signals::{Signals, ThrustSource};
use crate::simulate::pid::{PidFlightSettings, PidSettings};
use crate::study::flight::Flight;
use rayon::prelude::*;

/// Table 4 and the lines of Figures 6 to 9, recorded first; no lines where no model flew.
pub(super) fn closed_loop(
    flight: &Flight,
    signals: &Signals,
    models: &[Contender],
    span_s: (f64, f64),
) -> (ErrorTable, Vec<(String, TenSignals)>) {
    let by_pid = signals.quality.thrust_source == ThrustSource::Wrench;
    let controller = if by_pid { "the paper's PID" } else { "an autopilot's cascade" };
    let title = format!(
        "Simulated in closed loop with {controller} from the recorded setpoints, {:.0} to {:.0} s",
        span_s.0, span_s.1
    );
    let mut flown: Vec<(String, Result<TenSignals, String>)> =
        models.par_iter().map(|model| (model.of.name.clone(), fly(flight, model, models, by_pid))).collect();
    let recorded = match TenSignals::of_signals(signals) {
        Ok(recorded) => recorded,
        Err(error) => {
            let missing: Vec<_> =
                models.iter().map(|model| (model.of.name.clone(), Err(error.to_string()))).collect();
            return (closed_loop_table(title, &TenSignals::default(), &missing, span_s), Vec::new());
        }
    };
    for (_, simulated) in &mut flown {
        let how = simulated.as_ref().ok().and_then(|simulated| divergence(&recorded, simulated, span_s));
        if let Some(how) = how {
            *simulated = Err(format!(
                "the simulation diverges from the flight: {how}; its errors say nothing about the model"
            ));
        }
    }
    let table = closed_loop_table(title, &recorded, &flown, span_s);
    if table.shown().is_empty() {
        return (table, Vec::new());
    }
    let tracking = recorded_tracking_m(&flight.recording, &recorded, span_s);
    let notes = notes(by_pid, &models[0].of.name, tracking.ok().flatten());
    let mut lines = vec![("recorded".to_owned(), recorded)];
    lines.extend(flown.into_iter().filter_map(|(name, signals)| Some((name, signals.ok()?))));
    (ErrorTable { notes, ..table }, lines)
}

/// By the controller that believes the first model.
fn fly(flight: &Flight, model: &Contender, models: &[Contender], by_pid: bool) -> Result<TenSignals, String> {
    let nominal = &models[0].vehicle;
    let flown = if by_pid {
        let controller = PidSettings { mass_kg: nominal.body.mass_kg, ..PidSettings::default() };
        let settings = PidFlightSettings { controller, ..PidFlightSettings::default() };
        resimulated(&flight.recording, (&model.model, &model.vehicle), &settings)
    } else {
        autopilot_flight(&flight.recording, &model.model, nominal)
    };
    flown.map_err(|error| error.to_string())
}

/// Who flew the simulations, and what that leaves in the errors.
fn notes(by_pid: bool, nominal: &str, tracking_m: Option<[f64; 3]>) -> Vec<Note> {
    let controller = if by_pid {
        format!("controller: the paper's PID (28) to (32) with the mass of {nominal}, on exact states")
    } else {
        format!(
            "controller: position, velocity, attitude and rate loops with PX4's default gains, on exact states; it \
             assumes {nominal}. The autopilot's own gains and estimates are not in the log, so their differences \
             affect every column. Force and torque distinguish models; position and attitude do so only as far as the \
             controller does not hold them"
        )
    };
    let tracking = tracking_m.map(|[x, y, z]| {
        format!(
            "the recorded flight itself was off its setpoints by {x:.3}, {y:.3}, {z:.3} m RMS in x, y, z, which no \
             model can correct"
        )
    });
    std::iter::once(controller).chain(tracking).map(|text| Note::remark(About::Errors, text)).collect()
}
