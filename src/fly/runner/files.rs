//! Names of the files of a flight in its folder.

/// Names of the files of a flight in its folder.
pub const TLOG: &str = "flight.tlog";
/// Log of events, JSON lines.
pub const EVENTS: &str = "events.jsonl";
/// The vehicle's parameters.
pub const PARAMETERS: &str = "parameters.toml";
