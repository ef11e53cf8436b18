//! ArduCopter: GUIDED, its timeouts and limits, arming, parameters of both releases.

use mavid::sitl::{Fault, LinkRole, Mode, Settings};
use mavlink::dialects::ardupilotmega::MavFrame;

use crate::ground::{Ground, Target, attitude_target, settings};
use crate::{ACCEPTED, COPTER, COPTER_4_6, DENIED, FAILED, assert_at};

fn with(parameters: &[(&str, f64)]) -> Settings {
    let parameters = parameters.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect();
    Settings { parameters, ..settings(COPTER) }
}

/// In GUIDED at 3 m over the start.
fn guided(settings: Settings) -> Ground {
    let mut ground = Ground::new(settings);
    ground.take_off(3.0);
    ground.forget();
    ground
}

#[test]
fn takes_off_in_guided_flies_to_a_position_and_lands() {
    let mut ground = guided(settings(COPTER));
    ground.stream(12.0, &Target::at([2.0, -1.5, -2.0]).message());
    assert_eq!(ground.mode(), Some(Mode::Guided));
    assert_at(&ground, [2.0, -1.5, -2.0], 0.1);
    assert_eq!(ground.last(245).unwrap().u8(1), 2, "in the air");
    assert_eq!(ground.set_mode(Mode::Land), ACCEPTED);
    ground.wait(14.0);
    assert!(!ground.is_armed(), "{:?} {:?}", ground.position(), ground.texts());
    assert_at(&ground, [2.0, -1.5, 0.0], 0.2);
    assert_eq!(ground.last(245).unwrap().u8(1), 1, "on the ground");
    assert_eq!(ground.mode(), Some(Mode::Land), "it stays in LAND");
    assert_eq!(ground.arm(), FAILED);
    assert!(ground.has_text("LAND mode not armable"));
}

#[test]
fn nothing_comes_unasked_but_heartbeat_timesync_and_texts() {
    let mut ground = Ground::of(COPTER);
    ground.wait(12.0);
    assert!((12..=13).contains(&ground.count(0)), "{}", ground.count(0));
    assert!(ground.count(111) > 0);
    assert!(ground.received.iter().all(|(_, id, _)| [0, 111, 253].contains(id)));
}

#[test]
fn the_pre_arm_bit_depends_on_the_mode_and_guided_waits_for_a_position() {
    let mut ground = Ground::of(COPTER);
    ground.set_interval(1, 10.0);
    ground.set_interval(32, 10.0);
    ground.set_interval(193, 10.0);
    ground.wait(1.0);
    let pre_arm = |ground: &Ground| ground.last(1).unwrap().u32(8) & 0x1000_0000 != 0;
    assert_eq!(ground.mode(), Some(Mode::Stabilize));
    assert!(pre_arm(&ground), "good in STABILIZE");
    assert_eq!(ground.set_mode(Mode::Guided), ACCEPTED, "disarmed, any mode may be chosen");
    ground.wait(0.2);
    assert!(!pre_arm(&ground));
    assert_eq!(ground.arm(), FAILED);
    assert!(ground.has_text("Need Position Estimate"));
    assert_eq!(ground.count(32), 0);
    assert!(ground.last(193).unwrap().u16(20) & 128 != 0, "constant position");
    ground.wait(1.5);
    assert!(ground.has_text("EKF3 IMU0 is using GPS"));
    assert!(ground.count(32) > 0 && pre_arm(&ground));
    assert_eq!(ground.last(193).unwrap().u16(20) & (16 | 128), 16);
    assert_eq!(ground.arm(), ACCEPTED);
    ground.wait(9.5);
    assert!(ground.is_armed());
    ground.wait(2.0);
    assert!(!ground.is_armed(), "DISARM_DELAY");
}

#[test]
fn its_own_warm_up_takes_forty_one_seconds() {
    let mut ground = Ground::new(Settings { warm_up: None, ..settings(COPTER) });
    ground.wait(40.5);
    assert!(!ground.has_text("using GPS"));
    ground.wait(1.0);
    assert!(ground.has_text("using GPS"));
}

