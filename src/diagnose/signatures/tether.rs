//! Signature: a tether.

use crate::diagnose::picture::{Over, Picture};
use crate::diagnose::recorded::{Need, Recorded};
use crate::diagnose::signature::{EffectTerm, Joint, Naming, Signature, Whence};
use crate::diagnose::usual_size::UsualSize;
use crate::diagnose::wording::{Clause, Words};
use crate::physics::effects::Tether;

/// A length of the tether that no flight reaches, m.
const SLACK_M: f64 = 500.0;
/// Least mass of a line per length, kg/m. A thin cable of two wires has as much.
const LEAST_LINE_KG_M: f64 = 0.005;
/// Least share of the vehicle's mass by which the weight of a line changes over the heights of a flight. Set by judgement: errors of the
/// thrust law are nearly as large, and follow the height by chance (1.8 and 1.9 % in two of 400 simulated flights without a line).
const LEAST_OF_MASS: f64 = 0.02;
/// Added to the least normal deviate. A thrust that drifts with height reached 6.2 in one real flight, where the hold-out refutes it. Set by
/// judgement.
const EXTRA_Z: f64 = 2.0;
/// Mass per length at which a carried line is tried, kg/m: a line without weight has no effect. A start value.
const LINE_KG_M: f64 = 0.01;
/// Lengths of a tether that are fitted, as shares of the farthest distance flown. A grid: the length is refined
/// afterwards.
const TAUT_AT: [f64; 6] = [0.4, 0.55, 0.7, 0.8, 0.9, 0.96];

/// A line to the ground.
pub static SIGNATURE: Signature = Signature {
    needs: &[Need::Position],
    forms: |_| vec![SIGNATURE.form(&[0.0, 0.0, SLACK_M, 0.0], &[0])],
    naming: Naming {
        least_of_mass: LEAST_OF_MASS,
        by_height: true,
        extra_z: EXTRA_Z,
        is_ordinary: |term, _| term.values[0] < LEAST_LINE_KG_M && term.values[1] == 0.0,
        ..Naming::PLAIN
    },
    joint: Joint {
        forms: Some(|recorded, _| terms(recorded)),
        whence: |_, slot, _, _| {
            (slot < 3).then_some(Whence::NotDetermined(
                "the line was not taut in this flight, or pulled too little to show",
            ))
        },
        ..Joint::PLAIN
    },
    picture: Picture::of(&[2], Over::Altitude),
    sizes: &[
        ("line_mass", UsualSize::PerMass(0.03)),
        ("stiffness", UsualSize::Of(0.0)),
        ("length", UsualSize::Of(500.0)),
    ],
    ..Signature::of(
        &Tether,
        &[0, 1],
        Words {
            clause: Clause::OneNumber {
                parameter: "line_mass",
                factor: 1e3,
                before: "A line leads down to the ground:",
                after: "g more for each metre of height",
            },
            ..Words::of("a tether")
        },
    )
};

/// Forms: slack, with a line that the vehicle carries or not; or taut at some distance.
fn terms(recorded: &Recorded) -> Vec<EffectTerm> {
    let far_m = farthest_m(recorded);
    let slack = [
        SIGNATURE.term(&[0.0, 0.0, SLACK_M], &[0]),
        SIGNATURE.term(&[LINE_KG_M, 0.0, SLACK_M, 0.5], &[0, 3]),
    ];
    let taut = TAUT_AT.iter().map(|share| share * far_m).filter(|length_m| *length_m > 0.5);
    let taut = taut.map(|length_m| SIGNATURE.term(&[0.0, 0.0, length_m], &[0, 1, 2]));
    slack.into_iter().chain(taut).collect()
}

/// Largest distance from the world's origin, m.
fn farthest_m(recorded: &Recorded) -> f64 {
    let flown = recorded
        .flights
        .iter()
        .flat_map(|trace| trace.centers.iter().map(move |&row| trace.states[row].position_m.norm()));
    flown.fold(0.0, f64::max)
}
