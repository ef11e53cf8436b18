//! Thrust of the rotors by the autopilot's messages and the vehicle file. If the file is of another vehicle, or if its
//! actuator unit is not the autopilot's, the thrust in hover is not the weight.

use super::parameters::Parameters;
use crate::recording::{Quantity, Recording};
use crate::signals::{motor_channels, propulsion_from_log};
use crate::vehicle::{Propulsion, Vehicle};
use std::ops::RangeInclusive;

/// Range of normalised commands. Commands outside of it have another unit than the vehicle file's: a hovering rotor
/// is far from both ends. Pulse widths are near 1500, and percents near 40.
const IN_UNIT: RangeInclusive<f64> = -0.25..=1.25;
/// Least number of samples of a message.
const LEAST_SAMPLES: u32 = 5;
/// Ratio of thrust to weight, or its inverse, that is reported. Nominal files are often 20 to 30 % off; an offset of
/// the pulse range that is not stated, or a discharged battery, adds as much. Smaller would warn of most files,
/// larger would hide an undervoltage.
const NOTABLE: f64 = 1.4;
/// Ratio from which the file is of another vehicle or unit, or has a wrong thrust curve: twice the usual error. The
/// flight does not begin with such a file; with more it would.
const GROSS: f64 = 2.0;

/// Actuator outputs, or rotor speeds in rad/s, of one message.
#[derive(Debug, Clone, PartialEq)]
pub struct Outputs {
    /// which
    pub quantity: Quantity,
    /// the message
    pub source: &'static str,
    /// one a channel
    pub values: Vec<f64>,
}

/// Conversion of one message's outputs to thrust, with the outputs in hover.
#[derive(Debug, Clone, PartialEq)]
struct Heard {
    source: &'static str,
    quantity: Quantity,
    count: u32,
    sum_n: f64,
    /// samples in none of the units of the file and the parameters
    strange: u32,
}

/// Comparison of the outputs of a hovering vehicle with its weight.
#[derive(Debug, Clone, PartialEq)]
pub struct Lift {
    stated: Propulsion,
    said: Propulsion,
    channels: Vec<usize>,
    rotors: usize,
    weight_n: f64,
    heard: Vec<Heard>,
}

/// Result of the comparison of thrust and weight.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Weighed {
    /// they agree, with the sentence
    Alike(String),
    /// they differ more than usual, or are not known
    Notable(String),
}

impl Lift {
    /// The comparison for a vehicle file and the autopilot's parameters of its outputs.
    #[must_use]
    pub fn new(vehicle: &Vehicle, parameters: &Parameters) -> Self {
        let said = Recording {
            parameters: parameters.values.clone(),
            autopilot: parameters.autopilot,
            ..Recording::default()
        };
        let rotors = vehicle.rotors.len();
        let mut notes = Vec::new();
        Self {
            stated: vehicle.propulsion,
            said: propulsion_from_log(&said, &vehicle.propulsion).0,
            channels: motor_channels(&said, rotors, &mut notes),
            rotors,
            weight_n: vehicle.body.mass_kg * vehicle.gravity_m_s2,
            heard: Vec::new(),
        }
    }

    /// Forgets all samples, because the vehicle does not hover.
    pub(super) fn clear(&mut self) {
        self.heard.clear();
    }

    /// Takes actuator outputs or rotor speeds (rad/s) of one instant.
    pub(super) fn add(&mut self, outputs: &Outputs) {
        let Outputs { quantity, source, ref values } = *outputs;
        let thrust_n = match quantity {
            Quantity::RotorSpeed => self.of_speeds_n(values),
            Quantity::ActuatorCommand => self.of_commands_n(values),
            _ => return,
        };
        let same = |heard: &Heard| (heard.quantity, heard.source) == (quantity, source);
        let index = self.heard.iter().position(same).unwrap_or_else(|| {
            self.heard.push(Heard { source, quantity, count: 0, sum_n: 0.0, strange: 0 });
            self.heard.len() - 1
        });
        let heard = &mut self.heard[index];
        match thrust_n {
            Some(thrust_n) => {
                heard.count += 1;
                heard.sum_n += thrust_n;
            }
            None => heard.strange += 1,
        }
    }

    fn of_speeds_n(&self, values: &[f64]) -> Option<f64> {
        let speeds = values.get(..self.rotors)?;
        // nothing but zeros is a message without sensors behind it
        let turning = speeds.iter().all(|speed| speed.is_finite()) && speeds.iter().any(|speed| *speed > 0.0);
        let thrusts = speeds.iter().map(|speed| self.stated.thrust_from_speed_n(*speed));
        if turning { thrusts.sum() } else { None }
    }

    fn of_commands_n(&self, values: &[f64]) -> Option<f64> {
        let of = |propulsion: &Propulsion| {
            let commands: Option<Vec<f64>> = self
                .channels
                .iter()
                .map(|channel| values.get(*channel).map(|v| propulsion.normalized(*v)))
                .collect();
            let commands = commands.filter(|commands| commands.iter().all(|u| IN_UNIT.contains(u)))?;
            Some(commands.iter().map(|u| propulsion.thrust_from_command_n(*u)).sum::<f64>())
        };
        of(&self.said).or_else(|| of(&self.stated))
    }

