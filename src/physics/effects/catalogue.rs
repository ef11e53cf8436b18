//! The effects that the program knows, and how they are made by name.

use crate::physics::{ActiveEffect, Bounds, Effect, Parameter, PhysicsError, REFERENCE_SIZE};
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

/// The bounds of a file; on a vehicle of unknown size none where they scale with it.
fn widened(bounds: &Bounds, size: Option<&VehicleSize>) -> Option<(f64, f64)> {
    if bounds.powers() == (0, 0) {
        return Some(bounds.at(size.unwrap_or(&REFERENCE_SIZE)));
    }
    let (least, greatest) = bounds.at(size?);
    Some((WIDER * least, WIDER * greatest))
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

/// What a file may say of a parameter.
fn expected(parameter: &Parameter, size: Option<&VehicleSize>) -> String {
    let bounds = &parameter.bounds;
    let in_unit = if parameter.unit == "-" { String::new() } else { format!(" {}", parameter.unit) };
    match widened(bounds, size) {
        Some((least, greatest)) => {
            let of = size.map_or_else(String::new, |size| of_vehicle(bounds, size));
            format!("{} to {}{in_unit}{of}", compact(least), compact(greatest))
        }
        None if in_unit.is_empty() => "a number".to_owned(),
        None => format!("a number in{in_unit}"),
    }
}

impl ActiveEffect {
    /// By names, as files have them, on a vehicle of this size.
    ///
    /// Bounds that scale with the vehicle are twice as wide here as where an effect is estimated: those are of the
    /// vehicle as it was stated, and a model file holds the mass that was identified.
    ///
    /// # Errors
    /// If there is no such effect, a parameter is missing, unknown, or outside its bounds. The first of these.
    pub fn named(id: &str, values: &[(&str, f64)], size: &VehicleSize) -> Result<Self, PhysicsError> {
        Self::checked(id, values, Some(size)).map_err(|(first, _)| first)
    }

    /// As [`ActiveEffect::named`], with everything that is wrong at once. On a vehicle of unknown size, bounds that scale with
    /// it are not checked.
    ///
    /// # Errors
    /// As [`ActiveEffect::named`]: the first, and all others.
    pub fn checked(
        id: &str,
        values: &[(&str, f64)],
        size: Option<&VehicleSize>,
    ) -> Result<Self, (PhysicsError, Vec<PhysicsError>)> {
        let effect = by_id(id).ok_or_else(|| {
            let expected = ALL.iter().map(|e| e.id()).collect::<Vec<_>>().join(", ");
            (PhysicsError::UnknownEffect { id: id.to_owned(), expected }, Vec::new())
        })?;
        let refused = |name: &str, expected: String, got: String| PhysicsError::EffectParameter {
            id: effect.id(),
            name: name.to_owned(),
            expected,
            got,
        };
        let (common, finer) = (effect.parameters(), effect.finer_parameters());
        let names: Vec<_> = common.iter().chain(finer).map(|parameter| parameter.name).collect();
        let unknown = values.iter().filter(|(name, _)| !names.contains(name));
        let mut wrong: Vec<_> = unknown
            .map(|(name, _)| {
                refused(name, format!("one of {}", names.join(", ")), "an unknown name".to_owned())
            })
            .collect();
        let is_given = |parameter: &Parameter| values.iter().any(|(name, _)| *name == parameter.name);
        let finer = &finer[..finer.iter().rposition(is_given).map_or(0, |last| last + 1)];
        let mut parameters = Vec::with_capacity(names.len());
        for parameter in common.iter().chain(finer) {
            let (least, greatest) =
                widened(&parameter.bounds, size).unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
            let came = match values.iter().find(|(name, _)| *name == parameter.name) {
                Some((_, value)) if (least..=greatest).contains(value) => {
                    parameters.push(*value);
                    continue;
                }
                Some((_, value)) => value.to_string(),
                None => "nothing".to_owned(),
            };
            wrong.push(refused(parameter.name, expected(parameter, size), came));
        }
        let mut wrong = wrong.into_iter();
        match wrong.next() {
            Some(first) => Err((first, wrong.collect())),
            None => Ok(Self { effect, parameters }),
        }
    }
}
