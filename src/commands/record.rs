//! `mavid record --connect ADDRESS --out FILE.tlog`: captures a link until told to stop.
//!
//! It only listens, unless `--heartbeat` asks it to speak as a ground station and to request messages.
//! Exit status 3 where the file misses frames or nothing came.

use mavid::wire::heartbeat::{AUTOPILOT_AT, NO_AUTOPILOT};
use mavid::wire::message_id::HEARTBEAT;
use std::time::Duration;

use mavid::fly::{self, MessageId, Order, Period, Target};
use mavid::link::{
    LinkEvent, LinkOptions, LinkReader, LinkStats, LinkWriter, Received, ReceivedFrame, RecordError,
    Recorder, RecorderStatus, Signing,
};
use mavid::text;
use mavid::wire::{ComponentId, SystemId};
use mavlink::dialects::ardupilotmega as dialect;
use serde::Serialize;
use tokio::time::{Instant, MissedTickBehavior, interval, sleep_until};

use super::standard_error::StandardError;
use super::{CommandError, Outcome, live, network, output};
use crate::cli::RecordArgs;

/// Longest recording, where the user gives no duration.
const YEAR: Duration = Duration::from_secs(365 * 86_400);
/// How long the end of the link may take: it goes on for 1 s with what is still to be sent. One that stands still is not waited for.
const CLOSING: Duration = Duration::from_secs(2);
/// Messages that identification uses and the rates asked for, Hz. A vehicle gives what it can.
const MESSAGES: &[(MessageId, u16)] = &[
    (MessageId::of::<dialect::ATTITUDE_QUATERNION_DATA>(), 100),
    (MessageId::of::<dialect::LOCAL_POSITION_NED_DATA>(), 50),
    (MessageId::of::<dialect::SERVO_OUTPUT_RAW_DATA>(), 100),
    (MessageId::of::<dialect::ATTITUDE_TARGET_DATA>(), 50),
    (MessageId::of::<dialect::POSITION_TARGET_LOCAL_NED_DATA>(), 20),
    (MessageId::of::<dialect::HIGHRES_IMU_DATA>(), 100),
    (MessageId::of::<dialect::RAW_IMU_DATA>(), 100),
    (MessageId::of::<dialect::BATTERY_STATUS_DATA>(), 2),
    (MessageId::of::<dialect::EXTENDED_SYS_STATE_DATA>(), 5),
    (MessageId::of::<dialect::ESC_STATUS_DATA>(), 10),
    (MessageId::of::<dialect::ODOMETRY_DATA>(), 50),
    (MessageId::of::<dialect::ACTUATOR_OUTPUT_STATUS_DATA>(), 100),
];

/// The JSON document.
#[derive(Debug, Serialize)]
struct Document {
    schema: u32,
    log: String,
    duration_s: f64,
    /// frames and bytes in the file, sent ones included
    frames: u64,
    bytes: u64,
    received_frames: u64,
    sent_frames: u64,
    /// frames that the file misses
    dropped: u64,
    /// frames in the file that the system could not confirm to be on the disk
    doubtful: u64,
    /// frames with a signing key left out
    redacted: u64,
    unknown_messages: u64,
    bad_checksums: u64,
    noise_bytes: u64,
    resyncs: u64,
    lost_frames: u64,
    badly_signed: u64,
    replayed: u64,
    unsigned: u64,
    link_losses: u64,
    stranger_datagrams: u64,
    senders: Vec<SenderLine>,
}

#[derive(Debug, Serialize)]
struct SenderLine {
    system: u32,
    component: u8,
    frames: u64,
    lost: u64,
    duplicates: u64,
}

/// Runs the verb.
pub fn run(json: bool, stderr: &StandardError, args: &RecordArgs) -> Result<Outcome, CommandError> {
    let (args, stderr) = (args.clone(), stderr.clone());
    live::run(move |work| {
        // a signal ends the recording itself
        work.ends_itself();
        let signing = args.signing_key_file.as_deref().map(Signing::open).transpose();
        let signing = signing.map_err(|error| CommandError::Input(error.to_string()))?;
        output::signing_warnings(signing.as_ref());
        network::block_on(record((json, stderr), &args, signing))
    })
}

