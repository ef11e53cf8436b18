//! The effects as readers want them: what is one thing to them is one entry.

use crate::diagnose::signatures::signature_of;
use crate::diagnose::{Named, NamedParameter};

/// Drag along the rotor axis within this share of that across it is one isotropic drag.
const ISOTROPIC: f64 = 0.35;

/// One drag where the search found it in two pieces: drag across the rotor axis, and thrust that falls with
/// climb, which is the same law along the axis.
#[must_use]
pub fn for_readers(named: &[Named]) -> Vec<Named> {
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
}
