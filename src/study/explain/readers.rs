//! Merges or splits effects for the report: an isotropic drag is one entry.

use crate::diagnose::signature::Signature;
use crate::diagnose::signatures::{ALL, signature_of};
use crate::diagnose::{Named, NamedParameter, Strength};

/// Drag along the rotor axis within this share of that across it is one isotropic drag. Only words depend on it: one
/// drag, or drag and thrust that falls with climb; the model is the same.
const ISOTROPIC: f64 = 0.35;

/// Drag along the rotor axis exceeds that across it beyond this many standard errors. Only words depend on it: one
/// drag, or drag and thrust that falls with climb; the model is the same.
const TOLD_APART: f64 = 4.0;

/// One drag where the search found it in two pieces: drag across the rotor axis, and thrust that falls with
/// climb, which is the same law along the axis. Both where the search found them in one, and the part along the axis is more
/// than a drag of the body would be. `airspeed_m_s` is the mean airspeed of the flights, m/s.
#[must_use]
pub fn for_readers(named: &[Named], airspeed_m_s: f64) -> Vec<Named> {
    let mut out = merged(named, airspeed_m_s);
    if out.iter().all(|named| signature_of(named.id).is_none_or(|of| of.role.axial_part_of.is_none())) {
        let others: Vec<f64> = out.iter().map(|drag| of_others(&out, drag, airspeed_m_s)).collect();
        let of = |(drag, others): (&mut Named, f64)| part_of_climb(drag, others);
        let parts: Vec<Named> = out.iter_mut().zip(others).filter_map(of).collect();
        out.extend(parts);
    }
    out
}

/// What the other drags, which are known across the rotor axis only, may have in the term of one along the axis, N/(m/s).
fn of_others(named: &[Named], drag: &Named, airspeed_m_s: f64) -> f64 {
    let others = named.iter().filter(|other| other.id != drag.id);
    others.filter_map(|other| slope_along(other, airspeed_m_s)).sum()
}

