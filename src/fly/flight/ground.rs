//! On the ground: find the vehicle, check that it may fly, engage our mode, arm.

use std::time::Duration;

use super::checking::{AUTOPILOT_VERSION, Checking, interval};
use super::phase::Phase;
use super::state::{Contact, Flight};
use crate::autopilot::{Mode, SetpointRules};
use crate::fly::commander::{Answer, AnswerResult, Manner};
use crate::fly::health::BatteryLevel;
use crate::fly::outcome::{Cause, Level};
use crate::fly::preflight::ESTIMATE_GOOD_FOR;
use crate::fly::roster::Choice;
use crate::fly::safety::Lead;
use crate::fly::setpoint::Place;
use crate::fly::sortie::Origin;
use crate::fly::target::{MessageId, Order};
use crate::fly::telemetry::Telemetry;
use crate::wire::Payload;
use mavlink::dialects::ardupilotmega::{HEARTBEAT_DATA, MavCmd};

/// Time for which setpoints are sent before OFFBOARD.
const PRIME: Duration = Duration::from_millis(1500);
/// A position older than this counts as missing.
const POSITION_FRESH: Duration = Duration::from_millis(500);
/// Largest distance between vehicle and start of the trajectory, m. A larger distance is a mistake in the room's
/// origin, not a transfer.
const START_MAX_M: f64 = 5.0;
/// A vehicle that has not answered five requests a second for this time never answers.
const ANSWERS_WITHIN: Duration = Duration::from_secs(10);
const NO_ANSWERS: &str = "expected an answer to TIMESYNC, got none within 10 s: without it, after a stall or a silence, an old \
     report of the mode could not be distinguished from a new one, and no abort could be ordered. PX4 and ArduPilot \
     answer; \
     let routers on the way forward TIMESYNC";
/// Where it says the release.
const FLIGHT_SW_VERSION: usize = 16;
/// Manner of requests: their answers arrive soon or not at all.
const QUESTION: Manner = Manner {
    repeat: Duration::from_millis(400),
    patience: Duration::from_millis(1500),
    failed_is_temporary: false,
};

impl Flight {
    pub(super) fn connect(&mut self, now: Duration) {
        match self.roster.choose(now, self.sortie.system) {
            Choice::Vehicle(vehicle, target, stack) => {
                let text = format!("system {} component {}, {}", target.system, target.component, stack.name);
                let (system, component) = (target.system.0, target.component.0);
                tracing::info!(system, component, autopilot = stack.name, "vehicle found");
                self.note(now, Level::Information, "vehicle", text);
                let telemetry = Telemetry::new(vehicle, stack, now);
                self.contact = Some(Contact { target, telemetry });
                self.guide.target = Some((target, stack));
                self.enter(now, Phase::Check(Checking::new(stack)));
            }
            Choice::Refuse(why) => self.end(now, Cause::Refused(why)),
            Choice::Wait if now.saturating_sub(self.entered) > self.sortie.settings.connect_timeout => {
                let wanted =
                    self.sortie.system.map_or("a vehicle".to_owned(), |system| format!("system {system}"));
                let heard = self.roster.heard();
                self.end(now, Cause::Refused(format!("expected a HEARTBEAT of {wanted}, heard {heard}")));
            }
            Choice::Wait => self.tell_others(now),
        }
    }

    /// Reports once that other vehicles are heard but not the requested one.
    fn tell_others(&mut self, now: Duration) {
        let Some(system) = self.sortie.system.filter(|_| !self.told_others) else { return };
        if let Some(others) = self.roster.without(now, system) {
            self.told_others = true;
            self.note(
                now,
                Level::Warning,
                "vehicle",
                format!("waiting for system {system}; heard: {others}"),
            );
        }
    }

    /// Takes AUTOPILOT_VERSION. The vehicle that this program started has the nonce that it was given. Other reports
    /// about itself could come from anybody.
    pub(super) fn version(&mut self, now: Duration, payload: Payload<'_>) {
        let own = self.sortie.own_vehicle.is_some_and(|nonce| nonce.is_in(payload));
        // flight_sw_version: major, minor, patch, kind of release from its highest byte on
        let [_, _, minor, major] = payload.u32(FLIGHT_SW_VERSION).to_le_bytes();
        self.release = Some((major, minor)).filter(|release| *release != (0, 0));
        if let Phase::Check(checking) = &mut self.phase
            && checking.own.replace(own) != Some(own)
            && own
        {
            self.note(now, Level::Information, "vehicle", "the simulated vehicle of this program");
        }
    }

