//! What each effect of the model is worth: errors of open-loop prediction without it, the rest as it is.

use super::carried::{carried_over, pair_on};
use super::error::HoldoutError;
use super::open_loop::{WINDOWS_S, playback_of, predicting};
use super::ready::{Ready, trace_of};
use super::settings::{Explained, HeldOut, HoldoutSettings};
use crate::compare::{WindowErrors, playback_lengths};
use crate::diagnose::base::Base;
use crate::diagnose::signature::LatencyKind;
use crate::diagnose::signatures::latency_kind;
use crate::vehicle::Vehicle;
use rayon::prelude::*;

/// Root mean square errors of position (m), velocity (m/s), attitude (rad) and rates (rad/s) over windows of one length; `None` where the
/// recording does not hold the quantity.
pub type WindowError = [Option<f64>; 4];

/// Errors without an effect.
#[derive(Debug, Clone, PartialEq)]
pub struct Without {
    /// the effect that is left out; `None`: the whole model
    pub id: Option<&'static str>,
    /// one for each of [`WINDOWS_S`]
    pub errors: Vec<WindowError>,
    /// of the windows of half a second, block after block of the flights: sums of the squared errors of each quantity, and their numbers
    pub blocks: Vec<SquaredErrors>,
}

/// Sums of squared errors of position (m^2), velocity (m^2/s^2), attitude (rad^2) and rates (rad^2/s^2), and how many each is of.
pub type SquaredErrors = [(f64, usize); 4];

/// Place of the window of half a second in [`WINDOWS_S`].
pub const HALF_SECOND: usize = 1;

/// Errors of the whole model and without each of these effects, which may be made of several terms. `used`: the flights were those
/// that were explained.
///
/// # Errors
/// [`HoldoutError`] where a flight cannot be played back.
pub fn without_each(
    explained: Explained,
    effects: &[(&'static str, Vec<&'static str>)],
    (flights, used): (&[HeldOut], bool),
    (vehicle, settings): (&Vehicle, &HoldoutSettings),
) -> Result<Vec<Without>, HoldoutError> {
    let mut ready = Vec::with_capacity(flights.len());
    for flight in flights {
        let trace = trace_of(flight, vehicle, settings)?;
        let pair = if used {
            pair_on(explained, vehicle, &trace)
        } else {
            carried_over(explained, (flight, &trace), vehicle, settings)?
        };
        ready.push(Ready { flight, trace, pair });
    }
    let none: &[&'static str] = &[];
    let whole = std::iter::once((None, none));
    let each = whole.chain(effects.iter().map(|(id, terms)| (Some(*id), terms.as_slice())));
    let each: Vec<_> = each.collect();
    each.into_par_iter()
        .map(|(id, terms)| {
            let (errors, blocks) = errors_without(&ready, terms, settings.block_s)?;
            Ok(Without { id, errors, blocks })
        })
        .collect()
}

fn errors_without(
    ready: &[Ready],
    terms: &[&str],
    block_s: f64,
) -> Result<(Vec<WindowError>, Vec<SquaredErrors>), HoldoutError> {
    const NONE: SquaredErrors = [(0.0, 0); 4];
    // squares and their number
    let mut sums = vec![NONE; WINDOWS_S.len()];
    let mut blocks: Vec<SquaredErrors> = Vec::new();
    let settings = playback_of(ready);
    for of in ready {
        let base = left_out(of.pair.predicting().1, terms);
        let model = predicting(&base, of.pair.rate_law)?;
        let played =
            playback_lengths((&model, &base.vehicle), None, of.flight.signals, (&settings, &WINDOWS_S), None)
                .map_err(|source| HoldoutError::Compare { flight: of.flight.name.to_owned(), source })?;
        for (place, (sums, length)) in sums.iter_mut().zip(played).enumerate() {
            let from_s = of.pair.predicted_from_s();
            // of the last block: a flight begins with a new one
            let mut ends_s = f64::NEG_INFINITY;
            for window in length.windows.iter().filter(|window| window.start_s >= from_s) {
                add(sums, window);
                if place == HALF_SECOND {
                    if window.start_s >= ends_s {
                        blocks.push(NONE);
                        ends_s = window.start_s + block_s;
                    }
                    if let Some(last) = blocks.last_mut() {
                        add(last, window);
                    }
                }
            }
        }
    }
    let root = |(sum, count): (f64, usize)| (count > 0).then(|| (sum / count as f64).sqrt());
    Ok((sums.into_iter().map(|sums| sums.map(root)).collect(), blocks))
}

fn add(sums: &mut SquaredErrors, window: &WindowErrors) {
    for (sum, (square, count)) in sums.iter_mut().zip(window.squares.iter().zip(&window.counts)) {
        *sum = (sum.0 + square, sum.1 + count);
    }
}

/// A base without these terms; without a lag or a delay it has none.
fn left_out(base: &Base, terms: &[&str]) -> Base {
    let mut left = base.clone();
    left.effects.retain(|term| !terms.contains(&term.id()));
    for term in terms {
        match latency_kind(term) {
            Some(LatencyKind::Lag) => (left.latency.lag_s, left.latency.uneven) = (0.0, 0.0),
            Some(LatencyKind::Delay) => left.latency.delay_s = 0.0,
            None => {}
        }
    }
    left
}