async fn record(
    (json, stderr): (bool, StandardError),
    args: &RecordArgs,
    signing: Option<Signing>,
) -> Result<Outcome, CommandError> {
    let address = network::address("--connect", &args.connect)?;
    output::folder_of(&args.out)?;
    let recorder = Recorder::create(&args.out, args.force).map_err(|error| refused(&error))?;
    let options = LinkOptions { recorder: Some(recorder.clone()), signing, ..LinkOptions::default() };
    let opened = network::open(&address, options).await;
    if opened.is_err() {
        // nothing was recorded; a file that cannot be removed is an empty one
        let _ = std::fs::remove_file(&args.out);
    }
    let (reader, writer) = opened?;
    let start = Instant::now();
    let mut capture = Capture { reader, writer, stderr, asked: Vec::new(), recorder };
    let ended = capture.until(start, args).await;
    let lasted_s = start.elapsed().as_secs_f64();
    let Capture { reader, writer, stderr, recorder, .. } = capture;
    let stats = closed(reader, writer).await;
    // whether or not the link held, what came is brought onto the disk
    let status = recorder.end().await.map_err(|error| CommandError::Failure(error.to_string()))?;
    if status.is_whole() && stats.received_frames == 0 && is_empty(&args.out) {
        // the same command begins again; a file that cannot be removed is an empty one
        let _ = std::fs::remove_file(&args.out);
    }
    let document = document(args, lasted_s, &status, &stats);
    let told = if json { output::json(&document) } else { output::text(&text(&document)) };
    stderr.flush();
    ended?;
    told?;
    if let Some(failure) = &status.failure {
        return Err(CommandError::Failure(format!("cannot write {}: {failure}", text::path(&args.out))));
    }
    let whole = status.is_whole() && stats.received_frames > 0;
    Ok(if whole { Outcome::Done } else { Outcome::DoneWithLoss })
}

/// Ends the link when what was asked for last is sent, and gives what passed it. The recording, ended after it, has these frames and no
/// others.
async fn closed(reader: LinkReader, writer: LinkWriter) -> LinkStats {
    let so_far = reader.stats();
    drop(reader);
    tokio::time::timeout(CLOSING, writer.close()).await.unwrap_or(so_far)
}

fn is_empty(path: &std::path::Path) -> bool {
    std::fs::metadata(path).is_ok_and(|found| found.is_file() && found.len() == 0)
}

fn refused(error: &RecordError) -> CommandError {
    match error {
        RecordError::Exists { .. } => CommandError::Input(format!("{error}: --force replaces it")),
        _ => CommandError::Failure(error.to_string()),
    }
}

/// A running capture.
struct Capture {
    reader: LinkReader,
    writer: LinkWriter,
    recorder: Recorder,
    stderr: StandardError,
    /// vehicles that were asked for their messages
    asked: Vec<(SystemId, ComponentId)>,
}

impl Capture {
    /// Until the time is over, or somebody interrupts.
    async fn until(&mut self, start: Instant, args: &RecordArgs) -> Result<(), CommandError> {
        let length = args.duration.map_or(YEAR, |seconds| Duration::from_secs_f64(seconds).min(YEAR));
        let mut second = interval(Duration::from_secs(1));
        second.set_missed_tick_behavior(MissedTickBehavior::Skip);
        let interrupted = network::interrupted();
        tokio::pin!(interrupted);
        loop {
            tokio::select! {
                received = self.reader.receive() => match received {
                    Ok(Received::Frame(frame)) => self.frame(&frame, args.heartbeat),
                    Ok(Received::Event(event)) => self.event(&event),
                    Err(error) => return Err(CommandError::Failure(error.to_string())),
                },
                _ = second.tick() => self.second(start, args.heartbeat),
                () = sleep_until(start + length) => return Ok(()),
                stopped = &mut interrupted => return stopped,
            }
        }
    }

