//! The live identification in a separate thread of ordinary priority, so that its load or a fault in it never delays
//! the flight.

use std::io;
use std::sync::mpsc::{Receiver, Sender, SyncSender, channel, sync_channel};
use std::thread;
use std::time::{Duration, Instant};

use crate::fly::live::{LiveEstimate, LiveIdentification};
use crate::link::ReceivedFrame;
use crate::wire::{Check, CrcSeeds, Decoder, Frame, Record};

/// Between two estimates.
const ESTIMATE: Duration = Duration::from_secs(1);
/// Frames that may wait: some seconds of telemetry. One that finds no room is left out, and leaves a gap.
const WAITING: usize = 4096;

/// Messages to the thread.
#[derive(Debug)]
enum EstimatorInput {
    /// start of the identification
    Begin(Box<(Decoder, LiveIdentification)>),
    /// a frame of the vehicle
    Frame(ReceivedFrame),
    /// whether the trajectory is being flown
    Active(bool),
}

/// Messages of the thread.
#[derive(Debug)]
pub(super) enum LiveNews {
    /// the latest estimate
    Estimate(Box<LiveEstimate>),
    /// what the first one waits for
    Waits(String),
}

/// The live identification of one flight.
#[derive(Debug)]
pub(super) struct Estimating {
    to: SyncSender<EstimatorInput>,
    from: Receiver<LiveNews>,
    began: bool,
}

impl Estimating {
    /// Starts its thread with the priority of the calling one, which must be an ordinary one.
    pub(super) fn start() -> io::Result<Self> {
        let (to, inputs) = sync_channel(WAITING);
        let (say, from) = channel();
        // it ends with the flight, which does not wait for it
        thread::Builder::new().name("live".into()).spawn(move || estimate(&inputs, &say))?;
        Ok(Self { to, from, began: false })
    }

    /// Frames from now on are decoded by `decoder`, and identified.
    pub(super) fn begin(&mut self, decoder: Decoder, live: LiveIdentification) {
        self.began = self.to.try_send(EstimatorInput::Begin(Box::new((decoder, live)))).is_ok();
    }

    pub(super) fn frame(&self, frame: ReceivedFrame) {
        if self.began {
            // a thread that cannot keep up, or is no more, says less
            let _ = self.to.try_send(EstimatorInput::Frame(frame));
        }
    }

    /// Sets whether the trajectory is flown: other motion is not identified.
    pub(super) fn set_active(&self, active: bool) {
        if self.began {
            let _ = self.to.try_send(EstimatorInput::Active(active));
        }
    }

    /// The latest news, once.
    pub(super) fn latest(&self) -> Option<LiveNews> {
        self.from.try_iter().last()
    }
}

fn estimate(inputs: &Receiver<EstimatorInput>, say: &Sender<LiveNews>) {
    let seeds = CrcSeeds::new();
    let mut at_work: Option<Box<(Decoder, LiveIdentification)>> = None;
    let mut said = Instant::now();
    for inputs in inputs {
        match (inputs, at_work.as_deref_mut()) {
            (EstimatorInput::Begin(work), _) => at_work = Some(work),
            (EstimatorInput::Active(active), Some((_, live))) => live.set_active(active),
            (EstimatorInput::Frame(received), Some((decoder, live))) => {
                let Some(frame) = Frame::at_start(received.bytes()) else { continue };
                let known = frame.check(&seeds) == Check::Right;
                let record = Record { stamp_us: received.stamp.utc_us, offset: 0, known, frame };
                decoder.decode(&record, &mut |event| live.take(&event));
                if said.elapsed() < ESTIMATE {
                    continue;
                }
                said = Instant::now();
                let news = match live.estimate() {
                    Some(estimate) => LiveNews::Estimate(Box::new(estimate)),
                    None => LiveNews::Waits(live.waits_for()),
                };
                if say.send(news).is_err() {
                    return;
                }
            }
            (EstimatorInput::Active(_) | EstimatorInput::Frame(_), None) => {}
        }
    }
}
