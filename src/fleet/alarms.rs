//! How often an unchanged vehicle is called changed: by histories whose flights are in no order.

use super::history::VehicleHistory;
use crate::change::NAMED_SIGMAS;
use crate::study::{Changed, Judge, Track};
use crate::trim::{AXES, Balance};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use rayon::prelude::*;
use serde::Serialize;
use statrs::distribution::{Beta, ContinuousCDF};

/// Most unchanged vehicles that are called changed, as a share: one of 200.
pub const FALSE_ALARMS: f64 = 0.005;
/// Shuffled histories by which that is calibrated.
pub const SHUFFLES: u32 = 1000;
/// Flights, or blocks of them, from which on an order says something: three have six orders.
const LEAST_BLOCKS: usize = 4;

/// The rate of false alarms of one fleet, by its own flights.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FalseAlarms {
    /// what was asked for: share of unchanged vehicles, over the whole time of their histories
    #[serde(rename = "wanted")]
    pub allowed: f64,
    /// histories that were shuffled; 0: too few orders differ for the share that was asked for, and the usual bound holds
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
    /// Share of the shuffled histories that are called changed, and the largest that agrees with that count at 95 %. Orders that occur
    /// several times are counted several times: of few blocks there are few orders.
    #[must_use]
    pub fn rate(&self) -> Option<(f64, f64)> {
        let share = self.called as f64 / self.shuffled as f64;
        (self.shuffled > 0).then(|| (share, greatest_rate(self.called, self.shuffled)))
    }
}

/// The largest share of all histories that agrees at 95 % with so many called changed of those that were shuffled.
fn greatest_rate(called: usize, shuffled: usize) -> f64 {
    if called >= shuffled {
        return 1.0;
    }
    let (called, all) = (called as f64, shuffled as f64);
    Beta::new(called + 1.0, all - called).map_or(1.0, |beta| beta.inverse_cdf(0.95))
}

/// How many of the shuffled histories may be called changed, so that the rate is below the wanted one with 95 % confidence; 0 where
/// there are too few of them for that.
fn callable(shuffled: usize, wanted: f64) -> usize {
    let is_sure = |called: &usize| greatest_rate(*called, shuffled) <= wanted;
    (0..shuffled).take_while(is_sure).last().unwrap_or(0)
}

/// Shuffles the histories and finds the bound beyond which, with 95 % confidence, at most the wanted share of them is called changed. Time is no order
/// there: what is found is chance. Flights of one day (or of one log, where logs have no date) are alike and stay together. Changes beyond
/// the bound are no chance: they are taken out, and the bound is found again. Until then an order that divides the flights as the true
/// one does, by its own change, is left out: of a few flights, one order in some tens does so.
#[must_use]
pub fn calibrated(histories: &[VehicleHistory], wanted: f64, shuffles: u32) -> FalseAlarms {
    let long: Vec<&VehicleHistory> =
        histories.iter().filter(|history| history.study.flights.len() >= LEAST_BLOCKS).collect();
    let none = FalseAlarms {
        allowed: wanted,
        shuffled: 0,
        called: 0,
        flights: 0.0,
        blocks: 0.0,
        least_sigmas: NAMED_SIGMAS,
    };
    // of fewer orders than one false alarm takes, each is as likely as is allowed, and the true one is among them
    let orders: f64 = long.iter().map(|history| orders(blocks(history).len())).sum();
    if wanted * orders < 1.0 {
        return none;
    }
    // nothing is taken out at first: the bound is the highest
    let (mut least_sigmas, mut called, mut shuffled) = (f64::INFINITY, 0, 0);
    let mut blocks = 0.0;
    for _ in 0..ROUNDS {
        let unchanged: Vec<Unchanged<'_>> =
            long.par_iter().map(|history| Unchanged::of(history, least_sigmas)).collect();
        blocks = mean(unchanged.iter().map(|of| of.blocks.len()));
        let strongest = strongest(&unchanged, shuffles);
        shuffled = strongest.len();
        let bound = strongest.get(callable(shuffled, wanted)).copied().unwrap_or(0.0);
        let found = NAMED_SIGMAS.max(bound.next_up());
        called = strongest.iter().take_while(|sigmas| **sigmas >= found).count();
        let is_settled = found >= least_sigmas;
        least_sigmas = found.min(least_sigmas);
        if is_settled {
            break;
        }
    }
    let flights = mean(long.iter().map(|history| history.study.flights.len()));
    FalseAlarms { shuffled, called, flights, blocks, least_sigmas, ..none }
}

