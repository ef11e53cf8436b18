//! Plays a recorded flight back at the pace of its stamps.

use crate::wire::heartbeat::{AUTOPILOT_AT, NO_AUTOPILOT, TYPE_AT};
use crate::wire::message_id::HEARTBEAT;
use std::collections::BTreeSet;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::time::Duration;

use tokio::time::{Instant, sleep_until};

use super::counts::{HeldBack, ReplayCounts};
use super::error::ReplayError;
use super::telemetry::is_telemetry;
use crate::link::{HostStamp, LinkError, LinkEvent, LinkFeed, LinkReader, LinkWriter, Received};
use crate::log::{LogError, Loss, TlogReader, expect_file};
use crate::text;
use crate::wire::{ComponentId, CrcSeeds, Frame, Payload, SystemId};

/// HEARTBEAT.type of a ground station and of a companion computer.
const STATIONS: [u8; 2] = [6, 18];
/// A longer pause, or a step back, is the seam of two logs: played without waiting.
const SEAM: Duration = Duration::from_secs(3600);

/// A recorded flight, ready to be played back.
///
/// Only telemetry that autopilots sent is played, by a list of messages: a replay that reaches a real vehicle does
/// nothing there. All else is held back and counted. Stamps that step back, or over more than an hour, are played without waiting.
#[derive(Debug, Clone)]
pub struct Replay {
    path: PathBuf,
    autopilots: BTreeSet<(SystemId, ComponentId)>,
    seeds: CrcSeeds,
    frames: u64,
    duration: Duration,
    speed: f64,
    losses: Vec<Loss>,
}

impl Replay {
    /// Looks through a telemetry log. `speed` 1 plays as fast as it was, 0 as fast as possible.
    ///
    /// # Errors
    /// The log cannot be read, or `speed` is negative or no number.
    pub fn open(path: &Path, speed: f64) -> Result<Self, ReplayError> {
        if !speed.is_finite() || speed < 0.0 {
            return Err(ReplayError::Speed { got: speed });
        }
        let mut replay = Self {
            path: path.into(),
            autopilots: BTreeSet::new(),
            seeds: CrcSeeds::new(),
            frames: 0,
            duration: Duration::ZERO,
            speed,
            losses: Vec::new(),
        };
        expect_file(path).map_err(|source| replay.error(source))?;
        let mut reader = replay.reader()?;
        let mut pauses = Pauses::default();
        while let Some(record) = reader.next_record().map_err(|source| replay.error(source))? {
            let (header, payload) = (record.frame.header(), record.frame.payload());
            if header.message_id == HEARTBEAT && is_of_autopilot(payload) {
                replay.autopilots.insert((header.system, header.component));
            }
            replay.frames += 1;
            replay.duration += pauses.next(record.stamp_us);
        }
        replay.losses = reader.report().losses();
        Ok(replay)
    }

    /// Frames in the log.
    #[must_use]
    pub fn frames(&self) -> u64 {
        self.frames
    }

    /// What of the log itself is gone.
    #[must_use]
    pub fn losses(&self) -> &[Loss] {
        &self.losses
    }

    /// From the first frame to the last, at the log's own pace.
    #[must_use]
    pub fn duration(&self) -> Duration {
        self.duration
    }

    /// Plays on the current tokio runtime into a reader, as if it were a link. There is no writer. A frame's
    /// stamp has the present moment and the log's time. At the end the reader says that the link has ended.
    #[must_use]
    pub fn start(self) -> LinkReader {
        let (feed, reader) = LinkFeed::new(text::path(&self.path));
        tokio::spawn(async move {
            feed.event(LinkEvent::Connected { peer: feed.name().to_owned() });
            let Ok(mut player) = self.player() else { return };
            while let Some((due, stamp_us, bytes)) = player.next() {
                sleep_until(due).await;
                feed.ready().await;
                let stamp = HostStamp { at: Instant::now(), utc_us: stamp_us };
                let Some(frame) = Frame::at_start(&bytes) else { continue };
                if !feed.frame(stamp, frame) {
                    return;
                }
            }
        });
        reader
    }

