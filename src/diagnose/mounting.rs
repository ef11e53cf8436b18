//! How thrust axis and sensors sit: off a little in every vehicle, and an effect where they are off by much.
//!
//! What stands in a nuisance's place is tried only when nothing else passes: almost any force that does not
//! change looks a little like a lean.

use super::base::{FRAME_MISALIGNMENT, THRUST_TILT};
use super::candidates::{Candidate, present};
use super::channels::Nuisance;
use super::evidence::Weighted;
use super::fit::Fitted;
use super::tested::Tested;
use super::trace::Trace;
use super::trial::{columns_of, is_present};
use rayon::prelude::*;

/// Mountings are true to about half a degree, rad.
const ORDINARY_RAD: f64 = 0.0087;
/// No inertial unit sits at the centre of mass to better than this, m.
const ORDINARY_M: f64 = 0.005;

/// How something sits.
struct Mounting {
    id: &'static str,
    /// slots that are estimated
    free: &'static [usize],
    /// values at which it does nothing
    nothing: &'static [f64],
    /// size (norm of the amounts) below which it has no name
    ordinary: f64,
    turn: Turn,
}

const fn mounting(
    id: &'static str,
    (free, nothing): (&'static [usize], &'static [f64]),
    ordinary: f64,
    turn: Turn,
) -> Mounting {
    Mounting { id, free, nothing, ordinary, turn }
}

const MOUNTINGS: [Mounting; 5] = [
    mounting(THRUST_TILT, (&[0, 1], &[0.0; 2]), ORDINARY_RAD, Turn::Last),
    // turned about the vertical nothing changes
    mounting(FRAME_MISALIGNMENT, (&[0, 1], &[0.0; 3]), ORDINARY_RAD, Turn::Last),
    // only the position is askew, not the attitude
    mounting(FRAME_MISALIGNMENT, (&[0, 1, 2], &[0.0; 4]), ORDINARY_RAD, Turn::First),
    mounting("imu_misalignment", (&[0, 1, 2], &[0.0; 3]), ORDINARY_RAD, Turn::First),
    mounting("imu_offset", (&[0, 1, 2], &[0.0; 3]), ORDINARY_M, Turn::First),
];

/// The size (norm of the parameters) below which a mounting is like any other; `None` for other effects.
pub(super) fn ordinary_size(id: &str) -> Option<f64> {
    MOUNTINGS.iter().find(|mounting| mounting.id == id).map(|mounting| mounting.ordinary)
}

/// Whether a nuisance column stands for small sizes of the effect.
fn is_small(id: &str, nuisance: Nuisance) -> bool {
    match nuisance {
        Nuisance::Tilt(_) => id == THRUST_TILT,
        Nuisance::Level(_) => id == FRAME_MISALIGNMENT,
        _ => false,
    }
}

/// Whether a mounting waits until nothing else passes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Turn {
    /// what only the inertial unit sees, and no nuisance stands for
    First,
    /// what a nuisance stands for
    Last,
}

/// Each of a turn that the recordings show, tested without the nuisance that stands for it.
pub(super) fn mountings(flights: &[Trace], fitted: &Fitted, turn: Turn) -> Vec<Tested> {
    let twice = flights.iter().all(Trace::reads_force_twice);
    MOUNTINGS
        .par_iter()
        .filter(|mounting| mounting.turn == turn)
        .filter(|mounting| twice || mounting.id == THRUST_TILT)
        .filter_map(|&Mounting { id, free, nothing, .. }| {
            let part = present(id, nothing, free)?;
            let candidate = Candidate { id, parts: vec![part], through: None };
            if is_present(&fitted.base, &candidate) {
                return None;
            }
            let columns = columns_of(flights, fitted, &candidate)?;
            let evidence = if turn == Turn::First {
                fitted.weighted.test(&columns)?
            } else {
                let mut rows = fitted.rows.clone();
                rows.nuisances.retain(|column| !is_small(id, column.nuisance));
                Weighted::at(&rows, &fitted.weighted.sigma).test(&columns)?
            };
            Some(Tested { candidate, evidence })
        })
        .collect()
}
