//! A model as one vector differential equation, rigid body first, then the effects' own states.

use nalgebra::SVector;

use super::SimulateError;
use super::integrator::rk4_step;
use crate::physics::{Evaluation, Input, Model, RIGID_STATES, State, Wrench};

/// Capacity of the state vector: rigid body and the effects' own states.
pub const PLANT_STATES: usize = 32;

/// Something beyond every effect that pushes the vehicle, as force and torque in the body frame.
pub type Push<'a> = &'a dyn Fn(f64, &State) -> Wrench;

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

    /// Where it is.
    #[must_use]
    pub fn state(&self) -> State {
        State::read(&self.vector)
    }

    /// Force, torque and rotors under this input, now.
    #[must_use]
    pub fn evaluate(&self, input: &Input) -> Evaluation {
        let mut rates = [0.0; PLANT_STATES];
        evaluate(self.model, self.push, &self.vector, (input, &mut rates))
    }

    /// Moves on by `step_s` (s) under a constant input, with one Runge-Kutta step.
    pub fn step(&mut self, input: &Input, step_s: f64) {
        let (model, push) = (self.model, self.push);
        let mut derivative = |time_s: f64, vector: &SVector<f64, PLANT_STATES>| {
            let mut rates = [0.0; PLANT_STATES];
            let now = Input { time_s, ..*input };
            let evaluation = evaluate(model, push, vector, (&now, &mut rates));
            let mut out = SVector::<f64, PLANT_STATES>::zeros();
            model.body.derivative(&State::read(vector), &evaluation.wrench).write(&mut out);
            for (slot, rate) in out.iter_mut().skip(RIGID_STATES).zip(rates) {
                *slot = rate;
            }
            out
        };
        self.vector = rk4_step(&mut derivative, input.time_s, &self.vector, step_s);
        // back to a unit quaternion: the step leaves it by its own error
        self.state().write(&mut self.vector);
    }
}

fn evaluate(
    model: &Model,
    push: Option<Push>,
    vector: &SVector<f64, PLANT_STATES>,
    (input, rates): (&Input, &mut [f64; PLANT_STATES]),
) -> Evaluation {
    let state = State::read(vector);
    let count = model.own_state_count();
    let own = &vector.as_slice()[RIGID_STATES..RIGID_STATES + count];
    let mut evaluation = model.evaluate(&state, input, own, &mut rates[..count]);
    if let Some(push) = push {
        evaluation.wrench += push(input.time_s, &state);
    }
    evaluation
}

#[cfg(test)]
mod tests;
