//! PX4.

use super::FlownBy::{self, Autopilot as Itself, Companion, Pilot};
use super::failsafe::{Choice, Failsafe, Reaction, choice};
use super::frames::{PLUS, X, class};
use super::geometry::Geometry;
use super::kind::Autopilot;
use super::limits::{Bounded, Braking};
use super::modes::{FlightMode, Numbering, Wishes};
use super::outputs::{Numbered, NumberedGroup, Outputs, PulseRange};
use super::parameters::ParameterType::{self, Int32 as I, Real32 as R};
use super::parameters::units::{B_S, DEG, DEG_S, HZ, M, M_S, M_S2, M_S3, NONE, PER_S, S};
use super::parameters::{Parameter, ParameterTable, Unit};
use super::pilot::{KillSwitch, PilotSwitches};
use super::release::Release;
use super::setpoints::{LastSetpoint, SetpointRules, Takeoff};
use super::stack::Stack;
use mavlink::dialects::ardupilotmega::MavAutopilot;
use std::time::Duration;

/// PX4: setpoints are flown in OFFBOARD, which wants a stream of them before it is entered.
pub static PX4: Stack = Stack {
    autopilot: Autopilot::Px4,
    name: "PX4",
    id: "px4",
    vehicles: "PX4 multicopter",
    mav_autopilot: MavAutopilot::MAV_AUTOPILOT_PX4,
    numbering: Numbering::MainAndSub,
    modes: &MODES,
    wishes: Wishes { external: OFFBOARD, hold: LOITER, land: LAND, home: RETURN },
    setpoints: SetpointRules {
        stream_before_mode: true,
        position_checked_in_mode: false,
        failed_is_temporary: false,
        takeoff: Takeoff::BySetpoints,
        last_setpoint: LastSetpoint::Held,
        timeout: "COM_OF_LOSS_T",
        timeout_default: Duration::from_secs(1),
    },
    parameters: ParameterTable {
        thrust: THRUST,
        failsafes: FAILSAFES,
        limits: LIMITS,
        others: OTHERS,
        renamed: &[],
        renamed_since: Release::new(1, 16),
    },
    failsafes: &[
        Failsafe { parameter: "COM_OBL_RC_ACT", choices: SETPOINTS_LOST },
        Failsafe { parameter: "NAV_DLL_ACT", choices: LINK_LOST },
        Failsafe { parameter: "NAV_RCL_ACT", choices: LINK_LOST },
        Failsafe { parameter: "COM_LOW_BAT_ACT", choices: BATTERY_LOW },
        Failsafe { parameter: "GF_ACTION", choices: FENCE },
    ],
    limits: &[
        (Bounded::HorizontalSpeed, "MPC_XY_VEL_MAX"),
        (Bounded::ClimbSpeed, "MPC_Z_VEL_MAX_UP"),
        (Bounded::DescentSpeed, "MPC_Z_VEL_MAX_DN"),
        (Bounded::Tilt, "MPC_TILTMAX_AIR"),
        (Bounded::YawRate, "MC_YAWRATE_MAX"),
    ],
    braking: Braking {
        horizontal: "MPC_ACC_HOR",
        vertical: &["MPC_ACC_UP_MAX", "MPC_ACC_DOWN_MAX"],
        tilt: "MPC_TILTMAX_AIR",
    },
    outputs: Outputs {
        function: numbered("PWM_MAIN_FUNC", ""),
        first_motor: 101,
        last_motor: 112,
        pulses: PulseRange::OfOutputs(&[
            (numbered("PWM_MAIN_MIN", ""), numbered("PWM_MAIN_MAX", "")),
            (numbered("PWM_AUX_MIN", ""), numbered("PWM_AUX_MAX", "")),
        ]),
        // 13 bits of UAVCAN's RawCommand
        bus: Some(8191),
        expo: "THR_MDL_FAC",
        linear_without_expo: true,
        hover: "MPC_THR_HOVER",
        relevant: &[
            "THR_MDL_FAC",
            "MPC_THR_HOVER",
            "PWM_MAIN_MIN",
            "PWM_MAIN_MAX",
            "PWM_MAIN_FUNC",
            "PWM_AUX_MIN",
            "PWM_AUX_MAX",
            "PWM_AUX_FUNC",
            "CA_AIRFRAME",
            "CA_ROTOR",
            "SYS_AUTOSTART",
            "BAT_N_CELLS",
            "BAT1_N_CELLS",
        ],
        gains: &["MC_ROLL", "MC_PITCH", "MC_YAW", "MPC_XY_", "MPC_Z_"],
        groups: &[
            NumberedGroup {
                entries: &[
                    numbered("CA_ROTOR", "_PX"),
                    numbered("CA_ROTOR", "_PY"),
                    numbered("CA_ROTOR", "_KM"),
                    numbered("CA_ROTOR", "_CT"),
                ],
                first: 0,
                count: None,
            },
            NumberedGroup {
                entries: &[
                    numbered("PWM_MAIN_FUNC", ""),
                    numbered("PWM_MAIN_MIN", ""),
                    numbered("PWM_MAIN_MAX", ""),
                    numbered("PWM_MAIN_DIS", ""),
                ],
                first: 1,
                count: Some(8),
            },
            NumberedGroup {
                entries: &[
                    numbered("PWM_AUX_FUNC", ""),
                    numbered("PWM_AUX_MIN", ""),
                    numbered("PWM_AUX_MAX", ""),
                    numbered("PWM_AUX_DIS", ""),
                ],
                first: 1,
                count: Some(8),
            },
        ],
        recorded: "THR_MDL_FAC and PWM_MAIN_*",
    },
    geometry: Geometry::Rotors {
        count: "CA_ROTOR_COUNT",
        place: [numbered("CA_ROTOR", "_PX"), numbered("CA_ROTOR", "_PY"), numbered("CA_ROTOR", "_PZ")],
        turning: numbered("CA_ROTOR", "_KM"),
        airframe: "SYS_AUTOSTART",
        frames: &[
            (4000, 4999, class::QUAD, X),
            (5000, 5999, class::QUAD, PLUS),
            (6000, 6999, class::HEXA, X),
            (7000, 7999, class::HEXA, PLUS),
            (8000, 8999, class::OCTA, X),
            (9000, 9999, class::OCTA, PLUS),
            (10016, 10016, class::QUAD, X),
        ],
    },
    // default and system identification
    logging: "set SDLOG_PROFILE = 9 and restart the autopilot",
    log_settings: super::logging::PX4,
    pilot: PilotSwitches {
        mode_channel: "RC_MAP_FLTMODE",
        positions: numbered("COM_FLTMODE", ""),
        no_transmitter: Some(("COM_RC_IN_MODE", 4)),
        shows_unknown: false,
        kill: KillSwitch::Channel("RC_MAP_KILL_SW"),
    },
    // until 1.13 EKF2_HGT_MODE
    height_by_pose: &[("EKF2_HGT_REF", 3.0), ("EKF2_HGT_MODE", 3.0)],
};

