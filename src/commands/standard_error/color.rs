//! Whether standard error is in colours.

use std::ffi::OsStr;
use std::io::{self, IsTerminal};

use clap::ColorChoice;
use ratatui::crossterm::style::{Stylize, force_color_output};

/// How a line stands out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Tone {
    /// it does not
    Plain,
    /// what the user should know
    Warning,
    /// why the work is not done
    Error,
}

impl Tone {
    /// A line in the colour of its tone.
    pub(super) fn colored(self, line: &str) -> String {
        match self {
            Self::Plain => line.to_owned(),
            Self::Warning => line.yellow().to_string(),
            Self::Error => line.red().to_string(),
        }
    }
}

/// Settles it for messages and for the view of a flight: as `--color` says, and else on a terminal that may have colours.
pub(super) fn settle(choice: ColorChoice) -> bool {
    let has_colors = help_has_colors(choice, io::stderr().is_terminal());
    force_color_output(has_colors);
    has_colors
}

/// The same for help, which goes to standard output or, after a mistake, to standard error: `is_terminal` says of which.
pub fn help_has_colors(choice: ColorChoice, is_terminal: bool) -> bool {
    let [no_color, term] = ["NO_COLOR", "TERM"].map(std::env::var_os);
    has_colors(choice, is_terminal, no_color.as_deref(), term.as_deref())
}

fn has_colors(
    choice: ColorChoice,
    is_terminal: bool,
    no_color: Option<&OsStr>,
    term: Option<&OsStr>,
) -> bool {
    let is_unwanted =
        no_color.is_some_and(|value| !value.is_empty()) || term.is_some_and(|term| term == "dumb");
    match choice {
        ColorChoice::Always => true,
        ColorChoice::Never => false,
        ColorChoice::Auto => is_terminal && !is_unwanted,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_option_beats_the_environment_and_that_the_terminal() {
        let some = |text: &'static str| Some(OsStr::new(text));
        assert!(has_colors(ColorChoice::Auto, true, None, some("xterm")));
        assert!(has_colors(ColorChoice::Auto, true, some(""), None));
        assert!(!has_colors(ColorChoice::Auto, true, some("1"), None));
        assert!(!has_colors(ColorChoice::Auto, true, None, some("dumb")));
        assert!(!has_colors(ColorChoice::Auto, false, None, None));
        assert!(has_colors(ColorChoice::Always, false, some("1"), None));
        assert!(!has_colors(ColorChoice::Never, true, None, None));
    }
}