/// Orders in which so many blocks can stand.
fn orders(blocks: usize) -> f64 {
    (1..=blocks).map(|place| place as f64).product()
}

/// How often the changes beyond a bound are taken out and the bound is found again: each time it falls, or stays.
const ROUNDS: usize = 6;

fn mean(counts: impl ExactSizeIterator<Item = usize>) -> f64 {
    let all = counts.len() as f64;
    counts.map(|count| count as f64).sum::<f64>() / all
}

/// Standard deviations of the strongest change of each shuffled history, the greatest first.
fn strongest(histories: &[Unchanged<'_>], shuffles: u32) -> Vec<f64> {
    // in turn, so that each vehicle has as many
    let draws = usize::try_from(shuffles).unwrap_or(usize::MAX).div_ceil(histories.len()) * histories.len();
    let one = |draw: usize| histories[draw % histories.len()].strongest_shuffled(draw as u64);
    let mut strongest: Vec<f64> = (0..draws).into_par_iter().filter_map(one).collect();
    strongest.sort_by(|a, b| b.total_cmp(a));
    strongest
}

/// A history without the changes that are no chance.
struct Unchanged<'a> {
    history: &'a VehicleHistory,
    balance: Balance,
    tracks: Vec<Track>,
    /// flights that stay together
    blocks: Vec<Vec<usize>>,
    /// flights on one side of its strongest change, while that is in it
    own: Option<Vec<usize>>,
}

impl<'a> Unchanged<'a> {
    /// Without the changes of at least so many standard deviations.
    fn of(history: &'a VehicleHistory, least_sigmas: f64) -> Self {
        let study = &history.study;
        let blocks = blocks(history);
        let count = study.flights.len();
        let order: Vec<usize> = (0..count).collect();
        let steps =
            if least_sigmas.is_finite() { judge(history).history(&order, least_sigmas) } else { Vec::new() };
        let (mut balance, mut tracks) = (study.balance.clone(), study.tracks.clone());
        let parts = |is_of: &dyn Fn(Changed) -> bool| {
            let own = steps.iter().filter(|step| step.change.changes.iter().any(|change| is_of(change.what)));
            let borders: Vec<usize> =
                std::iter::once(0).chain(own.map(|step| step.from)).chain([count]).collect();
            Parts::of(borders, &blocks)
        };
        let of_balance = parts(&|what| !matches!(what, Changed::Parameter(_)));
        for axis in 0..AXES {
            let lean: Vec<_> = balance.flights.iter().map(|flight| Some(flight.lean[axis])).collect();
            for (flight, level) in balance.flights.iter_mut().zip(of_balance.levelled(&lean)) {
                flight.lean[axis] = level.unwrap_or(flight.lean[axis]);
            }
        }
        for (place, track) in tracks.iter_mut().enumerate() {
            let values: Vec<_> = track.values.iter().map(|value| Some(value.as_ref()?.0)).collect();
            let levels = parts(&|what| what == Changed::Parameter(place)).levelled(&values);
            for (value, level) in track.values.iter_mut().zip(levels) {
                *value = value.zip(level).map(|((_, std), level)| (level, std));
            }
        }
        let own = judge(history).strongest(&order).map(|(_, before)| before).filter(|_| steps.is_empty());
        Self { history, balance, tracks, blocks, own }
    }

    /// Standard deviations of the strongest change of a shuffled order, 0 where there is none; `None` of an order that divides the
    /// flights as the true one does.
    fn strongest_shuffled(&self, draw: u64) -> Option<f64> {
        let mut blocks: Vec<&Vec<usize>> = self.blocks.iter().collect();
        let mut generator = Pcg64::seed_from_u64(draw);
        for place in (1..blocks.len()).rev() {
            blocks.swap(place, generator.random_range(0..=place));
        }
        let order: Vec<usize> = blocks.into_iter().flatten().copied().collect();
        let judge = Judge { balance: &self.balance, tracks: &self.tracks, ..judge(self.history) };
        let Some((sigmas, mut before)) = judge.strongest(&order) else { return Some(0.0) };
        before.sort_unstable();
        let after: Vec<usize> =
            (0..order.len()).filter(|flight| before.binary_search(flight).is_err()).collect();
        let is_own = self.own.as_ref().is_some_and(|own| *own == before || *own == after);
        (!is_own).then_some(sigmas)
    }
}

