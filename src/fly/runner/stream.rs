//! The threads that send setpoints at their times.

use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, mpsc};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use serde::Serialize;
use tokio::sync::mpsc::UnboundedSender;

use super::clock::Clock;
use super::priority::{cores_to_wait_on, raise_priority, stay_on};
use crate::fly::safety::{Guide, Lead, Streamed, Streamer};
use crate::link::{LinkStats, LinkWriter};

/// A setpoint further from its time is late.
const LATE: Duration = Duration::from_millis(3);

/// The setpoints to be streamed, shared with the flight.
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

    /// Renews it, as of when all was known that the link had brought.
    pub(super) fn set(&self, guide: &Guide, seen: Duration) {
        let issued = guide.issued.min(seen);
        let mut shared = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let same = Guide { issued: shared.issued, held_back: shared.held_back, ..guide.clone() } == *shared;
        if same {
            (shared.issued, shared.held_back) = (issued, guide.held_back);
        } else {
            shared.clone_from(guide);
            shared.issued = issued;
        }
    }
}

/// Figures of the sent setpoints.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct StreamFigures {
    /// sent setpoints
    pub sent: u64,
    /// setpoints computed more than 3 ms after their time
    pub late: u64,
    /// not sent, because the next one existed already or the stream had ended
    pub overtaken: u64,
    /// refused by the link, or in no message's range
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
    threads: Vec<JoinHandle<()>>,
    sender: Arc<Sender>,
    /// it has a real-time thread
    pub(super) is_real_time: bool,
}

impl Stream {
    /// Starts it; a stall is reported to `stalled`. One real-time thread is sufficient. Without permission for one,
    /// several ordinary threads, bound to different cores, wait for each setpoint's time, and the first that the system
    /// wakes sends it.
    pub(super) fn start(
        period: Duration,
        clock: Clock,
        guide: SharedGuide,
        writer: LinkWriter,
        stalled: UnboundedSender<Duration>,
    ) -> io::Result<Self> {
        let turn = Mutex::new(Turn {
            streamer: Streamer::new(period),
            figures: StreamFigures::default(),
            streams: false,
        });
        let sender = Arc::new(Sender { turn, over: AtomicBool::new(false), clock, guide, writer, stalled });
        let (raised, is_raised) = mpsc::channel();
        let work = {
            let sender = sender.clone();
            move || {
                // whoever starts it waits for this word
                let _ = raised.send(raise_priority());
                sender.work();
            }
        };
        let mut stream = Self { threads: Vec::new(), sender, is_real_time: false };
        stream.threads.push(thread::Builder::new().name("setpoints".into()).spawn(work)?);
        stream.is_real_time = is_raised.recv().unwrap_or(false);
        if !stream.is_real_time {
            for core in cores_to_wait_on() {
                let sender = stream.sender.clone();
                let work = move || {
                    // one that may run anywhere waits as well
                    let _ = stay_on(core);
                    sender.work();
                };
                match thread::Builder::new().name("setpoints".into()).spawn(work) {
                    Ok(thread) => stream.threads.push(thread),
                    // one waits already
                    Err(_) => break,
                }
            }
        }
        Ok(stream)
    }

    /// Ends it.
    pub(super) fn finish(self) -> StreamFigures {
        self.sender.over.store(true, Ordering::Release);
        for thread in self.threads {
            // one that panicked has counted what it sent
            let _ = thread.join();
        }
        self.sender.turn().figures
    }
}

/// Data of all threads of a stream.
#[derive(Debug)]
struct Sender {
    turn: Mutex<Turn>,
    over: AtomicBool,
    clock: Clock,
    guide: SharedGuide,
    writer: LinkWriter,
    stalled: UnboundedSender<Duration>,
}

/// State of the thread that computes the next setpoint.
#[derive(Debug)]
struct Turn {
    streamer: Streamer,
    figures: StreamFigures,
    streams: bool,
}

impl Sender {
    fn turn(&self) -> MutexGuard<'_, Turn> {
        self.turn.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits for each setpoint's time and sends it, unless another thread did.
    fn work(&self) {
        let mut due = self.turn().streamer.due();
        while !self.over.load(Ordering::Acquire) {
            thread::sleep(due.saturating_sub(self.clock.elapsed()));
            let mut turn = self.turn();
            if turn.streamer.due() == due {
                turn.send(self, due);
            }
            due = turn.streamer.due();
        }
    }
}

