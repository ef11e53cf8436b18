//! ArduPilot's multirotor, ArduCopter.

use super::FlownBy::{self, Autopilot as Itself, Companion, Pilot};
use super::failsafe::{Choice, Failsafe, Reaction, choice};
use super::geometry::Geometry;
use super::kind::Autopilot;
use super::limits::{Bounded, Braking};
use super::modes::{FlightMode, Numbering, Wishes};
use super::outputs::{Numbered, NumberedGroup, Outputs, PulseRange, ThrottleChannel};
use super::parameters::ParameterType::{self, Int8 as B, Int16 as H, Int32 as I, Real32 as R};
use super::parameters::units::{
    CDEG, CDEG_S2, CM, CM_S, CM_S2, DEG, DEG_S2, HZ, M, M_S, M_S2, M_S3, MAH, NONE, PER_S, S, US, V,
};
use super::parameters::{Parameter, ParameterTable, Renamed, Unit};
use super::pilot::{KillSwitch, PilotSwitches};
use super::release::Release;
use super::setpoints::{LastSetpoint, SetpointRules, Takeoff};
use super::stack::Stack;
use mavlink::dialects::ardupilotmega::MavAutopilot;
use std::time::Duration;

/// ArduCopter: setpoints are flown in GUIDED, after a takeoff by command.
pub static ARDUPILOT: Stack = Stack {
    autopilot: Autopilot::ArduPilot,
    name: "ArduPilot",
    id: "ardupilot",
    vehicles: "ArduCopter",
    mav_autopilot: MavAutopilot::MAV_AUTOPILOT_ARDUPILOTMEGA,
    numbering: Numbering::Whole,
    modes: &MODES,
    // LOITER holds too, and is never asked for: it is a pilot's
    wishes: Wishes { external: GUIDED, hold: BRAKE, land: LAND, home: RETURN },
    setpoints: SetpointRules {
        stream_before_mode: false,
        position_checked_in_mode: true,
        failed_is_temporary: true,
        takeoff: Takeoff::ByCommand,
        last_setpoint: LastSetpoint::MovedOn,
        timeout: "GUID_TIMEOUT",
        timeout_default: Duration::from_secs(3),
    },
    parameters: ParameterTable {
        thrust: THRUST,
        failsafes: FAILSAFES,
        limits: LIMITS,
        others: OTHERS,
        renamed: RENAMED,
        renamed_since: RENAMED_SINCE,
    },
    failsafes: &[
        Failsafe { parameter: "FS_GCS_ENABLE", choices: GROUND_STATION_LOST },
        Failsafe { parameter: "FS_THR_ENABLE", choices: TRANSMITTER_LOST },
        Failsafe { parameter: "FS_EKF_ACTION", choices: ESTIMATE_BAD },
        Failsafe { parameter: "BATT_FS_LOW_ACT", choices: BATTERY_LOW },
        Failsafe { parameter: "BATT_FS_CRT_ACT", choices: BATTERY_LOW },
        Failsafe { parameter: "FENCE_ACTION", choices: FENCE },
    ],
    limits: &[
        (Bounded::HorizontalSpeed, "WPNAV_SPEED"),
        (Bounded::ClimbSpeed, "WPNAV_SPEED_UP"),
        (Bounded::DescentSpeed, "WPNAV_SPEED_DN"),
        (Bounded::HorizontalAcceleration, "WPNAV_ACCEL"),
        (Bounded::VerticalAcceleration, "WPNAV_ACCEL_Z"),
        (Bounded::HorizontalJerk, "PSC_JERK_XY"),
        (Bounded::VerticalJerk, "PSC_JERK_Z"),
        (Bounded::Tilt, "ANGLE_MAX"),
    ],
    braking: Braking { horizontal: "WPNAV_ACCEL", vertical: &["WPNAV_ACCEL_Z"], tilt: "ANGLE_MAX" },
    outputs: Outputs {
        function: FUNCTION,
        first_motor: 33,
        last_motor: 40,
        // full command at MOT_SPIN_MAX of the range, none at MOT_SPIN_MIN
        pulses: PulseRange::Shares {
            ends: ("MOT_PWM_MIN", "MOT_PWM_MAX"),
            shares: ("MOT_SPIN_MIN", "MOT_SPIN_MAX"),
            // before 4.2 a vehicle may have MOT_PWM_MIN and MOT_PWM_MAX at zero
            otherwise: ThrottleChannel {
                channel: ("RCMAP_THROTTLE", 3),
                ends: (numbered("RC", "_MIN"), numbered("RC", "_MAX")),
            },
        },
        // logged as pulses whatever they go over
        bus: None,
        expo: "MOT_THST_EXPO",
        linear_without_expo: false,
        hover: "MOT_THST_HOVER",
        relevant: &["MOT_", "FRAME_"],
        gains: &["ATC_", "PSC_"],
        groups: &[
            NumberedGroup { entries: &[FUNCTION], first: 1, count: Some(16) },
            // pulse ranges of the motors come from MOT_PWM_*; a reversed output would still turn them round
            NumberedGroup { entries: &[numbered("SERVO", "_REVERSED")], first: 1, count: None },
        ],
        recorded: "MOT_* and SERVOn_FUNCTION",
    },
    geometry: Geometry::Class { class: "FRAME_CLASS", kind: "FRAME_TYPE", former: "FRAME" },
    // fast attitude; RC output; fast and raw IMU. Motors are at 10 Hz whatever is asked for
    logging: "add bits 0 (fast attitude), 10 (RC output) and 18 (fast IMU) to LOG_BITMASK",
    log_settings: super::logging::ARDUPILOT,
    pilot: PilotSwitches {
        mode_channel: "FLTMODE_CH",
        positions: numbered("FLTMODE", ""),
        no_transmitter: None,
        shows_unknown: true,
        // motor emergency stop, and arming with it
        kill: KillSwitch::Option { option: numbered("RC", "_OPTION"), channels: 5..=16, stops: [31, 165] },
    },
    height_by_pose: &[("EK3_SRC1_POSZ", 6.0)],
};

