//! Commands to the vehicle, which wait for a report of its mode.

use std::time::Duration;

use super::action::Action;
use super::phase::Phase;
use super::state::Flight;
use super::status::STALL_SHOWN;
use crate::autopilot::Mode;
use crate::fly::commander::{Manner, Permission};
use crate::fly::outcome::{Cause, Level};
use crate::fly::safety::{Doubted, Lead, SHORT, SILENT_AFTER};
use crate::fly::target::{MessageId, Order, timesync};
use mavlink::dialects::ardupilotmega::HEARTBEAT_DATA;

impl Flight {
    /// Requests the mode if it is needed, and sends the commands that it permits.
    pub(super) fn command(&mut self, now: Duration) {
        if let Some((target, _)) = self.target() {
            let permission = self.permission();
            let waits = self.commander.waits_for_report(now, permission) || self.known.is_in_doubt();
            // before the flight it is seen that questions are answered at all
            let tries = matches!(self.phase, Phase::Check(_)) && !self.known.has_answers();
            if let Some(number) = self.known.asks(now, waits || tries) {
                self.actions.push_back(Action::Send(timesync(number)));
                if waits {
                    let question = Order::request_message(MessageId::of::<HEARTBEAT_DATA>());
                    self.actions.push_back(Action::Send(target.command(&question, 0)));
                }
            }
            let (messages, answers) = self.commander.poll(now, target, permission);
            if let (Phase::Leave(leaving), Some((_, stack))) = (&mut self.phase, self.guide.target)
                && self.commander.has_sent(&Order::set_mode(stack, leaving.wish()))
            {
                leaving.ordered();
            }
            self.arm_ordered |= self.commander.has_sent(&Order::arm(true));
            self.actions.extend(messages.into_iter().map(Action::Send));
            for answer in answers {
                self.answered(now, &answer);
            }
        }
    }

    /// Detects whether the flight was not stepped for a while. Its knowledge may then be outdated, and the socket may
    /// hold unread messages.
    pub(super) fn note_time(&mut self, now: Duration) {
        let gap = self.stepped.replace(now).map_or(Duration::ZERO, |last| now.saturating_sub(last));
        if gap <= SILENT_AFTER || self.contact.is_none() {
            return;
        }
        self.known.doubt(now, Doubted::Stall(gap));
        self.note_stall(now, gap);
        if gap >= SHORT {
            self.watch.awake = now;
            if self.phase.is_ours() && self.phase.is_airborne() {
                self.stalled(now, gap);
            } else {
                self.note(now, Level::Warning, "host", stall(gap));
            }
        }
    }

    /// Holds setpoints back while a pilot may have taken over without notice. After a short pause the stream continues:
    /// a vehicle that its pilot flies ignores it.
    pub(super) fn hold_back(&mut self, now: Duration) {
        let left = self.phase.is_ours() && self.left_our_mode().is_some();
        let held_back = left || self.known.is_in_doubt_for_long();
        if held_back && !left && !self.guide.held_back && self.guide.lead != Lead::Silent {
            self.note(
                now,
                Level::Warning,
                "stream",
                "setpoints are held back until the vehicle reports its mode",
            );
        }
        self.guide.held_back = held_back;
    }

    /// Counts a stall, and remembers it for the display; a longer one stays while it is shown.
    fn note_stall(&mut self, now: Duration, gap: Duration) {
        let began = now.saturating_sub(gap);
        self.flown.stalls += u32::from(self.stalls_until.is_none_or(|ended| began >= ended));
        self.flown.stalled_max_s = self.flown.stalled_max_s.max(gap.as_secs_f64());
        self.stalls_until = Some(now);
        let is_shown = |(ended, longer): &(Duration, Duration)| {
            now.saturating_sub(*ended) < STALL_SHOWN && *longer > gap
        };
        if !self.stall.as_ref().is_some_and(is_shown) {
            self.stall = Some((now, gap));
        }
    }

    pub(super) fn stalled(&mut self, now: Duration, gap: Duration) {
        if gap >= SHORT {
            self.watch.awake = now;
        }
        tracing::warn!(gap_s = gap.as_secs_f64(), "setpoints stalled");
        self.note_stall(now, gap);
        self.known.doubt(now, Doubted::Stall(gap));
        self.end(now, Cause::Stalled(stall(gap)));
    }

    /// Whether the vehicle may be commanded now, as far as its mode is known.
    fn permission(&self) -> Permission {
        let ours = !self.unread && !self.known.is_in_doubt() && self.is_to_command();
        Permission { reports: self.known.reports(), ours }
    }

    /// Whether the vehicle is in a mode that we ordered or, before the start, in the mode in which it was found.
    pub(super) fn is_to_command(&self) -> bool {
        let Some(state) = self.contact.as_ref().and_then(|contact| contact.telemetry.state) else {
            return false;
        };
        match &self.phase {
            Phase::Engage => self.found == Some(state.value.custom_mode) && !state.value.armed,
            Phase::Leave(leaving) => {
                let wished = leaving.is_ordered() && self.is_in(leaving.wish());
                !leaving.has_strayed() && (wished || leaving.comes_from(state.value.custom_mode))
            }
            // of a vehicle that is left to others only the motors are stopped, by the operator's typed word
            Phase::Watch => self.killed_in == Some(state.value.custom_mode),
            phase => phase.is_ours() && self.is_in(Mode::External),
        }
    }

    /// Gives a command, which is sent when the vehicle's mode permits it.
    pub(super) fn give(&mut self, now: Duration, order: Order, manner: Manner) {
        match order {
            Order::SetMode(_, mode) => tracing::info!(?mode, "mode ordered"),
            order => tracing::info!(?order, "command ordered"),
        }
        self.commander.give(now, order, manner, self.known.reports());
    }
}

/// In words.
fn stall(gap: Duration) -> String {
    format!(
        "this program or its computer stalled for {} ms (load, sleep, a stopped process); the vehicle is asked for \
         its mode",
        gap.as_millis()
    )
}