pub(crate) const ALTITUDE: FlightMode = mode(2, 0, "ALTCTL", "Altitude", Pilot, 1);
pub(crate) const POSITION: FlightMode = mode(3, 0, "POSCTL", "Position", Pilot, 2);
pub(crate) const TAKEOFF: FlightMode = mode(AUTO, 2, "AUTO.TAKEOFF", "Takeoff", Itself, 10);
pub(crate) const LOITER: FlightMode = mode(AUTO, 3, "AUTO.LOITER", "Hold", Itself, 4);
pub(crate) const RETURN: FlightMode = mode(AUTO, 5, "AUTO.RTL", "Return", Itself, 5);
pub(crate) const LAND: FlightMode = mode(AUTO, 6, "AUTO.LAND", "Land", Itself, 11);
pub(crate) const OFFBOARD: FlightMode = mode(6, 0, "OFFBOARD", "Offboard", Companion, 7);
pub(crate) const STABILIZED: FlightMode = mode(7, 0, "STABILIZED", "Stabilized", Pilot, 8);

/// Main mode of all AUTO modes.
const AUTO: u8 = 4;
/// No switch leads there.
const NO_SWITCH: i32 = -1;

/// Numbers and names by `px4_custom_mode.h`, titles by `nav_state_names`, switches by COM_FLTMODE1; release 1.16.
const MODES: [FlightMode; 28] = [
    mode(1, 0, "MANUAL", "Manual", Pilot, 0),
    ALTITUDE,
    POSITION,
    mode(3, 1, "POSCTL.ORBIT", "Orbit", Itself, NO_SWITCH),
    mode(3, 2, "POSCTL.SLOW", "Position Slow", Pilot, 9),
    mode(AUTO, 1, "AUTO.READY", "Ready", Itself, NO_SWITCH),
    TAKEOFF,
    LOITER,
    mode(AUTO, 4, "AUTO.MISSION", "Mission", Itself, 3),
    RETURN,
    LAND,
    mode(AUTO, 8, "AUTO.FOLLOW_TARGET", "Follow Target", Itself, 12),
    mode(AUTO, 9, "AUTO.PRECLAND", "Precision Landing", Itself, 13),
    mode(AUTO, 10, "AUTO.VTOL_TAKEOFF", "VTOL Takeoff", Itself, NO_SWITCH),
    mode(AUTO, 11, "AUTO.EXTERNAL1", "External 1", Companion, 100),
    mode(AUTO, 12, "AUTO.EXTERNAL2", "External 2", Companion, 101),
    mode(AUTO, 13, "AUTO.EXTERNAL3", "External 3", Companion, 102),
    mode(AUTO, 14, "AUTO.EXTERNAL4", "External 4", Companion, 103),
    mode(AUTO, 15, "AUTO.EXTERNAL5", "External 5", Companion, 104),
    mode(AUTO, 16, "AUTO.EXTERNAL6", "External 6", Companion, 105),
    mode(AUTO, 17, "AUTO.EXTERNAL7", "External 7", Companion, 106),
    mode(AUTO, 18, "AUTO.EXTERNAL8", "External 8", Companion, 107),
    mode(5, 0, "ACRO", "Acro", Pilot, 6),
    OFFBOARD,
    STABILIZED,
    // of older releases
    mode(8, 0, "RATTITUDE", "Rattitude", Pilot, NO_SWITCH),
    mode(10, 0, "TERMINATION", "Termination", Itself, NO_SWITCH),
    // a main mode whose sub mode is not said
    mode(AUTO, 0, "AUTO", "Auto", Itself, NO_SWITCH),
];

