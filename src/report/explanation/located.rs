//! Where simulation and recording differ.

use super::follow::variables;
use crate::diagnose::{AXES, CHANNEL_NAMES, Explanation, Trace, Verdict};
use serde::Serialize;

/// An axis' share of the misfit.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AxisShare {
    /// as in [`CHANNEL_NAMES`]
    pub axis: &'static str,
    /// percent
    pub share_percent: f64,
}

/// What a variable of the state explains of the misfit.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StateShare {
    /// name
    pub variable: String,
    /// percent
    pub share_percent: f64,
    /// value of the variable at which the misfit is largest, SI
    pub peak_at: Option<f64>,
}

/// The misfit by axis, time, state and frequency.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Located {
    /// largest share first; none where nothing is missing
    pub axes: Vec<AxisShare>,
    /// s, spans in which it is above its usual size
    pub time_s: Vec<[f64; 2]>,
    /// largest share first
    pub state: Vec<StateShare>,
    /// Hz, from and to
    pub band_hz: Option<[f64; 2]>,
    /// where in the room, in words
    #[serde(skip)]
    pub place: Option<String>,
}

/// A state that explains less is not listed, percent.
const LEAST_SHARE_PERCENT: f64 = 5.0;
/// A harmonic this far above its neighbours carries misfit.
const LINE_RATIO: f64 = 5.0;

impl Located {
    /// By axis and frequency, from the search and the harmonic test.
    #[must_use]
    pub fn of(explanation: &Explanation) -> Self {
        let energy = misfit(explanation);
        let total: f64 = energy.iter().sum();
        let mut axes: Vec<AxisShare> = energy
            .iter()
            .zip(CHANNEL_NAMES)
            .filter(|(energy, _)| **energy > 0.01 * total)
            .map(|(energy, axis)| AxisShare { axis, share_percent: 100.0 * energy / total })
            .collect();
        axes.sort_by(|a, b| b.share_percent.total_cmp(&a.share_percent));
        Self { axes, band_hz: band_hz(explanation), ..Self::default() }
    }

    /// By time and state along the axis with the largest share, from the flights' traces.
    pub(super) fn add_states(&mut self, explanation: &Explanation, traces: &[Trace]) {
        let worst = self.axes.first().and_then(|worst| CHANNEL_NAMES.iter().position(|n| *n == worst.axis));
        let Some(axis) = worst else { return };
        let (before, after) = (&explanation.search.before, &explanation.search.after);
        let residual = &before.rows.residual[axis];
        self.time_s = spans(&before.rows.time_s, &rolling(residual), 2.0 * after.weighted.sigma[axis]);
        self.state = variables(traces, before)
            .iter()
            .map(|variable| {
                let binned = variable.bin(residual);
                StateShare {
                    variable: variable.name.to_owned(),
                    share_percent: 100.0 * binned.share,
                    peak_at: binned.peak_at(),
                }
            })
            .filter(|state| state.share_percent > LEAST_SHARE_PERCENT)
            .collect();
        self.state.sort_by(|a, b| b.share_percent.total_cmp(&a.share_percent));
        self.place = self.state.first().and_then(|first| {
            let along = first.variable.strip_prefix("world_")?;
            let at = first.peak_at?;
            Some(format!("in the room where {along} is about {at:.1} m ({:.0} %)", first.share_percent))
        });
    }
}

/// Energy of the misfit by channel, sigma squared: what the found effects took away, or, where nothing
/// serves, what repeats with the trajectory.
fn misfit(explanation: &Explanation) -> [f64; AXES] {
    let search = &explanation.search;
    match explanation.verdict {
        Verdict::NothingMissing => [0.0; AXES],
        Verdict::Unexplained => explanation.lack_of_fit.as_ref().map_or([0.0; AXES], |lack| {
            std::array::from_fn(|c| lack.lines[c].iter().map(|line| line.excess.max(0.0)).sum())
        }),
        Verdict::Explained | Verdict::PartlyExplained => {
            let (before, after) = (&search.before.weighted.sigma, &search.after.weighted.sigma);
            std::array::from_fn(|c| {
                if after[c] > 0.0 { ((before[c] / after[c]).powi(2) - 1.0).max(0.0) } else { 0.0 }
            })
        }
    }
}

fn band_hz(explanation: &Explanation) -> Option<[f64; 2]> {
    let lack = explanation.lack_of_fit.as_ref()?;
    if matches!(explanation.verdict, Verdict::NothingMissing | Verdict::Explained) {
        return None;
    }
    let lines = lack.lines.iter().flatten().filter(|line| line.ratio > LINE_RATIO && line.excess > 0.0);
    lines.fold(None, |band: Option<[f64; 2]>, line| {
        let f = line.frequency_hz;
        Some(band.map_or([f, f], |[low, high]| [low.min(f), high.max(f)]))
    })
}

/// Rows of a rolling mean: one second.
const ROLLING: usize = 20;
/// s between spans that are one.
const JOINED_S: f64 = 1.0;

/// Rolling root mean square over a second.
pub(super) fn rolling(residual: &[f64]) -> Vec<f64> {
    let half = ROLLING / 2;
    (0..residual.len())
        .map(|row| {
            let part = &residual[row.saturating_sub(half)..(row + half).min(residual.len())];
            (part.iter().map(|r| r * r).sum::<f64>() / part.len().max(1) as f64).sqrt()
        })
        .collect()
}

/// Spans in which a size lies above a bound, s; near ones are joined.
pub(super) fn spans(time_s: &[f64], size: &[f64], bound: f64) -> Vec<[f64; 2]> {
    let mut out: Vec<[f64; 2]> = Vec::new();
    for (time, _) in time_s.iter().zip(size).filter(|(_, size)| **size > bound) {
        match out.last_mut() {
            Some(last) if time - last[1] < JOINED_S => last[1] = *time,
            _ => out.push([*time, *time]),
        }
    }
    out.retain(|[from, to]| to > from);
    out
}
