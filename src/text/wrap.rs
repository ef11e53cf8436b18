//! Long sentences as lines of a terminal.

use std::fmt::Write;

/// Before the second line of a sentence, and each after it.
const INDENT: &str = "  ";

/// Lines of at most so many columns, broken between words; those after the first are moved in.
#[must_use]
pub fn wrapped(text: &str, columns: usize) -> Vec<String> {
    let columns = columns.max(20);
    let mut lines = Vec::new();
    let mut line = String::new();
    for word in text.split_whitespace() {
        let space = usize::from(!line.trim().is_empty());
        if space > 0 && line.chars().count() + space + word.chars().count() > columns {
            lines.push(std::mem::replace(&mut line, INDENT.to_owned()));
        }
        let between = if line.trim().is_empty() { "" } else { " " };
        // writing to a String cannot fail
        let _ = write!(line, "{between}{word}");
    }
    if !line.trim().is_empty() {
        lines.push(line);
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_broken_between_words_and_none_is_lost() {
        let text =
            "warning: fence: expected a fence round the place of the flight, got none in force; set one";
        for columns in [20, 37, 80, 200] {
            let lines = wrapped(text, columns);
            assert!(lines.iter().all(|line| line.chars().count() <= columns), "{lines:#?}");
            let words: Vec<&str> = lines.iter().flat_map(|line| line.split_whitespace()).collect();
            assert_eq!(words, text.split_whitespace().collect::<Vec<_>>());
        }
    }
}
