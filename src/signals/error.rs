//! Errors of the conditioning.

use super::Grid;
use crate::recording::Quantity;

/// Errors of the conditioning.
#[derive(Debug, thiserror::Error)]
pub enum SignalsError {
    /// no actuator stream that fits the vehicle
    #[error(
        "no actuator outputs for {rotors} rotors: expected {unit}, as the vehicle file's [propulsion] says; \
         the recording holds {found}"
    )]
    NoActuators {
        /// rotors of the vehicle
        rotors: usize,
        /// what the vehicle file expects
        unit: &'static str,
        /// what the recording has, and what to do
        found: String,
    },
    /// the log is that of a vehicle with another number of rotors
    #[error(
        "expected the log of a vehicle with {rotors} rotors, as the given one has (its file, or --frame), got {came}: give the file of the \
         vehicle that flew (`mavid vehicle init` drafts one from its log), correct its [[rotor]] entries, or leave --frame out"
    )]
    OtherRotors {
        /// rotors of the vehicle
        rotors: usize,
        /// what the recording has
        came: String,
    },
    /// a needed stream has too few samples
    #[error(
        "{message} holds {count} usable sample{} of {}: at least {needed} are needed",
        if *count == 1 { "" } else { "s" },
        quantity.name()
    )]
    TooFewSamples {
        /// which
        quantity: Quantity,
        /// message or column group that it comes from
        message: &'static str,
        /// samples that hold a number for every channel that is used
        count: usize,
        /// needed number of samples
        needed: usize,
    },
    /// no stream of motion
    #[error(
        "no stream of motion: expected body rates, attitude or acceleration; record them (over MAVLink ATTITUDE_QUATERNION and HIGHRES_IMU or RAW_IMU)"
    )]
    NoMotion,
    /// sampled too slowly
    #[error("sampled too slowly to identify from: {slow}. 100 Hz of each is good: {}", faster(logging.as_deref()))]
    TooSlow {
        /// each slow stream, its rate, and the rate that was expected
        slow: String,
        /// what to set for more in the vehicle's own log; `None` of a table, which says nothing of its autopilot
        logging: Option<Box<str>>,
    },
    /// streams do not share a span
    #[error("motion and actuator streams overlap for {overlap_s:.2} s only; at least 1 s is needed")]
    NoOverlap {
        /// s
        overlap_s: f64,
    },
    /// more than one flight
    #[error(
        "motion and actuator streams last {span_s:.0} s or more: expected one flight, of at most {} samples; divide \
         the log into its flights",
        Grid::LONGEST
    )]
    TooLong {
        /// s
        span_s: f64,
    },
    /// by the vehicle file nothing was flown, and the log shows a flight
    #[error(
        "the vehicle file contradicts the log: by the file the rotors give at most {most_n:.3} N in this flight, less than its \
         weight of {weight_n:.3} N, and below {:.0} % of that nothing flies; the log shows a flight. Correct thrust and mass \
         in the vehicle file",
        100.0 * share
    )]
    ThrustTooLow {
        /// largest sum of the rotors' thrusts by the file, N
        most_n: f64,
        /// weight by the file, N
        weight_n: f64,
        /// of the weight: below it a vehicle does not fly
        share: f64,
    },
    /// the time that is left out at the beginning is most of the flight
    #[error(
        "the time that is left out at the beginning (--transient) leaves too little: expected at most {most_s:.1} s, got {asked_s} s \
         ({reason})"
    )]
    LeftOutTooLong {
        /// s that would leave enough, if nothing else is left out
        most_s: f64,
        /// s
        asked_s: f64,
        /// reasons why time was left out
        reason: String,
    },
    /// no stretch of flight is left
    #[error("nothing to identify from: {usable_s:.1} s usable, at least {needed_s:.1} s needed ({reason})")]
    NothingUsable {
        /// s left
        usable_s: f64,
        /// s needed
        needed_s: f64,
        /// reasons why time was left out
        reason: String,
    },
}

/// What to do for more samples.
fn faster(logging: Option<&str>) -> String {
    logging.map_or_else(
        || "if the log is faster than that, its time column is not in the unit that the mapping says".to_owned(),
        |logging| format!("for the log that the vehicle writes, {logging}; on a link, request them, if it carries as much"),
    )
}
