//! Playback window by window.

use super::commands::Commands;
use super::measured::MeasuredStates;
use super::settings::PlaybackSettings;
use crate::compare::CompareError;
use crate::compare::mean_square::MeanSquare;
use crate::physics::{Model, State};
use crate::signals::{Grid, Signals, ThrustSource};
use crate::simulate::{Plant, Push};
use crate::vehicle::Vehicle;
use std::cmp::Ordering;

/// [`playback`](super::playback) window by window, for whoever needs to know how the error is spread. `push` acts beside
/// the model.
///
/// # Errors
/// As [`playback`](super::playback).
pub fn playback_windows(
    (model, vehicle): (&Model, &Vehicle),
    push: Option<Push>,
    signals: &Signals,
    settings: &PlaybackSettings,
) -> Result<Vec<WindowErrors>, CompareError> {
    let model = played(model, signals);
    let played = Played::of((&model, vehicle), push, signals, settings)?;
    let mut out = Vec::with_capacity(played.starts.len());
    for &start in &played.starts {
        let mut errors = [MeanSquare::default(); 4];
        let simulated = played.window(start, &played.states.at(start))?;
        for (index, state) in (start + 1..).zip(&simulated) {
            played.states.compare(state, &played.states.at(index), &mut errors);
        }
        out.push(played.errors(start, &errors));
    }
    Ok(out)
}

/// Squared errors of one window, in the order of [`Fit::quantities`](super::Fit::quantities).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WindowErrors {
    /// s, vehicle clock, where the window starts
    pub start_s: f64,
    /// sums of squares: m^2, (m/s)^2, rad^2, (rad/s)^2
    pub squares: [f64; 4],
    /// instants in each sum; 0 where the recording does not hold the quantity
    pub counts: [usize; 4],
}

/// Where rotor speeds were measured, what lies between command and speed is left out.
pub(super) fn played(model: &Model, signals: &Signals) -> Model {
    let measured_speeds = signals.quality.thrust_source == ThrustSource::MeasuredSpeed;
    if measured_speeds { model.with_measured_speeds() } else { model.clone() }
}

/// A recording ready to be played back.
pub(super) struct Played<'a> {
    model: &'a Model,
    push: Option<Push<'a>>,
    pub states: MeasuredStates<'a>,
    pub commands: Commands<'a>,
    step_s: f64,
    substeps: u32,
    /// instants
    window: usize,
    warm_up: usize,
    pub starts: Vec<usize>,
}

impl<'a> Played<'a> {
    pub fn of(
        (model, vehicle): (&'a Model, &Vehicle),
        push: Option<Push<'a>>,
        signals: &'a Signals,
        settings: &PlaybackSettings,
    ) -> Result<Self, CompareError> {
        let states = MeasuredStates::of(signals)?;
        let commands = Commands::of(model, vehicle, signals)?;
        let step_s = signals.grid.step_s;
        let count =
            |time_s: f64| (1..signals.grid.count).take_while(|n| *n as f64 * step_s <= time_s + 1e-9).count();
        let (window, warm_up) = (count(settings.window_s).max(1), count(settings.warm_up_s));
        let substeps = (1..100).find(|n| step_s / f64::from(*n) <= settings.step_s + 1e-12).unwrap_or(100);
        let mut starts = Vec::new();
        for run in Grid::runs(&signals.usable, window + warm_up + 1) {
            starts.extend((run.start + warm_up..run.end - window).step_by(count(settings.stride_s).max(1)));
        }
        if starts.is_empty() {
            let PlaybackSettings { window_s, warm_up_s, .. } = *settings;
            return Err(CompareError::NoWindow { window_s, warm_up_s });
        }
        Ok(Self { model, push, states, commands, step_s, substeps, window, warm_up, starts })
    }

    /// States at the instants after `start`, from `initial` there.
    pub fn window(&self, start: usize, initial: &State) -> Result<Vec<State>, CompareError> {
        let first = start - self.warm_up;
        let mut plant =
            Plant::new(self.model, self.push, &self.states.at(first), &self.commands.at(first, 0.0))?;
        let mut out = Vec::with_capacity(self.window);
        for index in first..start + self.window {
            match index.cmp(&start) {
                Ordering::Less => plant.set_state(&self.states.at(index)),
                Ordering::Equal => plant.set_state(initial),
                Ordering::Greater => {}
            }
            for substep in 0..self.substeps {
                let share = (f64::from(substep) + 0.5) / f64::from(self.substeps);
                plant.step(&self.commands.at(index, share), self.step_s / f64::from(self.substeps));
            }
            if index >= start {
                out.push(plant.state());
            }
        }
        Ok(out)
    }

    pub fn errors(&self, start: usize, errors: &[MeanSquare; 4]) -> WindowErrors {
        WindowErrors {
            start_s: self.states.signals.grid.time_s(start),
            squares: errors.map(|error| error.sum),
            counts: errors.map(|error| error.count),
        }
    }
}
