//! The topics of PX4's log: how often each is written, its fields, and their values.

use super::moment::Moment;
use super::schedule::Every::{self, Loop, Ms, Never};
use crate::physics::MAX_ROTORS;
use crate::sitl::Mode;

/// Channels of `actuator_motors` and `actuator_outputs`.
const MOTORS: usize = 12;
const OUTPUTS: usize = 16;
/// Speed controllers of `esc_status`, the type of one, and what it holds.
const ESCS: usize = 8;
pub(super) const ESC_REPORT: &str = "esc_report";
pub(super) const ESC_FIELDS: &[Field] = &[
    ("uint64_t", 1, "timestamp"),
    ("float", 1, "esc_voltage"),
    ("int32_t", 1, "esc_rpm"),
    ("uint8_t", 1, "actuator_function"),
];
/// Number of the output function of motor 1.
const FIRST_MOTOR: f64 = 101.0;
pub(super) const SECONDS_A_MINUTE: f64 = 60.0;
/// The first field of every topic: microseconds since boot.
const STAMP: &[Field] = &[("uint64_t", 1, "timestamp")];

/// Type as the format names it, length of the array, name.
pub(super) type Field = (&'static str, usize, &'static str);

/// One topic.
#[derive(Debug, Clone, Copy)]
pub(super) struct Topic {
    pub(super) name: &'static str,
    /// after the timestamp
    pub(super) fields: &'static [Field],
    pub(super) default: Every,
    pub(super) identification: Every,
    /// values in the order of the fields; none where there is nothing to say
    pub(super) fill: fn(&Moment, &mut Vec<f64>),
}

impl Topic {
    /// All fields, the timestamp first.
    pub(super) fn all_fields(&self) -> impl Iterator<Item = Field> {
        STAMP.iter().chain(self.fields).copied()
    }
}

const fn topic(
    name: &'static str,
    fields: &'static [Field],
    (default, identification): (Every, Every),
    fill: fn(&Moment, &mut Vec<f64>),
) -> Topic {
    Topic { name, fields, default, identification, fill }
}

