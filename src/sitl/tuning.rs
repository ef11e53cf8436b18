//! What the parameters mean for the flight, in SI; read anew when one of them changes.

use std::time::Duration;

use super::action::Action;
use super::battery::Thresholds;
use super::demand::ThrustField;
use super::fence::FenceRules;
use super::parameters::Parameters;
use super::{Firmware, Mode};
use crate::autopilot::Release;
use crate::simulate::{ShaperLaw, ShaperLimits, jerk_within};
use crate::units::rad_from_deg;

/// The flight's settings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Tuning {
    pub(super) limits: ShaperLimits,
    pub(super) takeoff_speed_m_s: f64,
    pub(super) land_speed_m_s: f64,
    pub(super) takeoff_height_m: f64,
    /// above home
    pub(super) return_height_m: f64,
    /// rise of the cone around home within which the return climbs less (-)
    pub(super) return_cone: f64,
    /// of setpoints
    pub(super) setpoint_timeout: Duration,
    /// PX4's when setpoints end
    pub(super) setpoint_loss: Action,
    /// silence of the ground station until its loss is declared
    pub(super) ground_timeout: Duration,
    pub(super) ground_loss: Action,
    /// the system whose heartbeats count, ArduPilot
    pub(super) ground_system: Option<u8>,
    pub(super) low_battery: Action,
    pub(super) critical_battery: Action,
    pub(super) battery_thresholds: Thresholds,
    /// disarms when landed so long
    pub(super) disarm_landed: Option<Duration>,
    /// disarms when armed so long without a takeoff
    pub(super) disarm_idle: Option<Duration>,
    /// turns towards where it flies unless told a yaw
    pub(super) yaw_follows_path: bool,
    pub(super) arming_checks: bool,
    /// how ArduPilot reads SET_ATTITUDE_TARGET
    pub(super) thrust_field: ThrustField,
    /// what the parameters say of it; none where it is off
    pub(super) fence: Option<FenceRules>,
    /// PX4 holds for so long before a failsafe returns or lands
    pub(super) failsafe_delay: Duration,
}

fn seconds(value: f64) -> Duration {
    Duration::try_from_secs_f64(value).unwrap_or(Duration::ZERO)
}

fn positive(value: f64) -> Option<Duration> {
    (value > 0.0).then(|| seconds(value))
}

/// A whole-number parameter.
fn choice(parameters: &Parameters, name: &str) -> i32 {
    crate::units::whole(parameters.value(name))
}

/// Of GUID_OPTIONS.
const THRUST_AS_THRUST: i32 = 1 << 3;
/// Least value of a bound, so that a zero does not stop the reference for ever.
const LEAST: f64 = 0.1;

impl Tuning {
    pub(super) fn of(kind: Firmware, parameters: &Parameters) -> Self {
        if kind.is_px4() { px4(parameters) } else { ardupilot(kind.release(), parameters) }
    }
}

