//! The model as the writers read it, and the file that they make of it.

use super::cost::Costs;
use super::error::ExportError;
use super::program::EffectsProgram;
use crate::diagnose::called;
use crate::physics::effects::by_id;
use crate::physics::{ActiveEffect, Airframe, Parameter};
use crate::text::{compact, list};
use crate::vehicle::{Guess, ThrustLaw, Vehicle};
use nalgebra::Vector3;
use std::f64::consts::TAU;
use toml::{Table, Value};

/// Static thrust coefficient of a usual propeller of small multirotors, `T / (rho n^2 D^4)`: 0.08 to 0.12 in the propeller database of the
/// University of Illinois.
const USUAL_THRUST_COEFFICIENT: f64 = 0.1;
/// Density of the standard atmosphere at sea level, kg/m^3.
const AIR_KG_M3: f64 = 1.225;

/// The effect of a rotor that gives less.
const WEAK_ROTOR: &str = "weak_rotor";
/// The effects between a command and its thrust.
const LATENCIES: [&str; 2] = ["motor_lag", "transport_delay"];
/// Latency below which none is lost, s.
const LEAST_LATENCY_S: f64 = 0.005;

/// Lag that is nearly none, s, for formats that need one.
pub(super) const FAST_S: f64 = 0.001;

/// The model as the writers read it; what they do not take is told at the end.
pub(super) struct Source<'a> {
    pub(super) vehicle: &'a Vehicle,
    pub(super) airframe: Airframe,
    /// height of the flight's place above the sea, m, if it is known
    pub(super) altitude_m: Option<f64>,
    /// share of the gyroscopic torque that acts in the simulator
    gyroscopic: f64,
    effects: &'a [ActiveEffect],
    /// effects that were identified, by the model's file; `None` where it does not say
    named: Option<&'a Table>,
    costs: Costs<'a>,
    taken: Vec<&'static str>,
    left_out: Vec<String>,
    callback: Option<Callback>,
}

impl<'a> Source<'a> {
    pub(super) fn new(
        vehicle: &'a Vehicle,
        effects: &'a [ActiveEffect],
        identified: Option<&'a Table>,
    ) -> Result<Self, ExportError> {
        let airframe = Airframe::new(vehicle)?;
        let costs = Costs::of(identified);
        let named = identified.and_then(|table| table.get("effects")?.as_table());
        Ok(Self {
            vehicle,
            airframe,
            altitude_m: None,
            gyroscopic: 1.0,
            effects,
            named,
            costs,
            taken: Vec::new(),
            left_out: Vec::new(),
            callback: None,
        })
    }

    /// Tells what of the file no flight determined, and which guesses it rests on.
    pub(super) fn tell_unsure(&mut self, identified: Option<&Table>) {
        let open = |value: &Value| value.get("status").and_then(Value::as_str) == Some("not_determined");
        let named = identified.into_iter().flatten().filter(|(_, value)| open(value));
        let named: Vec<String> = named.map(|(name, _)| name.clone()).collect();
        if !named.is_empty() {
            self.note(format!(
                "the flights did not determine {}: its value here rests on what the vehicle file states or guesses (the model file says why)",
                list(&named)
            ));
        }
        let guess = |guess: &Guess| format!("{} +- {:.0} %", guess.of.words(), 100.0 * guess.relative);
        let guesses: Vec<String> = self.vehicle.guesses.iter().map(guess).collect();
        if !guesses.is_empty() {
            self.note(format!("rests on guesses: {}", guesses.join(", ")));
        }
    }

    /// The simulator turns a body without its gyroscopic torque.
    pub(super) fn turns_without_gyroscopic(&mut self) {
        self.gyroscopic = 0.0;
    }

    /// Gives effects that the file cannot hold to a program beside it.
    pub(super) fn call_back(&mut self, callback: Callback) {
        self.callback = Some(callback);
    }

    /// An effect's parameter, 0 where the model does not have the effect; it counts as carried over.
    pub(super) fn take(&mut self, id: &'static str, parameter: &str) -> f64 {
        self.take_or(id, parameter, 0.0)
    }

