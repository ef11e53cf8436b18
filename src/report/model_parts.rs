//! Common parts of the model files of several commands.

use crate::physics::ActiveEffect;
use crate::study::{Correlation, InputFile};
use crate::text::toml_string;
use std::fmt::Write;

/// The effects as `[[effect]]` tables.
pub(super) fn effect_tables(effects: &[ActiveEffect]) -> String {
    let mut text = String::new();
    for effect in effects {
        let _ = writeln!(text, "\n[[effect]]\nid = \"{}\"", effect.effect().id());
        let (common, finer) = (effect.effect().parameters(), effect.effect().finer_parameters());
        for (parameter, value) in common.iter().chain(finer).zip(effect.parameters()) {
            let _ = writeln!(text, "{} = {value:?} # {}", parameter.name, parameter.unit);
        }
    }
    text
}

/// A correlation as names and rows.
pub(super) fn correlation_lines(correlation: &Correlation) -> String {
    let row = |row: &Vec<Option<f64>>| {
        let cells: Vec<String> =
            row.iter().map(|r| r.map_or_else(|| "nan".to_owned(), |r| format!("{r:.4}"))).collect();
        format!("  [{}]", cells.join(", "))
    };
    let rows: Vec<String> = correlation.rows.iter().map(row).collect();
    format!("correlation_of = {:?}\ncorrelation = [\n{}\n]\n", correlation.names, rows.join(",\n"))
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

/// The line of a parameter that no flight determined, with the reason.
pub(super) fn not_determined(name: &str, reason: &str) -> String {
    format!("{name} = {{ status = \"not_determined\", reason = {} }}", toml_string(reason))
}
