//! Refinement of the model after the search: which effects stay, and their sizes by estimators that the autopilot's noise does
//! not bias (flight path reconstruction, instruments).

use super::base::Base;
use super::bend::Bend;
use super::climb_alone::is_of_climb;
use super::drag_law::settle_laws;
use super::drag_location::add_damping;
use super::feedback_noise::is_fed_back;
use super::fit::{Fitted, Newton, fit};
use super::floors::{FORM, add_floors};
use super::latency_error::by_latency;
use super::left_over::add_left_over;
use super::limits::is_beyond_showing;
use super::measured_force::{Felt, shows_in_forces};
use super::named::Strength;
use super::one_balance::better_alone;
use super::other_law::add_other_laws;
use super::pace::Pace;
use super::physical::make_physical;
use super::reconstructed::{Forms, reconstruct};
use super::recorded::{Need, heights_flown_m};
use super::rotor_axes::{is_refuted, least_weakness};
use super::signature::EffectTerm;
use super::stated_mass::settle_scale;
use super::tested::Search;
use super::thrust_slope::may_be_noise;
use super::torques_by_instruments::torques_by_instruments;
use super::trace::Trace;
use super::trim_check::Trim;
use crate::estimate::inertia_by_wider_window;
use crate::physics::PhysicsError;
use crate::signals::Signals;
use crate::stats::normal_deviate;
use crate::vehicle::Vehicle;
use nalgebra::{DMatrix, DVector};

/// An effect that is nearer to nothing than this many standard errors, beside all others and with its errors as
/// reconstruction and instruments tell them, leaves the model. Set by judgement; measured only together with all
/// conditions of a name (see `Gates`).
const STAYS: f64 = 3.0;
/// The same where its errors hold what is left over as well. The usual two.
const CERTAIN: f64 = 2.0;
/// How often the model is estimated again after effects left it. A number of steps: only the time of a search and its
/// last digits depend on it.
const ROUNDS: usize = 6;

