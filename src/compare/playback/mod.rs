//! Open loop: recorded actuators played back from measured states over short windows.

mod floor;

pub use floor::{CommandNoise, StateNoise, playback_floor};

use super::{CompareError, MeanSquare};
use crate::physics::{Input, MAX_ROTORS, Model, State};
use crate::signals::{Grid, Signals, ThrustSource};
use crate::simulate::{Allocation, Plant, Push};
use crate::vehicle::Vehicle;
use nalgebra::Vector3;
use std::cmp::Ordering;

/// How playback is done.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlaybackSettings {
    /// length of a window, s
    pub window_s: f64,
    /// time from one window's start to the next one's, s
    pub stride_s: f64,
    /// time before each window in which the effects' own states follow the recording, s
    pub warm_up_s: f64,
    /// longest integration step, s
    pub step_s: f64,
}

impl Default for PlaybackSettings {
    fn default() -> Self {
        Self { window_s: 0.5, stride_s: 0.5, warm_up_s: 0.3, step_s: 0.002 }
    }
}

/// Root mean square over all instants of all windows of the size of the vector error. `None` where the
/// recording does not hold the quantity.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Fit {
    /// m
    pub position_m: Option<f64>,
    /// m/s
    pub velocity_m_s: Option<f64>,
    /// angle between the attitudes, rad
    pub attitude_rad: Option<f64>,
    /// rad/s
    pub rates_rad_s: Option<f64>,
    /// windows
    pub windows: usize,
}

impl Fit {
    /// Position, velocity, attitude, rates.
    #[must_use]
    pub fn quantities(&self) -> [Option<f64>; 4] {
        [self.position_m, self.velocity_m_s, self.attitude_rad, self.rates_rad_s]
    }
}

/// Plays the recorded actuators back through a model.
///
/// `signals` must be conditioned with `vehicle`, which `model` is made of, because its thrust law turns
/// commands into thrusts. Where the rotor speeds were measured, effects between command and speed (lag, delay,
/// sag with the battery) are left out, and the rotors spin up as measured; where the log holds force and
/// torque, they are shared out to the rotors. The battery's voltage is the recorded one.
///
/// # Errors
/// If attitude or rates are missing, no window fits, or the model cannot be simulated.
pub fn playback(
    (model, vehicle): (&Model, &Vehicle),
    signals: &Signals,
    settings: &PlaybackSettings,
) -> Result<Fit, CompareError> {
    let windows = playback_windows((model, vehicle), None, signals, settings)?;
    let mut errors = [MeanSquare::default(); 4];
    for window in &windows {
        for (error, (sum, count)) in errors.iter_mut().zip(window.squares.iter().zip(&window.counts)) {
            error.sum += sum;
            error.count += count;
        }
    }
    let [position_m, velocity_m_s, attitude_rad, rates_rad_s] = errors.map(|error| error.root());
    Ok(Fit { position_m, velocity_m_s, attitude_rad, rates_rad_s, windows: windows.len() })
}

/// Squared errors of one window, in the order of [`Fit::quantities`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WindowErrors {
    /// s, vehicle clock, where the window starts
    pub start_s: f64,
    /// sums of squares: m^2, (m/s)^2, rad^2, (rad/s)^2
    pub squares: [f64; 4],
    /// instants in each sum; 0 where the recording does not hold the quantity
    pub counts: [usize; 4],
}

/// [`playback`] window by window, for whoever needs to know how the error is spread. `push` acts beside
/// the model.
///
/// # Errors
/// As [`playback`].
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

/// Where rotor speeds were measured, what lies between command and speed is left out.
fn played(model: &Model, signals: &Signals) -> Model {
    let measured_speeds = signals.quality.thrust_source == ThrustSource::MeasuredSpeed;
    if measured_speeds { model.with_measured_speeds() } else { model.clone() }
}

/// A recording ready to be played back.
struct Played<'a> {
    model: &'a Model,
    push: Option<Push<'a>>,
    states: MeasuredStates<'a>,
    commands: Commands<'a>,
    step_s: f64,
    substeps: u32,
    /// instants
    window: usize,
    warm_up: usize,
    starts: Vec<usize>,
}

