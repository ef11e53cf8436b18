//! Messages that are no samples.

use super::definition::Definition;

/// What a message means that is no sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Special {
    /// name, value
    Parameter,
    /// text
    Text,
    /// number of an event
    Event,
    /// number or name of a mode
    Mode,
    /// part of the autopilot, code
    Error,
    /// offsets north and east by which the estimate jumped last
    Jump,
    /// degrees north and east, and height, m
    Place,
    /// week of the satellites, and ms of it
    Date,
    /// messages dropped before they were written, so far
    Dropped,
    /// batch, kind of sensor, sensor, multiplier, time of the first sample, rate
    BatchHead,
    /// batch, place in it, three arrays
    BatchData,
}

/// A message that is no sample, and the fields that are read of it by their names: one of each list.
#[derive(Debug)]
pub(super) struct SpecialMessage {
    pub message: &'static str,
    pub meaning: Special,
    fields: &'static [&'static [&'static str]],
}

const fn special(
    message: &'static str,
    meaning: Special,
    fields: &'static [&'static [&'static str]],
) -> SpecialMessage {
    SpecialMessage { message, meaning, fields }
}

pub(super) const SPECIALS: &[SpecialMessage] = &[
    special("PARM", Special::Parameter, &[&["Name"], &["Value"]]),
    special("MSG", Special::Text, &[&["Message"]]),
    special("EV", Special::Event, &[&["Id"]]),
    special("MODE", Special::Mode, &[&["ModeNum", "Mode"]]),
    special("ERR", Special::Error, &[&["Subsys"], &["ECode"]]),
    special("XKF4", Special::Jump, &[&["OFN"], &["OFE"]]),
    special("NKF4", Special::Jump, &[&["OFN"], &["OFE"]]),
    special("POS", Special::Place, &[&["Lat"], &["Lng"], &["RelOriginAlt", "RelHomeAlt", "RelAlt", "Alt"]]),
    special("GPS", Special::Date, &[&["GWk", "Week"], &["GMS", "TimeMS"]]),
    special("DSF", Special::Dropped, &[&["Dp"]]),
    special(
        "ISBH",
        Special::BatchHead,
        &[&["N"], &["type"], &["instance"], &["mul"], &["SampleUS"], &["smp_rate"]],
    ),
    special("ISBD", Special::BatchData, &[&["N"], &["seqno"], &["x"], &["y"], &["z"]]),
];

impl SpecialMessage {
    pub(super) fn fields_in(&self, definition: &Definition) -> Option<Vec<usize>> {
        self.fields.iter().map(|names| names.iter().find_map(|name| definition.field(name))).collect()
    }
}
