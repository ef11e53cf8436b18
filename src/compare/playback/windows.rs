//! Playback window by window.

use super::commands::Commands;
use super::measured::MeasuredStates;
use super::settings::PlaybackSettings;
use crate::compare::CompareError;
use crate::compare::mean_square::MeanSquare;
use crate::physics::{Input, Model, State};
use crate::signals::{Grid, Signals, ThrustSource};
use crate::simulate::{Plant, PlantMemory, Push};
use crate::vehicle::Vehicle;
use nalgebra::Vector3;
use std::cell::Cell;

/// The windows of [`playback_windows`](super::playback_windows), predicted by the state at the start of each: nothing changes. The baseline that published benchmarks call
/// naive.
///
/// # Errors
/// As [`playback`](super::playback).
pub fn unchanged_windows(
    signals: &Signals,
    settings: &PlaybackSettings,
) -> Result<Vec<WindowErrors>, CompareError> {
    let windows = Windows::of(signals, settings)?;
    // over the ground, which seems to move to who moves with the air
    let per_step_m = signals.air_m_s * signals.grid.step_s;
    let at = |start: usize, count: usize| {
        let state = windows.states.at(start);
        State { position_m: state.position_m - per_step_m * count as f64, ..state }
    };
    let unchanged = |&start: &usize| {
        let states: Vec<State> = (1..=windows.window).map(|count| at(start, count)).collect();
        windows.errors(start, &states)
    };
    Ok(windows.starts.iter().map(unchanged).collect())
}

/// Squared errors of one window, in the order of [`Fit::quantities`](super::Fit::quantities).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WindowErrors {
    /// s, vehicle clock, where the window starts
    pub start_s: f64,
    /// sums of squares: m^2, (m/s)^2, rad^2, (rad/s)^2
    pub squares: [f64; 4],
    /// instants in each sum; 0 where the recording does not hold the quantity, or no torque is predicted that would turn the body
    pub counts: [usize; 4],
    /// sizes of the errors at the end of the window: m, m/s, rad, rad/s; 0 where the recording does not hold the quantity
    pub at_end: [f64; 4],
}

/// Where rotor speeds were measured, what lies between command and speed is left out.
pub(super) fn played(model: &Model, signals: &Signals) -> Model {
    let measured_speeds = signals.quality.thrust_source == ThrustSource::MeasuredSpeed;
    if measured_speeds { model.with_measured_speeds() } else { model.clone() }
}

/// Where a recording is predicted, and what was measured there.
pub(super) struct Windows<'a> {
    states: MeasuredStates<'a>,
    /// instants
    pub window: usize,
    pub starts: Vec<usize>,
}

/// Grid steps in a time, at least none.
fn steps(time_s: f64, grid: &Grid) -> usize {
    (1..grid.count).take_while(|n| *n as f64 * grid.step_s <= time_s + 1e-9).count()
}

impl<'a> Windows<'a> {
    pub fn of(signals: &'a Signals, settings: &PlaybackSettings) -> Result<Self, CompareError> {
        let states = MeasuredStates::of(signals)?;
        let count = |time_s: f64| steps(time_s, &signals.grid);
        let (window, warm_up) = (count(settings.window_s).max(1), count(settings.warm_up_s));
        let mut starts = Vec::new();
        for run in Grid::runs(&signals.usable, window + warm_up + 1) {
            starts.extend((run.start + warm_up..run.end - window).step_by(count(settings.stride_s).max(1)));
        }
        if starts.is_empty() {
            let PlaybackSettings { window_s, warm_up_s, .. } = *settings;
            return Err(CompareError::NoWindow { window_s, warm_up_s });
        }
        Ok(Self { states, window, starts })
    }

    /// Errors of the states predicted for the instants after `start`.
    pub fn errors(&self, start: usize, predicted: &[State]) -> WindowErrors {
        let measured = (start + 1..).map(|index| self.states.at(index));
        self.errors_against(start, predicted.iter().copied().zip(measured))
    }

    /// Errors of predicted states, each with what it is compared with, in a window from `start` on.
    pub fn errors_against(
        &self,
        start: usize,
        pairs: impl IntoIterator<Item = (State, State)>,
    ) -> WindowErrors {
        let mut errors = [MeanSquare::default(); 4];
        let mut at_end = [MeanSquare::default(); 4];
        for (predicted, measured) in pairs {
            at_end = [MeanSquare::default(); 4];
            self.states.compare(&predicted, &measured, &mut at_end);
            for (sum, one) in errors.iter_mut().zip(&at_end) {
                sum.sum += one.sum;
                sum.count += one.count;
            }
        }
        WindowErrors {
            start_s: self.states.signals.grid.time_s(start),
            squares: errors.map(|error| error.sum),
            counts: errors.map(|error| error.count),
            at_end: at_end.map(|error| error.sum.sqrt()),
        }
    }
}

