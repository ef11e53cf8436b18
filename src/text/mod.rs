//! Text that others wrote: what a vehicle says, names in files, columns, paths, and what errors quote of them.
//!
//! All of it passes through here where it enters, before it is stored, shown or written to a file. Characters that
//! command a terminal, break a line or turn the direction of reading become visible escapes such as `\u{1b}`; whoever
//! writes a format then escapes for that format (XML, Python, TOML, JSON, HTML), for which what is ordinary here may
//! still mean something.

mod format;
mod json;

pub use format::{line_comment, markup, markup_comment, toml_string};
pub use json::{json_line, json_pretty};

use std::borrow::Cow;
use std::ffi::OsStr;

/// Names of a list that are told one by one.
const LISTED: usize = 20;
/// Characters of one name in a list.
const NAME_CHARS: usize = 64;

/// A character that does something instead of being seen: C0 and C1 controls, line and paragraph separators, marks and
/// overrides of the direction of reading, interlinear marks and the byte order mark.
#[must_use]
pub fn is_command(letter: char) -> bool {
    letter.is_control()
        || matches!(
            letter,
            '\u{61c}'
                | '\u{200e}'
                | '\u{200f}'
                | '\u{2028}'..='\u{202e}'
                | '\u{2066}'..='\u{2069}'
                | '\u{feff}'
                | '\u{fff9}'..='\u{fffb}'
        )
}

/// On one line, each character that [`is_command`] as an escape. What is clean already stays as it is.
#[must_use]
pub fn clean(text: &str) -> String {
    escaped(text, |_| false).into_owned()
}

/// As [`clean`], line by line: breaks between lines stay.
#[must_use]
pub fn clean_lines(text: &str) -> Cow<'_, str> {
    escaped(text, |letter| letter == '\n')
}

fn escaped(text: &str, stays: impl Fn(char) -> bool) -> Cow<'_, str> {
    let acts = |letter: char| is_command(letter) && !stays(letter);
    if !text.chars().any(acts) {
        return Cow::Borrowed(text);
    }
    let mut seen = String::with_capacity(text.len() + 16);
    for letter in text.chars() {
        if acts(letter) {
            seen.extend(letter.escape_default());
        } else {
            seen.push(letter);
        }
    }
    Cow::Owned(seen)
}

/// Clean, and no longer than `chars` characters: an error need not repeat a file.
#[must_use]
pub fn excerpt(text: &str, chars: usize) -> String {
    match text.char_indices().nth(chars) {
        None => clean(text),
        Some((end, _)) => format!("{}...", clean(&text[..end])),
    }
}

/// A path, or a part of one, for people: clean.
#[must_use]
pub fn path<P: AsRef<OsStr> + ?Sized>(path: &P) -> String {
    clean(&path.as_ref().to_string_lossy())
}

/// Names one after the other, as many as can be read.
pub fn listed<T: AsRef<str>>(names: impl ExactSizeIterator<Item = T>) -> String {
    let further = names.len().saturating_sub(LISTED);
    let mut told: Vec<String> = names.take(LISTED).map(|name| excerpt(name.as_ref(), NAME_CHARS)).collect();
    if further > 0 {
        told.push(format!("and {further} more"));
    }
    told.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_commands_becomes_visible_and_the_rest_stays() {
        assert_eq!(
            clean("x\u{1b}[31m\r\n\t\u{9b}2J\u{7}\u{7f}"),
            "x\\u{1b}[31m\\r\\n\\t\\u{9b}2J\\u{7}\\u{7f}"
        );
        assert_eq!(clean("a\u{202e}b\u{2067}c\u{2028}d\u{feff}"), "a\\u{202e}b\\u{2067}c\\u{2028}d\\u{feff}");
        let ordinary = "X500 \"Prüfstand\" <3> 日本 \\ % {0} \u{fffd}";
        assert_eq!(clean(ordinary), ordinary);
        let once = clean("\u{0}\u{1b}");
        assert_eq!(clean(&once), once);
        assert_eq!(clean_lines("one\ntwo\r\u{1b}"), "one\ntwo\\r\\u{1b}");
    }

    #[test]
    fn quotations_and_lists_have_an_end() {
        assert_eq!(excerpt("ab\ncd", 3), "ab\\n...");
        assert_eq!(excerpt("日本", 2), "日本");
        let names: Vec<String> = (0..50).map(|number| format!("c{number}")).collect();
        let told = listed(names.iter());
        assert!(told.starts_with("c0, c1, ") && told.ends_with("c19, and 30 more"), "{told}");
        assert_eq!(path("a\nb"), "a\\nb");
    }
}
