//! The effects that the program knows, and how they are made by name.

use crate::physics::{ActiveEffect, Bounds, Effect, Parameter, PhysicsError};
use crate::text::compact;
use crate::vehicle::VehicleSize;

/// All effects that the program knows.
pub static ALL: &[&dyn Effect] = &[
    &super::LinearDrag,
    &super::QuadraticDrag,
    &super::GroundEffect,
    &super::CeilingEffect,
    &super::MotorLag,
    &super::TransportDelay,
    &super::ThrustCurve,
    &super::BatterySag,
    &super::WeakRotor,
    &super::ComOffset,
    &super::ThrustTilt,
    &super::RotorInertia,
    &super::AngularDamping,
    &super::BladeFlapping,
    &super::Inflow,
    &super::TranslationalLift,
    &super::SteadyWind,
    &super::Gust,
    &super::SlungLoad,
    &super::MassChange,
    &super::ImuMisalignment,
    &super::ImuOffset,
    &super::FrameMisalignment,
    &super::Tether,
    &super::VortexRing,
];

/// The effect of this identifier.
#[must_use]
pub fn by_id(id: &str) -> Option<&'static dyn Effect> {
    ALL.iter().copied().find(|effect| effect.id() == id)
}

/// How much wider than in an estimate the bounds of a file are, where they scale with the vehicle.
const WIDER: f64 = 2.0;

fn widened(bounds: &Bounds, size: &VehicleSize) -> (f64, f64) {
    let (least, greatest) = bounds.at(size);
    let times = if bounds.powers() == (0, 0) { 1.0 } else { WIDER };
    (times * least, times * greatest)
}

/// Of which vehicle bounds are that scale with it; nothing where they do not.
fn of_vehicle(bounds: &Bounds, size: &VehicleSize) -> String {
    let mass = format!("{} kg", compact(size.mass_kg));
    match bounds.powers() {
        (0, 0) => String::new(),
        (_, 0) => format!(" for a vehicle of {mass}"),
        _ => format!(" for a vehicle of {mass} with arms of {} m", compact(size.arm_m)),
    }
}

impl ActiveEffect {
    /// By names, as files have them, on a vehicle of this size.
    ///
    /// Bounds that scale with the vehicle are twice as wide here as where an effect is estimated: those are of the
    /// vehicle as it was stated, and a model file holds the mass that was identified.
    ///
    /// # Errors
    /// If there is no such effect, a parameter is missing, unknown, or outside its bounds.
    pub fn named(id: &str, values: &[(&str, f64)], size: &VehicleSize) -> Result<Self, PhysicsError> {
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
        let is_given = |parameter: &Parameter| values.iter().any(|(name, _)| *name == parameter.name);
        let finer = &finer[..finer.iter().rposition(is_given).map_or(0, |last| last + 1)];
        let mut parameters = Vec::with_capacity(names.len());
        for parameter in common.iter().chain(finer) {
            let (least, greatest) = widened(&parameter.bounds, size);
            let range = format!(
                "{} to {} {}{}",
                compact(least),
                compact(greatest),
                parameter.unit,
                of_vehicle(&parameter.bounds, size)
            );
            match values.iter().find(|(name, _)| *name == parameter.name) {
                Some((_, value)) if (least..=greatest).contains(value) => parameters.push(*value),
                Some((_, value)) => return refuse(parameter.name, range, value.to_string()),
                None => return refuse(parameter.name, range, "nothing".to_owned()),
            }
        }
        Ok(Self { effect, parameters })
    }
}