#[test]
fn setpoints_before_the_takeoff_are_ignored_and_the_takeoff_has_conditions() {
    let mut ground = Ground::of(COPTER);
    ground.set_interval(32, 10.0);
    ground.wait(3.0);
    let takeoff = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 3.0];
    assert_eq!(ground.command(22, takeoff), FAILED, "not in GUIDED");
    assert_eq!(ground.set_mode(Mode::Guided), ACCEPTED);
    assert_eq!(ground.command(22, takeoff), FAILED, "not armed");
    assert_eq!(ground.arm(), ACCEPTED);
    ground.stream(4.0, &Target::at([0.0, 0.0, -3.0]).message());
    assert_at(&ground, [0.0, 0.0, 0.0], 0.1);
    assert_eq!(ground.command(22, [0.0; 7]), FAILED, "no height");
    assert_eq!(ground.command(22, takeoff), ACCEPTED);
    ground.wait(8.0);
    assert_at(&ground, [0.0, 0.0, -3.0], 0.3);
    assert_eq!(ground.command(22, takeoff), FAILED, "in the air already");
}

#[test]
fn a_last_velocity_is_kept_for_three_seconds_then_it_holds_and_stays_in_guided() {
    let mut ground = guided(settings(COPTER));
    ground.stream(4.0, &Target::moving([1.0, 0.0, 0.0]).message());
    let there = ground.position()[0];
    ground.wait(2.5);
    let later = ground.position()[0];
    assert!(later - there > 2.0, "{there} {later}");
    ground.wait(4.0);
    let stopped = ground.position()[0];
    ground.wait(3.0);
    assert!((ground.position()[0] - stopped).abs() < 0.15, "{stopped} {}", ground.position()[0]);
    assert_eq!(ground.mode(), Some(Mode::Guided));
}

#[test]
fn a_last_place_is_moved_on_by_its_velocity_and_acceleration_for_three_seconds() {
    for (velocity, acceleration, on_m) in [(1.0, 0.0, 3.0), (0.0, 0.5, 2.25), (0.0, 0.0, 0.0)] {
        let mut ground = guided(settings(COPTER));
        let last = Target {
            velocity: [velocity, 0.0, 0.0],
            acceleration: [acceleration, 0.0, 0.0],
            ..Target::at([2.0, 0.0, -3.0])
        };
        ground.send(&last.message());
        ground.wait(12.0);
        // the place to which it was moved stays when the time-out makes the rest zero
        assert_at(&ground, [2.0 + on_m, 0.0, -3.0], 0.3);
        assert_eq!(ground.mode(), Some(Mode::Guided));
    }
}

#[test]
fn any_bit_of_a_group_ignores_the_whole_vector() {
    let mut ground = guided(settings(COPTER));
    // one bit of the position, all of the acceleration: velocity alone
    let target = Target {
        mask: 0b001 | 0b111 << 6 | 1 << 11,
        velocity: [0.0, 0.5, 0.0],
        ..Target::at([50.0, 50.0, -50.0])
    };
    ground.stream(5.0, &target.message());
    let [north, east, down] = ground.position();
    assert!(
        north.abs() < 0.3 && (1.5..3.0).contains(&east) && (down + 3.0).abs() < 0.4,
        "{north} {east} {down}"
    );
}

#[test]
fn what_it_cannot_use_stops_it() {
    let moving = Target::moving([1.0, 0.0, 0.0]);
    let useless = [
        Target { mask: moving.mask | 1 << 9, ..moving },
        Target { frame: MavFrame::MAV_FRAME_GLOBAL, ..moving },
        Target { velocity: [f32::NAN, 0.0, 0.0], ..moving },
        Target { mask: 0b1_1111_1111, ..moving },
    ];
    for stop in useless {
        let mut ground = guided(settings(COPTER));
        ground.stream(3.0, &moving.message());
        ground.send(&stop.message());
        ground.wait(2.0);
        let stopped = ground.position()[0];
        ground.wait(1.0);
        assert!((ground.position()[0] - stopped).abs() < 0.15, "{} {stopped}", stop.mask);
    }
}

#[test]
fn offsets_count_from_where_it_is() {
    let mut ground = guided(settings(COPTER));
    let step = Target {
        mask: 0b1_1111_1000,
        frame: MavFrame::MAV_FRAME_LOCAL_OFFSET_NED,
        ..Target::at([1.0, 0.0, 0.0])
    };
    ground.send(&step.message());
    ground.wait(6.0);
    assert_at(&ground, [1.0, 0.0, -3.0], 0.2);
    ground.send(&step.message());
    ground.wait(6.0);
    assert_at(&ground, [2.0, 0.0, -3.0], 0.25);
}

