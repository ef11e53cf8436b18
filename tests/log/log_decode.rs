//! One hand-worked sample for each message, and how messages are put on the vehicle's clock.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test ends where it fails"
)]

use crate::support;

use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2, PI, TAU};

use mavid::autopilot::Autopilot;
use mavid::recording::{Event, Quantity};
use mavid::wire::{Anchor, ComponentId, Decoder, Record, Stamp, SystemId, Vehicle};
use mavlink::dialects::ardupilotmega::{self as dialect, MavMessage as M};
use mavlink::types::CharArray;
use proptest::prelude::*;
use support::{START_US, by_hand, header, heartbeat, v2};

#[derive(Debug, Clone, PartialEq)]
enum Said {
    Sample { quantity: Quantity, source: &'static str, instance: u8, time_s: f64, values: Vec<f64> },
    Parameter(String, f64),
    Text(f64, String),
    ClockReset(f64),
    EstimatorReset(f64),
}

/// A vehicle's decoder; its clock is zero at 10 s since boot.
struct Rig {
    decoder: Decoder,
    said: Vec<Said>,
}

impl Rig {
    fn new(autopilot: Autopilot) -> Self {
        let vehicle = Vehicle { system: SystemId(1), component: ComponentId(1), autopilot, kind: None };
        let anchor = Anchor::new(Stamp::BootMs(10_000), i64::try_from(START_US).unwrap());
        Self { decoder: Decoder::new(vehicle, anchor, START_US), said: Vec::new() }
    }

    fn hear_frame(&mut self, host_s: f64, bytes: &[u8]) -> &mut Self {
        let stamp_us = (START_US as f64 + host_s * 1e6).round() as u64;
        let record = Record { stamp_us, offset: 0, known: true, frame: support::frame(bytes) };
        let said = &mut self.said;
        self.decoder.decode(&record, &mut |event| said.push(owned(event)));
        self
    }

    fn hear(&mut self, host_s: f64, message: &M) -> &mut Self {
        self.hear_frame(host_s, &v2(header(1, 0), message))
    }

    /// The samples of one quantity: time and values.
    fn samples(&self, wanted: Quantity) -> Vec<(f64, Vec<f64>)> {
        let of = |said: &Said| match said {
            Said::Sample { quantity, time_s, values, .. } if *quantity == wanted => {
                Some((*time_s, values.clone()))
            }
            _ => None,
        };
        self.said.iter().filter_map(of).collect()
    }