fn px4(p: &Parameters) -> Tuning {
    let at_least = |name: &str| p.value(name).max(LEAST);
    let loss = match choice(p, "COM_OBL_RC_ACT") {
        0 => Action::Descend(Mode::Position),
        1 => Action::Descend(Mode::Altitude),
        2 => Action::Descend(Mode::Stabilize),
        3 => Action::Enter(Mode::Return),
        4 => Action::Enter(Mode::Land),
        5 => Action::Enter(Mode::Hold),
        _ => Action::Terminate,
    };
    let ground_loss = match choice(p, "NAV_DLL_ACT") {
        1 => Action::Enter(Mode::Hold),
        2 => Action::Enter(Mode::Return),
        3 => Action::Enter(Mode::Land),
        5 | 6 => Action::Terminate,
        _ => Action::Warn,
    };
    let critical_battery = match choice(p, "COM_LOW_BAT_ACT") {
        1 | 3 => Action::Enter(Mode::Return),
        2 => Action::Enter(Mode::Land),
        _ => Action::Warn,
    };
    Tuning {
        limits: ShaperLimits {
            speed_m_s: at_least("MPC_XY_CRUISE"),
            climb_m_s: at_least("MPC_Z_V_AUTO_UP"),
            descent_m_s: at_least("MPC_Z_V_AUTO_DN"),
            acceleration_m_s2: at_least("MPC_ACC_HOR"),
            vertical_acceleration_m_s2: at_least("MPC_ACC_DOWN_MAX"),
            jerk_m_s3: at_least("MPC_JERK_AUTO"),
            vertical_jerk_m_s3: at_least("MPC_JERK_AUTO"),
            law: ShaperLaw::default(),
        },
        takeoff_speed_m_s: at_least("MPC_TKO_SPEED"),
        land_speed_m_s: at_least("MPC_LAND_SPEED"),
        takeoff_height_m: p.value("MIS_TAKEOFF_ALT"),
        return_height_m: p.value("RTL_RETURN_ALT"),
        return_cone: p.value("RTL_CONE_ANG").to_radians().tan(),
        setpoint_timeout: seconds(p.value("COM_OF_LOSS_T")),
        setpoint_loss: loss,
        ground_timeout: seconds(p.value("COM_DL_LOSS_T")),
        ground_loss,
        ground_system: None,
        low_battery: Action::Warn,
        critical_battery,
        battery_thresholds: Thresholds::Remaining {
            low: p.value("BAT_LOW_THR"),
            critical: p.value("BAT_CRIT_THR"),
        },
        disarm_landed: positive(p.value("COM_DISARM_LAND")),
        disarm_idle: positive(p.value("COM_DISARM_PRFLT")),
        yaw_follows_path: false,
        arming_checks: true,
        thrust_field: ThrustField::Thrust,
        fence: px4_fence(p),
        failsafe_delay: seconds(p.value("COM_FAIL_ACT_T")),
    }
}

/// GF_*; a distance of zero is none.
fn px4_fence(p: &Parameters) -> Option<FenceRules> {
    let action = match choice(p, "GF_ACTION") {
        0 => return None,
        2 => Action::Enter(Mode::Hold),
        3 => Action::Enter(Mode::Return),
        4 => Action::Terminate,
        5 => Action::Enter(Mode::Land),
        _ => Action::Warn,
    };
    let distance_m = |name| Some(p.value(name)).filter(|distance_m| *distance_m > 0.0);
    let (radius_m, height_max_m) = (distance_m("GF_MAX_HOR_DIST"), distance_m("GF_MAX_VER_DIST"));
    Some(FenceRules { radius_m, height_max_m, areas: true, action })
}

/// FENCE_*: of its kinds the greatest height (bit 0), the circle (1) and the areas (2). There is no smart return
/// here; where there is none on ArduPilot it returns as it can.
fn ardupilot_fence(p: &Parameters) -> Option<FenceRules> {
    let action = match choice(p, "FENCE_ACTION") {
        0 => Action::Warn,
        2 | 5 => Action::Enter(Mode::Land),
        4 => Action::Enter(Mode::Brake),
        _ => Action::Enter(Mode::Return),
    };
    let kinds = choice(p, "FENCE_TYPE");
    let distance_m = |bit: i32, name| (kinds & bit != 0).then(|| p.value(name));
    let (height_max_m, radius_m) = (distance_m(1, "FENCE_ALT_MAX"), distance_m(2, "FENCE_RADIUS"));
    let rules = FenceRules { radius_m, height_max_m, areas: kinds & 4 != 0, action };
    (choice(p, "FENCE_ENABLE") != 0).then_some(rules)
}

/// FS_GCS_ENABLE.
fn ardupilot_ground_loss(choice: i32) -> Action {
    match choice {
        1 | 3 | 4 => Action::Enter(Mode::Return),
        5 => Action::Enter(Mode::Land),
        7 => Action::Enter(Mode::Brake),
        _ => Action::Warn,
    }
}

/// BATT_FS_LOW_ACT, BATT_FS_CRT_ACT.
fn ardupilot_battery(choice: i32) -> Action {
    match choice {
        1 => Action::Enter(Mode::Land),
        2 | 3 | 4 | 6 => Action::Enter(Mode::Return),
        5 => Action::Terminate,
        7 => Action::Enter(Mode::Brake),
        _ => Action::Warn,
    }
}

