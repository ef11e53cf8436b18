//! A vehicle as its file states it.

use super::anchor::Anchor;
use super::body::RigidBody;
use super::guess::{Guess, Guessed};
use super::limits::Limits;
use super::propulsion::Propulsion;
use super::rotor::{Mixer, Rotor};

/// A vehicle as its file states it, in SI.
#[derive(Debug, Clone, PartialEq)]
pub struct Vehicle {
    /// name for reports
    pub name: String,
    /// nominal mass and inertia
    pub body: RigidBody,
    /// thrust and torque from actuator values
    pub propulsion: Propulsion,
    /// in the order of the actuator outputs
    pub rotors: Vec<Rotor>,
    /// what `plan` and `fly` must keep
    pub limits: Limits,
    /// what sets the scale
    pub anchor: Anchor,
    /// m/s^2
    pub gravity_m_s2: f64,
    /// values that nobody measured
    pub guesses: Vec<Guess>,
}

impl Vehicle {
    /// The map from rotor thrusts to `F = [Fz tau_x tau_y tau_z]` at the centre of mass.
    #[must_use]
    pub fn mixer(&self) -> Mixer {
        Mixer::new(&self.rotors, self.body.center_of_mass_m, self.propulsion.torque_per_thrust_m)
    }

    /// Relative standard error of a value that nobody measured, as in [`Guess::relative`]; 0 where it is no guess.
    #[must_use]
    pub fn guessed(&self, of: Guessed) -> f64 {
        self.guesses.iter().filter(|guess| guess.of == of).map(|guess| guess.relative).fold(0.0, f64::max)
    }

    /// The rotor that an effect's number means, from 0; `None` where there is none.
    #[must_use]
    pub fn rotor_of(&self, number: f64) -> Option<usize> {
        (0..self.rotors.len()).find(|&index| (index as f64 - number).abs() < 0.5)
    }

    /// The motor at a place of [`Self::rotors`] as people call it: `motor 2 (rear left)`.
    #[must_use]
    pub fn motor_words(&self, index: usize) -> String {
        self.rotors
            .get(index)
            .map_or_else(|| format!("motor {}", index + 1), |rotor| rotor.motor_words(index))
    }
}
