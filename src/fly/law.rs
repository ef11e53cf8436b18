//! Response of an autopilot to setpoints, and to the last one after they end.

use nalgebra::Vector3;

use super::parameters::Parameters;
use crate::autopilot::{ARDUPILOT, Autopilot, PX4, SetpointRules, Stack};
use crate::simulate::{GuidedTarget, Shaper, ShaperLaw, ShaperLimits, Wish, jerk_within};
use crate::units::rad_from_deg;

/// A motion: position, velocity, acceleration; world, SI.
pub type Motion = Shaper;

/// Time in which PX4 notices the loss, s: it checks ten times a second, and changes the mode in its next control
/// period.
const NOTICES_S: f64 = 0.15;
/// PX4's own allowance for its delay and jerk in the distance to a stop, s.
const STOPS_S: f64 = 0.6;
/// Time constant with which a vehicle tilts for an acceleration, s: that of its attitude loop. Larger says that a
/// vehicle stops later, which refuses more.
const LEANS_S: f64 = 0.12;
/// ArduPilot's least acceleration and jerk, so that a value of zero does not stop the model for ever.
const LEAST: f64 = 0.1;

/// The control law of an autopilot for setpoints.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FollowLaw {
    /// ArduCopter in GUIDED: an internal reference, shaped within its limits, follows the setpoint. The setpoint is
    /// extrapolated by its velocity and acceleration for the time-out, then both are zero
    ArduPilot {
        /// of the reference
        limits: ShaperLimits,
        /// GUID_TIMEOUT, s
        timeout_s: f64,
    },
    /// PX4 in OFFBOARD: the vehicle itself follows, `v = v_ff + P (p - p_now)` within its limits and
    /// `(1 + D) a = a_ff + K (v - v_now)`, without the integrator of the velocity, which learns drag. The last
    /// setpoint stays for the time-out, then another mode of PX4 brakes
    Px4 {
        /// MPC_XY_P, MPC_Z_P, 1/s
        position_1_s: Vector3<f64>,
        /// MPC_XY_VEL_P_ACC, MPC_Z_VEL_P_ACC, 1/s
        velocity_1_s: Vector3<f64>,
        /// D: MPC_XY_VEL_D_ACC, MPC_Z_VEL_D_ACC
        damping: Vector3<f64>,
        /// m/s: MPC_XY_VEL_MAX, MPC_Z_VEL_MAX_UP, MPC_Z_VEL_MAX_DN
        speeds_m_s: [f64; 3],
        /// COM_OF_LOSS_T, s
        timeout_s: f64,
        /// m/s^2 and m/s^3 of the mode that follows
        braking: (f64, f64),
    },
}

impl FollowLaw {
    /// From the vehicle's parameters, by the autopilot's defaults where one did not answer, and its release (major and minor
    /// number): all that it may follow, the most likely first; none for an autopilot that is not known. ArduPilot changed its law
    /// and its parameters' names on the way to 4.7, the law first: where it has the old names and does not say that it is
    /// older, both laws are possible.
    #[must_use]
    pub fn of(parameters: &Parameters, release: Option<(u8, u8)>) -> Vec<Self> {
        match parameters.autopilot {
            Autopilot::ArduPilot => {
                let renamed = parameters.name_of("WPNAV_ACCEL") != "WPNAV_ACCEL";
                let laws: &[ShaperLaw] = match release {
                    _ if renamed => &[ShaperLaw::From4_7],
                    Some(release) if release < (4, 7) => &[ShaperLaw::UpTo4_6],
                    Some(_) => &[ShaperLaw::From4_7, ShaperLaw::UpTo4_6],
                    None => &[ShaperLaw::UpTo4_6, ShaperLaw::From4_7],
                };
                laws.iter().map(|law| ardupilot(parameters, *law)).collect()
            }
            Autopilot::Px4 => vec![px4(parameters)],
            Autopilot::Other | Autopilot::Unknown => Vec::new(),
        }
    }

    /// Time for which the last setpoint is followed, s.
    #[must_use]
    pub fn timeout_s(&self) -> f64 {
        match self {
            Self::ArduPilot { timeout_s, .. } | Self::Px4 { timeout_s, .. } => *timeout_s,
        }
    }

