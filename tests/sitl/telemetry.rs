//! What the vehicle says of itself: fields, units, noise, agreement of its messages with each other.

use mavid::sitl::{LinkRole, Mode, Settings};
use mavid::wire::{Check, CrcSeeds, Frame};
use mavlink::Message;
use mavlink::dialects::ardupilotmega::MavMessage;

use crate::ground::{Ground, Target, settings};
use crate::{ACCEPTED, COPTER, PX4};

#[test]
fn every_message_is_one_of_the_dialect_and_says_what_was_meant() {
    for kind in [PX4, COPTER] {
        let mut ground = Ground::new(Settings { esc_telemetry: true, transmitter: true, ..settings(kind) });
        ground.take_off(2.0);
        for id in [
            1, 2, 24, 27, 31, 32, 33, 36, 49, 65, 74, 83, 85, 105, 116, 141, 147, 148, 193, 230, 242, 245,
            290, 291, 331, 375, 436, 11030,
        ] {
            ground.command(512, [id as f32, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        }
        ground.wait(1.0);
        let seeds = CrcSeeds::new();
        let frames = || ground.received.iter().filter_map(|(_, _, bytes)| Frame::at_start(bytes));
        assert!(frames().all(|frame| frame.check(&seeds) != Check::Wrong));
        let known = frames().filter(|frame| frame.check(&seeds) == Check::Right).count();
        let typed = ground.typed();
        assert_eq!(typed.len(), known, "each is read by the dialect, enumerations and all");
        for message in &typed {
            match message {
                MavMessage::HEARTBEAT(beat) => assert_eq!(beat.mavlink_version, 3),
                MavMessage::GLOBAL_POSITION_INT(place) => {
                    assert!((place.lat - 473_977_420).abs() < 200 && (place.lon - 85_455_940).abs() < 200);
                    assert!((place.alt - 488_000 - place.relative_alt).abs() < 300);
                }
                MavMessage::BATTERY_STATUS(battery) => {
                    assert!((15_000..16_500).contains(&battery.voltages[0]));
                    assert_eq!(battery.current_battery, -1, "the current is not told");
                }
                MavMessage::ESC_STATUS(esc) => assert!(esc.rpm.iter().all(|rpm| (0..12_000).contains(rpm))),
                MavMessage::VFR_HUD(hud) => assert!((0..=100).contains(&hud.throttle)),
                _ => {}
            }
        }
        let seen: std::collections::BTreeSet<u32> = typed.iter().map(Message::message_id).collect();
        let own: &[u32] = if kind == PX4 {
            &[
                1, 2, 24, 31, 32, 33, 36, 49, 65, 74, 83, 85, 105, 141, 147, 148, 230, 242, 245, 290, 291,
                331, 375, 436,
            ]
        } else {
            &[1, 2, 24, 27, 31, 32, 33, 36, 49, 65, 74, 83, 85, 116, 147, 148, 193, 242, 245, 11030]
        };
        for id in own {
            assert!(seen.contains(id), "{kind:?} {id}");
        }
    }
}

#[test]
fn servo_outputs_are_pulses_by_the_parameters_and_hover_carries_the_weight() {
    for kind in [PX4, COPTER] {
        let mut ground = Ground::of(kind);
        ground.set_interval(36, 50.0);
        ground.wait(1.0);
        let off = ground.last(36).unwrap().u16(4);
        assert_eq!(off, if kind == PX4 { 900 } else { 1000 });
        ground.take_off(2.0);
        ground.forget();
        ground.wait(2.0);
        let value = |ground: &mut Ground, name: &str| {
            ground.request_parameter(name);
            let payload = ground.parameter(name).unwrap();
            if payload.u8(24) == 6 && kind == PX4 { f64::from(payload.i32(0)) } else { payload.f32(0) }
        };
        let (low, high, expo) = if kind == PX4 {
            let range = (value(&mut ground, "PWM_MAIN_MIN1"), value(&mut ground, "PWM_MAIN_MAX1"));
            assert_eq!(value(&mut ground, "PWM_MAIN_FUNC4"), 104.0);
            assert!(value(&mut ground, "CA_ROTOR0_KM") > 0.0, "counter-clockwise");
            assert!(value(&mut ground, "CA_ROTOR0_PY") > 0.0, "right");
            (range.0, range.1, value(&mut ground, "THR_MDL_FAC"))
        } else {
            let (min, max) = (value(&mut ground, "MOT_PWM_MIN"), value(&mut ground, "MOT_PWM_MAX"));
            let spin = (value(&mut ground, "MOT_SPIN_MIN"), value(&mut ground, "MOT_SPIN_MAX"));
            assert_eq!(value(&mut ground, "SERVO4_FUNCTION"), 36.0);
            assert_eq!((value(&mut ground, "FRAME_CLASS"), value(&mut ground, "FRAME_TYPE")), (1.0, 1.0));
            let span = max - min;
            (min + spin.0 * span, min + spin.1 * span, value(&mut ground, "MOT_THST_EXPO"))
        };
        let mut share = Vec::new();
        for (_, _, bytes) in ground.received.iter().filter(|(_, id, _)| *id == 36) {
            let payload = Frame::at_start(bytes).unwrap().payload();
            for rotor in 0..4 {
                let u = (f64::from(payload.u16(4 + 2 * rotor)) - low) / (high - low);
                share.push((1.0 - expo) * u + expo * u * u);
            }
        }
        let mean = share.iter().sum::<f64>() / share.len() as f64;
        // the vehicle's file: 2.0643 kg on four rotors of 8.54858e-6 (1000 rad/s)^2
        let hover = 2.0643 * 9.81 / (4.0 * 8.548_58);
        // its rotors slow down in twice the time in which they speed up: a command that jitters carries a percent more
        assert!((0.98..1.005).contains(&(mean / hover)), "{mean} {hover}");
    }
}

#[test]
fn px4_sends_the_same_pulses_in_both_actuator_messages() {
    let mut ground = Ground::of(PX4);
    assert_eq!(ground.set_interval(36, 250.0), ACCEPTED);
    assert_eq!(ground.set_interval(375, 250.0), ACCEPTED);
    ground.take_off(2.0);
    let pulses = |id: u32, at: usize| {
        let of = move |payload: mavid::wire::Payload| match id {
            36 => f64::from(payload.u16(4 + 2 * at)),
            _ => payload.f32(12 + 4 * at),
        };
        ground
            .received
            .iter()
            .filter(|(_, got, _)| *got == id)
            .map(|(time, _, bytes)| (*time, of(Frame::at_start(bytes).unwrap().payload())))
            .collect::<std::collections::BTreeMap<_, _>>()
    };
    let (servo, status) = (pulses(36, 1), pulses(375, 1));
    let common = servo.iter().filter(|(time, pulse)| status.get(time) == Some(pulse)).count();
    assert!(common > 1000 && common + 2 > servo.len(), "{common} of {}", servo.len());
    assert!(ground.last(375).unwrap().u32(8) == 4, "a number of outputs, not a mask");
}

#[test]
fn attitude_messages_agree_and_the_accelerometer_feels_the_weight() {
    let mut ground = Ground::new(settings(PX4));
    ground.link = ground.vehicle.open_link(LinkRole::Onboard);
    ground.take_off(2.0);
    ground.set_mode(Mode::Guided);
    ground.stream(3.0, &Target { yaw: 0.7, ..Target::at([0.0, 0.0, -2.0]) }.message());
    assert_eq!(ground.set_mode(Mode::Guided), ACCEPTED);
    ground.stream(5.0, &Target { yaw: 0.7, ..Target::at([0.0, 0.0, -2.0]) }.message());
    let yaw = ground.last(30).unwrap().f32(12);
    let [w, x, y, z] = ground.last(31).unwrap().f32s(4);
    let by_quaternion = (2.0 * (w * z + x * y)).atan2(1.0 - 2.0 * (y * y + z * z));
    assert!((yaw - 0.7).abs() < 0.05 && (by_quaternion - yaw).abs() < 0.02, "{yaw} {by_quaternion}");
    let down: Vec<f64> = ground
        .received
        .iter()
        .rev()
        .filter(|(_, id, _)| *id == 105)
        .take(100)
        .map(|(_, _, bytes)| Frame::at_start(bytes).unwrap().payload().f32(16))
        .collect();
    let mean = down.iter().sum::<f64>() / 100.0;
    let scatter = (down.iter().map(|a| (a - mean).powi(2)).sum::<f64>() / 100.0).sqrt();
    assert!((mean + 9.81).abs() < 0.1, "{mean}");
    assert!((0.06..0.4).contains(&scatter), "{scatter}");
}

#[test]
fn ardupilots_inertial_unit_counts_in_milli_g() {
    let mut ground = Ground::of(COPTER);
    ground.set_interval(27, 50.0);
    ground.wait(3.0);
    let imu = ground.last(27).unwrap();
    assert!((i32::from(imu.i16(12)) + 1000).abs() < 60, "{}", imu.i16(12));
    assert!(imu.i16(14).abs() < 40);
}

#[test]
fn a_quiet_vehicle_has_no_noise_and_a_standing_one_stands() {
    let base = settings(PX4);
    let sensors = mavid::sitl::SensorSettings { noise_scale: 0.0, ..base.sensors };
    let mut ground = Ground::new(Settings { sensors, ..base });
    ground.wait(4.0);
    let first = ground.position();
    assert!(first.iter().all(|value| value.abs() < 1e-3), "{first:?}");
    ground.wait(2.0);
    let last = ground.position();
    assert!(first.iter().zip(last).all(|(a, b)| (a - b).abs() < 1e-6));
}
