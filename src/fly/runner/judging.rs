//! The checks before the flight in a separate thread of ordinary priority: while they are computed, the flight goes on to read
//! what the vehicle says.

use std::io;
use std::sync::mpsc::{Receiver, SyncSender, TryRecvError, sync_channel};
use std::thread;

use super::question::{Answer, Question};

/// The thread of the checks.
#[derive(Debug)]
pub(super) struct Judging {
    to: SyncSender<Box<Question>>,
    from: Receiver<Box<Answer>>,
    /// an answer is awaited
    waits: bool,
}

impl Judging {
    /// Starts its thread with the priority of the calling one, which must be an ordinary one.
    pub(super) fn start() -> io::Result<Self> {
        let (to, questions) = sync_channel::<Box<Question>>(1);
        let (answers, from) = sync_channel(1);
        // it ends with the flight, which does not wait for it
        thread::Builder::new().name("checks".into()).spawn(move || {
            for question in questions {
                if answers.send(Box::new(question.answer())).is_err() {
                    return;
                }
            }
        })?;
        Ok(Self { to, from, waits: false })
    }

    /// Has the checks made.
    pub(super) fn ask(&mut self, question: Box<Question>) {
        // that it is no more, the missing answer tells
        let _ = self.to.try_send(question);
        self.waits = true;
    }

    /// What the checks came to, once; an error where they broke off.
    pub(super) fn answer(&mut self) -> Option<Result<Box<Answer>, &'static str>> {
        if !self.waits {
            return None;
        }
        let answer = match self.from.try_recv() {
            Ok(answer) => Ok(answer),
            Err(TryRecvError::Empty) => return None,
            Err(TryRecvError::Disconnected) => Err("the checks before the flight broke off without a result"),
        };
        self.waits = false;
        Some(answer)
    }
}
