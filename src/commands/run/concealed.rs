//! What the embedded vehicle conceals, and how what was found compares with it.

use std::path::{Path, PathBuf};

use mavid::config::read_effect_tables;
use mavid::diagnose::Named;
use mavid::physics::{ActiveEffect, WHICH_ROTOR};
use mavid::report::with_error;
use mavid::study::effects_file;
use mavid::vehicle::Vehicle;
use serde::Serialize;
use toml::{Table, Value};

use crate::commands::read_once::is_read_once;
use crate::commands::{CommandError, output};

/// The file of what is concealed, in the folder of a run; neither the flight nor the explanation reads it.
pub const CONCEALED: &str = "concealed.toml";

/// The file itself, or its content kept in the folder where it can be read once only.
pub fn kept(file: &Path, folder: &Path) -> Result<PathBuf, CommandError> {
    if !is_read_once(file) {
        return Ok(file.to_owned());
    }
    let tables = read_effect_tables(file)?.into_iter().map(Value::Table).collect();
    let whole = Table::from_iter([("effect".to_owned(), Value::Array(tables))]);
    let content = toml::to_string(&whole)
        .map_err(|error| CommandError::Failure(format!("cannot keep the concealed effects: {error}")))?;
    let kept = folder.join(CONCEALED);
    output::file(&kept, &content)?;
    Ok(kept)
}

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

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(unix)]
    use std::fs;

    #[test]
    fn what_is_a_file_stays_where_it_is() {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/demo/concealed.toml");
        assert!(!is_read_once(&file) && !is_read_once(&std::env::temp_dir()));
        assert_eq!(kept(&file, Path::new("nowhere")).unwrap(), file);
        let gone = Path::new("nowhere/gone.toml");
        assert_eq!(
            kept(gone, Path::new("nowhere")).unwrap(),
            gone,
            "that there is none is told where it is read"
        );
    }

    #[cfg(unix)]
    #[test]
    fn what_comes_through_a_pipe_is_kept_and_read_again() {
        let folder = std::env::temp_dir().join(format!("mavid-concealed-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        let pipe = folder.join("pipe");
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/demo/concealed.toml");
        let (text, end) = (fs::read_to_string(&file).unwrap(), pipe.clone());
        let writer = std::thread::spawn(move || fs::write(end, text).unwrap());
        let kept = kept(&pipe, &folder).unwrap();
        writer.join().unwrap();
        assert_eq!(kept, folder.join(CONCEALED));
        for _ in 0..2 {
            assert_eq!(read_effect_tables(&kept).unwrap(), read_effect_tables(&file).unwrap());
        }
        fs::remove_dir_all(folder).unwrap();
    }
}
