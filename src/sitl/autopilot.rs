//! Modes, arming, takeoff and landing: the autopilot between what it is told and what it puts out.

use std::collections::VecDeque;
use std::time::Duration;

use mavlink::dialects::ardupilotmega::{MavResult, MavSeverity};
use nalgebra::Vector3;

use super::battery::Battery;
use super::demand::{AttitudeDemand, Lift};
use super::estimator::Estimator;
use super::fence::Fence;
use super::guidance::{Guidance, Leg, Task};
use super::parameters::hover_share;
use super::safety::Safety;
use super::tuning::Tuning;
use super::{Firmware, Mode, Settings, SitlError};
use crate::physics::{MAX_ROTORS, State};
use crate::simulate::{AutopilotCascade, AutopilotGains, Setpoint};

/// What the vehicle says in words.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Text {
    pub(super) severity: MavSeverity,
    pub(super) text: String,
}

/// Output of rotors that idle on the ground (-).
const IDLE: f64 = 0.05;
/// Least output in flight (-).
const COMMAND_MIN: f64 = 0.02;
/// Thrust over weight below which a vehicle that should descend stands on the ground (-).
const STANDING_THRUST: f64 = 0.6;
/// Vertical speed of a vehicle that stands, m/s.
const STANDING_M_S: f64 = 0.2;

/// The autopilot.
#[derive(Debug)]
pub(super) struct Autopilot {
    pub(super) kind: Firmware,
    pub(super) tuning: Tuning,
    pub(super) estimator: Estimator,
    pub(super) battery: Battery,
    pub(super) safety: Safety,
    pub(super) fence: Fence,
    pub(super) guidance: Guidance,
    pub(super) cascade: AutopilotCascade,
    pub(super) weight_n: f64,
    /// full thrust, N
    pub(super) thrust_max_n: f64,
    /// thrust of a hover over full thrust, of the vehicle that it believes
    hover_share: f64,
    origin_altitude_m: f64,
    pub(super) armed_since: Option<Duration>,
    /// left the ground since it was armed
    pub(super) has_flown: bool,
    /// stands on the ground, since when
    pub(super) landed_since: Option<Duration>,
    standing_since: Option<Duration>,
    /// what is flown
    pub(super) mode: Mode,
    /// what was asked for
    pub(super) intended: Mode,
    /// PX4's after disarming: the last one asked for in which it arms
    pub(super) resting: Mode,
    pub(super) home_m: Option<Vector3<f64>>,
    /// what the cascade was last asked for
    pub(super) setpoint: Setpoint,
    pub(super) texts: VecDeque<Text>,
}

impl Autopilot {
    pub(super) fn new(settings: &Settings, tuning: Tuning) -> Result<Self, SitlError> {
        let vehicle = settings.believed();
        let gains = AutopilotGains::default();
        let estimator = Estimator::new(settings);
        let state = estimator.state;
        let kind = settings.autopilot;
        let mode = if kind.is_px4() { Mode::Hold } else { Mode::Stabilize };
        Ok(Self {
            kind,
            tuning,
            estimator,
            battery: Battery::new(settings),
            safety: Safety::new(settings.transmitter),
            fence: Fence::of(settings),
            guidance: Guidance::new(&state, gains),
            cascade: AutopilotCascade::new(vehicle, gains, COMMAND_MIN)?,
            weight_n: vehicle.body.mass_kg * vehicle.gravity_m_s2,
            thrust_max_n: vehicle.propulsion.thrust_from_command_n(1.0) * vehicle.rotors.len() as f64,
            hover_share: hover_share(vehicle),
            origin_altitude_m: settings.origin.altitude_m,
            armed_since: None,
            has_flown: false,
            landed_since: Some(Duration::ZERO),
            standing_since: None,
            mode,
            intended: mode,
            resting: mode,
            home_m: None,
            setpoint: Setpoint {
                position_m: state.position_m,
                velocity_m_s: Vector3::zeros(),
                acceleration_m_s2: Vector3::zeros(),
                yaw_rad: state.attitude.euler_angles().2,
                yaw_rate_rad_s: 0.0,
            },
            texts: VecDeque::new(),
        })
    }

    pub(super) fn is_armed(&self) -> bool {
        self.armed_since.is_some()
    }

    pub(super) fn is_landed(&self) -> bool {
        self.landed_since.is_some()
    }

    pub(super) fn say(&mut self, severity: MavSeverity, text: impl Into<String>) {
        self.texts.push_back(Text { severity, text: text.into() });
    }

    /// One control period; the outputs u for it.
    pub(super) fn tick(&mut self, shown: &State, now: Duration, period_s: f64) -> [f64; MAX_ROTORS] {
        self.estimator.update(shown);
        if self.home_m.is_none() && self.estimator.is_good(now) {
            self.home_m = Some(self.estimator.state.position_m);
            if !self.kind.is_px4() {
                self.say(MavSeverity::MAV_SEVERITY_INFO, "EKF3 IMU0 origin set");
                self.say(MavSeverity::MAV_SEVERITY_INFO, "EKF3 IMU0 is using GPS");
            }
        }
        if self.is_armed() {
            self.battery.drain(period_s);
        }
        self.check_safety(now);
        self.disarm_by_itself(now);
        if !self.is_armed() {
            return [0.0; MAX_ROTORS];
        }
        self.fly(now, period_s)
    }

