//! Common parts of the model files of several commands.

use crate::physics::ActiveEffect;
use crate::study::{Correlation, InputFile};
use crate::text::toml_string;
use crate::vehicle::Vehicle;
use std::fmt::Write;

/// The effects as `[[effect]]` tables.
pub(super) fn effect_tables(effects: &[ActiveEffect], vehicle: &Vehicle) -> String {
    let mut text = String::new();
    for effect in effects {
        let _ = writeln!(text, "\n[[effect]]\nid = \"{}\"", effect.effect().id());
        let (common, finer) = (effect.effect().parameters(), effect.effect().finer_parameters());
        for (parameter, value) in common.iter().chain(finer).zip(effect.parameters()) {
            let words = match vehicle.rotor_of(*value).filter(|_| parameter.is_rotor()) {
                Some(index) => format!("counts from 0: {}", vehicle.motor_words(index)),
                None => parameter.unit.to_owned(),
            };
            let _ = writeln!(text, "{} = {value:?} # {words}", parameter.name);
        }
    }
    text
}

/// A correlation as names and rows.
pub(super) fn correlation_lines(correlation: &Correlation) -> String {
    // what has no error, because it is given or not determined, goes with nothing
    let has_error = |index: &usize| correlation.rows[*index][*index].is_some();
    let kept: Vec<usize> = (0..correlation.names.len()).filter(has_error).collect();
    let row = |i: &usize| {
        let cell = |j: &usize| format!("{:.4}", correlation.rows[*i][*j].unwrap_or_default());
        format!("  [{}]", kept.iter().map(cell).collect::<Vec<_>>().join(", "))
    };
    let names: Vec<&String> = kept.iter().map(|index| &correlation.names[*index]).collect();
    let rows: Vec<String> = kept.iter().map(row).collect();
    format!("correlation_of = {names:?}\ncorrelation = [\n{}\n]\n", rows.join(",\n"))
}

/// Files by name and hash as an array.
pub(super) fn files(inputs: &[InputFile]) -> String {
    let file =
        |(path, sha256): (&str, &str)| format!("  {{ path = {}, sha256 = \"{sha256}\" }}", toml_string(path));
    let files: Vec<String> = inputs.iter().flat_map(InputFile::files).map(file).collect();
    format!("[\n{}\n]", files.join(",\n"))
}

/// The program that wrote the file, and its inputs.
pub(super) fn provenance(inputs: &[InputFile]) -> String {
    let version = env!("CARGO_PKG_VERSION");
    format!("\n[provenance]\nprogram = \"mavid {version}\"\ninputs = {}\n", files(inputs))
}

/// The lines of the battery's mean voltage in the air, V, and of the motors' command at hover (0 to 1); nothing of what was not recorded.
pub(super) fn as_flown(voltage_v: Option<f64>, hover_command: Option<(f64, f64)>) -> String {
    let mut text = String::new();
    if let Some(volts) = voltage_v {
        let _ = writeln!(text, "battery_voltage = {volts:.3} # V, mean in the air");
    }
    if let Some((value, std)) = hover_command {
        let _ = writeln!(text, "# command of the motors at hover, as flown");
        let _ = writeln!(text, "hover_command = {{ value = {value:.4}, std = {std:.4}, unit = \"-\" }}");
    }
    text
}

/// The line of a parameter that no flight determined, with the reason.
pub(super) fn not_determined(name: &str, reason: &str) -> String {
    format!("{name} = {{ status = \"not_determined\", reason = {} }}", toml_string(reason))
}
