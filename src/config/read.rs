//! From a file to the form of its kind: no larger than it may be, and with what is wrong named on one line.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use super::ConfigError;
use super::kind::Kind;
use crate::text;

/// Bytes of a file: a hundred times what the largest model has. TOML itself goes at most 80 levels deep.
const BYTES_MAX: u64 = 1 << 20;
/// Characters of a faulty line, and of what is said about it.
const LINE_CHARS: usize = 60;
const REASON_CHARS: usize = 400;

/// The text of a configuration file of this kind.
pub(super) fn read_text(path: &Path, kind: Kind) -> Result<String, ConfigError> {
    let failed = |source| ConfigError::Read { path: path.to_owned(), source };
    let mut bytes = Vec::new();
    // one more than it may have tells that there are more
    File::open(path).and_then(|file| file.take(BYTES_MAX + 1).read_to_end(&mut bytes)).map_err(failed)?;
    if bytes.len() as u64 > BYTES_MAX {
        return Err(ConfigError::TooLarge {
            path: path.to_owned(),
            expected: kind.expected(),
            max: BYTES_MAX,
        });
    }
    String::from_utf8(bytes)
        .map_err(|_| ConfigError::NoText { path: path.to_owned(), expected: kind.expected() })
}

/// TOML text to the form `T` of a file of this kind, with `origin` named in the error.
pub(super) fn parse_toml<T: serde::de::DeserializeOwned>(
    text: &str,
    origin: &str,
    kind: Kind,
) -> Result<T, ConfigError> {
    toml::from_str(text).map_err(|source| {
        let (origin, expected) = (origin.to_owned(), kind.expected());
        match kind.other(text) {
            Some(came) => ConfigError::OtherKind { origin, expected, came },
            None => ConfigError::Parse { origin, expected, reason: reason(&source, text) },
        }
    })
}

/// Where, what stands there, and what is wrong with it.
fn reason(error: &toml::de::Error, text: &str) -> String {
    let message = error.message().lines().map(str::trim_end).collect::<Vec<_>>().join(", ");
    let message = text::excerpt(&message, REASON_CHARS);
    let Some(before) = error.span().and_then(|span| text.get(..span.start)) else { return message };
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
    use crate::config::{parse_limits, parse_vehicle};

    fn refusal(text: &str) -> String {
        parse_vehicle(text, "v.toml").unwrap_err().to_string()
    }

    #[test]
    fn a_refusal_says_where_on_one_line() {
        let said = parse_limits("[limits]\n  speed = 2\n", "l.toml").unwrap_err().to_string();
        assert!(said.contains("line 2, column 3 (`speed = 2`): unknown field `speed`"), "{said}");
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
            assert!(
                said.starts_with("v.toml: expected") && said.len() < 1000,
                "{} bytes: {said:.200}",
                said.len()
            );
        }
    }
}
