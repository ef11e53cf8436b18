//! Signature: damping of the rotation.

use crate::diagnose::picture::{Over, Picture};
use crate::diagnose::recorded::Need;
use crate::diagnose::signature::{Form, Naming, Role, Signature};
use crate::diagnose::usual_size::UsualSize;
use crate::diagnose::wording::{Clause, Size, Words};
use crate::diagnose::words::axes;
use crate::physics::effects::AngularDamping;
use crate::vehicle::Vehicle;

/// Damping of the rotation.
pub static SIGNATURE: Signature = Signature {
    needs: &[Need::Torques],
    forms: |_| forms(),
    naming: Naming { usual, ..Naming::PLAIN },
    role: Role {
        // nor is it what tells a vehicle from another: the phase of a log's commands and the law of the rotors' torque move it by its size
        like_latency: Some(|| SIGNATURE.whole()),
        ..Role::NONE
    },
    picture: Picture::of(&[3, 4, 5], Over::Rate),
    sizes: &[
        ("bx", UsualSize::PerInertia(0.8)),
        ("by", UsualSize::PerInertia(0.8)),
        ("bz", UsualSize::PerInertia(0.8)),
    ],
    ..Signature::of(
        &AngularDamping,
        &[0, 1, 2],
        Words {
            clause: Clause::Own(|named, _| {
                format!(
                    "Damping of the rotation was left out: {}",
                    axes(named, &["bx", "by", "bz"], "N m per rad/s")
                )
            }),
            size: Size::Axes,
            expected_in_motion: Some(1),
            ..Words::of("damping of the rotation")
        },
    )
};

fn forms() -> Vec<Form> {
    vec![SIGNATURE.form(&[0.0; 3], &[0, 1, 2]), SIGNATURE.form(&[0.0; 3], &[0, 1])]
}

/// Usual size: torques scale with the inertia, 0.8 1/s.
fn usual(parameter: &str, vehicle: &Vehicle) -> Option<f64> {
    let axis = ["bx", "by", "bz"].iter().position(|name| *name == parameter)?;
    Some(0.8 * vehicle.body.inertia_kg_m2[(axis, axis)])
}
