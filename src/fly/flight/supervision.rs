//! The safety rules, checked in every step.

use std::time::Duration;

use super::phase::Phase;
use super::state::Flight;
use crate::autopilot::Mode;
use crate::fly::health::BatteryLevel;
use crate::fly::outcome::{Cause, Ending, Level};
use crate::fly::safety::Lead;
use crate::fly::target::Order;

/// Silence after which the trajectory waits.
const PAUSE_AFTER: Duration = Duration::from_secs(2);
/// Silence after which the flight is given up.
const GIVE_UP_AFTER: Duration = Duration::from_secs(5);
/// Without a HEARTBEAT within this time the mode is not known; other messages may still arrive.
const HEARTBEAT_MAX: Duration = Duration::from_secs(6);
/// Without a position for this time there is no estimate.
const POSITION_MAX: Duration = Duration::from_secs(2);
/// After a stall of this program, the messages in the socket are read within this time.
const SOCKET_IS_READ: Duration = Duration::from_millis(500);
/// If other messages arrive within this time, the estimate is silent and not the link.
const STILL_HEARD: Duration = Duration::from_millis(500);
/// Innovation tests fail for an instant; an estimate is bad if they fail for this time.
const ESTIMATOR_BAD: Duration = Duration::from_secs(1);
/// If an autopilot declares a failsafe and does not change the mode within this time, its failsafe does nothing. A
/// report of its battery, which may be the reason, arrives within this time.
const FAILSAFE_ACTS: Duration = Duration::from_millis(2500);
/// An order to stop the motors that waits for a report of the mode is given up after this time, together with the
/// setpoints that keep the vehicle in the mode.
const KILL_BY: Duration = Duration::from_secs(7);
/// A termination (a kill switch, a parachute) that is declared for this time is not a forged or damaged frame.
const TERMINATES: Duration = Duration::from_secs(1);

impl Flight {
    /// All rules for the time in which the vehicle is in our mode.
    pub(super) fn supervise(&mut self, now: Duration) {
        if self.contact.is_none() || matches!(self.phase, Phase::Done) {
            return;
        }
        self.tell_contradiction(now);
        if let Some(cause) = self.check_stand() {
            self.end(now, cause);
            return;
        }
        if self.phase.is_ours() {
            let cause = self
                .check_mode(now)
                .or_else(|| self.check_setpoint(now))
                .or_else(|| self.check_suspicion())
                .or_else(|| self.check_vehicle(now));
            if let Some(cause) = cause {
                self.end(now, cause);
                return;
            }
        }
        if self.phase.is_ours() || matches!(self.phase, Phase::Prime | Phase::Engage | Phase::Leave(_)) {
            self.check_link(now);
        }
    }

    fn check_mode(&mut self, now: Duration) -> Option<Cause> {
        if let Some(what) = self.left_our_mode() {
            let said = self.contact.as_ref().map(|contact| {
                let recent = now.saturating_sub(Duration::from_secs(3));
                contact.telemetry.complaints_since(recent)
            });
            let said = said.filter(|said| !said.is_empty()).map(|said| format!(" ({})", said.join("; ")));
            return Some(Cause::Override(what + &said.unwrap_or_default()));
        }
        let flying = self.phase.is_airborne();
        if flying && !self.is_armed() {
            return Some(Cause::Override("it was disarmed".to_owned()));
        }
        None
    }

    /// Checks a suspected second station. The cause may be the vehicle's own failsafe or its pilot, which a report of
    /// the mode shows a moment later. It is a second station only if the mode stays ours.
    fn check_suspicion(&mut self) -> Option<Cause> {
        let confirmed = |(_, reports): &mut (Cause, u64)| self.known.reports() > *reports;
        self.suspected.take_if(confirmed).map(|(cause, _)| cause)
    }

    /// Reports a single "disarmed" in the air, which is not accepted.
    fn tell_contradiction(&mut self, now: Duration) {
        let contradicted = self.contact.as_ref().is_some_and(|contact| {
            let telemetry = &contact.telemetry;
            // after a landing the ground is heard a moment later
            telemetry.is_arming_contradicted() && !telemetry.ground.is_said()
        });
        if contradicted && !std::mem::replace(&mut self.watch.told_contradiction, contradicted) {
            let text =
                "a HEARTBEAT says that it is disarmed and nothing else agrees: ignored unless it is repeated";
            self.note(now, Level::Warning, "vehicle", text);
        }
    }

    /// Checks that the streamed setpoint can be sent.
    fn check_setpoint(&self, now: Duration) -> Option<Cause> {
        let (target, _) = self.target()?;
        let why = self.guide.setpoint(now)?.message(target).err()?;
        Some(Cause::Unfit(why.to_string()))
    }

