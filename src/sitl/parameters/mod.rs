//! The autopilot's parameters, and how each autopilot puts them into PARAM_VALUE.

mod ardupilot;
mod px4;

use std::collections::BTreeMap;

use super::battery::Battery;
use super::message::Message;
use super::{AutopilotKind, Settings, SitlError};
use crate::log::Payload;
use crate::units::{narrow, whole};
use crate::vehicle::{Actuator, PwmRange, ThrustLaw, Vehicle as Description};

/// MAV_PARAM_TYPE of a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ParameterType {
    Int8,
    Int16,
    Int32,
    Real32,
}

impl ParameterType {
    fn mav(self) -> u8 {
        match self {
            Self::Int8 => 2,
            Self::Int16 => 4,
            Self::Int32 => 6,
            Self::Real32 => 9,
        }
    }
}

/// One parameter.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Parameter {
    pub(super) name: String,
    pub(super) kind: ParameterType,
    pub(super) value: f64,
}

/// A row of a table of defaults.
type Row = (&'static str, ParameterType, f64);

/// All parameters, by name.
#[derive(Debug)]
pub(super) struct Parameters {
    autopilot: AutopilotKind,
    list: Vec<Parameter>,
    index: BTreeMap<String, usize>,
}

/// Pulse widths that the autopilot puts out, microseconds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pulses {
    /// u = 0
    pub(super) min_us: f64,
    /// u = 1
    pub(super) max_us: f64,
    /// disarmed
    pub(super) off_us: f64,
}

/// ArduPilot's MOT_SPIN_MIN and MOT_SPIN_MAX.
const SPIN: (f64, f64) = (0.15, 0.95);
/// PX4's PWM_MAIN_DISn.
const PX4_OFF_US: f64 = 900.0;

impl Pulses {
    /// Those of the vehicle's file; where it has none the autopilot's defaults.
    pub(super) fn of(vehicle: &Description, autopilot: AutopilotKind) -> Self {
        let stated = match vehicle.propulsion.actuator {
            Actuator::Pwm(range) => range,
            Actuator::Speed | Actuator::Thrust => None,
        };
        match autopilot {
            AutopilotKind::Px4 => {
                let PwmRange { min_us, max_us } =
                    stated.unwrap_or(PwmRange { min_us: 1000.0, max_us: 2000.0 });
                Self { min_us, max_us, off_us: PX4_OFF_US.min(min_us) }
            }
            AutopilotKind::ArduPilot(_) => {
                let PwmRange { min_us, max_us } =
                    stated.unwrap_or(PwmRange { min_us: 1150.0, max_us: 1950.0 });
                let span_us = (max_us - min_us) / (SPIN.1 - SPIN.0);
                Self { min_us, max_us, off_us: min_us - SPIN.0 * span_us }
            }
        }
    }

    /// The pulse of a normalised output, whole microseconds.
    pub(super) fn pulse_us(&self, u: f64) -> u16 {
        u16::try_from(whole(self.min_us + u * (self.max_us - self.min_us))).unwrap_or(0)
    }

    /// The pulse of a disarmed output.
    pub(super) fn off_pulse_us(&self) -> u16 {
        u16::try_from(whole(self.off_us)).unwrap_or(0)
    }

    /// The normalised output of a pulse.
    pub(super) fn output(&self, pulse_us: u16) -> f64 {
        (f64::from(pulse_us) - self.min_us) / (self.max_us - self.min_us)
    }
}

/// THR_MDL_FAC or MOT_THST_EXPO that straightens the vehicle's thrust law.
fn expo(vehicle: &Description) -> f64 {
    match vehicle.propulsion.law {
        ThrustLaw::Curve { expo, .. } => expo,
        ThrustLaw::Speed { .. } => 1.0,
    }
}

/// Thrust of hover over full thrust.
fn hover_share(vehicle: &Description) -> f64 {
    let hover_n = vehicle.body.mass_kg * vehicle.gravity_m_s2 / vehicle.rotors.len() as f64;
    hover_n / vehicle.propulsion.thrust_from_command_n(1.0)
}

