//! Why samples were left out.

use super::source::Source;

/// Why samples were left out.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct DecodeReport {
    /// messages of the vehicle that were decoded
    pub decoded: u64,
    /// messages whose stamp fits neither the clock nor a new one
    pub stale_stamps: u64,
    /// times that the recording computer's clock was set while the vehicle's continued
    pub host_steps: u64,
    /// times that the vehicle's time since boot ran back and nothing started anew, and the furthest of these, microseconds
    pub ran_back: (u64, u64),
    /// messages of a simulator's truth and parameters SIM_*, SIH_*: never read
    pub withheld_truth: u64,
    /// messages in a frame or unit that cannot be used, by message
    pub unusable: Vec<(Source, u64)>,
    /// messages with no finite value in them, by message
    pub empty: Vec<(Source, u64)>,
}

impl DecodeReport {
    pub(super) fn count(list: &mut Vec<(Source, u64)>, source: Source) {
        match list.iter_mut().find(|(listed, _)| *listed == source) {
            Some((_, count)) => *count += 1,
            None => list.push((source, 1)),
        }
    }
}
