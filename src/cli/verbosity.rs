//! How much the program writes to standard error.

use clap::{ArgAction, Args};

/// What standard error shows.
#[derive(Debug, Clone, Copy, Args)]
pub struct Verbosity {
    /// Write log lines to standard error: -v info, -vv debug, -vvv trace; RUST_LOG sets levels for single targets
    #[arg(short, long, global = true, action = ArgAction::Count)]
    pub verbose: u8,
    /// Show only errors on standard error, and no progress bars
    #[arg(short, long, global = true)]
    pub quiet: bool,
}
