//! What both autopilots have in common: commands, faults, determinism, effects.

use std::time::Duration;

use mavid::fence::FenceItem;
use mavid::frames::Geodetic;
use mavid::link::SigningKey;
use mavid::physics::ActiveEffect;
use mavid::physics::effects::{LinearDrag, SteadyWind};
use mavid::sitl::{Fault, LinkRole, Mode, Settings, SitlError, Vehicle};
use mavlink::dialects::ardupilotmega::{COMMAND_LONG_DATA, MavCmd, MavMessage, SETUP_SIGNING_DATA};
use mavlink::{MAVLinkV2MessageRaw, MavHeader};

use crate::ground::{Ground, Target, heartbeat, settings};
use crate::{ACCEPTED, COPTER, DENIED, FAILED, PX4, TEMPORARILY_REJECTED, UNSUPPORTED, assert_at};

/// All bytes of a short flight.
fn flight(settings: Settings) -> Vec<(Duration, u32, Vec<u8>)> {
    let mut ground = Ground::new(settings);
    ground.take_off(2.0);
    ground.set_interval(32, 20.0);
    let goal = Target::at([1.0, 1.0, -2.0]).message();
    ground.stream(0.5, &goal);
    assert_eq!(ground.set_mode(Mode::Guided), ACCEPTED);
    ground.stream(1.5, &goal);
    ground.received
}

#[test]
fn the_same_calls_give_the_same_bytes_and_another_seed_gives_others() {
    for kind in [PX4, COPTER] {
        let first = flight(settings(kind));
        assert_eq!(first, flight(settings(kind)));
        assert_ne!(first, flight(Settings { seed: 1, ..settings(kind) }));
    }
}

#[test]
fn how_often_the_clock_is_read_changes_nothing() {
    let run = |step_us: u64| {
        let mut vehicle = Vehicle::new(settings(PX4)).unwrap();
        vehicle.open_link(LinkRole::Onboard);
        let mut frames = Vec::new();
        let mut now = Duration::ZERO;
        while now < Duration::from_secs(3) {
            now = (now + Duration::from_micros(step_us)).min(Duration::from_secs(3));
            frames.extend(vehicle.advance(now));
        }
        frames
    };
    let fine = run(700);
    assert_eq!(fine, run(1_000_000));
    assert!(fine.windows(2).all(|pair| pair[0].time <= pair[1].time));
}

#[test]
fn a_concealed_effect_changes_the_flight_and_is_told_nowhere() {
    let drag = ActiveEffect::new(&LinearDrag, &[0.9, 0.9, 0.0]).unwrap();
    let plain = flight(settings(PX4));
    let dragged = flight(Settings { effects: vec![drag], ..settings(PX4) });
    assert_ne!(plain, dragged);
    let place = |flight: &[(Duration, u32, Vec<u8>)]| {
        let last = flight.iter().rev().find(|(_, id, _)| *id == 32).unwrap();
        mavid::wire::Frame::at_start(&last.2).unwrap().payload().f32s::<3>(4)
    };
    assert!(
        (place(&plain)[0] - place(&dragged)[0]).abs() > 0.01,
        "{:?} {:?}",
        place(&plain),
        place(&dragged)
    );
    for (_, id, bytes) in &dragged {
        // SIMSTATE, SIM_STATE, HIL_*
        assert!(![90, 91, 92, 93, 107, 108, 113, 114, 115, 164].contains(id));
        let text = String::from_utf8_lossy(bytes);
        assert!(!text.contains("SIM_") && !text.contains("SIH_") && !text.contains("drag"));
    }
}