    fn fly(&mut self, now: Duration, period_s: f64) -> [f64; MAX_ROTORS] {
        let state = self.estimator.state;
        if self.is_landed() {
            self.cascade.reset();
            if !self.guidance.wants_up(&state, self.weight_n / self.thrust_max_n) {
                return [IDLE; MAX_ROTORS];
            }
            (self.landed_since, self.standing_since, self.has_flown) = (None, None, true);
            self.guidance.restart(&state);
            self.say(MavSeverity::MAV_SEVERITY_INFO, "Takeoff detected");
        }
        let home_m = self.home_m.unwrap_or_else(Vector3::zeros);
        if self.kind.is_px4() {
            self.estimator.align_at(state.position_m.z - home_m.z);
        }
        self.setpoint = self.guidance.setpoint(&state, &home_m, (&self.tuning, now), period_s);
        // an acceleration becomes a thrust by the thrust of a hover that the parameters say
        self.cascade.set_hover_scale(self.tuning.hover_share.map_or(1.0, |share| share / self.hover_share));
        let outputs = match self.guidance.turn_wanted(&self.tuning, now) {
            Some(AttitudeDemand { attitude, rates_rad_s, lift: Lift::Thrust(thrust) }) => {
                let thrust_n = thrust * self.thrust_max_n;
                self.cascade.turn(attitude, &rates_rad_s, thrust_n, (&state, period_s))
            }
            Some(AttitudeDemand { attitude, rates_rad_s, lift: Lift::Climb(_) }) => {
                self.cascade.turn_at_height(attitude, &rates_rad_s, &self.setpoint, (&state, period_s))
            }
            None => self.cascade.commands(&self.setpoint, &state, period_s),
        };
        self.watch_ground(now);
        if self.guidance.has_taken_off(&state) {
            self.guidance.begin(Task::Hold, &state);
            if self.mode == Mode::Takeoff {
                (self.mode, self.intended, self.resting) = (Mode::Hold, Mode::Hold, Mode::Hold);
            }
        }
        outputs
    }

    /// Little thrust and no motion although it should descend: it stands.
    fn watch_ground(&mut self, now: Duration) {
        let state = &self.estimator.state;
        let stands = self.guidance.wants_down(&self.setpoint, state)
            && state.velocity_m_s.z.abs() < STANDING_M_S
            && self.cascade.inner_loop_setpoint().thrust_n < STANDING_THRUST * self.weight_n;
        if !stands {
            self.standing_since = None;
            return;
        }
        let since = *self.standing_since.get_or_insert(now);
        let needed = Duration::from_millis(if self.kind.is_px4() { 500 } else { 1000 });
        if now.saturating_sub(since) >= needed {
            self.landed_since = Some(now);
            self.estimator.stand();
            if self.kind.is_px4() {
                self.say(MavSeverity::MAV_SEVERITY_INFO, "Landing detected");
            }
        }
    }

    fn disarm_by_itself(&mut self, now: Duration) {
        let (Some(armed), Some(landed)) = (self.armed_since, self.landed_since) else { return };
        let landing = matches!(self.mode, Mode::Land | Mode::Return);
        let (since, delay) = match (self.has_flown, self.kind.is_px4() || landing) {
            (true, true) => (landed, self.tuning.disarm_landed),
            (true, false) => (landed, self.tuning.disarm_idle),
            (false, _) => (armed, self.tuning.disarm_idle),
        };
        if delay.is_some_and(|delay| now.saturating_sub(since) >= delay) {
            self.switch_off(if self.has_flown {
                "Disarmed by landing"
            } else {
                "Disarmed by auto preflight disarming"
            });
        }
    }

    /// Rotors off, whatever the vehicle does.
    pub(super) fn switch_off(&mut self, why: &str) {
        self.armed_since = None;
        self.landed_since.get_or_insert(Duration::ZERO);
        let text = if self.kind.is_px4() { why } else { "Disarming motors" };
        self.say(MavSeverity::MAV_SEVERITY_INFO, text);
        if self.kind.is_px4() {
            (self.mode, self.intended) = (self.resting, self.resting);
        }
        self.safety.disarmed();
    }

