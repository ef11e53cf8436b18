//! What was measured of a body, to play back from and to compare with.

use crate::compare::CompareError;
use crate::compare::mean_square::MeanSquare;
use crate::physics::State;
use crate::signals::{Series, Signals};
use nalgebra::Vector3;

/// What was measured of the body.
pub(super) struct MeasuredStates<'a> {
    pub signals: &'a Signals,
}

impl<'a> MeasuredStates<'a> {
    pub fn of(signals: &'a Signals) -> Result<Self, CompareError> {
        let purpose = "open-loop playback";
        if signals.attitude.is_none() {
            return Err(CompareError::Missing { what: "attitude", purpose });
        }
        if signals.rate.is_none() {
            return Err(CompareError::Missing { what: "body rates", purpose });
        }
        Ok(Self { signals })
    }

    /// Whether a model's torques can be compared with the motion. Where they cannot, the body turns as it was measured, and its
    /// rotation is no prediction.
    pub fn is_turned_by_torques(&self) -> bool {
        self.signals.quality.torques
    }

    /// A predicted state with the rotation that was measured at an instant.
    pub fn turned(&self, predicted: State, index: usize) -> State {
        let State { attitude, rates_rad_s, .. } = self.at(index);
        State { attitude, rates_rad_s, ..predicted }
    }

    /// What is not recorded is zero.
    pub fn at(&self, index: usize) -> State {
        let vector = |series: &Option<Series<Vector3<f64>>>| {
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
    pub fn compare(&self, simulated: &State, measured: &State, errors: &mut [MeanSquare; 4]) {
        let [position, velocity, attitude, rates] = errors;
        if self.signals.position.is_some() && self.signals.velocity.is_some() {
            position.add((simulated.position_m - measured.position_m).norm_squared());
        }
        if self.signals.velocity.is_some() {
            velocity.add((simulated.velocity_m_s - measured.velocity_m_s).norm_squared());
        }
        if self.is_turned_by_torques() {
            attitude.add(simulated.attitude.angle_to(&measured.attitude).powi(2));
            rates.add((simulated.rates_rad_s - measured.rates_rad_s).norm_squared());
        }
    }
}
