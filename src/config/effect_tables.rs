//! `[[effect]]` tables in a file of their own.

use std::path::Path;

use serde::Deserialize;
use toml::Table;

use super::ConfigError;
use super::kind::Kind;
use super::read::{parse_toml, read_text};
use crate::text;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct EffectsFile {
    effect: Vec<Table>,
}

/// The tables of a file that holds nothing but `[[effect]]` tables, as they are written.
///
/// # Errors
/// If the file cannot be read, is not TOML, or holds anything else, or none.
pub fn read_effect_tables(path: &Path) -> Result<Vec<Table>, ConfigError> {
    parse_effect_tables(&read_text(path, Kind::Effects)?, &text::path(path))
}

/// As [`read_effect_tables`], from text; `origin` names it in errors.
///
/// # Errors
/// If the text is not TOML, or holds anything else, or none.
pub fn parse_effect_tables(text: &str, origin: &str) -> Result<Vec<Table>, ConfigError> {
    parse_toml::<EffectsFile>(text, origin, Kind::Effects).map(|file| file.effect)
}
