//! What is done before a vehicle is armed: parameters, message rates, and every check, against scripted vehicles.

use mavid::autopilot::{Autopilot, LogAwaited};
use mavid::config::load_vehicle;
use mavid::fence::{FenceItem, Zone};
use mavid::fly::finding::{Finding, Level, worst};
use mavid::fly::parameters::{Download, DownloadSettings, Parameters, requested_parameters};
use mavid::fly::preflight::{BatteryState, Fence, Judged, Readiness, Situation, judge};
use mavid::fly::requests::{
    Answer, Capacity, LinkKind, Need, RequestSettings, Requests, request_set, slow_request_set,
};
use mavid::frames::Geodetic;
use mavid::trajectory::{FlightPath, FourierAxis, FourierTrajectory, Segment, Transition, at_rest};
use mavid::vehicle::Limits;
use mavid::wire::{ComponentId, Decoder, Frame, Record, SystemId, Vehicle};
use mavlink::dialects::ardupilotmega as dialect;
use mavlink::{MAVLinkV2MessageRaw, MavHeader};
use nalgebra::Vector3;
use std::collections::{BTreeMap, VecDeque};
use std::path::Path;
use std::time::Duration;

fn vehicle_of(autopilot: Autopilot) -> Vehicle {
    Vehicle { system: SystemId(1), component: ComponentId(1), autopilot, kind: None }
}

/// A hash in place of chance.
fn chance(seed: &mut u32) -> f64 {
    *seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
    f64::from(*seed >> 8) / f64::from(1_u32 << 24)
}

/// Carries messages both ways with loss and delay; time is virtual.
struct Wire {
    loss: f64,
    delay: Duration,
    seed: u32,
    down: VecDeque<(Duration, dialect::MavMessage)>,
}

impl Wire {
    fn new(loss: f64, delay_ms: u64) -> Self {
        Self { loss, delay: Duration::from_millis(delay_ms), seed: 7, down: VecDeque::new() }
    }

    fn lost(&mut self) -> bool {
        chance(&mut self.seed) < self.loss
    }

    fn send_down(&mut self, now: Duration, message: dialect::MavMessage) {
        if !self.lost() {
            self.down.push_back((now + self.delay, message));
        }
    }

    fn arrived(&mut self, now: Duration) -> Option<Vec<u8>> {
        let (due, _) = self.down.front()?;
        if *due > now {
            return None;
        }
        let (_, message) = self.down.pop_front()?;
        let mut raw = MAVLinkV2MessageRaw::new();
        raw.serialize_message(MavHeader { system_id: 1, component_id: 1, sequence: 0 }, &message);
        Some(raw.raw_bytes().to_vec())
    }
}

/// Answers by name; PX4 puts integers' bytes into the float.
fn parameter_answer(
    request: &dialect::PARAM_REQUEST_READ_DATA,
    known: &BTreeMap<&str, f32>,
    integers: &[&str],
) -> Option<dialect::MavMessage> {
    let name = request.param_id.to_str().unwrap().to_owned();
    let value = *known.get(name.as_str())?;
    let (param_value, param_type) = if integers.contains(&name.as_str()) {
        #[expect(clippy::cast_possible_truncation, reason = "a whole number")]
        let whole = value as i32;
        (f32::from_bits(whole.cast_unsigned()), dialect::MavParamType::MAV_PARAM_TYPE_INT32)
    } else {
        (value, dialect::MavParamType::MAV_PARAM_TYPE_REAL32)
    };
    Some(dialect::MavMessage::PARAM_VALUE(dialect::PARAM_VALUE_DATA {
        param_id: request.param_id,
        param_value,
        param_type,
        ..Default::default()
    }))
}

/// Runs a download on virtual time; gives what came, the requests sent and the time it took.
fn downloaded(
    autopilot: Autopilot,
    (known, integers): (&BTreeMap<&str, f32>, &[&str]),
    mut wire: Wire,
) -> (Parameters, u32, Duration) {
    let vehicle = vehicle_of(autopilot);
    let mut download =
        Download::new(vehicle, requested_parameters(autopilot, 4), DownloadSettings::default());
    let mut decoder = Decoder::new(vehicle, None, 0);
    let (mut now, mut sent) = (Duration::ZERO, 0);
    while !download.is_done(now) {
        while let Some(message) = download.poll(now) {
            let dialect::MavMessage::PARAM_REQUEST_READ(request) = &message else { unreachable!() };
            sent += 1;
            let answer = parameter_answer(request, known, integers);
            if !wire.lost() {
                answer.into_iter().for_each(|answer| wire.send_down(now, answer));
            }
        }
        while let Some(bytes) = wire.arrived(now) {
            let frame = Frame::at_start(&bytes).unwrap();
            download.take_frame(&frame);
            let record = Record { stamp_us: 1, frame, known: true, offset: 0 };
            decoder.decode(&record, &mut |event| download.take(&event));
        }
        assert!(now < Duration::from_secs(120), "it never ends");
        now += Duration::from_millis(5);
    }
    (download.finish(), sent, now)
}

const ARDUPILOT_47: &[(&str, f32)] = &[
    ("MOT_THST_EXPO", 0.65),
    ("MOT_PWM_MIN", 1000.0),
    ("MOT_PWM_MAX", 2000.0),
    ("MOT_SPIN_MIN", 0.15),
    ("MOT_SPIN_MAX", 0.95),
    ("SERVO1_FUNCTION", 33.0),
    ("GUID_TIMEOUT", 3.0),
    ("FS_GCS_ENABLE", 0.0),
    ("WP_ACC", 2.5),
    ("ATC_ANGLE_MAX", 30.0),
    ("MAV_GCS_SYSID", 255.0),
];

