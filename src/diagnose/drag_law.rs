//! Which laws the drag follows, as the reconstructed flight path tells them.
//!
//! The search takes the autopilot's velocity for the airspeed. Its error is slow and as large as the motion itself in a quiet flight, so
//! that a drag seems to grow with another power of the airspeed than it does: in a wind a drag in proportion to the airspeed passes for
//! one with its square, and the other way round. The flight path is reconstructed with all laws at once; those that it does not tell
//! leave the model, and one that the search missed enters it.

use super::base::Base;
use super::candidates::candidates;
use super::feedback_noise::is_fed_back;
use super::fit::{Newton, fit};
use super::gates::NAME_Z;
use super::reconstructed::{Reconstructed, reconstructed_with};
use super::signature::{EffectTerm, Signature};
use super::signatures::ALL;
use super::tested::Search;
use super::trace::Trace;
use crate::physics::PhysicsError;
use crate::signals::Signals;
use crate::stats::normal_deviate;
use nalgebra::{DMatrix, DVector};

/// Normal deviate that a law needs that the search missed. One more than a name needs: the search had its say.
const ENTERS_Z: f64 = NAME_Z + 1.0;
/// Normal deviate that a law needs to stay. As of any effect beside the others.
const STAYS_Z: f64 = 3.0;
/// Normal deviate from which on the other forms of a law are tried. They push nearly alike, and where one shows nothing none enters.
const SHOWS_Z: f64 = 2.0;
/// A coefficient further than this many standard errors from nothing has a sign: below, it refutes its law. The usual two.
const CERTAIN: f64 = 2.0;