    /// [`Self::take`], `missing` where the model does not have the effect or does not state the parameter.
    pub(super) fn take_or(&mut self, id: &'static str, parameter: &str, missing: f64) -> f64 {
        self.taken.push(id);
        self.value(id, parameter).unwrap_or(missing)
    }

    /// An effect's parameter, where the model has the effect; it is not carried over by that.
    pub(super) fn value(&self, id: &str, parameter: &str) -> Option<f64> {
        let active = self.effects.iter().find(|active| active.effect().id() == id)?;
        let names = active.effect().parameters().iter().chain(active.effect().finer_parameters());
        names.zip(active.parameters()).find(|(p, _)| p.name == parameter).map(|(_, value)| *value)
    }

    /// An effect was looked at and this simulator cannot hold it: it is told as left out.
    pub(super) fn refuse(&mut self, id: &'static str) {
        self.taken.retain(|taken| *taken != id);
    }

    pub(super) fn has(&self, id: &str) -> bool {
        self.effects.iter().any(|active| active.effect().id() == id)
    }

    pub(super) fn note(&mut self, text: impl Into<String>) {
        self.left_out.push(text.into());
    }

    /// What was told so far.
    pub(super) fn notes(&self) -> &[String] {
        &self.left_out
    }

    /// s, lag of a rotor that speeds up and of one that slows down: of the effect, else what the vehicle's file
    /// knows.
    pub(super) fn lags_s(&mut self) -> Option<(f64, f64)> {
        if self.has("motor_lag") {
            let up_s = self.take("motor_lag", "time_constant");
            return Some((up_s, self.take_or("motor_lag", "time_constant_down", up_s)));
        }
        let propulsion = &self.vehicle.propulsion;
        let up_s = propulsion.time_constant_s.filter(|up_s| *up_s > 0.0)?;
        Some((up_s, propulsion.time_constant_down_s.unwrap_or(up_s)))
    }

    /// s, of a simulator that has one lag: the mean of both, which is told where they differ.
    pub(super) fn mean_lag_s(&mut self) -> Option<f64> {
        let (up_s, down_s) = self.lags_s()?;
        let mean_s = f64::midpoint(up_s, down_s);
        if (up_s - down_s).abs() > 0.01 * mean_s {
            self.note(format!(
                "the simulator's rotors speed up and slow down alike: {} s, the mean of {} s and {} s",
                compact(mean_s),
                compact(up_s),
                compact(down_s)
            ));
        }
        Some(mean_s)
    }

    /// Centre of mass in the frame of the rotor positions, m, with the offset that was found.
    pub(super) fn center_of_mass_m(&mut self) -> Vector3<f64> {
        let offset = ["x", "y", "z"].map(|axis| self.take("com_offset", axis));
        self.vehicle.body.center_of_mass_m + Vector3::from(offset)
    }

    /// Hubs from the centre of mass, m, body FLU.
    pub(super) fn arms_m(&mut self) -> Vec<Vector3<f64>> {
        let center = self.center_of_mass_m();
        self.vehicle.rotors.iter().map(|rotor| rotor.position_m - center).collect()
    }

    /// Thrust and torque of each rotor over those of an ordinary one, by the rotors that were found weak.
    pub(super) fn rotor_factors(&mut self) -> Vec<f64> {
        self.taken.push(WEAK_ROTOR);
        let mut factors = vec![1.0; self.vehicle.rotors.len()];
        for active in self.effects.iter().filter(|active| active.effect().id() == WEAK_ROTOR) {
            let value = |name: &str| {
                let mut named = active.effect().parameters().iter().zip(active.parameters());
                named.find(|(parameter, _)| parameter.name == name).map(|(_, value)| *value)
            };
            let (Some(rotor), Some(factor)) = (value("rotor"), value("factor")) else { continue };
            let weak =
                factors.iter_mut().enumerate().filter(|(index, _)| (*index as f64 - rotor).abs() < 0.5);
            weak.for_each(|(_, of)| *of *= factor);
        }
        factors
    }

