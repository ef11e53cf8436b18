//! Tests that wait for the real clock, in one program: they wait side by side.

#![cfg(target_os = "linux")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test ends where it fails")]

#[path = "../support/lossy.rs"]
mod lossy;
#[path = "../support/processes.rs"]
mod processes;
#[path = "../support/pty.rs"]
mod pty;
#[path = "../support/python.rs"]
mod python;
#[path = "../support/stuck.rs"]
mod stuck;
#[path = "../support/mod.rs"]
mod support;

mod demo;
mod fetch_interrupted;
mod log_commands;
mod loopback;
mod peers;
mod sitl_peers;
mod stuck_output;
mod terminal;
