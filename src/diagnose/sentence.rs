//! A named effect in the words of its signature.

use super::named::{DetectionLimit, Named, NamedParameter};
use super::signature::Signature;
use super::signatures::signature_of;
use super::wording::{Clause, Size};
use super::words::{largest, largest_across, norm, plain, range, range_across, said};
use crate::text::{significant, spoken, with_error};
use crate::vehicle::Vehicle;

/// A named effect as a clause that begins with a capital and ends without a full stop.
#[must_use]
pub fn clause(named: &Named, vehicle: &Vehicle) -> String {
    match signature_of(named.id).map(|signature| signature.words.clause) {
        Some(Clause::OneNumber { parameter, factor, before, after }) => {
            format!("{before} {} {after}", named.said(parameter, factor))
        }
        Some(Clause::Own(own)) => own(named, vehicle),
        Some(Clause::Sentence) | None => in_general(named),
    }
}

/// The effect's own sentence with its values.
fn in_general(named: &Named) -> String {
    let values: Vec<String> = named
        .parameters
        .iter()
        .map(|p| {
            format!("{} {} {}", p.name, with_error(p.value, p.std), spoken(p.unit)).trim_end().to_owned()
        })
        .collect();
    format!("{} ({})", named.sentence.trim_end_matches('.'), values.join(", "))
}

/// The name of an effect in a list.
#[must_use]
pub fn called(id: &str) -> &str {
    signature_of(id).map_or(id, |signature| signature.words.noun)
}

/// Name and, with `with_size`, size: `drag (0.41 +- 0.02 N per m/s)`.
#[must_use]
pub fn brief(named: &Named, vehicle: &Vehicle, with_size: bool) -> String {
    let signature = signature_of(named.id);
    let own = signature.and_then(|signature| signature.words.noun_of);
    let name = own.map_or_else(|| called(named.id).to_owned(), |own| own(named, vehicle));
    match size(named, signature).filter(|_| with_size) {
        // no parentheses within parentheses
        Some(size) => format!("{name} ({})", size.replace("(m/s)^2", "m^2/s^2")),
        None => name,
    }
}

/// Relative standard error (-) of the size that [`brief`] states. `None` where that has no unit, or was set.
#[must_use]
pub fn known_to(named: &Named) -> Option<f64> {
    let of = |p: &NamedParameter| (p.unit != "-").then_some((p.value, p.std));
    let (value, std) = match signature_of(named.id).map_or(Size::First, |signature| signature.words.size) {
        Size::Axes => largest(named),
        Size::Across(names) => largest_across(named, names),
        Size::Norm { .. } => Some(norm(&with_unit(named))),
        Size::Of { parameter, .. } => named.get(parameter).and_then(of),
        Size::Own(_, number) => number(named),
        Size::First => named.parameters.first().and_then(of),
    }?;
    (std > 0.0).then(|| std / value.abs()).filter(|relative| relative.is_finite())
}

fn with_unit(named: &Named) -> Vec<&NamedParameter> {
    named.parameters.iter().filter(|p| p.unit != "-").collect()
}

/// The size of the effect with its unit, as text.
fn size(named: &Named, signature: Option<&Signature>) -> Option<String> {
    match signature.map_or(Size::First, |signature| signature.words.size) {
        Size::Axes => Some(range(named)),
        Size::Across(names) => Some(range_across(named, names)),
        Size::Norm { factor, unit } => {
            let (norm, std) = norm(&with_unit(named));
            Some(format!("{} {unit}", plain(factor * norm, factor * std)))
        }
        Size::Of { parameter, factor, unit } => said(named, parameter, factor, unit),
        Size::Own(own, _) => own(named),
        Size::First => {
            let first = named.parameters.first()?;
            Some(format!("{} {}", plain(first.value, first.std), spoken(first.unit)).trim_end().to_owned())
        }
    }
}

