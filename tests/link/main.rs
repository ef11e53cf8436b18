//! Links: connections, signing, recording, replay, what is sent.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test ends where it fails")]

#[path = "../support/lossy.rs"]
mod lossy;
#[path = "../support/python.rs"]
mod python;
#[path = "../support/mod.rs"]
mod support;

mod connections;
mod fuzz_twins;
mod link_lossy;
mod link_recording;
mod link_replay;
#[cfg(unix)]
mod link_serial;
mod link_signing;
mod outgoing;
mod record_command;
