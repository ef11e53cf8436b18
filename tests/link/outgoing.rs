//! Every message that this ground station makes is in range, whatever it was made from: encoded, decoded, and each
//! field held against MAVLink's definitions.

use std::time::Duration;

use mavid::autopilot::Autopilot;
use mavid::autopilot::{ARDUPILOT, Mode, PX4, Purpose};
use mavid::fly::parameters::{Download, DownloadSettings, RequestedParameter, requested_parameters};
use mavid::fly::preflight::FenceDownload;
use mavid::fly::requests::{Capacity, LinkKind, Need, RequestSettings, Requests, StreamRequest};
use mavid::fly::{MessageId, Order, ParameterName, Period, Setpoint, Target, heartbeat};
use mavid::wire::{Check, ComponentId, CrcSeeds, Frame, SystemId, Vehicle};
use mavlink::dialects::ardupilotmega::MavMessage;
use mavlink::{MAVLinkV2MessageRaw, MavHeader};
use nalgebra::Vector3;
use proptest::prelude::*;

/// One field: from, to, and the step between its values (0: any value between).
type Field = (f64, f64, f64);
const UNUSED: Field = (0.0, 0.0, 0.0);
const MESSAGE_ID: Field = (0.0, 16_777_215.0, 1.0);

/// The parameters of each command that is sent, as MAVLink's definitions bound them; where they name no bound, what
/// both autopilots take: ArduCopter casts the numbers of `DO_SET_MODE` to 8 and 32 bits without a look, and an interval
/// to a signed 32 bits.
const COMMANDS: [(u16, [Field; 7]); 5] = [
    (22, [UNUSED, UNUSED, UNUSED, UNUSED, UNUSED, UNUSED, (0.009_999, 1000.0, 0.0)]),
    (176, [(1.0, 1.0, 1.0), (0.0, 255.0, 1.0), (0.0, 255.0, 1.0), UNUSED, UNUSED, UNUSED, UNUSED]),
    (400, [(0.0, 1.0, 1.0), (0.0, 21_196.0, 21_196.0), UNUSED, UNUSED, UNUSED, UNUSED, UNUSED]),
    (511, [MESSAGE_ID, (1000.0, 16_777_215.0, 1.0), UNUSED, UNUSED, UNUSED, UNUSED, (0.0, 2.0, 1.0)]),
    (512, [MESSAGE_ID, UNUSED, UNUSED, UNUSED, UNUSED, UNUSED, (0.0, 2.0, 1.0)]),
];

fn in_field(value: f64, (least, greatest, step): Field) -> bool {
    (least..=greatest).contains(&value) && (step == 0.0 || value % step == 0.0)
}