    /// The same autopilot with another time-out.
    #[must_use]
    pub fn with_timeout_s(self, seconds: f64) -> Self {
        match self {
            Self::ArduPilot { limits, .. } => Self::ArduPilot { limits, timeout_s: seconds },
            Self::Px4 { position_1_s, velocity_1_s, damping, speeds_m_s, braking, .. } => {
                Self::Px4 { position_1_s, velocity_1_s, damping, speeds_m_s, braking, timeout_s: seconds }
            }
        }
    }

    /// The position at rest (m) whose setpoint gives a vehicle in this motion exactly its acceleration.
    #[must_use]
    pub fn place_ahead(&self, motion: &Motion) -> Vector3<f64> {
        match self {
            Self::ArduPilot { limits, .. } => motion.place_ahead(limits),
            Self::Px4 { position_1_s, velocity_1_s, damping, .. } => {
                let asked_m_s2 = motion.acceleration_m_s2.component_mul(&damping.add_scalar(1.0));
                let wanted = motion.velocity_m_s + asked_m_s2.component_div(velocity_1_s);
                motion.position_m + wanted.component_div(position_1_s)
            }
        }
    }

    /// One period of flight after a setpoint.
    pub fn step(&self, motion: &mut Motion, target: &GuidedTarget, period_s: f64) {
        match self {
            Self::ArduPilot { limits, .. } => {
                let GuidedTarget { position_m, velocity_m_s, acceleration_m_s2 } = *target;
                motion.step(&Wish { position_m, velocity_m_s, acceleration_m_s2 }, limits, period_s);
            }
            Self::Px4 { position_1_s, velocity_1_s, damping, speeds_m_s, .. } => {
                let wanted =
                    target.velocity_m_s + (target.position_m - motion.position_m).component_mul(position_1_s);
                let wanted = within_speeds(wanted, speeds_m_s);
                let asked_m_s2 =
                    target.acceleration_m_s2 + (wanted - motion.velocity_m_s).component_mul(velocity_1_s);
                let acceleration = asked_m_s2.component_div(&damping.add_scalar(1.0));
                let share = 1.0 - (-period_s / LEANS_S).exp();
                motion.acceleration_m_s2 += (acceleration - motion.acceleration_m_s2) * share;
                motion.position_m +=
                    motion.velocity_m_s * period_s + motion.acceleration_m_s2 * (0.5 * period_s * period_s);
                motion.velocity_m_s += motion.acceleration_m_s2 * period_s;
            }
        }
    }

    /// Calls `at` with every position (m) of a vehicle that receives no setpoint after this one, until it rests.
    pub fn abandoned(&self, motion: &Motion, target: &GuidedTarget, mut at: impl FnMut(&Vector3<f64>)) {
        let (mut motion, mut target) = (*motion, *target);
        let mut passed_s = 0.0;
        match self {
            Self::ArduPilot { timeout_s, .. } => {
                while passed_s < timeout_s + SETTLES_S {
                    if passed_s >= *timeout_s {
                        target.time_out();
                        if motion.velocity_m_s.norm() < RESTS_M_S
                            && motion.acceleration_m_s2.norm() < RESTS_M_S
                        {
                            break;
                        }
                    }
                    self.step(&mut motion, &target, STEP_S);
                    target.step(STEP_S);
                    at(&motion.position_m);
                    passed_s += STEP_S;
                }
            }
            Self::Px4 { timeout_s, braking: (acceleration, jerk), .. } => {
                while passed_s < timeout_s + NOTICES_S {
                    self.step(&mut motion, &target, STEP_S);
                    at(&motion.position_m);
                    passed_s += STEP_S;
                }
                let speed = motion.velocity_m_s.norm();
                // with the greatest deceleration, or by a law that is linear in the speed where that takes longer
                let brakes_s =
                    (0.5 * speed / acceleration + 0.5 * acceleration / jerk).max(acceleration / jerk);
                // where its mode puts the place to stop at (`Navigator::preproject_stop_point`), or later
                let level_s = brakes_s.max(0.5 * speed / acceleration + STOPS_S);
                let times_s = Vector3::new(level_s, level_s, brakes_s);
                at(&(motion.position_m + motion.velocity_m_s.component_mul(&times_s)));
            }
        }
    }
}