    pub(super) fn check(&mut self, now: Duration) {
        let Phase::Check(checking) = &mut self.phase else { return };
        let question = interval(MessageId::of::<HEARTBEAT_DATA>(), 1);
        let version = Order::request_message(AUTOPILOT_VERSION);
        if !self.commander.waits_for_kind(&question) && !self.commander.waits_for_kind(&version) {
            match checking.orders.pop() {
                Some(order) => self.commander.give(now, order, QUESTION, 0),
                // the answer's acknowledgement came and the answer itself was lost
                None if checking.own.is_none() && checking.version_chances > 0 => {
                    checking.version_chances -= 1;
                    self.commander.give(now, version, QUESTION, 0);
                }
                None => checking.all_asked = true,
            }
        }
        if !checking.all_asked {
            return;
        }
        let own = checking.own == Some(true);
        if let Some(Err(why)) = &self.clearance {
            let why = why.clone();
            self.end(now, Cause::Refused(why));
            return;
        }
        if !self.known.has_answers() {
            if now.saturating_sub(self.entered) > ANSWERS_WITHIN {
                self.end(now, Cause::Refused(NO_ANSWERS.to_owned()));
            }
            return;
        }
        let cleared = !self.sortie.settings.await_clearance || self.clearance.is_some();
        let mut missing = self.missing(now);
        if !cleared {
            missing.push("its parameters and message rates are not checked".to_owned());
        }
        if !missing.is_empty() {
            self.give_up_waiting(now, "the vehicle is not ready", &missing);
            return;
        }
        if !own && !self.sortie.may_arm {
            let why =
                "all checks passed; expected the order to arm, got none: a vehicle is armed only with --arm";
            self.end(now, Cause::Refused(why.to_owned()));
            return;
        }
        if self.awaits_word() {
            // reading takes its time
            self.entered = now;
            return;
        }
        self.found = self.custom_mode();
        if self.rules().is_some_and(|rules| rules.stream_before_mode) {
            self.hold_here();
            self.enter(now, Phase::Prime);
        } else {
            self.begin_engage(now);
        }
    }