    /// Plays into an open link until the log's end. What the other end sends is counted and dropped.
    /// `progress` is told of each frame's number and of what was played so far.
    ///
    /// # Errors
    /// The log cannot be read any more, or the link has ended.
    pub async fn play(
        &self,
        reader: &mut LinkReader,
        writer: &LinkWriter,
        mut progress: impl FnMut(u64, &ReplayCounts),
    ) -> Result<ReplayCounts, ReplayError> {
        let mut counts = ReplayCounts::default();
        while !writer.is_connected() {
            discard(reader.receive().await?, &mut counts);
        }
        let mut player = self.player()?;
        while let Some((due, _, bytes)) = player.next() {
            let pause = sleep_until(due);
            tokio::pin!(pause);
            loop {
                tokio::select! {
                    biased;
                    () = &mut pause => break,
                    received = reader.receive() => discard(received?, &mut counts),
                }
            }
            while let Some(received) = reader.try_receive()? {
                discard(received, &mut counts);
            }
            match send(writer, &bytes).await {
                Ok(()) => counts.frames += 1,
                Err(LinkError::NotConnected { .. }) => counts.unsent += 1,
                Err(error) => return Err(error.into()),
            }
            counts.held_back = player.held_back;
            progress(player.number, &counts);
        }
        writer.flush().await?;
        counts.held_back = player.held_back;
        Ok(counts)
    }

    fn reader(&self) -> Result<TlogReader<File>, ReplayError> {
        let opened = File::open(&self.path);
        let opened = opened.map_err(|source| LogError::Open { path: self.path.clone(), source });
        opened.map(TlogReader::new).map_err(|source| self.error(source))
    }

    fn error(&self, source: LogError) -> ReplayError {
        ReplayError::Log { path: self.path.clone(), source }
    }

    fn player(&self) -> Result<Player<'_>, ReplayError> {
        Ok(Player {
            replay: self,
            reader: self.reader()?,
            pauses: Pauses::default(),
            due: Instant::now(),
            number: 0,
            held_back: HeldBack::default(),
        })
    }

    /// Whether a frame is played; counts it where it is not.
    fn plays(&self, frame: &Frame<'_>, held_back: &mut HeldBack) -> bool {
        let header = frame.header();
        let reason = if !self.autopilots.contains(&(header.system, header.component)) {
            &mut held_back.not_of_an_autopilot
        } else if self.seeds.get(header.message_id).is_none() {
            &mut held_back.unknown
        } else if !is_telemetry(header.message_id) {
            &mut held_back.not_telemetry
        } else {
            return true;
        };
        *reason += 1;
        false
    }
}

/// Of what flies, by its HEARTBEAT: one of a ground station would keep a vehicle from missing its own.
fn is_of_autopilot(heartbeat: Payload<'_>) -> bool {
    heartbeat.u8(AUTOPILOT_AT) != NO_AUTOPILOT && !STATIONS.contains(&heartbeat.u8(TYPE_AT))
}

/// Waits where too much waits already.
async fn send(writer: &LinkWriter, bytes: &[u8]) -> Result<(), LinkError> {
    match writer.send(bytes) {
        Err(LinkError::QueueFull { .. }) => {
            writer.flush().await?;
            writer.send(bytes)
        }
        sent => sent,
    }
}

fn discard(received: Received, counts: &mut ReplayCounts) {
    counts.discarded += u64::from(matches!(received, Received::Frame(_)));
}

/// Goes through the log and says when each frame is due.
struct Player<'a> {
    replay: &'a Replay,
    reader: TlogReader<File>,
    pauses: Pauses,
    due: Instant,
    number: u64,
    held_back: HeldBack,
}

impl Player<'_> {
    /// When the next frame is due, its stamp, its bytes. A log that fails midway ends there: it was read
    /// whole before.
    fn next(&mut self) -> Option<(Instant, u64, Vec<u8>)> {
        loop {
            let record = self.reader.next_record().ok()??;
            self.number += 1;
            let pause = self.pauses.next(record.stamp_us);
            if self.replay.speed > 0.0 {
                self.due += pause.div_f64(self.replay.speed);
            }
            if self.replay.plays(&record.frame, &mut self.held_back) {
                return Some((self.due, record.stamp_us, record.frame.bytes().to_vec()));
            }
        }
    }
}

/// From stamps to the pauses between them.
#[derive(Debug, Default)]
struct Pauses {
    last_us: Option<u64>,
}

impl Pauses {
    fn next(&mut self, stamp_us: u64) -> Duration {
        let step = self
            .last_us
            .and_then(|last| stamp_us.checked_sub(last))
            .map_or(Duration::ZERO, Duration::from_micros);
        self.last_us = Some(stamp_us);
        if step > SEAM { Duration::ZERO } else { step }
    }
}
