//! Open-loop prediction from the measured state with the recorded actuators.

use super::bootstrap::{AtEnd, Blocks, Compared, Interval, Squares};
use super::error::HoldoutError;
use super::floor::{command_noise, state_noise};
use super::rate_law::{Path, RateLaw};
use super::ready::{Ready, model_of};
use super::settings::HoldoutSettings;
use crate::compare::{
    CommandNoise, CompareError, FloorNoise, PlaybackSettings, StateNoise, WindowErrors, playback_lengths,
    torques_along, unchanged_windows,
};
use crate::diagnose::base::Base;
use crate::diagnose::empirical::Empirical;
use crate::physics::{Model, PhysicsError};
use rayon::prelude::*;

/// Time from one window's start to the next one's, s. Motions that repeat must not always be met at the same place.
const STRIDE_S: f64 = 0.17;
/// Time that one stride serves, s: of flights that are longer together, windows begin at each second, third, ... one. So many windows, some
/// 900, tell errors to a few percent, and the time that they take does not grow with the flights.
const SERVED_S: f64 = 150.0;
/// Lengths of the windows, s.
pub const WINDOWS_S: [f64; 3] = [0.1, HALF_S, 1.0];
/// Length of the windows that are told first, s.
pub const HALF_S: f64 = 0.5;

/// Errors over windows of one length; `None` for a quantity that the recording does not contain.
#[derive(Debug, Clone, PartialEq)]
pub struct OpenLoop {
    /// s
    pub window_s: f64,
    /// windows of all flights
    pub windows: usize,
    /// m
    pub position_m: Option<Compared>,
    /// m/s
    pub velocity_m_s: Option<Compared>,
    /// rad
    pub attitude_rad: Option<Compared>,
    /// rad/s
    pub rates_rad_s: Option<Compared>,
}

impl OpenLoop {
    /// That over windows of 0.5 s.
    #[must_use]
    pub fn half_second(each: &[Self]) -> Option<&Self> {
        each.iter().find(|of| of.is_half_second())
    }

    fn is_half_second(&self) -> bool {
        (self.window_s - HALF_S).abs() < 1e-9
    }

    /// Whether a state that does not change predicts each quantity better, in the order of [`Self::quantities`].
    #[must_use]
    pub fn worse_than_unchanged(&self) -> [bool; 4] {
        self.quantities().map(|of| of.is_some_and(|of| of.is_worse_than_unchanged()))
    }

    /// Position, velocity, attitude, rates.
    #[must_use]
    pub fn quantities(&self) -> [Option<Compared>; 4] {
        [self.position_m, self.velocity_m_s, self.attitude_rad, self.rates_rad_s]
    }
}

/// One flight's models.
struct Models {
    before: Model,
    after: Model,
    noise: StateNoise,
    commands: Option<CommandNoise>,
}

/// All window lengths, the mean improvement at 0.5 s, and the number of its blocks.
pub(super) fn open_loop(
    ready: &[Ready],
    empirical: Option<&Empirical>,
    settings: &HoldoutSettings,
) -> Result<(Vec<OpenLoop>, Option<Interval>, usize), HoldoutError> {
    let models: Vec<Models> = ready.iter().map(models_of).collect::<Result<_, _>>()?;
    let playback = playback_of(ready);
    let flights: Vec<Vec<Played>> = (0..ready.len())
        .into_par_iter()
        .map(|index| played((index, &ready[index]), &models[index], (empirical, &playback), settings))
        .collect::<Result<_, _>>()?;
    let parts: Vec<(OpenLoop, Option<Interval>, usize)> =
        (0..WINDOWS_S.len()).map(|length| one_length(length, (ready, &flights), settings)).collect();
    let half = parts.iter().find(|(of, ..)| of.is_half_second());
    let (improvement, blocks) = half.map_or((None, 0), |(_, improvement, blocks)| (*improvement, *blocks));
    Ok((parts.into_iter().map(|(of, ..)| of).collect(), improvement, blocks))
}

fn models_of(ready: &Ready) -> Result<Models, PhysicsError> {
    let (before, after) = ready.pair.predicting();
    let after = predicting(after, ready.pair.rate_law)?;
    Ok(Models {
        before: predicting(before, ready.pair.rate_law)?,
        after,
        noise: state_noise(ready.flight.signals),
        commands: command_noise(ready.flight.signals, &ready.pair.after.vehicle.propulsion),
    })
}

/// A base's model with its latency as effects, and with a law of its rates.
pub(super) fn predicting(base: &Base, rate_law: Option<RateLaw>) -> Result<Model, PhysicsError> {
    let model = model_of(base)?;
    rate_law.map_or(Ok(model.clone()), |law| law.acting_in(&model))
}

fn path_of<'a>(ready: &'a Ready, playback: &PlaybackSettings) -> Result<Path<'a>, HoldoutError> {
    let (_, base) = ready.pair.predicting();
    let (model, signals) = (model_of(base)?, ready.flight.signals);
    let torques_nm = torques_along((&model, &base.vehicle), signals, playback)
        .map_err(|source| HoldoutError::Compare { flight: ready.flight.name.to_owned(), source })?;
    Ok(Path { signals, torques_nm, body: model.body })
}

/// A law of the rates, fitted to flights.
pub(super) fn rate_law(ready: &[Ready]) -> Result<Option<RateLaw>, HoldoutError> {
    let playback = playback_of(ready);
    let paths: Vec<Path> =
        ready.par_iter().map(|ready| path_of(ready, &playback)).collect::<Result<_, HoldoutError>>()?;
    Ok(RateLaw::fit(&paths, (HALF_S, playback.stride_s)))
}

