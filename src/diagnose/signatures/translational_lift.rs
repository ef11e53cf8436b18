//! Signature: translational lift.

use crate::diagnose::picture::{Over, Picture};
use crate::diagnose::recorded::Need;
use crate::diagnose::signature::{Naming, Role, Signature};
use crate::diagnose::usual_size::UsualSize;
use crate::diagnose::wording::{Clause, Words};
use crate::physics::effects::TranslationalLift;

/// Thrust that grows with the airspeed across the rotor axis.
pub static SIGNATURE: Signature = Signature {
    needs: &[Need::Velocity],
    forms: |_| vec![SIGNATURE.form(&[0.0], &[0])],
    role: Role { of_air: true, ..Role::NONE },
    // 1/m: forces scale with the mass
    naming: Naming { usual: |_, vehicle| Some(0.12 * vehicle.body.mass_kg), ..Naming::PLAIN },
    picture: Picture::of(&[2], Over::Speed),
    sizes: &[("kh", UsualSize::PerMass(0.12))],
    ..Signature::of(
        &TranslationalLift,
        &[0],
        Words {
            clause: Clause::OneNumber {
                parameter: "kh",
                factor: 1.0,
                before: "Translational lift was left out:",
                after: "N per (m/s)^2 of airspeed across the rotor axis",
            },
            ..Words::of("translational lift")
        },
    )
};
