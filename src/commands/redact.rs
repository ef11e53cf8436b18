//! `mavid redact LOG --out FILE`: a log to share, without positions, serial numbers and keys.

use mavid::log::expect_file;
use mavid::redact::redact;
use mavid::text;
use serde::Serialize;

use super::{CommandError, Outcome, output};
use crate::cli::RedactArgs;

#[derive(Serialize)]
struct RedactedDocument {
    out: String,
    bytes: usize,
    messages_kept: u64,
    coordinates_moved: u64,
    values_emptied: u64,
    messages_left_out: u64,
    bytes_not_read: u64,
}

/// Runs the verb.
pub fn run(json: bool, args: &RedactArgs) -> Result<Outcome, CommandError> {
    output::refuse_overwriting(&[&args.log], &[&args.out])?;
    output::refuse_replacing(&args.out, args.force)?;
    let name = text::path(&args.log);
    let log = std::fs::read(&args.log).map_err(|error| {
        let why =
            expect_file(&args.log).err().map_or_else(|| error.to_string(), |no_file| no_file.to_string());
        CommandError::Input(format!("{name}: {why}"))
    })?;
    let redacted = redact(&log).map_err(|error| CommandError::Input(format!("{name}: {error}")))?;
    output::bytes(&args.out, &redacted.bytes)?;
    let tally = redacted.tally;
    let out = text::path(&args.out);
    if json {
        output::json(&RedactedDocument {
            out,
            bytes: redacted.bytes.len(),
            messages_kept: tally.kept,
            coordinates_moved: tally.moved,
            values_emptied: tally.emptied,
            messages_left_out: tally.left_out,
            bytes_not_read: tally.unread_bytes,
        })?;
    } else {
        output::text(&format!(
            "{out}: {} messages. Moved: {} coordinates. Emptied: {} serial numbers, keys and parameters of places. Left \
             out: {} messages. Read back: nothing of it is left.\n\
             Heights, times, the names of parameters and the flight in metres stay.\n",
            tally.kept, tally.moved, tally.emptied, tally.left_out
        ))?;
        if tally.unread_bytes > 0 {
            output::message(&format!(
                "{} bytes of {name} are no messages and were left out",
                tally.unread_bytes
            ));
        }
    }
    Ok(Outcome::Done)
}