/// Holds a message, as it leaves, against the definitions.
fn check(message: &MavMessage) -> Result<(), String> {
    let mut raw = MAVLinkV2MessageRaw::new();
    raw.serialize_message(MavHeader { system_id: 255, component_id: 190, sequence: 0 }, message);
    let frame = Frame::at_start(raw.raw_bytes()).ok_or("no frame")?;
    if frame.check(&CrcSeeds::new()) != Check::Right {
        return Err("wrong checksum".to_owned());
    }
    let (id, payload) = (frame.header().message_id, frame.payload());
    let holds = |rule: bool, what: &str| if rule { Ok(()) } else { Err(format!("{what}: {message:?}")) };
    match id {
        // HEARTBEAT: type GCS, autopilot invalid, no base mode, active, MAVLink's minor version
        0 => holds(payload.0.len() == 9 && payload.0[..9] == [0, 0, 0, 0, 6, 8, 0, 4, 3], "heartbeat"),
        // PARAM_REQUEST_READ
        20 => {
            let name = payload.text(4, 16);
            holds(payload.i16(0) == -1 && payload.u8(2) > 0, "index and vehicle")?;
            holds(!name.is_empty() && name.bytes().all(|b| b == b'_' || b.is_ascii_alphanumeric()), "name")
        }
        // MISSION_REQUEST_LIST, MISSION_ACK, MISSION_REQUEST_INT: of a fence
        43 => holds(payload.u8(0) > 0 && payload.u8(2) == 1, "fence"),
        47 => holds(payload.u8(0) > 0 && payload.u8(2) == 0 && payload.u8(3) == 1, "fence"),
        51 => holds(payload.u8(2) > 0 && payload.u8(4) == 1, "fence"),
        76 => {
            let command = payload.u16(28);
            let (_, fields) =
                COMMANDS.iter().find(|(known, _)| *known == command).ok_or(format!("command {command}"))?;
            for (index, field) in fields.iter().enumerate() {
                holds(in_field(payload.f32(4 * index), *field), &format!("parameter {}", index + 1))?;
            }
            holds(payload.u8(30) > 0, "a command to everybody")
        }
        // SET_POSITION_TARGET_LOCAL_NED: LOCAL_NED, nothing ignored
        84 => {
            let bounds = [10_000.0, 100.0, 100.0];
            for index in 0..9 {
                let value = payload.f32(4 + 4 * index);
                holds(value.abs() <= bounds[index / 3], &format!("component {index}"))?;
            }
            holds(payload.f32(40).abs() <= f64::from(std::f32::consts::PI), "yaw")?;
            holds(payload.f32(44).abs() <= 32.0, "yaw rate")?;
            holds(payload.u16(48) == 0 && payload.u8(50) > 0 && payload.u8(52) == 1, "mask, vehicle, frame")
        }
        _ => Err(format!("message {id} is not among those that are sent")),
    }
}

/// Any number: ordinary ones, and any bits.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        -20.0..20.0_f64,
        any::<u64>().prop_map(f64::from_bits),
        prop_oneof![Just(f64::NAN), Just(f64::INFINITY), Just(f64::NEG_INFINITY), Just(2_147_483_648.0)],
        -1e5..1e5_f64,
    ]
}

fn vector() -> impl Strategy<Value = Vector3<f64>> {
    (number(), number(), number()).prop_map(|(x, y, z)| Vector3::new(x, y, z))
}

fn target() -> impl Strategy<Value = Target> {
    (1_u32..=255, any::<u8>())
        .prop_map(|(system, component)| Target::new(SystemId(system), ComponentId(component)).unwrap())
}

fn vehicle(system: u32, autopilot: Autopilot) -> Vehicle {
    Vehicle { system: SystemId(system), component: ComponentId(1), autopilot, kind: None }
}

fn order() -> impl Strategy<Value = Option<Order>> {
    let stack = prop_oneof![Just(&PX4), Just(&ARDUPILOT)];
    let mode = prop_oneof![Just(Mode::External), Just(Mode::Hold), Just(Mode::Land), Just(Mode::Return)];
    prop_oneof![
        (stack, mode).prop_map(|(stack, mode)| Some(Order::set_mode(stack, mode))),
        any::<bool>().prop_map(|arm| Some(Order::arm(arm))),
        Just(Some(Order::kill())),
        number().prop_map(|height_m| Order::takeoff(height_m).ok()),
        (any::<u32>(), number()).prop_map(|(id, rate_hz)| {
            Some(Order::interval(MessageId::new(id >> 8).ok()?, Period::of_rate(rate_hz).ok()?))
        }),
        (any::<u16>(), any::<u16>())
            .prop_map(|(id, rate_hz)| Some(Order::interval(id, Period::of_whole_rate(rate_hz)))),
        any::<u32>().prop_map(|id| MessageId::new(id).ok().map(Order::request_message)),
        any::<u16>().prop_map(|id| Some(Order::request_message(id))),
    ]
}

