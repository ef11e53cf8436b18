//! Simulated flights with something concealed, explained from the recording and the nominal vehicle alone.

#![allow(dead_code, clippy::unwrap_used)] // no user uses all of it

use mavid::diagnose::{ExplainSettings, Explanation, explain};
use mavid::physics::ActiveEffect;
use mavid::signals::{ConditionSettings, ThrustPreference, condition};
use mavid::simulate::{FlightSettings, RandomTrajectory, Reference, Truth, random_vehicle, simulate_flight};
use mavid::vehicle::Vehicle;

/// Values of an effect's parameters by name.
pub type Sizes<'a> = &'a [(&'a str, f64)];

/// A flight but for what is concealed in it.
#[derive(Clone, Copy)]
pub struct Flight {
    /// draws vehicle, trajectory and noise
    pub seed: u64,
    pub trajectory: RandomTrajectory,
    pub settings: FlightSettings,
    /// s, of the motors, where the vehicle's description states it
    pub stated_lag_s: Option<f64>,
}

impl Flight {
    pub fn of_seed(seed: u64) -> Self {
        Self {
            seed,
            trajectory: RandomTrajectory::default(),
            settings: FlightSettings { seed, ..FlightSettings::default() },
            stated_lag_s: None,
        }
    }

    /// The vehicle that flies.
    pub fn vehicle(&self) -> Vehicle {
        random_vehicle(self.vehicle_seed()).truth
    }

    /// What is said of the flight with these effects concealed.
    pub fn explained(&self, effects: Vec<ActiveEffect>) -> Explanation {
        let mut pair = random_vehicle(self.vehicle_seed());
        pair.nominal.propulsion.time_constant_s = self.stated_lag_s;
        let trajectory = self.trajectory.draw(self.seed.wrapping_mul(104_729)).unwrap();
        let reference = Reference { trajectory, hover_s: 4.0, ramp_s: 2.0 };
        let truth = Truth { vehicle: pair.truth, effects, disturbance: None };
        let flight = simulate_flight(truth, &pair.nominal, &reference, &self.settings).unwrap();
        let how = ConditionSettings {
            transient_s: Some(1.0),
            thrust: ThrustPreference::Commands,
            ..ConditionSettings::default()
        };
        let signals = condition(&flight.recording, &pair.nominal, &how).unwrap();
        explain(&[signals], &pair.nominal, &ExplainSettings::default()).unwrap()
    }

    fn vehicle_seed(&self) -> u64 {
        self.seed.wrapping_mul(7919)
    }
}

/// One flight of a seed with effects of these sizes concealed.
pub fn explained(seed: u64, concealed: &[(&str, Sizes)], trajectory: RandomTrajectory) -> Explanation {
    let flight = Flight { trajectory, ..Flight::of_seed(seed) };
    let size = flight.vehicle().size();
    let named = |(id, values): &(&str, Sizes)| ActiveEffect::named(id, values, &size).unwrap();
    flight.explained(concealed.iter().map(named).collect())
}
