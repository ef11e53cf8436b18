//! Signature: the rotors' hub moment.

use crate::diagnose::recorded::Need;
use crate::diagnose::signature::{Role, Signature};
use crate::diagnose::wording::{Clause, Words};
use crate::physics::effects::BladeFlapping;

/// A moment at the rotors' hubs by the airspeed across their axes.
pub static SIGNATURE: Signature = Signature {
    needs: &[Need::Velocity],
    forms: |_| vec![SIGNATURE.form(&[0.0], &[0])],
    role: Role { of_air: true, ..Role::NONE },
    ..Signature::of(
        &BladeFlapping,
        &[0],
        Words {
            clause: Clause::OneNumber {
                parameter: "k",
                factor: 1.0,
                before: "The rotors' hub moment was left out:",
                after: "N m per m/s of airspeed across the rotor axis",
            },
            ..Words::of("the rotors' hub moment")
        },
    )
};
