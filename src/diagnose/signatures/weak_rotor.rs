//! Signature: a rotor that is weaker than the others.

use crate::diagnose::named::Named;
use crate::diagnose::picture::{Over, Picture};
use crate::diagnose::recorded::Recorded;
use crate::diagnose::signature::{EffectTerm, Form, Joint, Naming, OfTheVehicle, Role, Signature, Whence};
use crate::diagnose::usual_size::UsualSize;
use crate::diagnose::wording::{Clause, Size, Words};
use crate::diagnose::words;
use crate::physics::effects::WeakRotor;
use crate::text::{significant, with_error};
use crate::vehicle::Vehicle;

/// Slots of the values: the rotor's number and the factor on its thrust.
const ROTOR: usize = 0;
const FACTOR: usize = 1;
/// Difference between rotors of one vehicle that is ordinary (-). Set by judgement: with less, ordinary vehicles
/// would have it.
const SCATTER: f64 = 0.08;
/// Difference of one rotor that is ordinary (-): no two motors and propellers are more alike. Set by judgement: with
/// less, ordinary vehicles would have it.
const ALIKE: f64 = 0.005;
/// Difference of a second rotor, as a share of that of the first, below which it is none. Set by judgement; measured
/// only together with all conditions of a name (see `Gates`).
const BESIDE: f64 = 0.33;
/// Least standard error of a rotor's thrust factor (-). Rotors continue to move between samples at 100 Hz: flights of
/// the embedded vehicle are off by 0.09 to 0.10 %, all on the same side, while noise alone would give 0.01 to 0.02 %.
const BETWEEN_SAMPLES: f64 = 0.001;

/// A rotor that is weaker than the others.
pub static SIGNATURE: Signature = Signature {
    nothing: 1.0,
    forms: |recorded| {
        let rotors = terms(recorded.vehicle.rotors.len()).into_iter();
        rotors.map(|term| Form { term, instead_of_nuisance: false }).collect()
    },
    naming: Naming {
        ordinary_alone: ALIKE,
        is_ordinary,
        least_std: BETWEEN_SAMPLES,
        // the first rotor's number is 0
        says: |term, slot| slot == ROTOR || term.values[slot] != 0.0,
        ..Naming::PLAIN
    },
    role: Role { which: Some(ROTOR), of_the_vehicle: Some(OfTheVehicle::of(&[FACTOR])), ..Role::NONE },
    joint: Joint {
        forms: Some(|recorded: &Recorded, _| {
            terms(recorded.airframe.as_ref().map_or(0, |airframe| airframe.rotor_count()))
        }),
        whence: |term, slot, vehicle, _| {
            (slot == ROTOR).then(|| {
                let named = vehicle.rotor_of(term.values[ROTOR]).map(|index| vehicle.motor_words(index));
                Whence::Given(named.unwrap_or_else(|| "the likeliest".to_owned()))
            })
        },
        ..Joint::PLAIN
    },
    picture: Picture::of(&[3, 4], Over::OneRotor),
    sizes: &[("rotor", UsualSize::Of(1.0)), ("factor", UsualSize::Of(0.92))],
    ..Signature::of(
        &WeakRotor,
        &[FACTOR],
        Words {
            noun_of: Some(|named, vehicle| {
                let what = if named.value("factor") < 1.0 { "weak" } else { "strong" };
                format!("a {what} {}", motor_words(vehicle, named.value("rotor")))
            }),
            clause: Clause::Own(clause),
            size: Size::Own(
                |named| {
                    let p = named.get("factor")?;
                    let change = 100.0 * (1.0 - p.value).abs();
                    Some(format!("{} %", words::plain(change, 100.0 * p.std)))
                },
                |_| None,
            ),
            limit: Some(|limit| format!("a rotor {} % weak", significant(100.0 * limit, 2))),
            told_if_absent: Some(2),
            ..Words::of("a weak rotor")
        },
    )
};

fn terms(rotors: usize) -> Vec<EffectTerm> {
    (0..rotors).map(|rotor| SIGNATURE.term(&[rotor as f64, 1.0], &[FACTOR])).collect()
}

/// Whether it is ordinary: one rotor is stronger, or hardly weaker, or several differ, within the usual scatter of rotors. What
/// differs by far less than another rotor is no second one.
fn is_ordinary(term: &EffectTerm, all: &[EffectTerm]) -> bool {
    let every = || all.iter().filter(|other| other.is(&SIGNATURE)).map(|rotor| rotor.values[FACTOR]);
    let greatest = every().map(|factor| 1.0 - factor).fold(0.0, f64::max);
    let counts = |factor: &f64| (factor - 1.0).abs() >= BESIDE * greatest;
    let rotors = || every().filter(counts);
    let factor = term.values[FACTOR];
    factor > 1.0 - ALIKE
        || !counts(&factor)
        || rotors().count() > 1 && rotors().all(|other| other > 1.0 - SCATTER)
        || rotors().any(|other| other > 1.0) && factor > 1.0 - SCATTER
}

/// `motor 3 (front left)`, by the rotor's place from 0.
fn motor_words(vehicle: &Vehicle, number: f64) -> String {
    vehicle.rotor_of(number).map_or_else(|| "motor".to_owned(), |index| vehicle.motor_words(index))
}

fn clause(named: &Named, vehicle: &Vehicle) -> String {
    let name = motor_words(vehicle, named.value("rotor"));
    let factor = named.value("factor");
    let std = named.get("factor").map_or(0.0, |p| p.std);
    let (what, change) = if factor < 1.0 { ("weak", 1.0 - factor) } else { ("strong", factor - 1.0) };
    format!(
        "{name} is {what}: its thrust and torque are {} % {} than the others'",
        with_error(100.0 * change, 100.0 * std),
        if factor < 1.0 { "less" } else { "more" }
    )
    .replacen('m', "M", 1)
}
