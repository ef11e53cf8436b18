//! Parameters and message rates from the embedded vehicle, as PX4 and as ArduPilot of both names, over good and bad
//! links; all on a virtual clock.

use mavid::config::load_vehicle;
use mavid::fence::FenceItem;
use mavid::fly::finding::{Level, worst};
use mavid::fly::parameters::{
    Download, DownloadSettings, Parameters, failsafe_declaration, requested_parameters,
};
use mavid::fly::preflight::{Fence, FenceDownload, FenceOutcome};
use mavid::fly::requests::{Capacity, LinkKind, Need, RatesReport, RequestSettings, Requests, request_set};
use mavid::frames::Geodetic;
use mavid::recording::Event;
use mavid::sitl::{self, Firmware, LinkId, LinkRole, Settings};
use mavid::wire::{ComponentId, Decoder, Frame, Record, SystemId, Vehicle};
use mavlink::dialects::ardupilotmega::MavMessage;
use mavlink::{MAVLinkV2MessageRaw, MavHeader};
use std::path::Path;
use std::time::Duration;

/// The embedded vehicle at the end of a link.
struct Peer {
    vehicle: sitl::Vehicle,
    link: LinkId,
    decoder: Decoder,
    now: Duration,
    sequence: u8,
    /// share of the messages from here that get lost
    loss: f64,
    seed: u32,
}

impl Peer {
    fn new(kind: Firmware, loss: f64, latency_ms: u64) -> Self {
        Self::with_fence(kind, loss, latency_ms, Vec::new())
    }