    fn check_vehicle(&mut self, now: Duration) -> Option<Cause> {
        let flying = self.phase.is_airborne();
        let telemetry = &self.contact.as_ref()?.telemetry;
        if !flying {
            return None;
        }
        if telemetry.battery_level() == BatteryLevel::Critical {
            return Some(Cause::Battery("it is critical".to_owned()));
        }
        let bad =
            telemetry.estimator_bad_since.is_some_and(|since| now.saturating_sub(since) >= ESTIMATOR_BAD);
        let unhealthy = telemetry.system.as_ref().is_some_and(|seen| !seen.value.unhealthy.is_empty());
        let unhealthy = self.watch.unhealthy.update(now, unhealthy) >= ESTIMATOR_BAD;
        if bad || unhealthy {
            return Some(Cause::Estimator(telemetry.estimator_faults(now).join("; ")));
        }
        // after a silence the first message is seldom a position
        let since = telemetry.motion.map_or(telemetry.resumed, |motion| motion.at.max(telemetry.resumed));
        let heard = now.saturating_sub(telemetry.heard) < STILL_HEARD;
        if heard && now.saturating_sub(since) > POSITION_MAX {
            return Some(Cause::Estimator("no local position arrives".to_owned()));
        }
        self.check_declared(now)
    }

    /// Checks the system status of the autopilot. ArduPilot declares a failsafe whatever its reaction is, and continues
    /// in our mode if the reaction is none: mavid then has to end the flight. A low battery has a rule of its own.
    fn check_declared(&mut self, now: Duration) -> Option<Cause> {
        let telemetry = &self.contact.as_ref()?.telemetry;
        let status = telemetry.state?.value;
        let said = || telemetry.complaints_since(now.saturating_sub(Duration::from_secs(5))).join("; ");
        if self.watch.terminated.update(now, status.is_terminated()) >= TERMINATES {
            return Some(Cause::Override(format!("flight termination is declared; it says \"{}\"", said())));
        }
        let explained = telemetry.battery_level() == BatteryLevel::Low;
        if self.watch.failsafe.update(now, status.is_in_failsafe() && !explained) >= FAILSAFE_ACTS {
            return Some(Cause::Failsafe(format!(
                "declared, and the mode is still ours; it says \"{}\"",
                said()
            )));
        }
        None
    }

    /// Rules on the place of the vehicle, checked at each frame of it.
    pub(super) fn check_motion(&mut self, now: Duration) {
        if !self.phase.is_ours() || !self.phase.is_airborne() {
            return;
        }
        let Some(contact) = &self.contact else { return };
        let telemetry = &contact.telemetry;
        let tilted = telemetry
            .attitude
            .filter(|attitude| attitude.at == now)
            .and_then(|attitude| self.watch.envelope.check_tilt(now, &attitude.value));
        let motion = telemetry.motion.filter(|motion| motion.at == now);
        let on_course = matches!(self.phase, Phase::Course);
        let mut cause = tilted;
        if let (Some(motion), Some(stand)) = (motion, self.stand) {
            let position_m = motion.value.position_m;
            let offset_m = self.offset_m(&stand.position_m);
            let limit_m = self.sortie.settings.tracking_max_m;
            let off = self.watch.tracking.check(now, &position_m, limit_m, 0.0);
            if on_course {
                self.watch.tracking.count();
                let outside = self.watch.envelope.check_room(now, &(position_m - offset_m));
                cause = cause.or(outside);
            }
            cause = cause.or(off);
        }
        if let Some(cause) = cause {
            self.end(now, cause);
        }
    }

    fn check_link(&mut self, now: Duration) {
        let Some(contact) = &self.contact else { return };
        // no setpoint goes out meanwhile
        if self.watch.awake > Duration::ZERO && now.saturating_sub(self.watch.awake) < SOCKET_IS_READ {
            return;
        }
        let silent = now.saturating_sub(contact.telemetry.heard);
        // what comes first after a silence is seldom a HEARTBEAT
        let no_mode = now.saturating_sub(contact.telemetry.heartbeat.max(contact.telemetry.resumed));
        if silent > GIVE_UP_AFTER || no_mode > HEARTBEAT_MAX {
            let what = if silent > GIVE_UP_AFTER { "anything" } else { "a HEARTBEAT" };
            let age_s = silent.max(no_mode.min(HEARTBEAT_MAX)).as_secs_f64();
            self.end(now, Cause::LinkLost(format!("{age_s:.1} s without {what} of the vehicle")));
            return;
        }
        if let Some(unknown) = self.unanswered(now).filter(|unknown| *unknown > GIVE_UP_AFTER) {
            let text = format!(
                "{:.1} s without an answer of the vehicle, although its messages arrive",
                unknown.as_secs_f64()
            );
            self.end(now, Cause::LinkLost(text));
            return;
        }
        match (silent > PAUSE_AFTER, self.watch.paused_since) {
            (true, None) => {
                self.watch.paused_since = Some(now);
                self.note(now, Level::Warning, "link", "2 s without a message: the trajectory waits");
            }
            (false, Some(since)) => {
                self.watch.paused_since = None;
                let lasted_s = now.saturating_sub(since).as_secs_f64();
                if matches!(self.phase, Phase::Course) {
                    self.flown.paused_s += lasted_s;
                    self.losses.push(format!("the trajectory waited {lasted_s:.1} s for the link"));
                }
                self.note(
                    now,
                    Level::Warning,
                    "link",
                    format!("the link is back after {lasted_s:.1} s of waiting"),
                );
            }
            _ => {}
        }
    }