/// Brings the laws of the drag in line with the reconstructed flight path. Without a drag, or where no noise is fed back, all stays as
/// the search left it. Laws that are `refused` do not enter. Returns the new model with the values of the flight path where it changed.
///
/// # Errors
/// [`PhysicsError`] where the vehicle is not physical.
pub(super) fn settle_laws(
    signals: &[Signals],
    traces: &[Trace],
    (found, refused): (&mut Search, &[&'static str]),
) -> Result<Option<Base>, PhysicsError> {
    let present = &found.after.base.effects;
    if !is_fed_back(traces) || !present.iter().any(|term| term.signature.is_drag()) {
        return Ok(None);
    }
    let mut best: Option<(f64, Reconstructed)> = None;
    for base in with_all_laws(&found.after.base, traces, refused) {
        let Some(told) = reconstructed_with(signals, found, base) else { continue };
        // of several forms of a law the most certain one that is possible
        let before = &found.after.base.effects;
        let is_new = |law: &Law| law.possible && before.iter().all(|term| !term.is(law.term.signature));
        let z = laws(&told).filter(is_new).map(|law| law.z).fold(0.0, f64::max);
        if best.as_ref().is_none_or(|(most, _)| z > *most) {
            best = Some((z, told));
        }
        if z < SHOWS_Z {
            break;
        }
    }
    let Some((_, told)) = best else { return Ok(None) };
    let Some(base) = settled(&found.after.base, &told) else { return Ok(None) };
    found.after = fit(traces, base, Newton::Held)?;
    let present = &found.after.base.effects;
    let is_open = |signature: &'static Signature| present.iter().all(|term| !term.is(signature));
    found.last.retain(|tested| tested.candidate.signature().is_none_or(is_open));
    Ok(Some(told.put_into(found.after.base.clone())))
}

/// The model with all laws, each along all axes; one for each form of those that it lacks.
fn with_all_laws(base: &Base, traces: &[Trace], refused: &[&'static str]) -> Vec<Base> {
    let others = candidates(&base.vehicle, traces, ALL).into_iter().filter_map(|candidate| {
        let [part] = candidate.parts.as_slice() else { return None };
        let is_new = base.effects.iter().all(|present| !present.is(part.signature));
        (is_new && part.signature.is_drag() && !refused.contains(&part.id())).then(|| part.clone())
    });
    let mut forms: Vec<EffectTerm> = Vec::new();
    for form in others {
        if forms.iter().all(|known| known.id() != form.id() || known.values != form.values) {
            forms.push(form);
        }
    }
    let with = |form: Option<EffectTerm>| {
        let mut whole = base.clone();
        whole.effects.extend(form);
        let along_axis: Vec<_> =
            base.effects.iter().filter_map(|term| term.signature.role.axial_part_of).collect();
        for term in whole.effects.iter_mut().filter(|term| term.signature.is_drag()) {
            // along the rotor axis it may be the same term as that of another effect
            let elsewhere = along_axis.iter().any(|whole| whole.id() == term.id());
            let axial = term.signature.role.axial.filter(|_| elsewhere);
            for &slot in term.signature.amounts {
                if Some(slot) != axial && !term.free.contains(&slot) {
                    term.free.push(slot);
                }
            }
            term.free.sort_unstable();
        }
        whole
    };
    if forms.is_empty() { vec![with(None)] } else { forms.into_iter().map(|form| with(Some(form))).collect() }
}

/// A law as the flight path tells it.
struct Law<'a> {
    term: &'a EffectTerm,
    /// normal deviate of its coefficients across the rotor axis together
    z: f64,
    /// none of these coefficients is certainly below nothing
    possible: bool,
    /// place of the law among the effects of the flight path
    place: usize,
    /// slots of those across the rotor axis, and of that along it where it is told
    free: Vec<usize>,
}

fn laws(told: &Reconstructed) -> impl Iterator<Item = Law<'_>> {
    let of_law = |(_, term): &(usize, &EffectTerm)| term.signature.is_drag();
    told.base.effects.iter().enumerate().filter(of_law).map(|(place, term)| {
        let vertical = term.signature.role.vertical;
        let is_across = |slot: &usize| term.is_amount(*slot) && Some(*slot) != vertical;
        let mut free: Vec<usize> = term.free.iter().copied().filter(is_across).collect();
        let places = |slots: &[usize]| slots.iter().map(|slot| (place, *slot)).collect::<Vec<_>>();
        let (values, covariance) = told.of(&places(&free));
        let std = |at: usize| covariance[(at, at)].max(0.0).sqrt();
        let possible = (0..values.len()).all(|at| values[at] > -CERTAIN * std(at)) && values.sum() > 0.0;
        if let Some(slot) = vertical {
            let (along, variance) = told.of(&[(place, slot)]);
            let is_told = |value: &&f64| **value > CERTAIN * variance[(0, 0)].max(0.0).sqrt();
            free.extend(along.iter().find(is_told).map(|_| slot));
        }
        Law { term, z: away_from_nothing((values, covariance)), possible, place, free }
    })
}

/// Normal deviate of estimates together from nothing (Wald).
fn away_from_nothing((values, covariance): (DVector<f64>, DMatrix<f64>)) -> f64 {
    let information = covariance.cholesky().map(|root| root.inverse());
    let wald = information.map_or(0.0, |information| values.dot(&(information * &values)));
    normal_deviate(wald, values.len())
}

/// The model with the laws that the flight path tells; `None` where it has these, or where the flight path tells none.
fn settled(base: &Base, path: &Reconstructed) -> Option<Base> {
    let was = |law: &Law| base.effects.iter().any(|term| term.is(law.term.signature));
    let told: Vec<Law> = laws(path).collect();
    let stays = |law: &Law| law.possible && law.z > if was(law) { STAYS_Z } else { ENTERS_Z };
    let shared = shared_slots(base, path, &told.iter().filter(|law| stays(law)).collect::<Vec<_>>());
    let changes = !shared.is_empty() || told.iter().any(|law| was(law) != stays(law));
    if !told.iter().any(stays) || !changes {
        return None;
    }
    let mut out = base.clone();
    // what one law had taken over along an axis belongs to the other
    let along = |law: &Law| law.term.signature.role.vertical.filter(|slot| law.term.free.contains(slot));
    let left = |law: &Law| {
        let term = base.effects.iter().find(|term| term.is(law.term.signature)).filter(|_| !stays(law));
        term.is_some_and(|term| along(law).is_some_and(|slot| term.free.contains(&slot)))
    };
    let leaves_along = told.iter().any(left);
    for law in &told {
        let (is_there, is_told) = (was(law), stays(law));
        tracing::debug!(law = law.term.id(), z = law.z, law.possible, is_there, is_told, "law of the drag");
        match (is_there, is_told) {
            (true, false) => out.effects.retain(|term| !term.is(law.term.signature)),
            // in the form that the flight path shows best; only torques show where it acts
            (false, true) => {
                let mut free = (law.term.signature.refinement.freed)(law.term);
                free.retain(|slot| law.term.is_share_at_hubs(*slot));
                out.effects.push(EffectTerm { free, ..law.term.clone() });
            }
            _ => {}
        }
        for term in out.effects.iter_mut().filter(|term| term.is(law.term.signature)) {
            let is_new = |slot: &usize| !is_there || shared.is_empty() || shared.contains(slot);
            term.free.extend(law.free.iter().copied().filter(is_new));
            term.free.extend(along(law).filter(|_| leaves_along));
            term.free.sort_unstable();
            term.free.dedup();
        }
    }
    Some(out)
}

/// Slots of the laws that stay on which the flight path tells them together, where one of them lacks such a slot across the rotor axis: the other one
/// hides what it has there. None where a single law stays, or where none lacks any.
fn shared_slots(base: &Base, path: &Reconstructed, staying: &[&Law]) -> Vec<usize> {
    if staying.len() < 2 {
        return Vec::new();
    }
    let is_told = |slot: &usize| {
        let places: Vec<_> = staying.iter().map(|law| (law.place, *slot)).collect();
        away_from_nothing(path.of(&places)) > STAYS_Z
    };
    let slots: Vec<usize> = staying.iter().flat_map(|law| law.free.iter().copied()).filter(is_told).collect();
    let lacks = |law: &&Law| {
        let is_across = |slot: &usize| law.term.signature.role.vertical != Some(*slot);
        let mut present = base.effects.iter().filter(|term| term.is(law.term.signature));
        present.any(|term| slots.iter().filter(|slot| is_across(slot)).any(|slot| !term.free.contains(slot)))
    };
    if staying.iter().any(lacks) { slots } else { Vec::new() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::rows::tests::vehicle;

    /// In proportion to the airspeed, and with its square.
    fn both_laws() -> [&'static Signature; 2] {
        let laws: Vec<_> = ALL.iter().copied().filter(|signature| signature.is_drag()).collect();
        laws.try_into().expect("two laws")
    }

    /// A model with these laws, and what the flight path tells of both along x and y, with the standard error of all.
    fn settled_by(
        present: &[&'static Signature],
        told: [[f64; 2]; 2],
        std: f64,
    ) -> Vec<(&'static str, Vec<usize>)> {
        let term = |signature: &'static Signature| {
            let whole = signature.whole();
            EffectTerm { free: vec![0, 1], ..whole }
        };
        let with = |laws: &[&'static Signature]| {
            let mut base = Base::rigid(&vehicle());
            base.effects = laws.iter().map(|law| term(law)).collect();
            base
        };
        let all = with(&both_laws());
        let told = Reconstructed::by_hand(all, told.as_flattened(), std);
        let base = with(present);
        settled(&base, &told)
            .unwrap_or(base)
            .effects
            .iter()
            .map(|term| (term.id(), term.free.clone()))
            .collect()
    }

    #[test]
    fn two_laws_share_the_axes_across_the_rotors() {
        let laws = both_laws();
        let told = [[1.4, 1.4], [0.4, 0.3]];
        let all = |free: [&[usize]; 2]| {
            let mut base = Base::rigid(&vehicle());
            let terms = laws.iter().zip(free);
            base.effects =
                terms.map(|(law, free)| EffectTerm { free: free.to_vec(), ..law.whole() }).collect();
            base
        };
        let both = || all([&[0, 1], &[0, 1]]);
        let path = Reconstructed::by_hand(both(), told.as_flattened(), 0.1);
        let settled_to = settled(&all([&[0, 1], &[0]]), &path).expect("one law lacks an axis");
        assert!(settled_to.effects.iter().all(|term| term.free == [0, 1]));
        assert!(settled(&both(), &path).is_none());
        // along y the flight path tells neither
        let path = Reconstructed::by_hand(both(), &[1.4, 0.1, 0.4, 0.1], 0.1);
        assert!(settled(&all([&[0, 1], &[0]]), &path).is_none());
    }

    #[test]
    fn laws_that_the_flight_path_does_not_tell_leave_and_those_that_it_tells_enter() {
        let [linear, square] = both_laws();
        let both = vec![("linear_drag", vec![0, 1]), ("quadratic_drag", vec![0, 1])];
        // 20 and 6 standard errors
        assert_eq!(settled_by(&[linear], [[1.4, 1.4], [0.4, 0.5]], 0.1), both);
        // 4.2: what the search found stays, and what it did not find stays out
        assert_eq!(settled_by(&[linear, square], [[1.4, 1.4], [0.3, 0.3]], 0.1), both);
        assert_eq!(settled_by(&[linear], [[1.4, 1.4], [0.3, 0.3]], 0.1), both[..1]);
        // 1.4 standard errors of the square
        assert_eq!(settled_by(&[linear, square], [[1.4, 1.4], [0.1, 0.1]], 0.1), both[..1]);
        assert_eq!(settled_by(&[square], [[1.4, 1.4], [0.1, 0.1]], 0.1), both[..1]);
        // certainly below nothing along one axis
        assert_eq!(settled_by(&[linear, square], [[1.4, 1.4], [0.9, -0.3]], 0.1), both[..1]);
        // it tells neither
        assert_eq!(settled_by(&[linear, square], [[0.1, 0.1], [0.1, 0.1]], 0.1), both);
    }
}
