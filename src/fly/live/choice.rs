//! Choice of the message from which a quantity is taken, while messages arrive.

use super::track::{At, Track, WIDTH};
use crate::recording::landed::ON_GROUND;
use crate::recording::{Quantity, StreamKey};
use crate::signals::best_rank;

/// Time for which sources are observed before one is chosen, s. Every source sends within it; the live view begins so
/// much later.
const WATCH_S: f64 = 2.0;
/// Silence after which a source is given up, s. Streams of 10 Hz and a lossy link pause for less.
const SILENT_S: f64 = 1.0;
/// Largest number of observed sources of one quantity; others are ignored.
const WATCHED: usize = 8;

const QUANTITIES: [Quantity; 5] = [
    Quantity::AngularRate,
    Quantity::Attitude,
    Quantity::Velocity,
    Quantity::ActuatorCommand,
    Quantity::RotorSpeed,
];
/// Quantities of a row; in addition, either actuator commands or rotor speeds are needed.
const NEEDED: [Quantity; 3] = [Quantity::AngularRate, Quantity::Attitude, Quantity::Velocity];

/// A source while it is observed.
#[derive(Debug, Clone, Copy)]
struct Watched {
    id: StreamKey,
    count: u32,
    moved: bool,
    first: f64,
}

#[derive(Debug)]
struct Chosen {
    quantity: Quantity,
    /// values that a sample must have
    width: usize,
    watched: Vec<Watched>,
    since_s: Option<f64>,
    source: Option<StreamKey>,
    track: Track,
}

/// All quantities of a row.
#[derive(Debug)]
pub(super) struct Sources {
    quantities: Vec<Chosen>,
    landed: bool,
}

impl Sources {
    /// For actuator messages with `channels` channels and speeds of `rotors` rotors.
    pub(super) fn new(channels: usize, rotors: usize) -> Self {
        let chosen = |quantity| Chosen {
            quantity,
            width: match quantity {
                Quantity::Attitude => 4,
                // channels at the end that are zero may be left out
                Quantity::ActuatorCommand => channels.min(1),
                Quantity::RotorSpeed => rotors,
                _ => 3,
            },
            watched: Vec::with_capacity(WATCHED),
            since_s: None,
            source: None,
            track: Track::new(),
        };
        Self { quantities: QUANTITIES.map(chosen).into(), landed: false }
    }

    /// Adds a sample.
    pub(super) fn add(&mut self, id: StreamKey, time_s: f64, values: &[f64]) {
        if id.quantity == Quantity::LandedState {
            self.landed = values.first().is_some_and(|state| (state - ON_GROUND).abs() < 0.5);
        }
        if let Some(chosen) = self.quantities.iter_mut().find(|chosen| chosen.quantity == id.quantity) {
            chosen.add(id, time_s, values);
        }
    }

    /// Whether the autopilot reports that it stands on the ground.
    pub(super) fn is_landed(&self) -> bool {
        self.landed
    }

    /// The track of a quantity whose source is chosen.
    pub(super) fn track(&self, quantity: Quantity) -> Option<&Track> {
        let chosen = self.quantities.iter().find(|chosen| chosen.quantity == quantity)?;
        chosen.source.map(|_| &chosen.track)
    }

    /// The latest instant that every track has reached, s; `None` while something is missing.
    pub(super) fn oldest_newest_s(&self) -> Option<f64> {
        let newest = |quantity| self.track(quantity).and_then(Track::newest_s);
        let drive = newest(Quantity::RotorSpeed).or_else(|| newest(Quantity::ActuatorCommand))?;
        NEEDED.iter().try_fold(drive, |least, quantity| newest(*quantity).map(|s| least.min(s)))
    }

    /// What no source is chosen of yet.
    pub(super) fn missing(&self) -> Vec<Quantity> {
        let is_missing = |quantity: &Quantity| self.track(*quantity).and_then(Track::newest_s).is_none();
        let drive = is_missing(&Quantity::RotorSpeed) && is_missing(&Quantity::ActuatorCommand);
        let needed = NEEDED.into_iter().filter(is_missing);
        needed.chain(drive.then_some(Quantity::ActuatorCommand)).collect()
    }

    /// A quantity that has a gap at this instant.
    pub(super) fn gap_at(&self, time_s: f64) -> Option<Quantity> {
        let tracks = QUANTITIES.into_iter().filter_map(|quantity| Some((quantity, self.track(quantity)?)));
        let mut gaps = tracks.filter(|(_, track)| matches!(track.at(time_s), At::Gap));
        gaps.next().map(|(quantity, _)| quantity)
    }

    /// Forgets all samples, because the clock restarted.
    pub(super) fn clear(&mut self) {
        for chosen in &mut self.quantities {
            chosen.track.clear();
            chosen.since_s = None;
            chosen.watched.clear();
        }
    }
}

impl Chosen {
    fn add(&mut self, id: StreamKey, time_s: f64, values: &[f64]) {
        if values.len() < self.width || values.len() > WIDTH {
            return;
        }
        match self.source {
            Some(source) if source == id => self.track.push(time_s, values),
            Some(_) if self.track.newest_s().is_none_or(|newest_s| time_s - newest_s < SILENT_S) => {}
            Some(_) => {
                self.source = None;
                self.since_s = None;
                self.watched.clear();
                self.track.clear();
            }
            None => self.watch(id, time_s, values),
        }
    }

    fn watch(&mut self, id: StreamKey, time_s: f64, values: &[f64]) {
        let since_s = *self.since_s.get_or_insert(time_s);
        let first = values.first().copied().unwrap_or(0.0);
        if let Some(watched) = self.watched.iter_mut().find(|watched| watched.id == id) {
            watched.count += 1;
            watched.moved |= first.to_bits() != watched.first.to_bits();
        } else if self.watched.len() < WATCHED {
            self.watched.push(Watched { id, count: 1, moved: false, first });
        }
        if time_s - since_s >= WATCH_S {
            self.choose(time_s - since_s);
        }
    }

    fn choose(&mut self, watched_s: f64) {
        // a frozen stream says nothing
        self.watched.retain(|watched| watched.moved);
        self.watched.sort_by_key(|watched| watched.id);
        let mut rated = [("", 0.0); WATCHED];
        for (rated, watched) in rated.iter_mut().zip(&self.watched) {
            *rated = (watched.id.source, f64::from(watched.count) / watched_s);
        }
        let best = best_rank(self.quantity, &rated[..self.watched.len()]);
        self.source = best.map(|index| self.watched[index].id);
        self.watched.clear();
        self.since_s = None;
    }
}
