//! Signature: thrust that falls with climb.

use crate::diagnose::picture::{Over, Picture};
use crate::diagnose::recorded::Need;
use crate::diagnose::signature::{Joint, Naming, Role, Signature};
use crate::diagnose::usual_size::UsualSize;
use crate::diagnose::wording::{Clause, Words};
use crate::physics::effects::{Inflow, LinearDrag};

use super::angular_damping;

/// Thrust that falls with the airspeed along the rotor axis.
pub static SIGNATURE: Signature = Signature {
    needs: &[Need::Velocity],
    // of the rotors, at their hubs, or of the body, at its centre
    forms: |recorded| {
        let at = |at_hubs: &f64| SIGNATURE.form(&[0.0, *at_hubs], &[0]);
        recorded.shares_at_hubs().iter().map(at).collect()
    },
    // 1/s: forces scale with the mass
    naming: Naming {
        usual: |parameter, vehicle| (parameter == "kz").then_some(0.4 * vehicle.body.mass_kg),
        ..Naming::PLAIN
    },
    role: Role {
        of_air: true,
        axial: Some(0),
        vertical: Some(0),
        axial_part_of: Some(&LinearDrag),
        damped_by: Some(|| angular_damping::SIGNATURE.whole()),
        ..Role::NONE
    },
    joint: Joint {
        forms: Some(|recorded, _| {
            let at = |at_hubs: &f64| SIGNATURE.term(&[0.0, *at_hubs], &[0, 1]);
            recorded.shares_at_hubs().iter().map(at).collect()
        }),
        ..Joint::PLAIN
    },
    picture: Picture::of(&[2], Over::AirspeedUp),
    sizes: &[("kz", UsualSize::PerMass(0.4))],
    ..Signature::of(
        &Inflow,
        &[0],
        Words {
            clause: Clause::OneNumber {
                parameter: "kz",
                factor: 1.0,
                before: "Thrust falls with climb: by",
                after: "N per m/s of airspeed along the rotor axis",
            },
            ..Words::of("thrust that falls with climb")
        },
    )
};