    fn with_fence(kind: Firmware, loss: f64, latency_ms: u64, fence: Vec<FenceItem>) -> Self {
        let description =
            load_vehicle(&Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/x500.toml")).unwrap();
        let settings = Settings {
            loss,
            fence,
            latency: Duration::from_millis(latency_ms),
            ..Settings::new(description, kind)
        };
        let mut vehicle = sitl::Vehicle::new(settings).unwrap();
        let link = vehicle.open_link(LinkRole::GroundStation);
        let decoder = Decoder::new(Self::identity(kind), None, 0);
        Self { vehicle, link, decoder, now: Duration::ZERO, sequence: 0, loss, seed: 11 }
    }

    fn identity(kind: Firmware) -> Vehicle {
        let autopilot = kind.autopilot();
        Vehicle { system: SystemId(1), component: ComponentId(1), autopilot, kind: None }
    }

    fn send(&mut self, message: &MavMessage) {
        // a hash in place of chance
        self.seed = self.seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        if f64::from(self.seed >> 8) / f64::from(1_u32 << 24) < self.loss {
            return;
        }
        let mut raw = MAVLinkV2MessageRaw::new();
        let header = MavHeader { system_id: 255, component_id: 190, sequence: self.sequence };
        raw.serialize_message(header, message);
        self.sequence = self.sequence.wrapping_add(1);
        self.vehicle.receive(self.link, raw.raw_bytes(), self.now);
    }

    /// Lets 5 ms pass; gives each frame and what the decoder makes of it.
    fn step(&mut self, mut frame: impl FnMut(&Frame<'_>), mut event: impl FnMut(&Event<'_>)) {
        self.now += Duration::from_millis(5);
        for out in self.vehicle.advance(self.now) {
            let arrived = Frame::at_start(&out.bytes).unwrap();
            frame(&arrived);
            let record = Record { stamp_us: 1, frame: arrived, known: true, offset: 0 };
            self.decoder.decode(&record, &mut |decoded| event(&decoded));
        }
        assert!(self.now < Duration::from_secs(180), "it never ends");
    }
}

fn downloaded(peer: &mut Peer, kind: Firmware) -> Parameters {
    let vehicle = Peer::identity(kind);
    let mut download =
        Download::new(vehicle, requested_parameters(vehicle.autopilot, 4), DownloadSettings::default());
    while !download.is_done(peer.now) {
        while let Some(message) = download.poll(peer.now) {
            peer.send(&message);
        }
        let cell = std::cell::RefCell::new(&mut download);
        peer.step(|frame| cell.borrow_mut().take_frame(frame), |event| cell.borrow_mut().take(event));
    }
    download.finish()
}

fn measured(peer: &mut Peer, kind: Firmware) -> RatesReport {
    let vehicle = Peer::identity(kind);
    let capacity = Capacity::new(LinkKind::Wide, vehicle.autopilot);
    let set = request_set(vehicle.autopilot);
    let mut requests = Requests::new(vehicle, set, capacity, RequestSettings::default());
    while !requests.is_done() {
        while let Some(message) = requests.poll(peer.now) {
            peer.send(&message);
        }
        peer.step(|frame| requests.take_frame(frame), |_| {});
    }
    requests.report()
}

const KINDS: [Firmware; 3] = [Firmware::PX4, Firmware::ARDUPILOT_4_6, Firmware::ARDUPILOT_4_7];

#[test]
fn every_kind_gives_what_a_flight_needs() {
    for kind in KINDS {
        let parameters = downloaded(&mut Peer::new(kind, 0.0, 20), kind);
        let needed: &[&str] = match kind {
            Firmware::PX4 => &["COM_OF_LOSS_T", "COM_OBL_RC_ACT", "THR_MDL_FAC", "PWM_MAIN_MIN1"],
            _ => &[
                "MOT_THST_EXPO",
                "MOT_PWM_MIN",
                "MOT_SPIN_MIN",
                "SERVO1_FUNCTION",
                "GUID_TIMEOUT",
                "FS_GCS_ENABLE",
                "WPNAV_ACCEL",
                "ANGLE_MAX",
                "SYSID_MYGCS",
            ],
        };
        for name in needed {
            assert!(parameters.get(name).is_some(), "{kind:?}: no {name}; has {:?}", parameters.values);
        }
        let said = failsafe_declaration(&parameters, 255);
        let stop = said.iter().find(|sentence| sentence.about == "setpoints stop").unwrap();
        assert!(!stop.text.contains("unknown"), "{}", stop.text);
    }
}

#[test]
fn old_and_new_names_mean_the_same() {
    let of = |kind| downloaded(&mut Peer::new(kind, 0.0, 20), kind);
    let (old, new) = (of(Firmware::ARDUPILOT_4_6), of(Firmware::ARDUPILOT_4_7));
    for name in ["WPNAV_ACCEL", "WPNAV_SPEED", "ANGLE_MAX", "SYSID_MYGCS"] {
        let (old, new) = (old.get(name).unwrap(), new.get(name).unwrap());
        assert!((old - new).abs() < 1e-3 * old.abs(), "{name}: {old} and {new}");
    }
    assert!(old.values.contains_key("WPNAV_ACCEL") && new.values.contains_key("WP_ACC"));
}

#[test]
fn a_lossy_link_loses_no_parameter() {
    for kind in KINDS {
        let clean = downloaded(&mut Peer::new(kind, 0.0, 20), kind);
        let lossy = downloaded(&mut Peer::new(kind, 0.2, 200), kind);
        assert_eq!(clean.values, lossy.values, "{kind:?}");
    }
}

#[test]
fn every_kind_sends_what_identification_needs() {
    for kind in KINDS {
        // until ArduPilot has a position estimate it sends none
        let mut peer = Peer::new(kind, 0.0, 20);
        while peer.now < Duration::from_secs(45) {
            peer.step(|_| {}, |_| {});
        }
        let report = measured(&mut peer, kind);
        let lines: Vec<String> = report.streams.iter().map(|stream| stream.line()).collect();
        assert!(report.suffices_to_identify(), "{kind:?}: {lines:#?}");
        assert_ne!(worst(&report.findings()), Level::Refusal, "{kind:?}: {:#?}", report.findings());
        let rates = report.needs.iter().find(|need| need.need == Need::BodyRates).unwrap();
        assert!(rates.best.unwrap().arrived_hz > 95.0, "{kind:?}: {lines:#?}");
    }
}

#[test]
fn a_lossy_link_still_gets_its_streams() {
    for kind in KINDS {
        let mut peer = Peer::new(kind, 0.2, 200);
        while peer.now < Duration::from_secs(45) {
            peer.step(|_| {}, |_| {});
        }
        let report = measured(&mut peer, kind);
        let lines: Vec<String> = report.streams.iter().map(|stream| stream.line()).collect();
        assert!(report.suffices_to_identify(), "{kind:?}: {lines:#?}");
    }
}

fn fence_of(peer: &mut Peer, kind: Firmware) -> (FenceOutcome, Vec<FenceItem>) {
    let mut download = FenceDownload::new(Peer::identity(kind));
    while download.outcome().is_none() {
        while let Some(message) = download.poll(peer.now) {
            peer.send(&message);
        }
        peer.step(|frame| download.take_frame(frame), |_| {});
    }
    (download.outcome().unwrap().clone(), download.items().to_vec())
}

#[test]
fn the_stored_fence_is_read_over_any_link() {
    let origin = Geodetic { latitude_deg: 47.397_742, longitude_deg: 8.545_594 };
    let corner = |north_deg: f64, east_deg: f64| FenceItem {
        command: 5001,
        parameter: 4.0,
        place: Geodetic {
            latitude_deg: origin.latitude_deg + north_deg,
            longitude_deg: origin.longitude_deg + east_deg,
        },
    };
    let stored = vec![corner(-1e-4, -1e-4), corner(1e-4, -1e-4), corner(1e-4, 1e-4), corner(-1e-4, 1e-4)];
    for kind in KINDS {
        for (loss, latency_ms) in [(0.0, 20), (0.2, 200)] {
            let mut peer = Peer::with_fence(kind, loss, latency_ms, stored.clone());
            let (outcome, items) = fence_of(&mut peer, kind);
            assert_eq!((outcome, items.len()), (FenceOutcome::Complete, 4), "{kind:?}");
            let parameters =
                Parameters { autopilot: Peer::identity(kind).autopilot, ..Parameters::default() };
            let fence = Fence::new(&parameters, &items, Some(&origin));
            // a ten thousandth of a degree: 11.1 m north, 7.5 m east
            let spare_m = fence.zones[0].spare_m([0.0, 0.0]);
            assert!((spare_m - 7.55).abs() < 0.1, "{spare_m}");
        }
        let (outcome, items) = fence_of(&mut Peer::new(kind, 0.0, 20), kind);
        assert_eq!((outcome, items.len()), (FenceOutcome::Complete, 0), "{kind:?}: no fence");
        let (outcome, _) = fence_of(&mut Peer::new(kind, 0.999, 20), kind);
        assert!(matches!(outcome, FenceOutcome::Incomplete { .. }), "{kind:?}: {outcome:?}");
    }
}
