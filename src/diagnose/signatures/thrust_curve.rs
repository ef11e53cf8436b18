//! Signature: a bent thrust curve.

use crate::diagnose::picture::{Over, Picture};
use crate::diagnose::signature::{Joint, Naming, OfTheVehicle, Role, Signature};
use crate::diagnose::usual_size::UsualSize;
use crate::diagnose::wording::{Clause, Size, Words};
use crate::physics::effects::ThrustCurve;
use crate::text::significant;

/// Curvature up to which a thrust curve counts as known (-). Set by judgement: with less, ordinary vehicles would
/// have it.
const ORDINARY_BEND: f64 = 0.02;

/// A thrust curve with another curvature than in the vehicle file.
pub static SIGNATURE: Signature = Signature {
    forms: |_| vec![SIGNATURE.form(&[0.0; 2], &[0])],
    naming: Naming {
        ordinary: Some(ORDINARY_BEND),
        // it bends the commands' own noise, too
        extra_z: 1.0,
        usual: |parameter, _| (parameter == "curvature").then_some(0.15),
        ..Naming::PLAIN
    },
    role: Role { bends_thrust: Some(0), of_the_vehicle: Some(OfTheVehicle::of(&[0])), ..Role::NONE },
    joint: Joint {
        forms: Some(|_, _| vec![SIGNATURE.term(&[0.0], &[0]), SIGNATURE.term(&[0.0; 2], &[0, 1])]),
        ..Joint::PLAIN
    },
    picture: Picture::of(&[2], Over::Thrust),
    sizes: &[("curvature", UsualSize::Of(0.15))],
    ..Signature::of(
        &ThrustCurve,
        &[0],
        Words {
            clause: Clause::Own(|named, _| {
                let bend = named.value("curvature");
                format!(
                    "The thrust curve is bent: near hover the thrust changes {} % {} with the command than in the \
                     vehicle file",
                    named.said("curvature", 100.0 * bend.signum()),
                    if bend > 0.0 { "more" } else { "less" }
                )
            }),
            size: Size::Of { parameter: "curvature", factor: 100.0, unit: "% about hover" },
            limit: Some(|limit| {
                format!("a thrust that changes {} % more about hover", significant(100.0 * limit, 2))
            }),
            ..Words::of("a bent thrust curve")
        },
    )
};
