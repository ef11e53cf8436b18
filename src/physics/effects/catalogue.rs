//! The effects that the program knows, and how they are made by name.

use super::{
    AngularDamping, BatterySag, BladeFlapping, CeilingEffect, ComOffset, FrameMisalignment, GroundEffect,
    Gust, ImuMisalignment, ImuOffset, Inflow, LinearDrag, MassChange, MotorLag, QuadraticDrag, RotorInertia,
    SlungLoad, SteadyWind, Tether, ThrustCurve, ThrustTilt, TranslationalLift, TransportDelay, VortexRing,
    WeakRotor,
};
use crate::physics::{ActiveEffect, Effect, PhysicsError};

/// All effects that the program knows.
pub static ALL: &[&dyn Effect] = &[
    &LinearDrag,
    &QuadraticDrag,
    &GroundEffect,
    &CeilingEffect,
    &MotorLag,
    &TransportDelay,
    &ThrustCurve,
    &BatterySag,
    &WeakRotor,
    &ComOffset,
    &ThrustTilt,
    &RotorInertia,
    &AngularDamping,
    &BladeFlapping,
    &Inflow,
    &TranslationalLift,
    &SteadyWind,
    &Gust,
    &SlungLoad,
    &MassChange,
    &ImuMisalignment,
    &ImuOffset,
    &FrameMisalignment,
    &Tether,
    &VortexRing,
];

/// The effect of this identifier.
#[must_use]
pub fn by_id(id: &str) -> Option<&'static dyn Effect> {
    ALL.iter().copied().find(|effect| effect.id() == id)
}

impl ActiveEffect {
    /// By names, as files have them.
    ///
    /// # Errors
    /// If there is no such effect, a parameter is missing, unknown, or outside its bounds.
    pub fn named(id: &str, values: &[(&str, f64)]) -> Result<Self, PhysicsError> {
        let effect = by_id(id).ok_or_else(|| {
            let expected = ALL.iter().map(|e| e.id()).collect::<Vec<_>>().join(", ");
            PhysicsError::UnknownEffect { id: id.to_owned(), expected }
        })?;
        let refuse = |name: &str, expected: String, got: String| {
            Err(PhysicsError::EffectParameter { id: effect.id(), name: name.to_owned(), expected, got })
        };
        let (common, finer) = (effect.parameters(), effect.finer_parameters());
        let names: Vec<_> = common.iter().chain(finer).map(|parameter| parameter.name).collect();
        if let Some((name, _)) = values.iter().find(|(name, _)| !names.contains(name)) {
            return refuse(name, format!("one of {}", names.join(", ")), "an unknown name".to_owned());
        }
        let is_finer = finer.iter().any(|parameter| values.iter().any(|(name, _)| *name == parameter.name));
        let mut parameters = Vec::with_capacity(names.len());
        for parameter in common.iter().chain(if is_finer { finer } else { &[] }) {
            let range = format!("{} to {} {}", parameter.min, parameter.max, parameter.unit);
            match values.iter().find(|(name, _)| *name == parameter.name) {
                Some((_, value)) if (parameter.min..=parameter.max).contains(value) => {
                    parameters.push(*value)
                }
                Some((_, value)) => return refuse(parameter.name, range, value.to_string()),
                None => return refuse(parameter.name, range, "nothing".to_owned()),
            }
        }
        Ok(Self { effect, parameters })
    }
}
