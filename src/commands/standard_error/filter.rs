//! Which events become log lines.

use std::ffi::OsStr;

use mavid::fly::EVENTS_TARGET;
use mavid::text;
use tracing_subscriber::filter::EnvFilter;

use super::target::MESSAGE;
use crate::cli::Verbosity;
use crate::commands::CommandError;

/// Names of the levels in a directive.
const LEVELS: [&str; 6] = ["off", "error", "warn", "info", "debug", "trace"];

/// What `RUST_LOG` asks for, or else `-v`. Messages are never log lines; the log of a flight is shown by its view and is
/// written to its file, so that `RUST_LOG` alone asks for it here.
///
/// # Errors
/// [`CommandError::Input`] where one of them makes no sense.
pub(super) fn filter(verbosity: &Verbosity, variable: Option<&OsStr>) -> Result<EnvFilter, CommandError> {
    if verbosity.quiet && verbosity.verbose > 0 {
        return Err(CommandError::Input("expected one of --quiet and --verbose, got both".to_owned()));
    }
    let Some(given) = variable.filter(|given| !given.is_empty()) else {
        let level = match verbosity.verbose {
            0 => "off",
            1 => "info",
            2 => "debug",
            _ => "trace",
        };
        return parsed(&format!("mavid={level},{EVENTS_TARGET}=off,{MESSAGE}=off"))
            .map_err(|why| CommandError::Failure(format!("the levels of -v: {why}")));
    };
    let wrong = |why: &str| {
        CommandError::Input(format!(
            "RUST_LOG: expected a level ({}) or TARGET=LEVEL, several with commas between them, such as \
             `warn,mavid::link=debug`; got `{}`: {why}",
            LEVELS.join(", "),
            text::path(given)
        ))
    };
    let given = given.to_str().ok_or_else(|| wrong("it is not UTF-8"))?;
    if let Some(word) = given.split(',').map(str::trim).find(|word| is_no_level(word)) {
        return Err(wrong(&format!("`{}` is no level", text::clean(word))));
    }
    parsed(&format!("{given},{MESSAGE}=off")).map_err(|why| wrong(&why))
}

/// A word alone, which is taken for a target where it is no level: of this program there is one.
fn is_no_level(word: &str) -> bool {
    let is_word = !word.is_empty() && word.chars().all(|letter| letter.is_alphanumeric() || letter == '_');
    is_word && word != "mavid" && !LEVELS.iter().any(|level| word.eq_ignore_ascii_case(level))
}

fn parsed(directives: &str) -> Result<EnvFilter, String> {
    EnvFilter::builder().parse(directives).map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn verbosity(verbose: u8) -> Verbosity {
        Verbosity { verbose, quiet: false }
    }

    fn refusal(variable: &str) -> String {
        filter(&verbosity(0), Some(OsStr::new(variable))).unwrap_err().to_string()
    }

    #[test]
    fn the_flag_says_the_level_and_the_variable_overrides_it() {
        for (verbose, level) in [(0, "off"), (1, "info"), (2, "debug"), (3, "trace"), (9, "trace")] {
            let shown = filter(&verbosity(verbose), None).unwrap().to_string();
            assert!(shown.contains(&format!("mavid={level}")), "{shown}");
        }
        for given in ["info", "mavid", "mavid::link=debug", "WARN,mavid::fly=trace", "mavid[flight]=debug"] {
            let shown = filter(&verbosity(1), Some(OsStr::new(given))).unwrap().to_string();
            assert!(!shown.contains(EVENTS_TARGET), "{shown}");
            assert!(shown.contains("mavid::message=off"), "{shown}");
        }
        let empty = filter(&verbosity(1), Some(OsStr::new(""))).unwrap().to_string();
        assert!(empty.contains("mavid=info"), "{empty}");
    }

    #[test]
    fn a_wrong_variable_is_told_with_what_was_expected() {
        for wrong in ["mavid=loud", "loud", "mavid=info,debugg", "mavid[=info", "\u{1b}[31m"] {
            let told = refusal(wrong);
            assert!(told.starts_with("RUST_LOG: expected a level (off, error, warn, info"), "{told}");
            assert!(!told.contains('\u{1b}'), "{told}");
        }
    }
}
