//! The charts of flights that were simulated in closed loop.

use crate::compare::{SIGNALS, TenSignals};
use crate::report::chart::{Line, Panel};

/// Figures 6 to 9: the path over ground, then each of the ten signals over time, recorded and simulated; none without
/// flights.
#[must_use]
pub fn closed_loop_charts(flights: &[(String, TenSignals)]) -> Vec<Panel> {
    if flights.is_empty() {
        return Vec::new();
    }
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
