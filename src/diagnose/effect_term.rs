//! Values of an effect as a term of the model.

use super::signature::{EffectTerm, Growth, Signature};
use crate::physics::{Effect, Hook, Parameter};
use crate::vehicle::VehicleSize;

impl EffectTerm {
    /// Its equation.
    #[must_use]
    pub fn effect(&self) -> &'static dyn Effect {
        self.signature.effect
    }

    /// Its identifier.
    #[must_use]
    pub fn id(&self) -> &'static str {
        self.signature.effect.id()
    }

    /// Whether it is the effect of this signature.
    #[must_use]
    pub fn is(&self, signature: &Signature) -> bool {
        self.id() == signature.id()
    }

    /// The parameter of a slot of the values; `None` beyond the last.
    #[must_use]
    pub fn parameter(&self, slot: usize) -> Option<&'static Parameter> {
        self.effect().parameters().iter().chain(self.effect().finer_parameters()).nth(slot)
    }

    /// The value nearest to this that is plausible on a vehicle of this size.
    #[must_use]
    pub fn possible(&self, slot: usize, value: f64, size: &VehicleSize) -> f64 {
        self.parameter(slot).map_or(value, |parameter| {
            let (least, greatest) = parameter.bounds.at(size);
            value.clamp(least, greatest)
        })
    }

    /// Whether a value is the least or the greatest that is plausible on a vehicle of this size.
    pub(super) fn is_at_bound(&self, slot: usize, size: &VehicleSize) -> bool {
        self.parameter(slot).is_some_and(|parameter| {
            let (least, greatest) = parameter.bounds.at(size);
            self.values[slot] <= least || self.values[slot] >= greatest
        })
    }

    /// The same of a value that is not that of no effect: what ends there is something else.
    pub(super) fn ends_at_bound(&self, slot: usize, size: &VehicleSize) -> bool {
        self.is_at_bound(slot, size) && self.values[slot] != self.nothing_at(slot)
    }

    /// Whether a parameter is an amount of the effect; the others describe its form.
    #[must_use]
    pub fn is_amount(&self, slot: usize) -> bool {
        self.signature.amounts.contains(&slot)
    }

    /// Whether the effect is proportional to a parameter, or nearly so: its slope by a small step is the same to either side.
    pub(super) fn is_proportional_to(&self, slot: usize) -> bool {
        self.is_amount(slot) && self.signature.growth == Growth::Proportional
    }

    /// Estimates the amounts as well that another one of the same effect does, from the other one's values on.
    pub(super) fn free_amounts_of(&mut self, other: &Self) {
        for &slot in other.free.iter().filter(|slot| other.is_amount(**slot)) {
            if !self.free.contains(&slot) {
                self.values[slot] = other.values[slot];
                self.free.push(slot);
            }
        }
        self.free.sort_unstable();
    }

    /// Whether it changes what sensors show and nothing else: how much force that makes says nothing of its size.
    pub(super) fn is_of_sensors(&self) -> bool {
        self.effect().hooks() == [Hook::Sensors]
    }

    /// Whether every vehicle of this size has as much of it: it has no name, and stays in the model where it is certain and no rotor is weak.
    pub(super) fn is_of_every_vehicle(&self, size: &VehicleSize) -> bool {
        self.size() < self.signature.naming.least_of_arm * size.arm_m
    }

    /// Whether a parameter is the share of a force that acts at the rotors' hubs: it shows only in torques.
    pub(super) fn is_share_at_hubs(&self, slot: usize) -> bool {
        self.parameter(slot).is_some_and(|parameter| parameter.name == "at_hubs")
    }

    /// Value of a parameter at which the effect vanishes.
    #[must_use]
    pub fn nothing_at(&self, slot: usize) -> f64 {
        if self.is_amount(slot) { self.signature.nothing } else { 0.0 }
    }

    /// Distance of a parameter from the value at which its effect vanishes, in its unit: the factor of its column in
    /// the effect.
    #[must_use]
    pub fn from_nothing(&self, slot: usize) -> f64 {
        match self.inverse_usual(slot) {
            // it divides: nothing lies at infinity, and the distance to it is in the inverse
            Some(_) => -self.values[slot],
            None => self.values[slot] - self.nothing_at(slot),
        }
    }

    /// This distance in standard errors of `std`.
    #[must_use]
    pub fn away_from_nothing(&self, slot: usize, std: f64) -> f64 {
        self.from_nothing(slot) / std.max(f64::MIN_POSITIVE)
    }

    /// Value of the parameter after a change of its column's coefficient by `by`.
    pub(super) fn moved_to(&self, slot: usize, by: f64) -> f64 {
        let from = self.values[slot];
        match self.inverse_usual(slot).filter(|_| from == self.nothing_at(slot)) {
            // so much of a usual one's, and the effect goes with the inverse
            Some(usual) => {
                let share = by / (usual - from);
                if share > 0.0 { usual / share } else { from }
            }
            None => from + by,
        }
    }

    /// Step of a parameter for numerical derivatives, in its unit.
    pub(super) fn step_of(&self, slot: usize, size: &VehicleSize) -> f64 {
        let at_nothing = self.values[slot] == self.nothing_at(slot);
        if let Some(usual) = self.inverse_usual(slot).filter(|_| at_nothing) {
            // it is taken to a usual one's at once: its slope at nothing leads nowhere
            return usual - self.values[slot];
        }
        let span = self.parameter(slot).map_or(1.0, |parameter| {
            let (least, greatest) = parameter.bounds.at(size);
            (greatest - least).min(1.0)
        });
        (1e-4 * span).max(1e-3 * self.values[slot].abs())
    }

    /// The usual amount of a slot whose inverse is the effect's size.
    fn inverse_usual(&self, slot: usize) -> Option<f64> {
        match self.signature.growth {
            Growth::Inverse { usual } if self.is_amount(slot) => Some(usual),
            _ => None,
        }
    }

    /// Whether it is a change at one moment, and was before this time, s.
    pub(super) fn is_before(&self, time_s: Option<f64>) -> bool {
        let moment_s = self.signature.role.moment.map(|slot| self.values[slot]);
        moment_s.zip(time_s).is_some_and(|(moment_s, time_s)| moment_s <= time_s)
    }

    /// Norm of the amounts that are estimated.
    #[must_use]
    pub fn size(&self) -> f64 {
        let amounts = self.free.iter().filter(|slot| self.is_amount(**slot));
        amounts.map(|&slot| self.values[slot].powi(2)).sum::<f64>().sqrt()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test ends where it fails")]
    use crate::diagnose::signatures::signature_of;
    use crate::simulate::random_vehicle;

    #[test]
    fn every_vehicle_has_a_little_of_a_centre_of_mass_that_is_off_and_of_nothing_else() {
        let size = random_vehicle(1).nominal.size();
        let of = |id: &str, amount: f64| {
            let term = signature_of(id).unwrap().term(&[amount, 0.0, 0.0], &[0, 1]);
            term.is_of_every_vehicle(&size)
        };
        assert!(of("com_offset", 0.005 * size.arm_m) && !of("com_offset", 0.02 * size.arm_m));
        assert!(!of("linear_drag", 1e-6));
    }
}