    /// Time for which a vehicle in our mode has not answered requests for its mode.
    fn unanswered(&self, now: Duration) -> Option<Duration> {
        let resumed = self.contact.as_ref()?.telemetry.resumed;
        let since = self.known.unknown_since().filter(|_| self.phase.is_ours())?;
        Some(now.saturating_sub(since.max(resumed).max(self.watch.awake)))
    }

    /// Handles the loss of the vehicle: nothing is sent until it is heard again and is still in our mode.
    pub(super) fn lose(&mut self, now: Duration) {
        self.guide.lead = Lead::Silent;
        self.commander.clear();
        self.enter(now, Phase::Lost);
        let text = "setpoints have ended; its own failsafe acts. Once it is heard and answers, and is still in our mode, it is \
                    told to hold";
        self.note(now, Level::Warning, "link", text);
    }

    /// Waits for a report of the vehicle after a loss of the link.
    pub(super) fn wait_for_word(&mut self, now: Duration) {
        let Some(contact) = &self.contact else { return };
        let heard = now.saturating_sub(contact.telemetry.heard) < PAUSE_AFTER;
        if !heard {
            self.give_up_listening(now);
        } else if !self.is_armed() {
            self.finish_watching(now);
        } else if !self.is_in(Mode::External) {
            // it left our mode meanwhile: even if it reports it again, nothing is sent any more
            let mode = self.mode_name();
            self.note(
                now,
                Level::Warning,
                "link",
                format!("the link is back; the vehicle is in mode {mode}"),
            );
            self.hands_off(now);
        } else if !self.known.is_in_doubt() && !contact.telemetry.is_arming_contradicted() {
            // it may have landed meanwhile, and its mode may have changed: without doubt about either it is told to hold
            self.note(now, Level::Warning, "link", "the link is back; the vehicle is still in the mode of setpoints and is told to hold its position");
            self.begin_hold(now);
        } else if now.saturating_sub(self.entered) > self.sortie.settings.watch_max {
            let mode = self.mode_name();
            self.finish(now, Ending::InTheAir(mode));
        }
    }

    /// Hands off: from now on only heartbeats are sent, and no mode is ordered again, whatever the vehicle reports
    /// later.
    pub(super) fn hands_off(&mut self, now: Duration) {
        self.guide.lead = Lead::Silent;
        self.commander.clear();
        self.enter(now, Phase::Watch);
        let text = "nothing is sent but heartbeats; the vehicle is recorded until it is disarmed (Ctrl-C ends it now)";
        self.note(now, Level::Information, "watch", text);
    }

    /// Watches a vehicle that others fly.
    pub(super) fn watch_others(&mut self, now: Duration) {
        let Some(contact) = &self.contact else { return };
        let heard = now.saturating_sub(contact.telemetry.heard) < PAUSE_AFTER;
        let late = now.saturating_sub(self.entered) > KILL_BY;
        if late && self.commander.waits_for(&Order::kill()) {
            self.commander.forget(&Order::kill());
            let text = "the mode was not known in time, so the motors were not stopped: only the pilot may stop them";
            self.note(now, Level::Error, "abort", text);
        }
        let killing = self.commander.waits_for(&Order::kill()) && self.is_to_command();
        if !killing {
            self.guide.lead = Lead::Silent;
        }
        if heard && !self.is_armed() && !killing {
            self.finish_watching(now);
        } else if now.saturating_sub(self.entered) > self.sortie.settings.watch_max {
            let mode = if heard { self.mode_name() } else { "not heard".to_owned() };
            self.finish(now, Ending::InTheAir(mode));
        } else {
            self.give_up_listening(now);
        }
    }

    /// Ends the watch: the motors are off.
    fn finish_watching(&mut self, now: Duration) {
        let ending = match self.cause {
            Some(Cause::Killed) => Ending::Fell,
            _ if self.stand.is_some() => Ending::Landed,
            _ => Ending::NotFlown,
        };
        self.finish(now, ending);
    }

    /// Ends the flight if nothing was heard for too long.
    fn give_up_listening(&mut self, now: Duration) {
        let Some(contact) = &self.contact else { return };
        let silent = now.saturating_sub(contact.telemetry.heard.max(self.watch.awake));
        if silent > self.sortie.settings.gone_after {
            self.finish(now, Ending::InTheAir("not heard".to_owned()));
        }
    }

    /// The name of the vehicle's mode.
    pub(super) fn mode_name(&self) -> String {
        let state = self.contact.as_ref().and_then(|contact| {
            Some(contact.telemetry.stack().mode_name(contact.telemetry.state?.value.custom_mode))
        });
        state.unwrap_or_else(|| "not known".to_owned())
    }
}
