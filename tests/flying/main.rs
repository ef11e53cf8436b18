//! Flights and the checks before them, without a clock.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test ends where it fails")]

#[path = "../support/flying.rs"]
mod flying;
#[path = "../support/mod.rs"]
mod support;

mod abandoned;
mod flight;
mod flight_view;
mod fly_command;
mod live_identification;
mod preflight;
mod preflight_sitl;
mod vehicles;