/// `custom_mode` of a main and a sub mode.
pub(super) const fn number(main: u8, sub: u8) -> u32 {
    Numbering::MainAndSub.number(main, sub)
}

const fn mode(
    main: u8,
    sub: u8,
    name: &'static str,
    title: &'static str,
    flown_by: FlownBy,
    switch: i32,
) -> FlightMode {
    let switch = if switch == NO_SWITCH { None } else { Some(switch) };
    FlightMode { number: number(main, sub), name, title, flown_by, switch }
}

const SETPOINTS_LOST: &[Choice] = &[
    choice(0, "changes to Position mode and, without a transmitter, descends", Reaction::Position),
    choice(1, "changes to Altitude mode: it drifts with the wind", Reaction::Altitude),
    choice(2, "changes to Stabilized mode: without a pilot it falls", Reaction::Stabilized),
    choice(3, "returns to its launch place", Reaction::Return),
    choice(4, "lands where it is", Reaction::Land),
    choice(5, "holds its position", Reaction::Hold),
    choice(6, "stops its motors in the air", Reaction::StopMotors),
    choice(7, "disarms in the air", Reaction::StopMotors),
];

/// Of a ground station and of a transmitter.
const LINK_LOST: &[Choice] = &[
    choice(0, "does nothing, its other failsafes apply", Reaction::Nothing),
    choice(1, "holds its position", Reaction::Hold),
    choice(2, "returns to its launch place", Reaction::Return),
    choice(3, "lands where it is", Reaction::Land),
    choice(5, "stops its motors in the air", Reaction::StopMotors),
    choice(6, "disarms in the air", Reaction::StopMotors),
];