pub(super) const TOPICS: &[Topic] = &[
    topic(
        "vehicle_attitude",
        &[("uint64_t", 1, "timestamp_sample"), ("float", 4, "q")],
        (Ms(20), Loop),
        |at, out| {
            out.push(at.time_us);
            out.extend(at.attitude);
        },
    ),
    topic(
        "vehicle_angular_velocity",
        &[("uint64_t", 1, "timestamp_sample"), ("float", 3, "xyz")],
        (Ms(20), Loop),
        |at, out| {
            out.push(at.time_us);
            out.extend(at.rates_rad_s);
        },
    ),
    topic(
        "vehicle_acceleration",
        &[("uint64_t", 1, "timestamp_sample"), ("float", 3, "xyz")],
        (Ms(52), Loop),
        |at, out| {
            out.push(at.time_us);
            out.extend(at.force_m_s2);
        },
    ),
    topic(
        "sensor_combined",
        &[
            ("float", 3, "gyro_rad"),
            ("uint32_t", 1, "gyro_integral_dt"),
            ("int32_t", 1, "accelerometer_timestamp_relative"),
            ("float", 3, "accelerometer_m_s2"),
            ("uint32_t", 1, "accelerometer_integral_dt"),
        ],
        (Loop, Loop),
        |at, out| {
            out.extend(at.mean_rates_rad_s);
            out.extend([at.period_us, 0.0]);
            out.extend(at.mean_force_m_s2);
            out.push(at.period_us);
        },
    ),
    topic(
        "vehicle_local_position",
        &[
            ("uint64_t", 1, "timestamp_sample"),
            ("float", 1, "x"),
            ("float", 1, "y"),
            ("float", 1, "z"),
            ("float", 1, "vx"),
            ("float", 1, "vy"),
            ("float", 1, "vz"),
            ("bool", 1, "xy_valid"),
            ("bool", 1, "z_valid"),
            ("bool", 1, "v_xy_valid"),
            ("bool", 1, "v_z_valid"),
            ("uint8_t", 1, "xy_reset_counter"),
            ("uint8_t", 1, "z_reset_counter"),
            ("uint8_t", 1, "vxy_reset_counter"),
            ("uint8_t", 1, "vz_reset_counter"),
        ],
        (Ms(100), Ms(20)),
        |at, out| {
            let valid = f64::from(u8::from(at.has_origin));
            out.push(at.time_us);
            out.extend(at.position_m);
            out.extend(at.velocity_m_s);
            out.extend([valid, 1.0, valid, 1.0, at.resets, at.resets, 0.0, 0.0]);
        },
    ),
    topic(
        "sensor_gps",
        &[
            ("uint64_t", 1, "timestamp_sample"),
            ("double", 1, "latitude_deg"),
            ("double", 1, "longitude_deg"),
            ("double", 1, "altitude_msl_m"),
            ("float", 1, "vel_n_m_s"),
            ("float", 1, "vel_e_m_s"),
            ("float", 1, "vel_d_m_s"),
            ("uint8_t", 1, "fix_type"),
            ("bool", 1, "vel_ned_valid"),
        ],
        (Ms(200), Ms(200)),
        |at, out| {
            out.push(at.time_us);
            out.extend(at.on_earth);
            out.extend(at.velocity_m_s);
            out.extend([3.0, 1.0]);
        },
    ),
    topic(
        "vehicle_air_data",
        &[("uint64_t", 1, "timestamp_sample"), ("float", 1, "baro_alt_meter")],
        (Ms(200), Ms(100)),
        |at, out| out.extend([at.time_us, at.on_earth[2]]),
    ),
    topic(
        "actuator_motors",
        &[
            ("uint64_t", 1, "timestamp_sample"),
            ("uint16_t", 1, "reversible_flags"),
            ("float", MOTORS, "control"),
        ],
        (Ms(100), Loop),
        |at, out| {
            out.extend([at.time_us, 0.0]);
            let is_there = |rotor: usize| at.armed && at.pulses_us.get(rotor).is_some_and(|pulse| *pulse > 0);
            let control = |rotor| if is_there(rotor) { at.motors[rotor] } else { f64::NAN };
            out.extend((0..MOTORS).map(control));
        },
    ),
    topic(
        "actuator_outputs",
        &[("uint32_t", 1, "noutputs"), ("float", OUTPUTS, "output")],
        (Ms(100), Ms(100)),
        |at, out| {
            out.push(MAX_ROTORS as f64);
            out.extend((0..OUTPUTS).map(|index| at.pulses_us.get(index).copied().map_or(0.0, f64::from)));
        },
    ),
    topic(
        "vehicle_torque_setpoint",
        &[("uint64_t", 1, "timestamp_sample"), ("float", 3, "xyz")],
        (Ms(20), Loop),
        |at, out| {
            out.push(at.time_us);
            out.extend(at.torque);
        },
    ),
    topic(
        "vehicle_thrust_setpoint",
        &[("uint64_t", 1, "timestamp_sample"), ("float", 3, "xyz")],
        (Ms(20), Loop),
        |at, out| out.extend([at.time_us, 0.0, 0.0, -at.thrust]),
    ),
    topic(
        "vehicle_attitude_setpoint",
        &[("float", 4, "q_d"), ("float", 3, "thrust_body")],
        (Ms(52), Ms(20)),
        |at, out| {
            if at.armed {
                out.extend(at.attitude_wanted);
                out.extend([0.0, 0.0, -at.thrust_wanted]);
            }
        },
    ),
    topic(
        "vehicle_rates_setpoint",
        &[("float", 1, "roll"), ("float", 1, "pitch"), ("float", 1, "yaw"), ("float", 3, "thrust_body")],
        (Ms(20), Ms(20)),
        |at, out| {
            if at.armed {
                out.extend(at.rates_wanted_rad_s);
                out.extend([0.0, 0.0, -at.thrust_wanted]);
            }
        },
    ),
    topic(
        "trajectory_setpoint",
        &[
            ("float", 3, "position"),
            ("float", 3, "velocity"),
            ("float", 3, "acceleration"),
            ("float", 1, "yaw"),
            ("float", 1, "yawspeed"),
        ],
        (Ms(200), Ms(20)),
        |at, out| {
            if at.armed {
                out.extend(at.position_wanted_m);
                out.extend(at.velocity_wanted_m_s);
                out.extend(at.acceleration_wanted_m_s2);
                out.extend([at.yaw_wanted_rad, f64::NAN]);
            }
        },
    ),
    topic(
        "esc_status",
        &[("uint8_t", 1, "esc_count"), ("uint8_t", 1, "esc_online_flags"), (ESC_REPORT, ESCS, "esc")],
        (Ms(250), Ms(20)),
        |at, out| {
            let Some(speeds) = at.rotor_speed_rad_s else { return };
            let count = at.rotor_count.min(ESCS);
            out.extend([count as f64, if count == ESCS { 255.0 } else { f64::from((1_u16 << count) - 1) }]);
            for (rotor, speed) in speeds.iter().enumerate().take(ESCS) {
                let rpm = speed * SECONDS_A_MINUTE / std::f64::consts::TAU;
                let function = if rotor < count { FIRST_MOTOR + rotor as f64 } else { 0.0 };
                out.extend([at.time_us, at.battery_v, rpm, function]);
            }
        },
    ),
    topic(
        "battery_status",
        &[("float", 1, "voltage_v"), ("float", 1, "current_a"), ("bool", 1, "connected")],
        (Ms(200), Ms(200)),
        |at, out| out.extend([at.battery_v, -1.0, 1.0]),
    ),
    topic(
        "vehicle_status",
        &[("uint8_t", 1, "arming_state"), ("uint8_t", 1, "nav_state")],
        (Ms(500), Never),
        |at, out| out.extend([if at.armed { 2.0 } else { 1.0 }, nav_state(at.mode)]),
    ),
    topic("vehicle_land_detected", &[("bool", 1, "landed")], (Ms(500), Never), |at, out| {
        out.push(f64::from(u8::from(at.landed)))
    }),
];

/// Written at once when they change.
pub(super) const STATES: [&str; 2] = ["vehicle_status", "vehicle_land_detected"];

/// PX4's number of a mode in `vehicle_status`.
fn nav_state(mode: Mode) -> f64 {
    match mode {
        Mode::Stabilize => 15.0,
        Mode::Altitude => 1.0,
        Mode::Position => 2.0,
        Mode::Hold | Mode::Brake => 4.0,
        Mode::Guided => 14.0,
        Mode::Takeoff => 17.0,
        Mode::Return => 5.0,
        Mode::Land => 18.0,
    }
}