/// Leaves effects without a name out, and estimates the sizes of the others by what has no noise of the autopilot's own: forces
/// with the flight path, torques by instruments. What is `refused` does not come back.
pub(super) fn refine(
    (flights, traces): (&[Signals], &[Trace]),
    vehicle: &Vehicle,
    (found, refused, pace): (&mut Search, &[&'static str], &mut Pace<'_>),
) -> Result<(), PhysicsError> {
    let trim = Trim::of(flights, vehicle);
    leave_out_unnamed((traces, (flights, vehicle)), &trim, (found, false))?;
    let mut start =
        tracing::info_span!("laws").in_scope(|| settle_laws(flights, traces, (found, refused)))?;
    loop {
        estimate_sizes((flights, traces), (vehicle, &trim), (found, pace), start.take())?;
        let Some(place) = uncertain(&found.after) else { break };
        tracing::info!(
            effect = found.after.base.effects[place].id(),
            "effect is not certain with what is left over"
        );
        found.after = fit(traces, found.after.base.without(|of| of == place), Newton::Held)?;
        pace.again();
    }
    // which law a drag follows says nothing of whether it is there
    found.by_other_law = add_other_laws(traces, &found.last, &mut found.after);
    add_damping(traces, &mut found.after);
    settle_scale(traces, vehicle, (&mut found.after, &mut found.by_other_law))?;
    add_floors(&mut found.after);
    // the model where nothing serves
    add_left_over(&mut found.before, &[]);
    add_floors(&mut found.before);
    found.latency.std_s = found.latency.std_s.hypot(FORM * found.latency.total_s);
    found.by_wider_window = inertia_by_wider_window(flights, vehicle);
    tracing::debug!(?found.by_wider_window, "moments of inertia of the rigid body by another window");
    make_physical(traces, (vehicle, found.by_wider_window), &mut found.before)?;
    make_physical(traces, (vehicle, found.by_wider_window), &mut found.after)
}

/// The sizes of the effects, with what is left over in their errors. Effects that then have no name leave. `start` is a model with values
/// that the reconstructed flight path tells.
fn estimate_sizes(
    (flights, traces): (&[Signals], &[Trace]),
    (vehicle, trim): (&Vehicle, &Trim),
    (found, pace): (&mut Search, &mut Pace<'_>),
    mut start: Option<Base>,
) -> Result<(), PhysicsError> {
    let by_search = found.after.clone();
    let mut by_instruments = Vec::new();
    for left in (0..ROUNDS).rev() {
        let start = start.take();
        let done = tracing::info_span!("reconstruct")
            .in_scope(|| reconstruct(flights, traces, (Forms::Chosen, found), start.as_ref()))?;
        found.laws_by_path |= start.is_some() && done;
        if start.is_some() && !done {
            // laws without sizes of their own are none
            found.after.clone_from(&by_search);
            reconstruct(flights, traces, (Forms::Chosen, found), None)?;
        }
        if is_fed_back(traces) {
            by_instruments = tracing::info_span!("instruments")
                .in_scope(|| torques_by_instruments(traces, found.latency.std_s, &mut found.after))?;
        }
        pace.reconstructed();
        // sizes along the reconstructed flight path are those of forces alone
        let by_weak_form = found.paths.is_empty();
        if left == 0 || !leave_out_unnamed((traces, (flights, vehicle)), trim, (found, by_weak_form))? {
            break;
        }
        pace.again();
    }
    add_left_over(&mut found.after, &by_instruments);
    let latency_std_s = found.latency.told_std_s();
    found.after.covariance += by_latency(traces, &found.after, (latency_std_s, &by_instruments))?;
    Ok(())
}

/// The place of the effect that is nearest to nothing, where that is nearer than the usual two standard errors with what is left over in
/// them. A lag or delay has its latency, which may be certain while its kind is not.
fn uncertain(fitted: &Fitted) -> Option<usize> {
    let each = fitted.with_first_columns().enumerate();
    let judged = each.filter(|(_, (present, _))| present.signature.role.latency.is_none());
    let strengths = judged.map(|(place, (present, first))| (place, fitted_strength(fitted, present, first)));
    weakest(strengths, CERTAIN).map(|(_, place)| place)
}

/// The smallest normal deviate below `least` among the strengths of effects, with the place of its effect.
pub(super) fn weakest(
    strengths: impl Iterator<Item = (usize, Strength)>,
    least: f64,
) -> Option<(f64, usize)> {
    let told = strengths.filter(|(_, of)| of.count > 0 && of.z < least).map(|(place, of)| (of.z, place));
    told.min_by(|a, b| a.0.total_cmp(&b.0))
}

/// Removes effects without a name from the model. Returns whether there were any. Those that the flights could not have shown leave first:
/// they take from the others, which are then judged without them.
fn leave_out_unnamed(
    (traces, given): (&[Trace], (&[Signals], &Vehicle)),
    trim: &Trim,
    (found, by_weak_form): (&mut Search, bool),
) -> Result<bool, PhysicsError> {
    let fitted = &found.after;
    let turning: Vec<&'static str> = fitted
        .with_first_columns()
        .filter(|(present, first)| by_weak_form && only_turns(fitted, present, *first))
        .map(|(present, _)| present.id())
        .collect();
    let beyond: Vec<bool> = fitted
        .with_first_columns()
        .map(|(present, first)| {
            let beyond = is_beyond_showing(fitted, present, first);
            if beyond {
                tracing::info!(effect = present.id(), "the flights could not have shown the effect");
            }
            beyond
        })
        .collect();
    let are_shown = !beyond.contains(&true);
    let leaves = if are_shown {
        found.misplaced.extend(&turning);
        unnamed((traces, given), trim, (fitted, &turning))?
    } else {
        beyond
    };
    if !leaves.contains(&true) {
        return Ok(false);
    }
    let left = fit(traces, fitted.base.without(|place| leaves[place]), Newton::Held)?;
    let instead = if are_shown { better_alone(traces, (fitted, &leaves), &left)? } else { None };
    if let Some((alone, at)) = instead
        && !unnamed((traces, given), trim, (&alone, &turning))?[at]
    {
        found.after = alone;
        return Ok(true);
    }
    found.after = left;
    Ok(true)
}

/// Which effects of a fit get no name: those of ordinary size, the least certain of those that are not certain, those that the
/// accelerometer does not feel, those that are `turning` alone, those of descents that a loss of thrust in climb explains as well, and those
/// that hover excludes.
fn unnamed(
    (traces, given): (&[Trace], (&[Signals], &Vehicle)),
    trim: &Trim,
    (fitted, turning): (&Fitted, &[&'static str]),
) -> Result<Vec<bool>, PhysicsError> {
    let felt = Felt::of(fitted);
    let is_unnamed = |(present, first): (&EffectTerm, usize)| {
        let refuted = felt.as_ref().is_some_and(|felt| felt.refutes(fitted, present, first));
        // a bend acts on the commands' own noise, and that is in the torques
        let bent = present.signature.role.bends_thrust.is_some() && is_fed_back(traces);
        let unseen = bent && !is_bent((present, first), traces, fitted);
        let unseen = unseen || turning.contains(&present.id());
        let unbalanced = is_refuted(given, fitted, present, first);
        let ordinary = is_ordinary(present, &fitted.base, traces);
        let of_climb = is_of_climb(traces, fitted, present, first);
        let is_unnamed = refuted || unseen || unbalanced || ordinary || of_climb;
        if is_unnamed {
            let effect = present.id();
            tracing::info!(effect, refuted, unseen, unbalanced, ordinary, of_climb, "effect gets no name");
        }
        is_unnamed
    };
    let mut leaves: Vec<bool> = fitted.with_first_columns().map(is_unnamed).collect();
    let effects = &fitted.base.effects;
    if let Some(place) = trim.refuted(&fitted.base)? {
        tracing::info!(effect = effects[place].id(), "hover shows no such balance");
        leaves[place] = true;
    }
    // two that explain much of each other are both uncertain: one leaves, and the other is judged again
    let strengths =
        fitted.with_first_columns().map(|(present, first)| fitted_strength(fitted, present, first));
    if let Some((z, place)) = weakest(strengths.enumerate(), STAYS) {
        tracing::info!(effect = effects[place].id(), z, "effect is not certain beside the others");
        leaves[place] = true;
    }
    leave_scatter(&fitted.base, &mut leaves);
    Ok(leaves)
}

/// Beside a weak rotor that stays, an offset of the balance that every vehicle has leaves as well: it is taken for the scatter of the other
/// rotors, and would take a part of the weak one.
fn leave_scatter(base: &Base, leaves: &mut [bool]) {
    let mut rotors =
        base.effects.iter().zip(leaves.iter()).filter(|(of, _)| of.signature.role.which.is_some());
    if rotors.any(|(_, leaves)| !leaves) {
        for (of, leaves) in base.effects.iter().zip(leaves) {
            *leaves |= of.signature.role.of_the_loading && of.is_of_every_vehicle(&base.size);
        }
    }
}

/// Whether an effect is a wind that only the torques show: its moment is that of a centre of mass that is off.
fn only_turns(fitted: &Fitted, present: &EffectTerm, first: usize) -> bool {
    present.signature.role.wind.is_some() && !shows_in_forces(fitted, present, first)
}

/// Whether the forces show a bent thrust curve where the commands answer noise: those that go with the commanded trajectory, or those of all
/// commands, unless the former contradict.
fn is_bent((bent, first): (&EffectTerm, usize), traces: &[Trace], fitted: &Fitted) -> bool {
    let by_all = || shows_in_forces(fitted, bent, first) && !is_noise(bent, traces, fitted);
    match Bend::by_instruments(traces, fitted, bent) {
        Some(told) => told.shows(bent.values[0], STAYS) || told.agrees(bent.values[0], STAYS) && by_all(),
        None => by_all(),
    }
}

/// Whether noise alone may have bent a thrust curve: it lowers the slope, and never raises it.
fn is_noise(bent: &EffectTerm, traces: &[Trace], fitted: &Fitted) -> bool {
    bent.values[0] < 0.0 && may_be_noise(traces, fitted)
}

/// Share of the mass up to which a change of it is ordinary beside a thrust that falls with the battery, because a cell does not follow its voltage
/// alone, and where commands are logged too seldom to compare torques: the thrust of real vehicles differed from such commands by 1 to 5 % of the
/// weight for some seconds.
const UNSURE_THRUST: f64 = 0.05;

/// Whether an effect leaves the model without a name: every vehicle has this much of it, or it is too small for its
/// name. One that every vehicle has a little of, and that is certain, stays as a trace (`EffectTerm::is_of_every_vehicle`).
fn is_ordinary(term: &EffectTerm, base: &Base, traces: &[Trace]) -> bool {
    let naming = &term.signature.naming;
    let of_all = || term.values.iter().map(|value| value * value).sum::<f64>().sqrt();
    let amounts = || term.signature.amounts.iter().filter_map(|&slot| term.values.get(slot));
    let over = if naming.by_height { heights_flown_m(traces) } else { 1.0 };
    let sags = base.effects.iter().any(|of| of.signature.needs.contains(&Need::Voltage));
    let is_unsure = sags || traces.iter().all(|trace| !trace.torques);
    let least_change = if is_unsure && term.signature.role.moment.is_some() { UNSURE_THRUST } else { 0.0 };
    let away =
        || term.signature.amounts.iter().map(|&slot| term.from_nothing(slot).abs()).fold(0.0, f64::max);
    away() < least_weakness(traces, base, term.signature)
        || term.size() * over < naming.least_of_mass.max(least_change) * base.vehicle.body.mass_kg
        || naming.ordinary.is_some_and(|ordinary| term.size() < ordinary)
        || naming.least > 0.0 && of_all() < naming.least
        || naming.most.is_some_and(|most| amounts().any(|amount| *amount > most))
        || (naming.is_ordinary)(term, &base.effects)
}

/// Significance of an effect that was accepted together with another, from the distance of its amounts from zero. The parameters of
/// its form are held at their estimates: without the effect they do not exist, and where they are free the size may be uncertain
/// of an effect that is certain.
pub(super) fn fitted_strength(fitted: &Fitted, present: &EffectTerm, first: usize) -> Strength {
    let amounts: Vec<(usize, usize)> = present
        .free
        .iter()
        .enumerate()
        .filter(|(_, slot)| present.is_amount(**slot))
        .map(|(index, &slot)| (first + index, slot))
        .filter(|&(index, _)| fitted.covariance[(index, index)] > 0.0)
        .collect();
    let count = amounts.len();
    let away = amounts.iter().map(|&(_, slot)| present.from_nothing(slot)).collect::<Vec<_>>();
    let away = DVector::from_vec(away);
    let forms: Vec<usize> = (0..present.free.len())
        .filter(|&index| !present.is_amount(present.free[index]))
        .map(|index| first + index)
        .filter(|&index| fitted.covariance[(index, index)] > 0.0)
        .collect();
    let columns: Vec<usize> = amounts.iter().map(|&(index, _)| index).collect();
    let covariance = with_held(fitted, &columns, &forms);
    // a covariance of two estimators need not be positive definite
    let apart = || (0..count).map(|i| away[i].powi(2) / covariance[(i, i)]).fold(0.0, f64::max);
    let wald = covariance.clone().cholesky().map_or_else(apart, |factor| away.dot(&factor.solve(&away)));
    Strength { z: normal_deviate(wald, count), gain: 0.0, energy: wald, count }
}

/// Covariance of these columns while others are held; that with the others free where it is no covariance, as one of two estimators
/// need not be.
fn with_held(fitted: &Fitted, columns: &[usize], held: &[usize]) -> DMatrix<f64> {
    let own = part(&fitted.covariance, columns, columns);
    let Some(normal) = fitted.weighted.normal.as_ref().filter(|_| !held.is_empty()) else { return own };
    let factor = normal.l();
    reduced(&(&factor * factor.transpose()), &fitted.covariance, columns, held)
        .filter(|reduced| reduced.clone().cholesky().is_some())
        .unwrap_or(own)
}

/// Sandwich of the regression without the held columns, from the information A and the sandwich V of the whole: its meat is A V A.
fn reduced(
    information: &DMatrix<f64>,
    covariance: &DMatrix<f64>,
    columns: &[usize],
    held: &[usize],
) -> Option<DMatrix<f64>> {
    let kept: Vec<usize> = (0..information.nrows()).filter(|index| !held.contains(index)).collect();
    let meat = part(&(information * covariance * information), &kept, &kept);
    let bread = part(information, &kept, &kept).cholesky()?.inverse();
    let all = &bread * meat * &bread;
    let places: Vec<usize> =
        columns.iter().filter_map(|column| kept.iter().position(|kept| kept == column)).collect();
    Some(part(&all, &places, &places))
}

fn part(of: &DMatrix<f64>, rows: &[usize], columns: &[usize]) -> DMatrix<f64> {
    DMatrix::from_fn(rows.len(), columns.len(), |i, j| of[(rows[i], columns[j])])
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test ends where it fails")]
    use super::*;
    use crate::diagnose::rows::tests::vehicle;
    use crate::diagnose::signatures::signature_of;

    #[test]
    fn with_a_column_held_it_is_the_sandwich_of_the_smaller_regression() {
        // rows of a regression and a covariance of its noise that is not white
        let x =
            DMatrix::from_row_slice(4, 3, &[1.0, 0.4, 0.2, 0.3, 1.0, -0.5, 0.9, 0.8, 1.0, -0.2, 0.5, 0.7]);
        let noise = DMatrix::from_fn(4, 4, |i, j| 0.6_f64.powi(i32::try_from(i.abs_diff(j)).unwrap()));
        let sandwich = |x: &DMatrix<f64>| {
            let bread = (x.transpose() * x).try_inverse().unwrap();
            &bread * (x.transpose() * &noise * x) * &bread
        };
        let found = reduced(&(x.transpose() * &x), &sandwich(&x), &[0, 2], &[1]).unwrap();
        let smaller = DMatrix::from_fn(4, 2, |i, j| x[(i, 2 * j)]);
        assert!((found - sandwich(&smaller)).norm() < 1e-12);
    }

    #[test]
    fn what_the_scatter_of_rotors_makes_leaves_beside_a_weak_rotor_that_stays() {
        let mut base = Base::rigid(&vehicle());
        let [mut rotor, mut load] = ["weak_rotor", "com_offset"].map(|id| signature_of(id).unwrap().whole());
        rotor.values = vec![1.0, 0.9];
        for (share, is_ordinary) in [(0.005, true), (0.1, false)] {
            load.values[0] = share * base.size.arm_m;
            base.effects = vec![load.clone(), rotor.clone()];
            for rotor_leaves in [false, true] {
                let mut leaves = [false, rotor_leaves];
                leave_scatter(&base, &mut leaves);
                assert_eq!(leaves, [is_ordinary && !rotor_leaves, rotor_leaves]);
            }
            // alone it stays, as a trace or with a name
            base.effects.truncate(1);
            let mut leaves = [false];
            leave_scatter(&base, &mut leaves);
            assert!(!leaves[0]);
        }
    }
}
