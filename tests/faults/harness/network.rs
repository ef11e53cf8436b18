//! What lies between the vehicle and the program: one way of it.

use std::collections::BTreeMap;
use std::fmt;
use std::time::Duration;

use rand::RngExt;
use rand_pcg::Pcg64;

/// How bad a way is. Shares of the frames, and times.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Quality {
    pub loss: f64,
    pub delay_s: f64,
    pub jitter_s: f64,
    pub doubled: f64,
    pub corrupted: f64,
}

impl Quality {
    /// The same, only so much of it.
    pub fn times(self, factor: f64) -> Self {
        Self {
            loss: self.loss * factor,
            delay_s: self.delay_s * factor,
            jitter_s: self.jitter_s * factor,
            doubled: self.doubled * factor,
            corrupted: self.corrupted * factor,
        }
    }
}

impl fmt::Display for Quality {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { loss, delay_s, jitter_s, doubled, corrupted } = self;
        write!(
            f,
            "loss {loss:.2} delay {delay_s:.2}+{jitter_s:.2} s doubled {doubled:.2} corrupted {corrupted:.2}"
        )
    }
}

/// A frame under way.
#[derive(Debug, Clone, PartialEq)]
pub struct Packet {
    pub bytes: Vec<u8>,
    /// when the vehicle or the program gave it; `None` for what others made
    pub said: Option<Duration>,
}

/// One way. The frames of a stream keep their order, and what a silence holds back comes after it.
#[derive(Debug)]
pub struct Way {
    pub quality: Quality,
    /// nothing passes before this
    pub silent_until: Duration,
    stream: bool,
    random: Pcg64,
    under_way: BTreeMap<(Duration, u64), Packet>,
    latest: Duration,
    count: u64,
}

impl Way {
    pub fn new(random: Pcg64, stream: bool) -> Self {
        Self {
            quality: Quality::default(),
            silent_until: Duration::ZERO,
            stream,
            random,
            under_way: BTreeMap::new(),
            latest: Duration::ZERO,
            count: 0,
        }
    }

    pub fn give(&mut self, now: Duration, packet: Packet) {
        let quality = self.quality;
        if self.stream {
            let arrives = now.max(self.silent_until) + Duration::from_secs_f64(quality.delay_s);
            self.latest = self.latest.max(arrives);
            let at = self.latest;
            return self.put(at, packet);
        }
        if now < self.silent_until || self.random.random::<f64>() < quality.loss {
            return;
        }
        let copies = if self.random.random::<f64>() < quality.doubled { 2 } else { 1 };
        for _ in 0..copies {
            let mut packet = packet.clone();
            if self.random.random::<f64>() < quality.corrupted {
                let at = self.random.random_range(1..packet.bytes.len());
                packet.bytes[at] ^= 1 << self.random.random_range(0..8);
                packet.said = None;
            }
            let late_s = quality.delay_s + quality.jitter_s * self.random.random::<f64>();
            self.put(now + Duration::from_secs_f64(late_s), packet);
        }
    }

    fn put(&mut self, at: Duration, packet: Packet) {
        self.count += 1;
        self.under_way.insert((at, self.count), packet);
    }

    pub fn take(&mut self, now: Duration) -> Vec<Packet> {
        let later = self.under_way.split_off(&(now + Duration::from_nanos(1), 0));
        std::mem::replace(&mut self.under_way, later).into_values().collect()
    }

    /// The connection is cut: what is under way is gone.
    pub fn cut(&mut self) {
        self.under_way.clear();
    }
}
