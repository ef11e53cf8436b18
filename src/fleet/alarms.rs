//! How often an unchanged vehicle is called changed: by histories whose flights are in no order.

use super::history::VehicleHistory;
use crate::study::Judge;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use rayon::prelude::*;
use serde::Serialize;

/// Most unchanged vehicles that are called changed, as a share: one of 200.
pub const FALSE_ALARMS: f64 = 0.005;
/// Shuffled histories by which that is calibrated.
pub const SHUFFLES: u32 = 1000;
/// Flights from which on an order says something: three have six orders.
const LEAST_FLIGHTS: usize = 4;
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
/// there: what is found is chance. An order that divides the flights as the true one does, by its own change, is no chance and is left
/// out: of a few flights, one order in some tens does so.
#[must_use]
pub fn calibrated(histories: &[VehicleHistory], wanted: f64, shuffles: u32) -> FalseAlarms {
    let long: Vec<Long<'_>> = histories
        .iter()
        .filter(|history| history.study.flights.len() >= LEAST_FLIGHTS)
        .map(|history| Long { history, own: own_division(history) })
        .collect();
    let none = FalseAlarms { wanted, shuffled: 0, called: 0, flights: 0.0, least_sigmas: NAMED_SIGMAS };
    if long.is_empty() {
        return none;
    }
    // in turn, so that each vehicle has as many
    let draws = usize::try_from(shuffles).unwrap_or(usize::MAX).div_ceil(long.len()) * long.len();
    let one = |draw: usize| long[draw % long.len()].strongest_shuffled(draw as u64);
    let mut strongest: Vec<f64> = (0..draws).into_par_iter().filter_map(one).collect();
    strongest.sort_by(|a, b| b.total_cmp(a));
    let shuffled = strongest.len();
    // a chance that falls between two counts is the lower
    let allowed = (0..shuffled).take_while(|count| (*count + 1) as f64 <= wanted * shuffled as f64).count();
    let bound = strongest.get(allowed).copied().unwrap_or(0.0);
    let least_sigmas = NAMED_SIGMAS.max(bound.next_up());
    FalseAlarms {
        shuffled,
        called: strongest.iter().take_while(|sigmas| **sigmas >= least_sigmas).count(),
        flights: long.iter().map(|long| long.history.study.flights.len() as f64).sum::<f64>()
            / long.len() as f64,
        least_sigmas,
        ..none
    }
}

/// A history with flights enough.
struct Long<'a> {
    history: &'a VehicleHistory,
    /// flights on one side of its own strongest change
    own: Option<Vec<usize>>,
}

/// The flights before the strongest change of a history, in the order of their places.
fn own_division(history: &VehicleHistory) -> Option<Vec<usize>> {
    let order: Vec<usize> = (0..history.study.flights.len()).collect();
    judge(history).strongest(&order).map(|(_, before)| before)
}

impl Long<'_> {
    /// Standard deviations of the strongest change of a shuffled order, 0 where there is none; `None` of an order that divides the
    /// flights as the true one does.
    fn strongest_shuffled(&self, draw: u64) -> Option<f64> {
        let count = self.history.study.flights.len();
        let mut order: Vec<usize> = (0..count).collect();
        let mut generator = Pcg64::seed_from_u64(draw);
        for place in (1..count).rev() {
            order.swap(place, generator.random_range(0..=place));
        }
        let Some((sigmas, mut before)) = judge(self.history).strongest(&order) else { return Some(0.0) };
        before.sort_unstable();
        let after: Vec<usize> = (0..count).filter(|flight| before.binary_search(flight).is_err()).collect();
        let is_own = self.own.as_ref().is_some_and(|own| *own == before || *own == after);
        (!is_own).then_some(sigmas)
    }
}

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