/// The smallest size of an effect that would have been named.
#[must_use]
pub fn limit(limit: &DetectionLimit) -> String {
    match signature_of(limit.id).and_then(|signature| signature.words.limit) {
        Some(own) => own(limit.limit),
        None => {
            let size = format!("{} {}", significant(limit.limit, 2), spoken(limit.unit));
            format!("{} of {}", called(limit.id), size).trim_end().to_owned()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::Strength;
    use crate::physics::effects::ALL;
    use crate::physics::effects::by_id;

    fn vehicle() -> Vehicle {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/x500.toml");
        crate::config::load_vehicle(&path).unwrap()
    }

    fn named(id: &str, values: &[(&str, f64, f64)]) -> Named {
        let effect = by_id(id).unwrap();
        let parameters = effect
            .parameters()
            .iter()
            .filter_map(|p| {
                let (_, value, std) = values.iter().find(|(name, ..)| *name == p.name)?;
                Some(NamedParameter { name: p.name, value: *value, std: *std, unit: p.unit })
            })
            .collect();
        Named {
            id: effect.id(),
            sentence: effect.sentence(),
            parameters,
            strength: Strength::default(),
            confusable_with: Vec::new(),
        }
    }

    #[test]
    fn drag_is_one_number_where_the_axes_agree() {
        let vehicle = vehicle();
        let text = clause(&named("linear_drag", &[("dx", 0.41, 0.02), ("dy", 0.42, 0.02)]), &vehicle);
        assert!(
            text.starts_with("Drag was left out: 0.415 +- 0.014 N per m/s along body x and y (0.2"),
            "{text}"
        );
        let text = clause(&named("linear_drag", &[("dx", 0.41, 0.01), ("dy", 0.61, 0.02)]), &vehicle);
        assert!(text.contains("0.410 +- 0.010 along x and 0.61 +- 0.02 along y N per m/s"), "{text}");
    }

    /// 0.453 +- 0.055 and 0.449 +- 0.06: weights 330.6 and 277.8, mean 0.4512, error 1 / sqrt(608.4) = 0.0405.
    #[test]
    fn drag_along_z_is_said_with_that_across_only_where_it_agrees_and_is_known_as_well() {
        let vehicle = vehicle();
        let of = |z: (f64, f64)| {
            named("linear_drag", &[("dx", 0.453, 0.055), ("dy", 0.449, 0.06), ("dz", z.0, z.1)])
        };
        // it agrees (0.107 apart, error 0.058), and is known worse: 12 % and not 9 %
        let worse = of((0.344, 0.041));
        let text = clause(&worse, &vehicle);
        let expected =
            "Drag was left out: 0.45 +- 0.04 across and 0.34 +- 0.04 along z N per m/s of the body (";
        assert!(text.starts_with(expected), "{text}");
        let expected = "drag (0.45 +- 0.04 across and 0.34 +- 0.04 along z N per m/s)";
        assert_eq!(brief(&worse, &vehicle, true), expected);
        assert!((known_to(&worse).unwrap() - 0.0898).abs() < 2e-4);
        // it agrees, and is known as well: 7 %; the mean is that of x and y
        let as_well = of((0.42, 0.03));
        let text = clause(&as_well, &vehicle);
        assert!(text.contains(": 0.45 +- 0.04 N per m/s along body x, y and z ("), "{text}");
        assert_eq!(brief(&as_well, &vehicle, true), "drag (0.45 +- 0.04 N per m/s)");
        // it is known well, and differs: 0.15 apart, error 0.045
        let differs = clause(&of((0.30, 0.02)), &vehicle);
        assert!(
            differs.contains("0.45 +- 0.04 across and 0.30 +- 0.02 along z N per m/s of the body"),
            "{differs}"
        );
        let square = named("quadratic_drag", &[("cx", 0.2, 0.02), ("cy", 0.2, 0.02), ("cz", 0.6, 0.1)]);
        let text = clause(&square, &vehicle);
        assert!(
            text.ends_with("0.200 +- 0.014 across and 0.60 +- 0.10 along z N per (m/s)^2 of the body"),
            "{text}"
        );
    }

    #[test]
    fn one_axis_is_named_behind_the_unit() {
        let text = clause(&named("linear_drag", &[("dx", 0.63, 0.16)]), &vehicle());
        assert!(text.starts_with("Drag was left out: 0.63 +- 0.16 N per m/s along body x ("), "{text}");
    }

    #[test]
    fn how_well_a_size_is_known_follows_from_the_size_that_is_stated() {
        let alike = named("linear_drag", &[("dx", 0.60, 0.055), ("dy", 0.62, 0.055)]);
        assert_eq!(brief(&alike, &vehicle(), true), "drag (0.61 +- 0.04 N per m/s)");
        assert!((known_to(&alike).unwrap() - 0.055 / 2.0_f64.sqrt() / 0.61).abs() < 1e-9);
        let apart = named("linear_drag", &[("dx", 0.61, 0.02), ("dy", 0.41, 0.01), ("dz", 0.02, 0.04)]);
        assert!((known_to(&apart).unwrap() - 0.02 / 0.61).abs() < 1e-9);
        let wind = named("steady_wind", &[("north", 3.0, 0.3), ("west", 4.0, 0.3)]);
        assert!((known_to(&wind).unwrap() - 0.06).abs() < 1e-9);
        // the moment of a change is not its size
        let change = named("mass_change", &[("time", 26.0, 0.1), ("delta", -0.2, 0.02)]);
        assert!((known_to(&change).unwrap() - 0.1).abs() < 1e-9);
        assert_eq!(known_to(&named("thrust_curve", &[("curvature", 0.1, 0.01)])), None);
    }

    #[test]
    fn wind_comes_from_where_it_blows() {
        // towards north and west: from the south-east
        let text = clause(&named("steady_wind", &[("north", 2.5, 0.1), ("west", 1.5, 0.1)]), &vehicle());
        assert!(text.contains("2.92 +- 0.10 m/s from south-east (149 deg)"), "{text}");
    }

    #[test]
    fn every_effect_has_a_clause_of_its_own_or_its_sentence() {
        let vehicle = vehicle();
        for effect in ALL {
            let values: Vec<(&str, f64, f64)> = effect
                .parameters()
                .iter()
                .map(|p| {
                    let (least, greatest) = p.bounds.at(&vehicle.size());
                    (p.name, (least + 0.1 * (greatest.min(10.0) - least)).max(0.01), 0.01)
                })
                .collect();
            let text = clause(&named(effect.id(), &values), &vehicle);
            let begins = text.chars().next().is_some_and(char::is_uppercase);
            assert!(begins && !text.ends_with('.') && !text.contains("NaN"), "{}: {text}", effect.id());
            assert_ne!(called(effect.id()), effect.id());
        }
        let rotor = clause(&named("weak_rotor", &[("rotor", 1.0, 0.0), ("factor", 0.97, 0.001)]), &vehicle);
        assert!(
            rotor.starts_with("Motor 2 (rear left) is weak") && rotor.contains("3.00 +- 0.10 % less"),
            "{rotor}"
        );
    }
}
