//! Mass and centre of mass of a held-out flight: it has its own payload, and a battery that was put back elsewhere.

use super::agreement::PAYLOAD_SHARE;
use super::settings::HoldoutSettings;
use crate::diagnose::base::Base;
use crate::diagnose::channels::AXES;
use crate::diagnose::common_values::{MassByLift, mass_after, mass_by_lift};
use crate::diagnose::gates::NAME_Z;
use crate::diagnose::rows::Rows;
use crate::diagnose::signatures::{ALL, REPACKED_M};
use crate::diagnose::trace::Trace;
use crate::physics::PhysicsError;
use crate::signals::OwnOfFlight;
use nalgebra::{Matrix2, Vector2};

/// Beginning of a held-out flight from which its centre of mass is taken, s; the errors are those of the rest. Longer
/// would take what is to be predicted, shorter leaves the place vague.
const FIRST_S: f64 = 5.0;
/// Length of the blocks whose scatter gives its standard error, s. It is longer than the weak form's window, over which torques are
/// correlated; longer ones are too few for a scatter.
const BLOCK_S: f64 = 0.5;
/// Standard errors beyond which it was another place. As many as a name needs.
const SIGMAS: f64 = NAME_Z;

/// Least share of the mass that is a payload. Less is what laws of thrust leave open.
const LEAST_OF_MASS: f64 = 0.03;

/// A base with the load of another flight.
pub(super) struct Loaded {
    pub(super) base: Base,
    /// by which it moved, body x and y, m; `None` where it did not
    pub(super) moved_m: Option<[f64; 2]>,
    /// kg beyond the mass of the base; `None` where it is that
    pub(super) more_kg: Option<f64>,
    /// vehicle clock, s, up to where the flight was used for it
    pub(super) until_s: f64,
}

/// The base with the mass and the centre of mass that the beginning of a flight shows; `None` where they are no others than the base has,
/// or a place that no battery explains.
pub(super) fn loaded(
    base: &Base,
    trace: &Trace,
    settings: &HoldoutSettings,
) -> Result<Option<Loaded>, PhysicsError> {
    loaded_from(base, trace, (settings, LEAST_OF_MASS, SIGMAS))
}

/// The same of the model that is compared with one that has its own mass: it has its own in any case, or the difference would count for the
/// effects.
pub(super) fn loaded_beside(
    base: &Base,
    trace: &Trace,
    settings: &HoldoutSettings,
) -> Result<Option<Loaded>, PhysicsError> {
    loaded_from(base, trace, (settings, 0.0, 0.0))
}

fn loaded_from(
    base: &Base,
    trace: &Trace,
    (settings, least, sigmas): (&HoldoutSettings, f64, f64),
) -> Result<Option<Loaded>, PhysicsError> {
    if settings.same_flight {
        return Ok(None);
    }
    let own = without_payload(trace);
    let trace = &trace.with_own(own.clone());
    let mut all = with_held_effects(base);
    let heavier = if settings.own_mass { heavier(&all, trace, (least, sigmas))? } else { None };
    if let Some((more_kg, _)) = heavier {
        all.vehicle.body.mass_kg += more_kg;
    }
    let moved = if trace.torques { moved(&mut all, trace)? } else { None };
    let Some(until_s) = moved.map(|(_, until_s)| until_s).or(heavier.map(|(_, until_s)| until_s)) else {
        return Ok(None);
    };
    // as free as they were, for a fit of the flight's own
    let given = base.effects.iter().map(|term| term.free.clone()).chain(std::iter::repeat(Vec::new()));
    all.effects.iter_mut().zip(given).for_each(|(term, free)| term.free = free);
    Ok(Some(Loaded {
        base: all.on(&own).into_owned(),
        moved_m: moved.map(|(moved_m, _)| moved_m),
        more_kg: heavier.map(|(more_kg, _)| more_kg),
        until_s,
    }))
}

/// What is a flight's own but its payload: what the whole flight tells of that is not known from its beginning.
pub(super) fn without_payload(trace: &Trace) -> OwnOfFlight {
    OwnOfFlight { payload_kg: 0.0, ..trace.own.clone() }
}

/// Whether the beginning of a flight shows another mass than the base has.
pub(super) fn has_other_mass(base: &Base, trace: &Trace) -> Result<bool, PhysicsError> {
    Ok(heavier(&with_held_effects(base), trace, (LEAST_OF_MASS, SIGMAS))?.is_some())
}

fn with_held_effects(base: &Base) -> Base {
    let mut all = base.clone();
    all.effects.iter_mut().for_each(|term| term.free.clear());
    all
}

/// By how much the centre of mass moved, and up to when (s) the flight was used; the base is then moved.
fn moved(base: &mut Base, trace: &Trace) -> Result<Option<([f64; 2], f64)>, PhysicsError> {
    let mut of_the_loading = ALL.iter().filter(|signature| signature.role.of_the_loading);
    let Some(&signature) = of_the_loading.next() else { return Ok(None) };
    let slots = signature.amounts;
    let mut all = base.clone();
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
    *base = all;
    Ok(Some((moved.into(), until_s)))
}

/// Mass beyond that of the base, kg, and up to when (s) the flight was used; `None` where it is less than a share of the mass or so many
/// standard errors, and where no vehicle lifts so much beyond its own mass, or is so much lighter.
fn heavier(
    base: &Base,
    trace: &Trace,
    (least, sigmas): (f64, f64),
) -> Result<Option<(f64, f64)>, PhysicsError> {
    let rows = Rows::new(std::slice::from_ref(trace), base)?;
    let Some(&first_s) = rows.time_s.first() else { return Ok(None) };
    let until_s = first_s + FIRST_S;
    let used: Vec<usize> = (0..rows.len()).filter(|&row| rows.time_s[row] < until_s).collect();
    let Some(MassByLift { step_kg, slopes, squares }) = mass_by_lift(&rows, &used) else { return Ok(None) };
    let mass_kg = base.vehicle.body.mass_kg;
    let Some((own_kg, factor)) = mass_after(mass_kg, step_kg) else { return Ok(None) };
    let slope = |row: usize| slopes[row];
    let mut blocks: Vec<(f64, f64)> = Vec::new();
    for &row in &used {
        let block = ((rows.time_s[row] - first_s) / BLOCK_S).floor();
        if blocks.last().is_none_or(|(last, _)| *last != block) {
            blocks.push((block, 0.0));
        }
        if let Some((_, score)) = blocks.last_mut() {
            *score += slope(row) * (rows.residual[2][row] - slope(row) * step_kg);
        }
    }
    let left = blocks.len().saturating_sub(1).max(1);
    let scatter =
        blocks.iter().map(|(_, score)| score * score).sum::<f64>() * blocks.len() as f64 / left as f64;
    let (more_kg, std_kg) = (own_kg - mass_kg, factor * scatter.sqrt() / squares);
    let is_payload = more_kg.abs() > sigmas * std_kg
        && more_kg.abs() > least * mass_kg
        && more_kg.abs() < PAYLOAD_SHARE * mass_kg;
    Ok(is_payload.then_some((more_kg, until_s)))
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
