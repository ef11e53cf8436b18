//! Evaluation of the received frames.

use std::time::Duration;

use super::phase::Phase;
use super::state::Flight;
use crate::autopilot::Mode;
use crate::fly::news::Novelty;
use crate::fly::outcome::{Cause, Level};
use crate::fly::safety::Doubted;
use crate::wire::message_id::{AUTOPILOT_VERSION, COMMAND_ACK, TIMESYNC};
use crate::wire::{Check, Frame};

/// Time for a vehicle to follow our setpoints after its takeoff, and to report it.
const TAKEN_OVER: Duration = Duration::from_millis(1500);
/// After a silence of this length the vehicle's mode is requested; normally frames arrive a hundred times a second.
const SILENCE: Duration = Duration::from_millis(500);

impl Flight {
    pub(super) fn hear(&mut self, now: Duration, frame: Frame<'_>) {
        if frame.check(&self.seeds) != Check::Right {
            return;
        }
        self.roster.hear(now, frame);
        let Some(contact) = &mut self.contact else { return };
        let header = frame.header();
        if (header.system, header.component) != (contact.target.system, contact.target.component) {
            if let Some(cause) = self.watch.masters.hear(frame, contact.target) {
                self.end(now, cause);
            }
            return;
        }
        if now.saturating_sub(contact.telemetry.heard) > SILENCE {
            self.known.doubt(now, Doubted::Silence);
        }
        let reports = contact.telemetry.mode_reports();
        let news = contact.telemetry.take(now, frame);
        let place = contact.telemetry.place();
        if contact.telemetry.mode_reports() > reports {
            self.known.report(place);
        }
        if let (Phase::Gate, Some(lift)) = (&self.phase, &mut self.lift) {
            for outputs in contact.telemetry.outputs() {
                lift.add(outputs);
            }
        }
        match header.message_id {
            // its addressee is an extension that may be zero
            COMMAND_ACK => {
                let payload = frame.payload();
                let ours = payload.u8(8) == 0 || u32::from(payload.u8(8)) == self.sortie.settings.station.0.0;
                if ours && let Some(answer) = self.commander.hear(now, payload) {
                    self.answered(now, &answer);
                }
            }
            // what asks has zero in front. The number tells whose answer it is; the addressee does not: PX4's
            // TIMESYNC module leaves these two bytes as they were in its memory
            TIMESYNC if frame.payload().u64(0) != 0 => {
                self.known.answered(frame.payload().u64(8).cast_signed(), place);
            }
            AUTOPILOT_VERSION => self.version(now, frame.payload()),
            _ => {}
        }
        for novelty in news {
            self.learn(now, novelty);
        }
        self.check_motion(now);
    }

    /// Whether it has been heard without a pause for long enough to follow our setpoints.
    fn is_settled(&self, now: Duration) -> bool {
        self.contact
            .as_ref()
            .is_some_and(|contact| now.saturating_sub(contact.telemetry.resumed) >= TAKEN_OVER)
    }

    fn learn(&mut self, now: Duration, novelty: Novelty) {
        let Some((_, stack)) = self.target() else { return };
        match novelty {
            Novelty::State { from, to } => {
                let mode = stack.mode_name(to.custom_mode);
                let armed = if to.armed { "armed" } else { "disarmed" };
                if from.is_none_or(|from| (from.custom_mode, from.armed) != (to.custom_mode, to.armed)) {
                    tracing::info!(mode, armed = to.armed, "mode reported");
                    // a report of the mode alone says nothing of the motors: what is known of them may be old
                    let is_news = from.is_none_or(|from| from.armed != to.armed);
                    let armed = if is_news { format!(", {armed}") } else { String::new() };
                    self.note(now, Level::Information, "mode", format!("{mode}{armed}"));
                }
            }
            Novelty::LateMode(mode) => {
                self.known.doubt(now, Doubted::Contradiction);
                // however late: into a mode that is none of ours somebody else has put it
                let ours = [Mode::External, Mode::Hold, Mode::Land, Mode::Return];
                let was_ours =
                    self.found == Some(mode) || ours.into_iter().any(|ours| stack.is_in(ours, mode));
                if self.phase.is_airborne() && !was_ours {
                    let mode = stack.mode_name(mode);
                    self.end(now, Cause::Override(format!("{mode} was reported, late")));
                }
            }
            Novelty::Text(severity, text) => {
                let level = match severity {
                    0..=3 => Level::Error,
                    4 => Level::Warning,
                    _ => Level::Information,
                };
                self.note(now, level, "vehicle", text);
            }
            // frames of long ago look like it too: the mode tells whether it is still ours to hold
            Novelty::Reboot if self.phase.is_airborne() => {
                self.known.doubt(now, Doubted::Silence);
                self.end(now, Cause::Reboot);
            }
            Novelty::Reboot => {
                self.end(now, Cause::Refused("the autopilot restarted; expected it to stay on".into()));
            }
            Novelty::EstimatorReset(what) if self.phase.is_airborne() => {
                self.end(now, Cause::EstimatorReset(what));
            }
            Novelty::EstimatorReset(what) | Novelty::EstimatorStep(what) => {
                self.note(now, Level::Warning, "estimator", what);
            }
            Novelty::Target(place_m) => {
                if self.is_following(now)
                    && let Some(cause) = self.watch.masters.check(now, place_m, stack)
                {
                    let reports = self.known.reports();
                    self.suspected.get_or_insert((cause, reports));
                }
            }
        }
    }

    /// Whether the target that the vehicle reports must be ours.
    fn is_following(&self, now: Duration) -> bool {
        // after a silence it may still tell where its failsafe led
        let settled = self.is_settled(now) && !self.known.is_in_doubt();
        settled
            && match self.phase {
                // at first it may still say where its takeoff led
                Phase::Transfer => now.saturating_sub(self.entered) >= TAKEN_OVER,
                Phase::Gate | Phase::Course => true,
                _ => false,
            }
    }
}
