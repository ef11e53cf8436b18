//! Words and numbers that several views of an identification have in common.

use crate::diagnose::LEAST_FLIGHT_S;
use crate::diagnose::joint::{ParameterFound, Physical};
use crate::estimate::{Finding, MethodResult, Nominal, POOR, RIGID_BODY_ALONE, size_of};
use crate::report::thrust_source::thrust_name;
use crate::signals::Quality;
use crate::study::IdentifyStudy;
use crate::text::compact;
use std::fmt::Write;

/// What the flight is good for, in one sentence. A result that contradicts the vehicle's file, or rests on one that is
/// hardly meant, is good for nothing until one of both is corrected.
pub(super) fn verdict(study: &IdentifyStudy, result: &MethodResult) -> String {
    let doubts = study.doubts();
    if !doubts.is_empty() {
        return format!("doubtful: {}", doubts.join("; "));
    }
    let scale = study.with.as_ref().map_or(study.scale.as_ref(), |with| with.joint.scale.as_ref());
    let (mut good, mut poor, mut no) = (Vec::new(), Vec::new(), Vec::new());
    let mut tell = |name: &'static str, relative: f64| {
        if relative > POOR {
            poor.push(format!("{name} to {:.0} %", 100.0 * relative));
        } else {
            good.push(name);
        }
    };
    if let Some(Finding::Determined { value, std }) = scale.map(|scale| &scale.factor) {
        tell("thrust", std / value);
    }
    let nominal = Nominal::of(&study.vehicle);
    for (index, parameter) in result.parameters.iter().enumerate() {
        match parameter.finding {
            Finding::Determined { std, .. } => {
                tell(parameter.name, std / size_of(&result.estimated.theta, &nominal, index));
            }
            Finding::NotDetermined { .. } => no.push(parameter.name),
            Finding::Given { .. } => {}
        }
    }
    let usable_s: f64 = study.flights.iter().map(|flight| flight.quality.usable.usable_s).sum();
    let alone = if usable_s < LEAST_FLIGHT_S { RIGID_BODY_ALONE } else { "" };
    if poor.is_empty() && no.is_empty() {
        let all = if scale.is_some() { "thrust and all of the inertia" } else { "all of mass and inertia" };
        return format!("{alone}good for {all}");
    }
    let part = |word: &str, names: String| (!names.is_empty()).then(|| format!("{word} {names}"));
    // products of inertia alone are not what is looked for: then what is poor comes first
    let only_products = good.iter().all(|name| matches!(*name, "ixy" | "ixz" | "iyz"));
    let mut parts = [part("good for", good.join(", ")), part("poor for", poor.join(", "))];
    if only_products {
        parts.reverse();
    }
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    match part("not for", no.join(", ")) {
        _ if parts.is_empty() => "determines none of the parameters".into(),
        Some(not) => format!("{alone}{}; {not}", parts.join("; ")),
        None => format!("{alone}{}", parts.join("; ")),
    }
}

/// Five digits after the point if they show the value, otherwise a power of ten.
pub(super) fn number(value: f64) -> String {
    if value == 0.0 || value.abs() >= 2e-4 { format!("{value:.5}") } else { format!("{value:.3e}") }
}

/// The used data of each flight.
pub(super) fn flight_lines<'a>(flights: impl Iterator<Item = &'a Quality>) -> String {
    let mut page = String::new();
    for (index, quality) in flights.enumerate() {
        let _ = writeln!(
            page,
            "  flight {}: {:.1} s used; thrust from {}; {}",
            index + 1,
            quality.usable.usable_s,
            thrust_name(quality.thrust_source),
            quality.usable.summary()
        );
        for (quantity, offset) in &quality.offsets {
            let _ = if offset.std_s.is_finite() {
                let what = if offset.repaired { "taken out" } else { "not corrected: not known well enough" };
                writeln!(
                    page,
                    "    {quantity:?} {} by {:.2} +- {:.2} ms against the inertial unit, {what}",
                    if offset.late_s < 0.0 { "early" } else { "late" },
                    1e3 * offset.late_s.abs(),
                    1e3 * offset.std_s
                )
            } else {
                writeln!(page, "    {quantity:?}: lateness against the inertial unit not determined")
            };
        }
        for note in &quality.notes {
            let _ = writeln!(page, "    {note}");
        }
    }
    page
}

/// A sentence on a physically impossible inertia.
pub(super) fn physical(of: Physical) -> Option<&'static str> {
    match of {
        Physical::AsEstimated => None,
        Physical::Moved => Some(
            "the estimated inertia was physically impossible; replaced by the nearest possible one, within its error",
        ),
        Physical::No => Some(
            "warning: this inertia is physically impossible (one principal moment exceeds the sum of the others) by \
             more than its error; left as estimated. Check arms, thrust and torque per thrust in the vehicle file",
        ),
    }
}

/// A sentence on an estimate beyond its bound.
pub(super) fn beyond(parameter: &ParameterFound, wanted: f64, std: f64) -> String {
    let (least, most) = parameter.plausible;
    let away = if wanted < least { least - wanted } else { wanted - most };
    let what = if away > 3.0 * std { "not this effect" } else { "the bound is within the error" };
    format!(
        "without the bound {} +- {std:.1e}, possible are {} to {}: {what}",
        number(wanted),
        compact(least),
        compact(most)
    )
}