#[test]
fn ardupilot_parameters_come_by_either_name() {
    let known: BTreeMap<&str, f32> = ARDUPILOT_47.iter().copied().collect();
    let (parameters, ..) = downloaded(Autopilot::ArduPilot, (&known, &[]), Wire::new(0.0, 20));
    assert_eq!(parameters.values.len(), ARDUPILOT_47.len());
    assert_eq!(parameters.get("WPNAV_ACCEL"), Some(250.0));
    assert_eq!(parameters.get("ANGLE_MAX"), Some(3000.0));
    assert_eq!(parameters.get("SYSID_MYGCS"), Some(255.0));
    assert!(parameters.unanswered.contains(&"MOT_BAT_VOLT_MAX".to_owned()));
    // a renamed parameter that answered under its new name is not missing under its old one
    assert!(!parameters.unanswered.contains(&"WPNAV_ACCEL".to_owned()));
}

#[test]
fn px4_integers_are_read_from_their_bytes() {
    let known = BTreeMap::from([("COM_OBL_RC_ACT", 4.0), ("COM_OF_LOSS_T", 0.5), ("CA_ROTOR_COUNT", 4.0)]);
    let integers = ["COM_OBL_RC_ACT", "CA_ROTOR_COUNT"];
    let (parameters, ..) = downloaded(Autopilot::Px4, (&known, &integers), Wire::new(0.0, 20));
    assert_eq!(parameters.get("COM_OBL_RC_ACT"), Some(4.0));
    assert_eq!(parameters.get("COM_OF_LOSS_T"), Some(0.5));
    assert_eq!(parameters.get("CA_ROTOR_COUNT"), Some(4.0));
}

#[test]
fn a_lossy_link_costs_time_and_no_parameter() {
    let known: BTreeMap<&str, f32> = ARDUPILOT_47.iter().copied().collect();
    let (clean, clean_sent, clean_time) = downloaded(Autopilot::ArduPilot, (&known, &[]), Wire::new(0.0, 20));
    let (lossy, lossy_sent, lossy_time) =
        downloaded(Autopilot::ArduPilot, (&known, &[]), Wire::new(0.2, 200));
    assert_eq!(clean.values, lossy.values);
    assert!(lossy_sent > clean_sent && lossy_time > clean_time);
    assert!(clean_time < Duration::from_secs(6), "{clean_time:?}");
    assert!(lossy_time < Duration::from_secs(20), "{lossy_time:?}");
}

#[test]
fn a_dead_link_ends_the_download() {
    let (parameters, ..) = downloaded(Autopilot::Px4, (&BTreeMap::new(), &[]), Wire::new(1.0, 0));
    assert!(parameters.values.is_empty());
    assert_eq!(parameters.unanswered.len(), requested_parameters(Autopilot::Px4, 4).len());
}

/// Refuses and grants as the autopilots were seen to do; what is accepted runs at the granted rate.
struct Streamer {
    refused: &'static [u32],
    silent: &'static [u32],
    result: dialect::MavResult,
    fastest_hz: f64,
    /// µs, of the first output
    pulse_us: u16,
    running: BTreeMap<u32, (Duration, Duration)>,
}

impl Streamer {
    fn command(&mut self, request: &dialect::COMMAND_LONG_DATA, now: Duration) -> dialect::MavMessage {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an id")]
        let id = request.param1 as u32;
        let interval = Duration::from_secs_f64(f64::from(request.param2) * 1e-6);
        let too_fast = 1.0 / interval.as_secs_f64() > self.fastest_hz;
        let result = if self.refused.contains(&id) || too_fast {
            self.result
        } else {
            if !self.silent.contains(&id) {
                self.running.insert(id, (interval, now));
            }
            dialect::MavResult::MAV_RESULT_ACCEPTED
        };
        dialect::MavMessage::COMMAND_ACK(dialect::COMMAND_ACK_DATA {
            command: request.command,
            result,
            ..Default::default()
        })
    }

    fn due(&mut self, now: Duration) -> Vec<dialect::MavMessage> {
        use mavlink::Message;
        let mut messages = Vec::new();
        for (id, (interval, next)) in &mut self.running {
            while *next <= now {
                *next += *interval;
                messages.extend(dialect::MavMessage::default_message_from_id(*id));
            }
        }
        for message in &mut messages {
            if let dialect::MavMessage::SERVO_OUTPUT_RAW(outputs) = message {
                outputs.servo1_raw = self.pulse_us;
            }
        }
        messages
    }
}

fn requested(autopilot: Autopilot, streamer: &mut Streamer, mut wire: Wire, link: LinkKind) -> Requests {
    let capacity = Capacity::new(link, autopilot);
    let whole = request_set(autopilot);
    let set = if capacity.fits(&whole) { whole } else { slow_request_set(autopilot) };
    let mut requests = Requests::new(vehicle_of(autopilot), set, capacity, RequestSettings::default());
    let mut now = Duration::ZERO;
    while !requests.is_done() {
        while let Some(message) = requests.poll(now) {
            let dialect::MavMessage::COMMAND_LONG(request) = &message else { unreachable!() };
            assert_eq!((request.param3, request.param4, request.param7), (0.0, 0.0, 0.0));
            if !wire.lost() {
                let answer = streamer.command(request, now);
                wire.send_down(now, answer);
            }
        }
        streamer.due(now).into_iter().for_each(|message| wire.send_down(now, message));
        while let Some(bytes) = wire.arrived(now) {
            requests.take_frame(&Frame::at_start(&bytes).unwrap());
        }
        assert!(now < Duration::from_secs(300), "it never ends");
        now += Duration::from_millis(2);
    }
    requests
}

