//! Errors of open-loop prediction before and after.

use super::story::{Story, rigid_body};
use crate::compare::{CompareError, Fit, PlaybackSettings, improvement_percent, playback};
use crate::diagnose::{Trace, fit};
use crate::physics::{ActiveEffect, Model};
use crate::report::number::with_error;
use crate::signals::Signals;
use crate::vehicle::Vehicle;
use rayon::prelude::*;

/// What the improvement is shown on.
#[derive(Debug, Clone, PartialEq)]
pub enum ShownOn {
    /// flights that were not used otherwise, by their files
    Flights(Vec<crate::report::InputFile>),
    /// the end of the flight that was explained, held back from it
    HeldBack {
        /// s, from where on
        from_s: f64,
        /// s of flight
        seconds: f64,
    },
    /// nothing was left to show it on
    Nothing {
        /// why
        reason: String,
    },
}

impl ShownOn {
    /// Words for a sentence.
    #[must_use]
    pub fn words(&self) -> &'static str {
        match self {
            Self::Flights(_) => "the hold-out",
            Self::HeldBack { .. } => "the part of the flight held back",
            Self::Nothing { .. } => "nothing",
        }
    }
}

/// Rigid body alone, and the model with what was found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// rigid body, identified on the same data
    pub before: Fit,
    /// with the effects
    pub after: Fit,
}

/// Names of the quantities of a [`Fit`] in their order.
pub const QUANTITIES: [(&str, &str); 4] =
    [("position", "m"), ("velocity", "m/s"), ("attitude", "rad"), ("body rate", "rad/s")];

impl Pair {
    /// Percent by which each quantity's error fell.
    #[must_use]
    pub fn improvements(&self) -> [Option<f64>; 4] {
        let (before, after) = (self.before.quantities(), self.after.quantities());
        std::array::from_fn(|i| Some(improvement_percent(before[i]?, after[i]?)))
    }

    /// Mean over the quantities, percent.
    #[must_use]
    pub fn improvement(&self) -> Option<f64> {
        let known: Vec<f64> = self.improvements().into_iter().flatten().collect();
        (!known.is_empty()).then(|| known.iter().sum::<f64>() / known.len() as f64)
    }
}

impl Story {
    /// Plays flights back through the models before and after.
    ///
    /// # Errors
    /// [`CompareError`] where attitude or rates are missing or no window fits.
    pub fn played(&self, flights: &[Signals]) -> Result<Pair, CompareError> {
        let (before, after) = (self.model_before(), self.model_after());
        let (before, after) = rayon::join(|| fit_of(&before, flights), || fit_of(&after, flights));
        Ok(Pair { before: before?, after: after? })
    }
}

/// A hold-out whose mass or inertia differs by more than these shares is another vehicle's.
const OTHER_MASS: f64 = 0.05;
const OTHER_INERTIA: f64 = 0.5;
/// and by as many standard errors.
const CERTAIN: f64 = 6.0;

impl Story {
    /// Whether the hold-out was flown by another vehicle (or with another load), by its own residual about
    /// the model that was found: the sentence that says so.
    #[must_use]
    pub fn stranger(&self, flights: &[Signals]) -> Option<String> {
        let mut base = self.explanation.search.after.base.clone();
        base.present.iter_mut().for_each(|present| present.free.clear());
        let half_width_s = self.given.settings.half_width_s;
        let traces: Vec<Trace> = flights
            .iter()
            .map(|signals| Trace::new(signals, &self.given.vehicle, half_width_s))
            .collect::<Result<_, _>>()
            .ok()?;
        let own = rigid_body(&fit(&traces, base).ok()?);
        let differs = own.iter().zip(self.rigid_body()).find(|(theirs, ours)| {
            let share = match ours.name {
                "mass" => OTHER_MASS,
                "ixx" | "iyy" | "izz" => OTHER_INERTIA,
                _ => return false,
            };
            let by = (theirs.value - ours.value).abs();
            by > share * ours.value && by > CERTAIN * theirs.std.hypot(ours.std)
        });
        differs.map(|(theirs, ours)| {
            format!(
                "the hold-out does not look like the same vehicle: its {} comes out as {} {unit}, that of the flights explained as {} {unit}; expected another flight of this vehicle with the same load",
                ours.name,
                with_error(theirs.value, theirs.std),
                with_error(ours.value, ours.std),
                unit = ours.unit
            )
        })
    }
}

/// Over all flights together.
fn fit_of(
    (vehicle, effects): &(Vehicle, Vec<ActiveEffect>),
    flights: &[Signals],
) -> Result<Fit, CompareError> {
    let model = Model::new(vehicle, effects.clone()).map_err(crate::simulate::SimulateError::from)?;
    let settings = PlaybackSettings::default();
    let fits: Vec<Fit> = flights
        .par_iter()
        .map(|signals| playback((&model, vehicle), signals, &settings))
        .collect::<Result<_, _>>()?;
    let windows = fits.iter().map(|fit| fit.windows).sum();
    let pooled = |quantity: usize| {
        let (mut sum, mut count) = (0.0, 0.0);
        for fit in &fits {
            let weight = fit.windows as f64;
            sum += weight * fit.quantities()[quantity]?.powi(2);
            count += weight;
        }
        (count > 0.0).then(|| (sum / count).sqrt())
    };
    Ok(Fit {
        position_m: pooled(0),
        velocity_m_s: pooled(1),
        attitude_rad: pooled(2),
        rates_rad_s: pooled(3),
        windows,
    })
}

/// The last quarter of a single flight, whole periods of it where it repeats, for showing; the rest for
/// explaining. `None` where what remains would be too short for either.
#[must_use]
pub fn held_back(signals: &Signals, period_s: Option<f64>) -> Option<(Signals, Signals, f64)> {
    const SHARE: f64 = 0.25;
    const LEAST_S: f64 = 3.0;
    let step_s = signals.grid.step_s;
    let used: Vec<usize> = (0..signals.grid.count).filter(|&i| signals.usable[i]).collect();
    let seconds = used.len() as f64 * step_s;
    let back_s = match period_s {
        Some(period_s) if period_s < seconds => (SHARE * seconds / period_s).round().max(1.0) * period_s,
        _ => SHARE * seconds,
    };
    if back_s < LEAST_S || seconds - back_s < 2.0 * LEAST_S {
        return None;
    }
    let mut left_s = seconds - back_s;
    let first = *used.iter().find(|_| {
        left_s -= step_s;
        left_s <= 0.0
    })?;
    let (mut explained, mut shown) = (signals.clone(), signals.clone());
    explained.usable[first..].fill(false);
    shown.usable[..first].fill(false);
    Some((explained, shown, signals.grid.time_s(first)))
}
