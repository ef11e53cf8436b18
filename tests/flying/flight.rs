//! The whole flight against the embedded vehicle, as both autopilots, and each way in which it may end.

use crate::flying;

use std::time::Duration;

use flying::{Flying, vehicle_settings};
use mavid::autopilot::Autopilot;
use mavid::fly::parameters::Parameters;
use mavid::fly::{Cause, Ending, Event, Key, Lift, Origin, Outcome, Place, Setpoint, Target};
use mavid::sitl::{Fault, Firmware, LinkRole, Mode, Settings as VehicleSettings};
use mavid::wire::{ComponentId, Nonce, SystemId};
use mavlink::dialects::ardupilotmega::{MavMessage, PositionTargetTypemask, TIMESYNC_DATA};
use mavlink::{MAVLinkV2MessageRaw, MavHeader};
use nalgebra::Vector3;

const PX4: Firmware = Firmware::PX4;
const COPTER: Firmware = Firmware::ARDUPILOT_4_7;
const BOTH: [Firmware; 2] = [PX4, COPTER];

const SET_MODE: u32 = 176;
const ARM: u32 = 400;
const AUTOPILOT_VERSION: u32 = 148;
const TIMESYNC: u32 = 111;
const SYS_STATUS: u32 = 1;
const BATTERY_STATUS: u32 = 147;
/// MAV_STATE
const CRITICAL: u8 = 5;

/// In trajectory: a fault, and how the flight ends.
fn after(kind: Firmware, fault: Fault) -> (Flying, Duration) {
    let mut flying = Flying::of(kind);
    flying.fly_into_the_trajectory(5.0);
    let since = flying.now;
    flying.vehicle.fault(fault);
    flying.finish();
    (flying, since)
}

#[test]
fn a_whole_flight_takes_off_flies_lands_and_disarms() {
    for kind in BOTH {
        let mut flying = Flying::of(kind);
        let outcome = flying.finish();
        assert!(outcome.is_whole() && outcome.losses.is_empty(), "{outcome:?} {}", flying.story());
        assert_eq!(outcome.flown.periods, 3);
        assert!(outcome.flown.tracking_rms_m < 0.3, "{:?}", outcome.flown);
        assert!(outcome.flown.tilt_max_deg > 1.0 && outcome.flown.tilt_max_deg < 30.0, "{:?}", outcome.flown);
        assert!(!flying.flight.status(flying.now).armed);
        let (gaps, stale): (Vec<_>, Vec<_>) = (
            flying
                .setpoints
                .windows(2)
                .filter(|pair| pair[1].0 - pair[0].0 != Duration::from_millis(20))
                .collect(),
            flying.setpoints.iter().filter(|(at, setpoint)| *at != setpoint.time).collect(),
        );
        assert!(stale.is_empty());
        assert!(gaps.is_empty(), "{kind:?}: {gaps:?}");
    }
}

#[test]
fn px4_is_given_setpoints_before_offboard_and_the_copter_takes_off_by_command() {
    let mut flying = Flying::of(PX4);
    flying.fly_into_the_trajectory(0.0);
    let engaged = flying.commands.iter().find(|(_, number, _)| *number == SET_MODE).unwrap().0;
    let before = flying.setpoints.iter().filter(|(at, _)| *at < engaged).count();
    assert!(before >= 75, "1.5 s of stream, {before} setpoints");
    let mut flying = Flying::of(COPTER);
    flying.fly_into_the_trajectory(0.0);
    let of = |number: u32| flying.commands.iter().find(|command| command.1 == number).unwrap().0;
    assert!(of(SET_MODE) < of(ARM) && of(ARM) < of(22));
    assert!(flying.setpoints[0].0 > of(22), "setpoints on the ground are ignored");
}

#[test]
fn only_the_vehicle_that_was_given_the_nonce_is_armed_without_the_order() {
    // one that says of itself what the embedded vehicle says, and one that somebody else started
    for nonce in [None, Some(Nonce::random())] {
        let claims = VehicleSettings { nonce, ..vehicle_settings(PX4) };
        let mut flying = Flying::new(claims, |sortie| sortie.own_vehicle = Some(Nonce::random()));
        assert_eq!(flying.finish().ending, Ending::NotFlown);
        assert!(flying.cause().to_string().contains("--arm"), "{}", flying.cause());
        assert_eq!(flying.commands_since(ARM, Duration::ZERO), 0);
        assert_eq!(flying.commands_since(SET_MODE, Duration::ZERO), 0);
    }
    // without a nonce of its own nothing on a link is known
    let claims = VehicleSettings { nonce: None, ..vehicle_settings(PX4) };
    let mut flying = Flying::new(claims, |_| {});
    assert_eq!(flying.finish().ending, Ending::NotFlown);
}

#[test]
fn a_vehicle_that_does_not_say_what_it_is_is_not_armed_without_the_order() {
    let mut flying = Flying::of(PX4);
    flying.swallowed = vec![AUTOPILOT_VERSION];
    let outcome = flying.finish();
    assert_eq!(outcome.ending, Ending::NotFlown);
    assert!(flying.cause().to_string().contains("--arm"), "{}", flying.cause());
    assert_eq!((flying.commands_since(ARM, Duration::ZERO), flying.setpoints.len()), (0, 0));
    assert_eq!(flying.commands_since(SET_MODE, Duration::ZERO), 0);
    let mut flying = Flying::new(vehicle_settings(PX4), |sortie| sortie.may_arm = true);
    flying.swallowed = vec![AUTOPILOT_VERSION];
    assert!(flying.finish().is_whole(), "{}", flying.story());
}

