//! A file of figures with a section for each run of a benchmark: an object of JSON, in which each run has its command.

use std::io::ErrorKind;

use serde::Serialize;
use serde_json::{Map, Value};

use super::end;

/// Replaces the section of this name. The other sections of the file stay as they are. Ends the process if the file is not such an
/// object or cannot be written.
pub fn store<T: Serialize>(file: &str, section: &str, run: &T) {
    let mut sections: Map<String, Value> = match std::fs::read_to_string(file) {
        Ok(text) => serde_json::from_str(&text)
            .unwrap_or_else(|error| end(&format!("{file}: expected an object of JSON: {error}"))),
        Err(error) if error.kind() == ErrorKind::NotFound => Map::new(),
        Err(error) => end(&format!("{file}: {error}")),
    };
    let value = serde_json::to_value(run).unwrap_or_else(|error| end(&format!("{section}: {error}")));
    sections.insert(section.to_owned(), value);
    let text = serde_json::to_string_pretty(&sections).unwrap_or_else(|error| end(&error.to_string()));
    std::fs::write(file, text + "\n").unwrap_or_else(|error| end(&format!("{file}: {error}")));
    println!("{file}: section `{section}` written");
}
