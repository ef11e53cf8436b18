//! The split of a flight if there is no hold-out flight: its last periods are held back.

use crate::diagnose::harmonics::period_s;
use crate::signals::{Signals, stride};

/// A flight in two parts. Both contain all instants; only the masks differ.
#[derive(Debug, Clone)]
pub struct Split {
    /// the part that is explained
    pub identify: Signals,
    /// the part that is held back
    pub holdout: Signals,
    /// s, vehicle clock, where the second part begins
    pub from_s: f64,
}

/// Least time that must remain for the explanation, s. With less the explanation has too few rows.
const LEAST_S: f64 = 12.0;
/// Time left out between the parts, s: longer than the weak form's kernel (0.4 s) and the playback's warm-up.
const BETWEEN_S: f64 = 0.5;
/// Share of the flight that is held back. More would leave less to explain, less would make the intervals wide.
const SHARE: f64 = 1.0 / 3.0;

/// Holds back the last whole periods, about a third of the flight and at least one period; without a period, or where whole periods would
/// leave too little, the last third. `None` if too little would be left on either side.
#[must_use]
pub fn split_last_periods(signals: &Signals) -> Option<Split> {
    let used: Vec<usize> = (0..signals.grid.count).filter(|&index| signals.usable[index]).collect();
    let (first_s, last_s) = (signals.grid.time_s(*used.first()?), signals.grid.time_s(*used.last()?));
    let third_s = SHARE * (last_s - first_s);
    let period_s = flown_period_s(signals, &used);
    tracing::debug!(first_s, last_s, ?period_s, "the end of the flight is held back");
    let whole_s = period_s.map(|period_s| (third_s / period_s).round().max(1.0) * period_s);
    whole_s.into_iter().chain([third_s]).find_map(|held_s| split(signals, last_s - held_s))
}

/// The flight before and after a time (s); `None` if too little is left on either side.
fn split(signals: &Signals, from_s: f64) -> Option<Split> {
    let cut = |keep: &dyn Fn(f64) -> bool| {
        let mut part = signals.clone();
        for (index, usable) in part.usable.iter_mut().enumerate() {
            *usable &= keep(signals.grid.time_s(index));
        }
        part
    };
    let identify = cut(&|time_s| time_s < from_s - BETWEEN_S);
    let holdout = cut(&|time_s| time_s >= from_s);
    let seconds =
        |part: &Signals| part.usable.iter().filter(|usable| **usable).count() as f64 * signals.grid.step_s;
    (seconds(&identify) >= LEAST_S && seconds(&holdout) >= LEAST_S / 2.0).then_some(Split {
        identify,
        holdout,
        from_s,
    })
}

/// Period of the flight (s) over the instants that are `used`, by velocity if it is known, otherwise by body rates; `None` where it does not
/// repeat itself.
#[must_use]
pub fn flown_period_s(signals: &Signals, used: &[usize]) -> Option<f64> {
    let motion = signals.velocity.as_ref().or(signals.rate.as_ref())?;
    let rows: Vec<usize> = used.iter().copied().step_by(stride(signals.grid.step_s)).collect();
    let time_s: Vec<f64> = rows.iter().map(|&index| signals.grid.time_s(index)).collect();
    let axes: Vec<Vec<f64>> =
        (0..3).map(|axis| rows.iter().map(|&index| motion[index][axis]).collect()).collect();
    let axes: Vec<&[f64]> = axes.iter().map(Vec::as_slice).collect();
    period_s(&time_s, &axes)
}
