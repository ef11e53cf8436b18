//! A model as one vector differential equation, rigid body first, then the effects' own states.

use nalgebra::SVector;

use super::SimulateError;
use super::integrator::rk4_step;
use crate::physics::{Evaluation, Input, Model, OwnStates, RIGID_STATES, Rotors, State, Wrench};

/// Capacity of the state vector: rigid body and the effects' own states.
pub const PLANT_STATES: usize = 32;

/// Something beyond every effect that pushes the vehicle, as force and torque in the body frame.
pub type Push<'a> = &'a dyn Fn(f64, &State) -> Wrench;

/// Where a [`Plant`] is, own states of the effects included, while nobody steps it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlantMemory(SVector<f64, PLANT_STATES>);

/// A vehicle in flight.
pub struct Plant<'a> {
    model: &'a Model,
    push: Option<Push<'a>>,
    vector: SVector<f64, PLANT_STATES>,
}

impl<'a> Plant<'a> {
    /// A vehicle in `state` whose rotors have long followed the commands of `input`.
    ///
    /// # Errors
    /// If the effects have more own states than fit.
    pub fn new(
        model: &'a Model,
        push: Option<Push<'a>>,
        state: &State,
        input: &Input,
    ) -> Result<Self, SimulateError> {
        let count = model.own_state_count();
        if RIGID_STATES + count > PLANT_STATES {
            return Err(SimulateError::TooManyStates { count });
        }
        let mut vector = SVector::<f64, PLANT_STATES>::zeros();
        state.write(&mut vector);
        model.initial_states(state, input, &mut vector.as_mut_slice()[RIGID_STATES..RIGID_STATES + count]);
        Ok(Self { model, push, vector })
    }

    /// The vehicle that [`Self::memory`] was taken of; `model` must be the one it was taken with.
    #[must_use]
    pub fn resume(model: &'a Model, push: Option<Push<'a>>, memory: PlantMemory) -> Self {
        Self { model, push, vector: memory.0 }
    }

    /// All of its state, for [`Self::resume`].
    #[must_use]
    pub fn memory(&self) -> PlantMemory {
        PlantMemory(self.vector)
    }

    /// Where it is.
    #[must_use]
    pub fn state(&self) -> State {
        State::read(&self.vector)
    }

    /// Puts the body somewhere else; the effects' own states stay.
    pub fn set_state(&mut self, state: &State) {
        state.write(&mut self.vector);
    }

    /// Force, torque and rotors under this input, now.
    #[must_use]
    pub fn evaluate(&self, input: &Input) -> Evaluation {
        let (mut rates, count) = ([0.0; PLANT_STATES], self.model.own_state_count());
        let (state, own) = (self.state(), &self.vector.as_slice()[RIGID_STATES..RIGID_STATES + count]);
        let mut evaluation = self.model.evaluate(&state, input, own, &mut rates[..count]);
        if let Some(push) = self.push {
            evaluation.wrench += push(input.time_s, &state);
        }
        evaluation
    }

    /// Moves on by `step_s` (s) under a constant input, with one Runge-Kutta step.
    pub fn step(&mut self, input: &Input, step_s: f64) {
        // no more numbers than the effects need take part
        match self.model.own_state_count() {
            0 => self.step_of::<RIGID_STATES>(input, step_s),
            1..=4 => self.step_of::<{ RIGID_STATES + 4 }>(input, step_s),
            5..=10 => self.step_of::<{ RIGID_STATES + 10 }>(input, step_s),
            _ => self.step_of::<PLANT_STATES>(input, step_s),
        }
    }

    fn step_of<const N: usize>(&mut self, input: &Input, step_s: f64) {
        let (model, push) = (self.model, self.push);
        let count = model.own_state_count();
        let (mut now, mut rotors) = (*input, Rotors::still());
        let mut derivative = |time_s: f64, vector: &SVector<f64, N>| {
            let mut out = SVector::<f64, N>::zeros();
            let state = State::read(vector);
            now.time_s = time_s;
            let states = &vector.as_slice()[RIGID_STATES..RIGID_STATES + count];
            let rates = &mut out.as_mut_slice()[RIGID_STATES..RIGID_STATES + count];
            let mut wrench = model.wrench(&state, &now, OwnStates { states, rates }, &mut rotors);
            if let Some(push) = push {
                wrench += push(time_s, &state);
            }
            model.body.derivative(&state, &wrench).write(&mut out);
            out
        };
        let mut vector = SVector::<f64, N>::from_column_slice(&self.vector.as_slice()[..N]);
        vector = rk4_step(&mut derivative, input.time_s, &vector, step_s);
        // back to a unit quaternion: the step leaves it by its own error
        State::read(&vector).write(&mut vector);
        self.vector.as_mut_slice()[..N].copy_from_slice(vector.as_slice());
    }
}

#[cfg(test)]
mod tests;
