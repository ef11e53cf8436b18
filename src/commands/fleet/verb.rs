//! The dispatch of `mavid fleet`.

use super::{one, report, run as making};
use crate::cli::{FleetArgs, FleetVerb};
use crate::commands::standard_error::StandardError;
use crate::commands::{CommandError, Outcome, output};
use mavid::fleet::Schema;

/// Runs the verb.
pub fn run(json: bool, stderr: &StandardError, args: &FleetArgs) -> Result<Outcome, CommandError> {
    match &args.verb {
        Some(FleetVerb::Report(args)) => report::run(json, args),
        Some(FleetVerb::Rows(args)) => one::run(json, args),
        Some(FleetVerb::Schema) => {
            let schema = Schema::current();
            if json { output::json(&schema) } else { output::file_text(&schema.markdown()) }?;
            Ok(Outcome::Done)
        }
        None => making::run(json, stderr, &args.run),
    }
}