const HIGHRES_IMU: u32 = 105;
const RAW_IMU: u32 = 27;
const ESC_STATUS: u32 = 291;

fn ardupilot_without_highres() -> Streamer {
    Streamer {
        refused: &[HIGHRES_IMU],
        silent: &[],
        result: dialect::MavResult::MAV_RESULT_DENIED,
        fastest_hz: 320.0,
        pulse_us: 1500,
        running: BTreeMap::new(),
    }
}

#[test]
fn what_is_refused_is_replaced_and_what_arrives_is_measured() {
    for (loss, delay_ms) in [(0.0, 20), (0.2, 200)] {
        let wire = Wire::new(loss, delay_ms);
        let requests =
            requested(Autopilot::ArduPilot, &mut ardupilot_without_highres(), wire, LinkKind::Wide);
        let report = requests.report();
        let stream = |id: u32| report.streams.iter().find(|s| s.request.message_id == id).unwrap();
        assert_eq!(stream(HIGHRES_IMU).answer, Answer::Refused(2));
        assert_eq!(stream(RAW_IMU).answer, Answer::Accepted);
        let expected_hz = 100.0 * (1.0 - loss);
        assert!((stream(RAW_IMU).arrived_hz - expected_hz).abs() < 8.0, "{}", stream(RAW_IMU).line());
        assert_eq!(stream(26).answer, Answer::NotAsked, "a replacement's replacement is not needed");
        assert!(report.suffices_to_identify());
        assert_ne!(worst(&report.findings()), Level::Refusal);
    }
}

#[test]
fn actuator_messages_of_zeros_are_no_actuator_outputs() {
    let mut streamer = Streamer { pulse_us: 0, ..ardupilot_without_highres() };
    let requests = requested(Autopilot::ArduPilot, &mut streamer, Wire::new(0.0, 0), LinkKind::Wide);
    let report = requests.report();
    assert!(!report.suffices_to_identify());
    let findings = report.findings();
    let said = findings.iter().find(|finding| finding.expected.contains("actuator outputs")).unwrap();
    assert!(said.level == Level::Warning && said.came.contains("nothing but zeros"), "{said}");
}

#[test]
fn what_is_accepted_and_never_comes_is_noticed() {
    let mut streamer =
        Streamer { refused: &[], silent: &[HIGHRES_IMU, 36, 11030], ..ardupilot_without_highres() };
    let requests = requested(Autopilot::ArduPilot, &mut streamer, Wire::new(0.0, 5), LinkKind::Wide);
    let report = requests.report();
    let raw = report.streams.iter().find(|s| s.request.message_id == RAW_IMU).unwrap();
    assert!(raw.arrived_hz > 95.0, "the replacement of a silent stream was asked for: {}", raw.line());
    assert!(!report.suffices_to_identify(), "no actuators arrive");
    let actuators = report.needs.iter().find(|need| need.need == Need::Actuators).unwrap();
    assert!(!actuators.is_served());
    assert_eq!(worst(&report.findings()), Level::Warning);
}

#[test]
fn px4_refuses_with_another_result_and_esc_status_stays_silent() {
    let mut streamer = Streamer {
        refused: &[],
        silent: &[ESC_STATUS],
        result: dialect::MavResult::MAV_RESULT_FAILED,
        fastest_hz: 1000.0,
        pulse_us: 1500,
        running: BTreeMap::new(),
    };
    let requests = requested(Autopilot::Px4, &mut streamer, Wire::new(0.0, 5), LinkKind::Wide);
    assert!(requests.report().suffices_to_identify());
    assert_eq!(requests.report().identification().level, Level::Ok);
}

#[test]
fn a_radio_gets_the_set_to_fly_by_and_a_vehicle_that_sends_nothing_is_refused() {
    let radio = LinkKind::Serial { baud: 57_600.0 };
    let requests = requested(Autopilot::Px4, &mut ardupilot_without_highres(), Wire::new(0.0, 50), radio);
    let report = requests.report();
    assert!(report.arrived_bytes_s < 2880.0, "{} B/s", report.arrived_bytes_s);
    assert!(!report.suffices_to_identify());
    assert_eq!(worst(&report.findings()), Level::Warning);
    let said = report.identification();
    assert_eq!((said.level, said.subject), (Level::Warning, "identification"));
    assert!(
        said.expected.contains("body rates at 38 Hz") && said.expected.contains("actuator outputs at 38 Hz"),
        "{said}"
    );
    assert!(said.came.contains("ATTITUDE_QUATERNION at 10.0 Hz"), "{said}");
    assert!(said.came.contains("nothing for actuator outputs"), "{said}");

    let dead = requested(Autopilot::Px4, &mut ardupilot_without_highres(), Wire::new(1.0, 0), LinkKind::Wide);
    assert_eq!(worst(&dead.report().findings()), Level::Refusal);
}