#[test]
fn the_word_for_arming_is_waited_for_as_long_as_it_takes() {
    let mut flying = Flying::new(vehicle_settings(PX4), |sortie| sortie.settings.await_word = true);
    // nobody has asked for it
    assert!(!flying.flight.status(flying.now).awaits_word, "{}", flying.story());
    flying.event(Event::Key(Key::Arm));
    flying.wait(200.0);
    assert!(flying.flight.status(flying.now).awaits_word, "{}", flying.story());
    assert_eq!((flying.phase(), flying.commands_since(ARM, Duration::ZERO)), ("check", 0));
    flying.event(Event::Key(Key::Arm));
    flying.fly_into_the_trajectory(1.0);
}

#[test]
fn no_setpoint_leaves_the_room_whatever_the_trajectory_is() {
    for kind in BOTH {
        let mut flying = Flying::new(vehicle_settings(kind), |sortie| {
            sortie.limits.x_max_m = Some(0.3);
            sortie.limits.z_min_m = Some(1.5);
        });
        flying.finish();
        assert!(flying.setpoints.len() > 500);
        for (_, setpoint) in &flying.setpoints {
            assert!(setpoint.position_m.x.abs() <= 0.3 + 1e-9, "{setpoint:?}");
        }
        let began = flying.notes.iter().find(|note| note.text == "trajectory").unwrap().time_s;
        let course = flying.setpoints.iter().filter(|(at, _)| at.as_secs_f64() > began);
        assert!(course.into_iter().all(|(_, setpoint)| setpoint.position_m.z >= 1.4));
    }
}

#[test]
fn only_a_vehicle_that_is_named_is_flown() {
    let mut flying = Flying::new(vehicle_settings(PX4), |sortie| sortie.system = Some(SystemId(9)));
    assert_eq!(flying.finish().ending, Ending::NotFlown);
    assert!(
        flying.cause().to_string().contains("system 9 within 10 s, heard system 1"),
        "{}",
        flying.cause()
    );
    assert!(flying.commands.is_empty());
}

#[test]
fn an_estimate_that_is_not_good_keeps_it_on_the_ground() {
    for kind in BOTH {
        let mut settings = vehicle_settings(kind);
        settings.warm_up = Some(Duration::from_secs(3600));
        let mut flying = Flying::new(settings, |_| {});
        assert_eq!(flying.finish().ending, Ending::NotFlown);
        assert!(flying.cause().to_string().contains("not ready"), "{}", flying.cause());
        assert!(!flying.flight.status(flying.now).armed);
    }
}

#[test]
fn it_flies_where_it_stands_or_in_the_local_frame() {
    let mut settings = vehicle_settings(PX4);
    settings.start_m = [8.0, -3.0];
    let mut flying = Flying::new(settings.clone(), |_| {});
    assert_eq!(flying.finish().ending, Ending::NotFlown);
    assert!(flying.cause().to_string().contains("--origin here"), "{}", flying.cause());
    let mut flying = Flying::new(settings, |sortie| sortie.settings.origin = Origin::Here);
    flying.fly_into_the_trajectory(4.0);
    let [x, y, _] = flying.flight.status(flying.now).position_m.unwrap();
    assert!((x - 8.0).abs() < 1.5 && (y + 3.0).abs() < 1.5, "{x} {y}");
}

#[test]
fn a_pilot_takes_over_and_nothing_is_sent_again() {
    for kind in BOTH {
        let mut flying = Flying::new(vehicle_settings(kind), |sortie| {
            sortie.settings.watch_max = Duration::from_secs(20);
        });
        flying.fly_into_the_trajectory(5.0);
        flying.vehicle.fault(Fault::PilotTakesOver(Mode::Position));
        flying.until(1.2, "a stop", |flying| flying.phase() == "hands off");
        let since = flying.now;
        let outcome = flying.finish();
        assert!(matches!(outcome.cause, Some(Cause::Override(_))), "{}", flying.story());
        assert!(matches!(outcome.ending, Ending::InTheAir(_)));
        assert_eq!(flying.setpoints_since(since), 0);
        let commands: usize = flying.commands.iter().filter(|(at, ..)| *at > since).count();
        assert_eq!(commands, 0);
    }
}

#[test]
fn the_abort_key_holds_then_lands_then_returns() {
    for kind in BOTH {
        let mut flying = Flying::of(kind);
        flying.fly_into_the_trajectory(5.0);
        for (phase, stays_s) in [("hold", 30.0), ("land", 0.5), ("return", 2.0)] {
            flying.event(Event::Key(Key::Abort));
            assert_eq!(flying.phase(), phase);
            let pressed = flying.now - Duration::from_millis(1);
            flying.wait(stays_s);
            assert!((1..=4).contains(&flying.commands_since(SET_MODE, pressed)), "{}", flying.story());
            assert_eq!(flying.phase(), phase, "nobody but the operator goes on: {}", flying.story());
            // ArduPilot says its mode once a second
            let late = pressed + Duration::from_millis(if kind == PX4 { 450 } else { 1150 });
            assert_eq!(flying.setpoints_since(late), 0, "setpoints end once the mode is seen");
        }
        let outcome = flying.finish();
        assert_eq!((outcome.cause, outcome.ending), (Some(Cause::Operator), Ending::Landed));
    }
}

#[test]
fn a_kill_stops_the_motors() {
    let mut flying = Flying::of(PX4);
    flying.fly_into_the_trajectory(2.0);
    flying.event(Event::Key(Key::Kill));
    let outcome = flying.finish();
    assert_eq!((outcome.cause, outcome.ending), (Some(Cause::Killed), Ending::Fell));
    let (_, _, parameters) = flying.commands.iter().rfind(|(_, number, _)| *number == ARM).unwrap();
    assert_eq!(parameters[..2], [0.0, 21_196.0]);
}

