//! What a flight could have shown: the smallest size of each effect that stands out of it, against the size that
//! the effect has on ordinary vehicles.
//!
//! A flight that could not have shown an effect of ordinary size says nothing about it, neither that it is there
//! nor that it is not: in hover the air's forces, the damping and the ground's effect are below what a sensor's
//! noise makes, and what fits them is noise.

use super::base::Present;
use super::candidates::Candidate;
use super::explanation::DetectionLimit;
use super::fit::Fitted;
use super::gates::{Gates, ordinary_size};
use super::tested::Tested;
use crate::vehicle::Vehicle;

/// Standard errors at which an effect stands out.
const CERTAIN: f64 = 4.0;
/// and at which it does whatever its usual size.
const PLAIN: f64 = 8.0;
/// A centre of mass is not known better, m.
pub(super) const COM_NUISANCE_M: f64 = 0.000_15;

/// The smallest coefficient that this flight would have shown, for every candidate that was not named.
pub(super) fn limits(last: &[Tested], vehicle: &Vehicle) -> Vec<DetectionLimit> {
    let mut out: Vec<DetectionLimit> = Vec::new();
    // a ceiling's a1 has no smallest size: it divides; and the ground's is told in its first form
    let second_form = |part: &Present| part.effect.id() == "ground_effect" && part.free == [1];
    let has_size = |tested: &&Tested| {
        let Candidate { id, parts, through } = &tested.candidate;
        through.is_none() && *id != "ceiling_effect" && !parts.iter().any(second_form)
    };
    for tested in last.iter().filter(has_size) {
        let Candidate { id, parts, .. } = &tested.candidate;
        // certainty alone is not enough for a name
        let least = if *id == "com_offset" { COM_NUISANCE_M } else { ordinary_size(id).unwrap_or(0.0) };
        for part in parts {
            for &free in &part.free {
                let Some(parameter) = part.parameter(free) else { continue };
                let certain = Gates::default().deviate(id);
                let limit = (certain * least_std(part, free, last)).max(least);
                let same = out.iter_mut().find(|l| l.id == *id && l.parameter == parameter.name);
                match same {
                    Some(same) => same.limit = same.limit.max(limit),
                    None => {
                        let usual = usual_size(id, parameter.name, vehicle);
                        let (parameter, unit) = (parameter.name, parameter.unit);
                        out.push(DetectionLimit { id, parameter, limit, usual, unit });
                    }
                }
            }
        }
    }
    out
}

/// The smallest standard error that a parameter has among the candidates of the same form, which differ in the axes
/// that are estimated: what one of them shows is named.
fn least_std(part: &Present, slot: usize, all: &[Tested]) -> f64 {
    let std = |tested: &Tested| {
        let [of] = tested.candidate.parts.as_slice() else { return None };
        let same = of.effect.id() == part.effect.id() && of.values == part.values;
        let index = of.free.iter().position(|free| *free == slot).filter(|_| same)?;
        Some(tested.evidence.std(index))
    };
    all.iter().filter_map(std).fold(f64::INFINITY, f64::min)
}

/// Size of an effect's parameter on ordinary vehicles, in its unit, of those that show only where the vehicle
/// moves; `None` for all others. They scale with the vehicle: forces with its mass, torques with its inertia.
fn usual_size(id: &str, parameter: &str, vehicle: &Vehicle) -> Option<f64> {
    let mass_kg = vehicle.body.mass_kg;
    let inertia = vehicle.body.inertia_kg_m2;
    Some(match (id, parameter) {
        // 1/s and 1/m
        ("linear_drag", "dx" | "dy" | "dz") => 0.3 * mass_kg,
        ("inflow", "kz") => 0.4 * mass_kg,
        ("quadratic_drag" | "translational_lift", _) => 0.12 * mass_kg,
        ("angular_damping", "bx") => 0.8 * inertia[(0, 0)],
        ("angular_damping", "by") => 0.8 * inertia[(1, 1)],
        ("angular_damping", "bz") => 0.8 * inertia[(2, 2)],
        ("ground_effect", "rho") => 4.0,
        // the same two radii up with a decay of one a radius
        ("ground_effect", "ca") => 0.5,
        ("thrust_curve", "curvature") => 0.15,
        ("slung_load", "mass") => 0.08 * mass_kg,
        _ => return None,
    })
}

/// Whether an effect of a fit, whose first free parameter has this index among the columns, is determined so badly
/// that the flight could not have shown one of usual size.
pub(super) fn is_beyond_showing(fitted: &Fitted, present: &Present, first: usize) -> bool {
    let vehicle = &fitted.base.vehicle;
    let sizes = present.free.iter().enumerate().filter_map(|(index, &slot)| {
        let usual = usual_size(present.effect.id(), present.parameter(slot)?.name, vehicle)?;
        let std = fitted.covariance[(first + index, first + index)].max(0.0).sqrt();
        Some((std, usual))
    });
    let amounts = present.free.iter().enumerate().filter(|(_, slot)| present.is_amount(**slot));
    let plain = amounts.into_iter().any(|(index, &slot)| {
        let std = fitted.covariance[(first + index, first + index)].max(0.0).sqrt();
        present.away_from_nothing(slot, std).abs() > PLAIN
    });
    if plain {
        return false;
    }
    let mut any = false;
    let all = sizes.into_iter().all(|(std, usual)| {
        any = true;
        CERTAIN * std > usual
    });
    any && all
}

/// Nothing that shows only where the vehicle moves could have been seen at its usual size, and nothing of it was
/// found.
pub(super) fn too_little_excitation(after: &Fitted, limits: &[DetectionLimit]) -> bool {
    let vehicle = &after.base.vehicle;
    let moves = |present: &Present| {
        let mut parameters = present.free.iter().filter_map(|&slot| present.parameter(slot));
        parameters.any(|parameter| usual_size(present.effect.id(), parameter.name, vehicle).is_some())
    };
    // a load is swung by the measured motion, in hover by its noise: that shows nothing
    let shown = |limit: &DetectionLimit| {
        limit.id != "slung_load" && limit.usual.is_some_and(|usual| limit.limit < usual)
    };
    !after.base.present.iter().any(moves) && !limits.iter().any(shown)
}
