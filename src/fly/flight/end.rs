//! The end of a flight for a cause.

use std::time::Duration;

use super::action::Action;
use super::phase::Phase;
use super::state::Flight;
use crate::fly::outcome::{Cause, Ending, FlightStatistics, Level, Outcome, Response};
use crate::fly::safety::Lead;
use crate::units::deg_from_rad;

impl Flight {
    /// Ends the flight for a cause. The first cause counts, unless a later one means hands off.
    pub(super) fn end(&mut self, now: Duration, cause: Cause) {
        if matches!(self.phase, Phase::Watch | Phase::Done) {
            return;
        }
        let response = cause.response();
        let leaving = matches!(self.phase, Phase::Leave(_));
        if leaving && !matches!(response, Response::HandsOff | Response::Wait) {
            return;
        }
        if matches!((&self.phase, response), (Phase::Lost, Response::Hold | Response::Land | Response::Wait))
        {
            return;
        }
        tracing::error!(%cause, ?response, phase = self.phase.name(), "flight aborted");
        self.note(now, Level::Error, "abort", cause.to_string());
        if self.cause.is_none() {
            self.flown.stalled_before_end_s = self.late_stall_s(now);
        }
        self.cause.get_or_insert(cause);
        if !self.phase.is_airborne() && !self.is_armed() && !self.arm_ordered {
            self.finish(now, Ending::NotFlown);
            return;
        }
        match response {
            Response::HandsOff => self.hands_off(now),
            Response::Wait => self.lose(now),
            Response::Hold => self.begin_hold(now),
            Response::Land => self.begin_landing(now),
        }
    }

    pub(super) fn finish(&mut self, now: Duration, ending: Ending) {
        self.guide.lead = Lead::Silent;
        self.commander.clear();
        let (rms_m, max_m) = self.watch.tracking.figures_m();
        let flown = FlightStatistics {
            tracking_rms_m: rms_m,
            tracking_max_m: max_m,
            tilt_max_deg: deg_from_rad(self.watch.envelope.greatest_tilt_rad()),
            ..self.flown.clone()
        };
        self.enter(now, Phase::Done);
        let (cause, losses) = (self.cause.clone(), self.losses.clone());
        self.actions.push_back(Action::Finished(Outcome { cause, ending, flown, losses }));
    }
}
