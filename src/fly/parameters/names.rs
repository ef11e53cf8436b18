//! Which parameters matter, and by which names an autopilot may know them.

use crate::autopilot::Autopilot;

/// What a parameter is needed for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Purpose {
    /// from an actuator output to a rotor's thrust
    Thrust,
    /// what the vehicle does by itself
    Failsafe,
    /// what the autopilot makes of a setpoint
    Limit,
}

/// A parameter that changed its name and perhaps its unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Renamed {
    /// before
    pub old: &'static str,
    /// since
    pub new: &'static str,
    /// value under the old name = scale times value under the new one
    pub scale: f64,
}

const fn renamed(old: &'static str, new: &'static str, scale: f64) -> Renamed {
    Renamed { old, new, scale }
}

/// ArduPilot 4.7: centimetres became metres, centidegrees degrees. `ARMING_CHECK` is not among them: its
/// successor `ARMING_SKIPCHK` means the opposite.
pub const RENAMED: &[Renamed] = &[
    renamed("WPNAV_SPEED", "WP_SPD", 100.0),
    renamed("WPNAV_SPEED_UP", "WP_SPD_UP", 100.0),
    renamed("WPNAV_SPEED_DN", "WP_SPD_DN", 100.0),
    renamed("WPNAV_ACCEL", "WP_ACC", 100.0),
    renamed("WPNAV_ACCEL_Z", "WP_ACC_Z", 100.0),
    renamed("WPNAV_JERK", "WP_JERK", 1.0),
    renamed("PSC_JERK_XY", "PSC_NE_JERK", 1.0),
    renamed("PSC_JERK_Z", "PSC_D_JERK", 1.0),
    // before 4.7 was released
    renamed("PSC_JERK_XY", "PSC_JERK_NE", 1.0),
    renamed("PSC_JERK_Z", "PSC_JERK_D", 1.0),
    renamed("ANGLE_MAX", "ATC_ANGLE_MAX", 100.0),
    renamed("ATC_ACCEL_R_MAX", "ATC_ACC_R_MAX", 100.0),
    renamed("ATC_ACCEL_P_MAX", "ATC_ACC_P_MAX", 100.0),
    renamed("ATC_ACCEL_Y_MAX", "ATC_ACC_Y_MAX", 100.0),
    renamed("RTL_ALT", "RTL_ALT_M", 100.0),
    renamed("LAND_SPEED", "LAND_SPD_MS", 100.0),
    renamed("SYSID_THISMAV", "MAV_SYSID", 1.0),
    renamed("SYSID_MYGCS", "MAV_GCS_SYSID", 1.0),
];

/// A parameter to ask for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RequestedEffects {
    /// names by which it may answer, older first
    pub names: Vec<String>,
    /// what for
    pub purpose: Purpose,
}

const PX4: &[(Purpose, &[&str])] = &[
    (
        Purpose::Thrust,
        &[
            "THR_MDL_FAC",
            "MPC_THR_HOVER",
            "MPC_THR_MIN",
            "MPC_THR_MAX",
            "CA_AIRFRAME",
            "CA_ROTOR_COUNT",
            "SYS_AUTOSTART",
            "BAT1_N_CELLS",
        ],
    ),
    (
        Purpose::Failsafe,
        &[
            "COM_OF_LOSS_T",
            "COM_OBL_RC_ACT",
            "COM_RC_OVERRIDE",
            "COM_RCL_EXCEPT",
            "COM_RC_IN_MODE",
            "COM_RC_LOSS_T",
            "NAV_RCL_ACT",
            "NAV_DLL_ACT",
            "COM_DL_LOSS_T",
            "COM_LOW_BAT_ACT",
            "BAT_LOW_THR",
            "BAT_CRIT_THR",
            "BAT_EMERGEN_THR",
            "RTL_RETURN_ALT",
            "COM_DISARM_PRFLT",
            "GF_ACTION",
            "GF_MAX_HOR_DIST",
            "GF_MAX_VER_DIST",
            "GF_SOURCE",
            "RC_MAP_FLTMODE",
            "RC_MAP_KILL_SW",
            "COM_FLTMODE1",
            "COM_FLTMODE2",
            "COM_FLTMODE3",
            "COM_FLTMODE4",
            "COM_FLTMODE5",
            "COM_FLTMODE6",
        ],
    ),
    (
        Purpose::Limit,
        &[
            "MPC_XY_VEL_MAX",
            "MPC_Z_VEL_MAX_UP",
            "MPC_Z_VEL_MAX_DN",
            "MPC_TILTMAX_AIR",
            "MPC_ACC_HOR",
            "MPC_ACC_UP_MAX",
            "MPC_ACC_DOWN_MAX",
            "MPC_JERK_AUTO",
            "MPC_XY_P",
            "MPC_Z_P",
            "MPC_XY_VEL_P_ACC",
            "MPC_Z_VEL_P_ACC",
            "MPC_XY_VEL_D_ACC",
            "MPC_Z_VEL_D_ACC",
            "MC_YAWRATE_MAX",
        ],
    ),
];

