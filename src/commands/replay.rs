//! `mavid replay FILE.tlog [--to ADDRESS] [--speed N]`: plays a recorded flight back as live traffic.
//!
//! Only telemetry that autopilots sent goes out, so that a vehicle that hears it does nothing; what the other end sends
//! is dropped.

use indicatif::{ProgressBar, ProgressStyle};
use mavid::link::LinkOptions;
use mavid::replay::{Replay, ReplayCounts, ReplayError};
use mavid::text;
use serde::Serialize;

use super::standard_error::StandardError;
use super::{CommandError, Outcome, live, network, output};
use crate::cli::ReplayArgs;

/// The JSON document.
#[derive(Debug, Serialize)]
struct Document {
    schema: u32,
    log: String,
    to: String,
    /// the log's own length
    duration_s: f64,
    /// 0: as fast as possible
    speed: f64,
    frames: u64,
    /// held back: all that is not telemetry of an autopilot
    left_out: u64,
    /// of these, what no autopilot sent
    not_of_an_autopilot: u64,
    /// of these, what nobody here knows
    unknown_messages: u64,
    /// of these, what a vehicle may act upon
    not_telemetry: u64,
    /// had nobody to go to
    unsent: u64,
    /// sent by the other end, dropped
    discarded: u64,
    /// the user ended it before the log did
    interrupted: bool,
    /// what of the log itself is gone
    losses: Vec<String>,
}

impl Document {
    /// For the terminal.
    fn line(&self) -> String {
        format!(
            "{} to {}: {} frames played, {} held back ({} that a vehicle may act upon, {} of unknown messages, {} that no \
             autopilot sent), {} unsent; {} frames from the other end dropped{}",
            self.log,
            self.to,
            self.frames,
            self.left_out,
            self.not_telemetry,
            self.unknown_messages,
            self.not_of_an_autopilot,
            self.unsent,
            self.discarded,
            if self.interrupted { "; interrupted" } else { "" }
        )
    }
}

/// Runs the verb.
pub fn run(json: bool, stderr: &StandardError, args: &ReplayArgs) -> Result<Outcome, CommandError> {
    let (args, stderr) = (args.clone(), stderr.clone());
    live::run(move |work| {
        work.ends_itself();
        let replay = Replay::open(&args.log, args.speed).map_err(|error| failed(&error))?;
        network::block_on(play((json, &stderr), &args, &replay))
    })
}

fn failed(error: &ReplayError) -> CommandError {
    match error {
        ReplayError::Link(_) => CommandError::Failure(error.to_string()),
        _ => CommandError::Input(error.to_string()),
    }
}

async fn play(
    (json, stderr): (bool, &StandardError),
    args: &ReplayArgs,
    replay: &Replay,
) -> Result<Outcome, CommandError> {
    let (mut reader, writer) =
        network::open(&network::address("--to", &args.to)?, LinkOptions::default()).await?;
    if !writer.is_connected() {
        output::message(&format!("waiting for a peer at {}", args.to));
    }
    let bar = stderr.bar(bar(replay.frames()));
    let mut so_far = ReplayCounts::default();
    let mut progress = |frame: u64, counts: &ReplayCounts| {
        so_far = *counts;
        bar.set_position(frame);
    };
    let played = tokio::select! {
        played = replay.play(&mut reader, &writer, &mut progress) => Some(played),
        stopped = network::interrupted() => stopped.map(|()| None)?,
    };
    bar.finish_and_clear();
    let interrupted = played.is_none();
    let counts = played.transpose().map_err(|error| failed(&error))?.unwrap_or(so_far);
    let document = Document {
        schema: 1,
        log: text::path(&args.log),
        to: args.to.clone(),
        duration_s: replay.duration().as_secs_f64(),
        speed: args.speed,
        frames: if interrupted { writer.stats().sent_frames } else { counts.frames },
        left_out: counts.held_back.total(),
        not_of_an_autopilot: counts.held_back.not_of_an_autopilot,
        unknown_messages: counts.held_back.unknown,
        not_telemetry: counts.held_back.not_telemetry,
        unsent: counts.unsent,
        discarded: counts.discarded,
        interrupted,
        losses: replay.losses().iter().map(ToString::to_string).collect(),
    };
    for loss in &document.losses {
        output::warning(&format!("{}: {loss}", document.log));
    }
    if json {
        output::json(&document)?;
    } else {
        output::text(&document.line())?;
    }
    Ok(if document.unsent > 0 || !document.losses.is_empty() { Outcome::DoneWithLoss } else { Outcome::Done })
}

fn bar(frames: u64) -> ProgressBar {
    let bar = ProgressBar::new(frames);
    match ProgressStyle::with_template("playing {wide_bar} {pos} of {len} frames, about {eta} left") {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}