/// Step of the model, s. A tenth of the fastest time constant of the model.
pub const STEP_S: f64 = 0.02;
/// Longest time to rest after a time-out, s. A vehicle that takes longer is refused.
const SETTLES_S: f64 = 8.0;
/// Speed, m/s, and acceleration, m/s^2, that count as rest. Smaller than what an estimator resolves.
const RESTS_M_S: f64 = 0.02;

/// A velocity (m/s) along and across the vertical within its limits.
fn within_speeds(wanted_m_s: Vector3<f64>, [level, up, down]: &[f64; 3]) -> Vector3<f64> {
    let share = (level / wanted_m_s.xy().norm().max(f64::MIN_POSITIVE)).min(1.0);
    Vector3::new(wanted_m_s.x * share, wanted_m_s.y * share, wanted_m_s.z.min(*up).max(-down))
}

/// The autopilot's default in its base unit.
fn default(stack: &Stack, name: &str) -> f64 {
    let entry = stack.parameters.find(name);
    entry.and_then(|entry| Some(1.0 / entry.unit.per_base * entry.default?)).unwrap_or(0.0)
}

/// The value in its base unit; the default if the parameter did not answer.
pub(super) fn stated(parameters: &Parameters, stack: &Stack, name: &str) -> f64 {
    parameters.in_base_unit(name).unwrap_or_else(|| default(stack, name))
}

/// The same if the value is positive, otherwise the default: zero means no limit.
fn positive(parameters: &Parameters, stack: &Stack, name: &str) -> f64 {
    let answered = parameters.in_base_unit(name).filter(|value| *value > 0.0);
    answered.unwrap_or_else(|| default(stack, name))
}

/// Time for which the last setpoint is followed, s.
fn timeout_s(parameters: &Parameters, rules: &SetpointRules) -> f64 {
    parameters.get(rules.timeout).unwrap_or(rules.timeout_default.as_secs_f64())
}

fn ardupilot(parameters: &Parameters, law: ShaperLaw) -> FollowLaw {
    let positive = |name: &str| positive(parameters, &ARDUPILOT, name).max(LEAST);
    let turning = |name: &str| rad_from_deg(stated(parameters, &ARDUPILOT, name));
    let acceleration_m_s2 = positive("WPNAV_ACCEL");
    let limits = ShaperLimits {
        speed_m_s: positive("WPNAV_SPEED"),
        climb_m_s: positive("WPNAV_SPEED_UP"),
        descent_m_s: positive("WPNAV_SPEED_DN"),
        acceleration_m_s2,
        vertical_acceleration_m_s2: positive("WPNAV_ACCEL_Z"),
        jerk_m_s3: jerk_within(
            positive("PSC_JERK_XY"),
            acceleration_m_s2,
            turning("ATC_ACCEL_R_MAX").min(turning("ATC_ACCEL_P_MAX")),
        ),
        vertical_jerk_m_s3: positive("PSC_JERK_Z"),
        law,
    };
    FollowLaw::ArduPilot { limits, timeout_s: timeout_s(parameters, &ARDUPILOT.setpoints).max(0.1) }
}

