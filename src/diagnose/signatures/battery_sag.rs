//! Signature: the battery's sag.

use crate::diagnose::picture::{Over, Picture};
use crate::diagnose::recorded::{Need, Recorded};
use crate::diagnose::signature::{EffectTerm, Form, Joint, Role, Signature, Whence};
use crate::diagnose::usual_size::UsualSize;
use crate::diagnose::wording::{Clause, Size, Words};
use crate::diagnose::words;
use crate::physics::effects::BatterySag;
use crate::text::significant;

/// Thrust that falls with the battery's voltage.
pub static SIGNATURE: Signature = Signature {
    needs: &[Need::Voltage],
    forms,
    role: Role { by_motion: false, ..Role::NONE },
    joint: Joint {
        forms: Some(|recorded, _| terms(recorded)),
        whence: |_, slot, _, _| {
            (slot == 1).then(|| {
                let why = "the highest recorded: the thrust that the vehicle file states is taken to be that at this voltage";
                Whence::Given(why.to_owned())
            })
        },
        ..Joint::PLAIN
    },
    picture: Picture::of(&[2], Over::Voltage),
    sizes: &[("exponent", UsualSize::Of(1.5)), ("full_voltage", UsualSize::Of(16.8))],
    ..Signature::of(
        &BatterySag,
        &[0, 1],
        Words {
            clause: Clause::Own(|named, _| {
                format!(
                    "Thrust falls with the battery: as its voltage to the power of {}, from {} V on",
                    named.said("exponent", 1.0),
                    significant(named.value("full_voltage"), 4)
                )
            }),
            size: Size::Own(
                |named| {
                    Some(format!("the voltage to the power of {}", words::said(named, "exponent", 1.0, "")?))
                },
                |_| None,
            ),
            limit: Some(|limit| {
                format!("thrust that falls as the voltage to the power of {}", significant(limit, 2))
            }),
            ..Words::of("battery sag")
        },
    )
};

fn terms(recorded: &Recorded) -> Vec<EffectTerm> {
    recorded.full_voltage().into_iter().map(|full_v| SIGNATURE.term(&[0.0, full_v], &[0])).collect()
}

/// Forms of the search. There are none if the rotor speeds are measured, because they contain the effect.
fn forms(recorded: &Recorded) -> Vec<Form> {
    if !recorded.all(|trace| !trace.measured_speeds) {
        return Vec::new();
    }
    terms(recorded).into_iter().map(|term| Form { term, instead_of_nuisance: false }).collect()
}