impl Parameters {
    /// The autopilot's defaults with the values of the settings.
    ///
    /// # Errors
    /// If the settings name a parameter that this autopilot does not have.
    pub(super) fn new(settings: &Settings) -> Result<Self, SitlError> {
        let pulses = Pulses::of(&settings.vehicle, settings.autopilot);
        let mut list = match settings.autopilot {
            AutopilotKind::Px4 => px4::defaults(settings.believed(), &pulses, settings.system),
            AutopilotKind::ArduPilot(release) => {
                ardupilot::defaults(settings.believed(), &pulses, settings.system, release)
            }
        };
        list.sort_by(|a, b| a.name.cmp(&b.name));
        let index = list.iter().enumerate().map(|(at, parameter)| (parameter.name.clone(), at)).collect();
        let mut all = Self { autopilot: settings.autopilot, list, index };
        // a battery of this voltage, with its lines at the same shares as PX4's
        for (name, remaining) in [("BATT_LOW_VOLT", 0.15), ("BATT_CRT_VOLT", 0.07)] {
            all.set(name, Battery::volts_at(settings.battery_v, remaining));
        }
        for (name, value) in &settings.parameters {
            if !all.set(name, *value) {
                return Err(SitlError::Setting {
                    name: format!("parameter {name}"),
                    expected: "one that this autopilot has",
                    got: value.to_string(),
                });
            }
        }
        Ok(all)
    }

    pub(super) fn len(&self) -> usize {
        self.list.len()
    }

    pub(super) fn find(&self, name: &str) -> Option<usize> {
        self.index.get(name).copied()
    }

    /// Value of a parameter; zero where this autopilot has none of that name.
    pub(super) fn value(&self, name: &str) -> f64 {
        self.find(name).map_or(0.0, |at| self.list[at].value)
    }

    /// The first of these names that exists, with its factor to SI.
    pub(super) fn first(&self, names: &[(&str, f64)]) -> f64 {
        let found =
            names.iter().find_map(|(name, factor)| self.find(name).map(|at| self.list[at].value * factor));
        found.unwrap_or(0.0)
    }

    /// Sets a value as the parameter's type holds it; false where there is none of that name.
    pub(super) fn set(&mut self, name: &str, value: f64) -> bool {
        let Some(parameter) = self.find(name).and_then(|at| self.list.get_mut(at)) else { return false };
        parameter.value = match parameter.kind {
            ParameterType::Real32 => narrow(value).into(),
            _ => whole(value).into(),
        };
        true
    }

    /// What a PARAM_SET of this type and these bytes asks for; `None` where PX4 refuses the type.
    pub(super) fn decode(&self, at: usize, kind: u8, payload: Payload) -> Option<f64> {
        let parameter = self.list.get(at)?;
        match self.autopilot {
            AutopilotKind::Px4 if kind != parameter.kind.mav() => None,
            AutopilotKind::Px4 if parameter.kind != ParameterType::Real32 => Some(payload.i32(0).into()),
            _ => Some(payload.f32(0)).filter(|value| value.is_finite()),
        }
    }

    /// PARAM_VALUE. `index` as asked for: PX4 and ArduPilot give an index also where the name was asked.
    pub(super) fn message(&self, at: usize) -> Option<Message> {
        let parameter = self.list.get(at)?;
        let whole_value = whole(parameter.value);
        let message = Message::new(22);
        let message = match (self.autopilot, parameter.kind) {
            // the bytes of the integer in the place of the float
            (AutopilotKind::Px4, ParameterType::Int32) => message.i32(whole_value),
            _ => message.f32(parameter.value),
        };
        let count = u16::try_from(self.list.len()).unwrap_or(u16::MAX);
        let index = u16::try_from(at).unwrap_or(u16::MAX);
        Some(message.u16(count).u16(index).text(parameter.name.as_bytes(), 16).u8(parameter.kind.mav()))
    }
}

/// Rows of a table as parameters.
fn rows(table: &[Row]) -> impl Iterator<Item = Parameter> + '_ {
    table.iter().map(|(name, kind, value)| Parameter { name: (*name).to_owned(), kind: *kind, value: *value })
}

fn parameter(name: String, kind: ParameterType, value: f64) -> Parameter {
    Parameter { name, kind, value }
}
