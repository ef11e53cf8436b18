//! Commands that wait for their answer: they are repeated until an answer arrives or their time is over.

use crate::wire::command::{ACCEPTED, FAILED, IN_PROGRESS, TEMPORARILY_REJECTED};
use std::time::Duration;

use mavlink::dialects::ardupilotmega::MavMessage;

use super::target::{Order, Target};
use crate::wire::Payload;

/// Repetition of a command and meaning of its answers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Manner {
    /// time until a repetition without an answer
    pub repeat: Duration,
    /// time after which it counts as unanswered or refused
    pub patience: Duration,
    /// `FAILED` is repeated as well as `TEMPORARILY_REJECTED`: ArduPilot answers so to arming until its estimator is
    /// ready
    pub failed_is_temporary: bool,
}

/// Pause before a rejected command is sent again.
const AFTER_REJECTION: Duration = Duration::from_secs(1);

impl Manner {
    /// An ordinary command.
    pub const PATIENT: Self = Self {
        repeat: Duration::from_millis(500),
        patience: Duration::from_secs(5),
        failed_is_temporary: false,
    };
    /// A command that ends the flight: three times within a third of a second.
    pub const URGENT: Self = Self {
        repeat: Duration::from_millis(100),
        patience: Duration::from_millis(350),
        failed_is_temporary: false,
    };
}

/// The end of a command.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// the command
    pub order: Order,
    /// its result
    pub result: AnswerResult,
}

/// Result of a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AnswerResult {
    /// it is or will be executed
    Accepted,
    /// MAV_RESULT and the autopilot's additional number
    Refused {
        /// MAV_RESULT
        result: u8,
        /// `result_param2`
        detail: i32,
    },
    /// no COMMAND_ACK was received
    Unanswered,
}

impl AnswerResult {
    /// In words.
    #[must_use]
    pub fn text(self) -> String {
        let (result, detail) = match self {
            Self::Accepted => return "accepted".to_owned(),
            Self::Unanswered => return "no answer".to_owned(),
            Self::Refused { result, detail } => (result, detail),
        };
        let name = match result {
            1 => "temporarily rejected",
            2 => "denied",
            3 => "unsupported",
            4 => "failed",
            6 => "cancelled",
            7 => "only as COMMAND_LONG",
            8 => "only as COMMAND_INT",
            9 => "unsupported frame",
            _ => "refused",
        };
        if detail == 0 {
            format!("{name} (result {result})")
        } else {
            format!("{name} (result {result}, detail {detail})")
        }
    }
}

#[derive(Debug)]
struct Pending {
    order: Order,
    manner: Manner,
    since: Duration,
    due: Duration,
    sent: u8,
    /// number of reports of the mode when it was given or last sent
    reports: u64,
    rejection: Option<(u8, i32)>,
}

/// What may be sent in the vehicle's mode.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Permission {
    /// number of accepted reports of the mode
    pub reports: u64,
    /// by the last of them, the vehicle is in our mode
    pub ours: bool,
}

/// All commands that wait for their answer, one of each kind.
///
/// Requests are sent when they are due. Commands (a mode, arming, disarming, takeoff) are sent, and repeated, only
/// after a report of the mode that is newer than the order or its last transmission, and that shows that the vehicle is
/// in our mode.
#[derive(Debug, Default)]
pub struct Commander {
    pending: Vec<Pending>,
}

impl Commander {
    /// Gives a command, which [`Commander::poll`] sends when it is permitted. It replaces a waiting one of its kind.
    /// `reports`: number of accepted reports of the mode so far.
    pub fn give(&mut self, now: Duration, order: Order, manner: Manner, reports: u64) {
        self.pending.retain(|waiting| waiting.order.command() != order.command());
        self.pending.push(Pending { order, manner, since: now, due: now, sent: 0, reports, rejection: None });
    }