#[test]
fn a_steady_wind_leans_the_vehicle() {
    let lean = |effects| {
        let mut ground = Ground::new(Settings { effects, ..settings(PX4) });
        ground.take_off(2.0);
        ground.wait(5.0);
        let ground = &ground;
        let pitch: Vec<f64> = ground
            .received
            .iter()
            .rev()
            .filter(|(_, id, _)| *id == 30)
            .take(50)
            .map(|(_, _, bytes)| mavid::wire::Frame::at_start(bytes).unwrap().payload().f32(8))
            .collect();
        pitch.iter().sum::<f64>() / pitch.len() as f64
    };
    let drag = || ActiveEffect::new(&LinearDrag, &[0.9, 0.9, 0.0]).unwrap();
    let wind = ActiveEffect::new(&SteadyWind, &[4.0, 0.0, 0.0]).unwrap();
    let calm = lean(vec![drag()]);
    let windy = lean(vec![drag(), wind]);
    // a wind to the north: it leans back, nose up. 0.9 * 4 / (2.06 * 9.81) = 0.18
    assert!(calm.abs() < 0.02 && (0.1..0.26).contains(&windy), "{calm} {windy}");
}

#[test]
fn commands_are_answered_as_they_should_be() {
    for kind in [PX4, COPTER] {
        let mut ground = Ground::of(kind);
        ground.wait(3.0);
        assert_eq!(ground.command(31_999, [0.0; 7]), UNSUPPORTED, "no dialect knows it");
        assert_eq!(ground.command(176, [0.0, 4.0, 0.0, 0.0, 0.0, 0.0, 0.0]), DENIED, "not a custom mode");
        let unknown = ground.command(176, [1.0, 99.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!(unknown, if kind == PX4 { TEMPORARILY_REJECTED } else { FAILED });
        assert_eq!(ground.command(510, [30.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]), ACCEPTED);
        assert_eq!(ground.last(244).unwrap().u16(4), 30);
        assert_eq!(ground.command(512, [148.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]), ACCEPTED);
        let capabilities = ground.last(148).unwrap().u64(0);
        assert_eq!(capabilities & 16 != 0, kind == PX4, "parameters as bytes");
        assert_eq!(capabilities & 131_072 != 0, kind != PX4, "parameters as values");
        assert_eq!(capabilities & (128 | 8192), 128 | 8192);
        assert_eq!(ground.command(410, [0.0; 7]), ACCEPTED);
        let home = ground.last(242).unwrap();
        assert!((f64::from(home.i32(0)) - 47.397_742e7).abs() < 10.0, "{}", home.i32(0));
        // to another system: nobody answers
        ground.forget();
        let mut payload = vec![0; 28];
        payload.extend(400_u16.to_le_bytes());
        payload.extend([77, 1, 0]);
        ground.send_raw(76, 152, &payload);
        assert_eq!(ground.count(77), 0);
        // COMMAND_INT
        let mut payload = vec![0; 28];
        payload[..4].copy_from_slice(&1.0_f32.to_le_bytes());
        payload.extend(400_u16.to_le_bytes());
        payload.extend([1, 1, 0, 0, 1]);
        ground.send_raw(75, 158, &payload);
        let ack = ground.last(77).unwrap();
        assert_eq!((ack.u16(0), ack.u8(2)), (400, ACCEPTED));
        assert_eq!((ack.u8(8), ack.u8(9)), (255, 190), "to whom it answers");
        assert_eq!(ground.command(246, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]), DENIED, "armed");
    }
}

#[test]
fn set_mode_works_by_its_message_too() {
    for (kind, number, answered) in [(PX4, 6_u32 << 16, 176), (COPTER, 4, 11)] {
        let mut ground = Ground::of(kind);
        ground.wait(0.5);
        let mut payload = number.to_le_bytes().to_vec();
        payload.extend([1, 1]);
        ground.send_raw(11, 89, &payload);
        assert_eq!(ground.last(77).unwrap().u16(0), answered);
        ground.wait(1.0);
        assert_eq!(ground.heartbeat().0, number);
    }
}

#[test]
fn clocks_are_answered() {
    for kind in [PX4, COPTER] {
        let mut ground = Ground::of(kind);
        ground.wait(1.5);
        ground.forget();
        let mut payload = 0_i64.to_le_bytes().to_vec();
        payload.extend(123_456_789_012_i64.to_le_bytes());
        ground.send_raw(111, 34, &payload);
        let answer = ground.received.iter().find(|(_, id, _)| *id == 111).unwrap();
        let answer = mavid::wire::Frame::at_start(&answer.2).unwrap().payload();
        assert_eq!((answer.u64(0), answer.u64(8)), (1_500_000_000, 123_456_789_012));
        let mut ping = 99_u64.to_le_bytes().to_vec();
        ping.extend([7, 0, 0, 0, 0, 0]);
        ground.send_raw(4, 237, &ping);
        let answer = ground.last(4).unwrap();
        assert_eq!((answer.u64(0), answer.u32(8), answer.u8(12)), (99, 7, 255));
        assert_eq!(ground.command(512, [2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]), ACCEPTED);
        let time = ground.last(2).unwrap();
        assert_eq!(time.u64(0), 1_700_000_000_000_000 + u64::from(time.u32(8)) * 1000);
    }
}

#[test]
fn every_parameter_comes_once_by_list_and_by_index() {
    for kind in [PX4, COPTER] {
        let mut ground = Ground::of(kind);
        ground.wait(0.1);
        ground.send_raw(21, 159, &[1, 1]);
        ground.wait(2.0);
        let values: Vec<_> = ground
            .received
            .iter()
            .filter(|(_, id, _)| *id == 22)
            .map(|(_, _, bytes)| mavid::wire::Frame::at_start(bytes).unwrap().payload())
            .map(|payload| (payload.u16(6), payload.u16(4), payload.text(8, 16)))
            .collect();
        let count = values[0].1;
        assert!(count > 100);
        let indices: Vec<u16> = values.iter().map(|value| value.0).collect();
        assert_eq!(indices, (0..count).collect::<Vec<_>>());
        let mut names: Vec<&String> = values.iter().map(|value| &value.2).collect();
        names.dedup();
        assert_eq!(names.len(), usize::from(count));
        assert!(names.iter().all(|name| !name.starts_with("SIM_") && !name.starts_with("SIH_")));
        ground.forget();
        let mut payload = 3_i16.to_le_bytes().to_vec();
        payload.extend([1, 1]);
        payload.extend([0; 16]);
        ground.send_raw(20, 214, &payload);
        assert_eq!(ground.last(22).unwrap().text(8, 16), values[3].2);
    }
}

/// MISSION_ITEM_INT of a fence as it is on the wire.
fn fence_item(sequence: u16, command: u16, param1: f32, latitude: i32) -> Vec<u8> {
    let mut payload = param1.to_le_bytes().to_vec();
    payload.extend([0; 12]);
    payload.extend(latitude.to_le_bytes());
    payload.extend(85_000_000_i32.to_le_bytes());
    payload.extend([0; 4]);
    payload.extend(sequence.to_le_bytes());
    payload.extend(command.to_le_bytes());
    payload.extend([1, 1, 3, 0, 1, 1]);
    payload
}

#[test]
fn a_stored_fence_can_be_read_and_cleared_and_there_is_no_mission() {
    let corner = |latitude_deg| FenceItem {
        command: 5001,
        parameter: 3.0,
        place: Geodetic { latitude_deg, longitude_deg: 8.5 },
    };
    let fence = vec![corner(47.1), corner(47.2), corner(47.3)];
    let mut ground = Ground::new(Settings { fence, ..settings(PX4) });
    ground.wait(0.1);
    ground.send_raw(43, 132, &[1, 1, 1]);
    let count = ground.last(44).unwrap();
    assert_eq!((count.u16(0), count.u8(4)), (3, 1));
    ground.send_raw(51, 196, &[1, 0, 1, 1, 1]);
    let item = ground.last(73).unwrap();
    assert_eq!((item.i32(16), item.u16(28), item.u16(30)), (472_000_000, 1, 5001));
    ground.send_raw(51, 196, &[3, 0, 1, 1, 1]);
    assert_eq!(ground.last(47).unwrap().u8(2), 13, "no such item");
    ground.send_raw(43, 132, &[1, 1, 0]);
    assert_eq!(ground.last(44).unwrap().u16(0), 0, "no mission");
    ground.send_raw(44, 221, &[2, 0, 1, 1, 0]);
    assert_eq!(ground.last(47).unwrap().u8(2), 3, "a mission is not supported");
    ground.send_raw(45, 232, &[1, 1, 1]);
    assert_eq!(ground.last(47).unwrap().u8(2), 0);
    ground.send_raw(43, 132, &[1, 1, 1]);
    assert_eq!(ground.last(44).unwrap().u16(0), 0, "cleared");
}

#[test]
fn a_fence_is_stored_item_by_item_and_what_is_none_is_refused() {
    let mut ground = Ground::of(PX4);
    ground.wait(0.1);
    let asked = |ground: &Ground| ground.last(51).unwrap().u16(0);
    let answer = |ground: &Ground| ground.last(47).unwrap().u8(2);
    ground.send_raw(44, 221, &[4, 0, 1, 1, 1]);
    assert_eq!(asked(&ground), 0);
    ground.send_raw(73, 38, &fence_item(0, 5001, 3.0, 471_000_000));
    assert_eq!(asked(&ground), 1);
    // the item is lost: asked for again, and one that comes twice does not count twice
    let before = ground.count(51);
    ground.wait(0.6);
    assert_eq!((ground.count(51), asked(&ground)), (before + 2, 1));
    ground.send_raw(73, 38, &fence_item(0, 5001, 3.0, 471_000_000));
    ground.send_raw(73, 38, &fence_item(1, 5001, 3.0, 472_000_000));
    ground.send_raw(73, 38, &fence_item(2, 5001, 3.0, 473_000_000));
    assert_eq!(ground.count(47), 0);
    ground.send_raw(73, 38, &fence_item(3, 5003, 60.0, 471_500_000));
    assert_eq!(answer(&ground), 0, "accepted");
    ground.send_raw(43, 132, &[1, 1, 1]);
    assert_eq!(ground.last(44).unwrap().u16(0), 4);
    ground.send_raw(51, 196, &[3, 0, 1, 1, 1]);
    let circle = ground.last(73).unwrap();
    assert_eq!((circle.f32(0), circle.i32(16), circle.u16(30)), (60.0, 471_500_000, 5003));

    // two corners, a waypoint, a circle without radius, places in the local frame: refused, the stored fence stays
    ground.send_raw(44, 221, &[2, 0, 1, 1, 1]);
    ground.send_raw(73, 38, &fence_item(0, 5001, 2.0, 471_000_000));
    ground.send_raw(73, 38, &fence_item(1, 5001, 2.0, 472_000_000));
    assert_eq!(answer(&ground), 5);
    let mut local = fence_item(0, 5003, 60.0, 471_000_000);
    local[34] = 1;
    for (item, refusal) in [
        (fence_item(0, 16, 60.0, 471_000_000), 3),
        (fence_item(0, 5003, 0.0, 471_000_000), 5),
        (fence_item(0, 5003, f32::NAN, 471_000_000), 5),
        (fence_item(0, 5003, 60.0, 971_000_000), 5),
        (local, 2),
    ] {
        ground.send_raw(44, 221, &[1, 0, 1, 1, 1]);
        ground.send_raw(73, 38, &item);
        assert_eq!(answer(&ground), refusal, "{item:?}");
    }
    ground.send_raw(44, 221, &[65, 0, 1, 1, 1]);
    assert_eq!(answer(&ground), 4, "no space");
    // an upload that is left alone ends
    ground.send_raw(44, 221, &[1, 0, 1, 1, 1]);
    ground.wait(6.0);
    assert_eq!(answer(&ground), 15, "cancelled");
    ground.send_raw(43, 132, &[1, 1, 1]);
    assert_eq!(ground.last(44).unwrap().u16(0), 4);
}

#[test]
fn a_reboot_starts_the_clock_anew_and_disarms() {
    for kind in [PX4, COPTER] {
        let mut ground = Ground::of(kind);
        ground.wait(3.0);
        assert_eq!(ground.command(511, [30.0, 1e5, 0.0, 0.0, 0.0, 0.0, 0.0]), ACCEPTED);
        assert_eq!(ground.arm(), ACCEPTED);
        ground.wait(1.0);
        assert!(ground.last(30).unwrap().u32(0) > 3900);
        ground.fault(Fault::Reboot);
        ground.wait(0.5);
        assert_eq!(ground.command(512, [30.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]), ACCEPTED);
        assert!(ground.last(30).unwrap().u32(0) < 600);
        ground.wait(1.0);
        assert!(!ground.is_armed());
    }
}

#[test]
fn a_silent_link_carries_nothing_either_way() {
    let mut ground = Ground::of(PX4);
    ground.take_off(2.0);
    ground.fault(Fault::LinkSilence(Duration::from_secs(2)));
    ground.forget();
    ground.wait(1.9);
    assert!(ground.received.is_empty());
    assert_eq!(ground.command(21, [0.0; 7]), u8::MAX);
    ground.wait(1.2);
    assert!(ground.count(30) > 10);
    assert_eq!(ground.mode(), Some(Mode::Hold), "the command was not heard");
}

#[test]
fn a_push_tilts_it_and_a_rotor_that_stops_brings_it_down() {
    let mut ground = Ground::of(PX4);
    ground.take_off(3.0);
    let tilt = |ground: &Ground| {
        let attitude = ground.last(30).unwrap();
        attitude.f32(4).hypot(attitude.f32(8))
    };
    assert!(tilt(&ground) < 0.1);
    ground.fault(Fault::Push {
        force_n: [0.0; 3],
        torque_nm: [3.5, 0.0, 0.0],
        duration: Duration::from_millis(150),
    });
    let mut worst: f64 = 0.0;
    for _ in 0..20 {
        ground.wait(0.02);
        worst = worst.max(tilt(&ground));
    }
    assert!(worst > 0.35, "{worst}");
    ground.wait(6.0);
    assert_at(&ground, [0.0, 0.0, -3.0], 0.5);
    ground.fault(Fault::RotorStops(0));
    ground.wait(4.0);
    assert!(ground.position()[2] > -2.0, "{:?}", ground.position());
}

#[test]
fn a_foreign_heartbeat_comes_as_it_is() {
    let mut ground = Ground::of(PX4);
    ground.wait(0.5);
    ground.fault(Fault::ForeignHeartbeat { system: 255, component: 190 });
    ground.wait(0.1);
    let foreign = ground
        .received
        .iter()
        .filter(|(_, id, _)| *id == 0)
        .map(|(_, _, bytes)| *mavid::wire::Frame::at_start(bytes).unwrap().header())
        .any(|header| header.system.0 == 255 && header.component.0 == 190);
    assert!(foreign);
}

#[test]
fn frames_take_their_time_and_some_get_lost() {
    let latency = Duration::from_millis(200);
    let mut ground = Ground::new(Settings { latency, loss: 0.2, ..settings(PX4) });
    ground.wait(10.0);
    let first = ground.received.first().unwrap();
    assert!(first.0 >= latency);
    let sequences: Vec<u8> = ground
        .received
        .iter()
        .map(|(_, _, bytes)| mavid::wire::Frame::at_start(bytes).unwrap().header().sequence)
        .collect();
    let gaps: usize = sequences.windows(2).map(|pair| usize::from(pair[1].wrapping_sub(pair[0])) - 1).sum();
    let lost = gaps as f64 / (gaps + sequences.len()) as f64;
    assert!((lost - 0.2).abs() < 0.02, "{lost}");
    let beat = heartbeat();
    ground.send(&beat);
}

#[test]
fn wrong_settings_are_told() {
    let bad = [
        Settings { loss: 1.0, ..settings(PX4) },
        Settings { system: 0, ..settings(PX4) },
        Settings { start_m: [f64::NAN, 0.0], ..settings(PX4) },
        Settings { battery_v: 0.0, ..settings(PX4) },
        Settings { motor_time_constant_s: -1.0, ..settings(PX4) },
        Settings { parameters: vec![("WP_SPD".into(), 1.0)], ..settings(PX4) },
    ];
    for settings in bad {
        let error = Vehicle::new(settings).unwrap_err();
        assert!(matches!(error, SitlError::Setting { .. }), "{error}");
    }
}

#[test]
fn any_bytes_may_come_in() {
    let mut ground = Ground::of(COPTER);
    ground.wait(2.5);
    let mut state = 1_u32;
    for _ in 0..300 {
        let mut bytes: Vec<u8> = (0..97)
            .map(|_| {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                state.to_be_bytes()[0]
            })
            .collect();
        // among them every message with a random payload and a right checksum
        let whole = ground.raw(bytes[0] % 120, 0, &bytes[1..60]);
        bytes.extend(whole);
        ground.vehicle.receive(ground.link, &bytes, ground.now);
        ground.wait(0.02);
    }
    for id in [4, 11, 20, 21, 23, 43, 44, 51, 66, 75, 76, 84, 111_u8] {
        let seed = mavid::wire::CrcSeeds::new().get(id.into()).unwrap();
        for fill in [0x00, 0x01, 0x7F, 0xFF] {
            let frame = ground.raw(id, seed, &[fill; 60]);
            ground.vehicle.receive(ground.link, &frame, ground.now);
            ground.wait(0.02);
        }
    }
    ground.forget();
    ground.wait(2.0);
    assert!(ground.count(0) >= 1);
}

#[test]
fn stored_areas_are_kept_and_nobody_arms_outside_them() {
    let origin = settings(PX4).origin;
    let origin = Geodetic { latitude_deg: origin.latitude_deg, longitude_deg: origin.longitude_deg };
    let corner =
        |north_m, west_m| FenceItem { command: 5001, parameter: 4.0, place: origin.moved([north_m, west_m]) };
    let fence = vec![corner(-6.0, -6.0), corner(6.0, -6.0), corner(6.0, 6.0), corner(-6.0, 6.0)];
    for (kind, parameter, mode) in [(PX4, "GF_ACTION", Mode::Hold), (COPTER, "FENCE_ENABLE", Mode::Return)] {
        let value = if kind == PX4 { 2.0 } else { 1.0 };
        let parameters = vec![(parameter.to_owned(), value)];
        let inside = Settings { fence: fence.clone(), parameters, ..settings(kind) };
        let mut ground = Ground::new(inside.clone());
        ground.take_off(3.0);
        let east = Target::moving([0.0, 2.0, 0.0]).message();
        ground.stream(1.0, &east);
        assert_eq!(ground.set_mode(Mode::Guided), ACCEPTED);
        ground.stream(1.5, &east);
        assert_eq!(ground.mode(), Some(Mode::Guided));
        ground.stream(4.0, &east);
        assert_eq!(ground.mode(), Some(mode), "{kind:?}: {:?}", ground.texts());

        let mut ground = Ground::new(Settings { start_m: [20.0, 0.0], ..inside });
        ground.wait(3.0);
        if kind == COPTER {
            assert_eq!(ground.set_mode(Mode::Guided), ACCEPTED);
        }
        assert_ne!(ground.arm(), ACCEPTED);
        let said = if kind == PX4 { "Geofence violation" } else { "Vehicle breaching Polygon fence" };
        assert!(ground.has_text(said), "{:?}", ground.texts());
    }
}

#[test]
fn the_origin_is_told_to_whoever_asks_once_it_is_known() {
    for kind in [PX4, COPTER] {
        let mut ground = Ground::of(kind);
        ground.wait(1.0);
        ground.command(512, [49.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!(ground.count(49), 0, "{kind:?}: there is none yet");
        ground.wait(2.0);
        ground.forget();
        assert_eq!(ground.command(512, [49.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]), ACCEPTED);
        let origin = ground.last(49).unwrap();
        assert_eq!((origin.i32(0), origin.i32(4), origin.i32(8)), (473_977_420, 85_455_940, 488_000));
    }
}

/// 10 microseconds since 2015 at the boot of a vehicle as its settings have it.
const BOOT: u64 = 27_992_960_000_000;

/// REQUEST_MESSAGE of AUTOPILOT_VERSION, signed at so many seconds after the boot.
fn signed(key: u8, seconds: u64) -> Vec<u8> {
    let mut raw = MAVLinkV2MessageRaw::new();
    let message = MavMessage::COMMAND_LONG(COMMAND_LONG_DATA {
        target_system: 1,
        target_component: 1,
        command: MavCmd::MAV_CMD_REQUEST_MESSAGE,
        param1: 148.0,
        ..COMMAND_LONG_DATA::default()
    });
    let header = MavHeader { system_id: 255, component_id: 190, sequence: 0 };
    raw.serialize_message_for_signing(header, &message);
    let time = BOOT + 100_000 * seconds;
    raw.signature_timestamp_bytes_mut().copy_from_slice(&time.to_le_bytes()[..6]);
    let mut signature = [0; 6];
    raw.calculate_signature(&[key; 32], &mut signature);
    let mut bytes = raw.raw_bytes().to_vec();
    let tail = bytes.len() - signature.len();
    bytes[tail..].copy_from_slice(&signature);
    bytes
}

/// Whether it answers.
fn answers(ground: &mut Ground, bytes: &[u8]) -> bool {
    let before = ground.count(77);
    ground.vehicle.receive(ground.link, bytes, ground.now);
    ground.wait(0.1);
    ground.count(77) > before
}

fn are_signed(ground: &Ground) -> bool {
    ground.received.iter().all(|(_, _, bytes)| bytes[2] & 1 == 1)
}

#[test]
fn with_a_key_only_what_is_signed_with_it_is_believed() {
    for kind in [PX4, COPTER] {
        let key = SigningKey::from_bytes([7; 32]);
        let mut ground = Ground::new(Settings { signing_key: Some(key), ..settings(kind) });
        // ArduPilot believes everything on its first link
        assert_eq!(ground.command(512, [148.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]) == ACCEPTED, kind == COPTER);
        ground.link = ground.vehicle.open_link(LinkRole::GroundStation);
        ground.forget();
        ground.wait(1.5);
        assert_ne!(ground.command(512, [148.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]), ACCEPTED, "not signed");
        assert!(answers(&mut ground, &signed(7, 2)));
        assert!(!answers(&mut ground, &signed(7, 2)), "played back");
        assert!(!answers(&mut ground, &signed(8, 3)), "another key");
        assert!(answers(&mut ground, &signed(7, 4)));
        assert!(ground.count(0) > 0 && are_signed(&ground));
    }
}

#[test]
fn a_ground_station_sets_up_signing_on_ardupilot_and_ends_it_but_not_in_flight() {
    let set_up = |key: u8, begins: u64| {
        MavMessage::SETUP_SIGNING(SETUP_SIGNING_DATA {
            target_system: 1,
            target_component: 1,
            initial_timestamp: begins,
            secret_key: [key; 32],
        })
    };
    let mut ground = Ground::of(COPTER);
    ground.send(&set_up(7, BOOT));
    ground.forget();
    ground.wait(1.5);
    assert!(ground.count(0) > 0 && are_signed(&ground));
    ground.link = ground.vehicle.open_link(LinkRole::GroundStation);
    assert!(!answers(&mut ground, &signed(8, 2)) && answers(&mut ground, &signed(7, 2)));
    ground.link = mavid::sitl::LinkId(0);
    ground.send(&set_up(0, 0));
    ground.forget();
    ground.wait(1.5);
    assert!(ground.count(0) > 0 && !are_signed(&ground));
    ground.take_off(2.0);
    ground.send(&set_up(7, BOOT));
    ground.wait(1.5);
    assert!(ground.has_text("Won't setup signing when armed") && !are_signed(&ground));
    // PX4 1.16 has none to set up
    let mut ground = Ground::of(PX4);
    ground.send(&set_up(7, BOOT));
    ground.wait(1.5);
    assert!(!are_signed(&ground));
}