const BATTERY_LOW: &[Choice] = &[
    choice(0, "only warns", Reaction::Nothing),
    choice(1, "returns to its launch place when critical", Reaction::Return),
    choice(2, "lands when critical", Reaction::Land),
    choice(3, "returns when critical and lands at the emergency level", Reaction::Return),
];

const FENCE: &[Choice] = &[
    choice(0, "does nothing", Reaction::Nothing),
    choice(1, "only warns", Reaction::Nothing),
    choice(2, "holds its position", Reaction::Hold),
    choice(3, "returns to its launch place", Reaction::Return),
    choice(4, "stops its motors in the air", Reaction::StopMotors),
    choice(5, "lands where it is", Reaction::Land),
];

const THRUST: &[Parameter] = &[
    own("THR_MDL_FAC", R, NONE),
    own("MPC_THR_HOVER", R, NONE),
    row("MPC_THR_MIN", R, NONE, 0.12),
    row("MPC_THR_MAX", R, NONE, 1.0),
    row("CA_AIRFRAME", I, NONE, 0.0),
    own("CA_ROTOR_COUNT", I, NONE),
    row("SYS_AUTOSTART", I, NONE, 4001.0),
    row("BAT1_N_CELLS", I, NONE, 4.0),
];

const FAILSAFES: &[Parameter] = &[
    row("COM_OF_LOSS_T", R, S, 1.0),
    row("COM_OBL_RC_ACT", I, NONE, 0.0),
    row("COM_RC_OVERRIDE", I, NONE, 1.0),
    row("COM_RCL_EXCEPT", I, NONE, 0.0),
    row("COM_RC_IN_MODE", I, NONE, 3.0),
    row("COM_RC_LOSS_T", R, S, 0.5),
    row("NAV_RCL_ACT", I, NONE, 2.0),
    row("NAV_DLL_ACT", I, NONE, 0.0),
    row("COM_DL_LOSS_T", I, S, 10.0),
    row("COM_LOW_BAT_ACT", I, NONE, 0.0),
    row("BAT_LOW_THR", R, NONE, 0.15),
    row("BAT_CRIT_THR", R, NONE, 0.07),
    row("BAT_EMERGEN_THR", R, NONE, 0.05),
    row("RTL_RETURN_ALT", R, M, 60.0),
    row("COM_DISARM_PRFLT", R, S, 10.0),
    row("GF_ACTION", I, NONE, 2.0),
    row("GF_MAX_HOR_DIST", R, M, 0.0),
    row("GF_MAX_VER_DIST", R, M, 0.0),
    row("GF_SOURCE", I, NONE, 0.0),
    row("RC_MAP_FLTMODE", I, NONE, 0.0),
    row("RC_MAP_KILL_SW", I, NONE, 0.0),
    row("COM_FLTMODE1", I, NONE, -1.0),
    row("COM_FLTMODE2", I, NONE, -1.0),
    row("COM_FLTMODE3", I, NONE, -1.0),
    row("COM_FLTMODE4", I, NONE, -1.0),
    row("COM_FLTMODE5", I, NONE, -1.0),
    row("COM_FLTMODE6", I, NONE, -1.0),
];

const LIMITS: &[Parameter] = &[
    row("MPC_XY_VEL_MAX", R, M_S, 12.0),
    row("MPC_Z_VEL_MAX_UP", R, M_S, 3.0),
    row("MPC_Z_VEL_MAX_DN", R, M_S, 1.5),
    row("MPC_TILTMAX_AIR", R, DEG, 45.0),
    row("MPC_ACC_HOR", R, M_S2, 3.0),
    row("MPC_ACC_UP_MAX", R, M_S2, 4.0),
    row("MPC_ACC_DOWN_MAX", R, M_S2, 3.0),
    row("MPC_JERK_AUTO", R, M_S3, 4.0),
    row("MPC_XY_P", R, PER_S, 0.95),
    row("MPC_Z_P", R, PER_S, 1.0),
    row("MPC_XY_VEL_P_ACC", R, PER_S, 1.8),
    row("MPC_Z_VEL_P_ACC", R, PER_S, 4.0),
    row("MPC_XY_VEL_D_ACC", R, NONE, 0.2),
    own("MPC_Z_VEL_D_ACC", R, NONE),
    row("MC_YAWRATE_MAX", R, DEG_S, 200.0),
];

