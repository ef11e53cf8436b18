//! Before the flight: parameters are downloaded, message rates asked for and measured, and all of it checked.

use std::time::Duration;

use super::question::{Answer, FenceAndHome, Question};

use mavlink::dialects::ardupilotmega::MavMessage;

use crate::fly::finding::{Finding, Level};
use crate::fly::flight::Flight;
use crate::fly::parameters::{Download, DownloadSettings, Parameters, requested_parameters};
use crate::fly::preflight::{Fence, FenceDownload, FenceOutcome, Judged, Page};
use crate::fly::requests::{
    Capacity, LinkKind, Need, RequestSettings, Requests, request_set, slow_request_set,
};
use crate::fly::safety::Feeding;
use crate::frames::{Geodetic, world_from_ned};
use crate::vehicle::Vehicle;
use crate::wire::message_id::{GPS_GLOBAL_ORIGIN, HOME_POSITION};
use crate::wire::{self, Decoder, Frame, Payload, Record};
use nalgebra::Vector3;

/// Subjects that the flight itself waits for before it arms: no refusal here.
const AWAITED: [&str; 4] = ["estimate", "pre-arm", "home", "health"];

/// Result of the checks.
#[derive(Debug)]
pub(super) struct Cleared {
    /// the decoder of the frames so far
    pub(super) decoder: Option<Decoder>,
    pub(super) parameters: Parameters,
    pub(super) findings: Vec<Finding>,
    pub(super) feeding: Feeding,
    pub(super) page: Page,
    pub(super) lines: Vec<String>,
}

impl Cleared {
    /// Whether the flight may continue, or the reason why not.
    pub(super) fn verdict(&self) -> Result<(), String> {
        let refusals: Vec<String> = self
            .findings
            .iter()
            .filter(|finding| finding.level == Level::Refusal)
            .map(|finding| {
                let Finding { subject, expected, came, remedy, .. } = finding;
                format!("{subject}: expected {expected}, got {came} ({remedy})")
            })
            .collect();
        if refusals.is_empty() { Ok(()) } else { Err(refusals.join("; ")) }
    }
}

#[derive(Debug)]
enum Stage {
    Parameters(Box<Download>),
    Rates(Box<Parameters>, Box<Requests>),
    /// all is known, and judged
    Judged(Box<Requests>),
    Over,
}

/// The stages of the checks. Parameters are first, because ArduPilot slows its messages while they are sent.
#[derive(Debug)]
pub(super) struct Clearance {
    vehicle: wire::Vehicle,
    link: LinkKind,
    /// from the first frame on
    decoder: Option<Decoder>,
    stage: Stage,
    fence: FenceDownload,
    /// origin of the local frame, by GPS_GLOBAL_ORIGIN
    origin: Option<Geodetic>,
    /// home, by HOME_POSITION: m, world, local
    home_m: Option<Vector3<f64>>,
    /// since when only its position is awaited
    waits: Option<Duration>,
    counted_again: bool,
}

impl Clearance {
    pub(super) fn new(vehicle: wire::Vehicle, rotors: usize, link: LinkKind) -> Self {
        let download = Download::new(
            vehicle,
            requested_parameters(vehicle.autopilot, rotors),
            DownloadSettings::default(),
        );
        let (stage, fence) = (Stage::Parameters(Box::new(download)), FenceDownload::new(vehicle));
        Self {
            vehicle,
            link,
            decoder: None,
            stage,
            fence,
            origin: None,
            home_m: None,
            waits: None,
            counted_again: false,
        }
    }

    /// Takes a frame of any system.
    pub(super) fn take(&mut self, record: &Record<'_>) {
        if matches!(self.stage, Stage::Over) {
            return;
        }
        let Self { vehicle, decoder, stage, .. } = self;
        let decoder = decoder.get_or_insert_with(|| Decoder::new(*vehicle, None, record.stamp_us));
        decoder.decode(record, &mut |event| {
            if let Stage::Parameters(download) = stage {
                download.take(&event);
            }
        });
        if record.known {
            self.take_frame(&record.frame);
        }
    }