/// A row of flights in parts, between which something changed.
struct Parts {
    borders: Vec<usize>,
    /// blocks of flights in each part
    blocks: Vec<usize>,
}

impl Parts {
    fn of(borders: Vec<usize>, blocks: &[Vec<usize>]) -> Self {
        let begins = |block: &&Vec<usize>, ends: &[usize]| {
            block.first().is_some_and(|first| (ends[0]..ends[1]).contains(first))
        };
        let count = |ends: &[usize]| blocks.iter().filter(|block| begins(block, ends)).count().max(1);
        let blocks = borders.windows(2).map(count).collect();
        Self { borders, blocks }
    }

    /// A row without the differences between its parts: each part has the mean of the row, and scatters about it as much as the
    /// blocks of the part scatter about its own mean.
    fn levelled(&self, row: &[Option<f64>]) -> Vec<Option<f64>> {
        let mean = |of: &[Option<f64>]| {
            let known: Vec<f64> = of.iter().flatten().copied().collect();
            known.iter().sum::<f64>() / known.len() as f64
        };
        if self.blocks.len() < 2 {
            return row.to_vec();
        }
        let of_row = mean(row);
        let part = |(ends, blocks): (&[usize], &usize)| {
            let own = &row[ends[0]..ends[1]];
            let of_part = mean(own);
            // the mean of a part takes one of the freedoms of its blocks
            let count = *blocks as f64;
            let scatter = (count / (count - 1.0).max(1.0)).sqrt();
            own.iter().map(move |value| value.map(|value| of_row + scatter * (value - of_part)))
        };
        self.borders.windows(2).zip(&self.blocks).flat_map(part).collect()
    }
}

/// Flights that are alike and stay together: without a pause of hours between them, or of one log where not all logs have a date. Each
/// flight alone where that makes too few of them.
fn blocks(history: &VehicleHistory) -> Vec<Vec<usize>> {
    let study = &history.study;
    let is_with_last = |place: usize| match &history.start_utc_us {
        Some(starts) => starts[place] - starts[place - 1] < PAUSE_US,
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

/// Between two beginnings of flights of one day, microseconds, at most: six hours. A night is longer.
const PAUSE_US: i64 = 6 * 3_600_000_000;

/// The judge of a history.
#[must_use]
pub fn judge(history: &VehicleHistory) -> Judge<'_> {
    let study = &history.study;
    Judge {
        vehicle: &study.vehicle,
        balance: &study.balance,
        tracks: &study.tracks,
        alone: &study.alone,
        is_known: study.is_known,
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test ends where it fails")]
    use super::*;

    #[test]
    fn the_rate_is_below_the_wanted_one_with_confidence() {
        // of n histories without a call the rate is below 3 / n
        assert!((greatest_rate(0, 1000) - (1.0 - 0.05_f64.powf(0.001))).abs() < 1e-9);
        assert_eq!([100, 500, 700, 1000, 2000].map(|shuffled| callable(shuffled, 0.005)), [0, 0, 0, 1, 4]);
        assert!(greatest_rate(4, 2000) <= 0.005 && greatest_rate(5, 2000) > 0.005);
        assert_eq!((callable(0, 0.5), greatest_rate(7, 7)), (0, 1.0));
    }

    #[test]
    fn a_row_without_its_step_scatters_as_its_parts_do() {
        let row = [Some(1.0), Some(1.2), None, Some(5.0), Some(5.4), Some(5.2)];
        let alone: Vec<Vec<usize>> = (0..6).map(|place| vec![place]).collect();
        let level = Parts::of(vec![0, 2, 6], &alone).levelled(&row);
        let mean = (1.0 + 1.2 + 5.0 + 5.4 + 5.2) / 5.0;
        assert!((level[0].unwrap() - (mean - 0.1 * 2.0_f64.sqrt())).abs() < 1e-12);
        assert_eq!(level[2], None);
        assert!((level[4].unwrap() - (mean + 0.2 * (4.0_f64 / 3.0).sqrt())).abs() < 1e-12);
        // without a step it stays as it is
        assert_eq!(Parts::of(vec![0, 6], &alone).levelled(&row), row);
        // flights of two days are two
        let days = vec![vec![0, 1], vec![2, 3], vec![4, 5]];
        assert_eq!(Parts::of(vec![0, 2, 6], &days).blocks, [1, 2]);
    }
}