    fn second(&self, start: Instant, heartbeat: bool) {
        if heartbeat {
            // while nobody is there, there is nobody to tell
            let _ = self.writer.send_message(&fly::heartbeat());
        }
        let status = self.recorder.status();
        let lost = self.reader.stats().lost();
        self.stderr.status(&format!(
            "{:.0} s, {} frames, {:.1} kB, {lost} lost on the link",
            start.elapsed().as_secs_f64(),
            status.frames,
            status.bytes as f64 / 1e3
        ));
    }

    fn event(&self, event: &LinkEvent) {
        let warns = matches!(
            event,
            LinkEvent::Stranger { .. }
                | LinkEvent::RecordingFails
                | LinkEvent::Distrusted { .. }
                | LinkEvent::Unchecked { .. }
                | LinkEvent::ClockBehind { .. }
        );
        let text = if warns { format!("warning: {event}") } else { event.to_string() };
        self.stderr.tell(&text);
    }

    /// Asks a vehicle, once, for what identification uses.
    fn frame(&mut self, frame: &ReceivedFrame, speaks: bool) {
        let sender = (frame.header.system, frame.header.component);
        let is_vehicle =
            frame.header.message_id == HEARTBEAT && frame.payload().u8(AUTOPILOT_AT) != NO_AUTOPILOT;
        if !speaks || !is_vehicle || self.asked.contains(&sender) {
            return;
        }
        self.asked.push(sender);
        // an id that messages have no room for cannot be asked
        let Some(vehicle) = Target::new(sender.0, sender.1) else { return };
        for (message, rate_hz) in MESSAGES {
            let order = Order::interval(*message, Period::of_whole_rate(*rate_hz));
            // a link lost meanwhile: the vehicle keeps what it has
            let _ = self.writer.send_message(&vehicle.command(&order, 0));
        }
    }
}

fn document(args: &RecordArgs, duration_s: f64, status: &RecorderStatus, stats: &LinkStats) -> Document {
    let senders = stats.senders.values().map(|sender| SenderLine {
        system: sender.system.0,
        component: sender.component.0,
        frames: sender.frames,
        lost: sender.lost,
        duplicates: sender.duplicates,
    });
    Document {
        schema: 1,
        log: text::path(&args.out),
        duration_s,
        frames: status.frames,
        bytes: status.bytes,
        received_frames: stats.received_frames,
        sent_frames: stats.sent_frames,
        dropped: status.dropped,
        doubtful: status.doubtful,
        redacted: status.redacted,
        unknown_messages: stats.unknown,
        bad_checksums: stats.bad_crc,
        noise_bytes: stats.skipped_bytes,
        resyncs: stats.resyncs,
        lost_frames: stats.lost(),
        badly_signed: stats.badly_signed,
        replayed: stats.replayed,
        unsigned: stats.unsigned,
        link_losses: stats.losses,
        stranger_datagrams: stats.stranger_datagrams,
        senders: senders.collect(),
    }
}

fn text(document: &Document) -> String {
    let mut lines = vec![format!(
        "{}: {} frames, {} bytes in {:.1} s; {} received, {} sent, {} lost on the link, {} with a wrong checksum, \
         {} bytes of noise",
        document.log,
        document.frames,
        document.bytes,
        document.duration_s,
        document.received_frames,
        document.sent_frames,
        document.lost_frames,
        document.bad_checksums,
        document.noise_bytes
    )];
    for sender in &document.senders {
        lines.push(format!(
            "system {} component {}: {} frames, {} lost",
            sender.system, sender.component, sender.frames, sender.lost
        ));
    }
    let distrusted = document.badly_signed + document.replayed + document.unsigned;
    if distrusted > 0 {
        lines.push(format!(
            "signatures: {} wrong, {} replayed, {} missing",
            document.badly_signed, document.replayed, document.unsigned
        ));
    }
    if document.dropped > 0 {
        lines.push(format!("warning: {} frames are missing in the file", document.dropped));
    }
    if document.doubtful > 0 {
        let count = document.doubtful;
        lines.push(format!("warning: the system could not confirm that {count} frames are on the disk"));
    }
    if document.received_frames == 0 {
        lines.push("warning: nothing was received".into());
    }
    lines.join("\n")
}
