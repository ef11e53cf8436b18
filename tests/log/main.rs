//! Logs of all formats: read, decoded, inspected, and refused where they are none.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test ends where it fails")]

#[path = "../support/flight_log.rs"]
mod flight_log;
#[path = "../support/python.rs"]
mod python;
#[path = "../support/mod.rs"]
mod support;

mod both_logs;
mod csv_recordings;
mod damaged_logs;
mod doubtful_logs;
mod field_peers;
mod foreign_logs;
mod foreign_text;
mod inspect;
mod inspect_quantities;
mod log_dataflash;
mod log_dataflash_made;
mod log_decode;
mod log_flights;
mod log_lines;
mod log_load;
mod log_open;
mod log_shared;
mod log_splitter;
mod log_tlog;
mod log_ulog;
mod redact;
mod slow_logs;
mod vehicle_init;
mod wrong_sign;