    /// N, one rotor at full command.
    pub(super) fn thrust_max_n(&self) -> f64 {
        self.vehicle.propulsion.thrust_from_command_n(1.0)
    }

    /// N/(rad/s)^2 and rad/s at full command. Where no rotor's speed is known they are those of a usual propeller, and that is told.
    pub(super) fn speeds(&mut self, format: &'static str) -> Result<(f64, f64), ExportError> {
        let coefficient = match self.vehicle.propulsion.thrust_coefficient {
            Some(coefficient) => coefficient,
            None => self.usual_coefficient(format)?,
        };
        let speed_max = match self.vehicle.propulsion.law {
            ThrustLaw::Speed { speed_max_rad_s } => speed_max_rad_s,
            ThrustLaw::Curve { thrust_max_n, .. } => (thrust_max_n / coefficient).sqrt(),
        };
        Ok((coefficient, speed_max))
    }

    /// rad/s of each rotor at hover, for this coefficient, N/(rad/s)^2.
    pub(super) fn hover_rad_s(&self, coefficient: f64) -> f64 {
        (self.airframe.hover_thrust_n / coefficient).sqrt()
    }

    /// N/(rad/s)^2 of a usual propeller of the rotors' radius: `T = C_T rho n^2 D^4`.
    fn usual_coefficient(&mut self, format: &'static str) -> Result<f64, ExportError> {
        let radius_m = self.vehicle.propulsion.rotor_radius_m.ok_or(ExportError::Missing {
            format,
            what: "rotor_radius, from which usual rotor speeds follow, or thrust_coefficient (thrust by rotor speed, from a rotor's \
                   measured speed)",
        })?;
        let revolution = TAU * TAU;
        let coefficient = USUAL_THRUST_COEFFICIENT * AIR_KG_M3 * (2.0 * radius_m).powi(4) / revolution;
        self.note(format!(
            "no rotor's speed is known: speeds are those of a usual propeller of {radius_m} m radius (C_T {USUAL_THRUST_COEFFICIENT}), {:.0} \
             rad/s at hover. Thrust and torque are the model's at every command, and do not depend on them; measure a rotor's speed at hover \
             and state thrust_coefficient in [propulsion] for true ones",
            self.hover_rad_s(coefficient)
        ));
        Ok(coefficient)
    }

    /// What one of several flights has alone, by the model's file: the model does not have it, so no file that is written can.
    fn of_one_flight(&self) -> Vec<String> {
        let of = |(id, table): (&String, &Value)| {
            let flight = table.get("flight").and_then(Value::as_str);
            // models of before this key have no other effect that is named and not in the model
            if self.has(id) || flight.is_none() && id != WEAK_ROTOR {
                return None;
            }
            let effect = by_id(id)?;
            let value = |parameter: &Parameter| number(table.get(parameter.name)?.get("value")?);
            let values: Option<Vec<f64>> = effect.parameters().iter().map(value).collect();
            let active = values.and_then(|values| ActiveEffect::new(effect, &values).ok());
            let values =
                active.map_or_else(String::new, |active| format!(": {}", self.values(&active).join(", ")));
            let flight = flight.unwrap_or("one of the flights");
            Some(format!(
                "{id} was found in {flight} alone{values}; the model does not have it, and so it is not in this file"
            ))
        };
        self.named.into_iter().flatten().filter_map(of).collect()
    }

    /// Done: what was not taken is told, with what it costs.
    pub(super) fn finish(mut self, write: impl FnOnce(&[String]) -> String) -> Exported {
        let of_one_flight = self.of_one_flight();
        self.left_out.splice(0..0, of_one_flight);
        for active in self.effects {
            let id = active.effect().id();
            if self.taken.contains(&id) || self.is_no_latency(active) {
                continue;
            }
            let lost =
                format!("{} cannot be represented here: {}", called(id), self.values(active).join(", "));
            let instead = match &self.callback {
                Some(callback) if callback.ids.contains(&id) => callback.whither.to_owned(),
                _ => self.costs.words(id),
            };
            self.left_out.push(format!("{lost}; {instead}"));
        }
        self.left_out.extend(of_gyroscopic(self.vehicle.body.gyroscopic, self.gyroscopic));
        let callback = self.callback.map(|callback| callback.program);
        Exported { text: write(&self.left_out), left_out: self.left_out, callback }
    }

