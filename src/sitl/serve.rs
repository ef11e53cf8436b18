//! Runs a vehicle on real links, in real time, faster, or in step with its ground station.

use std::future::Future;
use std::time::Duration;

use tokio::sync::mpsc;
use tokio::task::JoinSet;
use tokio::time::Instant;

use super::{LinkId, LinkRole, Outgoing, Vehicle};
use crate::link::{Ends, LinkReader, LinkWriter, Received};

/// How the vehicle's time passes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Pace {
    /// this many times as fast as real time
    Times(f64),
    /// Time advances by [`LOCKSTEP`] whenever a ground station has sent something, or has been silent for
    /// as long in real time. One that sends a setpoint for whatever it hears is never late, however fast
    /// both are.
    Lockstep,
}

/// How it went.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Served {
    /// of the vehicle's own time
    pub flown: Duration,
    /// greatest distance between the vehicle's time and the pace, of the vehicle's time; none in lock-step
    pub behind: Duration,
}

/// Step of time in lock-step.
pub const LOCKSTEP: Duration = Duration::from_millis(20);

/// Shortest sleep: timers are no finer.
const NAP: Duration = Duration::from_millis(1);
/// Frames that wait to be looked at.
const QUEUE: usize = 4096;

/// Bytes that came in.
type Heard = (LinkId, Box<[u8]>);

/// Runs `vehicle` on these links until `stop` is ready, or for `limit` of its own time. A link that ends is left out; the others continue.
pub async fn serve(
    mut vehicle: Vehicle,
    links: Vec<(LinkRole, Ends)>,
    (pace, limit): (Pace, Option<Duration>),
    stop: impl Future<Output = ()>,
) -> Served {
    let mut behind = Duration::ZERO;
    let (to_us, mut heard) = mpsc::channel(QUEUE);
    let mut writers = Vec::with_capacity(links.len());
    let mut listeners = JoinSet::new();
    for (role, (reader, writer)) in links {
        let id = vehicle.open_link(role);
        writers.push(writer);
        listeners.spawn(listen(id, reader, to_us.clone()));
    }
    let limit = limit.unwrap_or(Duration::MAX);
    let run = async {
        match pace {
            Pace::Times(factor) => {
                at_pace(&mut vehicle, (&writers, &mut heard), (factor, limit), &mut behind).await
            }
            Pace::Lockstep => in_lockstep(&mut vehicle, &writers, &mut heard, limit).await,
        }
    };
    tokio::select! {
        () = run => {}
        () = stop => {}
    }
    for writer in &writers {
        // a link that has ended has nothing left to send
        let _ = tokio::time::timeout(Duration::from_millis(200), writer.flush()).await;
    }
    Served { flown: vehicle.next_loop(), behind }
}

async fn listen(id: LinkId, mut reader: LinkReader, to: mpsc::Sender<Heard>) {
    while let Ok(received) = reader.receive().await {
        if let Received::Frame(frame) = received
            && to.send((id, frame.bytes().into())).await.is_err()
        {
            return;
        }
    }
}

fn speak(writers: &[LinkWriter], out: Vec<Outgoing>) {
    for outgoing in out {
        if let Some(writer) = writers.get(outgoing.link.0) {
            // while nobody is there, or cannot keep up, telemetry is lost, as on every link
            let _ = writer.send(&outgoing.bytes);
        }
    }
}

async fn at_pace(
    vehicle: &mut Vehicle,
    (writers, heard): (&[LinkWriter], &mut mpsc::Receiver<Heard>),
    (factor, limit): (f64, Duration),
    behind: &mut Duration,
) {
    let start = Instant::now();
    loop {
        let now = start.elapsed().mul_f64(factor).min(limit);
        speak(writers, vehicle.advance(now));
        if now >= limit {
            return;
        }
        *behind = (*behind).max(start.elapsed().mul_f64(factor).saturating_sub(now));
        let wait = vehicle.next_loop().saturating_sub(now).div_f64(factor).max(NAP);
        tokio::select! {
            Some((link, bytes)) = heard.recv() => {
                vehicle.receive(link, &bytes, start.elapsed().mul_f64(factor));
            }
            () = tokio::time::sleep(wait) => {}
        }
    }
}

async fn in_lockstep(
    vehicle: &mut Vehicle,
    writers: &[LinkWriter],
    heard: &mut mpsc::Receiver<Heard>,
    limit: Duration,
) {
    let mut now = Duration::ZERO;
    while now < limit {
        speak(writers, vehicle.advance(now));
        if let Ok(Some((link, bytes))) = tokio::time::timeout(LOCKSTEP, heard.recv()).await {
            vehicle.receive(link, &bytes, now);
            while let Ok((link, bytes)) = heard.try_recv() {
                vehicle.receive(link, &bytes, now);
            }
        }
        now += LOCKSTEP;
    }
}