pub(crate) const STABILIZE: FlightMode = mode(0, "STABILIZE", Pilot);
pub(crate) const ALT_HOLD: FlightMode = mode(2, "ALT_HOLD", Pilot);
pub(crate) const GUIDED: FlightMode = mode(4, "GUIDED", Companion);
pub(crate) const LOITER: FlightMode = mode(5, "LOITER", Pilot);
pub(crate) const RETURN: FlightMode = mode(6, "RTL", Itself);
pub(crate) const LAND: FlightMode = mode(9, "LAND", Itself);
pub(crate) const POSHOLD: FlightMode = mode(16, "POSHOLD", Pilot);
pub(crate) const BRAKE: FlightMode = mode(17, "BRAKE", Itself);

/// Numbers and names of COPTER_MODE in the message definitions. A mode switch takes the same numbers.
const MODES: [FlightMode; 26] = [
    STABILIZE,
    mode(1, "ACRO", Pilot),
    ALT_HOLD,
    mode(3, "AUTO", Itself),
    GUIDED,
    LOITER,
    RETURN,
    mode(7, "CIRCLE", Itself),
    LAND,
    mode(11, "DRIFT", Pilot),
    mode(13, "SPORT", Pilot),
    mode(14, "FLIP", Itself),
    mode(15, "AUTOTUNE", Pilot),
    POSHOLD,
    BRAKE,
    mode(18, "THROW", Itself),
    mode(19, "AVOID_ADSB", Itself),
    mode(20, "GUIDED_NOGPS", Companion),
    mode(21, "SMART_RTL", Itself),
    mode(22, "FLOWHOLD", Pilot),
    mode(23, "FOLLOW", Itself),
    mode(24, "ZIGZAG", Pilot),
    mode(25, "SYSTEMID", Pilot),
    mode(26, "AUTOROTATE", Itself),
    mode(27, "AUTO_RTL", Itself),
    mode(28, "TURTLE", Pilot),
];

const fn mode(number: u8, name: &'static str, flown_by: FlownBy) -> FlightMode {
    let switch = Some(number as i32);
    FlightMode { number: Numbering::Whole.number(number, 0), name, title: name, flown_by, switch }
}

const GROUND_STATION_LOST: &[Choice] = &[
    choice(0, "does nothing and stays in GUIDED", Reaction::Nothing),
    choice(1, "returns to its launch place", Reaction::Return),
    choice(2, "returns to its launch place", Reaction::Return),
    choice(3, "returns by the way it came, or straight", Reaction::Return),
    choice(4, "returns by the way it came, or lands", Reaction::Return),
    choice(5, "lands where it is", Reaction::Land),
    choice(6, "lands by its mission's landing sequence, or returns", Reaction::Return),
    choice(7, "brakes, or lands", Reaction::Hold),
];

