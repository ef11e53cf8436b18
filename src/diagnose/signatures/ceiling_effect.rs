//! Signature: a ceiling.

use crate::diagnose::picture::{Over, Picture};
use crate::diagnose::recorded::{Need, Recorded};
use crate::diagnose::signature::{
    EffectTerm, GridScale, Growth, Joint, Naming, Refinement, Signature, Whence,
};
use crate::diagnose::trace::Trace;
use crate::diagnose::usual_size::UsualSize;
use crate::diagnose::wording::Words;
use crate::physics::Airframe;
use crate::physics::effects::CeilingEffect;

/// Distances of a ceiling above the highest rotor position that are tried, rotor radii. A grid: the height is refined
/// afterwards.
const CEILINGS_RADII: [f64; 7] = [0.5, 1.0, 1.5, 2.0, 3.0, 5.0, 8.0];
/// Range of the middle half of the flown heights from which on a flight tells of a ceiling, rotor radii. The suction falls to a fraction
/// within two of them. A vehicle that keeps its height is higher than that only by errors of its controller, which thrust answers.
const LEAST_RANGE_RADII: f64 = 2.0;
/// Value of a1 that is equivalent to no ceiling, the parameter's bound: the added thrust is proportional to its
/// inverse.
const NO_CEILING: f64 = 50.0;
/// Usual a1 of a ceiling, from measurements whose source is not recorded here.
const USUAL: f64 = 5.0;
/// Largest a1 of a ceiling that gets a name. With it, the thrust one rotor radius below the ceiling is about 5 %
/// larger.
const WEAKEST: f64 = 20.0;

/// More thrust under a ceiling.
pub static SIGNATURE: Signature = Signature {
    needs: &[Need::UnderRoof],
    growth: Growth::Inverse { usual: USUAL },
    nothing: NO_CEILING,
    forms: |recorded| {
        let forms = heights_m(recorded).into_iter();
        forms.map(|height_m| SIGNATURE.form(&[NO_CEILING, 0.0, height_m], &[0])).collect()
    },
    refinement: Refinement {
        // m
        grid: Some(GridScale::Even { slot: 2, step: 0.03, least: 0.003 }),
        freed_last: &[0, 2],
        ..Refinement::NONE
    },
    naming: Naming {
        extra_z: 1.0,
        most: Some(WEAKEST),
        // it divides: it has no smallest size
        has_limit: |_| false,
        ..Naming::PLAIN
    },
    joint: Joint {
        forms: Some(|recorded, _| {
            let forms = heights_m(recorded).into_iter();
            forms.map(|height_m| SIGNATURE.term(&[3.0, 0.0, height_m], &[0, 2])).collect()
        }),
        whence: |_: &EffectTerm, slot, _, _| {
            (slot == 1).then(|| {
                Whence::Given(
                    "acts only as its sum with the distance; the height given here holds it".to_owned(),
                )
            })
        },
        ..Joint::PLAIN
    },
    picture: Picture::of(&[2], Over::Altitude),
    sizes: &[("a1", UsualSize::Of(3.5)), ("a2", UsualSize::Of(0.03)), ("height", UsualSize::Of(2.35))],
    ..Signature::of(&CeilingEffect, &[0], Words::of("ceiling effect"))
};

/// Possible heights of a ceiling above the flown heights, m.
fn heights_m(recorded: &Recorded) -> Vec<f64> {
    recorded.airframe.as_ref().map(|airframe| over(recorded.flights, airframe)).unwrap_or_default()
}

fn over(flights: &[Trace], airframe: &Airframe) -> Vec<f64> {
    let radius_m = airframe.propulsion.rotor_radius_m.unwrap_or(0.0);
    let hub_m = |trace: &Trace, row: usize| {
        let state = &trace.states[row];
        let over = airframe.arms_m().iter().map(|arm| (state.attitude * arm).z).fold(f64::MIN, f64::max);
        state.position_m.z + over
    };
    let flown = flights.iter().flat_map(|trace| trace.centers.iter().map(move |&row| hub_m(trace, row)));
    let mut flown_m: Vec<f64> = flown.collect();
    flown_m.sort_by(f64::total_cmp);
    let Some(&top_m) = flown_m.last() else { return Vec::new() };
    let of_half_m = flown_m[3 * flown_m.len() / 4] - flown_m[flown_m.len() / 4];
    if of_half_m < LEAST_RANGE_RADII * radius_m {
        return Vec::new();
    }
    CEILINGS_RADII.iter().map(|radii| top_m + radii * radius_m).filter(|height_m| *height_m >= 0.5).collect()
}
