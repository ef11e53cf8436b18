//! Ends of pipes that take nothing.

use std::io::{PipeReader, PipeWriter, Write, pipe};

use rustix::fs::{OFlags, fcntl_setfl};

/// A full pipe: who writes to it waits until its reader is gone.
pub fn full_pipe() -> (PipeReader, PipeWriter) {
    let (reader, mut writer) = pipe().unwrap();
    fcntl_setfl(&writer, OFlags::NONBLOCK).unwrap();
    while writer.write(&[0; 4096]).is_ok() {}
    fcntl_setfl(&writer, OFlags::empty()).unwrap();
    (reader, writer)
}
