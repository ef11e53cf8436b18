//! The thread that sends setpoints at their times.

use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError, mpsc};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use serde::Serialize;
use tokio::sync::mpsc::UnboundedSender;

use super::priority::raise_priority;
use crate::fly::safety::{Guide, Lead, Streamed, Streamer};
use crate::link::{LinkStats, LinkWriter};

/// A setpoint further from its time is late.
const LATE: Duration = Duration::from_millis(3);

/// What is to be streamed, shared with the flight.
#[derive(Debug, Clone)]
pub(super) struct SharedGuide(Arc<Mutex<Guide>>);

impl SharedGuide {
    pub(super) fn new() -> Self {
        Self(Arc::new(Mutex::new(Guide::silent(Duration::ZERO))))
    }

    /// A guide is whole at every moment, so one whose holder panicked is as good as any.
    pub(super) fn get(&self) -> Guide {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    pub(super) fn set(&self, guide: &Guide) {
        let mut shared = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if shared.lead == guide.lead && shared.target == guide.target {
            shared.issued = guide.issued;
        } else {
            shared.clone_from(guide);
        }
    }
}

/// How the setpoints went out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct StreamFigures {
    /// setpoints that went out
    pub sent: u64,
    /// setpoints made more than 3 ms after their time
    pub late: u64,
    /// not sent, for the next was there already or the stream had ended
    pub overtaken: u64,
    /// refused by the link
    pub refused: u64,
}

impl StreamFigures {
    /// Of setpoints given to a link, what became of them there.
    pub(super) fn on_link(self, link: &LinkStats) -> Self {
        Self { sent: self.sent.saturating_sub(link.replaced), overtaken: link.replaced, ..self }
    }
}

/// The stream while it runs.
#[derive(Debug)]
pub(super) struct Stream {
    thread: JoinHandle<StreamFigures>,
    over: Arc<AtomicBool>,
    /// it has a real-time thread
    pub(super) is_real_time: bool,
}

impl Stream {
    /// Starts it; a stall is told to `stalled`.
    pub(super) fn start(
        period: Duration,
        clock: Instant,
        guide: SharedGuide,
        writer: LinkWriter,
        stalled: UnboundedSender<Duration>,
    ) -> io::Result<Self> {
        let over = Arc::new(AtomicBool::new(false));
        let ended = over.clone();
        let (raised, is_raised) = mpsc::channel();
        let work = move || {
            // whoever starts it waits for this word
            let _ = raised.send(raise_priority());
            send_setpoints(Streamer::new(period), clock, &guide, &writer, (&stalled, &ended))
        };
        let thread = thread::Builder::new().name("setpoints".into()).spawn(work)?;
        Ok(Self { thread, over, is_real_time: is_raised.recv().unwrap_or(false) })
    }

    /// Ends it.
    pub(super) fn finish(self) -> StreamFigures {
        self.over.store(true, Ordering::Release);
        self.thread.join().unwrap_or_default()
    }
}

fn send_setpoints(
    mut streamer: Streamer,
    clock: Instant,
    guide: &SharedGuide,
    writer: &LinkWriter,
    (stalled, over): (&UnboundedSender<Duration>, &AtomicBool),
) -> StreamFigures {
    let mut figures = StreamFigures::default();
    let mut streams = false;
    while !over.load(Ordering::Acquire) {
        let due = streamer.due();
        thread::sleep(due.saturating_sub(clock.elapsed()));
        let guide = guide.get();
        let now = clock.elapsed();
        match streamer.poll(now, &guide) {
            Some(Streamed::Setpoint(_, message)) => {
                // the first of a stream starts the grid
                figures.late += u64::from(streams && now.saturating_sub(due) > LATE);
                streams = true;
                match writer.send_latest(&message) {
                    Ok(()) => figures.sent += 1,
                    Err(_) => figures.refused += 1,
                }
            }
            Some(Streamed::Stalled { gap, setpoint, command }) => {
                writer.clear_latest();
                for message in setpoint.iter().chain([&command]) {
                    figures.refused += u64::from(writer.send_message(message).is_err());
                }
                // a flight that has ended hears nothing
                let _ = stalled.send(gap);
            }
            None => {
                streams = false;
                if guide.lead == Lead::Silent {
                    writer.clear_latest();
                }
            }
        }
    }
    figures
}