/// A gentle flight: rise to the start, two periods of a circle-like series, back.
fn path(size_m: f64) -> FlightPath {
    let period_s = 8.0;
    let w = std::f64::consts::TAU / period_s;
    let axis = |a: f64, b: f64, c: f64| FourierAxis { a: vec![a * w], b: vec![b * w], c };
    let series = FourierTrajectory {
        period_s,
        axes: [
            axis(0.0, -size_m, 0.0),
            axis(size_m, 0.0, 0.0),
            axis(0.1 * size_m, 0.0, 2.0),
            axis(0.0, 0.0, 0.0),
        ],
    };
    let start = mavid::trajectory::end_state(&series.derivatives(0.0));
    let hover = at_rest([0.0, 0.0, 2.0, 0.0]);
    FlightPath {
        segments: vec![
            (Segment::Transition(Transition::new(&hover, &start, 5.0)), 5.0),
            (Segment::Fourier(series), 16.0),
            (Segment::Transition(Transition::new(&start, &hover, 5.0)), 5.0),
        ],
    }
}

struct Scene {
    path: FlightPath,
    limits: Limits,
    parameters: Parameters,
    fence: Fence,
    battery: BatteryState,
    readiness: Readiness,
    home_m: Option<Vector3<f64>>,
    stand_m: Vector3<f64>,
    log_awaited: Vec<LogAwaited>,
}

impl Scene {
    fn good() -> Self {
        let room = Limits {
            x_max_m: Some(8.0),
            y_max_m: Some(8.0),
            z_min_m: Some(0.5),
            z_max_m: Some(6.0),
            ..Limits::default()
        };
        Self {
            path: path(1.0),
            limits: room,
            parameters: ardupilot(&[]),
            fence: Fence {
                radius_m: Some(30.0),
                height_max_m: Some(20.0),
                margin_m: 2.0,
                ..Fence::default()
            },
            battery: BatteryState { remaining_percent: Some(90.0), is_low: false, endurance_s: Some(900.0) },
            readiness: Readiness {
                may_arm: Some(true),
                estimate_good_for: Some(Duration::from_secs(10)),
                home_set: true,
                position_arrives: true,
                ..Readiness::default()
            },
            home_m: Some(Vector3::zeros()),
            stand_m: Vector3::zeros(),
            log_awaited: Vec::new(),
        }
    }

    fn findings(&self) -> Vec<Finding> {
        self.judged().findings
    }

