//! What an earlier try left in the folder of a flight: where nothing was heard, the same command begins again.

use std::fs::File;
use std::path::Path;

use mavid::fly::TLOG;
use mavid::log::TlogReader;
use mavid::text;
use mavid::wire::{STAMP_BYTES, SystemId};

use super::{CommandError, output};

/// The system id of this station.
pub const STATION: SystemId = SystemId(255);
/// A recording with more bytes than this is not looked through: somebody was there.
const LOOK_BYTES: u64 = 1 << 20;

/// Makes the folder, and takes a recording away in which there is nothing but what the station itself said to nobody.
///
/// A recording that holds anything else is never touched: the folder is refused.
pub fn make_way(folder: &Path, station: SystemId) -> Result<(), CommandError> {
    let tlog = folder.join(TLOG);
    if tlog.exists() {
        if !nothing_heard(&tlog, station).unwrap_or(false) {
            return Err(CommandError::Input(format!(
                "--out: expected a new folder, or one in which no vehicle was heard yet; {} exists already and holds a \
                 recording",
                text::path(&tlog)
            )));
        }
        std::fs::remove_file(&tlog).map_err(|error| {
            CommandError::Input(format!("cannot begin again with {}: {error}", text::path(&tlog)))
        })?;
    }
    output::silent_folder(folder)
}

/// Whether a flight can be recorded into this folder: it holds no recording of a vehicle.
pub fn is_free(folder: &Path, station: SystemId) -> bool {
    let tlog = folder.join(TLOG);
    !tlog.exists() || nothing_heard(&tlog, station).unwrap_or(false)
}

/// Whether every byte of a recording is of the station's own frames.
fn nothing_heard(tlog: &Path, station: SystemId) -> Option<bool> {
    let file = File::open(tlog).ok()?;
    // another that records into it holds it
    file.try_lock_shared().ok()?;
    let found = file.metadata().ok()?;
    if !found.is_file() || found.len() > LOOK_BYTES {
        return Some(false);
    }
    if found.len() == 0 {
        return Some(true);
    }
    let mut reader = TlogReader::new(file);
    let mut own_bytes = 0;
    while let Some(record) = reader.next_record().ok()? {
        if record.frame.header().system != station {
            return Some(false);
        }
        own_bytes += record.frame.bytes().len() + STAMP_BYTES;
    }
    // a frame of which the disk took only a part may be anybody's
    Some(own_bytes as u64 == found.len())
}
