//! PX4: OFFBOARD, its failsafes, arming, parameters.

use mavid::sitl::{Fault, Mode, Settings};
use mavlink::dialects::ardupilotmega::MavFrame;

use crate::ground::{Ground, Target, attitude_target, settings};
use crate::{ACCEPTED, DENIED, FAILED, PX4, TEMPORARILY_REJECTED, assert_at};

/// In OFFBOARD at 3 m over the start.
fn offboard(settings: Settings) -> Ground {
    let mut ground = Ground::new(settings);
    ground.wait(3.0);
    let hover = Target::at([0.0, 0.0, -3.0]).message();
    ground.stream(1.5, &hover);
    assert_eq!(ground.set_mode(Mode::Guided), ACCEPTED);
    assert_eq!(ground.arm(), ACCEPTED, "{:?}", ground.texts());
    ground.stream(6.0, &hover);
    assert_at(&ground, [0.0, 0.0, -3.0], 0.2);
    ground.forget();
    ground
}

fn with(parameters: &[(&str, f64)]) -> Settings {
    let parameters = parameters.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect();
    Settings { parameters, ..settings(PX4) }
}

#[test]
fn flies_offboard_to_a_position_and_lands_and_disarms() {
    let mut ground = offboard(settings(PX4));
    let goal = Target::at([2.0, -1.5, -2.0]).message();
    ground.stream(12.0, &goal);
    assert_eq!(ground.mode(), Some(Mode::Guided));
    assert_at(&ground, [2.0, -1.5, -2.0], 0.1);
    assert_eq!(ground.command(21, [0.0; 7]), ACCEPTED);
    ground.wait(12.0);
    assert!(!ground.is_armed(), "{:?} {:?}", ground.position(), ground.texts());
    assert_at(&ground, [2.0, -1.5, 0.0], 0.2);
    assert!(ground.has_text("Landing detected") && ground.has_text("Disarmed by landing"));
    // a landing is over: the mode is the one before
    assert_eq!(ground.mode(), Some(Mode::Guided));
}

#[test]
fn offboard_needs_a_stream_when_armed_and_arming_needs_it_when_not() {
    let mut ground = Ground::of(PX4);
    ground.wait(3.0);
    assert_eq!(ground.set_mode(Mode::Guided), ACCEPTED, "disarmed, any mode may be chosen");
    assert_eq!(ground.arm(), TEMPORARILY_REJECTED);
    assert!(
        ground.has_text("No offboard signal") && ground.has_text("Arming denied"),
        "{:?}",
        ground.texts()
    );
    assert_eq!(ground.set_mode(Mode::Hold), ACCEPTED);
    assert_eq!(ground.arm(), ACCEPTED);
    assert_eq!(ground.set_mode(Mode::Guided), TEMPORARILY_REJECTED);
    assert!(ground.has_text("Switching to Offboard is currently not available"));
    // two setpoints a second are enough
    let hover = Target::at([0.0, 0.0, -2.0]).message();
    for _ in 0..3 {
        ground.send(&hover);
        ground.wait(0.5);
    }
    assert_eq!(ground.set_mode(Mode::Guided), ACCEPTED);
}

#[test]
fn a_message_that_asks_for_nothing_is_no_proof_of_life() {
    let mut ground = Ground::of(PX4);
    ground.wait(3.0);
    assert_eq!(ground.arm(), ACCEPTED);
    let here = Target::at([0.0, 0.0, -2.0]);
    let useless = [
        Target { mask: 0b1_1111_1111, ..here },
        Target { mask: 1 << 9, ..here },
        Target { frame: MavFrame::MAV_FRAME_LOCAL_OFFSET_NED, ..here },
    ];
    for target in useless {
        ground.stream(1.5, &target.message());
        assert_eq!(ground.set_mode(Mode::Guided), TEMPORARILY_REJECTED, "{}", target.mask);
    }
    assert!(ground.has_text("coordinate frame 7 unsupported"), "{:?}", ground.texts());
}