const TRANSMITTER_LOST: &[Choice] = &[
    choice(0, "does nothing", Reaction::Nothing),
    choice(1, "returns to its launch place", Reaction::Return),
    choice(2, "returns to its launch place", Reaction::Return),
    choice(3, "lands where it is", Reaction::Land),
    choice(4, "returns by the way it came, or straight", Reaction::Return),
    choice(5, "returns by the way it came, or lands", Reaction::Return),
    choice(6, "lands by its mission's landing sequence, or returns", Reaction::Return),
    choice(7, "brakes, or lands", Reaction::Hold),
];

const ESTIMATE_BAD: &[Choice] = &[
    choice(0, "only reports", Reaction::Nothing),
    choice(1, "lands", Reaction::Land),
    choice(2, "changes to AltHold: it drifts with the wind", Reaction::Altitude),
    choice(3, "lands", Reaction::Land),
];

const BATTERY_LOW: &[Choice] = &[
    choice(0, "only warns", Reaction::Nothing),
    choice(1, "lands where it is", Reaction::Land),
    choice(2, "returns to its launch place", Reaction::Return),
    choice(3, "returns by the way it came, or straight", Reaction::Return),
    choice(4, "returns by the way it came, or lands", Reaction::Return),
    choice(5, "stops its motors in the air", Reaction::StopMotors),
    choice(6, "lands by its mission's landing sequence, or returns", Reaction::Return),
    choice(7, "brakes, or lands", Reaction::Hold),
];

const FENCE: &[Choice] = &[
    choice(0, "only reports", Reaction::Nothing),
    choice(1, "returns to its launch place, or lands", Reaction::Return),
    choice(2, "lands where it is", Reaction::Land),
    choice(3, "returns by the way it came, or lands", Reaction::Return),
    choice(4, "brakes, or lands", Reaction::Hold),
    choice(5, "returns by the way it came, or lands", Reaction::Return),
];

/// Centimetres became metres, centidegrees degrees. `ARMING_CHECK` is not among them: its successor `ARMING_SKIPCHK`
/// means the opposite.
const RENAMED: &[Renamed] = &[
    renamed("WPNAV_SPEED", CM_S, "WP_SPD", R, M_S),
    renamed("WPNAV_SPEED_UP", CM_S, "WP_SPD_UP", R, M_S),
    renamed("WPNAV_SPEED_DN", CM_S, "WP_SPD_DN", R, M_S),
    renamed("WPNAV_ACCEL", CM_S2, "WP_ACC", R, M_S2),
    renamed("WPNAV_ACCEL_Z", CM_S2, "WP_ACC_Z", R, M_S2),
    renamed("WPNAV_JERK", M_S3, "WP_JERK", R, M_S3),
    renamed("WPNAV_RADIUS", CM, "WP_RADIUS_M", R, M),
    renamed("PSC_JERK_XY", M_S3, "PSC_NE_JERK", R, M_S3),
    renamed("PSC_JERK_Z", M_S3, "PSC_D_JERK", R, M_S3),
    renamed("PSC_POSXY_P", PER_S, "PSC_NE_POS_P", R, PER_S),
    renamed("PSC_POSZ_P", PER_S, "PSC_D_POS_P", R, PER_S),
    renamed("PSC_VELXY_P", PER_S, "PSC_NE_VEL_P", R, PER_S),
    renamed("ANGLE_MAX", CDEG, "ATC_ANGLE_MAX", R, DEG),
    renamed("ATC_ACCEL_R_MAX", CDEG_S2, "ATC_ACC_R_MAX", R, DEG_S2),
    renamed("ATC_ACCEL_P_MAX", CDEG_S2, "ATC_ACC_P_MAX", R, DEG_S2),
    renamed("ATC_ACCEL_Y_MAX", CDEG_S2, "ATC_ACC_Y_MAX", R, DEG_S2),
    renamed("RTL_ALT", CM, "RTL_ALT_M", R, M),
    renamed("RTL_ALT_FINAL", CM, "RTL_ALT_FINAL_M", R, M),
    renamed("RTL_CLIMB_MIN", CM, "RTL_CLIMB_MIN_M", R, M),
    renamed("RTL_SPEED", CM_S, "RTL_SPEED_MS", R, M_S),
    renamed("LAND_ALT_LOW", CM, "LAND_ALT_LOW_M", R, M),
    renamed("LAND_SPEED", CM_S, "LAND_SPD_MS", R, M_S),
    renamed("LAND_SPEED_HIGH", CM_S, "LAND_SPD_HIGH_MS", R, M_S),
    renamed("LOIT_SPEED", CM_S, "LOIT_SPEED_MS", R, M_S),
    renamed("PILOT_SPEED_UP", CM_S, "PILOT_SPD_UP", R, M_S),
    renamed("SYSID_THISMAV", NONE, "MAV_SYSID", I, NONE),
    renamed("SYSID_MYGCS", NONE, "MAV_GCS_SYSID", I, NONE),
    // development versions before 4.7
    renamed("PSC_JERK_XY", M_S3, "PSC_JERK_NE", R, M_S3),
    renamed("PSC_JERK_Z", M_S3, "PSC_JERK_D", R, M_S3),
];
const RENAMED_SINCE: Release = Release::new(4, 7);

