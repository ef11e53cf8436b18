//! How often an unchanged vehicle is called changed: by histories whose flights are in no order.

use super::history::VehicleHistory;
use crate::study::{Judge, Track};
use crate::trim::{AXES, Balance};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use rayon::prelude::*;
use serde::Serialize;

/// Most unchanged vehicles that are called changed, as a share: one of 200.
pub const FALSE_ALARMS: f64 = 0.005;
/// Shuffled histories by which that is calibrated.
pub const SHUFFLES: u32 = 1000;
/// Flights, or blocks of them, from which on an order says something: three have six orders.
const LEAST_BLOCKS: usize = 4;
/// Standard deviations that `compare` asks for by itself.
const NAMED_SIGMAS: f64 = 4.5;

/// The rate of false alarms of one fleet, by its own flights.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FalseAlarms {
    /// what was asked for: share of unchanged vehicles, over the whole time of their histories
    pub wanted: f64,
    /// histories that were shuffled; 0: no vehicle has flights enough, and the usual bound holds
    pub shuffled: usize,
    /// of these called changed, by the bound below
    pub called: usize,
    /// flights of a history, mean
    pub flights: f64,
    /// blocks of a history that were shuffled as wholes, mean
    pub blocks: f64,
    /// standard deviations that a change needs
    pub least_sigmas: f64,
}

impl FalseAlarms {
    /// Share of the shuffled histories that are called changed, and the largest that agrees with that count at 95 %.
    #[must_use]
    pub fn rate(&self) -> Option<(f64, f64)> {
        use statrs::distribution::{Beta, ContinuousCDF};
        if self.shuffled == 0 {
            return None;
        }
        let (called, all) = (self.called as f64, self.shuffled as f64);
        let most = if self.called == self.shuffled {
            1.0
        } else {
            Beta::new(called + 1.0, all - called).map_or(1.0, |beta| beta.inverse_cdf(0.95))
        };
        Some((called / all, most))
    }
}

/// Shuffles the histories and finds the bound beyond which at most the wanted share of them is called changed. Time is no order
/// there: what is found is chance. Flights of one day (or of one log, where logs have no date) are alike and stay together. Changes that
/// a history shows by itself are taken out before, because they are no chance.
#[must_use]
pub fn calibrated(histories: &[VehicleHistory], wanted: f64, shuffles: u32) -> FalseAlarms {
    let long: Vec<Unchanged<'_>> = histories
        .iter()
        .filter(|history| history.study.flights.len() >= LEAST_BLOCKS)
        .map(Unchanged::of)
        .collect();
    let none =
        FalseAlarms { wanted, shuffled: 0, called: 0, flights: 0.0, blocks: 0.0, least_sigmas: NAMED_SIGMAS };
    if long.is_empty() {
        return none;
    }
    // in turn, so that each vehicle has as many
    let draws = usize::try_from(shuffles).unwrap_or(usize::MAX).div_ceil(long.len()) * long.len();
    let one = |draw: usize| long[draw % long.len()].strongest_shuffled(draw as u64);
    let mut strongest: Vec<f64> = (0..draws).into_par_iter().map(one).collect();
    strongest.sort_by(|a, b| b.total_cmp(a));
    let shuffled = strongest.len();
    // a chance that falls between two counts is the lower
    let allowed = (0..shuffled).take_while(|count| (*count + 1) as f64 <= wanted * shuffled as f64).count();
    let bound = strongest.get(allowed).copied().unwrap_or(0.0);
    let least_sigmas = NAMED_SIGMAS.max(bound.next_up());
    let mean = |of: fn(&Unchanged<'_>) -> usize| {
        long.iter().map(|long| of(long) as f64).sum::<f64>() / long.len() as f64
    };
    FalseAlarms {
        shuffled,
        called: strongest.iter().take_while(|sigmas| **sigmas >= least_sigmas).count(),
        flights: mean(|long| long.history.study.flights.len()),
        blocks: mean(|long| long.blocks.len()),
        least_sigmas,
        ..none
    }
}

/// A history without the changes that it shows.
struct Unchanged<'a> {
    history: &'a VehicleHistory,
    balance: Balance,
    tracks: Vec<Track>,
    /// flights that stay together
    blocks: Vec<Vec<usize>>,
}

