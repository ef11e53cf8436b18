//! The rotor speeds asked for, or measured, along a recording.

use crate::compare::CompareError;
use crate::physics::{Input, MAX_ROTORS, Model};
use crate::signals::{Signals, ThrustSource};
use crate::simulate::Allocation;
use crate::vehicle::Vehicle;

/// Relative rotor speeds asked for (or measured) at each instant, and the battery's voltage.
pub(super) struct Commands<'a> {
    signals: &'a Signals,
    delay_instants: f64,
    pub thrusts_n: Vec<[f64; MAX_ROTORS]>,
    model: &'a Model,
}

impl<'a> Commands<'a> {
    pub fn of(model: &'a Model, vehicle: &Vehicle, signals: &'a Signals) -> Result<Self, CompareError> {
        let rotors = model.airframe.rotor_count();
        let mut thrusts_n = vec![[0.0; MAX_ROTORS]; signals.grid.count];
        if signals.rotor_thrust_n.is_empty() {
            let allocation = Allocation::new(vehicle, 0.0)?;
            for (thrusts_n, wrench) in thrusts_n.iter_mut().zip(signals.wrench.iter()) {
                thrusts_n.copy_from_slice(allocation.thrusts_n(wrench).as_slice());
            }
        } else {
            let factor = signals.thrust_factor(&vehicle.propulsion);
            for (thrusts_n, recorded) in thrusts_n.iter_mut().zip(signals.rotor_thrust_n.chunks(rotors)) {
                thrusts_n.iter_mut().zip(recorded).for_each(|(thrust, recorded)| *thrust = factor * recorded);
            }
        }
        Ok(Self { signals, delay_instants: model.command_delay_s() / signals.grid.step_s, thrusts_n, model })
    }

    /// What acts `share` of the way from one instant to the next.
    pub fn at(&self, index: usize, share: f64) -> Input {
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
