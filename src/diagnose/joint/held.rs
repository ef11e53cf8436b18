//! Parameters that a flight does not determine are held at the value without influence, and those beyond a bound at the
//! bound.

use super::choose::Chosen;
use crate::diagnose::base::Base;
use crate::diagnose::evidence::Weighted;
use crate::diagnose::fit::{Fitted, Newton, fit};
use crate::diagnose::gates::NAME_Z;
use crate::diagnose::signature::EffectTerm;
use crate::diagnose::trace::Trace;
use crate::physics::PhysicsError;
use crate::text::compact;

/// Why a parameter is not estimated.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Held {
    /// not determined, with the reason for the user
    NotDetermined(String),
    /// the estimate, with its standard error, is beyond the bound
    AtBound { unbounded: f64, std: f64 },
}

/// A form with the treatment of its parameters.
#[derive(Debug, Clone)]
pub(super) struct FittedForm {
    pub(super) chosen: Chosen,
    /// slot and reason
    pub(super) held: Vec<(usize, Held)>,
}

/// A standard error above this share of the plausible range does not determine a parameter. An even distribution over
/// the range has a standard deviation of 0.29 of it; this is less than half of that.
const SAYS_NOTHING: f64 = 0.125;
/// Least share of a column that no other column may explain. Above rounding.
const OWN: f64 = 1e-7;
/// Standard errors by which an effect must differ from zero before its other parameters are estimated. Before that
/// its shape would be fitted to noise.
const SEEN: f64 = 2.5;
/// Standard errors by which a drag along z must differ from zero to determine a wind along z. As many as a name
/// needs.
const SHOWS_WIND: f64 = NAME_Z;

/// Fits, holds the parameters that cannot be estimated, and fits again until all remaining ones are determined.
pub(super) fn estimate_forms(
    flights: &[Trace],
    base: &Base,
    chosen: Vec<Chosen>,
    newton: Newton,
) -> Result<(Fitted, Vec<FittedForm>), PhysicsError> {
    let mut settled: Vec<FittedForm> =
        chosen.into_iter().map(|chosen| FittedForm { chosen, held: Vec::new() }).collect();
    let before = base.effects.len();
    let start = |settled: &[FittedForm]| {
        let mut base = base.clone();
        // what hangs below is no part of the vehicle
        let load_kg: f64 = settled.iter().filter_map(|of| load_kg(&of.chosen.form)).sum();
        base.vehicle.body.mass_kg -= load_kg;
        base.effects.extend(settled.iter().map(|of| of.chosen.form.clone()));
        base
    };
    let mut fitted = fit(flights, start(&settled), newton)?;
    let mut up_tried = false;
    loop {
        let singular = fitted.weighted.normal.is_none();
        let mut anew = singular && hold_last(&mut settled);
        for (index, of) in settled.iter_mut().enumerate().filter(|_| !singular) {
            anew |= hold_undetermined(&fitted, before + index, of);
        }
        if anew {
            fitted = fit(flights, start(&settled), newton)?;
            continue;
        }
        let mut next = fitted.base.clone();
        let mut bounded = false;
        for (index, of) in settled.iter_mut().enumerate() {
            bounded |= hold_at_bounds(&fitted, before + index, of);
            next.effects[before + index].free.clone_from(&of.chosen.form.free);
        }
        if !bounded && !up_tried {
            up_tried = true;
            bounded = free_vertical_wind(&fitted, &mut settled, (before, &mut next));
        }
        if !bounded {
            return Ok((fitted, settled));
        }
        fitted = fit(flights, next, newton)?;
    }
}

/// Mass of a slung load that an effect starts with, kg.
fn load_kg(form: &EffectTerm) -> Option<f64> {
    form.values.first().copied().filter(|_| form.signature.role.hangs_below)
}

/// Holds the last column if columns are linearly dependent. Returns whether there was one.
fn hold_last(settled: &mut [FittedForm]) -> bool {
    let last = settled.iter_mut().rev().find_map(|of| Some((of.chosen.form.free.pop()?, of)));
    let Some((slot, of)) = last else { return false };
    let why = "in this flight its effect is the same as that of other parameters";
    of.held.push((slot, Held::NotDetermined(why.to_owned())));
    true
}

/// Column of an effect's free parameter.
fn column(fitted: &Fitted, place: usize, nth: usize) -> usize {
    let before: usize = fitted.base.effects[..place].iter().map(|present| present.free.len()).sum();
    fitted.rows.nuisances.len() + before + nth
}

