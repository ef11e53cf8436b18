//! What a recording is written to.

use std::fs::File;
use std::io::{self, Write};

/// What a recording is written to.
pub trait Store: Write + Send {
    /// Brings what was written to where a power loss does not reach it.
    ///
    /// # Errors
    /// What the system says.
    fn sync(&mut self) -> io::Result<()>;
}

impl Store for File {
    fn sync(&mut self) -> io::Result<()> {
        match self.sync_data() {
            // a device or a pipe: nothing of it is kept back
            Err(error) if error.kind() == io::ErrorKind::InvalidInput => Ok(()),
            synced => synced,
        }
    }
}