#[test]
fn a_kill_as_it_takes_off_stops_the_motors() {
    for kind in BOTH {
        for after_s in [0.05, 0.3] {
            let mut flying = Flying::of(kind);
            flying.until(60.0, "take off", |flying| flying.phase() == "take off");
            flying.wait(after_s);
            flying.event(Event::Key(Key::Kill));
            flying.until(3.0, "motors off", |flying| !flying.vehicle.beheld().armed);
            flying.finish();
        }
    }
}

/// The stream ends with the order, and PX4 would leave our mode for that.
#[test]
fn a_kill_gets_through_a_link_that_loses_it() {
    for kind in BOTH {
        let timeout = ("COM_OF_LOSS_T".to_owned(), 0.3);
        let base = vehicle_settings(kind);
        let parameters = if kind == PX4 { vec![timeout] } else { Vec::new() };
        let mut flying = Flying::new(VehicleSettings { parameters, ..base }, |_| {});
        flying.fly_into_the_trajectory(2.0);
        flying.up.loss = 1.0;
        flying.event(Event::Key(Key::Kill));
        flying.wait(0.15);
        flying.up.loss = 0.0;
        flying.until(2.0, "motors off", |flying| !flying.vehicle.beheld().armed);
        let outcome = flying.finish();
        assert_eq!((outcome.cause, outcome.ending), (Some(Cause::Killed), Ending::Fell));
    }
}

#[test]
fn an_abort_withdraws_the_order_to_arm() {
    for kind in BOTH {
        let mut flying = Flying::of(kind);
        flying.until(60.0, "arm", |flying| flying.phase() == "arm");
        flying.up.loss = 1.0;
        flying.until(2.0, "the order", |flying| flying.commands_since(ARM, Duration::ZERO) > 0);
        flying.event(Event::Key(Key::Abort));
        flying.up.loss = 0.0;
        let since = flying.now;
        flying.wait(4.0);
        assert_eq!(flying.commands_since(ARM, since), 0, "{}", flying.story());
        assert!(!flying.vehicle.beheld().armed);
        assert_eq!(flying.finish().ending, Ending::NotFlown);
    }
}

#[test]
fn a_signal_leaves_the_vehicle_holding_within_a_second() {
    for kind in BOTH {
        let mut flying = Flying::of(kind);
        flying.fly_into_the_trajectory(5.0);
        let since = flying.now;
        flying.event(Event::Stop("SIGTERM".to_owned()));
        let outcome = flying.finish();
        assert!(flying.now - since <= Duration::from_millis(1020), "{:?}", flying.now - since);
        assert!(matches!(outcome.cause, Some(Cause::Signal(_))));
        let Ending::InTheAir(mode) = outcome.ending else { panic!("{}", flying.story()) };
        assert!(["AUTO.LOITER", "BRAKE"].contains(&mode.as_str()), "{mode}");
    }
}

#[test]
fn a_signal_on_the_ground_ends_at_once() {
    let mut flying = Flying::of(PX4);
    flying.wait(2.0);
    flying.event(Event::Stop("SIGINT".to_owned()));
    assert_eq!(flying.outcome.clone().unwrap().ending, Ending::NotFlown);
    assert_eq!(flying.commands_since(ARM, Duration::ZERO), 0);
}

#[test]
fn a_vehicle_that_is_pushed_off_its_path_holds_and_lands() {
    for kind in BOTH {
        let force_n = [0.0, 14.0, 0.0];
        let push = Fault::Push { force_n, torque_nm: [0.0; 3], duration: Duration::from_secs(6) };
        let (flying, since) = after(kind, push);
        assert!(
            matches!(flying.cause(), Cause::Tracking(_) | Cause::Tilt(_)),
            "{} {}",
            flying.cause(),
            flying.story()
        );
        assert_eq!(flying.outcome.as_ref().unwrap().ending, Ending::Landed);
        assert!(flying.commands_since(SET_MODE, since) >= 2, "hold, then land");
    }
}

#[test]
fn a_rotor_that_stops_ends_the_flight() {
    let mut flying = Flying::of(PX4);
    flying.fly_into_the_trajectory(5.0);
    let since = flying.now;
    flying.vehicle.fault(Fault::RotorStops(0));
    flying.until(2.0, "an abort", |flying| flying.phase() != "trajectory");
    assert!(flying.now - since < Duration::from_secs(2), "{}", flying.story());
    let abort = flying.notes.iter().find(|note| note.kind == "abort").unwrap();
    assert!(abort.text.contains("tilted") || abort.text.contains("off the reference"), "{abort:?}");
}

#[test]
fn an_estimate_that_jumps_ends_the_trajectory() {
    for kind in BOTH {
        let (flying, since) = after(kind, Fault::EstimatorJump([2.0, 0.0, 0.0]));
        assert!(matches!(flying.cause(), Cause::EstimatorReset(_)), "{} {}", flying.cause(), flying.story());
        assert_eq!(flying.outcome.as_ref().unwrap().ending, Ending::Landed);
        let late = since + Duration::from_millis(600);
        assert_eq!(flying.setpoints_since(late), 0);
    }
}

#[test]
fn an_estimate_that_fails_lands_the_vehicle() {
    for kind in BOTH {
        let (flying, _) = after(kind, Fault::EstimatorHealth(false));
        assert!(
            matches!(flying.cause(), Cause::Estimator(_) | Cause::Override(_)),
            "{} {}",
            flying.cause(),
            flying.story()
        );
    }
}

