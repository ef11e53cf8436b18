//! From a file to the form of its kind: no larger than it may be, and with what is wrong named on one line.

use std::fs::File;
use std::io::Read as _;
use std::path::Path;

use super::ConfigError;
use super::faults::Faults;
use super::form::{Fault, Read, read_form};
use super::kind::Kind;
use crate::log::format_of;
use crate::text;

/// Bytes of a file: a hundred times what the largest model has. TOML itself goes at most 80 levels deep.
const BYTES_MAX: u64 = 1 << 20;
/// Characters of a faulty line, and of what is said about it.
const LINE_CHARS: usize = 60;
const REASON_CHARS: usize = 400;

/// The text of a configuration file of this kind.
pub(super) fn read_text(path: &Path, kind: Kind) -> Result<String, ConfigError> {
    let failed = |source| ConfigError::Read { path: path.to_owned(), source };
    let other = |came: &str| {
        let origin = text::path(path);
        Err(ConfigError::OtherKind { origin, expected: kind.expected(), came: came.to_owned() })
    };
    if path.is_dir() {
        return other("a folder");
    }
    let mut bytes = Vec::new();
    // one more than it may have tells that there are more
    File::open(path).and_then(|file| file.take(BYTES_MAX + 1).read_to_end(&mut bytes)).map_err(failed)?;
    if bytes.is_empty() {
        return other("an empty file");
    }
    let is_large = bytes.len() as u64 > BYTES_MAX;
    if is_large || std::str::from_utf8(&bytes).is_err() {
        let format = format_of(path).ok().filter(|format| !format.takes_columns);
        if let Some(format) = format {
            return Err(ConfigError::Recording {
                path: path.to_owned(),
                expected: kind.expected(),
                came: format.name,
            });
        }
    }
    if is_large {
        return Err(ConfigError::TooLarge {
            path: path.to_owned(),
            expected: kind.expected(),
            max: BYTES_MAX,
        });
    }
    String::from_utf8(bytes)
        .map_err(|_| ConfigError::NoText { path: path.to_owned(), expected: kind.expected() })
}

/// TOML text to the form `T` of a file of this kind, with `origin` named in the error, which tells all that is wrong.
pub(super) fn parse_toml<T: serde::de::DeserializeOwned>(
    text: &str,
    origin: &str,
    kind: Kind,
) -> Result<T, ConfigError> {
    let (form, faults) = parse_toml_on(text, origin, kind)?;
    faults.refuse(origin)?;
    Ok(form)
}

/// The same past what is wrong, so that checks of the values can go on. What is refused at once is no TOML, a file of another
/// kind, or has very many faults.
pub(super) fn parse_toml_on<T: serde::de::DeserializeOwned>(
    text: &str,
    origin: &str,
    kind: Kind,
) -> Result<(T, Faults), ConfigError> {
    let errors = |faults: &[Fault]| -> Vec<ConfigError> {
        let one = |fault: &Fault| ConfigError::Parse {
            origin: origin.to_owned(),
            expected: kind.expected(),
            reason: reason(fault, text),
        };
        faults.iter().map(one).collect()
    };
    let other = |faults: &[Fault]| match kind.other(text).filter(|_| !faults.is_empty()) {
        Some(came) => {
            Err(ConfigError::OtherKind { origin: origin.to_owned(), expected: kind.expected(), came })
        }
        None => Ok(()),
    };
    match read_form(text) {
        Ok(Read { form, faults, stands_in }) => {
            other(&faults)?;
            Ok((form, Faults::new(errors(&faults), stands_in)))
        }
        Err(faults) => {
            other(&faults)?;
            Err(ConfigError::combined(origin, errors(&faults)))
        }
    }
}

/// Where, what stands there, and what is wrong with it.
fn reason(fault: &Fault, text: &str) -> String {
    let message = fault.message.lines().map(str::trim_end).collect::<Vec<_>>().join(", ");
    let table = fault.path.rsplit_once('.').map_or("", |(table, _)| table);
    let within = if table.is_empty() || message.contains(table) {
        String::new()
    } else {
        format!(" in `{}`", text::excerpt(table, LINE_CHARS))
    };
    let message = text::excerpt(&message, REASON_CHARS) + &within;
    let before = fault.span.as_ref().and_then(|span| text.get(..span.start));
    let Some(before) = before.filter(|before| !(before.is_empty() && message.starts_with("missing"))) else {
        return message;
    };
    let begin = before.rfind('\n').map_or(0, |end| end + 1);
    let (line, column) = (before.matches('\n').count() + 1, before[begin..].chars().count() + 1);
    let there = text[begin..].lines().next().unwrap_or_default().trim();
    let quoted =
        if there.is_empty() { String::new() } else { format!(" (`{}`)", text::excerpt(there, LINE_CHARS)) };
    format!("line {line}, column {column}{quoted}: {message}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::{load_vehicle, parse_limits, parse_vehicle};

    fn refusal(text: &str) -> String {
        parse_vehicle(text, "v.toml").unwrap_err().to_string()
    }

    #[test]
    fn a_refusal_says_where_on_one_line() {
        let said = parse_limits("[limits]\n  speed = 2\n", "l.toml").unwrap_err().to_string();
        assert!(said.contains("line 2, column 3 (`speed = 2`): unknown field `speed`"), "{said}");
    }

    #[test]
    fn a_recording_is_told_to_be_one() {
        let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures");
        for (log, format) in
            [("px4_flight.ulg", "PX4 log (.ulg)"), ("p01_identify_0_25s.tlog", "telemetry log (.tlog)")]
        {
            let said = load_vehicle(&fixtures.join(log)).unwrap_err().to_string();
            assert!(said.contains(&format!("got a recording, {format}: give it among the logs")), "{said}");
        }
    }

    #[test]
    fn a_folder_and_an_empty_file_are_told_to_be_that() {
        let folder = std::env::temp_dir().join(format!("mavid-config-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let empty = folder.join("empty.toml");
        std::fs::write(&empty, "").unwrap();
        for (path, came) in [(&folder, "a folder"), (&empty, "an empty file")] {
            let said = load_vehicle(path).unwrap_err().to_string();
            let expected =
                format!("{}: expected a vehicle or model file in TOML, got {came}", text::path(path));
            assert_eq!(said, expected);
        }
        std::fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn foreign_words_in_a_refusal_command_nothing() {
        for text in ["\"evil\\u001b[31m\\nkey\" = 1\n", "x = \"\u{1b}[31m\"\n", "x\r\u{9b} = \n", "= 1\n"] {
            let said = refusal(text);
            assert!(!said.chars().any(text::is_command), "{said:?}");
        }
        assert!(refusal("\"evil\\u001b[31m\\nkey\" = 1\n").contains("evil\\u{1b}[31m"));
    }

    #[test]
    fn depth_and_length_have_bounds() {
        let deep =
            |open: &str, close: &str| format!("a = {}1{}\n", open.repeat(50_000), close.repeat(50_000));
        let long = "x".repeat(100_000);
        for text in [
            deep("[", "]"),
            deep("{a=", "}"),
            format!("[{}]\nb = 1\n", ["a"; 50_000].join(".")),
            format!("{} = 1\n", ["a"; 50_000].join(".")),
            format!("{long} = 1\n"),
            format!("name = {long}\n"),
        ] {
            let said = refusal(&text);
            assert!(said.starts_with("v.toml: ") && said.len() < 2000, "{} bytes: {said:.200}", said.len());
        }
    }
}