    /// Whether a command of this kind waits for its answer.
    #[must_use]
    pub fn waits_for(&self, order: &Order) -> bool {
        self.pending.iter().any(|waiting| waiting.order == *order)
    }

    /// Whether a command of the same kind, whatever its parameters, waits for its answer.
    #[must_use]
    pub fn waits_for_kind(&self, order: &Order) -> bool {
        self.pending.iter().any(|waiting| waiting.order.command() == order.command())
    }

    /// Whether a command is due and waits for a report of the mode.
    #[must_use]
    pub fn waits_for_report(&self, now: Duration, permission: Permission) -> bool {
        self.pending.iter().any(|waiting| {
            let new = permission.ours && permission.reports > waiting.reports;
            now >= waiting.due && !waiting.order.is_question() && !new
        })
    }

    /// Whether this command waits for its answer and was sent.
    #[must_use]
    pub fn has_sent(&self, order: &Order) -> bool {
        self.pending.iter().any(|waiting| waiting.order == *order && waiting.sent > 0)
    }

    /// Forgets a command, because it is done.
    pub fn forget(&mut self, order: &Order) {
        self.pending.retain(|waiting| waiting.order != *order);
    }

    /// Forgets all of them.
    pub fn clear(&mut self) {
        self.pending.clear();
    }

    /// Commands to be sent now, and those that are given up.
    pub fn poll(
        &mut self,
        now: Duration,
        target: Target,
        permission: Permission,
    ) -> (Vec<MavMessage>, Vec<Answer>) {
        let (mut messages, mut answers) = (Vec::new(), Vec::new());
        self.pending.retain_mut(|waiting| {
            if now.saturating_sub(waiting.since) >= waiting.manner.patience && waiting.sent > 0 {
                let result = waiting.rejection.map_or(AnswerResult::Unanswered, |(result, detail)| {
                    AnswerResult::Refused { result, detail }
                });
                answers.push(Answer { order: waiting.order, result });
                return false;
            }
            let permitted =
                waiting.order.is_question() || permission.ours && permission.reports > waiting.reports;
            if now >= waiting.due && permitted {
                waiting.reports = permission.reports;
                // its patience begins when it could be sent
                waiting.since = if waiting.sent == 0 { now } else { waiting.since };
                messages.push(target.command(&waiting.order, waiting.sent));
                waiting.sent = waiting.sent.saturating_add(1);
                waiting.due = now + waiting.manner.repeat;
            }
            true
        });
        (messages, answers)
    }

