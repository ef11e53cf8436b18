//! What one effect of a model does, over the state on which it depends: recorded and by the model.

use super::super::channels::{AXES, Nuisance};
use super::super::fit::Fitted;
use super::super::followed::Followed;
use super::super::signature::{EffectTerm, Growth};
use super::super::signatures::latency_kind;
use super::super::trace::Trace;
use super::states::{Bin, binned, binned_over};
use super::view::View;

/// A picture of one effect: what the rest of the model leaves of one channel, over a state.
#[derive(Debug, Clone, PartialEq)]
pub struct Portrait {
    /// identifier of the effect
    pub id: &'static str,
    /// index in [`super::super::CHANNEL_NAMES`]
    pub channel: usize,
    /// the abscissa
    pub state: Followed,
    /// N or N m: recorded less the model without this effect, in bins of the state; of a latency the other way round, commanded less needed
    pub recorded: Vec<Bin>,
    /// N or N m: what the effect itself does, in the same bins
    pub model: Vec<Bin>,
}

/// The picture of an effect of a fitted model; `None` where the model does not hold it.
#[must_use]
pub fn portrait(traces: &[Trace], fitted: &Fitted, id: &'static str) -> Option<Portrait> {
    if latency_kind(id).is_some() {
        return of_latency(traces, fitted, id);
    }
    let mut column = 0;
    for term in &fitted.base.effects {
        if term.id() == id {
            return of_term(traces, fitted, (term, column));
        }
        column += term.free.len();
    }
    None
}

/// What a lag or a delay does: rotors that follow late give the torque that was commanded before, so what is commanded is beyond what the
/// motion needs by the latency times the rate of change of that. To first order, as the fit has it.
fn of_latency(traces: &[Trace], fitted: &Fitted, id: &'static str) -> Option<Portrait> {
    let view = View::new(traces, fitted)?;
    let nuisances = &fitted.rows.nuisances;
    let (place, column) =
        nuisances.iter().enumerate().find(|(_, column)| column.nuisance == Nuisance::Latency)?;
    let (coefficients, _) = fitted.weighted.coefficients(&fitted.rows);
    let latency_s = fitted.base.latency.total_s();
    // the column is what is left of the torque per second, so that the rate of change has the other sign
    let rate = |axis: usize| -> Vec<f64> { (0..view.len()).map(|row| -column.at(axis, row)).collect() };
    let size = |axis: &usize| {
        let energy: f64 = (0..view.len()).map(|row| column.at(*axis, row).powi(2)).sum();
        energy / fitted.weighted.sigma[*axis].powi(2).max(f64::MIN_POSITIVE)
    };
    let channel = (3..AXES).max_by(|a, b| size(a).total_cmp(&size(b)))?;
    let rate = rate(channel);
    if rate.iter().all(|value| *value == 0.0) {
        return None;
    }
    let part: Vec<f64> = rate.iter().map(|rate| latency_s * rate).collect();
    let by_s = latency_s + coefficients[place];
    let recorded: Vec<f64> =
        view.residual[channel].iter().zip(&rate).map(|(left, rate)| by_s * rate - left).collect();
    let state = Followed::TorqueRate(channel - 3);
    Some(Portrait {
        id,
        channel,
        state,
        recorded: binned_over(&view, (state, &rate), &recorded, channel),
        model: binned_over(&view, (state, &rate), &part, channel),
    })
}

fn of_term(traces: &[Trace], fitted: &Fitted, (term, column): (&EffectTerm, usize)) -> Option<Portrait> {
    let view = View::new(traces, fitted)?;
    let picture = term.signature.picture;
    let parts = picture.of.iter().map(|&channel| (channel, contribution(fitted, (term, column), channel)));
    let size = |(channel, part): &(usize, Vec<f64>)| {
        let energy: f64 = part.iter().map(|value| value * value).sum();
        energy / fitted.weighted.sigma[*channel].powi(2).max(f64::MIN_POSITIVE)
    };
    let (channel, part) = parts
        .filter(|(channel, part)| *channel < AXES && part.len() == view.len())
        .max_by(|a, b| size(a).total_cmp(&size(b)))?;
    if part.iter().all(|value| *value == 0.0) {
        return None;
    }
    let rotor = term.signature.role.which.and_then(|slot| {
        (0..fitted.base.vehicle.rotors.len()).find(|&rotor| (rotor as f64 - term.values[slot]).abs() < 0.5)
    });
    let wanted = picture.over.state(channel, rotor);
    let varies = view.states.iter().any(|(state, _)| *state == wanted);
    let state = if varies { wanted } else { Followed::Time };
    let step = step_of(fitted, (term, column), channel);
    let recorded: Vec<f64> = view.residual[channel]
        .iter()
        .zip(&part)
        .zip(&step)
        .map(|((left, of), step)| left + of + step)
        .collect();
    Some(Portrait {
        id: term.id(),
        channel,
        state,
        recorded: binned(&view, state, &recorded, channel)?,
        model: binned(&view, state, &part, channel)?,
    })
}

/// What the residual itself would change of the effect, row by row. What is left has it projected off; without it the picture would
/// agree with the model whatever was recorded.
fn step_of(fitted: &Fitted, (term, first): (&EffectTerm, usize), channel: usize) -> Vec<f64> {
    let (coefficients, _) = fitted.weighted.coefficients(&fitted.rows);
    let mut sum = vec![0.0; fitted.rows.len()];
    for (place, slot) in term.free.iter().enumerate() {
        let Some(column) = fitted.rows.effects.get(first + place) else { continue };
        if term.signature.amounts.contains(slot) {
            let by = coefficients[fitted.rows.nuisances.len() + first + place];
            sum.iter_mut().zip(&column[channel]).for_each(|(sum, value)| *sum += by * value);
        }
    }
    sum
}

/// What an effect does to a channel, row by row: the columns of its amounts times their distance from nothing.
fn contribution(fitted: &Fitted, (term, first): (&EffectTerm, usize), channel: usize) -> Vec<f64> {
    let signature = term.signature;
    let mut sum = vec![0.0; fitted.rows.len()];
    for (place, &slot) in term.free.iter().enumerate() {
        let Some(column) = fitted.rows.effects.get(first + place) else { continue };
        let amount = match signature.growth {
            _ if !signature.amounts.contains(&slot) => continue,
            Growth::Proportional => term.values[slot] - signature.nothing,
            // the slope of `k / v` times `-v` is `k / v`
            Growth::Inverse { .. } => -term.values[slot],
        };
        sum.iter_mut().zip(&column[channel]).for_each(|(sum, value)| *sum += amount * value);
    }
    sum
}
