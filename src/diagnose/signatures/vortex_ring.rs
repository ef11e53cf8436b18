//! Signature: the vortex ring state.

use crate::diagnose::picture::{Over, Picture};
use crate::diagnose::recorded::Need;
use crate::diagnose::signature::{Role, Signature};
use crate::diagnose::usual_size::UsualSize;
use crate::diagnose::wording::{Clause, Words};
use crate::physics::effects::VortexRing;
use crate::text::significant;

/// Loss of thrust in a descent into the vehicle's own wake.
pub static SIGNATURE: Signature = Signature {
    needs: &[Need::Velocity],
    forms: |_| vec![SIGNATURE.form(&[0.0], &[0])],
    role: Role { of_air: true, in_descent: true, ..Role::NONE },
    picture: Picture::of(&[2], Over::AirspeedUp),
    sizes: &[("loss", UsualSize::Of(2.0))],
    ..Signature::of(
        &VortexRing,
        &[0],
        Words {
            clause: Clause::OneNumber {
                parameter: "loss",
                factor: 1.0,
                before: "The vehicle sank into its own wake: the loss of thrust is",
                after: "times that of Leishman's vortex ring",
            },
            limit: Some(|limit| {
                format!("a loss of thrust {} times that of Leishman's vortex ring", significant(limit, 2))
            }),
            ..Words::of("the vortex ring state")
        },
    )
};