#[test]
fn without_setpoints_it_leaves_offboard_descends_and_comes_back_by_itself() {
    let mut ground = offboard(settings(PX4));
    ground.wait(0.9);
    assert_eq!(ground.mode(), Some(Mode::Guided));
    ground.wait(1.6);
    assert_eq!(ground.mode(), Some(Mode::Position));
    assert_eq!(ground.heartbeat().0, 3 << 16);
    assert!(ground.has_text("Failsafe activated"));
    assert_eq!(ground.heartbeat().2, 5, "critical");
    let down = ground.position()[2];
    assert!((-2.9..-0.5).contains(&down), "it descends: {down}");
    ground.wait(0.4);
    assert_eq!(ground.command(512, [436.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]), ACCEPTED);
    let intended = ground.last(436).unwrap();
    assert_eq!((intended.u32(0), intended.u32(4)), (3 << 16, 6 << 16));
    let hover = Target::at([0.0, 0.0, -3.0]).message();
    ground.stream(6.0, &hover);
    assert_eq!(ground.mode(), Some(Mode::Guided));
    assert_at(&ground, [0.0, 0.0, -3.0], 0.2);
}

#[test]
fn the_loss_of_setpoints_does_what_the_parameters_say() {
    for (action, mode) in [(3.0, Mode::Return), (4.0, Mode::Land), (5.0, Mode::Hold)] {
        let mut ground = offboard(with(&[("COM_OBL_RC_ACT", action), ("COM_OF_LOSS_T", 0.3)]));
        ground.wait(1.3);
        assert_eq!(ground.mode(), Some(mode));
    }
    let mut ground = offboard(with(&[("COM_OBL_RC_ACT", 7.0)]));
    ground.wait(3.0);
    assert!(!ground.is_armed(), "disarmed in the air");
    ground.wait(2.0);
    assert!(ground.position()[2] > -0.3, "and fallen");
    let mut ground = offboard(Settings { transmitter: true, ..settings(PX4) });
    ground.wait(4.0);
    assert_eq!(ground.mode(), Some(Mode::Position));
    assert_at(&ground, [0.0, 0.0, -3.0], 0.3);
}

#[test]
fn a_pilot_who_takes_over_keeps_it() {
    let mut ground = offboard(settings(PX4));
    ground.fault(Fault::PilotTakesOver(Mode::Position));
    let away = Target::at([5.0, 0.0, -3.0]).message();
    ground.stream(3.0, &away);
    assert_eq!(ground.mode(), Some(Mode::Position));
    assert_at(&ground, [0.0, 0.0, -3.0], 0.3);
    assert_eq!(ground.set_mode(Mode::Guided), ACCEPTED);
    ground.stream(3.0, &away);
    assert!(ground.position()[0] > 2.0);
}

#[test]
fn it_does_not_arm_before_its_position_is_good() {
    let mut ground = Ground::of(PX4);
    ground.wait(1.0);
    assert_eq!(ground.count(32), 0, "no local position yet");
    assert_eq!(ground.arm(), TEMPORARILY_REJECTED);
    assert!(ground.has_text("Preflight Fail: ekf2 missing data"));
    ground.wait(1.5);
    assert!(ground.count(32) > 0);
    assert_eq!(ground.arm(), ACCEPTED);
    ground.wait(9.0);
    assert!(ground.is_armed());
    ground.wait(2.0);
    assert!(!ground.is_armed(), "COM_DISARM_PRFLT");
}

#[test]
fn a_ground_station_is_needed_for_arming_where_its_loss_has_an_action() {
    let mut ground = Ground::new(with(&[("NAV_DLL_ACT", 2.0), ("COM_DL_LOSS_T", 3.0)]));
    ground.beats = false;
    ground.wait(3.0);
    assert_eq!(ground.arm(), TEMPORARILY_REJECTED);
    assert!(ground.has_text("No connection to the ground control station"));
    ground.beats = true;
    ground.wait(1.1);
    ground.take_off(3.0);
    ground.beats = false;
    ground.wait(2.0);
    assert_eq!(ground.mode(), Some(Mode::Hold));
    ground.wait(3.0);
    assert!(ground.has_text("Connection to ground control station lost"));
    assert!(ground.has_text("Failsafe activated: entering Hold for 5 seconds"));
    assert_eq!(ground.mode(), Some(Mode::Hold));
    ground.wait(5.0);
    assert_eq!(ground.mode(), Some(Mode::Return));
}

