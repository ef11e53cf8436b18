//! The comparisons of models with a flight: flown again, predicted, played back.

use super::error_table::ErrorTable;
use crate::compare::{Fit, SIGNALS, TenSignals};

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

/// Components of (43).
pub(in crate::report) const COMPONENTS: [(&str, &str); 4] =
    [("1: F_z", "N"), ("2: tau_phi", "N m"), ("3: tau_theta", "N m"), ("4: tau_psi", "N m")];

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
        table.notes.push(format!("not recorded (position needs velocity as well): {}", absent.join(", ")));
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_no_model_has_is_left_out_and_said_in_one_line() {
        let fit = Fit { attitude_rad: Some(0.1), rates_rad_s: Some(0.2), windows: 3, ..Fit::default() };
        let page = playback_table(0.5, &[("a".to_owned(), Ok(fit))]).page();
        assert!(!page.contains("velocity (m/s)") && page.contains("attitude (rad)"), "{page}");
        assert!(
            page.contains("not recorded (position needs velocity as well): position, velocity\n"),
            "{page}"
        );
        let none = || Err("no setpoints".to_owned());
        let mut table = closed_loop_table(
            "Again",
            &TenSignals::default(),
            &[("a".to_owned(), none()), ("b".to_owned(), none())],
            (0.0, 1.0),
        );
        table.notes.push("controller: a PID".to_owned());
        assert_eq!(table.page(), "Again: none\n  a, b: no setpoints\n");
    }
}