#[test]
fn a_destination_beyond_the_fence_is_dropped_in_silence() {
    let mut ground = guided(with(&[("FENCE_ENABLE", 1.0), ("FENCE_RADIUS", 5.0), ("FENCE_ALT_MAX", 6.0)]));
    for outside in [[8.0, 0.0, -3.0], [0.0, 0.0, -8.0]] {
        ground.stream(4.0, &Target::at(outside).message());
        assert_at(&ground, [0.0, 0.0, -3.0], 0.2);
    }
    assert!(ground.texts().is_empty(), "{:?}", ground.texts());
    ground.stream(8.0, &Target::at([4.0, 0.0, -3.0]).message());
    assert_at(&ground, [4.0, 0.0, -3.0], 0.2);
}

/// Distance (m, root mean square) from a lively reference, 2 m at 1.6 rad/s and 5 m/s^2, apart from the delay
/// with which any vehicle follows.
fn lively(settings: Settings) -> f64 {
    let mut ground = guided(settings);
    let (mut asked, mut flown) = (Vec::new(), Vec::new());
    ground.set_interval(32, 100.0);
    for step in 0..700_u16 {
        let (sin, cos) = (1.6 * f32::from(step) * 0.02).sin_cos();
        let target = Target {
            velocity: [3.2 * cos, 0.0, 0.0],
            acceleration: [-5.12 * sin, 0.0, 0.0],
            ..Target::at([2.0 * sin, 0.0, -3.0])
        };
        ground.send(&target.message());
        asked.push(f64::from(2.0 * sin));
        ground.wait(0.02);
        flown.push(ground.position()[0]);
    }
    let missed = |delay: usize| {
        let pairs = asked.iter().zip(&flown[delay..]).skip(300);
        let squares: Vec<f64> = pairs.map(|(asked, flown)| (asked - flown).powi(2)).collect();
        (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
    };
    (0..25).map(missed).fold(f64::INFINITY, f64::min)
}

#[test]
fn its_limits_in_guided_make_it_miss_a_lively_trajectory_unless_they_are_raised() {
    let limited = lively(settings(COPTER));
    let raised = lively(with(&[("WP_ACC", 20.0), ("PSC_NE_JERK", 100.0), ("WP_SPD", 20.0)]));
    assert!(limited > 2.0 * raised && raised < 0.3, "{limited} {raised}");
    let old = Settings {
        parameters: [("WPNAV_ACCEL", 2000.0), ("PSC_JERK_XY", 100.0), ("WPNAV_SPEED", 2000.0)]
            .map(|(name, value)| (name.to_owned(), value))
            .into(),
        ..settings(COPTER_4_6)
    };
    let old = lively(old);
    // its law of a position error is another, and hardly matters to what is fed forward
    assert!((old - raised).abs() < 0.05, "the same by the names and units of 4.6: {old} {raised}");
}

#[test]
fn without_yaw_it_turns_to_where_it_flies_and_with_yaw_it_does_not() {
    let heading = |mask: u16| {
        let mut ground = guided(settings(COPTER));
        ground.set_interval(30, 20.0);
        let target = Target { mask, ..Target::moving([0.0, 2.0, 0.0]) };
        ground.stream(5.0, &target.message());
        ground.last(30).unwrap().f32(12)
    };
    let group = 0b111 | 0b111 << 6;
    let turned = heading(group | 1 << 10 | 1 << 11);
    assert!((turned - std::f64::consts::FRAC_PI_2).abs() < 0.15, "{turned}");
    let kept = heading(group | 1 << 11);
    assert!(kept.abs() < 0.1, "{kept}");
}

#[test]
fn brake_stops_it_and_a_pilot_takes_over() {
    let mut ground = guided(settings(COPTER));
    let moving = Target::moving([2.0, 0.0, 0.0]).message();
    ground.stream(3.0, &moving);
    assert_eq!(ground.set_mode(Mode::Brake), ACCEPTED);
    ground.stream(3.0, &moving);
    let stopped = ground.position()[0];
    ground.stream(2.0, &moving);
    assert!((ground.position()[0] - stopped).abs() < 0.15);
    assert_eq!(ground.heartbeat().0, 17);
    assert_eq!(ground.set_mode(Mode::Guided), ACCEPTED);
    ground.fault(Fault::PilotTakesOver(Mode::Hold));
    ground.stream(1.2, &moving);
    assert_eq!(ground.mode(), Some(Mode::Hold));
}

#[test]
fn in_the_air_a_mode_that_needs_a_position_fails_without_one() {
    let mut ground = guided(settings(COPTER));
    ground.fault(Fault::EstimatorHealth(false));
    ground.wait(1.1);
    assert_eq!(ground.mode(), Some(Mode::Land), "{:?}", ground.texts());
    assert!(ground.has_text("EKF Failsafe"));
    assert_eq!(ground.set_mode(Mode::Guided), FAILED);
    assert!(ground.has_text("Mode change to GUIDED failed: requires position"));
    assert_eq!(ground.disarm(), FAILED, "in the air");
}

#[test]
fn only_the_heartbeats_of_its_ground_station_count() {
    let parameters = [("FS_GCS_ENABLE", 5.0), ("MAV_GCS_SYSID", 254.0)];
    let mut ground = guided(with(&parameters));
    ground.wait(7.0);
    assert_eq!(ground.mode(), Some(Mode::Guided), "its station was never heard");
    ground.system = 254;
    ground.wait(1.1);
    ground.system = 255;
    ground.wait(7.0);
    assert_eq!(ground.mode(), Some(Mode::Land));
    assert!(ground.has_text("GCS Failsafe"));
    // by default the loss does nothing
    let mut ground = guided(settings(COPTER));
    ground.beats = false;
    ground.wait(8.0);
    assert_eq!(ground.mode(), Some(Mode::Guided));
}

#[test]
fn a_low_battery_acts_as_its_parameter_says() {
    let mut ground = guided(with(&[("BATT_FS_LOW_ACT", 2.0)]));
    ground.fault(Fault::Battery(0.1));
    ground.wait(1.1);
    assert_eq!(ground.mode(), Some(Mode::Return));
    assert!(ground.has_text("Battery 1 is low"));
    let mut ground = guided(settings(COPTER));
    ground.fault(Fault::Battery(0.05));
    ground.wait(1.1);
    assert_eq!(ground.mode(), Some(Mode::Guided), "by default it warns");
}

#[test]
fn parameters_are_floats_and_have_the_names_of_their_release() {
    for (kind, name, other, value) in [
        (COPTER, "WP_SPD", "WPNAV_SPEED", 10.0),
        (COPTER_4_6, "WPNAV_SPEED", "WP_SPD", 1000.0),
        (COPTER, "ATC_ANGLE_MAX", "ANGLE_MAX", 30.0),
        (COPTER_4_6, "ANGLE_MAX", "ATC_ANGLE_MAX", 3000.0),
        (COPTER, "MAV_SYSID", "SYSID_THISMAV", 1.0),
        (COPTER_4_6, "SYSID_MYGCS", "MAV_GCS_SYSID", 255.0),
        (COPTER, "ARMING_SKIPCHK", "ARMING_CHECK", 0.0),
        (COPTER_4_6, "SR0_EXTRA1", "MAV1_EXTRA1", 0.0),
    ] {
        let mut ground = Ground::of(kind);
        ground.wait(0.1);
        ground.request_parameter(name);
        ground.request_parameter(other);
        assert_eq!(ground.parameter(name).unwrap().f32(0), value, "{name}");
        assert!(ground.parameter(other).is_none(), "{other}");
    }
    let mut ground = Ground::of(COPTER);
    ground.wait(0.1);
    ground.set_parameter("FS_GCS_ENABLE", 2, 5.0_f32.to_le_bytes());
    let answer = ground.parameter("FS_GCS_ENABLE").unwrap();
    assert_eq!((answer.u8(24), answer.f32(0)), (2, 5.0), "an integer as its value");
}

#[test]
fn intervals_have_whole_milliseconds_and_the_too_fast_are_denied() {
    let mut ground = Ground::of(COPTER);
    ground.wait(3.0);
    let rate = |ground: &mut Ground, id| {
        ground.forget();
        ground.wait(4.0);
        ground.count(id) as f64 / 4.0
    };
    for (asked_hz, got_hz) in [(100.0, 100.0), (200.0, 200.0), (250.0, 200.0), (60.0, 57.14)] {
        assert_eq!(ground.set_interval(30, asked_hz), ACCEPTED);
        let got = rate(&mut ground, 30);
        assert!((got - got_hz).abs() < 0.02 * got_hz, "{asked_hz}: {got}");
    }
    assert_eq!(ground.set_interval(30, 400.0), DENIED);
    let kept = rate(&mut ground, 30);
    assert!((kept - 57.14).abs() < 1.0, "the old rate: {kept}");
    for id in [291, 290, 375, 230, 331, 141] {
        ground.forget();
        assert_eq!(ground.set_interval(id, 10.0), DENIED, "{id}");
        assert!(ground.has_text(&format!("No ap_message for mavlink id ({id})")));
    }
    assert_eq!(ground.set_interval(226, 10.0), ACCEPTED, "RPM is accepted");
    assert_eq!(rate(&mut ground, 226), 0.0, "and silent");
    assert_eq!(ground.command(511, [30.0, 1e4, 1.0, 0.0, 0.0, 0.0, 0.0]), DENIED, "param3 is zero");
}

#[test]
fn groups_of_streams_can_be_asked_for() {
    let mut ground = Ground::of(COPTER);
    ground.wait(3.0);
    // group EXTRA1 at 20 Hz, on
    ground.send_raw(66, 148, &[20, 0, 1, 1, 10, 1]);
    ground.forget();
    ground.wait(2.0);
    assert!((39..=41).contains(&ground.count(30)), "{}", ground.count(30));
    ground.send_raw(66, 148, &[20, 0, 1, 1, 10, 0]);
    ground.forget();
    ground.wait(1.0);
    assert_eq!(ground.count(30), 0);
}

#[test]
fn a_download_of_parameters_slows_its_streams() {
    let mut ground = Ground::of(COPTER);
    ground.wait(3.0);
    ground.set_interval(30, 200.0);
    ground.forget();
    ground.send_raw(21, 159, &[1, 1]);
    while ground.count(22) == 0 || ground.received.iter().rev().take(200).any(|(_, id, _)| *id == 22) {
        ground.wait(0.02);
    }
    let values = ground.received.iter().filter(|(_, id, _)| *id == 22);
    let (first, last) = (values.clone().next().unwrap().0, values.clone().next_back().unwrap().0);
    let during =
        ground.received.iter().filter(|(time, id, _)| *id == 30 && *time > first && *time < last).count();
    let rate_hz = during as f64 / (last - first).as_secs_f64();
    assert!((35.0..60.0).contains(&rate_hz), "{rate_hz}");
}

#[test]
fn it_forwards_another_ground_station() {
    let mut ground = Ground::of(COPTER);
    let other = ground.vehicle.open_link(LinkRole::GroundStation);
    ground.wait(0.5);
    ground.system = 254;
    let beat = ground.frame(&crate::ground::heartbeat());
    ground.vehicle.receive(other, &beat, ground.now);
    ground.system = 255;
    ground.wait(0.1);
    let forwarded = ground.received.iter().any(|(_, id, bytes)| *id == 0 && *bytes == beat);
    assert!(forwarded, "byte for byte");
    assert_eq!(ground.mode(), Some(Mode::Stabilize), "and it is not the vehicle's");
}

#[test]
fn an_attitude_is_flown_with_a_climb_rate_or_where_it_is_told_so_with_a_thrust() {
    let lean = 6_f32.to_radians();
    let level = |thrust| attitude_target(0b111, 0.0, [0.0; 3], thrust);
    let mut ground = guided(settings(COPTER));
    ground.set_interval(32, 20.0);
    // nose down by 6 degrees, half a thrust: north, at its height
    ground.stream(2.0, &attitude_target(0b111, -lean, [0.0; 3], 0.5));
    let [north_m, east_m, down_m] = ground.position();
    // g tan(6 degrees) t^2 / 2
    assert!((north_m - 2.06).abs() < 0.5 && east_m.abs() < 0.3, "{north_m} {east_m}");
    assert!((down_m + 3.0).abs() < 0.2, "{down_m}");
    // 0.7: 0.4 of WP_SPD_UP (2.5 m/s); 0.3: 0.4 of WP_SPD_DN (1.5 m/s)
    let mut ground = guided(settings(COPTER));
    ground.set_interval(32, 20.0);
    let sinks_m_s = |ground: &Ground| ground.last(32).unwrap().f32(24);
    ground.stream(3.0, &level(0.7));
    assert!((sinks_m_s(&ground) + 1.0).abs() < 0.15, "{}", sinks_m_s(&ground));
    ground.stream(3.0, &level(0.3));
    assert!((sinks_m_s(&ground) - 0.6).abs() < 0.15, "{}", sinks_m_s(&ground));
    // no more come: level and at its height from GUID_TIMEOUT on
    ground.stream(0.5, &attitude_target(0b111, -lean, [0.0; 3], 0.7));
    ground.wait(6.0);
    let last = ground.last(32).unwrap();
    assert!(last.f32(24).abs() < 0.1, "{}", last.f32(24));
    assert_eq!(ground.mode(), Some(Mode::Guided));
    // a yaw rate without the others, no thrust, no quaternion: it stops where it is
    for useless in
        [attitude_target(0b011, -lean, [0.0; 3], 0.7), attitude_target(0b100_0111, -lean, [0.0; 3], 0.7)]
    {
        let mut ground = guided(settings(COPTER));
        ground.set_interval(32, 20.0);
        ground.stream(2.0, &useless);
        assert_at(&ground, [0.0, 0.0, -3.0], 0.2);
    }
    // thrust as thrust
    let mut ground = guided(with(&[("GUID_OPTIONS", 8.0)]));
    ground.set_interval(32, 20.0);
    ground.request_parameter("MOT_THST_HOVER");
    let hover = mavid::units::narrow(ground.parameter("MOT_THST_HOVER").unwrap().f32(0));
    ground.stream(1.0, &level(0.8 * hover));
    let sunk_m = ground.position()[2] + 3.0;
    // g / 5 t^2 / 2
    assert!((0.5..1.6).contains(&sunk_m), "{sunk_m}");
}

#[test]
fn an_attitude_lifts_off_where_a_position_does_not() {
    let mut ground = Ground::of(COPTER);
    ground.wait(3.0);
    ground.set_interval(32, 20.0);
    assert_eq!(ground.set_mode(Mode::Guided), ACCEPTED);
    assert_eq!(ground.arm(), ACCEPTED);
    ground.stream(2.0, &Target::at([0.0, 0.0, -3.0]).message());
    assert_at(&ground, [0.0, 0.0, 0.0], 0.1);
    ground.stream(3.0, &attitude_target(0b111, 0.0, [0.0; 3], 0.7));
    assert!(ground.position()[2] < -1.5, "{:?}", ground.position());
}

#[test]
fn a_breach_of_the_fence_does_what_its_action_says() {
    let away = Target::moving([2.0, 0.0, 0.0]).message();
    let up = Target::moving([0.0, 0.0, -1.0]).message();
    for (border, action, way, mode, said) in [
        ("FENCE_RADIUS", 1.0, &away, Mode::Return, "Circle fence breached"),
        ("FENCE_RADIUS", 2.0, &away, Mode::Land, "Circle fence breached"),
        ("FENCE_RADIUS", 4.0, &away, Mode::Brake, "Circle fence breached"),
        ("FENCE_RADIUS", 0.0, &away, Mode::Guided, "Circle fence breached"),
        ("FENCE_ALT_MAX", 1.0, &up, Mode::Return, "Max Alt fence breached"),
    ] {
        let mut ground = guided(with(&[("FENCE_ENABLE", 1.0), (border, 6.0), ("FENCE_ACTION", action)]));
        ground.stream(6.5, way);
        assert_eq!(ground.mode(), Some(mode), "{border} {action}: {:?}", ground.texts());
        assert!(ground.has_text(said), "{:?}", ground.texts());
    }
    // of the kinds that are off nothing is kept
    let mut ground = guided(with(&[("FENCE_ENABLE", 1.0), ("FENCE_RADIUS", 6.0), ("FENCE_TYPE", 1.0)]));
    ground.stream(6.5, &away);
    assert_eq!(ground.mode(), Some(Mode::Guided));
}