#[test]
fn each_axis_is_ignored_by_its_own_bit() {
    let mut ground = offboard(settings(PX4));
    // north and east by velocity, down by position
    let mixed = Target {
        mask: 0b011 | 0b100 << 3 | 0b111 << 6,
        velocity: [0.5, 0.0, 9.0],
        ..Target::at([9.0, 9.0, -3.5])
    };
    ground.stream(6.0, &mixed.message());
    let [north, east, down] = ground.position();
    assert!((2.2..3.2).contains(&north) && east.abs() < 0.3, "{north} {east}");
    assert!((down + 3.5).abs() < 0.2, "{down}");
    // x and y must come in pairs: such a setpoint is not flown
    let unpaired = Target { mask: 0b001 | 0b110 << 3 | 0b111 << 6, ..mixed };
    ground.stream(3.0, &unpaired.message());
    let stopped = ground.position();
    ground.stream(2.0, &unpaired.message());
    assert_at(&ground, stopped, 0.2);
    let velocity = Target::moving([0.5, 0.0, 0.0]).message();
    let before = ground.position()[0];
    ground.stream(4.0, &velocity);
    let moved = ground.position()[0] - before;
    assert!((1.2..2.4).contains(&moved), "{moved}");
}

#[test]
fn position_velocity_and_acceleration_count_together() {
    let worst = |mask: u16| {
        let mut ground = offboard(settings(PX4));
        let mut worst: f64 = 0.0;
        // 1.5 m at 1 rad/s
        for step in 0..600_u16 {
            let (sin, cos) = (f32::from(step) * 0.02).sin_cos();
            let target = Target {
                mask,
                velocity: [1.5 * cos, 0.0, 0.0],
                acceleration: [-1.5 * sin, 0.0, 0.0],
                ..Target::at([1.5 * sin, 0.0, -3.0])
            };
            ground.send(&target.message());
            ground.wait(0.02);
            if step > 300 {
                worst = worst.max((ground.position()[0] - f64::from(1.5 * sin)).abs());
            }
        }
        worst
    };
    let (full, position_only) = (worst(0), worst(0b1_1111_1000));
    assert!(full < 0.4, "{full}");
    assert!(position_only > 2.0 * full, "{position_only}");
}

#[test]
fn without_yaw_it_keeps_its_heading_and_with_it_turns() {
    let mut ground = offboard(settings(PX4));
    ground.set_interval(30, 50.0);
    let yaw = |ground: &Ground| ground.last(30).unwrap().f32(12);
    let turned = Target { yaw: 1.0, ..Target::at([0.0, 0.0, -3.0]) };
    ground.stream(4.0, &turned.message());
    assert!((yaw(&ground) - 1.0).abs() < 0.1, "{}", yaw(&ground));
    let unasked = Target { mask: 1 << 10 | 1 << 11, ..Target::at([1.0, 0.0, -3.0]) };
    ground.stream(4.0, &unasked.message());
    assert!((yaw(&ground) - 1.0).abs() < 0.1, "{}", yaw(&ground));
}

#[test]
#[expect(deprecated, reason = "PX4 knows the frame by its number, whatever its name")]
fn body_velocities_turn_with_the_heading() {
    let mut ground = offboard(settings(PX4));
    let east = std::f32::consts::FRAC_PI_2;
    ground.stream(4.0, &Target { yaw: east, ..Target::at([0.0, 0.0, -3.0]) }.message());
    let ahead = Target { frame: MavFrame::MAV_FRAME_BODY_NED, yaw: east, ..Target::moving([0.5, 0.0, 0.0]) };
    ground.stream(4.0, &ahead.message());
    let [north, moved_east, _] = ground.position();
    assert!(moved_east > 1.0 && north.abs() < 0.4, "{north} {moved_east}");
}

#[test]
fn an_attitude_with_a_thrust_is_flown_and_so_are_rates() {
    let mut ground = offboard(settings(PX4));
    ground.request_parameter("MPC_THR_HOVER");
    let hover = mavid::units::narrow(ground.parameter("MPC_THR_HOVER").unwrap().f32(0));
    // nose down by 6 degrees, with the thrust that carries the weight then: it goes north at its height
    let lean = 6_f32.to_radians();
    ground.stream(2.0, &attitude_target(0b111, -lean, [0.0; 3], hover / lean.cos()));
    let [north_m, east_m, down_m] = ground.position();
    // g tan(6 degrees) t^2 / 2
    assert!((north_m - 2.06).abs() < 0.5 && east_m.abs() < 0.3, "{north_m} {east_m}");
    assert!((down_m + 3.0).abs() < 0.4, "{down_m}");
    // level again by the rate about the body's y, then no thrust share that lifts: it sinks
    ground.stream(0.5, &attitude_target(1 << 7, 0.0, [0.0, 2.0 * lean, 0.0], hover));
    assert!((ground.last(30).unwrap().f32(8)).abs() < 0.04, "{:?}", ground.last(30).unwrap().f32(8));
    ground.stream(1.0, &attitude_target(0b111, 0.0, [0.0; 3], 0.8 * hover));
    let sunk_m = ground.position()[2] - down_m;
    // g / 5 t^2 / 2
    assert!((0.5..1.6).contains(&sunk_m), "{sunk_m}");
    // without a thrust, or with nothing to turn to, it is no setpoint: OFFBOARD ends
    for useless in
        [attitude_target(1 << 6, 0.0, [0.0; 3], hover), attitude_target(0b1000_0001, 0.0, [0.0; 3], hover)]
    {
        let mut ground = offboard(settings(PX4));
        ground.stream(1.5, &useless);
        assert!(ground.has_text("No offboard signal"), "{:?}", ground.texts());
    }
}