const OTHERS: &[Parameter] = &[
    row("BAT1_SOURCE", I, NONE, 0.0),
    row("COM_ARM_WO_GPS", I, NONE, 1.0),
    row("COM_DISARM_LAND", R, S, 2.0),
    row("COM_FAIL_ACT_T", R, S, 5.0),
    row("COM_POSCTL_NAVL", I, NONE, 0.0),
    row("COM_POS_FS_EPH", R, M, 5.0),
    row("DSHOT_MIN", R, NONE, 0.055),
    row("EKF2_HGT_REF", I, NONE, 1.0),
    row("GF_PREDICT", I, NONE, 0.0),
    row("IMU_GYRO_CUTOFF", R, HZ, 40.0),
    row("IMU_GYRO_DNF_EN", I, NONE, 0.0),
    row("IMU_GYRO_RATEMAX", I, HZ, 400.0),
    row("MAV_0_FORWARD", I, NONE, 1.0),
    row("MAV_0_MODE", I, NONE, 0.0),
    row("MAV_0_RATE", I, B_S, 1200.0),
    row("MAV_COMP_ID", I, NONE, 1.0),
    row("MAV_FWDEXTSP", I, NONE, 1.0),
    row("MAV_TYPE", I, NONE, 2.0),
    row("MC_PITCHRATE_D", R, NONE, 0.003),
    row("MC_PITCHRATE_I", R, NONE, 0.2),
    row("MC_PITCHRATE_P", R, NONE, 0.15),
    row("MC_PITCH_P", R, PER_S, 6.5),
    row("MC_ROLLRATE_D", R, NONE, 0.003),
    row("MC_ROLLRATE_I", R, NONE, 0.2),
    row("MC_ROLLRATE_P", R, NONE, 0.15),
    row("MC_ROLL_P", R, PER_S, 6.5),
    row("MC_YAWRATE_P", R, NONE, 0.2),
    row("MC_YAW_P", R, PER_S, 2.8),
    row("MIS_TAKEOFF_ALT", R, M, 2.5),
    row("MPC_ACC_DECOUPLE", I, NONE, 1.0),
    row("MPC_ACC_HOR_MAX", R, M_S2, 5.0),
    row("MPC_JERK_MAX", R, M_S3, 8.0),
    row("MPC_LAND_SPEED", R, M_S, 0.7),
    row("MPC_TKO_SPEED", R, M_S, 1.5),
    row("MPC_USE_HTE", I, NONE, 1.0),
    row("MPC_XY_CRUISE", R, M_S, 5.0),
    row("MPC_XY_VEL_I_ACC", R, NONE, 0.4),
    row("MPC_Z_VEL_I_ACC", R, NONE, 2.0),
    row("MPC_Z_V_AUTO_DN", R, M_S, 1.5),
    row("MPC_Z_V_AUTO_UP", R, M_S, 3.0),
    row("NAV_ACC_RAD", R, M, 10.0),
    row("PWM_MAIN_REV", I, NONE, 0.0),
    row("PWM_MAIN_TIM0", I, HZ, 400.0),
    row("RTL_CONE_ANG", I, DEG, 45.0),
    row("RTL_DESCEND_ALT", R, M, 30.0),
    row("RTL_LAND_DELAY", R, S, 0.0),
    row("RTL_MIN_DIST", R, M, 10.0),
    row("SDLOG_BACKEND", I, NONE, 3.0),
    row("SDLOG_MODE", I, NONE, 0.0),
    row("SDLOG_PROFILE", I, NONE, 1.0),
];

const fn numbered(before: &'static str, after: &'static str) -> Numbered {
    Numbered { before, after }
}

const fn row(name: &'static str, kind: ParameterType, unit: Unit, default: f64) -> Parameter {
    Parameter::of_release(name, kind, unit, default)
}

const fn own(name: &'static str, kind: ParameterType, unit: Unit) -> Parameter {
    Parameter::of_vehicle(name, kind, unit)
}
