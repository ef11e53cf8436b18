//! Force and torque that the rotors gave, and what models make of the recorded motion.

use super::chart::{Line, Panel};
use super::validation::COMPONENTS;
use crate::estimate::Theta;
use crate::regression::{ZeroPhase, paper_models};
use crate::signals::{Butterworth, Signals};

/// Points of a line at most: a chart is some 440 dots wide.
const POINTS: usize = 900;

/// One panel a component of (43) on a flight behind a zero-phase low-pass at `cutoff_hz`: what the rotors gave
/// (N, N m), times `thrust_factor`, and `Gamma Theta` of each model by its label. None where body rates or
/// vertical motion are not recorded.
pub(super) fn recorded_and_predicted(
    signals: &Signals,
    (cutoff_hz, gravity_m_s2, thrust_factor): (f64, f64, f64),
    models: &[(&str, Theta)],
) -> Vec<Panel> {
    let filter = Butterworth::new(cutoff_hz, 1.0 / signals.grid.step_s);
    let Some((standard, _)) =
        filter.and_then(|filter| paper_models(signals, gravity_m_s2, &ZeroPhase::Butterworth(filter)))
    else {
        return Vec::new();
    };
    let every = standard.time_s.len().div_ceil(POINTS).max(1);
    let time_s: Vec<f64> = standard.time_s.iter().step_by(every).copied().collect();
    let kept = || (0..standard.time_s.len()).step_by(every);
    COMPONENTS
        .iter()
        .enumerate()
        .map(|(row, (name, unit))| {
            let line = |label: &str, y: Vec<f64>, colour| Line {
                label: label.to_owned(),
                x: time_s.clone(),
                y,
                colour: Some(colour),
                ..Line::default()
            };
            let mut lines: Vec<Line> = models
                .iter()
                .enumerate()
                .map(|(index, (label, theta))| {
                    let y = kept().map(|i| (standard.gamma[i] * theta)[row]).collect();
                    line(label, y, index + 1)
                })
                .collect();
            lines.push(line("rotors", kept().map(|i| thrust_factor * standard.upsilon[i][row]).collect(), 0));
            let name = name.split_once(": ").map_or(*name, |(_, name)| name);
            Panel {
                title: format!("{name}, by the rotors and by the motion"),
                x_label: "time (s)".to_owned(),
                y_label: (*unit).to_owned(),
                lines,
                ..Panel::default()
            }
        })
        .collect()
}
