//! Trajectories, simulation and exports.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test ends where it fails")]

#[path = "../support/python.rs"]
mod python;
#[path = "../support/rotorpy.rs"]
mod rotorpy;
#[path = "../support/mod.rs"]
mod support;

mod export;
mod export_aircraft;
mod export_flown;
mod plan;
mod plan_command;
mod plan_prediction;
mod simulate_command;
mod simulation_peers;
