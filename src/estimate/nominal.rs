//! Prior knowledge of a vehicle by which estimates are judged.

use super::theta::{THETA, Theta, theta_of};
use crate::vehicle::{Anchor, Guess, Guessed, Vehicle};

/// Sizes of the parameters beforehand, and which of them no flight can know better than a guess.
#[derive(Debug, Clone, PartialEq)]
pub struct Nominal {
    /// of the vehicle's file
    pub theta: Theta,
    /// guesses that scale each parameter, in `Theta`'s order
    scaled_by: [Vec<Guess>; THETA],
}

impl Nominal {
    /// Of a vehicle. A flight gives torque over inertia: inertia goes with the arms and the rotors' torque, and mass and
    /// inertia with the thrust unless the mass was weighed.
    #[must_use]
    pub fn of(vehicle: &Vehicle) -> Self {
        let by_thrust = vehicle.anchor == Anchor::Thrust;
        let scales = |index: usize, of: Guessed| match (index, of) {
            (_, Guessed::ThrustMax) => by_thrust,
            (1..=5, Guessed::Arms) | (6, Guessed::TorqueRatio) => true,
            _ => false,
        };
        let of_index =
            |index| vehicle.guesses.iter().filter(|guess| scales(index, guess.of)).cloned().collect();
        Self { theta: theta_of(&vehicle.body), scaled_by: std::array::from_fn(of_index) }
    }

    /// The same as if nothing were guessed: of what the motion tells, guesses are no question.
    #[must_use]
    pub fn without_guesses(vehicle: &Vehicle) -> Self {
        Self { theta: theta_of(&vehicle.body), scaled_by: Default::default() }
    }

    /// Relative standard error that a parameter has from guesses alone.
    #[must_use]
    pub fn guessed(&self, index: usize) -> f64 {
        self.scaled_by[index].iter().map(|guess| guess.relative).fold(0.0, f64::hypot)
    }

    /// The guesses that a parameter rests on, in words; `None` without any.
    #[must_use]
    pub fn guesses(&self, index: usize) -> Option<String> {
        let words =
            |guess: &Guess| format!("{} is a guess of +- {:.0} %", guess.of.words(), 100.0 * guess.relative);
        let all: Vec<String> = self.scaled_by[index].iter().map(words).collect();
        (!all.is_empty()).then(|| all.join(" and "))
    }
}
