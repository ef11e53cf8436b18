//! PX4's parameters: defaults of the multicopter modules (v1.16), and what follows from the vehicle.

use super::parameter::ParameterType::{Int32 as I, Real32 as R};
use super::parameter::{Parameter, Row, parameter, rows};
use super::pulses::Pulses;
use super::thrust::{expo, hover_share};
use crate::frames::{Body, frd_from_body};
use crate::vehicle::{Spin, Vehicle as Description};

const DEFAULTS: &[Row] = &[
    ("BAT1_N_CELLS", I, 4.0),
    ("BAT1_SOURCE", I, 0.0),
    ("BAT_CRIT_THR", R, 0.07),
    ("BAT_EMERGEN_THR", R, 0.05),
    ("BAT_LOW_THR", R, 0.15),
    ("CA_AIRFRAME", I, 0.0),
    ("COM_ARM_WO_GPS", I, 1.0),
    ("COM_DISARM_LAND", R, 2.0),
    ("COM_DISARM_PRFLT", R, 10.0),
    ("COM_DL_LOSS_T", I, 10.0),
    ("COM_FLTMODE1", I, -1.0),
    ("COM_FLTMODE2", I, -1.0),
    ("COM_FLTMODE3", I, -1.0),
    ("COM_FLTMODE4", I, -1.0),
    ("COM_FLTMODE5", I, -1.0),
    ("COM_FLTMODE6", I, -1.0),
    ("COM_FAIL_ACT_T", R, 5.0),
    ("COM_LOW_BAT_ACT", I, 0.0),
    ("COM_OBL_RC_ACT", I, 0.0),
    ("COM_OF_LOSS_T", R, 1.0),
    ("COM_POSCTL_NAVL", I, 0.0),
    ("COM_POS_FS_EPH", R, 5.0),
    ("COM_RCL_EXCEPT", I, 0.0),
    ("COM_RC_IN_MODE", I, 3.0),
    ("COM_RC_LOSS_T", R, 0.5),
    ("COM_RC_OVERRIDE", I, 1.0),
    ("DSHOT_MIN", R, 0.055),
    ("EKF2_HGT_REF", I, 1.0),
    ("GF_ACTION", I, 2.0),
    ("GF_MAX_HOR_DIST", R, 0.0),
    ("GF_MAX_VER_DIST", R, 0.0),
    ("GF_PREDICT", I, 0.0),
    ("GF_SOURCE", I, 0.0),
    ("IMU_GYRO_CUTOFF", R, 40.0),
    ("IMU_GYRO_DNF_EN", I, 0.0),
    ("IMU_GYRO_RATEMAX", I, 400.0),
    ("MAV_0_FORWARD", I, 1.0),
    ("MAV_0_MODE", I, 0.0),
    ("MAV_0_RATE", I, 1200.0),
    ("MAV_COMP_ID", I, 1.0),
    ("MAV_FWDEXTSP", I, 1.0),
    ("MAV_TYPE", I, 2.0),
    ("MC_PITCHRATE_D", R, 0.003),
    ("MC_PITCHRATE_I", R, 0.2),
    ("MC_PITCHRATE_P", R, 0.15),
    ("MC_PITCH_P", R, 6.5),
    ("MC_ROLLRATE_D", R, 0.003),
    ("MC_ROLLRATE_I", R, 0.2),
    ("MC_ROLLRATE_P", R, 0.15),
    ("MC_ROLL_P", R, 6.5),
    ("MC_YAWRATE_MAX", R, 200.0),
    ("MC_YAWRATE_P", R, 0.2),
    ("MC_YAW_P", R, 2.8),
    ("MIS_TAKEOFF_ALT", R, 2.5),
    ("MPC_ACC_DECOUPLE", I, 1.0),
    ("MPC_ACC_DOWN_MAX", R, 3.0),
    ("MPC_ACC_HOR", R, 3.0),
    ("MPC_ACC_HOR_MAX", R, 5.0),
    ("MPC_ACC_UP_MAX", R, 4.0),
    ("MPC_JERK_AUTO", R, 4.0),
    ("MPC_JERK_MAX", R, 8.0),
    ("MPC_LAND_SPEED", R, 0.7),
    ("MPC_THR_MAX", R, 1.0),
    ("MPC_THR_MIN", R, 0.12),
    ("MPC_TILTMAX_AIR", R, 45.0),
    ("MPC_TKO_SPEED", R, 1.5),
    ("MPC_USE_HTE", I, 1.0),
    ("MPC_XY_CRUISE", R, 5.0),
    ("MPC_XY_P", R, 0.95),
    ("MPC_XY_VEL_D_ACC", R, 0.2),
    ("MPC_XY_VEL_I_ACC", R, 0.4),
    ("MPC_XY_VEL_MAX", R, 12.0),
    ("MPC_XY_VEL_P_ACC", R, 1.8),
    ("MPC_Z_P", R, 1.0),
    ("MPC_Z_VEL_I_ACC", R, 2.0),
    ("MPC_Z_VEL_MAX_DN", R, 1.5),
    ("MPC_Z_VEL_MAX_UP", R, 3.0),
    ("MPC_Z_VEL_P_ACC", R, 4.0),
    ("MPC_Z_V_AUTO_DN", R, 1.5),
    ("MPC_Z_V_AUTO_UP", R, 3.0),
    ("NAV_ACC_RAD", R, 10.0),
    ("NAV_DLL_ACT", I, 0.0),
    ("NAV_RCL_ACT", I, 2.0),
    ("PWM_MAIN_REV", I, 0.0),
    ("PWM_MAIN_TIM0", I, 400.0),
    ("RTL_CONE_ANG", I, 45.0),
    ("RTL_DESCEND_ALT", R, 30.0),
    ("RTL_LAND_DELAY", R, 0.0),
    ("RTL_MIN_DIST", R, 10.0),
    ("RTL_RETURN_ALT", R, 60.0),
    ("SDLOG_PROFILE", I, 1.0),
    ("SYS_AUTOSTART", I, 4001.0),
    ("RC_MAP_FLTMODE", I, 0.0),
    ("RC_MAP_KILL_SW", I, 0.0),
];