    /// The vehicle's rules for setpoints; `None` before it is known.
    fn rules(&self) -> Option<&'static SetpointRules> {
        self.target().map(|(_, stack)| &stack.setpoints)
    }

    /// Whether all checks are done and the operator's word is awaited, for any time.
    pub(super) fn awaits_word(&self) -> bool {
        let cleared = matches!(self.clearance, Some(Ok(()))) || !self.sortie.settings.await_clearance;
        let checking = matches!(&self.phase, Phase::Check(checking) if checking.all_asked);
        self.sortie.settings.await_word && !self.word_given && checking && cleared
    }

    /// Missing conditions of a vehicle on the ground for our mode.
    fn missing(&self, now: Duration) -> Vec<String> {
        let Some(contact) = &self.contact else { return Vec::new() };
        let telemetry = &contact.telemetry;
        let mut missing = Vec::new();
        if telemetry.state.is_none() {
            missing.push("its mode is not known".to_owned());
        }
        if telemetry.is_armed() {
            missing.push("it is armed".to_owned());
        }
        if telemetry.battery_level() > BatteryLevel::Good {
            missing.push("its battery is low".to_owned());
        }
        if !telemetry.stack().setpoints.position_checked_in_mode {
            missing.extend(self.missing_estimate(now));
        }
        missing
    }

    /// Missing conditions of the estimate for a takeoff.
    fn missing_estimate(&self, now: Duration) -> Vec<String> {
        let Some(contact) = &self.contact else { return Vec::new() };
        let telemetry = &contact.telemetry;
        let mut missing = telemetry.estimator_faults(now);
        let motion = telemetry.motion.filter(|motion| now.saturating_sub(motion.at) < POSITION_FRESH);
        let good = |since: Option<Duration>| {
            since.is_some_and(|since| now.saturating_sub(since) >= ESTIMATE_GOOD_FOR)
        };
        match motion {
            None => missing.push("no local position arrives".to_owned()),
            Some(_) if !good(telemetry.position_since) => {
                missing.push("its position is known for less than 5 s".to_owned());
            }
            Some(_) if telemetry.estimator.is_some() && !good(telemetry.estimator_good_since) => {
                missing.push("its estimate is good for less than 5 s".to_owned());
            }
            Some(motion) => {
                let start = self.start_from(&motion.value.position_m);
                let away_m = (start.position_m - motion.value.position_m).xy().norm();
                if away_m > START_MAX_M && self.sortie.settings.origin == Origin::Local {
                    missing.push(format!(
                        "the trajectory starts {away_m:.1} m from where it stands ({START_MAX_M} m are \
                         allowed; --origin here flies it from there)"
                    ));
                } else if let Some(outside) = self.stands_outside(&motion.value.position_m) {
                    missing.push(outside);
                }
            }
        }
        missing
    }

    /// Ends the flight if the wait for the `missing` conditions was too long.
    fn give_up_waiting(&mut self, now: Duration, what: &str, missing: &[String]) {
        if now.saturating_sub(self.entered) > self.sortie.settings.ready_timeout {
            let mut reasons = missing.to_vec();
            reasons.extend(self.complaints());
            self.end(now, Cause::Refused(format!("{what}: {}", reasons.join("; "))));
        }
    }

    fn complaints(&self) -> Vec<String> {
        let said = self.contact.as_ref().map(|contact| contact.telemetry.complaints_since(self.entered));
        said.unwrap_or_default().into_iter().map(|text| format!("it says \"{text}\"")).collect()
    }

    /// Streams setpoints at the present place.
    fn hold_here(&mut self) {
        if let Some(place) = self.place_now() {
            self.guide.lead = Lead::Hold(place);
        }
    }

    /// Place and yaw of the vehicle.
    pub(super) fn place_now(&self) -> Option<Place> {
        let telemetry = &self.contact.as_ref()?.telemetry;
        let position_m = telemetry.motion?.value.position_m;
        let yaw_rad = telemetry.attitude.map_or(0.0, |attitude| attitude.value.euler().2);
        Some(Place { position_m, yaw_rad })
    }

    pub(super) fn prime(&mut self, now: Duration) {
        self.hold_here();
        if self.left_before_ours(now) {
            return;
        }
        if now.saturating_sub(self.entered) >= PRIME {
            self.begin_engage(now);
        }
    }

    fn begin_engage(&mut self, now: Duration) {
        let Some((_, stack)) = self.target() else { return };
        self.give(now, Order::set_mode(stack, Mode::External), Manner::PATIENT);
        self.enter(now, Phase::Engage);
    }

    pub(super) fn engage(&mut self, now: Duration) {
        let Some((_, stack)) = self.target() else { return };
        if self.guide.lead != Lead::Silent {
            self.hold_here();
        }
        if self.is_in(Mode::External) {
            self.enter(now, Phase::Ready);
        } else if !self.left_before_ours(now)
            && now.saturating_sub(self.entered) > 2 * Manner::PATIENT.patience
        {
            let mode = stack.name_of(Mode::External);
            self.end(now, Cause::Refused(format!("{mode} was accepted and is not entered")));
        }
    }

    /// Ends the start if somebody changed the vehicle's mode from the one in which it was found.
    fn left_before_ours(&mut self, now: Duration) -> bool {
        if self.custom_mode() == self.found {
            return false;
        }
        let found = self.target().zip(self.found).map(|((_, stack), mode)| stack.mode_name(mode));
        let (found, shown) = (found.unwrap_or_else(|| "an unknown mode".to_owned()), self.mode_name());
        self.end(now, Cause::Override(format!("{found} was left for {shown} before our mode was entered")));
        true
    }

    pub(super) fn ready(&mut self, now: Duration) {
        if self.guide.lead != Lead::Silent {
            self.hold_here();
        }
        let mut missing = self.missing_estimate(now);
        let system = self.contact.as_ref().and_then(|contact| contact.telemetry.system.clone());
        if system.is_some_and(|system| system.value.may_arm == Some(false)) {
            missing.push("its pre-arm checks fail".to_owned());
        }
        if !missing.is_empty() {
            self.give_up_waiting(now, "the vehicle is not ready to arm", &missing);
            return;
        }
        let manner = Manner {
            patience: self.sortie.settings.reach_timeout,
            failed_is_temporary: self.rules().is_some_and(|rules| rules.failed_is_temporary),
            ..Manner::PATIENT
        };
        self.give(now, Order::arm(true), manner);
        self.enter(now, Phase::Arm);
    }

    pub(super) fn arm(&mut self, now: Duration) {
        if self.guide.lead != Lead::Silent {
            self.hold_here();
        }
        if self.is_armed() {
            self.stand = self.place_now();
            self.begin_climb(now);
        } else if now.saturating_sub(self.entered) > 2 * self.sortie.settings.reach_timeout {
            self.end(now, Cause::Refused("arming was accepted and the vehicle is not armed".to_owned()));
        }
    }

    /// A command has ended.
    pub(super) fn answered(&mut self, now: Duration, answer: &Answer) {
        let name = answer.order.name();
        let question = matches!(self.phase, Phase::Check(_));
        if answer.result == AnswerResult::Accepted {
            tracing::debug!(command = name, "command accepted");
            if !question {
                self.note(now, Level::Information, "command", format!("{name} accepted"));
            }
            return;
        }
        tracing::warn!(command = name, result = answer.result.text(), "command refused, or not answered");
        let mut reasons = vec![answer.result.text()];
        if !question {
            reasons.extend(self.complaints());
        }
        let text = format!("{name}: {}", reasons.join("; "));
        self.note(now, Level::Warning, "command", text.clone());
        let decides = match self.phase {
            Phase::Engage => answer.order.command() == MavCmd::MAV_CMD_DO_SET_MODE,
            Phase::Arm => answer.order.command() == MavCmd::MAV_CMD_COMPONENT_ARM_DISARM,
            Phase::Climb => answer.order.command() == MavCmd::MAV_CMD_NAV_TAKEOFF,
            _ => false,
        };
        if decides {
            let refused = matches!(answer.result, AnswerResult::Refused { .. });
            self.arm_ordered &= !(refused && answer.order == Order::arm(true));
            self.end(now, Cause::Refused(text));
        }
    }

    /// The last reported mode.
    pub(super) fn custom_mode(&self) -> Option<u32> {
        Some(self.contact.as_ref()?.telemetry.state?.value.custom_mode)
    }

    /// Whether the vehicle reports this mode.
    pub(super) fn is_in(&self, mode: Mode) -> bool {
        self.contact.as_ref().is_some_and(|contact| {
            let telemetry = &contact.telemetry;
            telemetry.state.is_some_and(|state| telemetry.stack().is_in(mode, state.value.custom_mode))
        })
    }
}
