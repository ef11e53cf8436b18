//! A connection whose reads and writes block: each has a thread of its own.
//!
//! Some serial drivers ignore their time-outs, so that a read may never return. The threads are never waited
//! for: when the session is over their channels close, and they end as soon as the system lets them.

use std::io::{self, ErrorKind, Read, Write};
use std::time::{Duration, Instant};

use tokio::sync::mpsc;
use tokio::time::timeout;

use super::super::clock::HostStamp;
use super::super::incoming::Incoming;
use super::super::outgoing::Outgoing;
use super::stream::SILENCE;

const BUFFER: usize = 4096;
/// Pieces that may wait for the task.
const PIECES: usize = 256;
/// A port that takes nothing for so long is lost.
const STUCK: Duration = Duration::from_secs(5);

/// A port opened twice: to read and to write. Both give up a call after some ten milliseconds with
/// [`ErrorKind::TimedOut`].
pub(super) struct Port {
    pub reader: Box<dyn Read + Send>,
    pub writer: Box<dyn Write + Send>,
}

type Piece = (HostStamp, io::Result<Vec<u8>>);

/// Carries bytes both ways until the port fails, and says why it did.
pub(super) async fn session(port: Port, incoming: &mut Incoming, outgoing: &mut Outgoing) -> String {
    match start(port, incoming) {
        Ok(threads) => carry(threads, incoming, outgoing).await,
        Err(error) => format!("the system gives no thread: {error}"),
    }
}

struct Threads {
    pieces: mpsc::Receiver<Piece>,
    /// one frame at a time: what follows stays where it can be replaced
    frames: mpsc::Sender<Box<[u8]>>,
    written: mpsc::Receiver<io::Result<Box<[u8]>>>,
}

fn start(port: Port, incoming: &Incoming) -> io::Result<Threads> {
    let clock = incoming.clock();
    let (to_task, pieces) = mpsc::channel(PIECES);
    let (frames, to_write) = mpsc::channel(1);
    let (done, written) = mpsc::channel(1);
    let thread = |name: &str| std::thread::Builder::new().name(name.into());
    thread("link reader").spawn(move || read(port.reader, &to_task, || clock.now()))?;
    thread("link writer").spawn(move || write(port.writer, to_write, &done))?;
    Ok(Threads { pieces, frames, written })
}

async fn carry(mut threads: Threads, incoming: &mut Incoming, outgoing: &mut Outgoing) -> String {
    let read = async {
        let mut in_doubt = false;
        loop {
            let piece = if in_doubt {
                timeout(SILENCE, threads.pieces.recv()).await
            } else {
                Ok(threads.pieces.recv().await)
            };
            in_doubt = piece.is_ok();
            match piece {
                Err(_) => incoming.silence(incoming.now()),
                Ok(Some((stamp, Ok(bytes)))) => incoming.bytes(&bytes, stamp),
                Ok(Some((_, Err(error)))) => return format!("reading failed: {error}"),
                Ok(None) => return "the reading thread ended".into(),
            }
        }
    };
    let write = async {
        loop {
            let frame = outgoing.next().await;
            let stamp = outgoing.now();
            let given = threads.frames.send(frame).await.is_ok();
            match threads.written.recv().await {
                Some(Ok(frame)) if given => outgoing.sent(&frame, stamp),
                Some(Err(error)) => {
                    outgoing.failed();
                    return format!("writing failed: {error}");
                }
                _ => {
                    outgoing.failed();
                    return "the writing thread ended".into();
                }
            }
        }
    };
    tokio::select! {
        why = read => why,
        why = write => why,
    }
}

fn read(mut port: impl Read, to_task: &mpsc::Sender<Piece>, now: impl Fn() -> HostStamp) {
    let mut buffer = [0; BUFFER];
    while !to_task.is_closed() {
        let read = port.read(&mut buffer);
        let stamp = now();
        let result = match read {
            Ok(0) => Err(io::Error::new(ErrorKind::UnexpectedEof, "the other end hung up")),
            Ok(bytes) => Ok(buffer[..bytes].to_vec()),
            Err(error) if matches!(error.kind(), ErrorKind::TimedOut | ErrorKind::Interrupted) => continue,
            Err(error) => Err(error),
        };
        let failed = result.is_err();
        if to_task.blocking_send((stamp, result)).is_err() || failed {
            return;
        }
    }
}

fn write(
    mut port: impl Write,
    mut frames: mpsc::Receiver<Box<[u8]>>,
    done: &mpsc::Sender<io::Result<Box<[u8]>>>,
) {
    while let Some(frame) = frames.blocking_recv() {
        let result = write_all(&mut port, &frame, || done.is_closed()).map(|()| frame);
        let failed = result.is_err();
        if done.blocking_send(result).is_err() || failed {
            return;
        }
    }
}

/// As `write_all`, but a port that takes nothing for a while is waited for, up to a bound.
fn write_all(port: &mut impl Write, mut bytes: &[u8], given_up: impl Fn() -> bool) -> io::Result<()> {
    let mut moved = Instant::now();
    while !bytes.is_empty() {
        match port.write(bytes) {
            Ok(0) => return Err(ErrorKind::WriteZero.into()),
            Ok(written) => {
                bytes = &bytes[written..];
                moved = Instant::now();
            }
            Err(error) if matches!(error.kind(), ErrorKind::TimedOut | ErrorKind::Interrupted) => {
                if given_up() || moved.elapsed() > STUCK {
                    return Err(error);
                }
            }
            Err(error) => return Err(error),
        }
    }
    Ok(())
}
