//! What the embedded vehicle conceals, and how what was found compares with it.

use std::path::Path;

use mavid::diagnose::Named;
use mavid::physics::{ActiveEffect, WHICH_ROTOR};
use mavid::report::with_error;
use mavid::study::effects_file;
use mavid::vehicle::Vehicle;
use serde::Serialize;

use crate::commands::CommandError;

/// What the file conceals in the embedded vehicle.
pub fn acting(file: &Path, vehicle: &Vehicle) -> Result<Vec<ActiveEffect>, CommandError> {
    Ok(effects_file(file, vehicle)?)
}

/// One parameter of a concealed effect beside what was found.
#[derive(Debug, Serialize)]
pub struct Compared {
    effect: &'static str,
    parameter: &'static str,
    unit: &'static str,
    concealed: f64,
    /// with its standard error; none where the effect was not named
    found: Option<f64>,
    std: Option<f64>,
}

/// Every concealed parameter beside what was found of it.
pub fn compare(concealed: &[ActiveEffect], named: &[Named]) -> Vec<Compared> {
    let mut rows = Vec::new();
    for active in concealed {
        let effect = active.effect();
        let found = named.iter().find(|named| named.id == effect.id());
        for (parameter, value) in effect.parameters().iter().zip(active.parameters()) {
            let found = found.and_then(|named| named.parameters.iter().find(|p| p.name == parameter.name));
            rows.push(Compared {
                effect: effect.id(),
                parameter: parameter.name,
                unit: parameter.unit,
                concealed: *value,
                found: found.map(|found| found.value),
                std: found.map(|found| found.std),
            });
        }
    }
    rows
}

/// The rows as a table.
pub fn table(rows: &[Compared], vehicle: &Vehicle) -> String {
    let shown = |row: &Compared, value: f64| rotor(row, value, vehicle).unwrap_or_else(|| format!("{value}"));
    let heading = "concealed";
    let widths = rows.iter().map(|row| shown(row, row.concealed).chars().count());
    let width = widths.fold(heading.len(), usize::max);
    let mut lines = vec![format!("  {:<24} {heading:>width$}   found", "")];
    for row in rows {
        let shown = |value: f64| shown(row, value);
        let found = match (row.found, row.std) {
            (Some(found), Some(std)) if std > 0.0 => with_error(found, std),
            (Some(found), _) => shown(found),
            _ => "not named".to_owned(),
        };
        let name = format!("{} {}", row.effect, row.parameter);
        let unit = if row.unit == "-" { "" } else { row.unit };
        lines.push(
            format!("  {name:<24} {:>width$}   {found} {unit}", shown(row.concealed)).trim_end().to_owned(),
        );
    }
    lines.join("\n")
}

/// A rotor by the autopilot's number and its place.
fn rotor(row: &Compared, value: f64, vehicle: &Vehicle) -> Option<String> {
    let index = vehicle.rotor_of(value).filter(|_| row.parameter == WHICH_ROTOR)?;
    Some(vehicle.motor_words(index))
}