const THRUST: &[Parameter] = &[
    own("FRAME_CLASS", B, NONE),
    own("FRAME_TYPE", B, NONE),
    own("MOT_PWM_MIN", H, US),
    own("MOT_PWM_MAX", H, US),
    row("MOT_PWM_TYPE", B, NONE, 0.0),
    row("MOT_SPIN_MIN", R, NONE, 0.15),
    row("MOT_SPIN_MAX", R, NONE, 0.95),
    row("MOT_SPIN_ARM", R, NONE, 0.10),
    own("MOT_THST_EXPO", R, NONE),
    own("MOT_THST_HOVER", R, NONE),
    row("MOT_HOVER_LEARN", B, NONE, 2.0),
    row("MOT_BAT_VOLT_MAX", R, V, 0.0),
    row("MOT_BAT_VOLT_MIN", R, V, 0.0),
    row("MOT_BAT_IDX", B, NONE, 0.0),
    row("MOT_OPTIONS", H, NONE, 0.0),
];

const FAILSAFES: &[Parameter] = &[
    row("GUID_TIMEOUT", R, S, 3.0),
    row("GUID_OPTIONS", I, NONE, 0.0),
    row("FS_GCS_ENABLE", B, NONE, 0.0),
    row("FS_GCS_TIMEOUT", R, S, 5.0),
    row("SYSID_MYGCS", H, NONE, 255.0),
    own("SYSID_THISMAV", I, NONE),
    row("FS_THR_ENABLE", B, NONE, 0.0),
    row("FS_EKF_ACTION", B, NONE, 1.0),
    row("FS_EKF_THRESH", R, NONE, 0.8),
    row("FS_OPTIONS", I, NONE, 16.0),
    row("BATT_FS_LOW_ACT", B, NONE, 0.0),
    row("BATT_FS_CRT_ACT", B, NONE, 0.0),
    row("BATT_LOW_VOLT", R, V, 10.5),
    row("BATT_CRT_VOLT", R, V, 0.0),
    own("BATT_LOW_MAH", R, MAH),
    row("BATT_CAPACITY", I, MAH, 3300.0),
    row("RTL_ALT", R, CM, 1500.0),
    row("RTL_CLIMB_MIN", H, CM, 0.0),
    row("RTL_CONE_SLOPE", R, NONE, 3.0),
    row("LAND_SPEED", H, CM_S, 50.0),
    row("DISARM_DELAY", B, S, 10.0),
    row("ARMING_CHECK", I, NONE, 1.0).until(RENAMED_SINCE),
    row("ARMING_SKIPCHK", I, NONE, 0.0).since(RENAMED_SINCE),
    row("FENCE_ENABLE", B, NONE, 0.0),
    row("FENCE_AUTOENABLE", B, NONE, 0.0),
    row("FENCE_TYPE", B, NONE, 7.0),
    row("FENCE_ACTION", B, NONE, 1.0),
    row("FENCE_ALT_MAX", R, M, 100.0),
    row("FENCE_ALT_MIN", R, M, -10.0),
    row("FENCE_RADIUS", R, M, 300.0),
    row("FENCE_MARGIN", R, M, 2.0),
    row("FLTMODE_CH", B, NONE, 5.0),
    row("FLTMODE1", B, NONE, 0.0),
    row("FLTMODE2", B, NONE, 0.0),
    row("FLTMODE3", B, NONE, 0.0),
    row("FLTMODE4", B, NONE, 0.0),
    row("FLTMODE5", B, NONE, 0.0),
    row("FLTMODE6", B, NONE, 0.0),
];