impl<'a> Played<'a> {
    fn of(
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
    fn window(&self, start: usize, initial: &State) -> Result<Vec<State>, CompareError> {
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

    fn errors(&self, start: usize, errors: &[MeanSquare; 4]) -> WindowErrors {
        WindowErrors {
            start_s: self.states.signals.grid.time_s(start),
            squares: errors.map(|error| error.sum),
            counts: errors.map(|error| error.count),
        }
    }
}

/// What was measured of the body.
struct MeasuredStates<'a> {
    signals: &'a Signals,
}

impl<'a> MeasuredStates<'a> {
    fn of(signals: &'a Signals) -> Result<Self, CompareError> {
        let purpose = "open-loop playback";
        if signals.attitude.is_none() {
            return Err(CompareError::Missing { what: "attitude", purpose });
        }
        if signals.rate.is_none() {
            return Err(CompareError::Missing { what: "body rates", purpose });
        }
        Ok(Self { signals })
    }

    /// What is not recorded is zero.
    fn at(&self, index: usize) -> State {
        let vector = |series: &Option<Vec<Vector3<f64>>>| {
            series.as_ref().map(|series| series[index]).unwrap_or_default()
        };
        State {
            position_m: vector(&self.signals.position),
            velocity_m_s: vector(&self.signals.velocity),
            attitude: self.signals.attitude.as_ref().map(|series| series[index]).unwrap_or_default(),
            rates_rad_s: vector(&self.signals.rate),
        }
    }

    /// Position only counts where velocity is known too: without it the start is a guess.
    fn compare(&self, simulated: &State, measured: &State, errors: &mut [MeanSquare; 4]) {
        let [position, velocity, attitude, rates] = errors;
        if self.signals.position.is_some() && self.signals.velocity.is_some() {
            position.add((simulated.position_m - measured.position_m).norm_squared());
        }
        if self.signals.velocity.is_some() {
            velocity.add((simulated.velocity_m_s - measured.velocity_m_s).norm_squared());
        }
        attitude.add(simulated.attitude.angle_to(&measured.attitude).powi(2));
        rates.add((simulated.rates_rad_s - measured.rates_rad_s).norm_squared());
    }
}

/// Relative rotor speeds asked for (or measured) at each instant, and the battery's voltage.
struct Commands<'a> {
    signals: &'a Signals,
    delay_instants: f64,
    thrusts_n: Vec<[f64; MAX_ROTORS]>,
    model: &'a Model,
}

impl<'a> Commands<'a> {
    fn of(model: &'a Model, vehicle: &Vehicle, signals: &'a Signals) -> Result<Self, CompareError> {
        let rotors = model.airframe.rotor_count();
        let mut thrusts_n = vec![[0.0; MAX_ROTORS]; signals.grid.count];
        if signals.rotor_thrust_n.is_empty() {
            let allocation = Allocation::new(vehicle, 0.0)?;
            for (thrusts_n, wrench) in thrusts_n.iter_mut().zip(&signals.wrench) {
                thrusts_n.copy_from_slice(allocation.thrusts_n(wrench).as_slice());
            }
        } else {
            for (thrusts_n, recorded) in thrusts_n.iter_mut().zip(signals.rotor_thrust_n.chunks(rotors)) {
                thrusts_n[..rotors].copy_from_slice(recorded);
            }
        }
        Ok(Self { signals, delay_instants: model.command_delay_s() / signals.grid.step_s, thrusts_n, model })
    }

    /// What acts `share` of the way from one instant to the next.
    fn at(&self, index: usize, share: f64) -> Input {
        let last = self.thrusts_n.len() - 1;
        let place = (index as f64 + share - self.delay_instants).max(0.0);
        // counted back from the instant: delays are a few instants long
        let mut left = index.min(last);
        while left > 0 && left as f64 > place {
            left -= 1;
        }
        let (right, part) = ((left + 1).min(last), place - left as f64);
        let Signals { grid, quality, battery_voltage_v, .. } = self.signals;
        let airframe = &self.model.airframe;
        let mut input = Input::from_commands(airframe, grid.time_s(index) + share * grid.step_s, &[]);
        let measured = quality.thrust_source == ThrustSource::MeasuredSpeed;
        for rotor in 0..airframe.rotor_count() {
            let (a, b) = (self.thrusts_n[left][rotor], self.thrusts_n[right][rotor]);
            let speed = airframe.relative_speed_of_thrust(a + part * (b - a));
            input.speed_command[rotor] = speed;
            if measured && speed > 0.0 {
                // T = T_hover n^2, so n' = T' / (2 T_hover n)
                let thrust_rate_n_s = (b - a) / grid.step_s;
                input.speed_rate_1_s[rotor] = thrust_rate_n_s / (2.0 * airframe.hover_thrust_n * speed);
            }
        }
        // of now: commands travel, the battery does not
        let next = (index + 1).min(last);
        input.battery_voltage_v =
            battery_voltage_v.as_ref().map(|volts| volts[index] + share * (volts[next] - volts[index]));
        input
    }
}

#[cfg(test)]
mod tests;