/// Slot, value, standard error, and share of its column that no other column explains (`None`: the column is zero).
pub(super) fn estimates(fitted: &Fitted, place: usize) -> Vec<(usize, f64, f64, Option<f64>)> {
    let present = &fitted.base.effects[place];
    let of = |(nth, &slot): (usize, &usize)| {
        let at = column(fitted, place, nth);
        let std = fitted.covariance[(at, at)].max(0.0).sqrt();
        (slot, present.values[slot], std, own_share(&fitted.weighted, at))
    };
    present.free.iter().enumerate().map(of).collect()
}

/// Share of a column of the rows (nuisances first, then the base's effects) that no other column explains; `None` if it
/// is zero.
fn own_share(weighted: &Weighted, index: usize) -> Option<f64> {
    let plain = weighted.nuisances.norm_squared(index);
    let own = weighted.own(index)?;
    (plain > 0.0).then(|| own / plain)
}

fn hold_undetermined(fitted: &Fitted, place: usize, of: &mut FittedForm) -> bool {
    let present = &fitted.base.effects[place];
    let all = estimates(fitted, place);
    let seen = all.iter().any(|(slot, _, std, _)| {
        present.is_amount(*slot) && present.away_from_nothing(*slot, *std).abs() > SEEN
    });
    let mut anew = false;
    for (slot, _, std, own) in all {
        let Some(parameter) = present.parameter(slot) else { continue };
        let (least, greatest) = parameter.bounds.at(&fitted.base.size);
        let amount = present.is_amount(slot);
        // a finer form was taken because it is the more likely one: what it adds stays in, whatever its error
        let finer = slot >= present.effect().parameters().len();
        let reason = if !amount && !seen {
            "the effect itself is not distinguishable from noise".to_owned()
        } else {
            match own {
                None if present.is_share_at_hubs(slot) && !fitted.rows.compares_torques => {
                    "it shows only in torques, and commands or body rates are logged at too low a rate to compare them".to_owned()
                }
                None => "nothing in this flight excites it".to_owned(),
                Some(own) if own < OWN => {
                    "in this flight its effect is the same as that of mass, inertia or another parameter"
                        .to_owned()
                }
                _ if !finer && std > SAYS_NOTHING * (greatest - least) => format!(
                    "its standard error, {std:.2e} {}, is at least as large as the plausible range ({} to {})",
                    parameter.unit,
                    compact(least),
                    compact(greatest)
                ),
                _ => continue,
            }
        };
        of.chosen.form.free.retain(|free| *free != slot);
        if amount {
            of.chosen.form.values[slot] = present.nothing_at(slot);
        }
        of.held.push((slot, Held::NotDetermined(reason)));
        anew = true;
    }
    anew
}

fn hold_at_bounds(fitted: &Fitted, place: usize, of: &mut FittedForm) -> bool {
    let present = &fitted.base.effects[place];
    let mut any = false;
    for (nth, (slot, value, std, _)) in estimates(fitted, place).into_iter().enumerate() {
        let wanted = value + fitted.coefficients[column(fitted, place, nth)];
        let nearest = present.possible(slot, wanted, &fitted.base.size);
        let outside = nearest != wanted && nearest == value;
        if outside {
            of.chosen.form.free.retain(|free| *free != slot);
            of.chosen.form.values[slot] = value;
            of.held.push((slot, Held::AtBound { unbounded: wanted, std }));
            any = true;
        }
    }
    any
}

/// Estimates the vertical wind only if there is a significant drag along z, through which it acts.
fn free_vertical_wind(
    fitted: &Fitted,
    settled: &mut [FittedForm],
    (before, next): (usize, &mut Base),
) -> bool {
    const UP: usize = 2;
    let shows = fitted.base.effects.iter().enumerate().any(|(place, present)| {
        let Some(along_z) = present.signature.role.vertical else { return false };
        let free = estimates(fitted, place).into_iter().find(|(slot, ..)| *slot == along_z);
        free.is_some_and(|(_, value, std, _)| value > SHOWS_WIND * std)
            || !present.free.contains(&along_z) && place < before && present.values[along_z] > 0.0
    });
    let mut freed = false;
    for (index, of) in settled.iter_mut().enumerate() {
        if of.chosen.form.signature.role.wind.is_none() || of.chosen.form.free.is_empty() {
            continue;
        }
        if shows {
            of.chosen.form.free.push(UP);
            next.effects[before + index].free.push(UP);
            freed = true;
        } else {
            let why =
                "it acts through the drag along body z, and this drag is not distinguishable from noise";
            of.held.push((UP, Held::NotDetermined(why.to_owned())));
        }
    }
    freed
}
