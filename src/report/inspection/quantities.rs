//! What one may want to know of a vehicle, a line a quantity.

use crate::inspect::{ExpectedParameter, Inspection, QuantitySummary};
use crate::text::significant;

/// Of a vehicle of which neither mass nor file is given.
const YAW_NEEDS: &str = "; Izz only where the rotors' torque per thrust is known";

/// The lines: name, and what is said of it. What is the same as in the line above is not said again.
pub(super) fn lines(inspection: &Inspection) -> Vec<(String, String)> {
    let mut above: Option<&QuantitySummary> = None;
    let mut lines = Vec::new();
    if let Some(reason) = of_all(&inspection.quantities) {
        return vec![("nothing".to_owned(), reason.to_owned())];
    }
    for quantity in &inspection.quantities {
        let mut line = said(quantity, above);
        if inspection.quantities_relative && quantity.expected.iter().any(|one| one.parameter == "izz") {
            line.push_str(YAW_NEEDS);
        }
        lines.push((quantity.name.replace('_', " "), line));
        above = Some(quantity);
    }
    if inspection.quantities_relative {
        let how = "relative: --mass and --size, or --vehicle, give them in their units".to_owned();
        lines.push(("errors are".to_owned(), how));
    }
    lines
}

/// The one reason why there is nothing of all quantities, and nothing to do about it.
fn of_all(quantities: &[QuantitySummary]) -> Option<&str> {
    let reason = quantities.first()?.reason.as_deref()?;
    let is_alike = |one: &QuantitySummary| {
        one.status == "no" && one.reason.as_deref() == Some(reason) && one.fly.is_none() && one.set.is_none()
    };
    quantities.iter().all(is_alike).then_some(reason)
}

fn said(quantity: &QuantitySummary, above: Option<&QuantitySummary>) -> String {
    let expected: Vec<String> =
        quantity.expected.iter().map(|one| error(one, quantity.expected.len() > 1)).collect();
    let expected = expected.join(", ");
    let better = if quantity.at_most { " or better" } else { "" };
    let reason = quantity.reason.as_deref().unwrap_or_default();
    let is_as_above = |same: fn(&QuantitySummary, &QuantitySummary) -> bool| {
        above.is_some_and(|above| above.status == quantity.status && same(above, quantity))
    };
    let mut line = match quantity.status {
        "yes" if expected.starts_with("the ") => format!("yes, {expected}{better}"),
        "yes" if quantity.poor_share() >= 1.0 => format!("yes, but poorly, to {expected}{better}"),
        "yes" if quantity.poor_share() > 0.0 => format!("yes, in part poorly, to {expected}{better}"),
        "yes" => format!("yes, to {expected}{better}"),
        "possible" if is_as_above(|_, _| true) => "yes, likewise".to_owned(),
        "possible" => "yes, by its streams and motion; --vehicle adds the accuracy".to_owned(),
        "partly" if expected.is_empty() => format!("partly; {reason}"),
        "partly" => format!("partly, to {expected}{better}; {reason}"),
        // an error beyond what is looked for is no accuracy
        _ if quantity.expected.iter().any(|one| one.std_relative > 1.0) => {
            format!("no, not determined: {reason}")
        }
        _ if !expected.is_empty() => format!("no, only to {expected}{better}; {reason}"),
        _ if is_as_above(|above, this| above.reason == this.reason && above.expected.is_empty()) => {
            "no, likewise".to_owned()
        }
        _ => format!("no: {reason}"),
    };
    let fly = quantity.fly.filter(|_| !is_as_above(|above, this| above.fly == this.fly));
    let set = quantity.set.clone().filter(|_| !is_as_above(|above, this| above.set == this.set));
    let next: Vec<String> = fly.map(|fly| format!("fly {fly}")).into_iter().chain(set).collect();
    if !next.is_empty() {
        line.push_str(". Next: ");
        line.push_str(&next.join("; "));
    }
    line
}

/// A standard error: with its unit, and as a share.
fn error(one: &ExpectedParameter, is_named: bool) -> String {
    let name = match one.parameter {
        "ixx" if is_named => "Ixx ",
        "iyy" if is_named => "Iyy ",
        "izz" if is_named => "Izz ",
        // the mass is given, or assumed
        "thrust_scale" => "thrust over weight to ",
        _ => "",
    };
    let share = format!("{} %", significant(100.0 * one.std_relative, 2));
    let std = one.std.map(|std| match one.unit {
        "-" if one.parameter == "exponent" => format!("{} in the exponent", significant(std, 2)),
        // of one
        "-" | "1" => format!("{} %", significant(100.0 * std, 2)),
        "s" => format!("{} ms", significant(1e3 * std, 2)),
        "m" => format!("{} mm", significant(1e3 * std, 2)),
        unit => format!("{} {unit}", significant(std, 2)),
    });
    match (one.of, std) {
        ("value", Some(std)) if one.unit != "1" => format!("{name}{share} ({std})"),
        ("value", _) => format!("{name}{share}"),
        (_, Some(std)) => format!("{std}, {share} of what is usual"),
        (_, None) => format!("{share} of what is usual"),
    }
}
