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
/// there: what is found is chance.
#[must_use]
pub fn calibrated(histories: &[VehicleHistory], wanted: f64, shuffles: u32) -> FalseAlarms {
    let long: Vec<&VehicleHistory> =
        histories.iter().filter(|history| history.study.flights.len() >= LEAST_FLIGHTS).collect();
    let none = FalseAlarms { wanted, shuffled: 0, called: 0, flights: 0.0, least_sigmas: NAMED_SIGMAS };
    if long.is_empty() {
        return none;
    }
    // in turn, so that each vehicle has as many
    let draws = usize::try_from(shuffles).unwrap_or(usize::MAX).div_ceil(long.len()) * long.len();
    let one = |draw: usize| strongest_shuffled(long[draw % long.len()], draw as u64);
    let mut strongest: Vec<f64> = (0..draws).into_par_iter().map(one).collect();
    strongest.sort_by(|a, b| b.total_cmp(a));
    // a chance that falls between two counts is the lower
    let allowed = (0..draws).take_while(|count| (*count + 1) as f64 <= wanted * draws as f64).count();
    let bound = strongest.get(allowed).copied().unwrap_or(0.0);
    let least_sigmas = NAMED_SIGMAS.max(bound.next_up());
    FalseAlarms {
        shuffled: draws,
        called: strongest.iter().take_while(|sigmas| **sigmas >= least_sigmas).count(),
        flights: long.iter().map(|history| history.study.flights.len() as f64).sum::<f64>()
            / long.len() as f64,
        least_sigmas,
        ..none
    }
}

fn strongest_shuffled(history: &VehicleHistory, draw: u64) -> f64 {
    let mut order: Vec<usize> = (0..history.study.flights.len()).collect();
    let mut generator = Pcg64::seed_from_u64(draw);
    for place in (1..order.len()).rev() {
        order.swap(place, generator.random_range(0..=place));
    }
    judge(history).strongest(&order)
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