impl<'a> Unchanged<'a> {
    fn of(history: &'a VehicleHistory) -> Self {
        let study = &history.study;
        let count = study.flights.len();
        let order: Vec<usize> = (0..count).collect();
        let steps = judge(history).history(&order, NAMED_SIGMAS);
        let borders: Vec<usize> =
            std::iter::once(0).chain(steps.iter().map(|step| step.from)).chain([count]).collect();
        let (mut balance, mut tracks) = (study.balance.clone(), study.tracks.clone());
        if !steps.is_empty() {
            for axis in 0..AXES {
                let lean: Vec<_> = balance.flights.iter().map(|flight| Some(flight.lean[axis])).collect();
                for (flight, level) in balance.flights.iter_mut().zip(levelled(&lean, &borders)) {
                    flight.lean[axis] = level.unwrap_or(flight.lean[axis]);
                }
            }
            for track in &mut tracks {
                let values: Vec<_> = track.values.iter().map(|value| Some(value.as_ref()?.0)).collect();
                for (value, level) in track.values.iter_mut().zip(levelled(&values, &borders)) {
                    *value = value.zip(level).map(|((_, std), level)| (level, std));
                }
            }
        }
        Self { history, balance, tracks, blocks: blocks(history) }
    }

    /// Standard deviations of the strongest change of a shuffled order, 0 where there is none.
    fn strongest_shuffled(&self, draw: u64) -> f64 {
        let mut blocks: Vec<&Vec<usize>> = self.blocks.iter().collect();
        let mut generator = Pcg64::seed_from_u64(draw);
        for place in (1..blocks.len()).rev() {
            blocks.swap(place, generator.random_range(0..=place));
        }
        let order: Vec<usize> = blocks.into_iter().flatten().copied().collect();
        let judge = Judge { balance: &self.balance, tracks: &self.tracks, ..judge(self.history) };
        judge.strongest(&order)
    }
}

/// A row without the differences between its parts: each part has the mean of the row, and scatters about it as much as the part
/// scatters about its own.
fn levelled(row: &[Option<f64>], borders: &[usize]) -> Vec<Option<f64>> {
    let mean = |of: &[Option<f64>]| {
        let known: Vec<f64> = of.iter().flatten().copied().collect();
        (known.iter().sum::<f64>() / known.len() as f64, known.len() as f64)
    };
    let (of_row, _) = mean(row);
    let part = |ends: &[usize]| {
        let own = &row[ends[0]..ends[1]];
        let (of_part, count) = mean(own);
        // the mean of a part takes one of its freedoms
        let scatter = (count / (count - 1.0).max(1.0)).sqrt();
        own.iter().map(move |value| value.map(|value| of_row + scatter * (value - of_part)))
    };
    borders.windows(2).flat_map(part).collect()
}

/// Flights that are alike and stay together: of one day, or of one log where not all logs have a date. Each flight alone where that
/// makes too few of them.
fn blocks(history: &VehicleHistory) -> Vec<Vec<usize>> {
    let study = &history.study;
    let is_with_last = |place: usize| match &history.start_utc_us {
        Some(starts) => starts[place].div_euclid(DAY_US) == starts[place - 1].div_euclid(DAY_US),
        None => study.flights[place].input.sha256 == study.flights[place - 1].input.sha256,
    };
    let mut blocks: Vec<Vec<usize>> = Vec::new();
    for place in 0..study.flights.len() {
        match blocks.last_mut() {
            Some(block) if is_with_last(place) => block.push(place),
            _ => blocks.push(vec![place]),
        }
    }
    if blocks.len() < LEAST_BLOCKS {
        (0..study.flights.len()).map(|place| vec![place]).collect()
    } else {
        blocks
    }
}

/// A day, microseconds.
const DAY_US: i64 = 86_400_000_000;

/// The judge of a history.
#[must_use]
pub fn judge(history: &VehicleHistory) -> Judge<'_> {
    let study = &history.study;
    Judge {
        vehicle: &study.vehicle,
        balance: &study.balance,
        tracks: &study.tracks,
        is_known: study.is_known,
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test ends where it fails")]
    use super::*;

    #[test]
    fn a_row_without_its_step_scatters_as_its_parts_do() {
        let row = [Some(1.0), Some(1.2), None, Some(5.0), Some(5.4), Some(5.2)];
        let level = levelled(&row, &[0, 3, 6]);
        let mean = (1.0 + 1.2 + 5.0 + 5.4 + 5.2) / 5.0;
        assert!((level[0].unwrap() - (mean - 0.1 * 2.0_f64.sqrt())).abs() < 1e-12);
        assert_eq!(level[2], None);
        assert!((level[4].unwrap() - (mean + 0.2 * 1.5_f64.sqrt())).abs() < 1e-12);
        assert_eq!(levelled(&[Some(3.0)], &[0, 1]), [Some(3.0)]);
    }
}