    /// MAV_CMD_COMPONENT_ARM_DISARM.
    pub(super) fn arm(&mut self, forced: bool, now: Duration) -> MavResult {
        if self.is_armed() {
            return MavResult::MAV_RESULT_ACCEPTED;
        }
        let reasons =
            if forced || !self.tuning.arming_checks { Vec::new() } else { self.arming_refusals(now) };
        if !reasons.is_empty() {
            for reason in reasons {
                self.say(MavSeverity::MAV_SEVERITY_CRITICAL, reason);
            }
            return if self.kind.is_px4() {
                MavResult::MAV_RESULT_TEMPORARILY_REJECTED
            } else {
                MavResult::MAV_RESULT_FAILED
            };
        }
        self.armed_since = Some(now);
        self.has_flown = false;
        self.landed_since = Some(now);
        self.cascade.reset();
        let state = self.estimator.state;
        self.guidance.restart(&state);
        if self.estimator.is_good(now) {
            self.home_m = Some(state.position_m);
        }
        self.say(
            MavSeverity::MAV_SEVERITY_INFO,
            if self.kind.is_px4() { "Armed by external command" } else { "Arming motors" },
        );
        if self.mode == Mode::Takeoff && !matches!(self.guidance.task, Task::Takeoff(_)) {
            self.enter(Mode::Takeoff);
        }
        MavResult::MAV_RESULT_ACCEPTED
    }

    /// Disarms on the ground; in the air only if forced.
    pub(super) fn disarm(&mut self, forced: bool) -> MavResult {
        if self.is_armed() && !self.is_landed() && !forced {
            if self.kind.is_px4() {
                self.say(MavSeverity::MAV_SEVERITY_CRITICAL, "Disarming denied: not landed");
                return MavResult::MAV_RESULT_TEMPORARILY_REJECTED;
            }
            return MavResult::MAV_RESULT_FAILED;
        }
        if self.is_armed() {
            self.switch_off("Disarmed by external command");
        }
        MavResult::MAV_RESULT_ACCEPTED
    }

    /// A mode asked for by command or by the pilot.
    pub(super) fn set_mode(&mut self, mode: Mode, now: Duration) -> MavResult {
        if mode.custom_mode(self.kind).is_none() {
            return MavResult::MAV_RESULT_DENIED;
        }
        let no_position = mode.needs_position() && !self.estimator.is_good(now);
        let no_signal = self.kind.is_px4() && mode == Mode::Guided && !self.has_signal(now);
        // disarmed, any mode may be chosen; arming is what is refused then
        if self.is_armed() && (no_position || no_signal) {
            let name = mode.name(self.kind);
            if self.kind.is_px4() {
                self.say(
                    MavSeverity::MAV_SEVERITY_CRITICAL,
                    format!("Switching to {name} is currently not available"),
                );
                return MavResult::MAV_RESULT_TEMPORARILY_REJECTED;
            }
            self.say(
                MavSeverity::MAV_SEVERITY_WARNING,
                format!("Mode change to {name} failed: requires position"),
            );
            return MavResult::MAV_RESULT_FAILED;
        }
        if self.mode != mode || self.intended != mode {
            self.intended = mode;
            if !mode.refuses_arming() {
                self.resting = mode;
            }
            self.safety.mode_chosen();
            self.enter(mode);
        }
        MavResult::MAV_RESULT_ACCEPTED
    }

    /// Begins to fly a mode.
    pub(super) fn enter(&mut self, mode: Mode) {
        self.mode = mode;
        let state = self.estimator.state;
        let height_m = state.position_m.z;
        let home_m = self.home_m.unwrap_or_else(Vector3::zeros);
        let task = match mode {
            Mode::Takeoff => Task::Takeoff(height_m + self.tuning.takeoff_height_m),
            Mode::Land => Task::Land,
            Mode::Return => {
                let cone_m = (state.position_m - home_m).xy().norm() * self.tuning.return_cone;
                let above_m = cone_m.min(self.tuning.return_height_m);
                Task::Return(Leg::Climb(height_m.max(home_m.z + above_m)))
            }
            // the first setpoint after the switch is the first that counts
            _ => Task::Hold,
        };
        self.guidance.begin(task, &state);
    }

    /// MAV_CMD_NAV_TAKEOFF; `height_m` as the command has it: above sea for PX4 (NaN takes the parameter),
    /// above home for ArduPilot.
    pub(super) fn take_off(&mut self, height_m: f64, now: Duration) -> MavResult {
        let state = self.estimator.state;
        if self.kind.is_px4() {
            let answer = self.set_mode(Mode::Takeoff, now);
            let asked_m = height_m - self.origin_altitude_m;
            if answer == MavResult::MAV_RESULT_ACCEPTED && asked_m > state.position_m.z + 0.5 {
                self.guidance.begin(Task::Takeoff(asked_m), &state);
            }
            return answer;
        }
        let ready = self.mode == Mode::Guided && self.is_armed() && self.is_landed();
        let home_m = self.home_m.unwrap_or_else(Vector3::zeros);
        let target_m = home_m.z + height_m;
        let climbs = target_m > state.position_m.z + 0.5;
        if !ready || !climbs {
            return MavResult::MAV_RESULT_FAILED;
        }
        self.guidance.begin(Task::Takeoff(target_m), &state);
        MavResult::MAV_RESULT_ACCEPTED
    }
}