    /// Thrust against weight from all samples since the last clear: measured speeds before commands.
    #[must_use]
    pub fn weighed(&self) -> Weighed {
        let speaks = |heard: &&Heard| heard.count >= LEAST_SAMPLES && heard.sum_n.is_finite();
        let speeds = self.heard.iter().filter(speaks).find(|heard| heard.quantity == Quantity::RotorSpeed);
        let most = self.heard.iter().filter(speaks).max_by_key(|heard| heard.count);
        let Some(Heard { source, count, sum_n, .. }) = speeds.or(most) else {
            return match self.heard.iter().find(|heard| heard.strange >= LEAST_SAMPLES) {
                Some(heard) => Weighed::Notable(format!(
                    "expected actuator outputs in the unit of the vehicle file, got {} in another: thrust is not \
                     compared with weight, and nothing may be identified",
                    heard.source
                )),
                None => Weighed::Notable(
                    "thrust is not compared with the vehicle file's weight: no actuator outputs arrive"
                        .into(),
                ),
            };
        };
        let thrust_n = sum_n / f64::from(*count);
        let text = format!(
            "expected outputs that give the vehicle file's weight, {:.4} N; those by which it hovers ({source}) give \
             {thrust_n:.4} N by the file's thrust curve",
            self.weight_n
        );
        let apart = apart(thrust_n, self.weight_n);
        if apart > GROSS {
            Weighed::Notable(format!(
                "{text}: the file is another vehicle's, its actuator unit or thrust is wrong, or the outputs mean nothing; expect no parameters from this flight"
            ))
        } else if apart > NOTABLE {
            Weighed::Notable(text)
        } else {
            Weighed::Alike(text)
        }
    }
}

/// The larger over the smaller; infinite if one of them is not positive.
#[must_use]
pub(super) fn apart(came: f64, expected: f64) -> f64 {
    if came > 0.0 && expected > 0.0 { (came / expected).max(expected / came) } else { f64::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::autopilot::Autopilot;
    use crate::simulate::random_vehicle;
    use crate::vehicle::{Actuator, PwmRange};

    fn hovering(vehicle: &Vehicle, parameters: &Parameters, quantity: Quantity, value: f64) -> Weighed {
        let mut lift = Lift::new(vehicle, parameters);
        for _ in 0..20 {
            lift.add(&Outputs { quantity, source: "A", values: vec![value; 8] });
        }
        lift.weighed()
    }

    fn px4_pulses() -> Parameters {
        let entries = (1..=4).flat_map(|output| {
            [("FUNC", 100.0 + f64::from(output)), ("MIN", 1000.0), ("MAX", 2000.0)]
                .map(|(name, value)| (format!("PWM_MAIN_{name}{output}"), value))
        });
        Parameters { autopilot: Autopilot::Px4, values: entries.collect(), ..Parameters::default() }
    }

    #[test]
    fn a_hovering_vehicle_is_weighed_by_speeds_fractions_and_pulses() {
        let (vehicle, silent) = (random_vehicle(1).truth, Parameters::default());
        let hover_n = vehicle.body.mass_kg * vehicle.gravity_m_s2 / 4.0;
        let u = vehicle.propulsion.command_from_thrust(hover_n);
        let speed = (hover_n / vehicle.propulsion.thrust_coefficient.expect("known")).sqrt();
        let alike = |weighed| matches!(weighed, Weighed::Alike(_));
        assert!(alike(hovering(&vehicle, &silent, Quantity::RotorSpeed, speed)));
        assert!(alike(hovering(&vehicle, &silent, Quantity::ActuatorCommand, u)));
        assert!(alike(hovering(&vehicle, &px4_pulses(), Quantity::ActuatorCommand, u)));
        assert!(alike(hovering(&vehicle, &px4_pulses(), Quantity::ActuatorCommand, 1000.0 + 1000.0 * u)));
        // thrust goes with the square of the speed
        let off = |factor: f64| hovering(&vehicle, &silent, Quantity::RotorSpeed, factor.sqrt() * speed);
        assert!(alike(off(1.3)) && alike(off(0.75)));
        assert!(matches!(off(1.5), Weighed::Notable(_)) && matches!(off(0.6), Weighed::Notable(_)));
        let gross = |weighed: &Weighed| matches!(weighed, Weighed::Notable(text) if text.contains("another vehicle's"));
        assert!(gross(&off(2.1)) && gross(&off(0.4)) && !gross(&off(1.6)));
    }

    #[test]
    fn another_unit_is_said_and_silence_is_no_other_vehicle() {
        let mut vehicle = random_vehicle(1).truth;
        vehicle.propulsion.actuator = Actuator::Pwm(Some(PwmRange { min_us: 1000.0, max_us: 2000.0 }));
        let strange = hovering(&vehicle, &Parameters::default(), Quantity::ActuatorCommand, 0.7);
        assert!(matches!(&strange, Weighed::Notable(text) if text.contains("in another")), "{strange:?}");
        let silent = Lift::new(&vehicle, &Parameters::default()).weighed();
        assert!(matches!(&silent, Weighed::Notable(text) if text.contains("not compared")), "{silent:?}");
        let still = hovering(&vehicle, &Parameters::default(), Quantity::RotorSpeed, 0.0);
        assert!(!matches!(still, Weighed::Alike(_)), "{still:?}");
    }
}
