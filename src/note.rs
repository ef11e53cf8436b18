//! What a stage has to say beside its result: remarks, warnings and losses, each with what it is about.

use serde::{Serialize, Serializer};
use std::fmt;

/// How much a note matters; the order is from little to much.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// good to know
    Remark,
    /// the result may be wrong, or says less than was asked for
    Warning,
    /// a part of the data was not read or not used
    Loss,
}

/// What a note is about.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum About {
    /// a file that went in, by its name as given
    File(String),
    /// a link, by its address
    Link(String),
    /// a case of `prove`, by its folder's name
    Case(String),
    /// key and times by which a link signs
    Signing,
    /// what the vehicle file states
    Vehicle,
    /// recorded streams of the motion
    Sensors,
    /// streams that contradict each other, or the rotors of the vehicle file
    Contradiction,
    /// commands, rotor speeds, and the law from them to thrust
    Actuators,
    /// the estimate and the method that it comes from
    Estimate,
    /// the comparison with flights that were not used
    HoldOut,
    /// the errors of models on a flight
    Errors,
}

/// A sentence beside a result.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Note {
    /// how much it matters
    pub severity: Severity,
    /// what it is about
    pub about: About,
    /// without the name of the file, link or case that it may be about
    pub text: String,
}

impl Note {
    /// Good to know.
    #[must_use]
    pub fn remark(about: About, text: impl Into<String>) -> Self {
        Self { severity: Severity::Remark, about, text: text.into() }
    }

    /// The result may be wrong.
    #[must_use]
    pub fn warning(about: About, text: impl Into<String>) -> Self {
        Self { severity: Severity::Warning, about, text: text.into() }
    }

    /// A part of the data was not used.
    #[must_use]
    pub fn loss(about: About, text: impl Into<String>) -> Self {
        Self { severity: Severity::Loss, about, text: text.into() }
    }

    /// The same about a file.
    #[must_use]
    pub fn of_file(&self, name: &str) -> Self {
        Self { about: About::File(name.to_owned()), ..self.clone() }
    }

    /// It is a warning.
    #[must_use]
    pub fn is_warning(&self) -> bool {
        self.severity == Severity::Warning
    }

    /// The text after the name of the file, link or case that it is about, without its severity.
    #[must_use]
    pub fn sentence(&self) -> String {
        match &self.about {
            About::File(name) | About::Link(name) | About::Case(name) => format!("{name}: {}", self.text),
            _ => self.text.clone(),
        }
    }
}

/// As it stands in documents: its sentence.
impl Serialize for Note {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&self.sentence())
    }
}

/// Names that are told of several files of which the same is said.
const NAMED: usize = 4;

/// Notes of which each is said once: what several files have in common, with their names.
#[must_use]
pub fn said_once(notes: Vec<Note>) -> Vec<Note> {
    let mut once: Vec<(Note, Vec<String>)> = Vec::new();
    for note in notes {
        let file = if let About::File(name) = &note.about { Some(name.clone()) } else { None };
        let is_same = |(other, files): &&mut (Note, Vec<String>)| {
            (other.severity, &other.text) == (note.severity, &note.text)
                && if file.is_some() { !files.is_empty() } else { other.about == note.about }
        };
        match once.iter_mut().find(is_same) {
            Some((_, files)) => files.extend(file.filter(|file| !files.contains(file))),
            None => once.push((note, file.into_iter().collect())),
        }
    }
    let named = |(note, files): (Note, Vec<String>)| match files.len() {
        0 | 1 => note,
        count => {
            let told = files.iter().take(NAMED).cloned().collect::<Vec<_>>().join(", ");
            let more = if count > NAMED { format!(" and {} more", count - NAMED) } else { String::new() };
            Note { about: About::File(format!("{told}{more}")), ..note }
        }
    };
    once.into_iter().map(named).collect()
}

/// As it is printed: a warning says that it is one.
impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mark = if self.is_warning() { "warning: " } else { "" };
        write!(f, "{mark}{}", self.sentence())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_warning_says_what_it_is_and_what_it_is_about() {
        let of = || About::File("a.tlog".to_owned());
        assert_eq!(Note::warning(of(), "short").to_string(), "warning: a.tlog: short");
        assert_eq!(Note::remark(of(), "short").to_string(), "a.tlog: short");
        assert_eq!(Note::loss(About::Sensors, "cut").to_string(), "cut");
        assert!(Severity::Remark < Severity::Warning && Severity::Warning < Severity::Loss);
    }

    #[test]
    fn what_is_said_of_several_files_is_said_once_with_their_names() {
        let of = |name: &str, text: &str| Note::warning(About::File(name.to_owned()), text);
        let rest = Note::remark(About::Vehicle, "short");
        let notes =
            vec![of("a", "slow"), of("b", "slow"), of("b", "cut"), of("a", "slow"), rest.clone(), rest];
        let told: Vec<String> = said_once(notes).iter().map(ToString::to_string).collect();
        assert_eq!(told, ["warning: a, b: slow", "warning: b: cut", "short"]);
        let many = (0..9).map(|index| of(&index.to_string(), "slow")).collect();
        assert_eq!(said_once(many)[0].sentence(), "0, 1, 2, 3 and 5 more: slow");
    }
}
