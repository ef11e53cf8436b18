//! The comparisons of models with a flight: flown again, predicted, played back.

use super::error_table::ErrorTable;
use crate::compare::{Fit, SIGNALS, TenSignals};
use crate::note::{About, Note};
use crate::study::COMPONENTS;

/// Table 4: errors of the ten signals between a flight and each simulation of it.
#[must_use]
pub fn closed_loop_table(
    title: impl Into<String>,
    recorded: &TenSignals,
    simulated: &[(String, Result<TenSignals, String>)],
    span_s: (f64, f64),
) -> ErrorTable {
    let column = |(name, signals): &(String, Result<TenSignals, String>)| {
        let errors = signals.as_ref().map_err(Clone::clone).and_then(|signals| {
            let errors = recorded.rms_errors(signals, span_s);
            errors.map(|errors| errors.map(Some).to_vec()).ok_or_else(|| "no common instants".to_owned())
        });
        (name.clone(), errors)
    };
    ErrorTable::new(title, &SIGNALS, &simulated.iter().map(column).collect::<Vec<_>>())
}

/// Tables 5 to 12: errors of the regression model's output, one column a set of parameters.
#[must_use]
pub fn prediction_table(
    title: impl Into<String>,
    columns: &[(String, Result<[f64; 4], String>)],
) -> ErrorTable {
    let columns: Vec<_> = columns
        .iter()
        .map(|(name, errors)| (name.clone(), errors.clone().map(|errors| errors.map(Some).to_vec())))
        .collect();
    ErrorTable::new(title, &COMPONENTS, &columns)
}

/// Open-loop playback over windows of `window_s`, one column a model.
#[must_use]
pub fn playback_table(window_s: f64, fits: &[(String, Result<Fit, String>)]) -> ErrorTable {
    const ROWS: [(&str, &str); 4] =
        [("position", "m"), ("velocity", "m/s"), ("attitude", "rad"), ("body rates", "rad/s")];
    let columns: Vec<_> = fits
        .iter()
        .map(|(name, fit)| (name.clone(), fit.clone().map(|fit| fit.quantities().to_vec())))
        .collect();
    let title = format!("Open-loop playback over windows of {window_s} s");
    let mut table = ErrorTable { window_s: Some(window_s), ..ErrorTable::new(title, &ROWS, &columns) };
    let shown = table.shown();
    let absent: Vec<&str> =
        ROWS.iter().map(|(name, _)| *name).filter(|name| shown.iter().all(|row| row.name != *name)).collect();
    if !absent.is_empty() {
        let text = format!("not recorded (position needs velocity as well): {}", absent.join(", "));
        table.notes.push(Note::remark(About::Errors, text));
    }
    table
}
