//! The page of `identify --with` for the terminal.

use crate::diagnose::NO_LATENCY;
use crate::diagnose::joint::{EffectFound, Found, JointEstimate, ParameterFound};
use crate::estimate::{Finding, Parameter, theta_of};
use crate::physics::WHICH_ROTOR;
use crate::study::{IdentifyStudy, Misfit, WithEffects};
use std::fmt::Write;

use super::words::{beyond, flight_lines, number, physical};

/// Effects and rigid body, identified together.
pub(super) fn with_text(study: &IdentifyStudy, with: &WithEffects) -> String {
    let joint = &with.joint;
    let ids: Vec<&str> = joint.effects.iter().map(|effect| effect.effect.id()).collect();
    let mut doubts = study.doubts().join("; ");
    if !doubts.is_empty() {
        doubts = format!("doubtful: {doubts}; ");
    }
    let mut page = format!(
        "{}: {doubts}{} identified together with the rigid body\n",
        study.vehicle.name,
        ids.join(", ")
    );
    for effect in &joint.effects {
        let _ = writeln!(page, "  {}: {}", effect.effect.id(), evidence(effect));
    }
    let _ = writeln!(
        page,
        "\n  {:<34}{:>13}{:>13}{:>15}{:>12}  unit",
        "parameter", "value", "std error", "without them", "nominal"
    );
    let nominal = theta_of(&study.vehicle.body);
    let bodies = joint.body.parameters.iter().zip(&joint.body_before.parameters);
    for (index, (with, without)) in bodies.enumerate() {
        let _ = writeln!(page, "  {}", body_line(with, without, nominal[index]));
    }
    for effect in &joint.effects {
        for parameter in &effect.parameters {
            let _ = writeln!(page, "  {}", effect_line(effect, parameter));
        }
    }
    page.push_str(&scale_line(joint));
    if let Some(sentence) = physical(joint.physical) {
        let _ = writeln!(page, "  {sentence}");
    }
    let _ = writeln!(page, "\n  {:<26}{:>13}{:>13}  unit", "misfit, rms", "without them", "with them");
    for Misfit { name, unit, without, with } in with.misfits() {
        let _ = writeln!(page, "  {name:<26}{:>13}{:>13}  {unit}", number(without), number(with));
    }
    page.push('\n');
    let latency = &joint.latency;
    let how = if joint.latency_named { "kept as the named kind" } else { "estimated with them" };
    let _ = if latency.is_determined() {
        let (total_ms, std_ms) = (1e3 * latency.total_s, 1e3 * latency.std_s);
        writeln!(page, "  actuation latency {total_ms:.1} +- {std_ms:.1} ms, {how}")
    } else {
        writeln!(page, "  actuation latency not determined: {NO_LATENCY}")
    };
    page.push_str(&flight_lines(with.quality.iter()));
    page
}

/// The source of the scale of the forces.
fn scale_line(joint: &JointEstimate) -> String {
    match joint.scale.as_ref().map(|scale| (scale.name, &scale.value, scale.unit)) {
        Some((name, Finding::Determined { value, std }, unit)) => {
            format!("  {name} {value:.4e} +- {std:.1e} {unit} (identified; forces have the scale of the weighed \
                     mass)\n")
        }
        Some((name, ..)) => format!("  {name} is not determined: forces have the stated scale\n"),
        None => "  scale: the stated thrust is trusted (anchor = \"thrust\"); masses, forces and torques depend on it\n"
            .to_owned(),
    }
}

/// The significance of an effect.
fn evidence(effect: &EffectFound) -> String {
    let tried =
        if effect.tried > 1 { format!(" after {} forms were tried", effect.tried) } else { String::new() };
    let there = if effect.is_significant() { "" } else { "; not distinguishable from zero" };
    format!("{} {:.1} standard errors from zero{tried}{there}", effect.effect.sentence(), effect.z)
}

fn body_line(with: &Parameter, without: &Parameter, nominal: f64) -> String {
    let short = |finding: &Finding| match finding {
        Finding::Determined { value, .. } | Finding::Given { value } => number(*value),
        Finding::NotDetermined { .. } => "-".to_owned(),
    };
    let (value, std) = match &with.finding {
        Finding::Determined { value, std } => (number(*value), number(*std)),
        Finding::Given { value } => (number(*value), "(weighed)".to_owned()),
        Finding::NotDetermined { reason } => return format!("{:<34} not determined: {reason}", with.name),
    };
    format!(
        "{:<34}{value:>13}{std:>13}{:>15}{:>12}  {}",
        with.name,
        short(&without.finding),
        number(nominal),
        with.unit
    )
}

fn effect_line(effect: &EffectFound, parameter: &ParameterFound) -> String {
    let name = format!("{}.{}", effect.effect.id(), parameter.name);
    let unit = parameter.unit;
    match &parameter.found {
        Found::Determined { value, std } => {
            format!("{name:<34}{:>13}{:>13}{:>15}{:>12}  {unit}", number(*value), number(*std), "", "")
        }
        Found::AtBound { value, unbounded, std } => {
            format!(
                "{name:<34}{:>13}{:>13}  {unit}; {}",
                number(*value),
                number(*std),
                beyond(parameter, *unbounded, *std)
            )
        }
        // the motor in words says more than its place from 0
        Found::Given { why, .. } if parameter.name == WHICH_ROTOR => format!("{name:<34} {why}"),
        Found::Given { value, why } => {
            format!("{name:<34}{:>13}{:>13}  {unit}; {why}", number(*value), "(set)")
        }
        Found::NotDetermined { reason, .. } => format!("{name:<34} not determined: {reason}"),
    }
}