/// A recording ready to be played back.
pub(super) struct Played<'a> {
    model: &'a Model,
    push: Option<Push<'a>>,
    states: MeasuredStates<'a>,
    pub commands: Commands<'a>,
    pub step_s: f64,
    substeps: u32,
    /// instants
    warm_up: usize,
    /// instant of the last window, and the vehicle there with its effects' own states; of states that are not rotors'
    carried: Cell<Option<(usize, PlantMemory)>>,
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
        let longest_s = settings.longest_step_s(model);
        let substeps = (1..100).find(|n| step_s / f64::from(*n) <= longest_s + 1e-12).unwrap_or(100);
        let warm_up = steps(settings.warm_up_s, &signals.grid);
        let carried = Cell::new(None);
        Ok(Self { model, push, states, commands, step_s, substeps, warm_up, carried })
    }

    /// The vehicle as it was measured at an instant, with rotors that have long followed their commands.
    pub fn plant(&self, index: usize) -> Result<Plant<'_>, CompareError> {
        let (state, commands) = (self.states.at(index), self.commands.at(index, 0.0));
        Ok(Plant::new(self.model, self.push, &state, &commands)?)
    }

    /// What was measured at an instant.
    pub fn measured(&self, index: usize) -> State {
        self.states.at(index)
    }

    /// The vehicle as it was measured at an instant, with own states of the effects that followed the recording until then: those of rotors, which
    /// forget in a moment, over the warm-up; others, as the swing of a load, since the beginning of what can be used.
    pub fn warm(&self, start: usize) -> Result<Plant<'_>, CompareError> {
        let of_rotors = self.model.own_states_are_of_rotors();
        let (from, mut plant) = if of_rotors {
            (start - self.warm_up, self.plant(start - self.warm_up)?)
        } else {
            self.carried_from(start)?
        };
        for index in from..start {
            plant.set_state(&self.states.at(index));
            if of_rotors {
                self.substeps(index, |inputs, step_s| plant.step_own(inputs, step_s));
            } else {
                self.step(&mut plant, index);
            }
        }
        plant.set_state(&self.states.at(start));
        if !of_rotors {
            self.carried.set(Some((start, plant.memory())));
        }
        Ok(plant)
    }

    /// Where the own states have followed the recording to, at most to an instant, and the vehicle there.
    fn carried_from(&self, start: usize) -> Result<(usize, Plant<'_>), CompareError> {
        let usable = &self.states.signals.usable[..start];
        let is_one_run = |from: usize| from <= start && usable[from..].iter().all(|used| *used);
        if let Some((at, memory)) = self.carried.get().filter(|(at, _)| is_one_run(*at)) {
            return Ok((at, Plant::resume(self.model, self.push, memory)));
        }
        let from = start - usable.iter().rev().take_while(|used| **used).count();
        Ok((from, self.plant(from)?))
    }

    /// Torque (body, N m) in the middle of the step from an instant to the next one, as measured; moves the effects' own states on.
    pub fn torque_nm(&self, plant: &mut Plant, index: usize) -> Vector3<f64> {
        plant.set_state(&self.states.at(index));
        let torque_nm = plant.evaluate(&self.commands.at(index, 0.5)).wrench.torque_nm;
        self.step(plant, index);
        torque_nm
    }

    /// One instant on, under the recorded commands.
    fn step(&self, plant: &mut Plant, index: usize) {
        self.substeps(index, |inputs, step_s| plant.step_along(inputs, step_s));
    }

    /// Commands at the beginning, in the middle and at the end of each integration step from an instant to the next one, and
    /// its length, s.
    fn substeps(&self, index: usize, mut step: impl FnMut([&Input; 3], f64)) {
        let count = f64::from(self.substeps);
        let mut begin = self.commands.at(index, 0.0);
        for substep in 0..self.substeps {
            let at = |part: f64| self.commands.at(index, (f64::from(substep) + part) / count);
            let (middle, end) = (at(0.5), at(1.0));
            step([&begin, &middle, &end], self.step_s / count);
            begin = end;
        }
    }

    /// States at the `window` instants after `start`, of a vehicle there.
    pub fn window(&self, mut plant: Plant, (start, window): (usize, usize)) -> Vec<State> {
        let mut out = Vec::with_capacity(window);
        for index in start..start + window {
            self.step(&mut plant, index);
            if !self.states.is_turned_by_torques() {
                plant.set_state(&self.states.turned(plant.state(), index + 1));
            }
            out.push(plant.state());
        }
        out
    }
}