    fn judged(&self) -> Judged {
        let vehicle = load_vehicle(&Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/x500.toml")).unwrap();
        judge(&Situation {
            path: &self.path,
            origin_m: Vector3::zeros(),
            stand_m: Some(self.stand_m),
            home_m: self.home_m,
            vehicle: &vehicle,
            limits: &self.limits,
            tracking_max_m: 1.0,
            parameters: &self.parameters,
            log_awaited: &self.log_awaited,
            release: Some((4, 6)),
            fence: &self.fence,
            battery: &self.battery,
            readiness: &self.readiness,
            own_system: 255,
        })
    }

    /// The worst finding of a subject.
    fn said(&self, subject: &str) -> Finding {
        let mut of_subject: Vec<Finding> =
            self.findings().into_iter().filter(|finding| finding.subject == subject).collect();
        of_subject.sort_by_key(|finding| finding.level);
        of_subject.pop().unwrap()
    }
}

fn ardupilot(changes: &[(&str, f64)]) -> Parameters {
    let values = [
        ("GUID_TIMEOUT", 3.0),
        ("GUID_OPTIONS", 0.0),
        ("FS_GCS_ENABLE", 5.0),
        ("FS_GCS_TIMEOUT", 5.0),
        ("MAV_GCS_SYSID", 255.0),
        ("FS_THR_ENABLE", 1.0),
        ("FS_EKF_ACTION", 1.0),
        ("BATT_FS_LOW_ACT", 1.0),
        ("FENCE_ENABLE", 1.0),
        ("FENCE_TYPE", 7.0),
        ("FENCE_ACTION", 1.0),
        ("FENCE_ALT_MAX", 20.0),
        ("FENCE_RADIUS", 30.0),
        ("FENCE_MARGIN", 2.0),
        ("WP_SPD", 10.0),
        ("WP_SPD_UP", 3.0),
        ("WP_SPD_DN", 3.0),
        ("WP_ACC", 4.0),
        ("WP_ACC_Z", 3.0),
        ("PSC_NE_JERK", 20.0),
        ("PSC_D_JERK", 20.0),
        ("ATC_ANGLE_MAX", 30.0),
        ("FLTMODE_CH", 5.0),
        ("FLTMODE1", 5.0),
        ("RC7_OPTION", 31.0),
        ("LOG_BITMASK", 263_169.0),
        ("LOG_BACKEND_TYPE", 1.0),
        ("LOG_FILE_RATEMAX", 0.0),
    ];
    let mut parameters = Parameters { autopilot: Autopilot::ArduPilot, ..Parameters::default() };
    for (name, value) in values.iter().chain(changes) {
        parameters.values.insert((*name).to_owned(), *value);
    }
    parameters
}

#[test]
fn a_ready_vehicle_and_a_gentle_path_pass() {
    let findings = Scene::good().findings();
    let bad: Vec<String> =
        findings.iter().filter(|f| f.level == Level::Refusal).map(ToString::to_string).collect();
    assert!(bad.is_empty(), "{bad:#?}");
    // only that the sticks do nothing in GUIDED is worth a warning
    let warned: Vec<&Finding> = findings.iter().filter(|f| f.level == Level::Warning).collect();
    assert_eq!(warned.len(), 1, "{warned:#?}");
    assert!(warned[0].came.contains("sticks"));
}

#[test]
fn a_path_that_leaves_the_room_is_refused_with_place_and_time() {
    let mut scene = Scene::good();
    scene.limits.y_max_m = Some(0.9);
    let said = scene.said("limits");
    assert_eq!(said.level, Level::Refusal);
    assert!(said.expected.contains("place along west at least -0.900 m"), "{said}");
    assert!(said.came.contains("1.000 m at"), "{said}");
}

#[test]
fn stopping_takes_room() {
    let mut scene = Scene::good();
    // the path stays within 1 m; at 0.79 m/s and 0.25 m/s^2 it takes 1.2 m more to stop
    scene.limits.x_max_m = Some(1.05);
    assert_eq!(scene.said("limits").level, Level::Ok);
    assert_eq!(scene.said("stopping distance").level, Level::Ok, "4 m/s^2 stop in 8 cm, not at the far end");
    scene.parameters = ardupilot(&[("WP_ACC", 0.25)]);
    let said = scene.said("stopping distance");
    assert_eq!(said.level, Level::Warning);
    assert!(
        said.came.contains("beyond the wall to the north or south if") && said.expected.contains("WP_ACC"),
        "{said}"
    );
}

const DIES: &str = "if setpoints end";

#[test]
fn setpoints_are_sent_such_that_each_may_be_the_last() {
    let mut scene = Scene::good();
    // the path's 1 m, the rotors' 0.39 m, and what the vehicle is off its model
    (scene.limits.x_max_m, scene.limits.y_max_m) = (Some(1.65), Some(1.65));
    let said = scene.said(DIES);
    assert_eq!(said.level, Level::Ok, "{said}");
    assert!(said.came.contains("positions ahead") && said.expected.contains("3.0 s"), "{said}");
    // where only the rotors pass the wall that is told, with both numbers
    (scene.limits.x_max_m, scene.limits.y_max_m) = (Some(1.2), Some(1.2));
    let narrow = scene.said(DIES);
    assert_eq!(narrow.level, Level::Warning, "{narrow}");
    assert!(narrow.came.contains("0 is expected, more than 1.25 m beyond a wall is refused"), "{narrow}");
    (scene.limits.z_max_m, scene.limits.x_max_m, scene.limits.y_max_m) = (Some(2.3), Some(1.65), Some(1.65));
    let low = scene.said(DIES);
    assert!(low.level == Level::Warning && low.came.contains("the ceiling at worst"), "{low}");
    scene.limits.z_max_m = Some(6.0);
    // at 0.8 m/s in a wide room nothing has to be kept back
    (scene.limits.x_max_m, scene.limits.y_max_m) = (Some(8.0), Some(8.0));
    let said = scene.said(DIES);
    assert!(said.came.contains("position, velocity and acceleration"), "{said}");
    // a border of the fence counts as a wall does
    scene.fence.radius_m = Some(1.6);
    scene.fence.margin_m = 0.0;
    let said = scene.said(DIES);
    assert!(said.level == Level::Ok && said.came.contains("positions ahead"), "{said}");
}

#[test]
fn where_nothing_is_safe_to_send_it_refuses_and_says_what_would_be() {
    let mut scene = Scene::good();
    (scene.limits.x_max_m, scene.limits.y_max_m) = (Some(1.2), Some(1.2));
    // so slow a law costs more of the trajectory than is allowed
    scene.parameters = ardupilot(&[("WP_ACC", 0.2), ("PSC_NE_JERK", 0.2)]);
    let said = scene.said(DIES);
    assert_eq!(said.level, Level::Refusal, "{said}");
    assert!(said.came.starts_with("the closest safe setpoints deviate"), "{said}");
    assert!(said.remedy.contains("--tracking-max"), "{said}");
    assert!(said.remedy.contains("slower"), "{said}");
}

#[test]
fn what_px4_does_after_the_loss_is_held_against_the_room() {
    let px4 = |action: f64| {
        let values = [("COM_OF_LOSS_T", 1.0), ("COM_OBL_RC_ACT", action), ("RTL_RETURN_ALT", 60.0)];
        Parameters {
            autopilot: Autopilot::Px4,
            values: values.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect(),
            ..Parameters::default()
        }
    };
    let mut scene = Scene::good();
    for (action, word) in [(3.0, "climbs to 60 m"), (2.0, "does not stop it")] {
        scene.parameters = px4(action);
        let said = scene.said(DIES);
        assert!(said.level == Level::Warning && said.came.contains(word), "{said}");
    }
    scene.parameters = px4(4.0);
    assert_eq!(scene.said(DIES).level, Level::Ok);
}

#[test]
fn what_follows_when_our_heartbeats_end_is_held_against_the_room() {
    let mut scene = Scene::good();
    scene.limits.z_max_m = Some(4.0);
    // a return from where it comes to rest climbs by a cone of slope 6
    let returning = |enable: f64, more: &[(&str, f64)]| {
        let mut parameters =
            ardupilot(&[("FS_GCS_ENABLE", enable), ("RTL_ALT_M", 15.0), ("RTL_CONE_SLOPE", 6.0)]);
        parameters.values.extend(more.iter().map(|(name, value)| ((*name).to_owned(), *value)));
        parameters
    };
    for enable in [1.0, 2.0, 3.0, 6.0] {
        scene.parameters = returning(enable, &[]);
        let said = scene.said(DIES);
        assert!(
            said.level == Level::Warning && said.came.contains("the ceiling allows 3.7 m"),
            "{enable}: {said}"
        );
        assert!(
            said.remedy.contains("FS_GCS_ENABLE to 5") && said.remedy.contains("RTL_ALT_M to 3.6 or less"),
            "{said}"
        );
    }
    // what lands or brakes, a return below the ceiling, a narrow cone, another station's heartbeats
    for safe in [
        returning(0.0, &[]),
        returning(4.0, &[]),
        returning(5.0, &[]),
        returning(7.0, &[]),
        returning(1.0, &[("RTL_ALT_M", 3.6)]),
        returning(1.0, &[("RTL_CONE_SLOPE", 0.7)]),
        returning(1.0, &[("MAV_GCS_SYSID", 254.0)]),
    ] {
        scene.parameters = safe;
        assert_eq!(scene.said(DIES).level, Level::Ok, "{}", scene.said(DIES));
    }
    // no cone, an unanswered height, a climb in any case
    scene.parameters = returning(1.0, &[("RTL_CONE_SLOPE", 0.0)]);
    scene.parameters.values.remove("RTL_ALT_M");
    let said = scene.said(DIES);
    assert!(said.came.contains("15.0 m above home (RTL_ALT, assumed"), "{said}");
    scene.parameters = returning(1.0, &[("RTL_ALT_M", 2.0), ("RTL_CLIMB_MIN_M", 3.0)]);
    let said = scene.said(DIES);
    assert!(said.came.contains("climbs to 5.") && !said.remedy.contains("RTL_ALT_M"), "{said}");
}

#[test]
fn what_px4_does_without_a_ground_station_is_held_against_the_room() {
    let px4 = |setpoints: f64, station: f64| {
        let values = [
            ("COM_OF_LOSS_T", 1.0),
            ("COM_OBL_RC_ACT", setpoints),
            ("NAV_DLL_ACT", station),
            ("COM_DL_LOSS_T", 10.0),
            ("RTL_RETURN_ALT", 60.0),
        ];
        Parameters {
            autopilot: Autopilot::Px4,
            values: values.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect(),
            ..Parameters::default()
        }
    };
    let mut scene = Scene::good();
    for (setpoints, station, word) in [
        (
            5.0,
            2.0,
            "climbs to 60 m above home (RTL_RETURN_ALT), the ceiling allows 5.7 m, once no ground station is heard for 10 s",
        ),
        (5.0, 5.0, "motors that stop in the air once"),
        (4.0, 6.0, "motors that stop in the air once"),
        (6.0, 0.0, "motors that stop in the air (COM_OBL_RC_ACT = 6)"),
        (7.0, 0.0, "motors that stop in the air (COM_OBL_RC_ACT = 7)"),
    ] {
        scene.parameters = px4(setpoints, station);
        let said = scene.said(DIES);
        assert!(said.level == Level::Warning && said.came.contains(word), "{setpoints}, {station}: {said}");
        assert!(said.remedy.starts_with("set "), "{said}");
    }
    for (setpoints, station) in [(5.0, 0.0), (5.0, 1.0), (5.0, 3.0), (4.0, 2.0)] {
        scene.parameters = px4(setpoints, station);
        assert_eq!(scene.said(DIES).level, Level::Ok, "{}", scene.said(DIES));
    }
}

#[test]
fn guided_options_that_follow_no_place_or_velocity_are_refused() {
    let mut scene = Scene::good();
    for (mask, part, safe) in
        [(16.0, "position is not", "to 0"), (32.0, "velocity is not", "to 0"), (52.0, "bit 5", "to 4")]
    {
        scene.parameters = ardupilot(&[("GUID_OPTIONS", mask)]);
        let said = scene.said("guided options");
        assert!(said.level == Level::Refusal && said.came.contains(part), "{said}");
        assert!(said.remedy.ends_with(safe), "{said}");
    }
    scene.parameters = ardupilot(&[("GUID_OPTIONS", 4.0 + 8.0 + 64.0)]);
    assert!(scene.findings().iter().all(|finding| finding.subject != "guided options"));
}

#[test]
fn no_flight_without_a_room_nor_below_its_floor_nor_from_outside() {
    let mut scene = Scene::good();
    scene.limits = Limits::default();
    let said = scene.said("room");
    assert!(
        said.level == Level::Refusal
            && said.came
                == "nothing of the wall to the north or south, the wall to the west or east, the floor, the ceiling"
            && said.remedy.contains("give x_max_m, y_max_m, z_min_m, z_max_m in"),
        "{said}"
    );
    // whatever the limits say of it
    let mut scene = Scene::good();
    scene.limits.z_min_m = Some(-5.0);
    for (segment, _) in &mut scene.path.segments {
        if let Segment::Fourier(series) = segment {
            series.axes[2].c = 0.5;
        }
    }
    let said = scene.said("floor");
    assert!(said.level == Level::Refusal && said.expected.contains("rotors' reach"), "{said}");
    let mut scene = Scene::good();
    scene.stand_m = Vector3::new(9.0, 0.0, 0.0);
    assert_eq!(scene.said("room").level, Level::Refusal);
    assert!(Scene::good().findings().iter().all(|finding| !["room", "floor"].contains(&finding.subject)));
}

#[test]
fn the_page_before_the_flight_begins_with_warnings_and_ends_with_the_room() {
    let mut scene = Scene::good();
    scene.battery.endurance_s = None;
    let lines = scene.judged().page.lines(72);
    assert!(lines[0].starts_with("warning: "), "{}", lines[0]);
    let text = scene.judged().page.lines(400).join("\n");
    for part in [
        "if setpoints end: ",
        "m/s along the ground",
        "degrees of tilt",
        "from above",
        "mode switch",
        "kill switch",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    assert!(lines.iter().all(|line| line.chars().count() <= 72), "{text}");
    let drawn = lines.iter().filter(|line| line.starts_with('|')).count();
    assert!(drawn >= 20 && text.contains("...") && text.contains('o'), "{text}");
}

/// Whatever of it is known: the page speaks of the battery, the fence, and both of the pilot's switches.
#[test]
fn battery_fence_and_switches_are_on_every_page() {
    let batteries = [(None, None), (Some(90.0), None), (None, Some(900.0)), (Some(90.0), Some(900.0))];
    let fences = [
        Scene::good().fence,
        Fence::default(),
        Fence { unknown: vec!["2 of 4 items came".to_owned()], ..Fence::default() },
    ];
    let switches: [&[&str]; 4] = [&[], &["FLTMODE_CH"], &["RC7_OPTION"], &["FLTMODE_CH", "RC7_OPTION"]];
    let mut pages = 0;
    for (remaining_percent, endurance_s) in batteries {
        for fence in &fences {
            for missing in switches {
                let mut scene = Scene::good();
                scene.battery = BatteryState { remaining_percent, endurance_s, is_low: false };
                scene.fence = fence.clone();
                scene.parameters.values.retain(|name, _| !missing.contains(&name.as_str()));
                let lines = scene.judged().page.lines(1000);
                for (subject, word) in [
                    ("battery", if remaining_percent.is_some() { "90 %" } else { "does not report" }),
                    ("fence", ""),
                    ("pilot's takeover", "mode switch"),
                    ("pilot's takeover", "kill switch"),
                ] {
                    let head = format!("{subject}: ");
                    let said = lines.iter().any(|line| line.contains(&head) && line.contains(word));
                    assert!(said, "{subject}, {word}: {lines:#?}");
                }
                pages += 1;
            }
        }
    }
    assert_eq!(pages, 48);
}

#[test]
fn low_guided_limits_are_said_with_what_to_set() {
    let mut scene = Scene::good();
    scene.path = path(3.0);
    scene.parameters = ardupilot(&[("WP_ACC", 1.0)]);
    let said = scene.said("autopilot limits");
    assert_eq!(said.level, Level::Warning);
    // 3 (2 pi / 8)^2 = 1.85 m/s^2 in the circle, more in the transitions
    assert!(said.expected.contains("horizontal acceleration"), "{said}");
    assert!(said.came.contains("WP_ACC = 1") && said.remedy.contains("set WP_ACC to"), "{said}");
    // the older firmware's name and unit, the same judgement
    scene.parameters.values.remove("WP_ACC");
    scene.parameters.values.insert("WPNAV_ACCEL".into(), 100.0);
    let older = scene.said("autopilot limits");
    assert!(older.came.contains("1.00 m/s^2 (WPNAV_ACCEL = 100"), "{older}");
}

#[test]
fn the_fence_is_checked_with_its_margin_and_with_every_area() {
    let mut scene = Scene::good();
    scene.fence.radius_m = Some(2.5);
    let said = scene.said("fence");
    assert_eq!(said.level, Level::Refusal, "1 m of flight leaves 1.5 m, the margin is 2 m: {said}");
    scene = Scene::good();
    scene.home_m = None;
    assert_eq!(scene.said("fence").level, Level::Refusal);
    scene = Scene::good();
    let square = |inside, half: f64, north: f64| Zone::Polygon {
        inside,
        corners_m: vec![
            [north - half, -half],
            [north + half, -half],
            [north + half, half],
            [north - half, half],
        ],
    };
    scene.fence.zones = vec![square(true, 10.0, 0.0)];
    assert_eq!(scene.said("fence").level, Level::Ok);
    scene.fence.zones.push(square(false, 1.0, 1.5));
    let said = scene.said("fence");
    assert!(said.level == Level::Refusal && said.came.contains("beyond"), "{said}");
}

#[test]
fn a_fence_that_is_enabled_in_flight_is_asked_for_and_declared() {
    let asked: Vec<String> =
        requested_parameters(Autopilot::ArduPilot, 4).into_iter().flat_map(|wanted| wanted.names).collect();
    assert!(asked.iter().any(|name| name == "FENCE_AUTOENABLE"));
    let mut scene = Scene::good();
    scene.parameters = ardupilot(&[("FENCE_ENABLE", 0.0), ("FENCE_AUTOENABLE", 3.0)]);
    let said: Vec<String> = scene.findings().iter().map(ToString::to_string).collect();
    assert!(
        said.iter().any(|said| said.contains("enabled at arming or takeoff (FENCE_AUTOENABLE)")),
        "{said:#?}"
    );
    assert!(!said.iter().any(|said| said.contains("There is no fence")), "{said:#?}");
}

#[test]
fn a_fence_is_built_from_parameters_and_items() {
    let origin = Geodetic { latitude_deg: 47.397_742, longitude_deg: 8.545_594 };
    let item = |command, parameter, north: f64, east: f64| FenceItem {
        command,
        parameter,
        place: Geodetic {
            latitude_deg: origin.latitude_deg + north / 111_176.0,
            longitude_deg: origin.longitude_deg + east / 75_500.0,
        },
    };
    let items = [
        item(5001, 4.0, -10.0, -10.0),
        item(5001, 4.0, 10.0, -10.0),
        item(5001, 4.0, 10.0, 10.0),
        item(5001, 4.0, -10.0, 10.0),
        item(5004, 3.0, 6.0, 0.0),
        item(5000, 0.0, 0.0, 0.0),
    ];
    let fence = Fence::new(&ardupilot(&[]), &items, Some(&origin));
    assert!(fence.unknown.is_empty(), "{:?}", fence.unknown);
    assert_eq!((fence.radius_m, fence.height_max_m, fence.height_min_m), (Some(30.0), Some(20.0), None));
    assert_eq!(fence.zones.len(), 2);
    assert!((fence.zones[0].spare_m([0.0, 0.0]) - 10.0).abs() < 0.05, "{:?}", fence.zones);
    assert!((fence.zones[1].spare_m([0.0, 0.0]) - 3.0).abs() < 0.05);
    // a polygon that did not arrive in whole, areas without an origin, and a fence that is off
    assert_eq!(Fence::new(&ardupilot(&[]), &items[1..4], Some(&origin)).unknown.len(), 1);
    assert_eq!(Fence::new(&ardupilot(&[]), &items, None).unknown.len(), 1);
    let off = |more: &[(&str, f64)]| {
        let mut parameters = ardupilot(&[("FENCE_ENABLE", 0.0), ("FENCE_AUTOENABLE", 0.0)]);
        parameters.values.extend(more.iter().map(|(name, value)| ((*name).to_owned(), *value)));
        parameters
    };
    assert_eq!(Fence::new(&off(&[]), &items, Some(&origin)), Fence::default());
    // enabled at takeoff or arming
    for value in [1.0, 2.0, 3.0] {
        let enabled = Fence::new(&off(&[("FENCE_AUTOENABLE", value)]), &items, Some(&origin));
        assert_eq!(enabled, fence, "FENCE_AUTOENABLE = {value}");
    }
    // one that did not answer is told, one that the vehicle does not know is off
    let mut silent = off(&[]);
    silent.values.remove("FENCE_AUTOENABLE");
    assert_eq!(Fence::new(&silent, &items, Some(&origin)).unknown, ["FENCE_AUTOENABLE did not answer"]);
    silent.absent.push("FENCE_AUTOENABLE".into());
    assert_eq!(Fence::new(&silent, &items, Some(&origin)), Fence::default());
}

#[test]
fn what_is_not_ready_is_refused_with_its_reason() {
    let refused = |subject: &str, change: &dyn Fn(&mut Scene)| {
        let mut scene = Scene::good();
        change(&mut scene);
        let said = scene.said(subject);
        assert_eq!(said.level, Level::Refusal, "{said}");
        assert!(!said.remedy.is_empty());
        said
    };
    let said = refused("battery", &|scene| scene.battery.remaining_percent = Some(7.0));
    assert!(said.came.contains("63 s"), "{said}");
    refused("battery", &|scene| scene.battery.is_low = true);
    refused("home", &|scene| scene.readiness.home_set = false);
    refused("health", &|scene| scene.readiness.unhealthy = vec!["position control".into()]);
    refused("estimate", &|scene| scene.readiness.position_arrives = false);
    refused("estimate", &|scene| scene.readiness.estimate_good_for = Some(Duration::from_secs(2)));
    refused("arming", &|scene| scene.readiness.armed = true);
    let said = refused("pre-arm", &|scene| {
        scene.readiness.may_arm = Some(false);
        scene.readiness.reasons = vec!["Need Position Estimate".into()];
    });
    assert!(said.came.contains("Need Position Estimate") && said.remedy.contains("GUIDED"), "{said}");
    let mut scene = Scene::good();
    scene.battery.endurance_s = None;
    assert_eq!(scene.said("battery").level, Level::Warning);
}

#[test]
fn logging_that_waits_for_a_restart_is_not_called_enough() {
    let mut scene = Scene::good();
    scene.parameters = Parameters {
        autopilot: Autopilot::Px4,
        values: [("SDLOG_PROFILE", 9.0), ("SDLOG_MODE", 0.0)]
            .map(|(name, value)| (name.to_owned(), value))
            .into(),
        ..Parameters::default()
    };
    let said = scene.said("vehicle's own log");
    assert_eq!(said.level, Level::Ok, "{said}");
    assert!(
        said.came.ends_with("if SDLOG_PROFILE was not changed since the autopilot's last start"),
        "{said}"
    );
    scene.log_awaited = vec![LogAwaited { parameter: "SDLOG_PROFILE", set: 9.0, runs_by: 1.0 }];
    let said = scene.said("vehicle's own log");
    assert_eq!(said.level, Level::Warning, "{said}");
    assert!(
        said.came.contains("it runs by 1; motor commands at 10 Hz") && said.remedy.contains("restart"),
        "{said}"
    );
}