#[test]
fn a_jump_of_the_estimate_is_counted_and_the_stored_setpoint_goes_with_it() {
    let mut ground = offboard(settings(PX4));
    assert_eq!(ground.set_interval(331, 30.0), ACCEPTED);
    let hover = Target::at([0.0, 0.0, -3.0]).message();
    ground.stream(0.5, &hover);
    let counter = |ground: &Ground| ground.last(331).unwrap().u8(230);
    let before = counter(&ground);
    ground.fault(Fault::EstimatorJump([1.0, 0.0, 0.0]));
    ground.wait(0.2);
    assert_eq!(counter(&ground), before + 1);
    assert!((ground.position()[0] - 1.0).abs() < 0.15, "it stays where it is: the frame has moved");
    // the next setpoint is not shifted
    ground.stream(5.0, &hover);
    assert_at(&ground, [0.0, 0.0, -3.0], 0.15);
}

#[test]
fn its_heading_is_aligned_once_in_a_flight_and_that_is_counted() {
    let mut ground = Ground::new(settings(PX4));
    assert_eq!(ground.set_interval(331, 30.0), ACCEPTED);
    assert_eq!(ground.set_interval(230, 5.0), ACCEPTED);
    ground.wait(3.0);
    let counter = |ground: &Ground| ground.last(331).unwrap().u8(230);
    let constant = |ground: &Ground| ground.last(230).unwrap().u16(40) & 128 != 0;
    let before = counter(&ground);
    assert!(constant(&ground), "it stands");
    let hover = Target::at([0.0, 0.0, -1.0]).message();
    ground.stream(1.5, &hover);
    assert_eq!(ground.set_mode(Mode::Guided), ACCEPTED);
    assert_eq!(ground.arm(), ACCEPTED);
    ground.stream(6.0, &hover);
    assert_eq!((counter(&ground), constant(&ground)), (before, false));
    ground.stream(6.0, &Target::at([0.0, 0.0, -3.0]).message());
    assert_eq!(counter(&ground), before + 1);
    ground.stream(4.0, &hover);
    ground.stream(4.0, &Target::at([0.0, 0.0, -3.0]).message());
    assert_eq!(counter(&ground), before + 1);
}

#[test]
fn a_bad_estimate_ends_offboard_and_shows() {
    let mut ground = offboard(settings(PX4));
    ground.set_interval(230, 10.0);
    ground.set_interval(1, 10.0);
    let hover = Target::at([0.0, 0.0, -3.0]).message();
    ground.stream(1.0, &hover);
    let status = ground.last(230).unwrap();
    assert!(status.f32(12) < 1.0 && status.u16(40) & 16 != 0);
    ground.fault(Fault::EstimatorHealth(false));
    ground.stream(1.2, &hover);
    let status = ground.last(230).unwrap();
    assert!(status.f32(12) > 1.0 && status.u16(40) & 16 == 0);
    assert_eq!(ground.last(1).unwrap().u32(8) & 0x4000, 0, "XY_POSITION_CONTROL");
    assert_eq!(ground.mode(), Some(Mode::Land));
    assert!(ground.has_text("Failsafe activated"));
}

