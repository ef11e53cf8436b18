//! Detection limits: the smallest size of each effect that a flight would have shown, compared with the size on
//! ordinary vehicles.
//!
//! A flight that could not have shown an effect of ordinary size gives no information about it. In hover, for example,
//! aerodynamic forces, damping and ground effect are smaller than the noise, and a fit of them is a fit to noise.

use super::candidates::Candidate;
use super::fit::Fitted;
use super::gates::Gates;
use super::gates::NAME_Z;
use super::materiality::Materiality;
use super::named::DetectionLimit;
use super::recorded::heights_flown_m;
use super::rotor_axes::least_weakness;
use super::signature::EffectTerm;
use super::signatures::signature_of;
use super::slight::BEYOND;
use super::tested::Tested;
use super::trace::Trace;
use crate::vehicle::VehicleSize;

/// Standard errors by which an effect of its usual size must differ from zero: the z of [`Gates`](super::Gates).
const CERTAIN: f64 = NAME_Z;
/// Standard errors at which an effect is accepted whatever its usual size is. Twice what a name needs: then no prior
/// can say otherwise.
const PLAIN: f64 = 8.0;

/// The smallest coefficient that this flight would have shown, for every candidate that was not named.
pub(super) fn limits(traces: &[Trace], last: &[Tested], fitted: &Fitted) -> Vec<DetectionLimit> {
    let vehicle = &fitted.base.vehicle;
    let mut out: Vec<DetectionLimit> = Vec::new();
    let has_size = |tested: &&Tested| {
        let Candidate { parts, through, .. } = &tested.candidate;
        through.is_none() && parts.iter().all(|part| (part.signature.naming.has_limit)(part))
    };
    for tested in last.iter().filter(has_size) {
        let Candidate { id, parts, .. } = &tested.candidate;
        let mut units = tested.evidence.unit_rms.iter();
        let mut coefficients = 0..;
        for part in parts {
            for &free in &part.free {
                let without_name = coefficients
                    .next()
                    .map_or(0.0, |index| seen((tested, part), (index, free), &vehicle.size()));
                let material =
                    units.next().map_or(0.0, |unit| Materiality::of_rms(unit, fitted).times_to_matter());
                let Some(parameter) = part.parameter(free) else { continue };
                let naming = &part.signature.naming;
                // certainty alone is not enough for a name
                let over = if naming.by_height { heights_flown_m(traces) } else { 1.0 };
                let of_size = naming.least_of_mass * vehicle.body.mass_kg / over
                    + naming.least_of_arm * fitted.base.size.arm_m;
                let alone = naming.ordinary_alone.max(least_weakness(traces, &fitted.base, part.signature));
                let of_size = if part.is_amount(free) { of_size.max(alone) } else { 0.0 };
                let least = naming.ordinary.unwrap_or(naming.least).max(of_size);
                let certain = Gates::default().deviate(part.signature);
                // nor is a size that does not matter
                let std = least_std(part, free, last);
                let certain = (certain * std).max(least);
                let limit = if part.is_of_sensors() {
                    certain.max(least + BEYOND * std)
                } else if part.is_amount(free) {
                    certain.max(material).max(without_name)
                } else {
                    certain
                };
                let same = out.iter_mut().find(|l| l.id == *id && l.parameter == parameter.name);
                match same {
                    Some(same) => {
                        same.limit = same.limit.max(limit);
                        same.certain = same.certain.max(certain);
                    }
                    None => {
                        let usual = (naming.usual)(parameter.name, vehicle);
                        let (low, high) = parameter.bounds.at(&vehicle.size());
                        let nothing = part.nothing_at(free);
                        let most = (high - nothing).max(nothing - low);
                        let (parameter, unit) = (parameter.name, parameter.unit);
                        out.push(DetectionLimit { id, parameter, limit, certain, usual, most, unit });
                    }
                }
            }
        }
    }
    out
}

/// The size that a flight shows for certain of an effect that gets no name all the same: a smaller one would have got none either. 0 where it
/// shows none that the effect can have.
fn seen((tested, part): (&Tested, &EffectTerm), (index, free): (usize, usize), size: &VehicleSize) -> f64 {
    let by = tested.evidence.theta.get(index).copied().unwrap_or(0.0);
    let is_possible = part.parameter(free).is_some_and(|parameter| {
        let (low, high) = parameter.bounds.at(size);
        let value = part.nothing_at(free) + by;
        low < value && value < high
    });
    if is_possible && by.abs() > CERTAIN * tested.evidence.std(index) { by.abs() } else { 0.0 }
}

/// The smallest standard error of a parameter among the candidates of the same form with different estimated axes.
fn least_std(part: &EffectTerm, slot: usize, all: &[Tested]) -> f64 {
    let std = |tested: &Tested| {
        let [of] = tested.candidate.parts.as_slice() else { return None };
        let same = of.is(part.signature) && of.values == part.values;
        let index = of.free.iter().position(|free| *free == slot).filter(|_| same)?;
        Some(tested.evidence.std(index))
    };
    all.iter().filter_map(std).fold(f64::INFINITY, f64::min)
}

/// Whether an effect of a fit, whose first free parameter has the column `first`, is determined so badly that the
/// flight could not have shown it at its usual size.
pub(super) fn is_beyond_showing(fitted: &Fitted, present: &EffectTerm, first: usize) -> bool {
    let vehicle = &fitted.base.vehicle;
    let sizes = present.free.iter().enumerate().filter_map(|(index, &slot)| {
        let usual = (present.signature.naming.usual)(present.parameter(slot)?.name, vehicle)?;
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

/// Whether no effect that appears only in motion could have been detected at its usual size, and none was found.
pub(super) fn too_little_excitation(after: &Fitted, limits: &[DetectionLimit]) -> bool {
    let vehicle = &after.base.vehicle;
    let moves = |present: &EffectTerm| {
        let mut parameters = present.free.iter().filter_map(|&slot| present.parameter(slot));
        parameters.any(|parameter| (present.signature.naming.usual)(parameter.name, vehicle).is_some())
    };
    // a load is swung by the measured motion, in hover by its noise: that shows nothing
    let shown = |limit: &DetectionLimit| {
        let swings = signature_of(limit.id).is_some_and(|signature| signature.role.hangs_below);
        !swings && limit.usual.is_some_and(|usual| limit.certain < usual)
    };
    !after.base.effects.iter().any(moves) && !limits.iter().any(shown)
}
