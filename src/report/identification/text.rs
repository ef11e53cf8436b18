//! The page of `identify` for the terminal.

use crate::estimate::{Finding, LatencyKind, MethodResult, NAMES, theta_of};
use crate::study::{IdentifyStudy, lost};
use crate::text::with_error;
use std::fmt::Write;

use super::with_text::with_text;
use super::words::{flight_lines, number, verdict};

/// The page for the terminal.
#[must_use]
pub fn identification_text(study: &IdentifyStudy) -> String {
    let mut page = match &study.with {
        Some(with) => with_text(study, with),
        None => body_text(study),
    };
    page.truncate(page.trim_end().len());
    page
}

/// The rigid body alone.
fn body_text(study: &IdentifyStudy) -> String {
    let mut page = String::new();
    let identification = &study.identification;
    let best = &identification.best;
    let _ = writeln!(page, "{}: {}", study.vehicle.name, verdict(study, &best.result));
    let _ = writeln!(page, "  method {}: {}", best.method.name(), best.why);
    if best.made_physical {
        let _ = writeln!(
            page,
            "  the estimated inertia was physically impossible; replaced by the nearest possible one"
        );
    }
    let nominal = theta_of(&study.vehicle.body);
    let _ = writeln!(page, "\n  parameter       value    std error    nominal  unit");
    for (index, parameter) in best.result.parameters.iter().enumerate() {
        let _ = writeln!(
            page,
            "  {}",
            parameter_line(parameter.name, &parameter.finding, (nominal[index], parameter.unit))
        );
    }
    if let Some(scale) = &study.scale {
        if let Finding::Determined { value, std } = scale.value {
            let _ = writeln!(page, "  {} {} {} (identified)", scale.name, with_error(value, std), scale.unit);
        }
    } else {
        let _ = writeln!(
            page,
            "  scale: the stated thrust is trusted (anchor = \"thrust\"); a weighed mass sets it with anchor = \
             \"mass\". Izz also depends on the stated torque per thrust"
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
    page.push_str(&quality_lines(study));
    page
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

fn quality_lines(study: &IdentifyStudy) -> String {
    let mut page = String::new();
    let identification = &study.identification;
    if let Some(latency) = identification.latency.filter(|latency| latency.total_s.is_finite()) {
        let kind = match latency.kind {
            _ if latency.total_s < 0.0 => {
                "the time stamps of the commands are later than the response of the body: an offset between streams"
            }
            LatencyKind::Undetermined => "lag or delay: this flight cannot distinguish them",
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
            "  latency of the rigid body alone, by WEAK: {:.1} +- {:.1} ms ({kind}), {taken}",
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
    page.push_str(&flight_lines(study.flights.iter().map(|flight| &flight.quality)));
    for note in identification.notes.iter().chain(&lost(&study.inputs)) {
        let _ = writeln!(page, "  {note}");
    }
    page
}
