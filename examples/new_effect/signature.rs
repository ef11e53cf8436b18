//! How the side force is tried, named and said.

use mavid::diagnose::Need;
use mavid::diagnose::signature::{Role, Signature};
use mavid::diagnose::wording::Words;

use super::effect::SideForce;

/// A force across the airspeed.
pub static SIGNATURE: Signature = Signature {
    needs: &[Need::Velocity],
    forms: |_| vec![SIGNATURE.form(&[0.0], &[0])],
    role: Role { of_air: true, ..Role::NONE },
    ..Signature::of(&SideForce, &[0], Words::of("a side force"))
};
