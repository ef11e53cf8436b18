//! Flights of the embedded vehicle on which things go wrong by lot, on a simulated clock and over a simulated link, and
//! the laws that hold all the same.

#![allow(dead_code, reason = "the test and the benchmark use a part each")]
#![allow(
    clippy::unwrap_used,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a test ends where it fails"
)]

pub mod forge;
pub mod host;
pub mod laws;
pub mod lot;
pub mod network;
pub mod ours;
pub mod trace;
pub mod wire;
pub mod world;

use std::collections::HashMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::Duration;

use mavid::log::TlogReader;
use mavid::sitl::Firmware;

use laws::{Broken, Law, check};
use lot::Lot;
use ours::Given;
use world::World;

/// What became of a flight.
#[derive(Debug, Clone)]
pub struct Report {
    pub number: u64,
    pub broken: Vec<Broken>,
    /// what went wrong, and how it ended
    pub story: String,
    /// around the first breach, or all of it
    pub excerpt: String,
    /// it came to its faults
    pub attacked: bool,
    /// phase from which on they were to come
    pub phase: &'static str,
    /// kinds of trouble that came
    pub came: Vec<&'static str>,
    /// vehicle frames that were read
    pub frames: usize,
    /// of simulated time
    pub lasted: Duration,
}

/// Flies one flight of a seed.
pub fn fly(seed: u64, number: u64, whole: bool) -> Report {
    fly_lot(Lot::draw(seed, number), (seed, number), whole)
}

/// Flies a lot; random numbers are those of a seed's flight.
pub fn fly_lot(lot: Lot, (seed, number): (u64, u64), whole: bool) -> Report {
    let given = given(&lot);
    let (story, phase) = (lot.to_string(), lot.phase);
    let mut world = World::new(lot, seed, number);
    let flown = catch_unwind(AssertUnwindSafe(|| world.fly()));
    let mut broken = check(&world.trace, &given);
    if flown.is_err() {
        broken.push(Broken { law: Law::Panic, at: world.now, how: "see above".into() });
    }
    if let Some(how) = missing(&mut world) {
        broken.push(Broken { law: Law::Log, at: world.now, how });
    }
    let around = Duration::from_secs(6);
    let excerpt = match broken.first() {
        Some(breach) if !whole => {
            world.trace.excerpt(breach.at.saturating_sub(around), breach.at + Duration::from_secs(1))
        }
        None if !whole => String::new(),
        _ => world.trace.excerpt(Duration::ZERO, Duration::MAX),
    };
    let ending =
        world.host.outcome.as_ref().map(|outcome| format!("{:?}, {:?}", outcome.cause, outcome.ending));
    let story = format!("{story}  ended: {}", ending.unwrap_or_else(|| "not".into()));
    let (attacked, frames, lasted) = (world.began(), world.host.read.len(), world.now);
    let came = std::mem::take(&mut world.came);
    Report { number, broken, story, excerpt, attacked, phase, came, frames, lasted }
}

pub fn given(lot: &Lot) -> Given {
    let limits = lot.sortie().limits;
    let bound = |limit: Option<f64>| limit.unwrap_or(f64::INFINITY);
    let room_m = [bound(limits.x_max_m), bound(limits.y_max_m), bound(limits.z_min_m), bound(limits.z_max_m)];
    Given { px4: lot.kind == Firmware::PX4, room_m, here: lot.origin == mavid::fly::Origin::Here }
}

/// Vehicle frames that were read and are not in the recording.
fn missing(world: &mut World) -> Option<String> {
    let recorded = world.host.recorded(&world.runtime);
    let mut kept: HashMap<Vec<u8>, i32> = HashMap::new();
    let mut reader = TlogReader::new(std::io::Cursor::new(recorded));
    while let Some(record) = reader.next_record().unwrap() {
        *kept.entry(record.frame.bytes().to_vec()).or_default() += 1;
    }
    let mut lost = 0;
    for frame in &world.host.read {
        let left = kept.entry(frame.clone()).or_default();
        *left -= 1;
        lost += usize::from(*left < 0);
    }
    (lost > 0).then(|| format!("{lost} of {} vehicle frames are not in the recording", world.host.read.len()))
}

impl Report {
    /// For people: what was broken, how to fly it again, what happened.
    pub fn text(&self, seed: u64) -> String {
        let broken: Vec<String> = self
            .broken
            .iter()
            .map(|broken| format!("{:?} at {:.3} s: {}", broken.law, broken.at.as_secs_f64(), broken.how))
            .collect();
        format!(
            "flight {} of seed {seed} ({}):\n  {}\n  again: cargo bench --bench faults -- --seed {seed} --first {} --flights 1 --trace\n{}",
            self.number,
            self.story,
            broken.join("\n  "),
            self.number,
            self.excerpt
        )
    }
}