    fn only(&self, quantity: Quantity) -> Vec<f64> {
        let samples = self.samples(quantity);
        assert_eq!(samples.len(), 1, "{quantity:?} in {:?}", self.said);
        samples[0].1.clone()
    }
}

fn owned(event: Event<'_>) -> Said {
    match event {
        Event::Sample { stream, time_s, values } => Said::Sample {
            quantity: stream.quantity,
            source: stream.source,
            instance: stream.instance,
            time_s,
            values: values.to_vec(),
        },
        Event::Autopilot(autopilot) => panic!("a frame says no {autopilot:?}"),
        Event::ParameterDefault { name, .. } => panic!("a frame says no default of {name}"),
        Event::Parameter { name, value } => Said::Parameter(name.to_owned(), value),
        Event::Text { time_s, text, .. } => Said::Text(time_s, text.to_owned()),
        Event::ClockReset { time_s, .. } => Said::ClockReset(time_s),
        Event::EstimatorReset { time_s } => Said::EstimatorReset(time_s),
    }
}

fn px4(message: &M) -> Rig {
    let mut rig = Rig::new(Autopilot::Px4);
    rig.hear(0.0, message);
    rig
}

fn close(got: &[f64], wanted: &[f64]) {
    assert_eq!(got.len(), wanted.len(), "{got:?}");
    for (got_one, wanted_one) in got.iter().zip(wanted) {
        let both_missing = got_one.is_nan() && wanted_one.is_nan();
        assert!(both_missing || (got_one - wanted_one).abs() < 1e-6, "{got:?}, wanted {wanted:?}");
    }
}

#[test]
fn attitude_nose_up_is_a_negative_turn_about_left() {
    let rig = px4(&M::ATTITUDE(dialect::ATTITUDE_DATA {
        time_boot_ms: 12_500,
        pitch: 0.2,
        rollspeed: 0.1,
        pitchspeed: 0.2,
        yawspeed: 0.3,
        ..Default::default()
    }));
    close(&rig.only(Quantity::Attitude), &[0.1_f64.cos(), 0.0, -(0.1_f64.sin()), 0.0]);
    close(&rig.only(Quantity::AngularRate), &[0.1, -0.2, -0.3]);
    assert_eq!(rig.samples(Quantity::Attitude)[0].0, 2.5);
}

#[test]
fn attitude_quaternion_facing_east_is_a_quarter_turn_clockwise() {
    let half = FRAC_1_SQRT_2 as f32;
    let rig = px4(&M::ATTITUDE_QUATERNION(dialect::ATTITUDE_QUATERNION_DATA {
        time_boot_ms: 10_000,
        q1: half,
        q4: half,
        yawspeed: 0.5,
        ..Default::default()
    }));
    close(&rig.only(Quantity::Attitude), &[FRAC_1_SQRT_2, 0.0, 0.0, -FRAC_1_SQRT_2]);
    close(&rig.only(Quantity::AngularRate), &[0.0, 0.0, -0.5]);
}

#[test]
fn a_quaternion_of_zeros_is_no_attitude() {
    let rig = px4(&M::ATTITUDE_QUATERNION(dialect::ATTITUDE_QUATERNION_DATA {
        time_boot_ms: 10_000,
        ..Default::default()
    }));
    assert!(rig.samples(Quantity::Attitude).is_empty());
}

#[test]
fn local_position_down_is_minus_up() {
    let rig = px4(&M::LOCAL_POSITION_NED(dialect::LOCAL_POSITION_NED_DATA {
        time_boot_ms: 10_000,
        x: 1.0,
        y: 2.0,
        z: -5.0,
        vx: 0.5,
        vy: -0.5,
        vz: 0.25,
    }));
    close(&rig.only(Quantity::Position), &[1.0, -2.0, 5.0]);
    close(&rig.only(Quantity::Velocity), &[0.5, 0.5, -0.25]);
}

fn odometry(child_frame_id: dialect::MavFrame) -> dialect::ODOMETRY_DATA {
    let half = FRAC_1_SQRT_2 as f32;
    dialect::ODOMETRY_DATA {
        time_usec: 10_000_000,
        x: 1.0,
        y: 2.0,
        z: -3.0,
        q: [half, 0.0, 0.0, half], // facing east
        vx: 2.0,
        vy: 0.5,
        vz: -1.0,
        rollspeed: 0.1,
        pitchspeed: 0.2,
        yawspeed: 0.3,
        frame_id: dialect::MavFrame::MAV_FRAME_LOCAL_NED,
        child_frame_id,
        ..Default::default()
    }
}

#[test]
fn odometry_velocity_is_turned_into_the_world_where_it_is_of_the_body() {
    // forward is east, right is south: 2 forward, 0.5 right, 1 up = 0.5 south, 2 east, 1 up
    let rig = px4(&M::ODOMETRY(odometry(dialect::MavFrame::MAV_FRAME_BODY_FRD)));
    close(&rig.only(Quantity::Velocity), &[-0.5, -2.0, 1.0]);
    close(&rig.only(Quantity::Position), &[1.0, -2.0, 3.0]);
    close(&rig.only(Quantity::AngularRate), &[0.1, -0.2, -0.3]);
    let rig = px4(&M::ODOMETRY(odometry(dialect::MavFrame::MAV_FRAME_LOCAL_NED)));
    close(&rig.only(Quantity::Velocity), &[2.0, -0.5, 1.0]);
}

#[test]
fn odometry_in_another_frame_is_counted_and_left_out() {
    let mut data = odometry(dialect::MavFrame::MAV_FRAME_BODY_FRD);
    data.frame_id = dialect::MavFrame::MAV_FRAME_LOCAL_FRD;
    let rig = px4(&M::ODOMETRY(data));
    assert!(rig.said.is_empty());
    assert_eq!(rig.decoder.report().unusable.len(), 1);
}

#[test]
fn odometry_reset_counter_is_an_extension_that_is_read() {
    let mut data = odometry(dialect::MavFrame::MAV_FRAME_BODY_FRD);
    data.reset_counter = 4;
    let mut rig = px4(&M::ODOMETRY(data.clone()));
    (data.reset_counter, data.time_usec) = (5, 11_000_000);
    rig.hear(1.0, &M::ODOMETRY(data));
    assert!(rig.said.contains(&Said::EstimatorReset(1.0)));
}

#[test]
fn highres_imu_hover_pushes_up() {
    let data = dialect::HIGHRES_IMU_DATA {
        time_usec: 10_000_000,
        xacc: 0.5,
        yacc: 0.25,
        zacc: -9.81,
        xgyro: 0.1,
        ygyro: 0.2,
        zgyro: 0.3,
        fields_updated: dialect::HighresImuUpdatedFlags::all(),
        ..Default::default()
    };
    let rig = px4(&M::HIGHRES_IMU(data.clone()));
    close(&rig.only(Quantity::SpecificForce), &[0.5, -0.25, 9.81]);
    close(&rig.only(Quantity::AngularRate), &[0.1, -0.2, -0.3]);
    let fields_updated = dialect::HighresImuUpdatedFlags::from_bits_truncate(0b111 << 3);
    let rig = px4(&M::HIGHRES_IMU(dialect::HIGHRES_IMU_DATA { fields_updated, ..data }));
    assert!(rig.samples(Quantity::SpecificForce).is_empty());
    assert_eq!(rig.samples(Quantity::AngularRate).len(), 1);
}

#[test]
fn scaled_imus_are_in_milli_g_and_milliradians() {
    let rig = px4(&M::SCALED_IMU(dialect::SCALED_IMU_DATA {
        time_boot_ms: 10_000,
        xacc: 100,
        yacc: 200,
        zacc: -1000,
        xgyro: 100,
        ygyro: 200,
        zgyro: -300,
        ..Default::default()
    }));
    close(&rig.only(Quantity::SpecificForce), &[0.980_665, -1.961_33, 9.806_65]);
    close(&rig.only(Quantity::AngularRate), &[0.1, -0.2, 0.3]);
    for message in [
        M::SCALED_IMU2(dialect::SCALED_IMU2_DATA { time_boot_ms: 10_000, zacc: -1000, ..Default::default() }),
        M::SCALED_IMU3(dialect::SCALED_IMU3_DATA { time_boot_ms: 10_000, zacc: -1000, ..Default::default() }),
    ] {
        close(&px4(&message).only(Quantity::SpecificForce), &[0.0, 0.0, 9.806_65]);
    }
}

#[test]
fn raw_imu_has_a_scale_on_ardupilot_alone() {
    let message = M::RAW_IMU(dialect::RAW_IMU_DATA {
        time_usec: 10_000_000,
        zacc: -1000,
        zgyro: 500,
        id: 2,
        ..Default::default()
    });
    let mut rig = Rig::new(Autopilot::ArduPilot);
    rig.hear(0.0, &message);
    close(&rig.only(Quantity::SpecificForce), &[0.0, 0.0, 9.806_65]);
    close(&rig.only(Quantity::AngularRate), &[0.0, 0.0, -0.5]);
    assert!(matches!(rig.said[0], Said::Sample { instance: 2, .. }));
    assert!(px4(&message).said.is_empty());
}

#[test]
fn servo_outputs_of_both_halves_are_read_and_no_output_is_missing() {
    let rig = px4(&M::SERVO_OUTPUT_RAW(dialect::SERVO_OUTPUT_RAW_DATA {
        time_usec: 10_000_000,
        port: 1,
        servo1_raw: 1500,
        servo2_raw: u16::MAX,
        servo9_raw: 1100,
        servo10_raw: 1900,
        ..Default::default()
    }));
    let values = rig.only(Quantity::ActuatorCommand);
    close(&values, &[1500.0, f64::NAN, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1100.0, 1900.0]);
    assert!(matches!(rig.said[0], Said::Sample { instance: 1, source: "SERVO_OUTPUT_RAW", .. }));
}

#[test]
fn servo_time_wraps_after_71_minutes_without_notice() {
    let servo = |time_usec: u32| {
        M::SERVO_OUTPUT_RAW(dialect::SERVO_OUTPUT_RAW_DATA {
            time_usec,
            servo1_raw: 1500,
            ..Default::default()
        })
    };
    // 80 minutes since boot: the 32 bits hold 505.03 s
    let vehicle = Vehicle {
        system: SystemId(1),
        component: ComponentId(1),
        autopilot: Autopilot::ArduPilot,
        kind: None,
    };
    let anchor = Anchor::new(Stamp::BootMs(4_800_000), i64::try_from(START_US).unwrap());
    let mut rig = Rig { decoder: Decoder::new(vehicle, anchor, START_US), said: Vec::new() };
    let wrapped = |boot_us: u64| servo(u32::try_from(boot_us % (1 << 32)).unwrap());
    rig.hear(0.01, &wrapped(4_800_010_000)).hear(0.02, &wrapped(4_800_020_000));
    assert_eq!(
        rig.samples(Quantity::ActuatorCommand).iter().map(|sample| sample.0).collect::<Vec<_>>(),
        [0.01, 0.02]
    );
    // across the second wrap, at 143.2 minutes
    let across = (1_u64 << 33) - 5000;
    let anchor = Anchor::new(Stamp::Us(across), i64::try_from(START_US).unwrap());
    let mut rig = Rig { decoder: Decoder::new(vehicle, anchor, START_US), said: Vec::new() };
    rig.hear(0.0, &wrapped(across)).hear(0.01, &wrapped(across + 10_000));
    assert_eq!(
        rig.samples(Quantity::ActuatorCommand).iter().map(|sample| sample.0).collect::<Vec<_>>(),
        [0.0, 0.01]
    );
}

#[test]
fn actuator_outputs_are_as_sent_without_the_silent_channels() {
    let mut actuator = [0.0; 32];
    actuator[..4].copy_from_slice(&[0.5, 0.25, 0.75, 1.0]);
    let rig = px4(&M::ACTUATOR_OUTPUT_STATUS(dialect::ACTUATOR_OUTPUT_STATUS_DATA {
        time_usec: 10_000_000,
        active: 4,
        actuator,
    }));
    close(&rig.only(Quantity::ActuatorCommand), &[0.5, 0.25, 0.75, 1.0]);
}

#[test]
fn rotor_speeds_are_in_radians_a_second() {
    let rig = px4(&M::ESC_STATUS(dialect::ESC_STATUS_DATA {
        time_usec: 10_000_000,
        rpm: [6000, -6000, 0, 60],
        index: 4,
        ..Default::default()
    }));
    close(&rig.only(Quantity::RotorSpeed), &[200.0 * PI, -200.0 * PI, 0.0, TAU]);
    assert!(matches!(rig.said[0], Said::Sample { instance: 4, .. }));
    let rig = px4(&M::ESC_TELEMETRY_1_TO_4(dialect::ESC_TELEMETRY_1_TO_4_DATA {
        rpm: [6000, 3000, 0, 60],
        ..Default::default()
    }));
    close(&rig.only(Quantity::RotorSpeed), &[200.0 * PI, 100.0 * PI, 0.0, TAU]);
}

#[test]
fn a_receivers_velocity_is_over_ground_and_needs_a_fix() {
    let with = |fix_type, vel, cog| {
        px4(&M::GPS_RAW_INT(dialect::GPS_RAW_INT_DATA { fix_type, vel, cog, ..Default::default() }))
    };
    let fix = dialect::GpsFixType::GPS_FIX_TYPE_3D_FIX;
    // to the east; the vertical velocity is not in it
    let east = with(fix, 250, 9000).only(Quantity::GpsVelocity);
    close(&east[..2], &[0.0, -2.5]);
    assert!(east[2].is_nan());
    let none = dialect::GpsFixType::GPS_FIX_TYPE_2D_FIX;
    for (fix, vel, cog) in [(none, 250, 9000), (fix, u16::MAX, 9000), (fix, 250, u16::MAX)] {
        assert!(with(fix, vel, cog).said.is_empty());
    }
}

fn battery(cells: &[u16], current_battery: i16, voltages_ext: [u16; 4]) -> M {
    let mut voltages = [u16::MAX; 10];
    voltages[..cells.len()].copy_from_slice(cells);
    M::BATTERY_STATUS(dialect::BATTERY_STATUS_DATA {
        voltages,
        current_battery,
        voltages_ext,
        ..Default::default()
    })
}

#[test]
fn battery_voltage_is_the_sum_of_the_cells_there_are() {
    let rig = px4(&battery(&[4100, 4110, 4090, 4100], 1250, [0; 4]));
    close(&rig.only(Quantity::BatteryVoltage), &[16.4]);
    close(&rig.only(Quantity::BatteryCurrent), &[12.5]);
    let rig = px4(&battery(&[4000; 10], 0, [4000, 4000, 0, 0]));
    close(&rig.only(Quantity::BatteryVoltage), &[48.0]);
}

#[test]
fn a_battery_that_is_not_measured_is_no_sample() {
    for unknown in [-1, -100] {
        assert!(px4(&battery(&[], unknown, [0; 4])).said.is_empty());
    }
    let message = M::SYS_STATUS(dialect::SYS_STATUS_DATA {
        voltage_battery: u16::MAX,
        current_battery: -1,
        ..Default::default()
    });
    assert!(px4(&message).said.is_empty());
}

#[test]
fn sys_status_has_voltage_and_current() {
    let rig = px4(&M::SYS_STATUS(dialect::SYS_STATUS_DATA {
        voltage_battery: 12_600,
        current_battery: 2998,
        ..Default::default()
    }));
    close(&rig.only(Quantity::BatteryVoltage), &[12.6]);
    close(&rig.only(Quantity::BatteryCurrent), &[29.98]);
}

#[test]
fn attitude_targets_respect_their_mask() {
    let data = dialect::ATTITUDE_TARGET_DATA {
        time_boot_ms: 10_000,
        q: [0.1_f32.cos(), 0.0, 0.1_f32.sin(), 0.0], // 0.2 rad nose up
        body_roll_rate: 0.1,
        body_pitch_rate: 0.2,
        body_yaw_rate: 0.3,
        thrust: 0.4,
        type_mask: dialect::AttitudeTargetTypemask::empty(), // the crate's default ignores the roll rate
    };
    let rig = px4(&M::ATTITUDE_TARGET(data.clone()));
    close(&rig.only(Quantity::AttitudeSetpoint), &[0.1_f64.cos(), 0.0, -(0.1_f64.sin()), 0.0]);
    close(&rig.only(Quantity::AngularRateSetpoint), &[0.1, -0.2, -0.3]);
    close(&rig.only(Quantity::ThrustSetpoint), &[0.4]);
    let type_mask = dialect::AttitudeTargetTypemask::from_bits_truncate(0b1100_0010);
    let rig = px4(&M::ATTITUDE_TARGET(dialect::ATTITUDE_TARGET_DATA { type_mask, ..data }));
    assert!(
        rig.samples(Quantity::AttitudeSetpoint).is_empty()
            && rig.samples(Quantity::ThrustSetpoint).is_empty()
    );
    close(&rig.only(Quantity::AngularRateSetpoint), &[0.1, f64::NAN, -0.3]);
}

fn position_target(mask: u16) -> dialect::POSITION_TARGET_LOCAL_NED_DATA {
    dialect::POSITION_TARGET_LOCAL_NED_DATA {
        time_boot_ms: 10_000,
        x: 1.0,
        y: 2.0,
        z: -5.0,
        vx: 0.1,
        vy: 0.2,
        vz: 0.3,
        afx: 0.4,
        afy: 0.5,
        afz: 0.6,
        yaw: FRAC_PI_2 as f32,
        yaw_rate: 0.7,
        type_mask: dialect::PositionTargetTypemask::from_bits_retain(mask),
        coordinate_frame: dialect::MavFrame::MAV_FRAME_LOCAL_NED,
    }
}

#[test]
fn position_targets_are_turned_and_respect_their_mask() {
    let rig = px4(&M::POSITION_TARGET_LOCAL_NED(position_target(0)));
    close(&rig.only(Quantity::PositionSetpoint), &[1.0, -2.0, 5.0]);
    close(&rig.only(Quantity::VelocitySetpoint), &[0.1, -0.2, -0.3]);
    close(&rig.only(Quantity::AccelerationSetpoint), &[0.4, -0.5, -0.6]);
    close(&rig.only(Quantity::YawSetpoint), &[-FRAC_PI_2]);
    close(&rig.only(Quantity::YawRateSetpoint), &[-0.7]);
    // position, yaw and yaw rate ignored, as ArduPilot answers; and one axis of the velocity
    let rig = px4(&M::POSITION_TARGET_LOCAL_NED(position_target(0b1100_0001_0111)));
    assert!(
        rig.samples(Quantity::PositionSetpoint).is_empty() && rig.samples(Quantity::YawSetpoint).is_empty()
    );
    close(&rig.only(Quantity::VelocitySetpoint), &[0.1, f64::NAN, -0.3]);
    // a force is no acceleration
    let rig = px4(&M::POSITION_TARGET_LOCAL_NED(position_target(1 << 9)));
    assert!(rig.samples(Quantity::AccelerationSetpoint).is_empty());
}

fn set_position(target_system: u8) -> M {
    M::SET_POSITION_TARGET_LOCAL_NED(dialect::SET_POSITION_TARGET_LOCAL_NED_DATA {
        time_boot_ms: 777_000_000, // the sender's clock
        z: -2.0,
        target_system,
        type_mask: dialect::PositionTargetTypemask::empty(), // the crate's default ignores x
        coordinate_frame: dialect::MavFrame::MAV_FRAME_LOCAL_NED,
        ..Default::default()
    })
}

#[test]
fn setpoints_sent_to_this_vehicle_are_placed_by_the_hosts_clock() {
    let mut rig = Rig::new(Autopilot::Px4);
    for (target, host_s) in [(1, 0.5), (0, 1.5), (2, 2.5)] {
        rig.hear_frame(host_s, &v2(header(255, 0), &set_position(target)));
    }
    let times: Vec<f64> = rig.samples(Quantity::PositionSetpoint).iter().map(|sample| sample.0).collect();
    assert_eq!(times, [0.5, 1.5]);
    close(&rig.samples(Quantity::PositionSetpoint)[0].1, &[0.0, 0.0, 2.0]);
}

#[test]
fn landed_state_unknown_is_no_sample() {
    let state = |landed_state| {
        M::EXTENDED_SYS_STATE(dialect::EXTENDED_SYS_STATE_DATA { landed_state, ..Default::default() })
    };
    let rig = px4(&state(dialect::MavLandedState::MAV_LANDED_STATE_IN_AIR));
    close(&rig.only(Quantity::LandedState), &[2.0]);
    assert!(px4(&state(dialect::MavLandedState::MAV_LANDED_STATE_UNDEFINED)).said.is_empty());
}

#[test]
fn an_unknown_enumeration_value_does_not_lose_the_heartbeat() {
    // type 200 and system status 9 do not exist; mode 0x00060000, armed
    let strange = by_hand(0, 0, 0, &[0, 0, 6, 0, 200, 12, 0x81, 9, 3], 50);
    let mut rig = Rig::new(Autopilot::Px4);
    rig.hear_frame(0.0, &strange);
    close(&rig.only(Quantity::Mode), &[393_216.0]);
    close(&rig.only(Quantity::Armed), &[1.0]);
    let record = Record { stamp_us: START_US, offset: 0, known: true, frame: support::frame(&strange) };
    assert_eq!(Vehicle::from_heartbeat(&record).unwrap().autopilot, Autopilot::Px4);
}

#[test]
fn current_mode_tells_the_mode() {
    let rig =
        px4(&M::CURRENT_MODE(dialect::CURRENT_MODE_DATA { custom_mode: 6 << 16, ..Default::default() }));
    close(&rig.only(Quantity::Mode), &[393_216.0]);
}

fn parameter(name: &str, bytes: [u8; 4], param_type: dialect::MavParamType) -> M {
    M::PARAM_VALUE(dialect::PARAM_VALUE_DATA {
        param_value: f32::from_le_bytes(bytes),
        param_id: CharArray::from(name),
        param_type,
        ..Default::default()
    })
}

#[test]
fn integer_parameters_are_bytes_on_px4_and_values_on_ardupilot() {
    use dialect::MavParamType::{MAV_PARAM_TYPE_INT32, MAV_PARAM_TYPE_REAL32};
    let rig = px4(&parameter("CA_ROTOR_COUNT", 4_i32.to_le_bytes(), MAV_PARAM_TYPE_INT32));
    assert_eq!(rig.said, [Said::Parameter("CA_ROTOR_COUNT".to_owned(), 4.0)]);
    let rig = px4(&parameter("NEGATIVE", (-7_i32).to_le_bytes(), MAV_PARAM_TYPE_INT32));
    assert_eq!(rig.said, [Said::Parameter("NEGATIVE".to_owned(), -7.0)]);
    let rig = px4(&parameter("MPC_THR_HOVER_16CH", 0.5_f32.to_le_bytes(), MAV_PARAM_TYPE_REAL32));
    assert_eq!(rig.said, [Said::Parameter("MPC_THR_HOVER_16".to_owned(), 0.5)]);
    let mut rig = Rig::new(Autopilot::ArduPilot);
    rig.hear(0.0, &parameter("FRAME_CLASS", 1_f32.to_le_bytes(), MAV_PARAM_TYPE_INT32));
    assert_eq!(rig.said, [Said::Parameter("FRAME_CLASS".to_owned(), 1.0)]);
}

#[test]
fn a_simulators_truth_is_never_read() {
    let mut rig = Rig::new(Autopilot::ArduPilot);
    let real = dialect::MavParamType::MAV_PARAM_TYPE_REAL32;
    rig.hear(0.0, &parameter("SIM_WIND_SPD", 5_f32.to_le_bytes(), real));
    rig.hear(0.0, &parameter("SIH_MASS", 1_f32.to_le_bytes(), real));
    rig.hear(0.0, &M::SIMSTATE(dialect::SIMSTATE_DATA { roll: 0.1, ..Default::default() }));
    rig.hear(0.0, &M::SIM_STATE(dialect::SIM_STATE_DATA { q1: 1.0, ..Default::default() }));
    rig.hear(0.0, &M::HIL_ACTUATOR_CONTROLS(dialect::HIL_ACTUATOR_CONTROLS_DATA::default()));
    rig.hear(0.0, &M::HIL_STATE_QUATERNION(dialect::HIL_STATE_QUATERNION_DATA::default()));
    assert!(rig.said.is_empty());
    assert_eq!(rig.decoder.report().withheld_truth, 6);
}

fn text(id: u16, chunk_seq: u8, text: &str) -> M {
    M::STATUSTEXT(dialect::STATUSTEXT_DATA {
        text: CharArray::from(text),
        id,
        chunk_seq,
        ..Default::default()
    })
}

#[test]
fn texts_are_put_together_from_their_chunks() {
    let long = "x".repeat(50);
    let mut rig = Rig::new(Autopilot::ArduPilot);
    rig.hear(1.0, &text(0, 0, "Armed\t"));
    rig.hear(2.0, &text(7, 0, &long)).hear(2.1, &text(7, 1, "end"));
    rig.hear(3.0, &text(8, 0, &long)).hear(3.1, &text(8, 2, "after a hole"));
    assert_eq!(
        rig.said,
        [
            Said::Text(1.0, "Armed".to_owned()),
            Said::Text(2.0, format!("{long}end")),
            Said::Text(3.0, format!("{long}[...]after a hole")),
        ]
    );
}

#[test]
fn texts_and_names_command_nothing_and_have_an_end() {
    let mut rig = Rig::new(Autopilot::ArduPilot);
    rig.hear(1.0, &text(0, 0, "a\u{1b}[2J\nmavid: b\r\u{9b}c\t"));
    // a letter of three bytes lies in two chunks
    let whole = format!("{}日本", "x".repeat(49));
    let bytes = whole.as_bytes();
    for (chunk_seq, part) in (0..).zip(bytes.chunks(50)) {
        let mut padded = [0; 50];
        padded[..part.len()].copy_from_slice(part);
        let data = dialect::STATUSTEXT_DATA { text: padded.into(), id: 9, chunk_seq, ..Default::default() };
        rig.hear(2.0, &M::STATUSTEXT(data));
    }
    // a sender whose chunks never end
    for _ in 0..20 {
        rig.hear(3.0, &text(5, 1, &"y".repeat(50)));
    }
    let said: Vec<&str> = rig
        .said
        .iter()
        .filter_map(|said| match said {
            Said::Text(_, text) => Some(text.as_str()),
            _ => None,
        })
        .collect();
    assert_eq!(said[..2], ["a\\u{1b}[2J\\nmavid: b\\r\\u{9b}c", &whole]);
    assert!(said.len() > 2 && said[2].len() < 1000, "{} bytes", said[2].len());
    let parameter = M::PARAM_VALUE(dialect::PARAM_VALUE_DATA {
        param_value: 1.0,
        param_id: CharArray::from("MOT_\u{1b}\nX"),
        param_type: dialect::MavParamType::MAV_PARAM_TYPE_REAL32,
        ..Default::default()
    });
    let mut rig = Rig::new(Autopilot::ArduPilot);
    rig.hear(1.0, &parameter);
    assert!(
        matches!(&rig.said[..], [Said::Parameter(name, _)] if name == "MOT_\\u{1b}\\nX"),
        "{:?}",
        rig.said
    );
}

#[test]
fn other_systems_and_components_are_not_listened_to() {
    let mut rig = Rig::new(Autopilot::Px4);
    rig.hear_frame(0.0, &v2(header(2, 0), &support::attitude(10_000)));
    let camera = mavlink::MavHeader { component_id: 100, ..header(1, 0) };
    rig.hear_frame(0.0, &v2(camera, &support::attitude(10_000)));
    rig.hear_frame(0.0, &v2(header(255, 0), &heartbeat()));
    assert!(rig.said.is_empty());
}

#[test]
fn messages_without_a_stamp_follow_a_vehicle_whose_clock_runs_slow() {
    let mut rig = Rig::new(Autopilot::Px4);
    for step in 0..6000_u32 {
        // 100 Hz of the vehicle, 0.7 % slower than the host, 3 ms or 8 ms late
        let vehicle_s = f64::from(step) * 0.01;
        let host_s = vehicle_s * 1.007 + if step % 3 == 0 { 0.008 } else { 0.003 };
        rig.hear(host_s, &support::attitude(10_000 + step * 10));
        if step % 100 == 50 {
            rig.hear(host_s + 0.004, &heartbeat());
        }
    }
    for (index, (time_s, _)) in (0_u32..).zip(rig.samples(Quantity::Armed)) {
        assert!((time_s - (f64::from(index) + 0.504)).abs() < 0.008, "{time_s}");
    }
}

#[test]
fn messages_of_one_burst_share_their_time() {
    let mut rig = Rig::new(Autopilot::ArduPilot);
    let telemetry =
        M::ESC_TELEMETRY_1_TO_4(dialect::ESC_TELEMETRY_1_TO_4_DATA { rpm: [100; 4], ..Default::default() });
    for step in 0..50_u32 {
        let jitter_s = f64::from(step * 7 % 20) * 1e-3;
        let host_s = f64::from(step) * 0.02 + jitter_s;
        rig.hear(host_s, &support::attitude(10_000 + step * 20)).hear(host_s, &telemetry);
    }
    for (index, (time_s, _)) in (0_u32..).zip(rig.samples(Quantity::RotorSpeed)) {
        assert!((time_s - f64::from(index) * 0.02).abs() < 1e-9, "{time_s}");
    }
}

#[test]
fn a_reboot_opens_a_new_stretch_placed_by_the_hosts_clock() {
    let mut rig = Rig::new(Autopilot::Px4);
    for step in 0..100_u32 {
        rig.hear(f64::from(step) * 0.1, &support::attitude(10_000 + step * 100));
    }
    // 5 s of silence, then from 1 s since boot
    for step in 0..100_u32 {
        rig.hear(15.0 + f64::from(step) * 0.1, &support::attitude(1000 + step * 100));
    }
    let resets: Vec<&Said> = rig.said.iter().filter(|said| matches!(said, Said::ClockReset(_))).collect();
    assert_eq!(resets.len(), 1, "{resets:?}");
    let times: Vec<f64> = rig.samples(Quantity::Attitude).iter().map(|sample| sample.0).collect();
    assert!(times.windows(2).all(|pair| pair[0] < pair[1]));
    assert!((times[times.len() - 1] - 24.9).abs() < 1e-6);
    assert_eq!(rig.decoder.report().stale_stamps, 2);
}

#[test]
fn one_old_stamp_is_no_reboot() {
    let mut rig = Rig::new(Autopilot::Px4);
    rig.hear(5.0, &support::attitude(15_000))
        .hear(5.1, &support::attitude(11_000))
        .hear(5.2, &support::attitude(15_200));
    assert_eq!(rig.samples(Quantity::Attitude).len(), 2);
    assert_eq!(rig.decoder.report().stale_stamps, 1);
}

#[test]
fn a_host_clock_that_jumps_does_not_move_the_vehicles() {
    let mut rig = Rig::new(Autopilot::Px4);
    for (host_s, boot_ms) in [(0.0, 10_000), (3600.0, 10_100), (-50.0, 10_200), (0.3, 10_300)] {
        rig.hear(host_s, &support::attitude(boot_ms));
    }
    let times: Vec<f64> = rig.samples(Quantity::Attitude).iter().map(|sample| sample.0).collect();
    close(&times, &[0.0, 0.1, 0.2, 0.3]);
}

#[test]
fn unix_and_boot_stamps_are_put_on_one_clock() {
    let imu = |time_usec| {
        let fields_updated = dialect::HighresImuUpdatedFlags::all();
        M::HIGHRES_IMU(dialect::HIGHRES_IMU_DATA {
            time_usec,
            zacc: -9.81,
            fields_updated,
            ..Default::default()
        })
    };
    let boot_unix_us = START_US - 10_000_000;
    // tied by what the vehicle says, although the frame is 40 ms late
    let mut rig = Rig::new(Autopilot::Px4);
    rig.hear(
        0.0,
        &M::SYSTEM_TIME(dialect::SYSTEM_TIME_DATA { time_unix_usec: START_US, time_boot_ms: 10_000 }),
    );
    rig.hear(0.140, &imu(boot_unix_us + 10_100_000));
    close(&[rig.samples(Quantity::SpecificForce)[0].0], &[0.1]);
    // without it, by the host's clock once
    let mut rig = Rig::new(Autopilot::Px4);
    rig.hear(0.0, &support::attitude(10_000))
        .hear(0.1, &imu(START_US + 55))
        .hear(0.2, &imu(START_US + 100_055));
    let times: Vec<f64> = rig.samples(Quantity::SpecificForce).iter().map(|sample| sample.0).collect();
    close(&times, &[0.1, 0.2]);
}

proptest! {
    #![proptest_config(support::cases())]

    #[test]
    fn arbitrary_payloads_do_no_harm(
        payloads in proptest::collection::vec(
            (0..mavid::wire::Source::ALL.len(), proptest::collection::vec(any::<u8>(), 0..255), any::<u32>()), 1..40,
        ),
    ) {
        let mut rig = Rig::new(Autopilot::Px4);
        for (source, payload, host_ms) in payloads {
            let id = mavid::wire::Source::ALL[source].message_id();
            rig.hear_frame(f64::from(host_ms) * 1e-3, &by_hand(id, 0, 0, &payload, 0));
        }
        for said in &rig.said {
            if let Said::Sample { time_s, .. } = said {
                prop_assert!(time_s.is_finite());
            }
        }
    }
}
