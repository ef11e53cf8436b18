//! What a person is asked, and what holds where nobody can be asked.

use crate::commands::agreement::{NO, YES};
use std::io::{self, BufRead};

use mavid::text;

use crate::commands::fly::is_attended;
use crate::commands::{CommandError, output, typed_early};

/// The end of the advice for a question that no option answers.
const Y_OR_N: &str = ", and answer y or n";
/// So often a wrong answer is asked for again.
const TRIES: u32 = 3;

/// Asks, or knows that nobody is there.
#[derive(Debug, Clone, Copy)]
pub struct Ask {
    person: bool,
}

impl Ask {
    /// A person at a terminal, unless `yes` was said beforehand.
    ///
    /// # Errors
    /// Neither is there.
    pub fn new(yes: bool) -> Result<Self, CommandError> {
        if yes || is_attended() {
            return Ok(Self { person: !yes });
        }
        let what = "run: expected a terminal at which questions can be answered, or --yes, got neither: --yes takes the \
                    defaults, and with --arm it flies";
        Err(CommandError::Input(what.to_owned()))
    }

    /// Somebody can be asked.
    pub fn is_person(self) -> bool {
        self.person
    }

    /// A value, by `parse`; `None` is the answer of return alone. `otherwise` ends the advice after wrong answers: an option, or what to
    /// answer. Where nobody is there, `alone` says what holds.
    pub fn value<T>(
        self,
        (question, otherwise): (&str, &str),
        parse: impl Fn(&str) -> Result<T, String>,
        alone: impl FnOnce() -> Result<Option<T>, CommandError>,
    ) -> Result<Option<T>, CommandError> {
        if !self.person {
            return alone();
        }
        for _ in 0..TRIES {
            let answer = answer(question)?;
            if answer.is_empty() {
                return Ok(None);
            }
            match parse(&answer) {
                Ok(value) => return Ok(Some(value)),
                Err(expected) => {
                    output::message(&format!("expected {expected}, got {}", text::excerpt(&answer, 30)));
                }
            }
        }
        Err(CommandError::Input(format!(
            "{question}: no answer that can be used; give the same command again{otherwise}"
        )))
    }

    /// Yes or no; return alone is yes. Where nobody is there, `alone` is the answer.
    pub fn agreed(self, question: &str, alone: bool) -> Result<bool, CommandError> {
        let question = format!("{question} [Y/n]");
        Ok(self.value((&question, Y_OR_N), yes_or_no, || Ok(Some(alone)))?.unwrap_or(true))
    }

    /// Yes or no; return alone is no, and so it is where nobody is there.
    pub fn agreed_expressly(self, question: &str) -> Result<bool, CommandError> {
        let question = format!("{question} [y/N]");
        Ok(self.value((&question, Y_OR_N), yes_or_no, || Ok(None))?.unwrap_or(false))
    }
}

fn yes_or_no(answer: &str) -> Result<bool, String> {
    match answer.to_ascii_lowercase() {
        yes if YES.contains(&yes.as_str()) => Ok(true),
        no if NO.contains(&no.as_str()) => Ok(false),
        _ => Err("y or n".to_owned()),
    }
}

/// One line of standard input, trimmed: at a terminal one that was typed after the question was asked.
fn answer(question: &str) -> Result<String, CommandError> {
    typed_early::throw_away();
    output::message(question);
    let mut line = String::new();
    let read = io::stdin().lock().read_line(&mut line);
    match read {
        Ok(0) => {
            Err(CommandError::Ended("ended at a question; run the same command again to continue".to_owned()))
        }
        Ok(_) => Ok(line.trim().to_owned()),
        Err(error) => Err(CommandError::Failure(format!("cannot read standard input: {error}"))),
    }
}

/// A number within bounds, by its unit.
pub fn number(text: &str, unit: &str, (least, most): (f64, f64)) -> Result<f64, String> {
    let expected = || format!("a number of {least} to {most} {unit}");
    let value: f64 = text.trim_end_matches(unit).trim().replace(',', ".").parse().map_err(|_| expected())?;
    if (least..=most).contains(&value) { Ok(value) } else { Err(expected()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_taken_as_people_write_them() {
        assert_eq!(number("1.5", "kg", (0.1, 10.0)), Ok(1.5));
        assert_eq!(number("1,5 kg", "kg", (0.1, 10.0)), Ok(1.5));
        assert!(number("50", "kg", (0.1, 10.0)).unwrap_err().contains("0.1 to 10 kg"));
        assert!(number("heavy", "kg", (0.1, 10.0)).is_err() && number("nan", "kg", (0.1, 10.0)).is_err());
    }

    #[test]
    fn nobody_is_asked_where_yes_was_said() {
        let ask = Ask::new(true).unwrap();
        assert!(!ask.is_person() && ask.agreed("?", true).unwrap() && !ask.agreed("?", false).unwrap());
        assert!(!ask.agreed_expressly("?").unwrap());
        let doubt = || Err(CommandError::Input("doubt".to_owned()));
        assert!(ask.value(("?", " with --mass"), |_| Ok(1), doubt).is_err());
    }
}