#[test]
fn a_low_battery_ends_with_the_period_and_a_critical_one_at_once() {
    for kind in BOTH {
        let mut flying = Flying::of(kind);
        flying.fly_into_the_trajectory(7.0);
        flying.vehicle.fault(Fault::Battery(0.12));
        let outcome = flying.finish();
        assert!(outcome.is_whole(), "{outcome:?} {}", flying.story());
        assert!(outcome.flown.periods < 3 && outcome.losses[0].contains("battery"), "{outcome:?}");
        let (flying, _) = after(kind, Fault::Battery(0.03));
        assert!(
            matches!(flying.cause(), Cause::Battery(_) | Cause::Override(_) | Cause::Failsafe(_)),
            "{}",
            flying.cause()
        );
        assert_eq!(flying.outcome.as_ref().unwrap().ending, Ending::Landed);
    }
}

#[test]
fn a_second_ground_station_with_our_ids_ends_the_flight() {
    for kind in BOTH {
        let (flying, _) = after(kind, Fault::ForeignHeartbeat { system: 255, component: 190 });
        assert!(matches!(flying.cause(), Cause::SecondMaster(_)), "{}", flying.cause());
        assert_eq!(flying.outcome.as_ref().unwrap().ending, Ending::Landed);
        let mut flying = Flying::of(kind);
        flying.fly_into_the_trajectory(2.0);
        flying.vehicle.fault(Fault::ForeignHeartbeat { system: 254, component: 190 });
        assert!(flying.finish().is_whole(), "another one that only listens is none");
    }
}

/// Setpoints of another station, each 20 to 40 ms for so long, on a link of its own: its target beside the course, or a
/// velocity alone.
fn beside(kind: Firmware, north_m: Option<f64>, lasts: Duration) -> Flying {
    let mut flying = Flying::of(kind);
    flying.fly_into_the_trajectory(2.0);
    let link = flying.vehicle.open_link(LinkRole::GroundStation);
    let target = Target::new(SystemId(1), ComponentId(1)).unwrap();
    let until = flying.now + lasts;
    let place = Place { position_m: Vector3::new(north_m.unwrap_or(0.0), 0.5, 1.5), yaw_rad: 0.0 };
    for steps in [2, 3, 4].into_iter().cycle() {
        if flying.now >= until || flying.outcome.is_some() {
            break;
        }
        for _ in 0..steps {
            flying.step(true);
        }
        let mut raw = MAVLinkV2MessageRaw::new();
        let header = MavHeader { system_id: 254, component_id: 190, sequence: 0 };
        let mut message = Setpoint::hold(flying.now, &place).message(target).unwrap();
        if let MavMessage::SET_POSITION_TARGET_LOCAL_NED(data) = &mut message {
            // position alone, or velocity alone
            data.type_mask =
                PositionTargetTypemask::from_bits_retain(if north_m.is_some() { 0xdf8 } else { 0xdc7 });
        }
        raw.serialize_message(header, &message);
        flying.vehicle.receive(link, raw.raw_bytes(), flying.now);
    }
    flying.finish();
    flying
}

#[test]
fn setpoints_of_another_between_ours_end_the_flight() {
    for kind in BOTH {
        for place in [Some(0.9), Some(-1.5), None] {
            let flying = beside(kind, place, Duration::from_secs(2));
            let outcome = flying.outcome.as_ref().unwrap();
            let seen = matches!(outcome.cause, Some(Cause::SecondMaster(_)));
            assert!(seen && outcome.ending == Ending::Landed, "{kind:?} {place:?} {}", flying.story());
        }
    }
}

#[test]
fn a_reboot_is_seen_and_nothing_is_sent_after_it() {
    let (flying, since) = after(PX4, Fault::Reboot);
    assert!(matches!(flying.cause(), Cause::Reboot | Cause::Override(_)), "{}", flying.cause());
    let late = since + Duration::from_millis(1200);
    assert_eq!((flying.setpoints_since(late), flying.commands_since(SET_MODE, since)), (0, 0));
}

#[test]
fn a_short_silence_pauses_the_trajectory_and_a_long_one_ends_it() {
    let mut flying = Flying::of(COPTER);
    // with velocity and acceleration it would be metres away by then
    flying.places_ahead();
    flying.fly_into_the_trajectory(5.0);
    flying.vehicle.fault(Fault::LinkSilence(Duration::from_millis(2600)));
    let outcome = flying.finish();
    assert!(outcome.is_whole(), "{}", flying.story());
    assert!(outcome.flown.paused_s > 0.4 && outcome.losses.len() == 1, "{outcome:?}");
    let (flying, since) = after(COPTER, Fault::LinkSilence(Duration::from_secs(9)));
    assert!(matches!(flying.cause(), Cause::LinkLost(_)), "{}", flying.cause());
    let late = since + Duration::from_millis(5020);
    assert_eq!(flying.setpoints_since(late), 0, "no blind resume");
    assert_eq!(flying.outcome.as_ref().unwrap().ending, Ending::Landed, "{}", flying.story());
}

/// PX4 falls out of OFFBOARD unheard and comes back to it with the first setpoint that it hears: what is seen
/// is a vehicle that is not where it was led.
#[test]
fn px4_fails_safe_in_a_silence_and_the_trajectory_is_not_resumed_elsewhere() {
    let (flying, _) = after(PX4, Fault::LinkSilence(Duration::from_millis(3500)));
    assert!(
        matches!(flying.cause(), Cause::Override(_) | Cause::Tracking(_)),
        "{} {}",
        flying.cause(),
        flying.story()
    );
    let outcome = flying.outcome.as_ref().unwrap();
    assert!(outcome.flown.periods < 2 && outcome.ending == Ending::Landed, "{outcome:?}");
}

