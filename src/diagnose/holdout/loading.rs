//! The centre of mass of a held-out flight: a battery that was put back elsewhere moves it.

use super::settings::HoldoutSettings;
use crate::diagnose::base::Base;
use crate::diagnose::channels::AXES;
use crate::diagnose::gates::NAME_Z;
use crate::diagnose::rows::Rows;
use crate::diagnose::signatures::{ALL, REPACKED_M};
use crate::diagnose::trace::Trace;
use crate::physics::PhysicsError;
use nalgebra::{Matrix2, Vector2};

/// Beginning of a held-out flight from which its centre of mass is taken, s; the errors are those of the rest. Longer
/// would take what is to be predicted, shorter leaves the place vague.
const FIRST_S: f64 = 5.0;
/// Length of the blocks whose scatter gives its standard error, s. It is longer than the weak form's window, over which torques are
/// correlated; longer ones are too few for a scatter.
const BLOCK_S: f64 = 0.5;
/// Standard errors beyond which it was another place. As many as a name needs.
const SIGMAS: f64 = NAME_Z;

/// A base with the centre of mass of another flight.
pub(super) struct Loaded {
    pub(super) base: Base,
    /// by which it moved, body x and y, m
    pub(super) moved_m: [f64; 2],
    /// vehicle clock, s, up to where the flight was used for it
    pub(super) until_s: f64,
}

/// The base with the centre of mass that the beginning of a flight shows; `None` where it shows no other one than the base has,
/// or one that no battery explains.
pub(super) fn loaded(
    base: &Base,
    trace: &Trace,
    settings: &HoldoutSettings,
) -> Result<Option<Loaded>, PhysicsError> {
    let mut of_the_loading = ALL.iter().filter(|signature| signature.role.of_the_loading);
    let Some(&signature) = of_the_loading.next().filter(|_| trace.torques && !settings.same_flight) else {
        return Ok(None);
    };
    let slots = signature.amounts;
    let mut all = base.clone();
    for term in &mut all.effects {
        term.free.clear();
    }
    let own = all.effects.iter().position(|term| std::ptr::eq(term.signature, signature));
    let place = own.unwrap_or(all.effects.len());
    if own.is_none() {
        all.effects.push(signature.whole());
    }
    all.effects[place].free = slots[..2].to_vec();
    let rows = Rows::new(std::slice::from_ref(trace), &all)?;
    let Some(&first_s) = rows.time_s.first() else { return Ok(None) };
    let until_s = first_s + FIRST_S;
    let Some((moved, std)) = of_torques(&rows, (first_s, until_s)) else { return Ok(None) };
    let is_moved = moved.iter().zip(&std).any(|(moved, std)| moved.abs() > SIGMAS * std);
    if !is_moved || moved.norm() > REPACKED_M {
        return Ok(None);
    }
    for (slot, moved) in slots.iter().zip(moved.iter()) {
        all.effects[place].values[*slot] += moved;
    }
    Ok(Some(Loaded { base: all, moved_m: moved.into(), until_s }))
}

/// Least squares of the torques' residual between two times on the two free parameters, and their standard errors by the scatter of
/// blocks; `None` where there are too few, or where they do not act.
fn of_torques(rows: &Rows, (from_s, until_s): (f64, f64)) -> Option<(Vector2<f64>, Vector2<f64>)> {
    let [along_x, along_y] = rows.effects.as_slice() else { return None };
    let used = || (0..rows.len()).filter(|&row| rows.time_s[row] < until_s);
    let at = |row: usize, channel: usize| Vector2::new(along_x[channel][row], along_y[channel][row]);
    let (mut normal, mut right) = (Matrix2::zeros(), Vector2::zeros());
    for row in used() {
        for channel in 3..AXES {
            let columns = at(row, channel);
            normal += columns * columns.transpose();
            right += columns * rows.residual[channel][row];
        }
    }
    let bread = normal.try_inverse()?;
    let moved = bread * right;
    let mut blocks: Vec<(f64, Vector2<f64>)> = Vec::new();
    for row in used() {
        let block = ((rows.time_s[row] - from_s) / BLOCK_S).floor();
        if blocks.last().is_none_or(|(last, _)| *last != block) {
            blocks.push((block, Vector2::zeros()));
        }
        let (_, score) = blocks.last_mut()?;
        for channel in 3..AXES {
            let columns = at(row, channel);
            *score += columns * (rows.residual[channel][row] - columns.dot(&moved));
        }
    }
    let left = blocks.len().checked_sub(2).filter(|left| *left > 0)?;
    let meat: Matrix2<f64> = blocks.iter().map(|(_, score)| score * score.transpose()).sum();
    let covariance = bread * meat * bread * (blocks.len() as f64 / left as f64);
    Some((moved, covariance.diagonal().map(|variance| variance.max(0.0).sqrt())))
}
