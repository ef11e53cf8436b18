//! What the parameters mean for the flight, in SI; read again when one of them changes.

use std::time::Duration;

use super::Firmware;
use super::action::Action;
use super::battery::Thresholds;
use super::demand::ThrustField;
use super::fence::FenceRules;
use super::parameters::Parameters;
use crate::autopilot::Release;
use crate::simulate::{ShaperLaw, ShaperLimits, jerk_within};
use crate::units::rad_from_deg;

/// The flight's settings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Tuning {
    pub(super) limits: ShaperLimits,
    /// thrust of a hover over full thrust, as the parameters say it; none where they do not
    pub(super) hover_share: Option<f64>,
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
    let action = |name: &str| Action::of_px4(p.reaction(name));
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
        hover_share: Some(p.value("MPC_THR_HOVER")).filter(|share| *share > 0.0),
        takeoff_speed_m_s: at_least("MPC_TKO_SPEED"),
        land_speed_m_s: at_least("MPC_LAND_SPEED"),
        takeoff_height_m: p.value("MIS_TAKEOFF_ALT"),
        return_height_m: p.value("RTL_RETURN_ALT"),
        return_cone: p.value("RTL_CONE_ANG").to_radians().tan(),
        setpoint_timeout: seconds(p.value("COM_OF_LOSS_T")),
        setpoint_loss: action("COM_OBL_RC_ACT"),
        ground_timeout: seconds(p.value("COM_DL_LOSS_T")),
        ground_loss: action("NAV_DLL_ACT"),
        ground_system: None,
        low_battery: Action::Warn,
        critical_battery: action("COM_LOW_BAT_ACT"),
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
    if choice(p, "GF_ACTION") == 0 {
        return None;
    }
    let action = Action::of_px4(p.reaction("GF_ACTION"));
    let distance_m = |name| Some(p.value(name)).filter(|distance_m| *distance_m > 0.0);
    let (radius_m, height_max_m) = (distance_m("GF_MAX_HOR_DIST"), distance_m("GF_MAX_VER_DIST"));
    Some(FenceRules { radius_m, height_max_m, areas: true, action })
}

/// FENCE_*: of its kinds the greatest height (bit 0), the circle (1) and the areas (2).
fn ardupilot_fence(p: &Parameters) -> Option<FenceRules> {
    let action = Action::of_ardupilot(p.reaction("FENCE_ACTION"));
    let kinds = choice(p, "FENCE_TYPE");
    let distance_m = |bit: i32, name| (kinds & bit != 0).then(|| p.value(name));
    let (height_max_m, radius_m) = (distance_m(1, "FENCE_ALT_MAX"), distance_m(2, "FENCE_RADIUS"));
    let rules = FenceRules { radius_m, height_max_m, areas: kinds & 4 != 0, action };
    // one that is enabled at arming or takeoff only is in force here all the time: on the ground it stops nothing
    ["FENCE_ENABLE", "FENCE_AUTOENABLE"].into_iter().any(|name| choice(p, name) != 0).then_some(rules)
}

/// What GUIDED allows its reference.
fn ardupilot_limits(release: Release, p: &Parameters) -> ShaperLimits {
    let limit = |name: &str| p.in_base_unit(name).max(LEAST);
    let turning = |name: &str| rad_from_deg(p.in_base_unit(name));
    let acceleration_m_s2 = limit("WPNAV_ACCEL");
    ShaperLimits {
        speed_m_s: limit("WPNAV_SPEED"),
        climb_m_s: limit("WPNAV_SPEED_UP"),
        descent_m_s: limit("WPNAV_SPEED_DN"),
        acceleration_m_s2,
        vertical_acceleration_m_s2: limit("WPNAV_ACCEL_Z"),
        jerk_m_s3: jerk_within(
            limit("PSC_JERK_XY"),
            acceleration_m_s2,
            turning("ATC_ACCEL_R_MAX").min(turning("ATC_ACCEL_P_MAX")),
        ),
        vertical_jerk_m_s3: limit("PSC_JERK_Z"),
        law: if release < Release::new(4, 7) { ShaperLaw::UpTo4_6 } else { ShaperLaw::From4_7 },
    }
}

fn ardupilot(release: Release, p: &Parameters) -> Tuning {
    let limit = |name: &str| p.in_base_unit(name).max(LEAST);
    let action = |name: &str| Action::of_ardupilot(p.reaction(name));
    let skipped = p.find("ARMING_SKIPCHK").is_some() && p.value("ARMING_SKIPCHK") < 0.0;
    let unchecked = p.find("ARMING_CHECK").is_some() && p.value("ARMING_CHECK") == 0.0;
    Tuning {
        limits: ardupilot_limits(release, p),
        hover_share: Some(p.value("MOT_THST_HOVER")).filter(|share| *share > 0.0),
        takeoff_speed_m_s: limit("WPNAV_SPEED_UP"),
        land_speed_m_s: limit("LAND_SPEED"),
        takeoff_height_m: 0.0,
        return_height_m: p.in_base_unit("RTL_ALT"),
        return_cone: p.value("RTL_CONE_SLOPE"),
        setpoint_timeout: seconds(p.value("GUID_TIMEOUT").max(0.1)),
        setpoint_loss: Action::Warn,
        ground_timeout: seconds(p.value("FS_GCS_TIMEOUT")),
        ground_loss: action("FS_GCS_ENABLE"),
        ground_system: u8::try_from(crate::units::whole(p.in_base_unit("SYSID_MYGCS"))).ok(),
        low_battery: action("BATT_FS_LOW_ACT"),
        critical_battery: action("BATT_FS_CRT_ACT"),
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
            ThrustField::Climb { climb_m_s: limit("WPNAV_SPEED_UP"), descent_m_s: limit("WPNAV_SPEED_DN") }
        },
        fence: ardupilot_fence(p),
        failsafe_delay: Duration::ZERO,
    }
}
