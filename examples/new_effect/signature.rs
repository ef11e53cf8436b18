//! How the side force is tried, named and said.

use mavid::diagnose::Need;
use mavid::diagnose::signature::{Naming, Role, Signature};
use mavid::diagnose::wording::Words;

use super::effect::SideForce;

/// A force across the airspeed.
pub static SIGNATURE: Signature = Signature {
    needs: &[Need::Velocity],
    forms: |_| vec![SIGNATURE.form(&[0.0], &[0])],
    // 1/s: forces scale with the mass
    naming: Naming { usual: |_, vehicle| Some(0.2 * vehicle.body.mass_kg), ..Naming::PLAIN },
    role: Role { of_air: true, ..Role::NONE },
    ..Signature::of(&SideForce, &[0], Words::of("a side force"))
};