/// What GUIDED allows its reference.
fn ardupilot_limits(release: Release, p: &Parameters) -> ShaperLimits {
    let limit = |old: &str, new: &str| p.first(&[(new, 1.0), (old, 0.01)]).max(LEAST);
    let jerk = |old: &str, new: &str| p.first(&[(new, 1.0), (old, 1.0)]).max(LEAST);
    let turning = |axis: char| {
        let degrees =
            p.first(&[(&format!("ATC_ACC_{axis}_MAX"), 1.0), (&format!("ATC_ACCEL_{axis}_MAX"), 0.01)]);
        rad_from_deg(degrees)
    };
    let acceleration_m_s2 = limit("WPNAV_ACCEL", "WP_ACC");
    ShaperLimits {
        speed_m_s: limit("WPNAV_SPEED", "WP_SPD"),
        climb_m_s: limit("WPNAV_SPEED_UP", "WP_SPD_UP"),
        descent_m_s: limit("WPNAV_SPEED_DN", "WP_SPD_DN"),
        acceleration_m_s2,
        vertical_acceleration_m_s2: limit("WPNAV_ACCEL_Z", "WP_ACC_Z"),
        jerk_m_s3: jerk_within(
            jerk("PSC_JERK_XY", "PSC_NE_JERK"),
            acceleration_m_s2,
            turning('R').min(turning('P')),
        ),
        vertical_jerk_m_s3: jerk("PSC_JERK_Z", "PSC_D_JERK"),
        law: if release < Release::new(4, 7) { ShaperLaw::UpTo4_6 } else { ShaperLaw::From4_7 },
    }
}

fn ardupilot(release: Release, p: &Parameters) -> Tuning {
    // metres from either release's name and unit
    let metres = |old: &str, new: &str| p.first(&[(new, 1.0), (old, 0.01)]);
    let limit = |old: &str, new: &str| metres(old, new).max(LEAST);
    let skipped = p.find("ARMING_SKIPCHK").is_some() && p.value("ARMING_SKIPCHK") < 0.0;
    let unchecked = p.find("ARMING_CHECK").is_some() && p.value("ARMING_CHECK") == 0.0;
    Tuning {
        limits: ardupilot_limits(release, p),
        takeoff_speed_m_s: limit("WPNAV_SPEED_UP", "WP_SPD_UP"),
        land_speed_m_s: limit("LAND_SPEED", "LAND_SPD_MS"),
        takeoff_height_m: 0.0,
        return_height_m: metres("RTL_ALT", "RTL_ALT_M"),
        return_cone: p.value("RTL_CONE_SLOPE"),
        setpoint_timeout: seconds(p.value("GUID_TIMEOUT").max(0.1)),
        setpoint_loss: Action::Warn,
        ground_timeout: seconds(p.value("FS_GCS_TIMEOUT")),
        ground_loss: ardupilot_ground_loss(choice(p, "FS_GCS_ENABLE")),
        ground_system: u8::try_from(crate::units::whole(
            p.first(&[("MAV_GCS_SYSID", 1.0), ("SYSID_MYGCS", 1.0)]),
        ))
        .ok(),
        low_battery: ardupilot_battery(choice(p, "BATT_FS_LOW_ACT")),
        critical_battery: ardupilot_battery(choice(p, "BATT_FS_CRT_ACT")),
        battery_thresholds: Thresholds::Volts {
            low: p.value("BATT_LOW_VOLT"),
            critical: p.value("BATT_CRT_VOLT"),
        },
        disarm_landed: Some(Duration::ZERO),
        disarm_idle: positive(p.value("DISARM_DELAY")),
        yaw_follows_path: choice(p, "WP_YAW_BEHAVIOR") != 0,
        arming_checks: !(skipped || unchecked),
        thrust_field: if choice(p, "GUID_OPTIONS") & THRUST_AS_THRUST != 0 {
            ThrustField::Thrust
        } else {
            ThrustField::Climb {
                climb_m_s: limit("WPNAV_SPEED_UP", "WP_SPD_UP"),
                descent_m_s: limit("WPNAV_SPEED_DN", "WP_SPD_DN"),
            }
        },
        fence: ardupilot_fence(p),
        failsafe_delay: Duration::ZERO,
    }
}
