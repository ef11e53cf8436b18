//! Standard error: messages, progress bars and log lines. No line is written into another or into a progress bar.
//!
//! Messages are tracing events with a target of their own. A layer writes each message before the call returns. Log lines
//! are all other events that `-v` or `RUST_LOG` selects. Verbs that talk to vehicles give log lines to a thread, so that a
//! flight never waits for standard error.

mod color;
mod filter;
mod handle;
mod layers;
mod lines;
mod target;
mod teller;

pub use color::help_has_colors;
pub use handle::StandardError;
pub use layers::install;
pub use target::MESSAGE;
