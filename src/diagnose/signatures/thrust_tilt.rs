//! Signature: a tilted thrust axis.

use crate::diagnose::channels::Nuisance;
use crate::diagnose::picture::{Over, Picture};
use crate::diagnose::signature::{Form, Naming, Role, Signature};
use crate::diagnose::usual_size::UsualSize;
use crate::diagnose::wording::{Clause, Size, Words};
use crate::physics::effects::ThrustTilt;

/// Tilt of the thrust axis that ordinary vehicles have, rad. A force that is fixed in the body reads as the offset of the
/// accelerometer does, and that of autopilots' sensors is 20 mg by their makers (ICM-42688-P, data sheet, table 2).
const ORDINARY_RAD: f64 = 0.02;

/// A tilted thrust axis.
pub static SIGNATURE: Signature = Signature {
    forms: |_| vec![Form { instead_of_nuisance: true, ..SIGNATURE.form(&[0.0; 2], &[0, 1]) }],
    naming: Naming { ordinary: Some(ORDINARY_RAD), ..Naming::PLAIN },
    role: Role { stands_for: |_, nuisance| matches!(nuisance, Nuisance::Tilt(_)), ..Role::NONE },
    picture: Picture::of(&[0, 1], Over::Thrust),
    sizes: &[("x", UsualSize::Of(0.025)), ("y", UsualSize::Of(-0.02))],
    ..Signature::of(
        &ThrustTilt,
        &[0, 1],
        Words {
            clause: Clause::Own(|named, _| {
                format!(
                    "The thrust axis is tilted by {} deg about body x and {} deg about body y: the thrust has a \
                     sideways component that is fixed in the body",
                    named.said("x", 1.0_f64.to_degrees()),
                    named.said("y", 1.0_f64.to_degrees())
                )
            }),
            size: Size::Norm { factor: 1.0_f64.to_degrees(), unit: "deg" },
            ..Words::of("a tilted thrust axis")
        },
    )
};