fn passes(message: &MavMessage) -> Result<(), TestCaseError> {
    check(message).map_err(TestCaseError::fail)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4096))]

    #[test]
    fn every_command_is_in_range(order in order(), target in target(), confirmation: u8) {
        if let Some(order) = order {
            passes(&target.command(&order, confirmation))?;
        }
    }

    #[test]
    fn every_setpoint_is_in_range(
        (position_m, velocity_m_s, acceleration_m_s2) in (vector(), vector(), vector()),
        (yaw_rad, yaw_rate_rad_s) in (number(), number()),
        (time_ms, target) in (any::<u64>(), target()),
    ) {
        let time = Duration::from_millis(time_ms);
        let setpoint = Setpoint { time, position_m, velocity_m_s, acceleration_m_s2, yaw_rad, yaw_rate_rad_s };
        if let Ok(message) = setpoint.message(target) {
            passes(&message)?;
        }
    }

    #[test]
    fn every_question_is_in_range(
        system in prop_oneof![0_u32..300, any::<u32>()],
        (id, rate_hz) in (any::<u32>(), number()),
        name in prop_oneof!["[A-Z0-9_]{0,20}", ".{0,20}"],
    ) {
        let (now, vehicle) = (Duration::ZERO, vehicle(system, Autopilot::Px4));
        let request = StreamRequest {
            message_id: id,
            name: "ANY",
            rate_hz,
            frame_bytes: 20.0,
            needs: &[Need::State],
            instead_of: None,
            on_change: false,
        };
        let capacity = Capacity::new(LinkKind::Wide, Autopilot::Px4);
        let mut requests = Requests::new(vehicle, vec![request], capacity, RequestSettings::default());
        let asked = RequestedParameter { names: vec![name], purpose: Purpose::Limit };
        let mut download = Download::new(vehicle, vec![asked], DownloadSettings::default());
        let mut fence = FenceDownload::new(vehicle);
        for message in [requests.poll(now), download.poll(now), fence.poll(now)].into_iter().flatten() {
            prop_assert!((1..256).contains(&system), "sent to {system}");
            passes(&message)?;
        }
    }
}

#[test]
fn what_is_not_in_range_is_refused_and_not_changed() {
    assert!(Order::takeoff(f64::NAN).is_err());
    let target = Target::new(SystemId(1), ComponentId(1)).unwrap();
    let zero = Vector3::zeros();
    let mut setpoint = Setpoint {
        time: Duration::ZERO,
        position_m: zero,
        velocity_m_s: zero,
        acceleration_m_s2: zero,
        yaw_rad: 0.0,
        yaw_rate_rad_s: 0.0,
    };
    assert!(setpoint.message(target).is_ok());
    setpoint.velocity_m_s.y = f64::NAN;
    let why = setpoint.message(target).unwrap_err().to_string();
    assert_eq!(why, "a setpoint's velocity: expected -100 to 100 m/s, got NaN; nothing was sent");
}

#[test]
fn what_is_sent_in_every_flight_is_in_range() {
    check(&heartbeat()).unwrap();
    for autopilot in [Autopilot::Px4, Autopilot::ArduPilot] {
        for name in requested_parameters(autopilot, 8).iter().flat_map(|wanted| &wanted.names) {
            assert!(ParameterName::new(name).is_ok(), "{name}");
        }
        for set in [mavid::fly::requests::request_set, mavid::fly::requests::slow_request_set] {
            for request in set(autopilot) {
                assert!(Period::of_rate(request.rate_hz).is_ok(), "{}", request.name);
                assert!(MessageId::new(request.message_id).is_ok(), "{}", request.name);
            }
        }
    }
}

/// A number that stopped ArduCopter, in each place where a command has room for one: the check of this file finds it.
#[test]
fn the_check_finds_what_is_out_of_range() {
    let target = Target::new(SystemId(1), ComponentId(1)).unwrap();
    let good = target.command(&Order::set_mode(&ARDUPILOT, Mode::Hold), 0);
    check(&good).unwrap();
    for value in [2_147_483_648.0, f32::NAN, f32::INFINITY, -1.0, 0.5] {
        for index in 0..7 {
            let MavMessage::COMMAND_LONG(mut data) = good.clone() else { panic!() };
            let fields = [
                &mut data.param1,
                &mut data.param2,
                &mut data.param3,
                &mut data.param4,
                &mut data.param5,
                &mut data.param6,
                &mut data.param7,
            ];
            *fields.into_iter().nth(index).unwrap() = value;
            assert!(check(&MavMessage::COMMAND_LONG(data)).is_err(), "{value} as parameter {}", index + 1);
        }
    }
}