    fn take_frame(&mut self, frame: &Frame<'_>) {
        let header = frame.header();
        if header.system == self.vehicle.system && header.message_id == GPS_GLOBAL_ORIGIN {
            self.origin = Some(geodetic(frame.payload()));
        }
        if header.system == self.vehicle.system && header.message_id == HOME_POSITION {
            self.home_m = Some(world_from_ned(frame.payload().f32s(12)).0);
        }
        self.fence.take_frame(frame);
        match &mut self.stage {
            Stage::Parameters(download) => download.take_frame(frame),
            Stage::Rates(_, requests) => requests.take_frame(frame),
            Stage::Judged(_) | Stage::Over => {}
        }
    }

    /// The next message to be sent.
    pub(super) fn poll(&mut self, now: Duration) -> Option<MavMessage> {
        let message = match &mut self.stage {
            Stage::Parameters(download) => download.poll(now),
            Stage::Rates(_, requests) => requests.poll(now),
            Stage::Judged(_) | Stage::Over => None,
        };
        let message = message.or_else(|| self.fence.poll(now));
        if message.is_none()
            && self.fence.outcome().is_some()
            && let Stage::Parameters(download) = &self.stage
            && download.is_done(now)
            && let Stage::Parameters(download) = std::mem::replace(&mut self.stage, Stage::Over)
        {
            let capacity = Capacity::new(self.link, self.vehicle.autopilot);
            let whole = request_set(self.vehicle.autopilot);
            let set = if capacity.fits(&whole) { whole } else { slow_request_set(self.vehicle.autopilot) };
            let requests = Requests::new(self.vehicle, set, capacity, RequestSettings::default());
            self.stage = Stage::Rates(Box::new(download.finish()), Box::new(requests));
        }
        message
    }

    /// Whether all else is done and the vehicle reports no position yet.
    pub(super) fn waits_for_position(&self) -> bool {
        self.waits.is_some() && !self.counted_again && matches!(self.stage, Stage::Rates(..))
    }

    /// What is to be judged, once, after the end.
    pub(super) fn question(&mut self, flight: &Flight, vehicle: &Vehicle, now: Duration) -> Option<Question> {
        let Stage::Rates(_, requests) = &mut self.stage else { return None };
        if !requests.is_done() {
            return None;
        }
        // ArduPilot has no position to tell for some 40 s after its boot
        let since = *self.waits.get_or_insert(now);
        if flight.status(now).position_m.is_some() {
            let known = self.home_m.is_some() && requests.report().serves(Need::Position);
            if !known && !std::mem::replace(&mut self.counted_again, true) {
                requests.measure_again(now);
                return None;
            }
        } else if now.saturating_sub(since) < flight.sortie().settings.ready_timeout {
            return None;
        }
        let Stage::Rates(parameters, requests) = std::mem::replace(&mut self.stage, Stage::Over) else {
            return None;
        };
        self.stage = Stage::Judged(requests);
        let mut fence = Fence::new(&parameters, self.fence.items(), self.origin.as_ref());
        if let Some(FenceOutcome::Incomplete { came, of }) = self.fence.outcome() {
            let of = of.map_or("an unknown number of".to_owned(), |of| of.to_string());
            fence.unknown.push(format!("{came} of {of} items came"));
        }
        Some(Question::of(flight, vehicle, now, (parameters, FenceAndHome { fence, home_m: self.home_m })))
    }

    /// The result, once, with what the checks came to.
    pub(super) fn finish(&mut self, flight: &Flight, answer: Answer) -> Option<Cleared> {
        let Stage::Judged(requests) = std::mem::replace(&mut self.stage, Stage::Over) else { return None };
        let report = requests.report();
        let Answer { judged: Judged { mut findings, feeding, mut page }, parameters } = answer;
        for finding in &mut findings {
            if finding.level == Level::Refusal && AWAITED.contains(&finding.subject) {
                finding.level = Level::Awaited;
            }
        }
        findings.extend(report.findings());
        findings.push(report.identification());
        let accepted = &flight.sortie().settings.accepted;
        for finding in &mut findings {
            if finding.level == Level::Refusal
                && accepted.iter().any(|check| check.subject() == finding.subject)
            {
                finding.level = Level::Warning;
            }
        }
        page.warn_of(&findings);
        let lines = report.streams.iter().map(|stream| stream.line()).collect();
        Some(Cleared {
            decoder: self.decoder.take(),
            parameters: *parameters,
            findings,
            feeding,
            page,
            lines,
        })
    }
}

fn geodetic(origin: Payload<'_>) -> Geodetic {
    let degrees = |offset: usize| 1e-7 * f64::from(origin.i32(offset));
    Geodetic { latitude_deg: degrees(0), longitude_deg: degrees(4) }
}