#[test]
fn a_battery_that_gets_low_is_told_and_a_critical_one_acts_where_it_is_told_to() {
    for (action, mode) in [(0.0, Mode::Guided), (3.0, Mode::Return), (2.0, Mode::Land)] {
        let mut ground = offboard(with(&[("COM_LOW_BAT_ACT", action)]));
        ground.set_interval(147, 10.0);
        let hover = Target::at([0.0, 0.0, -3.0]).message();
        ground.fault(Fault::Battery(0.12));
        ground.stream(0.5, &hover);
        assert_eq!(ground.last(147).unwrap().u8(40), 2, "low");
        assert!(ground.has_text("Low battery"));
        assert_eq!(ground.mode().unwrap_or(Mode::Guided), Mode::Guided);
        ground.fault(Fault::Battery(0.05));
        ground.stream(1.5, &hover);
        assert_eq!(ground.last(147).unwrap().u8(40), 3, "critical");
        let first = if mode == Mode::Guided { Mode::Guided } else { Mode::Hold };
        assert_eq!(ground.mode(), Some(first), "it holds for COM_FAIL_ACT_T first");
        ground.stream(5.0, &hover);
        assert_eq!(ground.mode(), Some(mode), "setpoints do not take it back");
    }
}

#[test]
fn it_disarms_in_the_air_only_by_force() {
    let mut ground = Ground::of(PX4);
    ground.take_off(2.0);
    assert_eq!(ground.mode(), Some(Mode::Hold), "a takeoff ends in Hold");
    assert_eq!(ground.disarm(), TEMPORARILY_REJECTED);
    assert!(ground.has_text("Disarming denied: not landed"));
    assert_eq!(ground.command(400, [0.0, 21196.0, 0.0, 0.0, 0.0, 0.0, 0.0]), ACCEPTED);
    ground.wait(1.1);
    assert!(!ground.is_armed());
}

#[test]
fn a_return_climbs_goes_home_and_lands() {
    let mut ground = offboard(with(&[("RTL_RETURN_ALT", 6.0)]));
    ground.stream(10.0, &Target::at([8.0, 0.0, -3.0]).message());
    assert_eq!(ground.command(20, [0.0; 7]), ACCEPTED);
    let mut highest: f64 = 0.0;
    for _ in 0..60 {
        ground.wait(0.5);
        highest = highest.max(-ground.position()[2]);
    }
    assert!(highest > 5.5, "{highest}");
    assert!(!ground.is_armed(), "{:?}", ground.position());
    assert_at(&ground, [0.0, 0.0, 0.0], 0.5);
}

#[test]
fn integer_parameters_are_bytes_and_a_wrong_type_is_refused() {
    let mut ground = Ground::of(PX4);
    ground.wait(0.1);
    ground.request_parameter("COM_OBL_RC_ACT");
    let answer = ground.parameter("COM_OBL_RC_ACT").unwrap();
    assert_eq!((answer.u8(24), answer.i32(0)), (6, 0));
    ground.set_parameter("COM_OBL_RC_ACT", 6, 5_i32.to_le_bytes());
    let answer = ground.parameter("COM_OBL_RC_ACT").unwrap();
    assert_eq!(answer.i32(0), 5);
    assert!(answer.f32(0) < 1e-40, "not a float");
    ground.set_parameter("COM_OBL_RC_ACT", 9, 4.0_f32.to_le_bytes());
    assert!(ground.has_text("param types mismatch"), "{:?}", ground.texts());
    assert_eq!(ground.parameter("COM_OBL_RC_ACT").unwrap().i32(0), 5);
    ground.set_parameter("NO_SUCH_THING", 9, 4.0_f32.to_le_bytes());
    assert!(ground.has_text("unknown param: NO_SUCH_THING"));
    ground.request_parameter("COM_OF_LOSS_T");
    let answer = ground.parameter("COM_OF_LOSS_T").unwrap();
    assert_eq!((answer.u8(24), answer.f32(0)), (9, 1.0));
}

#[test]
fn intervals_are_on_its_grid_and_what_it_never_sends_fails() {
    let mut ground = Ground::of(PX4);
    ground.wait(3.0);
    for (id, asked_hz, got_hz) in
        [(30, 100.0, 100.0), (30, 200.0, 125.0), (105, 250.0, 250.0), (32, 250.0, 125.0), (36, 250.0, 250.0)]
    {
        assert_eq!(ground.set_interval(id, asked_hz), ACCEPTED);
        ground.forget();
        ground.wait(4.0);
        let rate_hz = ground.count(id) as f64 / 4.0;
        assert!((rate_hz - got_hz).abs() < 0.02 * got_hz, "{id} at {asked_hz}: {rate_hz}");
    }
    for id in [27, 11030, 193] {
        assert_eq!(ground.set_interval(id, 10.0), FAILED, "{id}");
    }
    // accepted, and nothing comes: there is no ESC telemetry and no transmitter
    for id in [291, 65] {
        assert_eq!(ground.set_interval(id, 10.0), ACCEPTED, "{id}");
        ground.forget();
        ground.wait(1.0);
        assert_eq!(ground.count(id), 0);
    }
    assert_eq!(
        ground.command(511, [30.0, 1e4, 1.0, 0.0, 0.0, 0.0, 0.0]),
        FAILED,
        "unused parameters are zero"
    );
    assert_eq!(ground.command(512, [27.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]), DENIED);
}

