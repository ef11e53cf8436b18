//! Signature: the ground effect.

use crate::diagnose::named::Named;
use crate::diagnose::picture::{Over, Picture};
use crate::diagnose::recorded::Need;
use crate::diagnose::signature::{EffectTerm, Joint, Naming, Refinement, Signature, Whence, first_finer};
use crate::diagnose::usual_size::UsualSize;
use crate::diagnose::wording::{Clause, Size, Words};
use crate::diagnose::words;
use crate::physics::effects::GroundEffect;
use crate::text::significant;
use crate::vehicle::Vehicle;

/// Slots of the values, in the order of the effect's parameters.
const RHO: usize = 0;
const CA: usize = 1;
const CB: usize = 2;
/// Decays of the exponential form that the search tries, per rotor radius. A grid: the decay is refined afterwards.
const DECAYS_TRIED: [f64; 5] = [0.4, 0.7, 1.2, 2.0, 3.5];
/// Start values of the decay if the other form was accepted, per rotor radius. Start values: the fit moves them.
const DECAYS: [f64; 2] = [0.7, 1.5];
/// Decays of the exponential form that `--with` fits, per rotor radius. Start values: the fit moves them.
const DECAYS_FITTED: [f64; 3] = [0.4, 0.8, 1.6];
/// Height at which both forms have the same value at the start of a fit, rotor radii. A start value.
const ALIKE_RADII: f64 = 2.0;

/// More thrust near the ground.
pub static SIGNATURE: Signature = Signature {
    needs: &[Need::Position],
    forms: |_| {
        // all rotors lifted alike, or each by its own height
        let inverse = [0.0, 1.0].map(|levelling| SIGNATURE.form(&[0.0, 0.0, 1.0, levelling], &[RHO]));
        // for each height over which it dies down
        let exponential = DECAYS_TRIED.map(|decay| SIGNATURE.form(&[0.0, 0.0, decay, 1.0], &[CA]));
        inverse.into_iter().chain(exponential).collect()
    },
    refinement: Refinement {
        freed: |term| {
            let decay = (term.free == [CA]).then_some(CB);
            decay.into_iter().chain(first_finer(term)).collect()
        },
        other_forms,
        ..Refinement::NONE
    },
    naming: Naming {
        // the same two radii up with a decay of one a radius
        usual: |parameter, _| match parameter {
            "rho" => Some(4.0),
            "ca" => Some(0.5),
            _ => None,
        },
        // its decay says nothing where its form has none
        says: |term, slot| if slot == CB { term.values[CA] != 0.0 } else { term.values[slot] != 0.0 },
        // it is told in its first form
        has_limit: |term| term.free != [CA],
        ..Naming::PLAIN
    },
    joint: Joint {
        forms: Some(|_, _| {
            let inverse = [1.0, 0.0].map(|levelling| SIGNATURE.term(&[0.0, 0.0, 1.0, levelling], &[RHO, 3]));
            let exponential =
                DECAYS_FITTED.map(|decay| SIGNATURE.term(&[0.0, 0.1, decay, 1.0], &[CA, CB, 3]));
            inverse.into_iter().chain(exponential).collect()
        }),
        whence: |_, slot, _, _| {
            (slot <= CB).then(|| Whence::Given("the other law is more likely".to_owned()))
        },
        ..Joint::PLAIN
    },
    picture: Picture::of(&[2], Over::Altitude),
    sizes: &[("rho", UsualSize::Of(4.0)), ("ca", UsualSize::Of(0.0)), ("cb", UsualSize::Of(1.0))],
    ..Signature::of(
        &GroundEffect,
        &[RHO, CA],
        Words {
            clause: Clause::Own(clause),
            size: Size::Own(size, |_| None),
            limit: Some(|limit| {
                format!("ground effect {} times that of Cheeseman and Bennett", significant(limit, 2))
            }),
            told_if_absent: Some(3),
            expected_in_motion: Some(2),
            ..Words::of("ground effect")
        },
    )
};

/// The same size in the other form. For small sizes the forms are similar; for the estimated size they are not.
fn other_forms(term: &EffectTerm) -> Vec<EffectTerm> {
    let (rho, ca, cb) = (term.values[RHO], term.values[CA], term.values[CB]);
    let beside = term.free.iter().copied().filter(|slot| ![RHO, CA, CB].contains(slot));
    let of = |slots: &[usize], values: [f64; 3]| {
        let mut other = term.clone();
        other.values[..3].copy_from_slice(&values);
        other.free = slots.iter().copied().chain(beside.clone()).collect();
        other
    };
    let squared = 16.0 * ALIKE_RADII * ALIKE_RADII;
    if ca > 0.0 {
        let gain = ca * (-cb * ALIKE_RADII).exp();
        return vec![of(&[RHO], [squared * gain / (1.0 + gain), 0.0, cb])];
    }
    let gain = 1.0 / (1.0 - rho / squared) - 1.0;
    DECAYS.iter().map(|decay| of(&[CA, CB], [0.0, gain * (decay * ALIKE_RADII).exp(), *decay])).collect()
}

fn clause(named: &Named, vehicle: &Vehicle) -> String {
    let radius = vehicle.propulsion.rotor_radius_m;
    let (rho, ca, cb) = (named.value("rho"), named.value("ca"), named.value("cb"));
    // two radii up
    let gain_percent = 100.0 * (1.0 / (1.0 - rho / 64.0) - 1.0 + ca * (-2.0 * cb).exp());
    let height = radius.map_or(String::new(), |radius_m| {
        format!("{} % more thrust at {} m", significant(gain_percent, 2), significant(2.0 * radius_m, 2))
    });
    let by = if ca > 0.0 {
        format!("decreasing by a factor e every {} rotor radii", significant(1.0 / cb, 2))
    } else {
        format!("{} times that of Cheeseman and Bennett, decreasing with height", named.said("rho", 1.0))
    };
    let parts: Vec<String> = [by, height].into_iter().filter(|part| !part.is_empty()).collect();
    format!("Ground effect was left out: {}", parts.join(", "))
}

fn size(named: &Named) -> Option<String> {
    match named.get("ca") {
        Some(ca) if ca.value > 0.0 => {
            let at_two = ca.value * (-2.0 * named.value("cb")).exp();
            let decay_std = named.get("cb").map_or(0.0, |cb| cb.std);
            let std = at_two * (ca.std / ca.value).hypot(2.0 * decay_std);
            let percent = words::plain(100.0 * at_two, 100.0 * std);
            Some(format!("{percent} % of the thrust at a height of two rotor radii"))
        }
        _ => words::said(named, "rho", 1.0, "times Cheeseman and Bennett's"),
    }
}
