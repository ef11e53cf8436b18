//! What a model that is right would leave: noise of the measured states and of the logged commands.

use super::settings::PlaybackSettings;
use super::windows::{Played, WindowErrors, played};
use crate::compare::CompareError;
use crate::physics::{MAX_ROTORS, Model, State};
use crate::signals::Signals;
use crate::vehicle::Vehicle;
use nalgebra::{SMatrix, SVector, UnitQuaternion, Vector3};
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

/// White noise of the measured state, one standard deviation an axis.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StateNoise {
    /// m
    pub position_m: f64,
    /// m/s
    pub velocity_m_s: f64,
    /// rad, about each body axis
    pub attitude_rad: f64,
    /// rad/s
    pub rates_rad_s: f64,
}

/// What the rotors did beside what the log holds: it samples a loop that runs faster.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CommandNoise {
    /// N, lower Cholesky factor of the covariance over rotors
    pub factor_n: SMatrix<f64, MAX_ROTORS, MAX_ROTORS>,
    /// s, how long each draw lasts
    pub period_s: f64,
}

/// What [`super::playback_windows`] would find of a model that is right: the sensors' noise at the start of
/// each window, carried along by the model, and at every instant that is compared; and rotors that do
/// not quite what the log says. One seeded draw a window.
///
/// # Errors
/// As [`super::playback`].
pub fn playback_floor(
    (model, vehicle): (&Model, &Vehicle),
    signals: &Signals,
    settings: &PlaybackSettings,
    (noise, commands, seed): (&StateNoise, Option<&CommandNoise>, u64),
) -> Result<Vec<WindowErrors>, CompareError> {
    let model = played(model, signals);
    let exact = Played::of((&model, vehicle), None, signals, settings)?;
    let mut generator = Pcg64Mcg::seed_from_u64(seed);
    let mut otherwise = Played::of((&model, vehicle), None, signals, settings)?;
    if let Some(commands) = commands {
        commands.disturb(&mut otherwise, signals.grid.step_s, &mut generator);
    }
    let windows = &exact.windows;
    let mut out = Vec::with_capacity(windows.starts.len());
    for &start in &windows.starts {
        let measured = windows.states.at(start);
        let truth = exact.window(start, &measured)?;
        let simulated = otherwise.window(start, &noise.on(&measured, &mut generator))?;
        let pairs = truth.iter().zip(simulated).map(|(truth, of)| (of, noise.on(truth, &mut generator)));
        out.push(windows.errors_against(start, pairs));
    }
    Ok(out)
}

fn normal(generator: &mut Pcg64Mcg) -> f64 {
    StandardNormal.sample(generator)
}

impl StateNoise {
    fn on(&self, state: &State, generator: &mut Pcg64Mcg) -> State {
        let mut draw = |size: f64| Vector3::from_fn(|_, _| size * normal(generator));
        State {
            position_m: state.position_m + draw(self.position_m),
            velocity_m_s: state.velocity_m_s + draw(self.velocity_m_s),
            attitude: state.attitude * UnitQuaternion::from_scaled_axis(draw(self.attitude_rad)),
            rates_rad_s: state.rates_rad_s + draw(self.rates_rad_s),
        }
    }
}

impl CommandNoise {
    fn disturb(&self, played: &mut Played, step_s: f64, generator: &mut Pcg64Mcg) {
        let mut now = SVector::zeros();
        let mut left_s = 0.0;
        for thrusts_n in &mut played.commands.thrusts_n {
            if left_s <= 0.0 {
                now = self.factor_n * SVector::from_fn(|_, _| normal(generator));
                left_s += self.period_s;
            }
            left_s -= step_s;
            thrusts_n.iter_mut().zip(now.iter()).for_each(|(thrust, noise)| *thrust += noise);
        }
    }
}
