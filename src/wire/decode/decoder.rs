//! Decodes one vehicle's messages.

use super::report::DecodeReport;
use super::samples::Samples;
use super::source::Source;
use super::text::Texts;
use super::vehicle::Vehicle;
use super::{motion, setpoints, status};
use crate::recording::Event;
use crate::wire::clock::{Anchor, Placed, VehicleClock};
use crate::wire::frame::Payload;
use crate::wire::stamped::Record;

/// Messages that tell a simulator's truth: SIMSTATE, SIM_STATE, HIL_*.
const TRUTH_IDS: [u32; 10] = [90, 91, 92, 93, 107, 108, 113, 114, 115, 164];

/// Decodes one vehicle's messages.
#[derive(Debug)]
pub struct Decoder {
    vehicle: Vehicle,
    clock: VehicleClock,
    texts: Texts,
    last_reset_counter: Option<u8>,
    report: DecodeReport,
}

impl Decoder {
    /// A decoder for a vehicle whose clock is zero at the anchor, or where there is none at
    /// `start_host_us` of the host's clock.
    #[must_use]
    pub fn new(vehicle: Vehicle, anchor: Option<Anchor>, start_host_us: u64) -> Self {
        Self {
            vehicle,
            clock: VehicleClock::new(anchor, host_us(start_host_us)),
            texts: Texts::default(),
            last_reset_counter: None,
            report: DecodeReport::default(),
        }
    }

    /// Whose messages are decoded.
    #[must_use]
    pub fn vehicle(&self) -> &Vehicle {
        &self.vehicle
    }

    /// Why samples were left out.
    #[must_use]
    pub fn report(&self) -> &DecodeReport {
        &self.report
    }

    /// Gives what one frame holds to `sink`. Frames of others give nothing, but setpoints sent to this
    /// vehicle do, under their own source.
    pub fn decode(&mut self, record: &Record<'_>, sink: &mut impl FnMut(Event<'_>)) {
        if !record.known {
            return;
        }
        let header = record.frame.header();
        let Some(source) = Source::from_message_id(header.message_id) else {
            self.report.withheld_truth += u64::from(TRUTH_IDS.contains(&header.message_id));
            return;
        };
        let payload = record.frame.payload();
        let own = header.system == self.vehicle.system && header.component == self.vehicle.component;
        let wanted = match source {
            Source::SetPositionTargetLocalNed | Source::SetAttitudeTarget => {
                !own && setpoints::is_for(source, payload, self.vehicle.system)
            }
            _ => own,
        };
        if wanted {
            self.decode_wanted(source, payload, host_us(record.stamp_us), sink);
        }
    }

    /// Gives out what waited for its continuation: the last text.
    pub fn finish(&mut self, sink: &mut impl FnMut(Event<'_>)) {
        self.texts.finish(sink);
    }

    fn decode_wanted(
        &mut self,
        source: Source,
        payload: Payload<'_>,
        host_us: i64,
        sink: &mut impl FnMut(Event<'_>),
    ) {
        self.report.decoded += 1;
        let stamp = source.stamp(payload);
        let placed = self.clock.place(stamp, host_us);
        self.report.host_steps = self.clock.host_steps();
        self.report.ran_back = self.clock.ran_back();
        let time_us = match placed {
            Placed::At(time_us) => time_us,
            Placed::Restarted(time_us) => {
                self.last_reset_counter = None;
                sink(Event::ClockReset { time_s: seconds(time_us), stamp_s: stamp.seconds() });
                time_us
            }
            Placed::Stale => {
                self.report.stale_stamps += 1;
                return;
            }
        };
        let time_s = seconds(time_us);
        match source {
            Source::SystemTime => self.clock.note_pair(payload.u64(0), payload.u32(8)),
            Source::Statustext => self.texts.take(payload, time_s, sink),
            Source::ParamValue => self.parameter(payload, sink),
            _ => self.samples(source, payload, time_s, sink),
        }
    }

    fn samples(
        &mut self,
        source: Source,
        payload: Payload<'_>,
        time_s: f64,
        sink: &mut impl FnMut(Event<'_>),
    ) {
        if source == Source::Odometry && self.estimator_was_reset(payload) {
            sink(Event::EstimatorReset { time_s });
        }
        let mut samples =
            Samples { source, time_s, vehicle: self.vehicle, sink, report: &mut self.report, given: false };
        source.decode(payload, &mut samples);
        if !samples.given {
            DecodeReport::count(&mut self.report.empty, source);
        }
    }

    fn estimator_was_reset(&mut self, payload: Payload<'_>) -> bool {
        let counter = motion::odometry_reset_counter(payload);
        self.last_reset_counter.replace(counter).is_some_and(|last| last != counter)
    }

    fn parameter(&mut self, payload: Payload<'_>, sink: &mut impl FnMut(Event<'_>)) {
        let name = status::parameter_name(payload);
        if name.starts_with("SIM_") || name.starts_with("SIH_") {
            self.report.withheld_truth += 1;
            return;
        }
        sink(Event::Parameter {
            name: &name,
            value: status::parameter_value(payload, self.vehicle.autopilot),
        });
    }
}

/// Host stamps as signed microseconds; one beyond the year 290 000 is as good as the end of time.
fn host_us(stamp_us: u64) -> i64 {
    i64::try_from(stamp_us).unwrap_or(i64::MAX)
}

fn seconds(time_us: i64) -> f64 {
    crate::units::seconds_from_us(time_us as f64)
}