/// The failsafe that it flies is left to it: its mode from before the silence is not taken for its mode now.
#[test]
fn px4_that_fell_out_of_offboard_in_a_long_silence_is_told_nothing() {
    let (flying, since) = after(PX4, Fault::LinkSilence(Duration::from_secs(8)));
    assert!(matches!(flying.cause(), Cause::LinkLost(_)), "{}", flying.cause());
    let silent = since + Duration::from_millis(5020);
    assert_eq!(flying.setpoints_since(silent), 0);
    assert_eq!(flying.commands_since(SET_MODE, silent), 0, "{}", flying.story());
    assert_eq!(flying.outcome.as_ref().unwrap().ending, Ending::Landed, "{}", flying.story());
}

#[test]
fn a_flight_that_is_not_looked_after_holds_and_lands() {
    for (kind, silent_ms) in [(PX4, 200), (COPTER, 200), (COPTER, 600)] {
        let mut flying = Flying::of(kind);
        flying.fly_into_the_trajectory(5.0);
        let since = flying.now;
        for _ in 0..silent_ms / 10 {
            flying.step(false);
        }
        assert!(flying.setpoints_since(since + Duration::from_millis(100)) == 0);
        let outcome = flying.finish();
        assert!(matches!(outcome.cause, Some(Cause::Stalled(_))), "{}", flying.story());
        assert_eq!(outcome.ending, Ending::Landed);
        // what a busy computer is told by: reported by the stream and by the flight, and counted once
        let measured = &outcome.flown;
        let before_end_s = measured.stalled_before_end_s.unwrap();
        assert!((before_end_s - 1e-3 * f64::from(silent_ms)).abs() < 0.03, "{measured:?}");
        assert_eq!((measured.stalls, measured.stalled_max_s), (1, before_end_s), "{measured:?}");
    }
}

/// A pilot who takes over long after a stall: the computer has nothing to do with it.
#[test]
fn a_stall_of_long_ago_is_no_cause_of_an_end() {
    let mut flying = Flying::new(vehicle_settings(PX4), |sortie| {
        sortie.settings.watch_max = Duration::from_secs(20);
    });
    for _ in 0..300 {
        flying.step(true);
    }
    // on the ground
    stall(&mut flying, 150);
    flying.fly_into_the_trajectory(3.0);
    flying.vehicle.fault(Fault::PilotTakesOver(Mode::Position));
    let outcome = flying.finish();
    assert!(matches!(outcome.cause, Some(Cause::Override(_))), "{}", flying.story());
    assert_eq!((outcome.flown.stalls, outcome.flown.stalled_before_end_s), (1, None), "{}", flying.story());
}

#[test]
fn over_a_bad_link_the_flight_ends_and_no_setpoint_is_stale() {
    for kind in BOTH {
        for seed in 0..3 {
            let mut flying = Flying::of(kind);
            for (way, extra) in [(&mut flying.up, 0), (&mut flying.down, 7)] {
                way.reseed(seed + extra);
                way.loss = 0.2;
                way.delay = Duration::from_millis(150);
                way.jitter = Duration::from_millis(100);
            }
            let outcome = flying.finish();
            assert!(
                matches!(outcome.ending, Ending::Landed | Ending::NotFlown),
                "{kind:?} {seed}: {outcome:?} {}",
                flying.story()
            );
            assert!(flying.setpoints.iter().all(|(at, setpoint)| *at == setpoint.time));
            assert!(flying.setpoints.windows(2).all(|pair| pair[0].0 < pair[1].0));
        }
    }
}

/// What commands a vehicle, of all that was sent after a time; questions are free.
fn orders_since(flying: &Flying, since: Duration) -> Vec<(Duration, u32)> {
    let questions = [511, 512];
    let after = flying.commands.iter().filter(|(at, number, _)| *at > since && !questions.contains(number));
    after.map(|(at, number, _)| (*at, *number)).collect()
}

/// The flight is not looked after for so long.
fn stall(flying: &mut Flying, ms: u32) {
    for _ in 0..ms / 10 {
        flying.step(false);
    }
}

fn watched_briefly(kind: Firmware) -> Flying {
    Flying::new(vehicle_settings(kind), |sortie| sortie.settings.watch_max = Duration::from_secs(8))
}

#[test]
fn a_pilot_who_takes_over_during_a_stall_keeps_the_vehicle() {
    for kind in BOTH {
        for (before_ms, after_ms) in [(50, 150), (20, 380), (300, 350), (100, 2900)] {
            let mut flying = watched_briefly(kind);
            flying.fly_into_the_trajectory(3.0);
            stall(&mut flying, before_ms);
            flying.vehicle.fault(Fault::PilotTakesOver(Mode::Position));
            let since = flying.now;
            stall(&mut flying, after_ms);
            let awake = flying.now;
            let outcome = flying.finish();
            assert_eq!(orders_since(&flying, since), [], "{kind:?} {after_ms}: {}", flying.story());
            assert_eq!(flying.setpoints_since(awake), 0, "{kind:?} {after_ms}: {}", flying.story());
            assert!(matches!(outcome.ending, Ending::InTheAir(_)), "{outcome:?}");
            assert!(matches!(outcome.cause, Some(Cause::Stalled(_) | Cause::Override(_))), "{outcome:?}");
        }
    }
}