const LIMITS: &[Parameter] = &[
    row("WPNAV_SPEED", R, CM_S, 1000.0),
    row("WPNAV_SPEED_UP", R, CM_S, 250.0),
    row("WPNAV_SPEED_DN", R, CM_S, 150.0),
    row("WPNAV_ACCEL", R, CM_S2, 250.0),
    row("WPNAV_ACCEL_Z", R, CM_S2, 100.0),
    row("WPNAV_JERK", R, M_S3, 1.0),
    row("PSC_JERK_XY", R, M_S3, 5.0),
    row("PSC_JERK_Z", R, M_S3, 5.0),
    row("ANGLE_MAX", H, CDEG, 3000.0),
    row("ATC_ACCEL_R_MAX", R, CDEG_S2, 110_000.0),
    row("ATC_ACCEL_P_MAX", R, CDEG_S2, 110_000.0),
    row("ATC_ACCEL_Y_MAX", R, CDEG_S2, 27_000.0),
];

const OTHERS: &[Parameter] = &[
    row("ATC_ANG_PIT_P", R, PER_S, 4.5),
    row("ATC_ANG_RLL_P", R, PER_S, 4.5),
    row("ATC_ANG_YAW_P", R, PER_S, 4.5),
    row("ATC_RAT_PIT_D", R, NONE, 0.0036),
    row("ATC_RAT_PIT_I", R, NONE, 0.135),
    row("ATC_RAT_PIT_P", R, NONE, 0.135),
    row("ATC_RAT_RLL_D", R, NONE, 0.0036),
    row("ATC_RAT_RLL_I", R, NONE, 0.135),
    row("ATC_RAT_RLL_P", R, NONE, 0.135),
    row("ATC_RAT_YAW_P", R, NONE, 0.18),
    row("BATT_MONITOR", B, NONE, 4.0),
    row("EK3_ENABLE", B, NONE, 1.0),
    row("FENCE_TOTAL", B, NONE, 0.0),
    row("INS_ACCEL_FILTER", H, HZ, 20.0),
    row("INS_GYRO_FILTER", H, HZ, 20.0),
    row("INS_LOG_BAT_MASK", B, NONE, 0.0),
    row("INS_LOG_BAT_OPT", H, NONE, 0.0),
    row("LOG_BACKEND_TYPE", B, NONE, 1.0),
    row("LOG_BITMASK", I, NONE, 176_126.0),
    row("LOG_DISARMED", B, NONE, 0.0),
    row("LOG_FILE_RATEMAX", R, HZ, 0.0),
    row("MOT_SLEW_DN_TIME", R, S, 0.0),
    row("MOT_SLEW_UP_TIME", R, S, 0.0),
    row("SCHED_LOOP_RATE", H, HZ, 400.0),
    row("SERVO_BLH_POLES", B, NONE, 14.0),
    row("WP_YAW_BEHAVIOR", B, NONE, 2.0),
    row("LAND_ALT_LOW", H, CM, 1000.0),
    row("LAND_SPEED_HIGH", H, CM_S, 0.0),
    row("LOIT_SPEED", R, CM_S, 1250.0),
    row("PILOT_SPEED_UP", H, CM_S, 250.0),
    row("PSC_POSXY_P", R, PER_S, 1.0),
    row("PSC_POSZ_P", R, PER_S, 1.0),
    row("PSC_VELXY_P", R, PER_S, 2.0),
    row("RTL_ALT_FINAL", H, CM, 0.0),
    row("RTL_SPEED", H, CM_S, 0.0),
    row("SYSID_ENFORCE", B, NONE, 0.0).until(RENAMED_SINCE),
    row("WPNAV_RADIUS", R, CM, 200.0),
    row("MAV_GCS_SYSID_HI", I, NONE, 0.0).since(RENAMED_SINCE),
    row("MAV_OPTIONS", I, NONE, 0.0).since(RENAMED_SINCE),
];

const FUNCTION: Numbered = numbered("SERVO", "_FUNCTION");

const fn numbered(before: &'static str, after: &'static str) -> Numbered {
    Numbered { before, after }
}

const fn row(name: &'static str, kind: ParameterType, unit: Unit, default: f64) -> Parameter {
    Parameter::of_release(name, kind, unit, default)
}

const fn own(name: &'static str, kind: ParameterType, unit: Unit) -> Parameter {
    Parameter::of_vehicle(name, kind, unit)
}

const fn renamed(
    old: &'static str,
    before: Unit,
    new: &'static str,
    kind: ParameterType,
    since: Unit,
) -> Renamed {
    Renamed { old, new, kind, scale: before.per_base / since.per_base }
}