/// Takes out of a drag what it has along the rotor axis, if that is thrust that falls with climb. Other drags may have up to so much of it,
/// N/(m/s).
fn part_of_climb(drag: &mut Named, others: f64) -> Option<Named> {
    let signature = ALL.iter().find(|of| of.role.axial_part_of.is_some_and(|whole| whole.id() == drag.id))?;
    let whole = Slots(signature_of(drag.id)?);
    let (dx, dy, dz) = (whole.of(drag, 0)?, whole.of(drag, 1)?, whole.axial(drag)?);
    let across = 0.5 * (dx.value + dy.value) + others;
    let beyond = dz.value - across;
    let std = dz.std.hypot(0.5 * dx.std.hypot(dy.std));
    // that of the body grows with no rotor's speed and acts at its centre
    let (first, last) = (whole.0.effect.parameters().len(), whole.0.role.with_speed?.0);
    let of_body = (first..=last).any(|slot| whole.of(drag, slot).is_some_and(|of| of.value == 0.0));
    if of_body || across <= 0.0 || beyond < ISOTROPIC * across || beyond < TOLD_APART * std {
        return None;
    }
    drag.parameters.retain(|parameter| parameter.name != dz.name);
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

fn merged(named: &[Named], airspeed_m_s: f64) -> Vec<Named> {
    let mut out = named.to_vec();
    let axial_part_of = |named: &Named| signature_of(named.id)?.role.axial_part_of;
    let axial = named.iter().enumerate().find_map(|(place, of)| Some((place, axial_part_of(of)?)));
    let Some((part, whole)) = axial else { return out };
    let Some(drag) = named.iter().position(|effect| effect.id == whole.id()) else { return out };
    let Some(added) = added(named, (&named[drag], &named[part]), airspeed_m_s) else { return out };
    out[drag].parameters.push(added);
    for confusable in &named[part].confusable_with {
        let known = out[drag].confusable_with.iter().any(|other| other.id == confusable.id);
        if !known && confusable.id != whole.id() {
            out[drag].confusable_with.push(*confusable);
        }
    }
    out[drag].confusable_with.retain(|confusable| confusable.id != named[part].id);
    out.remove(part);
    out
}

/// The drag's parameter along the rotor axis, by the effect that has the same law there, where both are one isotropic drag.
fn added(named: &[Named], (drag, part): (&Named, &Named), airspeed_m_s: f64) -> Option<NamedParameter> {
    let (whole, own) = (Slots(signature_of(drag.id)?), Slots(signature_of(part.id)?));
    let (dx, dy, kz) = (whole.of(drag, 0)?, whole.of(drag, 1)?, own.axial(part)?);
    let across = 0.5 * (dx.value + dy.value);
    let most = across + of_others(named, drag, airspeed_m_s);
    let isotropic = (1.0 - ISOTROPIC) * across..=(1.0 + ISOTROPIC) * most;
    let other = whole.axial(drag).is_some() || !isotropic.contains(&kz.value);
    (!other).then_some(NamedParameter { name: whole.name(whole.0.role.axial?)?, ..kz })
}

/// Slope of a force with the square of the airspeed across the motion, over the mean of that across and along it.
const ACROSS_MOTION: f64 = 2.0 / 3.0;

/// What a drag that has no part of its own along the rotor axis may have there at this airspeed, N/(m/s): vehicles move across that axis.
fn slope_along(drag: &Named, airspeed_m_s: f64) -> Option<f64> {
    let law = Slots(signature_of(drag.id)?);
    let by_face = drag.get("by_face").map_or(0.0, |share| share.value);
    let slope = ACROSS_MOTION * (1.0 - by_face) * law.0.role.lateral_slope?(airspeed_m_s);
    let (x, y) = (law.of(drag, 0)?, law.of(drag, 1)?);
    let along = law.0.role.vertical.and_then(|slot| law.of(drag, slot));
    along.is_none().then_some(0.5 * slope * (x.value + y.value))
}

/// The values of a named effect by the slots of its signature.
struct Slots(&'static Signature);

impl Slots {
    fn name(&self, slot: usize) -> Option<&'static str> {
        let effect = self.0.effect;
        let mut all = effect.parameters().iter().chain(effect.finer_parameters());
        Some(all.nth(slot)?.name)
    }

    fn of(&self, named: &Named, slot: usize) -> Option<NamedParameter> {
        named.get(self.name(slot)?).copied()
    }

    fn axial(&self, named: &Named) -> Option<NamedParameter> {
        self.of(named, self.0.role.axial?)
    }
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
        let merged = for_readers(&both(0.55), 3.0);
        assert_eq!(merged.len(), 1);
        assert_eq!(merged[0].id, "linear_drag");
        assert_eq!((merged[0].parameters[2].name, merged[0].parameters[2].value), ("dz", 0.55));
        assert_eq!(for_readers(&both(0.9), 3.0).len(), 2);
        assert_eq!(for_readers(&both(0.9)[..1], 3.0).len(), 1);
    }

    #[test]
    fn what_a_drag_has_beyond_along_the_rotor_axis_is_thrust_that_falls_with_climb() {
        let drag = |dz| [named("linear_drag", &[("dx", 0.4), ("dy", 0.5), ("dz", dz)])];
        let split = for_readers(&drag(0.9), 3.0);
        assert_eq!(split.iter().map(|of| of.id).collect::<Vec<_>>(), ["linear_drag", "inflow"]);
        assert_eq!(split[0].parameters.len(), 2);
        assert_eq!((split[1].parameters[0].name, split[1].parameters[0].value), ("kz", 0.9));
        assert_eq!(for_readers(&drag(0.55), 3.0).len(), 1);
        assert_eq!(for_readers(&drag(0.1), 3.0).len(), 1);
    }

    #[test]
    fn a_drag_with_the_square_of_the_airspeed_is_in_the_term_along_the_rotor_axis() {
        let with = |square: &[(&'static str, f64)]| {
            let drag = named("linear_drag", &[("dx", 0.4), ("dy", 0.5)]);
            [named("inflow", &[("kz", 0.9)]), drag, named("quadratic_drag", square)]
        };
        // 0.45 + 0.15 * 3 = 0.9 N/(m/s) along the axis at 3 m/s across it
        let across = [("cx", 0.15), ("cy", 0.15)];
        let ids =
            |named: &[Named], speed| for_readers(named, speed).iter().map(|of| of.id).collect::<Vec<_>>();
        assert_eq!(ids(&with(&across), 3.0), ["linear_drag", "quadratic_drag"]);
        let [_, drag, square] = with(&across);
        let mut drag = drag;
        drag.parameters.push(NamedParameter { name: "dz", value: 0.9, std: 0.01, unit: "N/(m/s)" });
        let whole = [drag, square];
        assert_eq!(ids(&whole, 3.0), ["linear_drag", "quadratic_drag"]);
        assert_eq!(ids(&whole, 0.2), ["linear_drag", "quadratic_drag", "inflow"]);
        // at a slow pace it has no such part, and one with its own part along the axis has none in this term
        assert_eq!(ids(&with(&across), 0.2), ["inflow", "linear_drag", "quadratic_drag"]);
        let all = [("cx", 0.15), ("cy", 0.15), ("cz", 0.15)];
        assert_eq!(ids(&with(&all), 3.0), ["inflow", "linear_drag", "quadratic_drag"]);
    }
}