#[test]
fn a_pilot_who_takes_over_during_a_silence_keeps_the_vehicle() {
    for kind in BOTH {
        for (silent_ms, after_ms) in [(1200, 300), (2200, 1000), (2600, 200), (4000, 3500), (7000, 600)] {
            let mut flying = watched_briefly(kind);
            flying.fly_into_the_trajectory(3.0);
            flying.vehicle.fault(Fault::LinkSilence(Duration::from_millis(silent_ms)));
            let heard = flying.now + Duration::from_millis(silent_ms);
            flying.wait(1e-3 * f64::from(after_ms));
            flying.vehicle.fault(Fault::PilotTakesOver(Mode::Altitude));
            let since = flying.now;
            flying.finish();
            assert_eq!(orders_since(&flying, since), [], "{kind:?} {silent_ms}: {}", flying.story());
            let late = heard + Duration::from_millis(200);
            assert_eq!(flying.setpoints_since(late), 0, "{kind:?} {silent_ms}: {}", flying.story());
            assert_eq!(flying.phase(), "over");
        }
    }
}

#[test]
fn hands_off_is_final() {
    for kind in BOTH {
        let mut flying = Flying::of(kind);
        flying.fly_into_the_trajectory(3.0);
        flying.vehicle.fault(Fault::PilotTakesOver(Mode::Position));
        flying.until(1.5, "hands off", |flying| flying.phase() == "hands off");
        let since = flying.now;
        // another companion computer flies it in our mode, then it is landed
        flying.vehicle.fault(Fault::PilotTakesOver(Mode::Guided));
        flying.wait(4.0);
        flying.event(Event::Key(Key::Abort));
        flying.event(Event::Key(Key::Kill));
        flying.vehicle.fault(Fault::PilotTakesOver(Mode::Land));
        let outcome = flying.finish();
        assert_eq!(outcome.ending, Ending::Landed, "{}", flying.story());
        let sent = flying.commands.iter().filter(|(at, ..)| *at > since).count();
        assert_eq!((sent, flying.setpoints_since(since)), (0, 0), "{}", flying.story());
    }
}

#[test]
fn one_forged_heartbeat_that_says_disarmed_ends_nothing() {
    for (kind, mode) in [(PX4, 6 << 16), (COPTER, 4)] {
        let mut flying = Flying::of(kind);
        flying.fly_into_the_trajectory(3.0);
        let mut raw = MAVLinkV2MessageRaw::new();
        let mut data = mavlink::dialects::ardupilotmega::HEARTBEAT_DATA {
            custom_mode: mode,
            // the default is "armed"
            base_mode: mavlink::dialects::ardupilotmega::MavModeFlag::MAV_MODE_FLAG_CUSTOM_MODE_ENABLED,
            mavtype: mavlink::dialects::ardupilotmega::MavType::MAV_TYPE_QUADROTOR,
            autopilot: mavlink::dialects::ardupilotmega::MavAutopilot::MAV_AUTOPILOT_PX4,
            ..Default::default()
        };
        data.system_status = mavlink::dialects::ardupilotmega::MavState::MAV_STATE_ACTIVE;
        let sequence = flying.heard_sequence.wrapping_add(1);
        let header = MavHeader { system_id: 1, component_id: 1, sequence };
        raw.serialize_message(header, &MavMessage::HEARTBEAT(data));
        flying.event(Event::Frame(mavid::wire::Frame::at_start(raw.raw_bytes()).unwrap()));
        assert_eq!(flying.phase(), "trajectory", "{}", flying.story());
        let outcome = flying.finish();
        assert!(outcome.is_whole(), "{outcome:?} {}", flying.story());
        let told = flying.notes.iter().filter(|note| note.text.contains("says that it is disarmed")).count();
        assert_eq!(told, 1, "{}", flying.story());
    }
}

#[test]
fn a_pilots_loiter_after_an_abort_is_not_followed_by_a_landing() {
    let mut flying = watched_briefly(COPTER);
    flying.fly_into_the_trajectory(3.0);
    flying.event(Event::Key(Key::To(mavid::autopilot::Mode::Hold)));
    flying.wait(2.0);
    assert_eq!(flying.phase(), "hold");
    flying.vehicle.fault(Fault::PilotTakesOver(Mode::Hold));
    let since = flying.now;
    flying.finish();
    assert_eq!(orders_since(&flying, since), [], "{}", flying.story());
    assert!(flying.story().contains("LOITER"), "{}", flying.story());
}

/// A pilot who chooses, while the program stands still, the very mode that it would ask for.
#[test]
fn a_pilots_hold_during_a_stall_is_not_taken_for_ours() {
    for (kind, mode) in [(PX4, Mode::Hold), (COPTER, Mode::Brake)] {
        for ms in [200, 650, 2000] {
            let mut flying = watched_briefly(kind);
            flying.fly_into_the_trajectory(3.0);
            stall(&mut flying, 50);
            flying.vehicle.fault(Fault::PilotTakesOver(mode));
            let since = flying.now;
            stall(&mut flying, ms);
            flying.finish();
            assert_eq!(orders_since(&flying, since), [], "{kind:?} {ms}: {}", flying.story());
        }
    }
}

#[test]
fn the_vehicles_own_failsafe_is_not_taken_for_a_second_station() {
    let mut flying = Flying::of(PX4);
    flying.fly_into_the_trajectory(3.0);
    flying.up.loss = 1.0;
    let since = flying.now + Duration::from_secs(1);
    let outcome = flying.finish();
    assert!(matches!(outcome.cause, Some(Cause::Override(_))), "{}", flying.story());
    assert_eq!(orders_since(&flying, since), [], "{}", flying.story());
}

