//! What is in a log and what it is good for.
//!
//! A telemetry log streams through: streams are tallied sample by sample, and what flight segments,
//! excitation and information need is kept in windows of two minutes, each assessed by the identification's own
//! conditioning and weak form, turned into numbers, and let go. Memory does not grow with the log.

mod airborne;
mod assess;
mod clock;
mod evidence;
mod excitation;
mod flown;
mod flown_rates;
mod forecast;
mod inspection;
mod missing_streams;
mod motion;
mod off_mixer;
mod onboard;
mod outlook;
mod parameters;
mod quantities;
mod quantity;
mod reading;
mod streams;
mod tally;
mod timeline;
mod verdict;
mod window;

pub use flown::{FlightSummary, Segment};
pub use inspection::{
    ClockSummary, CsvReading, Excitation, Inspection, ModeChange, OffsetSummary, Outlook, ParameterSummary,
    Reading, SenderSummary, StreamSummary, Text, TextSummary, Timeline, TlogReading, Unflown, VehicleSummary,
};
pub use onboard::{OnboardReading, TopicSummary};
pub use quantity::{ExpectedParameter, QuantitySummary};
pub use tally::{inspect, inspect_recording};
