//! A UDP proxy that loses, delays, reorders and doubles datagrams, by a seeded plan.

#![allow(dead_code, clippy::unwrap_used)] // no test uses all of it

use std::net::SocketAddr;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use tokio::net::UdpSocket;
use tokio::task::JoinHandle;

/// What befalls the datagrams of each direction. Shares are 0 to 1.
#[derive(Debug, Clone, Copy, Default)]
pub struct Faults {
    /// the same seed, the same fate of the n-th datagram of a direction
    pub seed: u64,
    /// share that is lost
    pub loss: f64,
    /// share that arrives twice
    pub duplicate: f64,
    /// share that is held back for `held`, so that later ones overtake it
    pub reorder: f64,
    /// how long these are held back
    pub held: Duration,
    /// how long every datagram takes
    pub delay: Duration,
}

/// What befell them, both directions together.
#[derive(Debug, Default)]
pub struct Tally {
    pub forwarded: AtomicU64,
    pub lost: AtomicU64,
    pub doubled: AtomicU64,
    pub held: AtomicU64,
}

/// A running proxy; it ends when dropped.
pub struct LossyProxy {
    /// where the client is to send
    pub address: SocketAddr,
    pub tally: Arc<Tally>,
    cut: Arc<AtomicBool>,
    tasks: Vec<JoinHandle<()>>,
}

impl LossyProxy {
    /// Listens on a port of 127.0.0.1 (0: any) and passes on between whoever sends there and `target`.
    pub async fn start(port: u16, target: SocketAddr, faults: Faults) -> Self {
        let client_side = Arc::new(UdpSocket::bind(("127.0.0.1", port)).await.unwrap());
        let target_side = Arc::new(UdpSocket::bind("127.0.0.1:0").await.unwrap());
        let client = Arc::new(Mutex::new(None));
        let (tally, cut) = (Arc::new(Tally::default()), Arc::new(AtomicBool::new(false)));
        let direction = |stream| Direction {
            rng: Pcg64::seed_from_u64(faults.seed ^ stream),
            faults,
            tally: tally.clone(),
            cut: cut.clone(),
        };
        let (mut up, mut down) = (direction(0), direction(1 << 63));
        let address = client_side.local_addr().unwrap();
        let (from, to, seen) = (client_side.clone(), target_side.clone(), client.clone());
        let upward = tokio::spawn(async move {
            let mut buffer = [0; 2048];
            loop {
                // a peer that is not there yet answers with an error: nothing to pass on
                let Ok((bytes, sender)) = from.recv_from(&mut buffer).await else { continue };
                *seen.lock().unwrap() = Some(sender);
                up.pass(&buffer[..bytes], &to, target);
            }
        });
        let downward = tokio::spawn(async move {
            let mut buffer = [0; 2048];
            loop {
                let Ok((bytes, _)) = target_side.recv_from(&mut buffer).await else { continue };
                let to = *client.lock().unwrap();
                if let Some(to) = to {
                    down.pass(&buffer[..bytes], &client_side, to);
                }
            }
        });
        Self { address, tally, cut, tasks: vec![upward, downward] }
    }

    /// Cuts the line (everything is lost) or mends it.
    pub fn cut(&self, cut: bool) {
        self.cut.store(cut, Ordering::SeqCst);
    }
}

impl Drop for LossyProxy {
    fn drop(&mut self) {
        for task in &self.tasks {
            task.abort();
        }
    }
}

struct Direction {
    rng: Pcg64,
    faults: Faults,
    tally: Arc<Tally>,
    cut: Arc<AtomicBool>,
}

impl Direction {
    fn pass(&mut self, bytes: &[u8], by: &Arc<UdpSocket>, to: SocketAddr) {
        // always three numbers, so that one fault does not change the plan of the others
        let [lost, doubled, held] = [self.faults.loss, self.faults.duplicate, self.faults.reorder]
            .map(|share| self.rng.random_bool(share));
        if lost || self.cut.load(Ordering::SeqCst) {
            self.tally.lost.fetch_add(1, Ordering::SeqCst);
            return;
        }
        self.tally.forwarded.fetch_add(1, Ordering::SeqCst);
        self.tally.doubled.fetch_add(u64::from(doubled), Ordering::SeqCst);
        self.tally.held.fetch_add(u64::from(held), Ordering::SeqCst);
        let delay = self.faults.delay + if held { self.faults.held } else { Duration::ZERO };
        for _ in 0..=u8::from(doubled) {
            let (by, bytes) = (by.clone(), bytes.to_vec());
            if delay.is_zero() {
                // what a full buffer refuses is lost, as on any network
                let _ = by.try_send_to(&bytes, to);
            } else {
                tokio::spawn(async move {
                    tokio::time::sleep(delay).await;
                    let _ = by.send_to(&bytes, to).await;
                });
            }
        }
    }
}
