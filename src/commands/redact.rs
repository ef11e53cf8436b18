//! `mavid redact LOG --out FILE`: a log to share, without positions, serial numbers and keys.

use mavid::log::expect_file;
use mavid::redact::{Counts, Redacted, redact};
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
    /// values that were emptied, by field or parameter
    emptied: Counts,
    /// messages that were left out, by name
    left_out: Counts,
}

/// Names that are listed; a document in JSON has all of them.
const LISTED: usize = 12;

/// Runs the verb.
pub fn run(json: bool, args: &RedactArgs) -> Result<Outcome, CommandError> {
    output::refuse_overwriting(&[&args.log], &[&args.out])?;
    output::refuse_replacing(&args.out, args.force)?;
    let name = text::path(&args.log);
    if args.log.is_dir() {
        let expected =
            "expected a .tlog, .ulg or .bin recording, got a folder: give one of the recordings in it";
        return Err(CommandError::Input(format!("{name}: {expected}")));
    }
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
            emptied: redacted.emptied,
            left_out: redacted.left_out,
        })?;
    } else {
        output::text(&summary(&out, &redacted))?;
        if tally.unread_bytes > 0 {
            output::message(&format!(
                "{} bytes of {name} are no messages and were left out",
                tally.unread_bytes
            ));
        }
    }
    Ok(Outcome::Done)
}

/// What was done, line by line, by the names that things have in the log.
fn summary(out: &str, redacted: &Redacted) -> String {
    let tally = redacted.tally;
    let mut lines = vec![
        format!("{out}: {}", counted(tally.kept, "message")),
        format!("moved: {} (latitudes and longitudes)", counted(tally.moved, "coordinate")),
    ];
    let fields = counted(redacted.emptied.len() as u64, "field or parameter");
    let of_fields = format!("{} of {fields}", counted(tally.emptied, "value"));
    lines.push(format!("emptied: {of_fields}{}", listed(&redacted.emptied)));
    lines.push(format!("left out: {}{}", counted(tally.left_out, "message"), listed(&redacted.left_out)));
    lines.push("read back: none of these is left. Texts keep plain words and short numbers: read them before you share the log".to_owned());
    lines.push("heights, times, the names of parameters and the flight in metres stay".to_owned());
    lines.join("\n")
}

/// `1 message`, `2 messages`, `2 fields or parameters`.
fn counted(count: u64, what: &str) -> String {
    match count {
        1 => format!("1 {what}"),
        _ => format!("{count} {}s", what.replace(" or ", "s or ")),
    }
}

/// The names with their counts, the most frequent first; nothing where there is none.
fn listed(counts: &Counts) -> String {
    let mut all: Vec<(&String, &u64)> = counts.iter().collect();
    // stable: equal counts keep the order of the names
    all.sort_by(|one, other| other.1.cmp(one.1));
    let rest = all.len().saturating_sub(LISTED);
    let mut named: Vec<String> =
        all.iter().take(LISTED).map(|(name, count)| format!("{} ({count})", text::clean(name))).collect();
    if rest > 0 {
        named.push(format!("{rest} more (all of them are in --json)"));
    }
    if named.is_empty() { String::new() } else { format!(": {}", named.join(", ")) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mavid::redact::Tally;

    #[test]
    fn what_was_emptied_is_counted_by_its_name_and_said_to_be_values_of_fields() {
        let emptied: Counts =
            [("sensor_accel.device_id", 74_000), ("CAL_ACC0_ID", 1), ("sensor_gyro.device_id", 216)]
                .map(|(name, count)| (name.to_owned(), count))
                .into();
        let redacted = Redacted {
            bytes: Vec::new(),
            tally: Tally { kept: 1, moved: 2, emptied: 74_217, left_out: 0, unread_bytes: 0 },
            emptied,
            left_out: Counts::new(),
        };
        let said = summary("b.ulg", &redacted);
        let lines: Vec<&str> = said.lines().collect();
        assert_eq!(lines[0], "b.ulg: 1 message");
        assert_eq!(
            lines[2],
            "emptied: 74217 values of 3 fields or parameters: sensor_accel.device_id (74000), sensor_gyro.device_id (216), \
             CAL_ACC0_ID (1)"
        );
        assert_eq!(lines[3], "left out: 0 messages");
        let many: Counts = (0..20).map(|number| (format!("P{number:02}"), 1)).collect();
        assert!(
            listed(&many).ends_with(", P11 (1), 8 more (all of them are in --json)"),
            "{}",
            listed(&many)
        );
    }
}