/// Playback over windows of half a second, as often as these flights together need.
pub(super) fn playback_of(ready: &[Ready]) -> PlaybackSettings {
    let total_s: f64 = ready.iter().map(Ready::usable_s).sum();
    let stride_s = STRIDE_S * (total_s / SERVED_S).ceil().max(1.0);
    PlaybackSettings { window_s: HALF_S, stride_s, step_s: 0.01, ..PlaybackSettings::default() }
}

/// One flight's windows, as predicted by each.
struct Played {
    unchanged: Vec<WindowErrors>,
    before: Vec<WindowErrors>,
    after: Vec<WindowErrors>,
    noise: Vec<WindowErrors>,
}

fn played(
    (index, ready): (usize, &Ready),
    models: &Models,
    of: (Option<&Empirical>, &PlaybackSettings),
    settings: &HoldoutSettings,
) -> Result<Vec<Played>, HoldoutError> {
    by_length(ready, models, of, settings.seed ^ index as u64)
        .map_err(|source| HoldoutError::Compare { flight: ready.flight.name.to_owned(), source })
}

/// The windows of each length.
fn by_length(
    ready: &Ready,
    models: &Models,
    (empirical, playback): (Option<&Empirical>, &PlaybackSettings),
    seed: u64,
) -> Result<Vec<Played>, CompareError> {
    let signals = ready.flight.signals;
    let run = |model: &Model, base: &Base, empirical: Option<&Empirical>, floor: Option<FloorNoise>| {
        let push = empirical.map(Empirical::push);
        let push = push.as_ref().map(|push| push as crate::simulate::Push);
        playback_lengths((model, &base.vehicle), push, signals, (playback, &WINDOWS_S), floor)
    };
    let (base_before, base_after) = ready.pair.predicting();
    let noise = FloorNoise { state: &models.noise, commands: models.commands.as_ref(), seed };
    let own = std::ptr::eq(base_after, &ready.pair.after);
    let (before, (after, other)) = rayon::join(
        || run(&models.before, base_before, None, None),
        || {
            // where the loading is the flight's own, the floor has the scale of the model without it
            let other = (!own).then(|| run(&models.after, &ready.pair.after, None, Some(noise)));
            (run(&models.after, base_after, empirical, own.then_some(noise)), other)
        },
    );
    let (before, mut after) = (before?, after?);
    if let Some(other) = other {
        after.iter_mut().zip(other?).for_each(|(after, other)| after.floor = other.floor);
    }
    let each = WINDOWS_S.iter().zip(before).zip(after);
    each.map(|((&window_s, before), after)| {
        let unchanged = unchanged_windows(signals, &PlaybackSettings { window_s, ..*playback })?;
        Ok(Played { unchanged, before: before.windows, after: after.windows, noise: after.floor })
    })
    .collect()
}

/// Errors of all flights' windows of one length.
struct Sums {
    blocks: Blocks,
    /// squares and their number
    floor: [(f64, usize); 4],
    at_end: [[f64; 3]; 4],
    windows: usize,
}

impl Sums {
    /// Adds the windows of a flight that begin at `from_s` or later.
    fn add(&mut self, (flight, from_s): (usize, f64), played: &Played) {
        let each = played.unchanged.iter().zip(&played.before).zip(&played.after);
        for ((unchanged, before), after) in each.filter(|((of, _), _)| of.start_s >= from_s) {
            self.windows += 1;
            let squares = Squares {
                unchanged: Some(&unchanged.squares),
                before: &before.squares,
                after: &after.squares,
                count: &before.counts.map(|count| count as f64),
            };
            self.blocks.add((flight, before.start_s), squares);
            for (quantity, sums) in self.at_end.iter_mut().enumerate() {
                for (sum, of) in sums.iter_mut().zip([unchanged, before, after]) {
                    *sum += of.at_end[quantity];
                }
            }
        }
        for WindowErrors { squares, counts, .. } in played.noise.iter().filter(|of| of.start_s >= from_s) {
            for (floor, (square, count)) in self.floor.iter_mut().zip(squares.iter().zip(counts)) {
                *floor = (floor.0 + square, floor.1 + count);
            }
        }
    }

    /// Each quantity, and the mean improvement.
    fn compared(&self, settings: &HoldoutSettings) -> (Vec<Option<Compared>>, Option<Interval>) {
        let (mut each, improvement) = self.blocks.compared(settings.draws, settings.seed);
        for ((compared, (sum, count)), at_end) in each.iter_mut().zip(self.floor).zip(self.at_end) {
            if let Some(compared) = compared.as_mut().filter(|_| count > 0) {
                compared.floor = Some((sum / count as f64).sqrt());
                let [unchanged, before, after] = at_end.map(|sum| sum / self.windows as f64);
                compared.at_end = Some(AtEnd { unchanged, before, after });
            }
        }
        (each, improvement)
    }
}

fn one_length(
    length: usize,
    (ready, flights): (&[Ready], &[Vec<Played>]),
    settings: &HoldoutSettings,
) -> (OpenLoop, Option<Interval>, usize) {
    let blocks = Blocks::new(4, settings.block_s);
    let mut sums = Sums { blocks, floor: [(0.0, 0); 4], at_end: [[0.0; 3]; 4], windows: 0 };
    for (index, (ready, played)) in ready.iter().zip(flights).enumerate() {
        sums.add((index, ready.pair.predicted_from_s()), &played[length]);
    }
    let (each, improvement) = sums.compared(settings);
    let of = OpenLoop {
        window_s: WINDOWS_S[length],
        windows: sums.windows,
        position_m: each[0],
        velocity_m_s: each[1],
        attitude_rad: each[2],
        rates_rad_s: each[3],
    };
    (of, improvement, sums.blocks.len())
}
