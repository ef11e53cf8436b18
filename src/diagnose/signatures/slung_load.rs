//! Signature: a load that swings below.

use super::mass_change::LEAST_OF_MASS;
use crate::diagnose::picture::{Over, Picture};
use crate::diagnose::recorded::{Need, Recorded};
use crate::diagnose::signature::{
    EffectTerm, GridScale, Joint, Naming, Refinement, Role, Signature, first_finer,
};
use crate::diagnose::usual_size::UsualSize;
use crate::diagnose::wording::{Clause, Words};
use crate::physics::effects::SlungLoad;

/// Lengths of a load's cord that are tried, m: their periods differ by about 20 %.
const CORD_LENGTHS_M: [f64; 7] = [0.25, 0.4, 0.6, 0.9, 1.3, 2.0, 3.0];
/// Damping of the swing by the air at the start of a fit, 1/s. A start value.
const SWING_DAMPING_1_S: f64 = 0.2;
/// Shortest and longest cord that is fitted, m. Shorter ones swing too fast for the kernel, longer ones are flown
/// outdoors alone.
const CORDS_M: (f64, f64) = (0.2, 4.0);
/// Dampings of the swing that are fitted, 1/s, each with the ratio of neighbouring cord lengths. Swings of neighbouring
/// lengths stay in phase while the swing lasts, or differ by a tenth of a period after a minute.
const SWINGS: [(f64, f64); 3] = [(0.0, 1.015), (0.1, 1.03), (0.5, 1.1)];

/// Damping ratio of the swing from which on it is none. Air and cord damp a load to a tenth or less, so that it swings on after a stop;
/// at this ratio a sixteenth of the swing is left after one period.
const SWINGS_BELOW: f64 = 0.4;

/// A load that swings below on a cord.
pub static SIGNATURE: Signature = Signature {
    needs: &[Need::Velocity],
    forms: |recorded| {
        // a load that lies on the ground does not swing
        let height_m = highest_m(recorded);
        let cords = CORD_LENGTHS_M.into_iter().filter(|length_m| *length_m < height_m);
        cords.map(|length_m| SIGNATURE.form(&[0.0, length_m, SWING_DAMPING_1_S], &[0])).collect()
    },
    refinement: Refinement {
        // of the length
        grid: Some(GridScale::Relative { slot: 1, step: 0.04, least: 0.002 }),
        // a load that swings freely is out of step with its neighbours on the grid
        grid_before_test: true,
        freed: |term| std::iter::once(1).chain(first_finer(term)).collect(),
        ..Refinement::NONE
    },
    naming: Naming {
        extra_z: 1.0,
        least_of_mass: LEAST_OF_MASS,
        // what swings too fast for the kernel is no load that a flight shows
        is_ordinary: |term, _| damping_ratio(term) > SWINGS_BELOW || term.values[1] < CORDS_M.0,
        usual: |parameter, vehicle| (parameter == "mass").then_some(0.08 * vehicle.body.mass_kg),
        ..Naming::PLAIN
    },
    role: Role { hangs_below: true, ..Role::NONE },
    joint: Joint {
        forms: Some(|_, _| {
            let of = |(damping_1_s, ratio): (f64, f64)| {
                cords_m(ratio)
                    .into_iter()
                    .map(move |length_m| SIGNATURE.term(&[0.0, length_m, damping_1_s], &[0]))
            };
            SWINGS.into_iter().flat_map(of).collect::<Vec<EffectTerm>>()
        }),
        ..Joint::PLAIN
    },
    picture: Picture::of(&[0, 1], Over::Time),
    sizes: &[
        ("mass", UsualSize::PerMass(0.08)),
        ("length", UsualSize::Of(0.8)),
        ("damping", UsualSize::Of(0.3)),
    ],
    ..Signature::of(
        &SlungLoad,
        &[0],
        Words {
            clause: Clause::Own(|named, _| {
                let (mass, length) = (named.said("mass", 1.0), named.said("length", 1.0));
                format!("A load swings below: {mass} kg on a cord of {length} m")
            }),
            ..Words::of("a slung load")
        },
    )
};

/// Damping ratio of a load's swing (-).
fn damping_ratio(term: &EffectTerm) -> f64 {
    let damping_1_s = first_finer(term).first().map_or(0.0, |slot| term.values[*slot]);
    SlungLoad::damping_ratio(term.values[1], damping_1_s)
}

/// Highest position above the ground, m, if position is known and the ground is at zero; otherwise infinite.
fn highest_m(recorded: &Recorded) -> f64 {
    if !recorded.all(|trace| trace.known.position) {
        return f64::INFINITY;
    }
    let heights = recorded
        .flights
        .iter()
        .flat_map(|trace| trace.centers.iter().map(|&row| trace.states[row].position_m.z));
    let highest_m = heights.fold(f64::MIN, f64::max);
    if highest_m > 0.0 { highest_m } else { f64::INFINITY }
}

/// Cord lengths that are fitted, m, with this ratio between neighbours.
fn cords_m(ratio: f64) -> Vec<f64> {
    let mut out = vec![CORDS_M.0];
    while let Some(last_m) = out.last().map(|length_m| length_m * ratio).filter(|m| *m <= CORDS_M.1) {
        out.push(last_m);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_swing_on_is_no_load() {
        let ratio = |damping_1_s: f64| damping_ratio(&SIGNATURE.term(&[0.1, 0.9, damping_1_s], &[0]));
        // 3.3 rad/s
        assert!((ratio(0.3) - 0.0454).abs() < 1e-4);
        assert!(ratio(0.5) < SWINGS_BELOW && ratio(3.0) > SWINGS_BELOW);
        assert_eq!(damping_ratio(&SIGNATURE.term(&[0.1, 0.9], &[0])), 0.0);
    }

    #[test]
    fn cords_reach_from_the_shortest_to_the_longest() {
        for (_, ratio) in SWINGS {
            let cords = cords_m(ratio);
            assert!(cords.windows(2).all(|pair| pair[1] > pair[0]) && cords[0] == CORDS_M.0);
            assert!(cords.last().is_some_and(|last| *last <= CORDS_M.1 && *last * ratio > CORDS_M.1));
        }
    }
}
