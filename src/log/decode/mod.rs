//! Typed messages become SI samples in this crate's frames, here and nowhere else.
//!
//! Fields are read straight from the payload by their offset on the wire (largest types first, as MAVLink
//! orders them), so that a value which the dialect's enumerations do not know loses nothing.

mod actuators;
mod imu;
mod motion;
mod setpoints;
mod source;
mod status;
mod text;

pub use source::{Source, StreamId};

use super::clock::{Anchor, Placed, VehicleClock};
use super::frame::{ComponentId, Payload, SystemId};
use super::recording::{Autopilot, Quantity};
use super::tlog::Record;
use text::Texts;

/// Messages that tell a simulator's truth: SIMSTATE, SIM_STATE, HIL_*.
const TRUTH_IDS: [u32; 10] = [90, 91, 92, 93, 107, 108, 113, 114, 115, 164];
/// MAV_AUTOPILOT_INVALID and MAV_TYPE_GCS: a HEARTBEAT with either is not a vehicle's.
const AUTOPILOT_INVALID: u8 = 8;
const TYPE_GCS: u8 = 6;

/// The vehicle whose messages are decoded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Vehicle {
    /// its system
    pub system: SystemId,
    /// its autopilot's component; other components of the system are not listened to
    pub component: ComponentId,
    /// which software
    pub autopilot: Autopilot,
}

impl Vehicle {
    /// The vehicle that a frame's HEARTBEAT is of; `None` for other messages and for ground stations.
    #[must_use]
    pub fn from_heartbeat(record: &Record<'_>) -> Option<Self> {
        let header = record.frame.header();
        if header.message_id != Source::Heartbeat.message_id() {
            return None;
        }
        let payload = record.frame.payload();
        let (kind, autopilot) = (payload.u8(4), payload.u8(5));
        (autopilot != AUTOPILOT_INVALID && kind != TYPE_GCS).then_some(Self {
            system: header.system,
            component: header.component,
            autopilot: match autopilot {
                3 => Autopilot::ArduPilot,
                12 => Autopilot::Px4,
                _ => Autopilot::Other,
            },
        })
    }
}

/// What the decoder gives out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Event<'a> {
    /// one sample of a stream, in the order of the log
    Sample {
        /// which stream
        stream: StreamId,
        /// s of the vehicle's clock since the recording's start
        time_s: f64,
        /// SI, body FLU or world NWU; actuator channels at the end that are zero may be left out
        values: &'a [f64],
    },
    /// one of the vehicle's parameters
    Parameter {
        /// name
        name: &'a str,
        /// value in the autopilot's own unit
        value: f64,
    },
    /// what the vehicle said
    Text {
        /// s
        time_s: f64,
        /// MAV_SEVERITY: 0 emergency, 3 error, 4 warning, 6 information, 7 debugging
        severity: u8,
        /// whole text, put together from its chunks
        text: &'a str,
    },
    /// the vehicle's clock started anew
    ClockReset {
        /// s
        time_s: f64,
        /// s, the first stamp of the new clock: after a start anew the time since then
        stamp_s: f64,
    },
    /// the position estimate jumped (ODOMETRY.reset_counter)
    EstimatorReset {
        /// s
        time_s: f64,
    },
}

/// Why samples were left out.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct DecodeReport {
    /// messages of the vehicle that were decoded
    pub decoded: u64,
    /// messages whose stamp fits neither the clock nor a new one
    pub stale_stamps: u64,
    /// times that the recording computer's clock was set while the vehicle's went on
    pub host_steps: u64,
    /// messages of a simulator's truth and parameters SIM_*, SIH_*: never read
    pub withheld_truth: u64,
    /// messages in a frame or unit that cannot be used, by message
    pub unusable: Vec<(Source, u64)>,
    /// messages with no finite value in them, by message
    pub empty: Vec<(Source, u64)>,
}

impl DecodeReport {
    fn count(list: &mut Vec<(Source, u64)>, source: Source) {
        match list.iter_mut().find(|(listed, _)| *listed == source) {
            Some((_, count)) => *count += 1,
            None => list.push((source, 1)),
        }
    }
}

/// Decodes one vehicle's messages.
#[derive(Debug)]
pub struct Decoder {
    vehicle: Vehicle,
    clock: VehicleClock,
    texts: Texts,
    last_reset_counter: Option<u8>,
    report: DecodeReport,
}

/// Where a message's samples go.
struct Samples<'a> {
    source: Source,
    time_s: f64,
    vehicle: Vehicle,
    sink: &'a mut dyn FnMut(Event<'_>),
    report: &'a mut DecodeReport,
    given: bool,
}

impl Samples<'_> {
    /// Gives a sample out unless no value in it is finite.
    fn give(&mut self, quantity: Quantity, instance: u8, values: &[f64]) {
        if values.iter().any(|value| value.is_finite()) {
            self.given = true;
            let stream = StreamId { quantity, source: self.source, instance };
            (self.sink)(Event::Sample { stream, time_s: self.time_s, values });
        }
    }

    /// The message cannot be used as it is.
    fn unusable(&mut self) {
        self.given = true;
        DecodeReport::count(&mut self.report.unusable, self.source);
    }
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
