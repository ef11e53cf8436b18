//! The effects that `[[effect]]` tables mean: `id`, and the parameters by name.

use super::ConfigError;
use super::check::Check;
use super::faults::Faults;
use crate::physics::{ActiveEffect, Parameter, PhysicsError, WHICH_ROTOR};
use crate::vehicle::Vehicle;

/// The effects of a file, which `origin` names in errors.
///
/// # Errors
/// [`ConfigError`] where a table is no effect, or one comes twice: all of it at once.
pub fn effects_of(
    tables: &[toml::Table],
    origin: &str,
    vehicle: &Vehicle,
) -> Result<Vec<ActiveEffect>, ConfigError> {
    let mut faults = Faults::default();
    let effects = checked(&Check { origin }, tables, Some(vehicle), &mut faults);
    faults.refuse(origin).map(|()| effects)
}

/// Each effect at most once, though one of each rotor; `origin` is named in errors.
///
/// # Errors
/// [`ConfigError`] where one comes twice.
pub fn each_once(effects: &[ActiveEffect], origin: &str) -> Result<(), ConfigError> {
    let mut faults = Faults::default();
    repeated(&Check { origin }, effects, &mut faults);
    faults.refuse(origin)
}

/// What is wrong with the tables. Of no vehicle where that has errors: what depends on it is not checked then.
pub(super) fn checked(
    check: &Check<'_>,
    tables: &[toml::Table],
    vehicle: Option<&Vehicle>,
    faults: &mut Faults,
) -> Vec<ActiveEffect> {
    let mut effects = Vec::with_capacity(tables.len());
    for (index, table) in tables.iter().enumerate() {
        effects.extend(effect(check, (index, table), vehicle, faults));
    }
    repeated(check, &effects, faults);
    effects
}

fn repeated(check: &Check<'_>, effects: &[ActiveEffect], faults: &mut Faults) {
    let rotor = |active: &ActiveEffect| {
        let slot = active.effect().parameters().iter().position(Parameter::is_rotor)?;
        active.parameters().get(slot).copied()
    };
    for (index, active) in effects.iter().enumerate() {
        let id = active.effect().id();
        let again = |other: &ActiveEffect| other.effect().id() == id && rotor(other) == rotor(active);
        if effects[..index].iter().any(again) {
            faults.check(Err(check.refuse("effect", "each effect once", format!("{id} twice"))));
        }
    }
}

/// What a rotor may be called.
fn rotors(vehicle: &Vehicle) -> String {
    let names: Vec<&str> = vehicle.rotors.iter().map(|rotor| rotor.name.as_str()).collect();
    format!("a rotor: 0 to {}, or its name ({})", names.len().saturating_sub(1), names.join(", "))
}

fn number(name: &str, value: &toml::Value, vehicle: Option<&Vehicle>) -> Option<f64> {
    let number = match value {
        toml::Value::Float(number) => *number,
        // whole numbers of a file are small
        toml::Value::Integer(number) => f64::from(i32::try_from(*number).ok()?),
        toml::Value::String(rotor) if name == WHICH_ROTOR => match vehicle {
            Some(vehicle) => vehicle.rotors.iter().position(|known| known.name == *rotor)? as f64,
            None => 0.0,
        },
        _ => return None,
    };
    let is_rotor = |vehicle: &Vehicle| (0..vehicle.rotors.len()).any(|index| index as f64 == number);
    (name != WHICH_ROTOR || vehicle.is_none_or(is_rotor)).then_some(number)
}

