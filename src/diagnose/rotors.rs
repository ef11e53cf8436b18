//! Thrust, speed and acceleration of each rotor along a flight.

use crate::physics::{ActuationLatency, Airframe, MAX_ROTORS, delayed_thrusts_n};
use crate::signals::central_difference;

/// One thrust a rotor, N; those beyond the rotor count are zero.
pub type Thrusts = [f64; MAX_ROTORS];

/// Motion of the rotors at each grid instant.
#[derive(Debug, Clone)]
pub struct RotorMotion {
    /// N
    pub thrust_n: Vec<Thrusts>,
    /// speed for this thrust, relative to hover
    pub speed: Vec<Thrusts>,
    /// rate of the speed relative to hover, 1/s
    pub acceleration_1_s: Vec<Thrusts>,
}

impl RotorMotion {
    /// Motion for given thrusts: speeds and their rates.
    #[must_use]
    pub fn new(thrust_n: Vec<Thrusts>, airframe: &Airframe, step_s: f64) -> Self {
        let mut speed = vec![[0.0; MAX_ROTORS]; thrust_n.len()];
        let mut acceleration_1_s = speed.clone();
        for rotor in 0..airframe.rotor_count() {
            let of_rotor: Vec<f64> =
                thrust_n.iter().map(|thrusts| airframe.relative_speed_of_thrust(thrusts[rotor])).collect();
            let rates = central_difference(&of_rotor, step_s);
            for (index, (value, rate)) in of_rotor.iter().zip(rates).enumerate() {
                (speed[index][rotor], acceleration_1_s[index][rotor]) = (*value, rate);
            }
        }
        Self { thrust_n, speed, acceleration_1_s }
    }
}

/// Thrusts behind an actuation latency. The lag acts on the rotors' speed, as a motor's does.
pub(super) fn felt(
    commanded_n: &[Thrusts],
    airframe: &Airframe,
    step_s: f64,
    latency: ActuationLatency,
) -> Vec<Thrusts> {
    if latency == ActuationLatency::default() {
        return commanded_n.to_vec();
    }
    let rotors = airframe.rotor_count();
    let flat: Vec<f64> = commanded_n.iter().flat_map(|thrusts| &thrusts[..rotors]).copied().collect();
    let delayed = delayed_thrusts_n(&flat, rotors, step_s, latency);
    let of_all = |thrusts: &[f64]| {
        let mut all = [0.0; MAX_ROTORS];
        all[..rotors].copy_from_slice(thrusts);
        all
    };
    delayed.chunks_exact(rotors).map(of_all).collect()
}