const ARDUPILOT: &[(Purpose, &[&str])] = &[
    (
        Purpose::Thrust,
        &[
            "FRAME_CLASS",
            "FRAME_TYPE",
            "MOT_PWM_MIN",
            "MOT_PWM_MAX",
            "MOT_PWM_TYPE",
            "MOT_SPIN_MIN",
            "MOT_SPIN_MAX",
            "MOT_SPIN_ARM",
            "MOT_THST_EXPO",
            "MOT_THST_HOVER",
            "MOT_HOVER_LEARN",
            "MOT_BAT_VOLT_MAX",
            "MOT_BAT_VOLT_MIN",
            "MOT_BAT_IDX",
            "MOT_OPTIONS",
        ],
    ),
    (
        Purpose::Failsafe,
        &[
            "GUID_TIMEOUT",
            "GUID_OPTIONS",
            "FS_GCS_ENABLE",
            "FS_GCS_TIMEOUT",
            "SYSID_MYGCS",
            "SYSID_THISMAV",
            "FS_THR_ENABLE",
            "FS_EKF_ACTION",
            "FS_EKF_THRESH",
            "FS_OPTIONS",
            "BATT_FS_LOW_ACT",
            "BATT_FS_CRT_ACT",
            "BATT_LOW_VOLT",
            "BATT_CRT_VOLT",
            "BATT_LOW_MAH",
            "BATT_CAPACITY",
            "RTL_ALT",
            "LAND_SPEED",
            "DISARM_DELAY",
            "ARMING_CHECK",
            "ARMING_SKIPCHK",
            "FENCE_ENABLE",
            "FENCE_TYPE",
            "FENCE_ACTION",
            "FENCE_ALT_MAX",
            "FENCE_ALT_MIN",
            "FENCE_RADIUS",
            "FENCE_MARGIN",
            "FLTMODE_CH",
            "FLTMODE1",
            "FLTMODE2",
            "FLTMODE3",
            "FLTMODE4",
            "FLTMODE5",
            "FLTMODE6",
        ],
    ),
    (
        Purpose::Limit,
        &[
            "WPNAV_SPEED",
            "WPNAV_SPEED_UP",
            "WPNAV_SPEED_DN",
            "WPNAV_ACCEL",
            "WPNAV_ACCEL_Z",
            "WPNAV_JERK",
            "PSC_JERK_XY",
            "PSC_JERK_Z",
            "ANGLE_MAX",
            "ATC_ACCEL_R_MAX",
            "ATC_ACCEL_P_MAX",
            "ATC_ACCEL_Y_MAX",
        ],
    ),
];

/// Outputs of which the function is asked.
const OUTPUTS: usize = 16;
/// Channels of ArduPilot that may have a switch.
const SWITCHES: std::ops::Range<u8> = 5..17;
/// Outputs of a PX4 bank.
const BANK: usize = 8;

/// What to ask a vehicle with this many rotors, most needed first; nothing for other autopilots.
#[must_use]
pub fn wanted(autopilot: Autopilot, rotors: usize) -> Vec<RequestedEffects> {
    let (table, numbered) = match autopilot {
        Autopilot::Px4 => (PX4, px4_outputs(rotors)),
        Autopilot::ArduPilot => (ARDUPILOT, ardupilot_outputs(rotors)),
        Autopilot::Other | Autopilot::Unknown => return Vec::new(),
    };
    let named = table.iter().flat_map(|(purpose, names)| {
        names.iter().map(|name| RequestedEffects { names: all_names(name), purpose: *purpose })
    });
    let numbered =
        numbered.into_iter().map(|name| RequestedEffects { names: vec![name], purpose: Purpose::Thrust });
    let switches = if autopilot == Autopilot::ArduPilot { SWITCHES } else { 0..0 };
    let switches = switches.map(|channel| RequestedEffects {
        names: vec![format!("RC{channel}_OPTION")],
        purpose: Purpose::Failsafe,
    });
    named.chain(numbered).chain(switches).collect()
}

fn all_names(name: &str) -> Vec<String> {
    let new = RENAMED.iter().filter(|renamed| renamed.old == name).map(|renamed| renamed.new.to_owned());
    std::iter::once(name.to_owned()).chain(new).collect()
}

fn px4_outputs(rotors: usize) -> Vec<String> {
    let geometry = (0..rotors)
        .flat_map(|rotor| ["PX", "PY", "KM", "CT"].map(|entry| format!("CA_ROTOR{rotor}_{entry}")));
    let banks = ["MAIN", "AUX"].into_iter().flat_map(|bank| {
        (1..=BANK).flat_map(move |output| {
            ["FUNC", "MIN", "MAX", "DIS"].map(|entry| format!("PWM_{bank}_{entry}{output}"))
        })
    });
    geometry.chain(banks).collect()
}

fn ardupilot_outputs(rotors: usize) -> Vec<String> {
    let functions = (1..=OUTPUTS).map(|output| format!("SERVO{output}_FUNCTION"));
    // pulse ranges of the motors come from MOT_PWM_*; a reversed output would still turn them round
    functions.chain((1..=rotors).map(|output| format!("SERVO{output}_REVERSED"))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_fit_a_parameter_and_come_once() {
        for autopilot in [Autopilot::Px4, Autopilot::ArduPilot] {
            let mut names: Vec<String> =
                wanted(autopilot, 8).into_iter().flat_map(|wanted| wanted.names).collect();
            assert!(names.iter().all(|name| name.len() <= 16), "{names:?}");
            let count = names.len();
            names.sort();
            names.dedup();
            assert_eq!(names.len(), count);
        }
        assert!(wanted(Autopilot::Other, 4).is_empty());
    }
}
