//! Failsafes and the reasons for which the vehicle does not arm.

use std::time::Duration;

use mavlink::dialects::ardupilotmega::MavSeverity;

use super::Mode;
use super::action::Action;
use super::autopilot::Autopilot;
use super::battery::Charge;
use super::fence::Breach;
use super::guidance::Task;

impl Autopilot {
    /// The last setpoint is young enough for OFFBOARD.
    pub(super) fn has_signal(&self, now: Duration) -> bool {
        let age = self.safety.last_setpoint.map(|last| now.saturating_sub(last));
        age.is_some_and(|age| age <= self.tuning.setpoint_timeout)
    }

    /// A heartbeat of a ground station came in.
    pub(super) fn ground_station_seen(&mut self, system: u8, now: Duration) {
        if self.tuning.ground_system.is_some_and(|counts| counts != system) {
            return;
        }
        self.safety.ground_seen = Some(now);
        if std::mem::take(&mut self.safety.ground_lost) && self.kind.is_px4() {
            self.say(MavSeverity::MAV_SEVERITY_INFO, "Connection to ground control station regained");
        }
    }

    /// Why it does not arm now, as the vehicle says it.
    pub(super) fn arming_refusals(&self, now: Duration) -> Vec<String> {
        let mut reasons = Vec::new();
        let no_position = self.mode.needs_position() && !self.estimator.is_good(now);
        if !self.kind.is_px4() {
            if self.mode.refuses_arming() {
                reasons.push(format!("Arm: {} mode not armable", self.mode.name(self.kind)));
            }
            if no_position {
                reasons.push("Arm: Need Position Estimate".to_owned());
            }
            if self.safety.charge != Charge::Ok {
                reasons.push("Arm: Battery 1 failsafe".to_owned());
            }
            if self.safety.breach.is_any() {
                reasons.push(format!("Arm: Vehicle breaching {}", self.safety.breach.ardupilot_name()));
            }
            return reasons;
        }
        if no_position {
            reasons.push("Preflight Fail: ekf2 missing data".to_owned());
        }
        if self.mode == Mode::Guided && !self.has_signal(now) {
            reasons.push("Preflight Fail: No offboard signal".to_owned());
        }
        if self.safety.charge != Charge::Ok {
            reasons.push("Preflight Fail: low battery".to_owned());
        }
        reasons.extend(self.safety.breach.px4_names().map(str::to_owned));
        if self.tuning.ground_loss != Action::Warn
            && (self.safety.ground_seen.is_none() || self.safety.ground_lost)
        {
            reasons.push("Preflight Fail: No connection to the ground control station".to_owned());
        }
        if !reasons.is_empty() {
            reasons.push("Arming denied: Resolve system health failures first".to_owned());
        }
        reasons
    }

    /// Everything that is lost, and what is done about it.
    pub(super) fn check_safety(&mut self, now: Duration) {
        self.check_battery(now);
        self.check_ground(now);
        self.check_fence(now);
        if let Some((_, mode)) = self.safety.later.take_if(|(when, _)| *when <= now) {
            self.say(MavSeverity::MAV_SEVERITY_CRITICAL, "Failsafe activated");
            self.enter(mode);
        }
        if self.is_armed() && !self.is_landed() {
            self.check_position(now);
        }
        if self.is_armed() && self.kind.is_px4() {
            self.check_setpoints(now);
        }
    }

    /// PX4: without setpoints it leaves OFFBOARD, and goes back to it by itself when they resume.
    fn check_setpoints(&mut self, now: Duration) {
        let lost = self.intended == Mode::Guided && !self.has_signal(now);
        let was = std::mem::replace(&mut self.safety.setpoints_lost, lost);
        if lost && !was {
            self.say(MavSeverity::MAV_SEVERITY_CRITICAL, "No offboard signal");
            if !self.safety.overrides {
                self.say(MavSeverity::MAV_SEVERITY_CRITICAL, "Failsafe activated");
                self.act(self.tuning.setpoint_loss);
            }
        } else if was
            && !lost
            && self.intended == Mode::Guided
            && !self.safety.position_lost
            && !self.safety.overrides
        {
            self.enter(Mode::Guided);
        }
    }

    fn check_position(&mut self, now: Duration) {
        let lost = self.mode.needs_position() && !self.estimator.is_good(now);
        if lost && !self.safety.position_lost {
            self.safety.position_lost = true;
            if self.kind.is_px4() {
                self.say(MavSeverity::MAV_SEVERITY_CRITICAL, "Failsafe activated");
                self.act(Action::Descend(Mode::Land));
            } else {
                self.say(MavSeverity::MAV_SEVERITY_CRITICAL, "EKF Failsafe: changed to LAND Mode");
                self.act(Action::Enter(Mode::Land));
            }
        } else if self.estimator.is_good(now) {
            self.safety.position_lost = false;
        }
    }