    /// Whether this is a latency that nobody found: one without a name, or below [`LEAST_LATENCY_S`]. A model holds it beside the
    /// one that has the name.
    fn is_no_latency(&self, active: &ActiveEffect) -> bool {
        let id = active.effect().id();
        let is_slight = || active.parameters().first().is_some_and(|latency_s| *latency_s < LEAST_LATENCY_S);
        LATENCIES.contains(&id) && (self.named.is_some_and(|named| !named.contains_key(id)) || is_slight())
    }

    /// The parameters of an effect in words; a rotor by the autopilot's number and its place.
    fn values(&self, active: &ActiveEffect) -> Vec<String> {
        let word =
            |(parameter, value): (&Parameter, &f64)| match (parameter.name, self.vehicle.rotor_of(*value)) {
                (_, Some(index)) if parameter.is_rotor() => self.vehicle.motor_words(index),
                (name, _) if parameter.unit == "-" => format!("{name} = {}", compact(*value)),
                (name, _) => format!("{name} = {} {}", compact(*value), parameter.unit),
            };
        active.effect().parameters().iter().zip(active.parameters()).map(word).collect()
    }
}

/// A number, written as a whole one or not.
fn number(value: &Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64))
}

/// Difference of two shares of the gyroscopic torque that is none. The torque itself is about 5 % of all.
const SAME_SHARE: f64 = 0.1;

/// What is lost of the model's share of the gyroscopic torque in a simulator in which another acts.
fn of_gyroscopic(of_model: f64, of_simulator: f64) -> Option<String> {
    if (of_model - of_simulator).abs() < SAME_SHARE {
        return None;
    }
    Some(if of_simulator == 0.0 {
        format!(
            "the simulator has no gyroscopic torque w x J w, and in the model a share of {of_model:.2} acts: \
             `mavid identify` and `mavid explain` estimate the share that acts in a log of the simulator; the paper's methods and \
             WEAK take it to be 1 there, and get an izz near ixx and iyy from a flight that turns while it tilts"
        )
    } else {
        format!(
            "a share of {of_model:.2} of the gyroscopic torque w x J w cannot be represented here: in the simulator the whole of it acts"
        )
    })
}

/// A program that does in a simulator what its file cannot hold.
pub(super) struct Callback {
    /// of the effects
    pub(super) ids: Vec<&'static str>,
    /// words for where they are
    pub(super) whither: &'static str,
    /// what does it
    pub(super) program: EffectsProgram,
}

/// A file, and what of the model is not in it.
#[derive(Debug, Clone, PartialEq)]
pub struct Exported {
    /// the file
    pub text: String,
    /// sentence by sentence; they stand in the file as comments too
    pub left_out: Vec<String>,
    /// a program in Python that does what the file cannot hold, where there is one
    pub callback: Option<EffectsProgram>,
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test ends where it fails")]
    use super::*;

    #[test]
    fn a_share_of_the_gyroscopic_torque_is_lost_where_another_acts() {
        // the model's own simulator, with the error of the share, and a rigid body in a rigid body's
        assert!(of_gyroscopic(0.0, 0.0).is_none() && of_gyroscopic(0.04, 0.0).is_none());
        assert!(of_gyroscopic(1.0, 1.0).is_none());
        assert!(of_gyroscopic(0.0, 1.0).unwrap().starts_with("a share of 0.00 of the gyroscopic torque"));
        assert!(of_gyroscopic(1.0, 0.0).unwrap().contains("a share of 1.00 acts"));
    }
}
