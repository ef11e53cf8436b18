//! What the embedded vehicle conceals, and how what was found compares with it.

use std::path::Path;

use mavid::diagnose::Named;
use mavid::physics::ActiveEffect;
use mavid::report::with_error;
use mavid::study::effects_file;
use mavid::vehicle::Vehicle;
use serde::Serialize;

use crate::commands::CommandError;

/// Parameter that is a number of a rotor, from 0.
const ROTOR: &str = "rotor";

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
    let mut lines = vec![format!("  {:<28} {:>12}   found", "", "concealed")];
    for row in rows {
        let shown = |value: f64| rotor(row, value, vehicle).unwrap_or_else(|| format!("{value}"));
        let found = match (row.found, row.std) {
            (Some(found), Some(std)) if std > 0.0 => with_error(found, std),
            (Some(found), _) => shown(found),
            _ => "not named".to_owned(),
        };
        let name = format!("{} {}", row.effect, row.parameter);
        let unit = if row.unit == "-" { "" } else { row.unit };
        lines.push(
            format!("  {name:<28} {:>12}   {found} {unit}", shown(row.concealed)).trim_end().to_owned(),
        );
    }
    lines.join("\n")
}

/// A rotor by its name.
fn rotor(row: &Compared, value: f64, vehicle: &Vehicle) -> Option<String> {
    let mut rotors = vehicle.rotors.iter().enumerate();
    let is_it = |index: usize| (index as f64 - value).abs() < 0.5;
    (row.parameter == ROTOR).then(|| rotors.find(|(index, _)| is_it(*index)).map(|(_, r)| r.name.clone()))?
}
