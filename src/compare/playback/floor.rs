//! What a model that is right would leave: noise of the measured states and of the logged commands.

use super::windows::Played;
use crate::compare::CompareError;
use crate::physics::{MAX_ROTORS, State};
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

/// Noise of a recording.
#[derive(Debug, Clone, Copy)]
pub struct FloorNoise<'a> {
    /// of the measured state
    pub state: &'a StateNoise,
    /// of the logged commands, where the rotors' speeds were not measured
    pub commands: Option<&'a CommandNoise>,
    /// of its draws
    pub seed: u64,
}

/// What [`super::playback_windows`] would find of a model that is right: the sensors' noise at the start of
/// each window, carried along by the model, and at every instant that is compared; and rotors that do
/// not quite what the log says. One seeded draw an instant at which windows begin; those of all lengths share it.
pub(super) struct Floor<'a> {
    otherwise: Played<'a>,
    noise: &'a StateNoise,
    generator: Pcg64Mcg,
}

impl<'a> Floor<'a> {
    pub fn of(mut played: Played<'a>, noise: FloorNoise<'a>) -> Self {
        let mut generator = Pcg64Mcg::seed_from_u64(noise.seed);
        if let Some(commands) = noise.commands {
            commands.disturb(&mut played, &mut generator);
        }
        Self { otherwise: played, noise: noise.state, generator }
    }

    /// What is predicted for the instants after `start`, and what is measured there, where the truth is what the model does without
    /// noise.
    pub fn predicted(&mut self, start: usize, truth: &[State]) -> Result<Vec<(State, State)>, CompareError> {
        let Self { otherwise, noise, generator } = self;
        let mut plant = otherwise.warm(start)?;
        plant.set_state(&noise.on(&otherwise.measured(start), generator));
        let simulated = otherwise.window(plant, (start, truth.len()));
        Ok(simulated.into_iter().zip(truth).map(|(of, truth)| (of, noise.on(truth, generator))).collect())
    }
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
    fn disturb(&self, played: &mut Played, generator: &mut Pcg64Mcg) {
        let step_s = played.step_s;
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