/// Defaults for a vehicle.
pub(super) fn defaults(vehicle: &Description, pulses: &Pulses, system: u8) -> Vec<Parameter> {
    let mut list: Vec<Parameter> = rows(DEFAULTS).collect();
    list.push(parameter("MAV_SYS_ID".into(), I, system.into()));
    list.push(parameter("THR_MDL_FAC".into(), R, expo(vehicle)));
    list.push(parameter("MPC_THR_HOVER".into(), R, hover_share(vehicle)));
    list.push(parameter("CA_ROTOR_COUNT".into(), I, vehicle.rotors.len() as f64));
    for (rotor, hub) in vehicle.rotors.iter().enumerate() {
        let [px, py, pz] = frd_from_body(Body(hub.position_m));
        // KM > 0 turns counter-clockwise
        let km = match hub.spin {
            Spin::Ccw => vehicle.propulsion.torque_per_thrust_m,
            Spin::Cw => -vehicle.propulsion.torque_per_thrust_m,
        };
        let own = [
            ("PX", px),
            ("PY", py),
            ("PZ", pz),
            ("AX", 0.0),
            ("AY", 0.0),
            ("AZ", -1.0),
            ("CT", 6.5),
            ("KM", km),
        ];
        for (end, value) in own {
            // + 0.0 turns a negative zero into zero
            list.push(parameter(format!("CA_ROTOR{rotor}_{end}"), R, value + 0.0));
        }
    }
    for output in 1..=8_u8 {
        let is_motor = usize::from(output) <= vehicle.rotors.len();
        let function = if is_motor { 100.0 + f64::from(output) } else { 0.0 };
        let own =
            [("FUNC", function), ("MIN", pulses.min_us), ("MAX", pulses.max_us), ("DIS", pulses.off_us)];
        for (name, value) in own {
            list.push(parameter(format!("PWM_MAIN_{name}{output}"), I, value));
        }
    }
    list
}
