//! The effects as readers want them: what is one thing to them is one entry, and what is two things are two.

use crate::diagnose::signatures::{ALL, signature_of};
use crate::diagnose::{Named, NamedParameter, Strength};

/// Drag along the rotor axis within this share of that across it is one isotropic drag. Chosen; not measured.
const ISOTROPIC: f64 = 0.35;

/// Drag along the rotor axis exceeds that across it beyond this many standard errors. Chosen; not measured.
const TOLD_APART: f64 = 4.0;

/// One drag where the search found it in two pieces: drag across the rotor axis, and thrust that falls with
/// climb, which is the same law along the axis. Both where the search found them in one, and the part along the axis is more
/// than a drag of the body would be.
#[must_use]
pub fn for_readers(named: &[Named]) -> Vec<Named> {
    let mut out = merged(named);
    if out.iter().all(|named| signature_of(named.id).is_none_or(|of| of.role.axial_part_of.is_none())) {
        let parts: Vec<Named> = out.iter_mut().filter_map(part_of_climb).collect();
        out.extend(parts);
    }
    out
}

/// Takes out of a drag what it has along the rotor axis, if that is thrust that falls with climb.
fn part_of_climb(drag: &mut Named) -> Option<Named> {
    let signature = ALL.iter().find(|of| of.role.axial_part_of.is_some_and(|whole| whole.id() == drag.id))?;
    let value = |name: &str| drag.parameters.iter().find(|p| p.name == name).copied();
    let (dx, dy, dz) = (value("dx")?, value("dy")?, value("dz")?);
    let across = 0.5 * (dx.value + dy.value);
    let beyond = dz.value - across;
    let std = dz.std.hypot(0.5 * dx.std.hypot(dy.std));
    // that of the body grows with no rotor's speed and acts at its centre
    let of_body = ["at_hubs", "with_speed"].iter().any(|name| value(name).is_some_and(|of| of.value == 0.0));
    if of_body || across <= 0.0 || beyond < ISOTROPIC * across || beyond < TOLD_APART * std {
        return None;
    }
    drag.parameters.retain(|parameter| parameter.name != "dz");
    let own = signature.effect.parameters().first()?;
    let z = dz.value / dz.std.max(f64::MIN_POSITIVE);
    Some(Named {
        id: signature.id(),
        sentence: signature.effect.sentence(),
        parameters: vec![NamedParameter { name: own.name, ..dz }],
        strength: Strength { z, energy: z * z, count: 1, ..drag.strength },
        confusable_with: Vec::new(),
    })
}

fn merged(named: &[Named]) -> Vec<Named> {
    let mut out = named.to_vec();
    let axial_part_of = |named: &Named| signature_of(named.id)?.role.axial_part_of;
    let axial = named.iter().enumerate().find_map(|(place, of)| Some((place, axial_part_of(of)?)));
    let Some((inflow, whole)) = axial else { return out };
    let Some(drag) = named.iter().position(|effect| effect.id == whole.id()) else { return out };
    let value = |effect: usize, name: &str| named[effect].parameters.iter().find(|p| p.name == name).copied();
    let (Some(dx), Some(dy), Some(kz)) = (value(drag, "dx"), value(drag, "dy"), value(inflow, "kz")) else {
        return out;
    };
    let across = 0.5 * (dx.value + dy.value);
    if value(drag, "dz").is_some() || (kz.value - across).abs() > ISOTROPIC * across {
        return out;
    }
    out[drag].parameters.push(NamedParameter { name: "dz", ..kz });
    for confusable in &named[inflow].confusable_with {
        let known = out[drag].confusable_with.iter().any(|other| other.id == confusable.id);
        if !known && confusable.id != whole.id() {
            out[drag].confusable_with.push(*confusable);
        }
    }
    out[drag].confusable_with.retain(|confusable| confusable.id != named[inflow].id);
    out.remove(inflow);
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::Strength;

    fn named(id: &'static str, values: &[(&'static str, f64)]) -> Named {
        Named {
            id,
            sentence: "",
            parameters: values
                .iter()
                .map(|(name, value)| NamedParameter { name, value: *value, std: 0.01, unit: "N/(m/s)" })
                .collect(),
            strength: Strength::default(),
            confusable_with: Vec::new(),
        }
    }

    #[test]
    fn isotropic_drag_is_one_effect_and_other_drag_stays_two() {
        let both = |kz| [named("inflow", &[("kz", kz)]), named("linear_drag", &[("dx", 0.4), ("dy", 0.5)])];
        let merged = for_readers(&both(0.55));
        assert_eq!(merged.len(), 1);
        assert_eq!(merged[0].id, "linear_drag");
        assert_eq!((merged[0].parameters[2].name, merged[0].parameters[2].value), ("dz", 0.55));
        assert_eq!(for_readers(&both(0.9)).len(), 2);
        assert_eq!(for_readers(&both(0.9)[..1]).len(), 1);
    }

    #[test]
    fn what_a_drag_has_beyond_along_the_rotor_axis_is_thrust_that_falls_with_climb() {
        let drag = |dz| [named("linear_drag", &[("dx", 0.4), ("dy", 0.5), ("dz", dz)])];
        let split = for_readers(&drag(0.9));
        assert_eq!(split.iter().map(|of| of.id).collect::<Vec<_>>(), ["linear_drag", "inflow"]);
        assert_eq!(split[0].parameters.len(), 2);
        assert_eq!((split[1].parameters[0].name, split[1].parameters[0].value), ("kz", 0.9));
        assert_eq!(for_readers(&drag(0.55)).len(), 1);
        assert_eq!(for_readers(&drag(0.1)).len(), 1);
    }
}
