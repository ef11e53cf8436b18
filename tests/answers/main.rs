//! Identification, explanation and comparison: library and commands.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test ends where it fails")]

#[path = "../support/concealed.rs"]
mod concealed;
#[path = "../support/ordinary.rs"]
mod ordinary;
#[cfg(target_os = "linux")]
#[path = "../support/pty.rs"]
mod pty;
#[path = "../support/mod.rs"]
mod support;

mod blind_flights;
mod compare;
mod compare_scale;
mod every_effect;
mod explain_at_bounds;
mod explain_command;
mod explain_names;
#[cfg(target_os = "linux")]
mod explain_terminal;
mod feedback;
mod first_lines;
mod fleet;
mod hold_out_and_next_flight;
mod identify;
mod identify_with;
mod other_rotor;
mod paper_twin;
mod prove_command;
mod reconstruction;
mod validate_command;
mod velocity_error;
mod weighed_vehicle;
mod wrong_rotors;
