//! Characters that command something, as escapes that show.

use std::borrow::Cow;

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

/// As [`clean`], line by line: breaks between lines and tabs stay.
#[must_use]
pub fn clean_lines(text: &str) -> Cow<'_, str> {
    escaped(text, |letter| matches!(letter, '\n' | '\t'))
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
}
