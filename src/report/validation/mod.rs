//! The paper's two validations and open-loop playback as tables and charts.

mod heads;
mod html;

use serde::Serialize;
use std::fmt::Write;

use super::chart::{Line, Panel};
use crate::compare::{Fit, SIGNALS, TenSignals, improvement_percent};
pub use heads::shortened_names;
pub use html::{ValidatedFlight, validation_report};

/// RMS errors, one column a model; the first column is what the others are compared with.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ErrorTable {
    /// what was compared
    pub title: String,
    /// s, length of the windows of a playback
    #[serde(skip_serializing_if = "Option::is_none")]
    pub window_s: Option<f64>,
    /// names of the models
    pub models: Vec<String>,
    /// one a signal or component
    pub rows: Vec<ErrorRow>,
    /// models that are missing, and why
    pub missing: Vec<String>,
    /// what to know when reading it
    pub notes: Vec<String>,
}

/// One signal's errors.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ErrorRow {
    /// signal or component
    pub name: String,
    /// of the errors
    pub unit: String,
    /// RMS, one a model; null where there is none
    pub rms: Vec<Option<f64>>,
    /// `P_imp` against the first model, one a model; null where there is none
    pub improvement_percent: Vec<Option<f64>>,
}

/// A model's name and its errors, row by row, or why it has none.
pub type Column = (String, Result<Vec<Option<f64>>, String>);

impl ErrorTable {
    /// `rows` are names and units; each column holds as many errors.
    #[must_use]
    pub fn new(title: impl Into<String>, rows: &[(&str, &str)], columns: &[Column]) -> Self {
        let rms = |row: usize, column: usize| {
            columns[column].1.as_ref().ok().and_then(|errors| errors.get(row).copied().flatten())
        };
        let row = |(index, (name, unit)): (usize, &(&str, &str))| ErrorRow {
            name: (*name).to_owned(),
            unit: (*unit).to_owned(),
            rms: (0..columns.len()).map(|column| rms(index, column)).collect(),
            improvement_percent: (0..columns.len())
                .map(|column| Some(improvement_percent(rms(index, 0)?, rms(index, column)?)))
                .collect(),
        };
        // models that lack the same are told together
        let mut missing: Vec<(Vec<&str>, &str)> = Vec::new();
        for (name, errors) in columns {
            let Err(why) = errors else { continue };
            match missing.iter_mut().find(|(_, other)| *other == why) {
                Some((names, _)) => names.push(name),
                None => missing.push((vec![name.as_str()], why.as_str())),
            }
        }
        Self {
            title: title.into(),
            window_s: None,
            models: columns.iter().map(|(name, _)| name.clone()).collect(),
            rows: rows.iter().enumerate().map(row).collect(),
            missing: missing.iter().map(|(names, why)| format!("{}: {why}", names.join(", "))).collect(),
            notes: Vec::new(),
        }
    }

    /// Rows that hold an error of any model.
    #[must_use]
    pub fn shown(&self) -> Vec<&ErrorRow> {
        self.rows.iter().filter(|row| row.rms.iter().any(Option::is_some)).collect()
    }

    /// What is said below the rows: which models are missing and why, and, where there are rows, the notes.
    #[must_use]
    pub fn remarks(&self) -> Vec<&str> {
        let notes: &[String] = if self.shown().is_empty() { &[] } else { &self.notes };
        self.missing.iter().chain(notes).map(String::as_str).collect()
    }

    /// The table for people, in the form of Tables 4 to 12; where there is nothing to show, why.
    #[must_use]
    pub fn page(&self) -> String {
        let rows = self.shown();
        if rows.is_empty() {
            return format!("{}: none\n  {}\n", self.title, self.remarks().join("\n  "));
        }
        let mut page = format!("{}\n  {:<22}", self.title, "RMS error");
        for (index, model) in heads::column_heads(&self.models).iter().enumerate() {
            let _ = write!(page, "{model:>15}");
            if index > 0 {
                let _ = write!(page, "{:>10}", "P_imp %");
            }
        }
        page.push('\n');
        let number = |value: Option<f64>, digits: usize| {
            value.map_or_else(|| "-".to_owned(), |value| format!("{value:.digits$}"))
        };
        for row in rows {
            let _ = write!(page, "  {:<22}", format!("{} ({})", row.name, row.unit));
            for (index, (rms, gain)) in row.rms.iter().zip(&row.improvement_percent).enumerate() {
                let _ = write!(page, "{:>15}", number(*rms, 5));
                if index > 0 {
                    let _ = write!(page, "{:>10}", number(*gain, 2));
                }
            }
            page.push('\n');
        }
        for line in self.remarks() {
            let _ = writeln!(page, "  {line}");
        }
        page
    }
}

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

/// Components of (43).
pub(super) const COMPONENTS: [(&str, &str); 4] =
    [("1: F_z", "N"), ("2: tau_phi", "N m"), ("3: tau_theta", "N m"), ("4: tau_psi", "N m")];

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
        table.notes.push(format!("not recorded (position needs velocity as well): {}", absent.join(", ")));
    }
    table
}

/// Figures 6 to 9: the path over ground, then each of the ten signals along time, recorded and simulated.
#[must_use]
pub fn closed_loop_charts(flights: &[(String, &TenSignals)]) -> Vec<Panel> {
    let line = |label: &str, signals: &TenSignals, x: Option<usize>, y: usize| {
        // a chart is some 440 dots wide
        let every = (signals.time_s.len() / 880).max(1);
        let kept = || (0..signals.time_s.len()).step_by(every);
        Line {
            label: label.to_owned(),
            x: kept().map(|i| x.map_or(signals.time_s[i], |x| signals.values[i][x])).collect(),
            y: kept().map(|i| signals.values[i][y]).collect(),
            ..Line::default()
        }
    };
    let panel = |title: &str, labels: (&str, String), x: Option<usize>, y: usize| Panel {
        title: title.to_owned(),
        x_label: labels.0.to_owned(),
        y_label: labels.1,
        lines: flights.iter().map(|(label, signals)| line(label, signals, x, y)).collect(),
        ..Panel::default()
    };
    let mut panels = vec![panel("path", ("x (m)", "y (m)".to_owned()), Some(0), 1)];
    for (index, (name, unit)) in SIGNALS.iter().enumerate() {
        panels.push(panel(name, ("time (s)", format!("{name} ({unit})")), None, index));
    }
    panels
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn improvement_is_against_the_first_model_and_gaps_stay_gaps() {
        let columns = [
            ("nominal".to_owned(), Ok(vec![Some(0.06187), None])),
            ("LS".to_owned(), Ok(vec![Some(0.05888), Some(1.0)])),
            ("GD".to_owned(), Err("diverged".to_owned())),
        ];
        let table = ErrorTable::new("Table 4", &[("x", "m"), ("y", "m")], &columns);
        assert!((table.rows[0].improvement_percent[1].unwrap() - 4.83).abs() < 0.01);
        assert_eq!(table.rows[0].improvement_percent[2], None);
        assert_eq!(table.rows[1].improvement_percent[1], None);
        assert_eq!(table.missing, ["GD: diverged"]);
        let page = table.page();
        assert!(page.contains("4.83") && page.contains("x (m)") && page.contains("GD: diverged"), "{page}");
    }

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