    fn check_ground(&mut self, now: Duration) {
        let silent = self.safety.ground_seen.map(|seen| now.saturating_sub(seen));
        if self.safety.ground_lost || silent.is_none_or(|silent| silent <= self.tuning.ground_timeout) {
            return;
        }
        self.safety.ground_lost = true;
        if self.kind.is_px4() {
            self.say(MavSeverity::MAV_SEVERITY_WARNING, "Connection to ground control station lost");
        } else if self.tuning.ground_loss != Action::Warn {
            self.say(MavSeverity::MAV_SEVERITY_WARNING, "GCS Failsafe");
        }
        if self.is_armed() {
            self.fail_over(self.tuning.ground_loss, now);
        }
    }

    fn check_battery(&mut self, now: Duration) {
        let charge = self.battery.charge(&self.tuning.battery_thresholds);
        if charge <= self.safety.charge {
            return;
        }
        self.safety.charge = charge;
        let volts = self.battery.volts();
        let (text, action) = match (self.kind.is_px4(), charge) {
            (true, Charge::Critical) => {
                ("Critical battery, return now".to_owned(), self.tuning.critical_battery)
            }
            (true, _) => ("Low battery, return advised".to_owned(), self.tuning.low_battery),
            (false, Charge::Critical) => {
                (format!("Battery 1 is critical {volts:.2}V used 0 mAh"), self.tuning.critical_battery)
            }
            (false, _) => (format!("Battery 1 is low {volts:.2}V used 0 mAh"), self.tuning.low_battery),
        };
        self.say(MavSeverity::MAV_SEVERITY_WARNING, text);
        if self.is_armed() {
            self.fail_over(action, now);
        }
    }

    /// A border that is crossed again. What is outside before it flies is for the checks before arming.
    fn check_fence(&mut self, now: Duration) {
        let breach = self.breach_now(now);
        let before = std::mem::replace(&mut self.safety.breach, breach);
        let new = breach.since(before);
        let Some(action) = self.tuning.fence.map(|rules| rules.action) else { return };
        if !self.is_armed() {
            return;
        }
        if !self.kind.is_px4() && before.is_any() && !breach.is_any() && !self.is_landed() {
            self.say(MavSeverity::MAV_SEVERITY_NOTICE, "Fence breach cleared");
        }
        if !new.is_any() {
            return;
        }
        if self.kind.is_px4() {
            new.px4_names().for_each(|name| self.say(MavSeverity::MAV_SEVERITY_CRITICAL, name));
            // the action lasts until a mode is chosen, however often the border is crossed meanwhile
            if !std::mem::replace(&mut self.safety.fence_acts, action != Action::Warn) {
                self.fail_over(action, now);
            }
            return;
        }
        self.say(MavSeverity::MAV_SEVERITY_NOTICE, format!("{} breached", new.ardupilot_name()));
        match action {
            Action::Warn => {}
            Action::Enter(mode) if mode == self.mode => {}
            _ if self.is_landed() => self.switch_off("Disarming motors"),
            action => self.act(action),
        }
    }

    /// Where the vehicle is beyond its fence; without a position, what it was.
    fn breach_now(&self, now: Duration) -> Breach {
        match (&self.tuning.fence, &self.home_m) {
            (None, _) => Breach::default(),
            (Some(rules), Some(home_m)) if self.estimator.is_good(now) => {
                self.fence.breach(rules, &self.estimator.state.position_m, home_m)
            }
            _ => self.safety.breach,
        }
    }

    /// A failsafe that stays until somebody chooses a mode. PX4 holds for a while before it returns or lands, so
    /// that somebody can.
    fn fail_over(&mut self, action: Action, now: Duration) {
        let (true, Action::Enter(mode)) = (self.kind.is_px4(), action) else { return self.act(action) };
        let delay = self.tuning.failsafe_delay;
        self.safety.overrides = true;
        if mode == Mode::Hold || delay.is_zero() {
            self.say(MavSeverity::MAV_SEVERITY_CRITICAL, "Failsafe activated");
            self.safety.later = None;
            return self.enter(mode);
        }
        self.say(
            MavSeverity::MAV_SEVERITY_CRITICAL,
            format!("Failsafe activated: entering Hold for {} seconds", delay.as_secs()),
        );
        self.safety.later = Some((now + delay, mode));
        self.enter(Mode::Hold);
    }

    fn act(&mut self, action: Action) {
        match action {
            Action::Warn => {}
            Action::Enter(mode) => {
                // PX4 keeps what was asked for
                if !self.kind.is_px4() {
                    self.intended = mode;
                }
                self.enter(mode);
            }
            Action::Descend(mode) => {
                let state = self.estimator.state;
                self.mode = mode;
                let held = self.safety.transmitter && mode.is_manual();
                self.guidance.begin(if held { Task::Hold } else { Task::Land }, &state);
            }
            Action::Terminate => self.switch_off("Terminated"),
        }
    }
}
