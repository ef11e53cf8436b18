//! Where a message's samples go.

use super::report::DecodeReport;
use super::source::Source;
use super::vehicle::Vehicle;
use crate::recording::{Event, Quantity, StreamKey};

/// Where a message's samples go.
pub(super) struct Samples<'a> {
    pub source: Source,
    pub time_s: f64,
    pub vehicle: Vehicle,
    pub sink: &'a mut dyn FnMut(Event<'_>),
    pub report: &'a mut DecodeReport,
    pub given: bool,
}

impl Samples<'_> {
    /// Gives a sample out unless no value in it is finite.
    pub fn give(&mut self, quantity: Quantity, instance: u8, values: &[f64]) {
        if values.iter().any(|value| value.is_finite()) {
            self.given = true;
            let stream = StreamKey { quantity, source: self.source.name(), instance };
            (self.sink)(Event::Sample { stream, time_s: self.time_s, values });
        }
    }

    /// The message is whole, and says that nothing was measured.
    pub fn nothing_told(&mut self) {
        self.given = true;
    }

    /// The message cannot be used as it is.
    pub fn unusable(&mut self) {
        self.given = true;
        DecodeReport::count(&mut self.report.unusable, self.source);
    }
}
