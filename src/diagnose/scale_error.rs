//! How unsure the scale of force is where the stated thrust curve does not hold.

use super::base::Base;
use super::signature::EffectTerm;
use crate::vehicle::{Guessed, Vehicle};

/// Relative error of a law's thrust at hover by its curvature there, the middle of 1.0 to 1.7: a law with another curvature about hover is
/// elsewhere there by so much, at hover at 60 to 40 % of full thrust.
const ELSEWHERE: f64 = 1.35;
/// Relative standard error of the mass that a vehicle file states. Set by judgement: a battery is a third of the mass of a multirotor, and
/// another one weighs up to a fifth more or less.
pub const STATED_MASS: f64 = 0.07;

/// Relative standard error of the thrust, and of all that is on its scale, where the stated law does not hold and nothing was weighed.
pub(super) fn of_scale(base: &Base) -> f64 {
    let by_curve = of_curve(base);
    match base.weighed_kg {
        Some(_) => 0.0,
        None => base.stated_mass_differs.map_or(by_curve, |differs| {
            // a mean of what differs by more than its errors is as unsure as it differs (Birge 1932)
            by_curve * (1.0 - share_of_mass(by_curve)).sqrt() * differs.abs().max(1.0)
        }),
    }
}

/// Curvature of the bent thrust curve of a model, -; 0 without one.
pub(super) fn bend_of(base: &Base) -> f64 {
    let bend = |term: &EffectTerm| Some(term.values[term.signature.role.bends_thrust?].abs());
    base.effects.iter().filter_map(bend).sum()
}

/// Relative standard error of the stated thrust at hover by the bend of a model.
pub(super) fn of_curve(base: &Base) -> f64 {
    ELSEWHERE * bend_of(base)
}

/// Relative standard error that the scale of the stated thrust alone has beyond that of a settled model; 0 of others.
pub(super) fn beyond_stated_mass(base: &Base) -> f64 {
    if base.stated_mass_differs.is_none() {
        return 0.0;
    }
    (of_curve(base).powi(2) - of_scale(base).powi(2)).max(0.0).sqrt()
}

/// By how many standard errors of both the stated mass and the mass by the stated thrust differ, where the thrust curve of the model is bent; `None` of
/// other models, where the vehicle was weighed, and where the thrust is a guess.
#[must_use]
pub fn stated_mass_differs(base: &Base, stated: &Vehicle) -> Option<f64> {
    let by_curve = of_curve(base);
    let apart = (stated.body.mass_kg / base.vehicle.body.mass_kg).ln();
    let is_told = by_curve > 0.0 && base.weighed_kg.is_none() && stated.guessed(Guessed::ThrustMax) == 0.0;
    is_told.then(|| apart / by_curve.hypot(STATED_MASS))
}

/// Weight of the stated mass beside the stated thrust, each by its variance.
pub(super) fn share_of_mass(by_curve: f64) -> f64 {
    by_curve.powi(2) / (by_curve.powi(2) + STATED_MASS.powi(2))
}