fn px4(parameters: &Parameters) -> FollowLaw {
    let positive = |name: &str| positive(parameters, &PX4, name);
    let stated = |name: &str| stated(parameters, &PX4, name).max(0.0);
    let axes = |level: f64, upright: f64| Vector3::new(level, level, upright);
    FollowLaw::Px4 {
        position_1_s: axes(positive("MPC_XY_P"), positive("MPC_Z_P")),
        velocity_1_s: axes(positive("MPC_XY_VEL_P_ACC"), positive("MPC_Z_VEL_P_ACC")),
        damping: axes(stated("MPC_XY_VEL_D_ACC"), stated("MPC_Z_VEL_D_ACC")),
        speeds_m_s: [positive("MPC_XY_VEL_MAX"), positive("MPC_Z_VEL_MAX_UP"), positive("MPC_Z_VEL_MAX_DN")],
        timeout_s: timeout_s(parameters, &PX4.setpoints).max(0.0),
        braking: (positive("MPC_ACC_HOR").min(positive("MPC_ACC_DOWN_MAX")), positive("MPC_JERK_AUTO")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn law(autopilot: Autopilot, values: &[(&str, f64)]) -> FollowLaw {
        let values = values.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect();
        FollowLaw::of(&Parameters { autopilot, values, ..Parameters::default() }, None).remove(0)
    }

    #[test]
    fn old_names_of_a_release_that_is_not_known_to_be_older_leave_both_laws() {
        let of = |name: &str, release| {
            let values = [(name.to_owned(), 2.5)].into();
            let autopilot = Autopilot::ArduPilot;
            FollowLaw::of(&Parameters { autopilot, values, ..Parameters::default() }, release)
        };
        let number = |name, release| of(name, release).len();
        assert_eq!((number("WPNAV_ACCEL", Some((4, 6))), number("WP_ACC", Some((4, 7)))), (1, 1));
        assert_eq!((number("WPNAV_ACCEL", Some((4, 7))), number("WPNAV_ACCEL", None)), (2, 2));
        assert_ne!(of("WPNAV_ACCEL", Some((4, 6)))[0], of("WPNAV_ACCEL", Some((4, 7)))[0]);
    }

    fn farthest_x_m(law: &FollowLaw, target: &GuidedTarget) -> f64 {
        let motion = Motion {
            acceleration_m_s2: target.acceleration_m_s2,
            ..Motion::at(target.position_m, target.velocity_m_s)
        };
        let mut farthest_m = f64::NEG_INFINITY;
        law.abandoned(&motion, target, |place| farthest_m = farthest_m.max(place.x));
        farthest_m
    }

    #[test]
    fn ardupilot_flies_on_for_its_time_out_and_px4_leans_on_its_last_place() {
        let one = GuidedTarget {
            position_m: Vector3::zeros(),
            velocity_m_s: Vector3::x(),
            acceleration_m_s2: Vector3::zeros(),
        };
        let copter = farthest_x_m(&law(Autopilot::ArduPilot, &[("WP_ACC", 2.5)]), &one);
        assert!((2.9..3.6).contains(&copter), "three seconds at 1 m/s: {copter}");
        let short = farthest_x_m(&law(Autopilot::ArduPilot, &[("WP_ACC", 2.5), ("GUID_TIMEOUT", 0.5)]), &one);
        assert!((0.4..1.1).contains(&short), "{short}");
        let px4 = farthest_x_m(&law(Autopilot::Px4, &[]), &one);
        // 1.15 s of slowing down, and the stop where the navigator puts it: v (v / 2 a + 0.6 s)
        assert!((0.9..1.5).contains(&px4), "{px4}");
        let still = GuidedTarget { velocity_m_s: Vector3::zeros(), ..one };
        for autopilot in [Autopilot::ArduPilot, Autopilot::Px4] {
            assert!(farthest_x_m(&law(autopilot, &[]), &still).abs() < 1e-6);
        }
    }

    #[test]
    fn a_place_ahead_keeps_the_motion_that_it_was_made_for() {
        for autopilot in [Autopilot::ArduPilot, Autopilot::Px4] {
            let law = law(autopilot, &[("WP_ACC", 10.0), ("PSC_NE_JERK", 40.0), ("WP_ACC_Z", 6.0)]);
            let motion = Motion {
                acceleration_m_s2: Vector3::new(-0.5, 0.3, 0.1),
                ..Motion::at(Vector3::new(0.2, -1.0, 2.0), Vector3::new(0.4, 0.1, -0.2))
            };
            let target = GuidedTarget {
                position_m: law.place_ahead(&motion),
                velocity_m_s: Vector3::zeros(),
                acceleration_m_s2: Vector3::zeros(),
            };
            let mut stepped = motion;
            law.step(&mut stepped, &target, 1e-3);
            assert!((stepped.acceleration_m_s2 - motion.acceleration_m_s2).norm() < 1e-6, "{stepped:?}");
        }
    }
}
