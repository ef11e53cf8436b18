//! Signature: a misaligned inertial unit.

use crate::diagnose::picture::{Over, Picture};
use crate::diagnose::recorded::Need;
use crate::diagnose::signature::{Naming, Role, Signature};
use crate::diagnose::usual_size::UsualSize;
use crate::diagnose::wording::{Size, Words};
use crate::physics::effects::ImuMisalignment;

/// Misalignment that ordinary vehicles have, rad: about a degree, as far as the level of an autopilot and its estimate of attitude and
/// heading are off. Set by judgement: with half a degree, three of thirteen flights of ArduPilot's simulator had it.
pub(super) const ORDINARY_RAD: f64 = 0.02;

/// An inertial unit that is rotated against the body.
pub static SIGNATURE: Signature = Signature {
    needs: &[Need::Accelerometer, Need::ForceTwice],
    forms: |_| vec![SIGNATURE.form(&[0.0; 3], &[0, 1, 2])],
    naming: Naming { ordinary: Some(ORDINARY_RAD), ..Naming::PLAIN },
    role: Role { turns_inertial_unit: true, ..Role::NONE },
    picture: Picture::of(&[0, 1, 2], Over::Thrust),
    sizes: &[("x", UsualSize::Of(0.035)), ("y", UsualSize::Of(-0.026)), ("z", UsualSize::Of(0.03))],
    ..Signature::of(
        &ImuMisalignment,
        &[0, 1, 2],
        Words {
            size: Size::Norm { factor: 1.0_f64.to_degrees(), unit: "deg" },
            ..Words::of("a misaligned inertial unit")
        },
    )
};