#[test]
fn a_host_that_stalls_in_the_takeoff_says_so() {
    for kind in BOTH {
        let mut flying = Flying::of(kind);
        flying.until(60.0, "take off", |flying| flying.phase() == "take off");
        flying.wait(0.5);
        assert_eq!(flying.flight.status(flying.now).stall_s, None);
        stall(&mut flying, 1000);
        flying.wait(0.5);
        // while it matters it is told how long it was
        let stall_s = flying.flight.status(flying.now).stall_s.unwrap();
        assert!((0.9..1.2).contains(&stall_s), "{stall_s}");
        let outcome = flying.finish();
        assert_eq!(flying.flight.status(flying.now).stall_s, None);
        assert!(matches!(outcome.cause, Some(Cause::Stalled(_))), "{kind:?}: {}", flying.story());
        assert!(flying.cause().to_string().contains("stalled for"), "{}", flying.cause());
        assert_eq!(outcome.ending, Ending::Landed);
    }
}

/// ArduCopter declares its low battery as critical whatever BATT_FS_LOW_ACT makes of it, and stays in GUIDED with 0.
#[test]
fn a_low_battery_of_which_the_copter_makes_nothing_ends_with_the_period() {
    let mut settings = vehicle_settings(COPTER);
    settings.parameters = vec![("BATT_FS_LOW_ACT".to_owned(), 0.0)];
    let mut flying = Flying::new(settings, |_| {});
    flying.fly_into_the_trajectory(7.0);
    flying.vehicle.fault(Fault::Battery(0.12));
    flying.wait(3.0);
    assert_eq!((flying.system_status, flying.phase()), (CRITICAL, "trajectory"), "{}", flying.story());
    let outcome = flying.finish();
    assert!(outcome.is_whole() && outcome.flown.periods < 3, "{outcome:?} {}", flying.story());
}

/// The same without a word of the battery, as of a lost remote control with which the copter goes on in GUIDED.
#[test]
fn a_failsafe_that_is_declared_and_leaves_our_mode_ends_the_flight_on_the_ground() {
    let mut flying = Flying::of(COPTER);
    flying.fly_into_the_trajectory(2.0);
    flying.swallowed = vec![SYS_STATUS, BATTERY_STATUS];
    flying.vehicle.fault(Fault::Battery(0.12));
    let since = flying.now;
    flying.until(4.0, "an abort", |flying| flying.phase() == "hold");
    assert_eq!(flying.system_status, CRITICAL);
    let outcome = flying.finish();
    assert!(matches!(outcome.cause, Some(Cause::Failsafe(_))), "{outcome:?}");
    assert_eq!(outcome.ending, Ending::Landed, "{}", flying.story());
    assert!(flying.commands_since(SET_MODE, since) >= 2, "hold, then land");
}

#[test]
fn a_declared_failsafe_that_changes_the_mode_takes_our_hands_off() {
    let mut settings = vehicle_settings(COPTER);
    settings.parameters = vec![("BATT_FS_LOW_ACT".to_owned(), 1.0)];
    let mut flying = Flying::new(settings, |_| {});
    flying.fly_into_the_trajectory(2.0);
    flying.vehicle.fault(Fault::Battery(0.12));
    let since = flying.now;
    let outcome = flying.finish();
    assert!(matches!(outcome.cause, Some(Cause::Override(_))), "{outcome:?}");
    assert_eq!(orders_since(&flying, since), [], "{}", flying.story());
}

#[test]
fn a_vehicle_that_answers_no_question_is_not_flown() {
    for kind in BOTH {
        let mut flying = Flying::of(kind);
        flying.swallowed = vec![TIMESYNC];
        let outcome = flying.finish();
        assert_eq!(outcome.ending, Ending::NotFlown);
        assert!(flying.cause().to_string().contains("TIMESYNC"), "{}", flying.cause());
        assert_eq!(orders_since(&flying, Duration::ZERO), []);
    }
}

/// PX4 leaves the addressee of its answers uninitialised: the number of the question tells whose they are.
#[test]
fn an_answer_with_a_stray_addressee_is_an_answer() {
    for kind in BOTH {
        let mut flying = Flying::of(kind);
        flying.misaddressed = true;
        let outcome = flying.finish();
        assert_eq!(outcome.ending, Ending::Landed, "{}", flying.story());
    }
}

/// What the vehicle answered another station: by the time of day, or in nanoseconds since a start.
fn answer_to_another(number: i64) -> MavMessage {
    MavMessage::TIMESYNC(TIMESYNC_DATA { tc1: 1, ts1: number, ..Default::default() })
}

/// A short standstill in which the pilot takes over. What came before that is read first: another's answer, then a report of
/// our mode. The vehicle says its mode a second later.
#[test]
fn an_answer_to_another_station_does_not_make_an_old_report_count() {
    for number in [1_760_000_000_000_000_000, 200_000_000_000, i64::MAX] {
        for kind in BOTH {
            let mut flying = watched_briefly(kind);
            flying.fly_into_the_trajectory(3.0);
            // the answers come ten times a second
            for _ in 0..30 {
                flying.step(false);
                flying.overhear(&answer_to_another(number));
            }
            flying.vehicle.fault(Fault::PilotTakesOver(Mode::Return));
            let since = flying.now;
            // of what came since then nothing is in the socket yet
            flying.down.delay = Duration::from_millis(300);
            flying.finish();
            assert_eq!(orders_since(&flying, since), [], "{kind:?}: {}", flying.story());
        }
    }
}

