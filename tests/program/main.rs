//! The program and its documents.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test ends where it fails")]

#[path = "../support/python.rs"]
mod python;
#[path = "../support/require.rs"]
mod require;

mod command_line;
mod documents;
mod examples;
mod flight_review;
mod knowledge;
mod licences;
mod python_module;
mod requirements;
mod screen;
