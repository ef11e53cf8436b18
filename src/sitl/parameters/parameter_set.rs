//! All parameters of an autopilot, by name.

use std::collections::BTreeMap;

use mavlink::dialects::ardupilotmega::PARAM_VALUE_DATA;

use super::parameter::Parameter;
use super::pulses::Pulses;
use super::{ardupilot, px4};
use crate::autopilot::{ParameterType, Reaction};
use crate::sitl::battery::Battery;
use crate::sitl::message::Message;
use crate::sitl::{Firmware, Settings, SitlError};
use crate::units::{narrow, whole};
use crate::wire::Payload;

/// All parameters, by name.
#[derive(Debug)]
pub(in crate::sitl) struct Parameters {
    autopilot: Firmware,
    list: Vec<Parameter>,
    index: BTreeMap<String, usize>,
}

impl Parameters {
    /// The autopilot's defaults with the values of the settings.
    ///
    /// # Errors
    /// If the settings name a parameter that this autopilot does not have.
    pub(in crate::sitl) fn new(settings: &Settings) -> Result<Self, SitlError> {
        let pulses = Pulses::of(&settings.vehicle, settings.autopilot);
        let (vehicle, system, release) = (settings.believed(), settings.system, settings.autopilot.release());
        let mut list = if settings.autopilot.is_px4() {
            px4::defaults(vehicle, &pulses, system, release)
        } else {
            ardupilot::defaults(vehicle, &pulses, system, release)
        };
        list.sort_by(|a, b| a.name.cmp(&b.name));
        let index = list.iter().enumerate().map(|(at, parameter)| (parameter.name.clone(), at)).collect();
        let mut all = Self { autopilot: settings.autopilot, list, index };
        // a battery of this voltage, with its lines at the same shares as PX4's
        for (name, remaining) in [("BATT_LOW_VOLT", 0.15), ("BATT_CRT_VOLT", 0.07)] {
            all.set(name, Battery::volts_at(settings.battery_v, remaining));
        }
        for (name, value) in &settings.taken_over {
            // those of another release, or of what is not simulated, are left out
            all.set(name, *value);
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

    pub(in crate::sitl) fn len(&self) -> usize {
        self.list.len()
    }

    /// Name, type and value of each.
    pub(in crate::sitl) fn all(&self) -> impl Iterator<Item = (&str, ParameterType, f64)> {
        self.list.iter().map(|parameter| (parameter.name.as_str(), parameter.kind, parameter.value))
    }

    /// Type and value of one.
    pub(in crate::sitl) fn get(&self, at: usize) -> Option<(ParameterType, f64)> {
        self.list.get(at).map(|parameter| (parameter.kind, parameter.value))
    }

    pub(in crate::sitl) fn find(&self, name: &str) -> Option<usize> {
        self.index.get(name).copied()
    }

    /// Value of a parameter; zero where this autopilot has none of that name.
    pub(in crate::sitl) fn value(&self, name: &str) -> f64 {
        self.find(name).map_or(0.0, |at| self.list[at].value)
    }

    /// Value in its base unit (SI, but degrees for angles) of a parameter by its older name, under whichever name it has;
    /// zero where this autopilot has none of that name.
    pub(in crate::sitl) fn in_base_unit(&self, name: &str) -> f64 {
        let table = &self.autopilot.stack().parameters;
        let Some(entry) = table.find(name) else { return 0.0 };
        let factor = 1.0 / entry.unit.per_base;
        match table.renames_of(name).find(|renamed| self.find(renamed.new).is_some()) {
            Some(renamed) => self.value(renamed.new) * (renamed.scale * factor),
            None => self.value(name) * factor,
        }
    }

    /// What a failsafe's parameter (older name) asks for; nothing for a value without a meaning.
    pub(in crate::sitl) fn reaction(&self, name: &str) -> Reaction {
        let choice =
            self.autopilot.stack().failsafe(name).and_then(|failsafe| failsafe.choice(self.value(name)));
        choice.map_or(Reaction::Nothing, |choice| choice.reaction)
    }

    /// Sets a value as the parameter's type holds it; false where there is none of that name.
    pub(in crate::sitl) fn set(&mut self, name: &str, value: f64) -> bool {
        let Some(parameter) = self.find(name).and_then(|at| self.list.get_mut(at)) else { return false };
        parameter.value = match parameter.kind {
            ParameterType::Real32 => narrow(value).into(),
            _ => whole(value).into(),
        };
        true
    }

    /// What the autopilot's controllers make of values that they cannot use, and what is said of it: PX4's hover thrust stays
    /// within its least and its largest thrust. Nothing where they can use all.
    pub(in crate::sitl) fn constrain(&mut self) -> Option<&'static str> {
        if !self.autopilot.is_px4() {
            return None;
        }
        let [hover, least, most] =
            ["MPC_THR_HOVER", "MPC_THR_MIN", "MPC_THR_MAX"].map(|name| self.value(name));
        let usable = hover.min(most).max(least);
        (usable != hover).then(|| self.set("MPC_THR_HOVER", usable))?;
        Some("Hover thrust has been constrained by min/max thrust")
    }

    /// What a PARAM_SET of this type and these bytes asks for; `None` where PX4 refuses the type.
    pub(in crate::sitl) fn decode(&self, at: usize, kind: u8, payload: Payload) -> Option<f64> {
        let parameter = self.list.get(at)?;
        match self.autopilot.is_px4() {
            true if u32::from(kind) != parameter.kind.mav() as u32 => None,
            true if parameter.kind != ParameterType::Real32 => Some(payload.i32(0).into()),
            _ => Some(payload.f32(0)).filter(|value| value.is_finite()),
        }
    }

    /// PARAM_VALUE. `index` as asked for: PX4 and ArduPilot give an index also where the name was asked.
    pub(in crate::sitl) fn message(&self, at: usize) -> Option<Message> {
        let parameter = self.list.get(at)?;
        let param_value = match (self.autopilot.is_px4(), parameter.kind) {
            // the bytes of the integer in the place of the float
            (true, ParameterType::Int32) => f32::from_le_bytes(whole(parameter.value).to_le_bytes()),
            _ => narrow(parameter.value),
        };
        Some(Message::from(PARAM_VALUE_DATA {
            param_value,
            param_count: u16::try_from(self.list.len()).unwrap_or(u16::MAX),
            param_index: u16::try_from(at).unwrap_or(u16::MAX),
            param_id: parameter.name.as_str().into(),
            param_type: parameter.kind.mav(),
        }))
    }
}
