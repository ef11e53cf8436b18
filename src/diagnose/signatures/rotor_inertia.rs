//! Signature: the rotors' own inertia.

use crate::diagnose::picture::{Over, Picture};
use crate::diagnose::recorded::Need;
use crate::diagnose::signature::{Naming, OfTheVehicle, Role, Signature};
use crate::diagnose::usual_size::UsualSize;
use crate::diagnose::wording::{Clause, Words};
use crate::physics::effects::RotorInertia;

/// The rotors' own inertia.
pub static SIGNATURE: Signature = Signature {
    needs: &[Need::Torques],
    forms: |_| vec![SIGNATURE.form(&[0.0], &[0])],
    // and no force of the room, which position and velocity tell of, looks like it
    naming: Naming { ubiquitous: true, ..Naming::PLAIN },
    role: Role { spin_up: Some(0), of_the_vehicle: Some(OfTheVehicle::of(&[0])), ..Role::NONE },
    picture: Picture::of(&[5], Over::Time),
    sizes: &[("jr", UsualSize::PerInertia(0.0015))],
    ..Signature::of(
        &RotorInertia,
        &[0],
        Words {
            clause: Clause::OneNumber {
                parameter: "jr",
                factor: 1.0,
                before: "The rotors' own inertia was left out:",
                after: "kg m^2 each; a change of their speed yaws the vehicle, and a rotation of the vehicle causes \
                        gyroscopic torques",
            },
            ..Words::of("the rotors' inertia")
        },
    )
};
