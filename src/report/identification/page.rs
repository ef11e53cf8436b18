//! The page of `identify` for the terminal.

use crate::estimate::{Finding, Identification, LatencyKind, MethodResult, NAMES, ThrustScale};
use crate::signals::Quality;
use crate::vehicle::Vehicle;
use std::fmt::Write;

use super::thrust_source::thrust_name;

/// The page for the terminal.
#[must_use]
pub fn identification_page(
    identification: &Identification,
    vehicle: &Vehicle,
    quality: &[&Quality],
    scale: Option<&ThrustScale>,
) -> String {
    let mut page = String::new();
    let best = &identification.best;
    let doubtful = identification.notes.iter().any(|note| note.starts_with("warning"));
    let but = if doubtful { "; doubtful: see the warnings below" } else { "" };
    let _ = writeln!(page, "{}: {}{but}", vehicle.name, verdict(&best.result));
    let _ = writeln!(page, "  method {}: {}", best.method.name(), best.why);
    if best.made_physical {
        let _ = writeln!(
            page,
            "  the estimate was not an inertia that a body can have; moved to the nearest that is"
        );
    }
    let nominal = crate::estimate::theta_of(&vehicle.body);
    let _ = writeln!(page, "\n  parameter       value    std error    nominal  unit");
    for (index, parameter) in best.result.parameters.iter().enumerate() {
        let _ = writeln!(
            page,
            "  {}",
            parameter_line(parameter.name, &parameter.finding, (nominal[index], parameter.unit))
        );
    }
    if let Some(scale) = scale {
        let stated = "(identified)";
        if let Finding::Determined { value, std } = scale.value {
            let _ = writeln!(page, "  {} {value:.4e} +- {std:.1e} {} {stated}", scale.name, scale.unit);
        }
    } else {
        let _ = writeln!(
            page,
            "  scale: the stated thrust is trusted (anchor = \"thrust\"); a weighed mass would set it with anchor = \"mass\". Izz rests on the stated torque per thrust as well"
        );
    }
    let _ = writeln!(page, "\n  {:<12}{}", "method", NAMES.map(|name| format!("{name:>11}")).concat());
    for method in &identification.methods {
        let cells = method.parameters.iter().map(|p| match p.finding {
            Finding::Determined { value, .. } | Finding::Given { value } => format!("{:>11}", number(value)),
            Finding::NotDetermined { .. } => format!("{:>11}", "-"),
        });
        let _ = writeln!(page, "  {:<12}{}", method.method.name(), cells.collect::<String>());
    }
    let dashes =
        |m: &MethodResult| m.parameters.iter().any(|p| matches!(p.finding, Finding::NotDetermined { .. }));
    if identification.methods.iter().any(dashes) {
        let _ = writeln!(
            page,
            "  -: not determined. GD and FMGD follow the noise of the last instants; a smaller --sigma averages longer"
        );
    }
    page.push('\n');
    page.push_str(&quality_lines(identification, quality));
    page
}

/// Five digits after the point where that shows the value, powers of ten where it would not.
pub(super) fn number(value: f64) -> String {
    if value == 0.0 || value.abs() >= 2e-4 { format!("{value:.5}") } else { format!("{value:.3e}") }
}

/// What the flight is good for, in one sentence.
pub(super) fn verdict(result: &MethodResult) -> String {
    let (mut yes, mut no) = (Vec::new(), Vec::new());
    for parameter in &result.parameters {
        match parameter.finding {
            Finding::Determined { .. } => yes.push(parameter.name),
            Finding::NotDetermined { .. } => no.push(parameter.name),
            Finding::Given { .. } => {}
        }
    }
    match (yes.is_empty(), no.is_empty()) {
        (false, true) => "good for all of mass and inertia".into(),
        (false, false) => format!("good for {}; not for {}", yes.join(", "), no.join(", ")),
        (true, _) => "determines none of the parameters".into(),
    }
}

fn parameter_line(name: &str, finding: &Finding, (nominal, unit): (f64, &str)) -> String {
    match finding {
        Finding::Determined { value, std } => {
            format!("{name:<6}{:>15}{:>13}{:>11}  {unit}", number(*value), number(*std), number(nominal))
        }
        Finding::Given { value } => {
            format!("{name:<6}{:>15}{:>13}{:>11}  {unit}", number(*value), "(weighed)", number(nominal))
        }
        Finding::NotDetermined { reason } => format!("{name:<6} not determined: {reason}"),
    }
}

fn quality_lines(identification: &Identification, quality: &[&Quality]) -> String {
    let mut page = String::new();
    if let Some(latency) = identification.latency.filter(|latency| latency.total_s.is_finite()) {
        let kind = match latency.kind {
            _ if latency.total_s < 0.0 => {
                "commands stamped later than the body's answer: a skew between streams"
            }
            LatencyKind::Undetermined => "lag or delay: this flight cannot tell",
            LatencyKind::Lag => "a first-order lag",
            LatencyKind::Delay => "a transport delay",
            LatencyKind::Both { .. } => "lag and delay",
        };
        let taken = if identification.compensated.total_s() == 0.0 {
            "less than four standard errors, left in"
        } else if latency.total_s.abs() <= 4.0 * latency.std_s {
            "less than four standard errors: the vehicle file's lag, which it agrees with, is taken out"
        } else {
            "taken out"
        };
        let _ = writeln!(
            page,
            "  actuation latency {:.1} +- {:.1} ms ({kind}), {taken}",
            1e3 * latency.total_s,
            1e3 * latency.std_s
        );
    }
    let harmonic = identification.highest_harmonic_hz.map_or_else(
        || "trajectory unknown".into(),
        |f| format!("highest harmonic of the trajectory {f:.2} Hz"),
    );
    let _ =
        writeln!(page, "  low-pass of LS, GD, FMLS, FMGD at {:.2} Hz ({harmonic})", identification.cutoff_hz);
    if let Some(condition) = identification.condition_number {
        let _ = writeln!(
            page,
            "  cond(W) as flown {condition:.1}; with scaled columns {:.1}",
            identification.scaled_condition_number
        );
    }
    page.push_str(&flight_lines(quality));
    for note in &identification.notes {
        let _ = writeln!(page, "  {note}");
    }
    page
}

/// What was used of each flight.
pub(super) fn flight_lines(quality: &[&Quality]) -> String {
    let mut page = String::new();
    for (index, quality) in quality.iter().enumerate() {
        let _ = writeln!(
            page,
            "  flight {}: {:.1} s used; thrust from {}; {}",
            index + 1,
            quality.usable.usable_s,
            thrust_name(quality.thrust_source),
            quality.usable.summary()
        );
        for (quantity, offset) in &quality.offsets {
            let what = if offset.repaired { "taken out" } else { "left in: not known well enough" };
            let _ = writeln!(
                page,
                "    {quantity:?} {} by {:.2} +- {:.2} ms against the inertial unit, {what}",
                if offset.late_s < 0.0 { "early" } else { "late" },
                1e3 * offset.late_s.abs(),
                1e3 * offset.std_s
            );
        }
        for note in &quality.notes {
            let _ = writeln!(page, "    {note}");
        }
    }
    page
}
