//! Redacts a log and reads it back.

use super::error::RedactError;
use super::pass::{Counts, Pass, Tally, is_moved};
use super::{dataflash, tlog, ulog};
use crate::text::excerpt;

/// A log without positions, serial numbers and keys.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Redacted {
    /// the log, in the format of the one that was read
    pub bytes: Vec<u8>,
    /// what was done
    pub tally: Tally,
    /// values that were emptied, by field (`sensor_accel.device_id`) or parameter (`CAL_ACC0_ID`)
    pub emptied: Counts,
    /// messages that were left out, by their names in the log
    pub left_out: Counts,
}

type Walk = fn(&[u8], &mut Pass) -> Vec<u8>;

/// Redacts a telemetry log, ULog or DataFlash log, and reads the result back.
///
/// Latitude and longitude are moved: the flight over the ground stays as it was in metres, elsewhere on the Earth. Heights,
/// times and names of parameters stay. Messages that may hold a position, a serial number or a key in another form are left out.
/// Free text keeps plain words and short numbers.
///
/// # Errors
/// [`RedactError`] where it is no such log, or where the redacted log still holds something.
pub fn redact(log: &[u8]) -> Result<Redacted, RedactError> {
    if log.is_empty() {
        return Err(RedactError::Empty);
    }
    let (format, walk): (&'static str, Walk) = if ulog::is_one(log) {
        ("ULog", ulog::walk)
    } else if dataflash::is_one(log) {
        ("DataFlash", dataflash::walk)
    } else if tlog::is_one(log) {
        ("a telemetry log", tlog::walk)
    } else {
        let start: Vec<String> = log.iter().take(8).map(|byte| format!("{byte:02x}")).collect();
        return Err(RedactError::Unknown(excerpt(&start.join(" "), 40)));
    };
    let mut first = Pass::default();
    walk(log, &mut first);
    let mut pass = Pass::from(first.origin_deg);
    let bytes = walk(log, &mut pass);
    if pass.tally.kept == 0 {
        return Err(RedactError::Nothing { format, bytes: log.len() });
    }
    read_back(walk, &bytes, &pass)?;
    Ok(Redacted { bytes, tally: pass.tally, emptied: pass.emptied, left_out: pass.left_out })
}

/// Everything that was to be taken out is out, and everything that was to stay is there.
fn read_back(walk: Walk, bytes: &[u8], done: &Pass) -> Result<(), RedactError> {
    let mut again = Pass::default();
    walk(bytes, &mut again);
    let still = |what: String| Err(RedactError::StillThere { what });
    if again.tally.emptied > 0 {
        let names: Vec<&str> = again.emptied.keys().map(String::as_str).collect();
        return still(names.join(", "));
    }
    if again.tally.left_out > 0 {
        return still(format!("{} messages that were to be left out", again.tally.left_out));
    }
    if again.tally.kept != done.tally.kept {
        return still(format!("{} messages instead of {}", again.tally.kept, done.tally.kept));
    }
    match again.origin_deg {
        Some(origin_deg) if !is_moved(origin_deg) => still("a position that was not moved".to_owned()),
        _ => Ok(()),
    }
}
