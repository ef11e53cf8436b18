//! Long sentences as lines of a terminal.

use super::quantity::is_one;
use std::fmt::Write;

/// Before the second line of a sentence, and each after it.
const INDENT: &str = "  ";

/// Lines of at most so many columns, broken between words; those after the first are moved in. A number stands on one line with its
/// error and unit, unless these are longer than a line.
#[must_use]
pub fn wrapped(text: &str, columns: usize) -> Vec<String> {
    let columns = columns.max(20);
    let words: Vec<&str> = text.split_whitespace().collect();
    let mut lines = Vec::new();
    let mut line = String::new();
    for quantity in words.chunk_by(|before, word| is_one(before, word)) {
        let whole = quantity.join(" ");
        if INDENT.len() + whole.chars().count() <= columns {
            add(&mut lines, &mut line, &whole, columns);
        } else {
            quantity.iter().for_each(|word| add(&mut lines, &mut line, word, columns));
        }
    }
    if !line.trim().is_empty() {
        lines.push(line);
    }
    lines
}

/// Adds a word to a line, or to the next one where there is no room.
fn add(lines: &mut Vec<String>, line: &mut String, word: &str, columns: usize) {
    let space = usize::from(!line.trim().is_empty());
    if space > 0 && line.chars().count() + space + word.chars().count() > columns {
        lines.push(std::mem::replace(line, INDENT.to_owned()));
    }
    let between = if line.trim().is_empty() { "" } else { " " };
    // writing to a String cannot fail
    let _ = write!(line, "{between}{word}");
}

/// What begins a command that a person may copy.
const PROMPT: &str = "$ ";
/// At the end of each line of a command but its last: a shell then takes the next line with it.
const GOES_ON: &str = " \\";

/// Bytes of each letter and its columns: sequences that set a colour take none.
fn letters(text: &str) -> impl Iterator<Item = (usize, usize)> {
    let mut in_sequence = false;
    text.char_indices().map(move |(at, letter)| {
        in_sequence |= letter == '\u{1b}';
        let columns = usize::from(!in_sequence);
        in_sequence &= letter != 'm';
        (at, columns)
    })
}

/// Columns that a terminal takes for a text.
fn columns_of(text: &str) -> usize {
    letters(text).map(|(_, columns)| columns).sum()
}

/// Bytes of the beginning of a text that takes so many columns.
fn beginning(text: &str, columns: usize) -> usize {
    let mut taken = 0;
    let behind = letters(text).find(|(_, own)| {
        taken += own;
        taken > columns
    });
    behind.map_or(text.len(), |(at, _)| at)
}

/// A line as it was written, in lines of at most so many columns: broken between words, those after the first moved in by two more than
/// the line itself. A command after `$ ` still is one when it is copied. A word that is longer than a line stays whole, and so does a
/// number with its error and unit that fits a line.
#[must_use]
pub fn to_width(line: &str, columns: usize) -> Vec<String> {
    let columns = columns.max(20);
    let text = line.trim_end();
    if columns_of(text) <= columns {
        return vec![line.to_owned()];
    }
    let indent: String = text.chars().take_while(|letter| *letter == ' ').chain(INDENT.chars()).collect();
    let end = if text.starts_with(PROMPT) { GOES_ON } else { "" };
    let room = columns - end.len();
    let mut lines = Vec::new();
    let mut rest = text.to_owned();
    while columns_of(&rest) > columns {
        let first = rest.len() - rest.trim_start().len();
        // the last space within the line that is in no quantity, else the last one, else the first one behind the line
        let fits = beginning(&rest, room + 1).max(first);
        let spaces = || rest[first..fits].rmatch_indices(' ').map(|(at, _)| first + at);
        let within = spaces().find(|at| !is_in_quantity(&rest, *at)).or_else(|| spaces().next());
        let Some(at) = within.or_else(|| rest[fits..].find(' ').map(|at| fits + at)) else { break };
        lines.push(format!("{}{end}", rest[..at].trim_end()));
        rest = format!("{indent}{}", rest[at..].trim_start());
    }
    lines.push(rest);
    lines
}

/// Whether the space at a place stands between a number, its error and its unit.
fn is_in_quantity(text: &str, at: usize) -> bool {
    let before = text[..at].rsplit(' ').next().unwrap_or_default();
    let behind = text[at..].split(' ').nth(1).unwrap_or_default();
    is_one(before, behind)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_keeps_its_form_and_no_word_is_broken() {
        assert_eq!(to_width("  short   table ", 40), ["  short   table "]);
        let text = "  warning: fence: expected a fence round the place of the flight, got none";
        for columns in [20, 37, 60] {
            let lines = to_width(text, columns);
            assert!(lines.iter().all(|line| line.chars().count() <= columns), "{lines:#?}");
            assert!(lines[0].starts_with("  w") && lines[1..].iter().all(|line| line.starts_with("    ")));
            let words: Vec<&str> = lines.iter().flat_map(|line| line.split_whitespace()).collect();
            assert_eq!(words, text.split_whitespace().collect::<Vec<_>>());
        }
        // a path longer than the line
        let path = "x".repeat(50);
        assert_eq!(
            to_width(&format!("wrote {path} at last"), 30),
            ["wrote".to_owned(), format!("  {path}"), "  at last".to_owned()]
        );
        assert_eq!(to_width(&path, 30), [path]);
        assert_eq!(to_width("ä ö ü é è ê ñ õ ã ç ß ø", 20), ["ä ö ü é è ê ñ õ ã ç", "  ß ø"]);
    }

    #[test]
    fn colours_take_no_columns() {
        let line = "  \u{1b}[1m--room\u{1b}[0m the free room in metres";
        assert_eq!(to_width(line, 32), [line]);
        assert_eq!(to_width(line, 24), ["  \u{1b}[1m--room\u{1b}[0m the free room", "    in metres"]);
    }

    #[test]
    fn a_command_is_one_when_it_is_copied() {
        let lines = to_width("$ mavid fly --connect udpin:127.0.0.1:14550 --out flight1 --arm", 40);
        assert_eq!(
            lines,
            ["$ mavid fly --connect \\", "  udpin:127.0.0.1:14550 --out flight1 \\", "  --arm"]
        );
    }

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

    #[test]
    fn a_number_stands_on_one_line_with_its_error_and_unit() {
        let text = "drag was left out: 0.412 +- 0.014 N per m/s, by 97 %, 0.040 +- 0.003 kg m^2";
        for columns in 28..90 {
            for lines in [wrapped(text, columns), to_width(text, columns)] {
                assert!(lines.iter().all(|line| line.chars().count() <= columns), "{lines:#?}");
                for whole in ["0.412 +- 0.014 N per m/s,", "97 %,", "0.040 +- 0.003 kg m^2"] {
                    assert!(lines.iter().any(|line| line.contains(whole)), "{columns}: {lines:#?}");
                }
            }
        }
        // where it fits no line it is broken as words are
        for lines in [wrapped(text, 20), to_width(text, 20)] {
            assert!(lines.iter().all(|line| line.chars().count() <= 20), "{lines:#?}");
        }
    }
}