fn effect(
    check: &Check<'_>,
    (index, table): (usize, &toml::Table),
    vehicle: Option<&Vehicle>,
    faults: &mut Faults,
) -> Option<ActiveEffect> {
    let before = faults.count();
    let at = |name: &str| format!("effect[{index}].{name}");
    let id = match table.get("id") {
        Some(toml::Value::String(id)) => id,
        other => {
            let came = other.map_or_else(|| "nothing".to_owned(), ToString::to_string);
            faults.check(Err(check.refuse(&at("id"), "the id of an effect", came)));
            return None;
        }
    };
    let mut values = Vec::with_capacity(table.len());
    for (name, value) in table.iter().filter(|(name, _)| *name != "id") {
        let number = number(name, value, vehicle);
        if number.is_none() {
            let expected =
                vehicle.filter(|_| name == WHICH_ROTOR).map_or_else(|| "a number".to_owned(), rotors);
            faults.check(Err(check.refuse(&at(name), expected, value)));
        }
        values.push((name.as_str(), number));
    }
    let unread = |name: &str| values.iter().any(|(other, number)| *other == name && number.is_none());
    // what is no number is refused already
    let numbers: Vec<_> = values.iter().map(|(name, number)| (*name, number.unwrap_or(f64::NAN))).collect();
    let size = vehicle.map(Vehicle::size);
    let made = ActiveEffect::checked(id, &numbers, size.as_ref());
    let errors =
        made.as_ref().err().into_iter().flat_map(|(first, others)| std::iter::once(first).chain(others));
    for error in errors {
        match error {
            PhysicsError::UnknownEffect { expected, .. } => {
                faults.check(Err(check.refuse(&at("id"), format!("one of {expected}"), format!("\"{id}\""))));
            }
            PhysicsError::EffectParameter { name, expected, got, .. } if !unread(name) => {
                let expected = format!("of {id} {expected}");
                faults.check(Err(check.refuse(&at(name), expected, got)));
            }
            PhysicsError::EffectParameter { .. } => {}
            other => faults.check(Err(check.refuse(&format!("effect[{index}]"), "an effect", other))),
        }
    }
    made.ok().filter(|_| faults.count() == before)
}

#[cfg(test)]
mod tests {
    use crate::config::parse_vehicle;

    const X500: &str = include_str!("../../configs/x500.toml");

    fn said(tables: &str, vehicle: &str) -> String {
        parse_vehicle(&format!("{vehicle}\n{tables}"), "m.toml").unwrap_err().to_string()
    }

    #[test]
    fn all_errors_of_a_models_effects_are_told_with_the_file() {
        let tables = "[[effect]]\nid = \"linear_dragg\"\n\
                      [[effect]]\nid = \"com_offset\"\nx = 9000\ny = \"left\"\nq = 1.0\n\
                      [[effect]]\nid = \"weak_rotor\"\nrotor = \"tail\"\nfactor = 0.9\n\
                      [[effect]]\nid = 3\n";
        let said = said(tables, X500);
        for needle in [
            "`effect[0].id`: expected one of linear_drag, ",
            "got \"linear_dragg\"",
            "`effect[1].x`: expected of com_offset ",
            "got 9000",
            "`effect[1].y`: expected a number, got \"left\"",
            "`effect[1].q`: expected of com_offset one of x, y, z",
            "`effect[2].rotor`: expected a rotor: 0 to 3, or its name (",
            "`effect[3].id`: expected the id of an effect, got 3",
        ] {
            assert!(said.contains(needle), "{needle} is not in {said}");
        }
    }

    /// The bounds scale with the vehicle: they say nothing where that is wrong itself.
    #[test]
    fn with_a_wrong_vehicle_only_what_does_not_depend_on_it_is_told() {
        let vehicle = X500.replacen("mass = 2.064", "mass = -2.0", 1);
        assert_ne!(vehicle, X500);
        let tables = "[[effect]]\nid = \"inflow\"\nkz = 9000.0\n[[effect]]\nid = \"no_such\"\n";
        let said = said(tables, &vehicle);
        assert!(said.contains("`body.mass`") && said.contains("`effect[1].id`"), "{said}");
        assert!(!said.contains("effect[0]"), "{said}");
    }

    #[test]
    fn an_effect_comes_once_and_a_weak_rotor_once_a_rotor() {
        let drag = "[[effect]]\nid = \"inflow\"\nkz = 0.1\n";
        assert!(
            said(&drag.repeat(2), X500).contains("`effect`: expected each effect once, got inflow twice")
        );
        let weak = |rotor: usize| format!("[[effect]]\nid = \"weak_rotor\"\nrotor = {rotor}\nfactor = 0.9\n");
        let loaded = parse_vehicle(&format!("{X500}\n{}{}", weak(0), weak(1)), "m.toml").unwrap();
        assert_eq!(loaded.model.effects.len(), 2);
        assert!(said(&weak(1).repeat(2), X500).contains("weak_rotor twice"));
    }
}
