//! A step of the run: a command that exists, as one line. What is done is what the line says: it is parsed as if it was typed.

use std::ffi::{OsStr, OsString};

use clap::Parser;
use mavid::text::{self, shell_word};

use crate::cli::{
    Cli, ExplainArgs, ExportArgs, FlyArgs, IdentifyArgs, InitArgs, PlanArgs, SitlArgs, VehicleVerb, Verb,
};
use crate::commands::{CommandError, output};

/// The program as it is typed.
const PROGRAM: &str = "mavid";

/// A command, word by word.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Step(Vec<OsString>);

impl Step {
    /// A verb without arguments yet.
    pub fn of(verb: &[&str]) -> Self {
        Self(verb.iter().map(OsString::from).collect())
    }

    /// One more word.
    pub fn word(mut self, word: impl AsRef<OsStr>) -> Self {
        self.0.push(word.as_ref().to_owned());
        self
    }

    /// An option with its value.
    pub fn option(self, name: &str, value: impl AsRef<OsStr>) -> Self {
        self.word(name).word(value)
    }

    /// An option with its value, where there is one.
    pub fn maybe(self, name: &str, value: Option<impl AsRef<OsStr>>) -> Self {
        match value {
            Some(value) => self.option(name, value),
            None => self,
        }
    }

    /// A flag, where it is wanted.
    pub fn flag(self, name: &str, wanted: bool) -> Self {
        if wanted { self.word(name) } else { self }
    }

    /// As it is typed into a shell.
    pub fn line(&self) -> String {
        let words = self.0.iter().map(|word| shell_word(&text::path(word)));
        std::iter::once(PROGRAM.to_owned()).chain(words).collect::<Vec<_>>().join(" ")
    }

    /// Says it, so that it can be repeated alone.
    pub fn tell(&self) {
        output::message(&format!("$ {}", self.line()));
    }

    /// As the command line is understood.
    pub fn parse(&self) -> Result<Verb, CommandError> {
        let words = std::iter::once(OsStr::new(PROGRAM)).chain(self.0.iter().map(OsString::as_os_str));
        Cli::try_parse_from(words).map(|cli| cli.verb).map_err(|error| {
            let why = error.to_string();
            let first = why.lines().next().unwrap_or_default();
            CommandError::Input(format!("{}: {}", self.line(), first.trim_start_matches("error: ")))
        })
    }

    fn picked<T>(&self, pick: impl FnOnce(Verb) -> Option<T>) -> Result<T, CommandError> {
        let other = || CommandError::Failure(format!("{}: expected another command", self.line()));
        pick(self.parse()?).ok_or_else(other)
    }

    /// Of `mavid vehicle init`.
    pub fn init(&self) -> Result<InitArgs, CommandError> {
        self.picked(|verb| match verb {
            Verb::Vehicle(vehicle) => match vehicle.verb {
                Some(VehicleVerb::Init(args)) => Some(args),
                _ => None,
            },
            _ => None,
        })
    }

    /// Of `mavid plan`.
    pub fn plan(&self) -> Result<PlanArgs, CommandError> {
        self.picked(|verb| if let Verb::Plan(args) = verb { Some(args) } else { None })
    }

    /// Of `mavid fly`.
    pub fn fly(&self) -> Result<FlyArgs, CommandError> {
        self.picked(|verb| if let Verb::Fly(args) = verb { Some(args) } else { None })
    }

    /// Of `mavid sitl`.
    pub fn sitl(&self) -> Result<SitlArgs, CommandError> {
        self.picked(|verb| if let Verb::Sitl(args) = verb { Some(args) } else { None })
    }

    /// Of `mavid explain`.
    pub fn explain(&self) -> Result<ExplainArgs, CommandError> {
        self.picked(|verb| if let Verb::Explain(args) = verb { Some(args) } else { None })
    }

    /// Of `mavid identify`.
    pub fn identify(&self) -> Result<IdentifyArgs, CommandError> {
        self.picked(|verb| if let Verb::Identify(args) = verb { Some(args) } else { None })
    }

    /// Of `mavid export`.
    pub fn export(&self) -> Result<ExportArgs, CommandError> {
        self.picked(|verb| if let Verb::Export(args) = verb { Some(args) } else { None })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_what_is_done() {
        let step = Step::of(&["plan"])
            .word("my folder/vehicle.toml")
            .option("--takeoff", "0,0,-1.5")
            .maybe("--limits", None::<&str>)
            .flag("--check", false);
        assert_eq!(step.line(), "mavid plan 'my folder/vehicle.toml' --takeoff 0,0,-1.5");
        assert_eq!(step.plan().unwrap().takeoff, Some(vec![0.0, 0.0, -1.5]));
        let said = step.fly().unwrap_err().to_string();
        assert!(said.contains("mavid plan"), "{said}");
        let wrong = Step::of(&["plan"]).word("v.toml").word("--unknown").parse().unwrap_err();
        assert!(wrong.to_string().contains("--unknown"), "{wrong}");
        assert_eq!(wrong.status(), 2);
    }
}