/// What a silence held back comes at the pace of the radio: each report is six seconds old, for as long as it takes.
#[test]
fn a_pilot_who_takes_over_while_a_radio_drains_keeps_the_vehicle() {
    for kind in BOTH {
        let mut flying = watched_briefly(kind);
        flying.fly_into_the_trajectory(3.0);
        flying.down.delay = Duration::from_secs(6);
        flying.wait(4.5);
        flying.vehicle.fault(Fault::PilotTakesOver(Mode::Position));
        let since = flying.now + Duration::from_secs(1);
        let outcome = flying.finish();
        assert!(matches!(outcome.cause, Some(Cause::LinkLost(_))), "{outcome:?}");
        assert_eq!(
            (orders_since(&flying, since), flying.setpoints_since(since)),
            (vec![], 0),
            "{}",
            flying.story()
        );
        assert!(flying.story().contains("the link is back; the vehicle is in mode"), "{}", flying.story());
    }
}

/// The vehicle is heard and hears nothing: its mode is not known, and what could not be ordered is not given up.
#[test]
fn an_abort_without_an_uplink_waits_until_it_can_be_ordered() {
    for lost_s in [3.0, 30.0] {
        let mut flying = Flying::of(COPTER);
        flying.places_ahead();
        flying.fly_into_the_trajectory(3.0);
        flying.up.loss = 1.0;
        stall(&mut flying, 150);
        let since = flying.now;
        flying.event(Event::Key(Key::Abort));
        flying.wait(lost_s);
        assert_eq!((flying.phase(), orders_since(&flying, since)), ("hold", vec![]), "{}", flying.story());
        flying.up.loss = 0.0;
        flying.wait(2.0);
        assert!(flying.commands_since(SET_MODE, since) > 0, "{}", flying.story());
        flying.event(Event::Key(Key::To(mavid::autopilot::Mode::Land)));
        assert_eq!(flying.finish().ending, Ending::Landed, "{}", flying.story());
    }
}

#[test]
fn a_vehicle_that_is_heard_and_answers_nothing_counts_as_lost_and_is_told_to_hold_once_it_does() {
    let mut flying = Flying::of(COPTER);
    flying.places_ahead();
    flying.fly_into_the_trajectory(3.0);
    flying.up.loss = 1.0;
    flying.event(Event::Link(true));
    let since = flying.now;
    flying.until(5.5, "link lost", |flying| flying.phase() == "link lost");
    flying.wait(20.0);
    assert_eq!((flying.phase(), orders_since(&flying, since)), ("link lost", vec![]), "{}", flying.story());
    flying.up.loss = 0.0;
    let outcome = flying.finish();
    assert!(matches!(outcome.cause, Some(Cause::LinkLost(_))), "{outcome:?}");
    assert_eq!(outcome.ending, Ending::Landed, "{}", flying.story());
}

#[test]
fn a_gate_that_stays_shut_says_what_to_change() {
    let mut flying = Flying::new(vehicle_settings(PX4), |sortie| sortie.settings.gate_m = Some(1e-6));
    flying.finish();
    let cause = flying.cause().to_string();
    assert!(cause.contains("0.00 m are allowed") && cause.contains("--gate-distance"), "{cause}");
}

/// The whole of the supervision ends: nothing is sent, and the vehicle's own failsafe acts.
#[test]
fn a_supervisor_that_never_wakes_leaves_the_vehicle_to_its_failsafe() {
    let mut flying = Flying::of(PX4);
    flying.fly_into_the_trajectory(3.0);
    let since = flying.now;
    stall(&mut flying, 8000);
    assert_eq!(orders_since(&flying, since), []);
    assert_eq!(flying.setpoints_since(since + Duration::from_millis(100)), 0);
}

/// Flown with a file whose mass is `factor` times the vehicle's.
fn flown_by_a_file(factor: f64) -> (Flying, Outcome) {
    let settings = vehicle_settings(PX4);
    let mut file = settings.vehicle.clone();
    file.body.mass_kg *= factor;
    let mut flying = Flying::new(settings, |sortie| {
        sortie.settings.await_clearance = true;
    });
    // what turns pulses into commands, as it answers when asked
    let pulses = (1..=4).flat_map(|output| {
        [("FUNC", 100.0 + f64::from(output)), ("MIN", 1000.0), ("MAX", 2000.0)]
            .map(|(name, value)| (format!("PWM_MAIN_{name}{output}"), value))
    });
    let parameters =
        Parameters { autopilot: Autopilot::Px4, values: pulses.collect(), ..Parameters::default() };
    flying.until(30.0, "the checks", |flying| flying.flight.wants_clearance());
    flying.event(Event::Cleared(Ok(Box::new(Lift::new(&file, &parameters)))));
    let outcome = flying.finish();
    (flying, outcome)
}

#[test]
fn what_hovers_is_weighed_before_the_trajectory() {
    let said = |flying: &Flying| flying.notes.iter().find(|note| note.kind == "hover thrust").cloned();
    for (factor, level) in [(1.0, "Information"), (0.75, "Information"), (1.6, "Warning"), (0.65, "Warning")]
    {
        let (flying, outcome) = flown_by_a_file(factor);
        assert!(outcome.is_whole(), "{factor}: {}", flying.story());
        let note = said(&flying).unwrap();
        assert_eq!(format!("{:?}", note.level), level, "{factor}: {}", note.text);
    }
    for factor in [0.3, 3.0] {
        let (flying, outcome) = flown_by_a_file(factor);
        assert!(outcome.is_whole(), "{factor}: {}", flying.story());
        let note = said(&flying).unwrap();
        let weight = format!("weight, {:.4} N", factor * 2.0643 * 9.81);
        for part in [weight.as_str(), "SERVO_OUTPUT_RAW", "another vehicle's"] {
            assert!(note.text.contains(part), "{}", note.text);
        }
        assert_eq!(format!("{:?}", note.level), "Warning");
    }
}