    /// Takes a COMMAND_ACK (its payload); returns the command that it ends.
    pub fn hear(&mut self, now: Duration, ack: Payload<'_>) -> Option<Answer> {
        let (command, result) = (ack.u16(0), ack.u8(2));
        let detail = ack.i32(4);
        let at = self
            .pending
            .iter()
            .position(|waiting| u32::from(command) == waiting.order.command() as u32 && waiting.sent > 0)?;
        let waiting = &mut self.pending[at];
        let temporary =
            result == TEMPORARILY_REJECTED || result == FAILED && waiting.manner.failed_is_temporary;
        if result == IN_PROGRESS {
            waiting.since = now;
            waiting.due = now + waiting.manner.patience;
            return None;
        }
        let late = now + AFTER_REJECTION >= waiting.since + waiting.manner.patience;
        if temporary && !late {
            waiting.rejection = Some((result, detail));
            waiting.due = now + AFTER_REJECTION;
            return None;
        }
        let order = self.pending.remove(at).order;
        let result = if result == ACCEPTED {
            AnswerResult::Accepted
        } else {
            AnswerResult::Refused { result, detail }
        };
        Some(Answer { order, result })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wire::{ComponentId, SystemId};

    fn target() -> Target {
        Target::new(SystemId(1), ComponentId(1)).unwrap()
    }

    fn ms(value: u64) -> Duration {
        Duration::from_millis(value)
    }

    /// So many reports of the mode have come, and it is ours.
    fn ours(reports: u64) -> Permission {
        Permission { reports, ours: true }
    }

    fn ack(command: u16, result: u8) -> [u8; 3] {
        let [low, high] = command.to_le_bytes();
        [low, high, result]
    }

    #[test]
    fn an_unanswered_command_is_sent_again_and_given_up() {
        let mut commander = Commander::default();
        commander.give(ms(0), Order::arm(true), Manner::URGENT, 0);
        let mut sent = Vec::new();
        for step in 0..60 {
            let (messages, answers) = commander.poll(ms(10 * step), target(), ours(step + 1));
            sent.extend(messages.iter().map(|_| 10 * step));
            if let [answer] = answers.as_slice() {
                assert_eq!(answer.result, AnswerResult::Unanswered);
                assert_eq!(sent, [0, 100, 200, 300]);
                return;
            }
        }
        panic!("never given up");
    }

    #[test]
    fn a_temporary_rejection_is_asked_again_until_patience_ends() {
        let mut commander = Commander::default();
        commander.give(ms(0), Order::arm(true), Manner::PATIENT, 0);
        assert_eq!(commander.poll(ms(0), target(), ours(1)).0.len(), 1);
        assert!(commander.hear(ms(20), Payload(&ack(400, 1))).is_none());
        assert!(commander.poll(ms(600), target(), ours(2)).0.is_empty(), "it waits a second");
        assert_eq!(commander.poll(ms(1020), target(), ours(3)).0.len(), 1);
        assert!(commander.hear(ms(1050), Payload(&ack(176, 0))).is_none(), "of another command");
        let answer = commander.hear(ms(1060), Payload(&ack(400, 0))).unwrap();
        assert_eq!(answer.result, AnswerResult::Accepted);
        assert!(commander.hear(ms(1070), Payload(&ack(400, 0))).is_none(), "answered already");
    }

    #[test]
    fn a_refusal_says_why() {
        let mut commander = Commander::default();
        commander.give(ms(0), Order::arm(true), Manner::PATIENT, 0);
        commander.poll(ms(0), target(), ours(1));
        let answer = commander.hear(ms(5), Payload(&[0x90, 1, 2, 0, 9, 0, 0, 0])).unwrap();
        assert_eq!(answer.result.text(), "denied (result 2, detail 9)");
    }

    #[test]
    fn a_command_waits_for_a_report_of_the_mode_and_a_question_does_not() {
        let mut commander = Commander::default();
        commander.give(ms(0), Order::arm(true), Manner::PATIENT, 7);
        commander.give(ms(0), Order::request_message(148), Manner::PATIENT, 7);
        assert_eq!(commander.poll(ms(0), target(), ours(7)).0.len(), 1, "the question");
        assert!(commander.poll(ms(10), target(), Permission { reports: 9, ours: false }).0.is_empty());
        assert_eq!(commander.poll(ms(20), target(), ours(8)).0.len(), 1);
        // not again on the same report, however long it takes
        let again = commander.poll(ms(900), target(), ours(8)).0;
        assert!(again.iter().all(|message| !format!("{message:?}").contains("ARM_DISARM")), "{again:?}");
        assert_eq!(commander.poll(ms(1000), target(), ours(9)).0.len(), 1);
    }

    #[test]
    fn patience_begins_when_it_could_be_sent() {
        let mut commander = Commander::default();
        commander.give(ms(0), Order::arm(false), Manner::URGENT, 0);
        assert_eq!(commander.poll(ms(900), target(), ours(0)), (Vec::new(), Vec::new()));
        assert_eq!(commander.poll(ms(1000), target(), ours(1)).0.len(), 1);
        assert!(commander.poll(ms(1300), target(), ours(1)).1.is_empty());
        assert_eq!(commander.poll(ms(1350), target(), ours(1)).1.len(), 1, "unanswered");
    }
}