impl Turn {
    fn send(&mut self, sender: &Sender, due: Duration) {
        let guide = sender.guide.get();
        let now = sender.clock.elapsed();
        // a sleep since then is seen by the guide's own time
        let ran = now.saturating_sub(sender.writer.ran().elapsed());
        let came = send_due(&mut self.streamer, (now, ran), guide, &sender.writer);
        // the first of a stream starts the grid
        let made = matches!(came, Due::Sent | Due::Refused);
        self.figures.late += u64::from(made && self.streams && now.saturating_sub(due) > LATE);
        match came {
            Due::Sent => self.figures.sent += 1,
            Due::Refused => self.figures.refused += 1,
            Due::Stalled(gap) => {
                // a flight that has ended hears nothing
                let _ = sender.stalled.send(gap);
                return;
            }
            Due::Nothing => {}
        }
        self.streams = made;
    }
}

/// Result at a setpoint's time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Due {
    /// it was given to the link
    Sent,
    /// the link did not accept it
    Refused,
    /// a part stalled for this time: nothing is sent
    Stalled(Duration),
    /// there was nothing to send
    Nothing,
}

/// Computes the setpoint of `now` and passes it to the link, whose task `ran` last at that time. All times are those of
/// the flight's clock.
pub fn send_due(
    streamer: &mut Streamer,
    (now, ran): (Duration, Duration),
    mut guide: Guide,
    writer: &LinkWriter,
) -> Due {
    // a link whose task stands still brings no word of the vehicle: nobody knows what it does
    guide.issued = guide.issued.min(ran);
    match streamer.poll(now, &guide) {
        Some(Streamed::Setpoint(_, message)) => match writer.send_latest(&message) {
            Ok(()) => Due::Sent,
            Err(_) => Due::Refused,
        },
        Some(Streamed::Unfit(_)) => {
            // the flight finds the same, tells it and ends
            writer.clear_latest();
            Due::Refused
        }
        Some(Streamed::Stalled(gap)) => {
            writer.clear_latest();
            Due::Stalled(gap)
        }
        None => {
            if guide.lead == Lead::Silent || guide.held_back {
                writer.clear_latest();
            }
            Due::Nothing
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::autopilot::PX4;
    use crate::fly::setpoint::Place;
    use crate::fly::target::Target;
    use crate::link::{Link, LinkOptions};
    use crate::wire::{ComponentId, SystemId};
    use nalgebra::Vector3;
    use std::sync::mpsc::{Receiver, Sender, channel};
    use std::thread::ThreadId;
    use tracing::dispatcher::with_default;
    use tracing::{Dispatch, Event, Subscriber, span};
    use tracing_subscriber::Layer;
    use tracing_subscriber::layer::{Context, SubscriberExt};

    /// A subscriber that stands still: whoever says something waits until the gate opens. The sender of setpoints does
    /// not, so that the test sees that it said something.
    struct Stands {
        sender: ThreadId,
        waits: Sender<ThreadId>,
        gate: Mutex<Receiver<()>>,
    }

    impl Stands {
        fn stand(&self) {
            let who = thread::current().id();
            self.waits.send(who).unwrap();
            if who != self.sender {
                let _ = self.gate.lock().unwrap().recv();
            }
        }
    }

    impl<S: Subscriber> Layer<S> for Stands {
        fn on_event(&self, _: &Event<'_>, _: Context<'_, S>) {
            self.stand();
        }

        fn on_new_span(&self, _: &span::Attributes<'_>, _: &span::Id, _: Context<'_, S>) {
            self.stand();
        }

        fn on_enter(&self, _: &span::Id, _: Context<'_, S>) {
            self.stand();
        }
    }

    #[tokio::test(start_paused = true)]
    async fn setpoints_go_out_in_time_while_the_subscriber_stands_still() {
        let (_vehicle, (_reader, writer)) = Link::pair(LinkOptions::default(), LinkOptions::default());
        let (waits, waited) = channel();
        let (open, gate) = channel();
        let sender = thread::current().id();
        let stands = Stands { sender, waits, gate: Mutex::new(gate) };
        let subscriber = Dispatch::new(tracing_subscriber::registry().with(stands));
        let other = {
            let subscriber = subscriber.clone();
            thread::spawn(move || {
                with_default(&subscriber, || tracing::trace!("something happened"));
            })
        };
        assert_eq!(waited.recv().unwrap(), other.thread().id());
        let period = Duration::from_millis(20);
        let mut streamer = Streamer::new(period);
        let place = Place { position_m: Vector3::new(1.0, 0.0, 2.0), yaw_rad: 0.0 };
        let target = Target::new(SystemId(1), ComponentId(1)).map(|target| (target, &PX4));
        with_default(&subscriber, || {
            for now in (0..1000).map(|number| period * number) {
                let guide = Guide { lead: Lead::Hold(place), target, ..Guide::silent(now) };
                assert_eq!(send_due(&mut streamer, (now, now), guide, &writer), Due::Sent, "at {now:?}");
            }
        });
        drop(open);
        other.join().unwrap();
        assert_eq!(waited.try_iter().count(), 0, "what sends setpoints says nothing");
    }
}