#[test]
fn a_ground_station_and_a_companion_get_different_streams() {
    let mut ground = Ground::of(PX4);
    let onboard = ground.vehicle.open_link(mavid::sitl::LinkRole::Onboard);
    ground.wait(3.0);
    ground.forget();
    ground.wait(4.0);
    let of = |count: usize| count as f64 / 4.0;
    assert_eq!(ground.count(105), 0, "no inertial unit");
    assert!((of(ground.count(36)) - 50.0).abs() < 1.0);
    ground.link = onboard;
    ground.forget();
    ground.wait(4.0);
    for (id, rate_hz) in [(30, 100.0), (105, 50.0), (31, 50.0), (32, 30.0), (331, 30.0), (36, 10.0)] {
        let got = of(ground.count(id));
        assert!((got - rate_hz).abs() < 0.6, "{id}: {got}");
    }
    assert!(ground.count(8) > 0 && ground.count(411) > 0, "ids that older dialects do not know");
}

#[test]
fn a_breach_of_the_fence_holds_at_once_and_returns_or_lands_after_a_delay() {
    let away = Target::moving([2.0, 0.0, 0.0]).message();
    let up = Target::moving([0.0, 0.0, -1.0]).message();
    for (border, action, way, first, then) in [
        ("GF_MAX_HOR_DIST", 2.0, &away, Mode::Hold, Mode::Hold),
        ("GF_MAX_HOR_DIST", 3.0, &away, Mode::Hold, Mode::Return),
        ("GF_MAX_VER_DIST", 5.0, &up, Mode::Hold, Mode::Land),
        ("GF_MAX_HOR_DIST", 1.0, &away, Mode::Guided, Mode::Guided),
        ("GF_MAX_HOR_DIST", 0.0, &away, Mode::Guided, Mode::Guided),
    ] {
        let mut ground = offboard(with(&[(border, 6.0), ("GF_ACTION", action), ("RTL_RETURN_ALT", 4.0)]));
        ground.set_interval(436, 2.0);
        ground.stream(6.5, way);
        assert_eq!(ground.mode(), Some(first), "{border} {action}");
        // the real one's clock: a breach at 3.5 s, five seconds of Hold
        ground.stream(4.0, way);
        assert_eq!(ground.mode(), Some(then), "{border} {action}: {:?}", ground.texts());
        assert_eq!(ground.has_text("Geofence violation: exceeding maximum"), action != 0.0);
        assert_eq!(ground.has_text("Failsafe activated"), first == Mode::Hold);
        let intended = ground.last(436).unwrap().u32(4);
        assert_eq!(Mode::from_custom_mode(PX4, intended), Some(Mode::Guided), "what was asked for stays");
        if first == Mode::Hold {
            assert!(ground.heartbeat().2 == 5, "critical");
            assert_eq!(ground.set_mode(Mode::Hold), ACCEPTED);
            ground.wait(7.0);
            assert_eq!(ground.mode(), Some(Mode::Hold), "whoever chooses a mode has it");
        }
    }
}

#[test]
fn it_rests_in_the_mode_that_was_chosen_last_and_arms_in_it() {
    let mut ground = offboard(settings(PX4));
    assert_eq!(ground.set_mode(Mode::Land), ACCEPTED);
    ground.wait(14.0);
    assert!(!ground.is_armed(), "{:?}", ground.position());
    assert_eq!(ground.mode(), Some(Mode::Guided), "landing is no mode to arm in");
    assert_eq!(ground.arm(), TEMPORARILY_REJECTED, "without setpoints");
    let mut ground = Ground::of(PX4);
    ground.take_off(2.0);
    assert_eq!(ground.set_mode(Mode::Land), ACCEPTED);
    ground.wait(12.0);
    assert!(!ground.is_armed());
    assert_eq!(ground.mode(), Some(Mode::Hold), "as a takeoff ends");
}
