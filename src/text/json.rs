//! JSON in which nothing commands a terminal: what JSON itself lets stand is escaped as well.

use std::io::{self, Write};

use serde::Serialize;
use serde_json::ser::{CompactFormatter, Formatter, PrettyFormatter, Serializer};

use super::escape::is_command;

/// A document over several lines.
///
/// # Errors
/// Where a value has no form in JSON.
pub fn json_pretty(document: &impl Serialize) -> serde_json::Result<String> {
    written(document, PrettyFormatter::new())
}

/// A document on one line.
///
/// # Errors
/// Where a value has no form in JSON.
pub fn json_line(document: &impl Serialize) -> serde_json::Result<String> {
    written(document, CompactFormatter)
}

fn written(document: &impl Serialize, form: impl Formatter) -> serde_json::Result<String> {
    let mut bytes = Vec::new();
    document.serialize(&mut Serializer::with_formatter(&mut bytes, VisibleFormatter(form)))?;
    String::from_utf8(bytes).map_err(|error| serde_json::Error::io(io::Error::other(error)))
}

/// Any form of JSON. Characters that a terminal obeys become `\uXXXX`, also where JSON would allow them as they are.
struct VisibleFormatter<F>(F);

impl<F: Formatter> Formatter for VisibleFormatter<F> {
    fn write_string_fragment<W: ?Sized + Write>(&mut self, to: &mut W, fragment: &str) -> io::Result<()> {
        let mut units = [0; 2];
        let mut rest = fragment;
        while let Some((at, letter)) = rest.char_indices().find(|(_, letter)| is_command(*letter)) {
            to.write_all(&rest.as_bytes()[..at])?;
            for unit in letter.encode_utf16(&mut units) {
                write!(to, "\\u{unit:04x}")?;
            }
            rest = &rest[at + letter.len_utf8()..];
        }
        to.write_all(rest.as_bytes())
    }

    fn begin_array<W: ?Sized + Write>(&mut self, to: &mut W) -> io::Result<()> {
        self.0.begin_array(to)
    }

    fn end_array<W: ?Sized + Write>(&mut self, to: &mut W) -> io::Result<()> {
        self.0.end_array(to)
    }

    fn begin_array_value<W: ?Sized + Write>(&mut self, to: &mut W, first: bool) -> io::Result<()> {
        self.0.begin_array_value(to, first)
    }

    fn end_array_value<W: ?Sized + Write>(&mut self, to: &mut W) -> io::Result<()> {
        self.0.end_array_value(to)
    }

    fn begin_object<W: ?Sized + Write>(&mut self, to: &mut W) -> io::Result<()> {
        self.0.begin_object(to)
    }

    fn end_object<W: ?Sized + Write>(&mut self, to: &mut W) -> io::Result<()> {
        self.0.end_object(to)
    }

    fn begin_object_key<W: ?Sized + Write>(&mut self, to: &mut W, first: bool) -> io::Result<()> {
        self.0.begin_object_key(to, first)
    }

    fn begin_object_value<W: ?Sized + Write>(&mut self, to: &mut W) -> io::Result<()> {
        self.0.begin_object_value(to)
    }

    fn end_object_value<W: ?Sized + Write>(&mut self, to: &mut W) -> io::Result<()> {
        self.0.end_object_value(to)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn it_reads_the_same_and_commands_nothing() {
        let document = json!({ "a\u{9b}": ["x\u{1b}[31m\n\u{85}\u{7f}\u{202e}", 1.5], "b": {}, "c": [] });
        for text in [json_pretty(&document).unwrap(), json_line(&document).unwrap()] {
            assert!(!text.chars().any(|letter| letter != '\n' && is_command(letter)), "{text}");
            assert_eq!(serde_json::from_str::<serde_json::Value>(&text).unwrap(), document);
        }
        let plain = json!({ "a": [1, 2], "b": { "c": "d" } });
        assert_eq!(json_pretty(&plain).unwrap(), serde_json::to_string_pretty(&plain).unwrap());
        assert_eq!(json_line(&plain).unwrap(), plain.to_string());
    }
}
