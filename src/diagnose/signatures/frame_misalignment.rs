//! Signature: a misaligned position reference.

use super::imu_misalignment::ORDINARY_RAD;
use crate::diagnose::channels::Nuisance;
use crate::diagnose::picture::{Over, Picture};
use crate::diagnose::recorded::{Need, Recorded};
use crate::diagnose::signature::{EffectTerm, Form, Joint, Naming, Refinement, Role, Signature, Whence};
use crate::diagnose::usual_size::UsualSize;
use crate::diagnose::wording::{Size, Words};
use crate::physics::effects::FrameMisalignment;

/// Slot of the share by which the attitude is rotated with its frame.
const WITH_ATTITUDE: usize = 3;

/// A position reference that is not level or not aligned, with or without the attitude.
pub static SIGNATURE: Signature = Signature {
    needs: &[Need::Frame],
    forms: |_: &Recorded| {
        vec![
            // turned with the attitude: about the vertical nothing changes
            Form { instead_of_nuisance: true, ..SIGNATURE.form(&[0.0; 3], &[0, 1]) },
            // only the position is askew, not the attitude
            SIGNATURE.form(&[0.0; 4], &[0, 1, 2]),
        ]
    },
    refinement: Refinement { freed: |_| Vec::new(), ..Refinement::NONE },
    naming: Naming {
        ordinary: Some(ORDINARY_RAD),
        // whether the attitude is turned as well
        says: |term, slot| slot == WITH_ATTITUDE || term.values[slot] != 0.0,
        ..Naming::PLAIN
    },
    role: Role {
        stands_for: |term, nuisance| matches!(nuisance, Nuisance::Level(_)) && turns_attitude(term),
        ..Role::NONE
    },
    joint: Joint {
        // turned with the attitude, its heading is for no equation of the vehicle's own motion to see; or only the
        // position is askew
        forms: Some(|_, _| vec![SIGNATURE.term(&[0.0; 3], &[0, 1]), SIGNATURE.term(&[0.0; 4], &[0, 1, 2])]),
        whence: |_, slot, _, _| {
            Some(if slot >= WITH_ATTITUDE {
                Whence::Given("only position and velocity are turned: the more likely form".to_owned())
            } else {
                Whence::NotDetermined(
                    "position, velocity and attitude are turned by the same angle: no equation of the vehicle's \
                     motion depends on a heading",
                )
            })
        },
        ..Joint::PLAIN
    },
    picture: Picture::of(&[0, 1, 2], Over::Thrust),
    sizes: &[("x", UsualSize::Of(0.035)), ("y", UsualSize::Of(-0.026)), ("z", UsualSize::Of(0.0))],
    ..Signature::of(
        &FrameMisalignment,
        &[0, 1, 2],
        Words {
            size: Size::Norm { factor: 1.0_f64.to_degrees(), unit: "deg" },
            ..Words::of("a misaligned position reference")
        },
    )
};

fn turns_attitude(term: &EffectTerm) -> bool {
    term.values.get(WITH_ATTITUDE).is_none_or(|share| *share > 0.0)
}
