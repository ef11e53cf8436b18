//! Dependence of the residual on states: binned means with bands, ranked by analysis of variance. An additive model
//! removes marginal confounding.

use super::super::followed::Followed;
use super::view::View;
use crate::stats::{f_tail, median, quantile, resamples};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// Number of bins of a state, each with the same number of rows. Only what is shown depends on it.
const BINS: usize = 12;
/// Number of bootstrap samples of the flight behind a band. Only the width of a drawn band depends on it, by a
/// twentieth.
const RESAMPLES: usize = 200;
/// Knots of an additive spline. The penalty, not their number, gives the smoothness.
const KNOTS: usize = 10;
/// Largest number of states in the additive model. More cannot be shown to a reader.
const MOST_STATES: usize = 4;
/// p-value, over all states and channels, below which a state enters the additive model. Only what is shown depends
/// on it.
const ENTER_P: f64 = 0.01;
/// Least number of rows of a replicate in a bin. Only what is shown depends on it.
const LEAST_ROWS: usize = 3;
/// Seed of the bootstrap, so that results are repeatable.
const SEED: u64 = 0x6c6f_6361_7465;

/// One bin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bin {
    /// mean of the state
    pub center: f64,
    /// mean residual, N or N m
    pub mean: f64,
    /// 95 % band by resampling replicates
    pub low: f64,
    /// 95 % band by resampling replicates
    pub high: f64,
}

/// Dependence of one channel's residual on one state.
#[derive(Debug, Clone, PartialEq)]
pub struct Follow {
    /// index in [`super::super::CHANNEL_NAMES`]
    pub channel: usize,
    /// which state
    pub state: Followed,
    /// F statistic of the analysis of variance over the bins, with the flight's replicates
    pub f: f64,
    /// p-value of F
    pub p_value: f64,
    /// share of the channel's residual energy that the bins explain beyond chance (0..1)
    pub share: f64,
    /// F without the part of the other states of the additive model
    pub partial_f: f64,
    /// its p-value
    pub partial_p: f64,
    /// share of the energy that is then explained
    pub partial_share: f64,
    /// place in which it entered the additive model (0 first)
    pub entered: Option<usize>,
    /// bins along the state
    pub bins: Vec<Bin>,
    /// value of the state at which the mean residual is farthest from its median over the bins
    pub peak_at: f64,
}

/// A state cut into bins, each row with its replicate.
struct Cut<'a> {
    state: Followed,
    values: &'a [f64],
    bin: Vec<usize>,
    block: &'a [usize],
    blocks: usize,
    knots: Vec<f64>,
}

/// All channels against all states.
pub(super) fn follow(view: &View) -> Vec<Follow> {
    let cuts: Vec<Cut> = view.states.iter().map(|(state, values)| cut(view, *state, values)).collect();
    (0..view.residual.len())
        .into_par_iter()
        .flat_map_iter(|channel| of_channel(&cuts, channel, &view.residual[channel]))
        .collect()
}

fn cut<'a>(view: &'a View, state: Followed, values: &'a [f64]) -> Cut<'a> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    let mut bin = vec![0; values.len()];
    for (rank, &row) in order.iter().enumerate() {
        bin[row] = rank * BINS / values.len();
    }
    let last = values.len() - 1;
    let mut knots: Vec<f64> = (0..KNOTS).map(|knot| values[order[knot * last / (KNOTS - 1)]]).collect();
    knots.dedup_by(|a, b| *a - *b <= 1e-9 * a.abs().max(1e-9));
    let block = if state.is_slow() { &view.short_blocks } else { &view.blocks };
    Cut { state, values, bin, block, blocks: block.last().map_or(0, |last| last + 1), knots }
}

/// F, its p-value, and the share of energy explained beyond chance.
fn variance_ratio(cut: &Cut, residual: &[f64]) -> (f64, f64, f64) {
    let mut sums = vec![(0.0, 0usize); cut.blocks * BINS];
    for ((&bin, &block), value) in cut.bin.iter().zip(cut.block).zip(residual) {
        let cell = &mut sums[block * BINS + bin];
        cell.0 += value;
        cell.1 += 1;
    }
    let used: Vec<(usize, f64, f64)> = sums
        .iter()
        .enumerate()
        .filter(|(_, (_, count))| *count >= LEAST_ROWS)
        .map(|(cell, (sum, count))| (cell % BINS, sum / *count as f64, *count as f64))
        .collect();
    let mut bins = [(0.0, 0.0, 0usize); BINS];
    for (bin, mean, weight) in &used {
        bins[*bin].0 += mean * weight;
        bins[*bin].1 += weight;
        bins[*bin].2 += 1;
    }
    let total: f64 = bins.iter().map(|b| b.1).sum();
    if total <= 0.0 {
        return (0.0, 1.0, 0.0);
    }
    let grand = bins.iter().map(|b| b.0).sum::<f64>() / total;
    let filled = bins.iter().filter(|b| b.2 > 0).count();
    let between: f64 = bins.iter().filter(|b| b.1 > 0.0).map(|b| b.1 * (b.0 / b.1 - grand).powi(2)).sum();
    let within: f64 =
        used.iter().map(|(bin, mean, w)| w * (mean - bins[*bin].0 / bins[*bin].1).powi(2)).sum();
    let (free_between, free_within) =
        (filled.saturating_sub(1) as f64, used.len().saturating_sub(filled) as f64);
    if free_between < 1.0 || free_within < 4.0 || within <= 0.0 {
        return (0.0, 1.0, 0.0);
    }
    let noise = within / free_within;
    let f = between / free_between / noise;
    let p = f_tail(f, (free_between, free_within));
    let energy: f64 = residual.iter().map(|v| v * v).sum();
    let share = (between - free_between * noise).max(0.0) / energy.max(f64::MIN_POSITIVE);
    (f, p, share.min(1.0))
}

fn of_channel(cuts: &[Cut], channel: usize, residual: &[f64]) -> Vec<Follow> {
    let plain: Vec<(f64, f64, f64)> = cuts.iter().map(|cut| variance_ratio(cut, residual)).collect();
    let (entered, parts) = additive(cuts, residual, &plain);
    let all: Vec<f64> = sum_but(&parts, None, residual.len());
    let left: Vec<f64> = residual.iter().zip(&all).map(|(r, fit)| r - fit).collect();
    cuts.iter()
        .enumerate()
        .map(|(index, cut)| {
            let place = entered.iter().position(|&state| state == index);
            let partial = place.map_or_else(
                || variance_ratio(cut, &left),
                |place| {
                    let others = sum_but(&parts, Some(place), residual.len());
                    let own: Vec<f64> = residual.iter().zip(&others).map(|(r, fit)| r - fit).collect();
                    variance_ratio(cut, &own)
                },
            );
            let bins = bins(cut, residual, channel);
            Follow {
                channel,
                state: cut.state,
                f: plain[index].0,
                p_value: plain[index].1,
                share: plain[index].2,
                partial_f: partial.0,
                partial_p: partial.1,
                partial_share: partial.2,
                entered: place,
                peak_at: peak(&bins),
                bins,
            }
        })
        .collect()
}

/// States in the order in which they enter, and each one's part of the fit.
fn additive(cuts: &[Cut], residual: &[f64], plain: &[(f64, f64, f64)]) -> (Vec<usize>, Vec<Vec<f64>>) {
    let (mut entered, mut parts): (Vec<usize>, Vec<Vec<f64>>) = (Vec::new(), Vec::new());
    let mut ratios = plain.to_vec();
    while entered.len() < MOST_STATES {
        let enter_p = ENTER_P / (6 * cuts.len().max(1)) as f64;
        let best = (0..cuts.len())
            .filter(|index| !entered.contains(index) && ratios[*index].1 < enter_p)
            .max_by(|&a, &b| ratios[a].2.total_cmp(&ratios[b].2));
        let Some(best) = best else { break };
        entered.push(best);
        let Some(fitted) = fit_together(cuts, &entered, residual) else {
            entered.pop();
            break;
        };
        parts = fitted;
        let all = sum_but(&parts, None, residual.len());
        let left: Vec<f64> = residual.iter().zip(&all).map(|(r, fit)| r - fit).collect();
        ratios = cuts.iter().map(|cut| variance_ratio(cut, &left)).collect();
    }
    (entered, parts)
}

fn sum_but(parts: &[Vec<f64>], but: Option<usize>, rows: usize) -> Vec<f64> {
    let mut out = vec![0.0; rows];
    for (_, part) in parts.iter().enumerate().filter(|(index, _)| Some(*index) != but) {
        out.iter_mut().zip(part).for_each(|(sum, value)| *sum += value);
    }
    out
}

/// Fits piecewise linear functions of all states at once. A small ridge divides the part that states have in common.
fn fit_together(cuts: &[Cut], entered: &[usize], residual: &[f64]) -> Option<Vec<Vec<f64>>> {
    if entered.iter().any(|&state| cuts[state].knots.len() < 2) {
        return None;
    }
    let offsets: Vec<usize> = entered
        .iter()
        .scan(0, |at, &state| {
            let from = *at;
            *at += cuts[state].knots.len();
            Some(from)
        })
        .collect();
    let size: usize = entered.iter().map(|&state| cuts[state].knots.len()).sum();
    let hats: Vec<Vec<(usize, f64)>> = entered.iter().map(|&state| hats(&cuts[state])).collect();
    let mut normal = DMatrix::<f64>::zeros(size, size);
    let mut right = DVector::<f64>::zeros(size);
    for (row, value) in residual.iter().enumerate() {
        let mut touched = [(0usize, 0.0); 2 * MOST_STATES];
        for (index, (hats, offset)) in hats.iter().zip(&offsets).enumerate() {
            let (knot, share) = hats[row];
            touched[2 * index] = (offset + knot, 1.0 - share);
            touched[2 * index + 1] = (offset + knot + 1, share);
        }
        let touched = &touched[..2 * entered.len()];
        for (i, a) in touched {
            right[*i] += a * value;
            for (j, b) in touched {
                normal[(*i, *j)] += a * b;
            }
        }
    }
    let ridge = 1e-3 * normal.trace() / size as f64;
    for index in 0..size {
        normal[(index, index)] += ridge;
    }
    let theta = normal.cholesky()?.solve(&right);
    Some(
        hats.iter()
            .zip(&offsets)
            .map(|(hats, offset)| {
                hats.iter()
                    .map(|(knot, share)| {
                        theta[offset + knot] * (1.0 - share) + theta[offset + knot + 1] * share
                    })
                    .collect()
            })
            .collect(),
    )
}

/// For each row the knot below and the share of the knot above.
fn hats(cut: &Cut) -> Vec<(usize, f64)> {
    let knots = &cut.knots;
    cut.values
        .iter()
        .map(|value| {
            let above = knots.partition_point(|knot| knot <= value).clamp(1, knots.len() - 1);
            let (low, high) = (knots[above - 1], knots[above]);
            (above - 1, ((value - low) / (high - low)).clamp(0.0, 1.0))
        })
        .collect()
}

/// The mean of a channel in bins of a state that varies, with bands; `None` for a state that is not in the view.
pub(super) fn binned(view: &View, state: Followed, of_channel: &[f64], channel: usize) -> Option<Vec<Bin>> {
    let (_, values) = view.states.iter().find(|(of, _)| *of == state)?;
    Some(binned_over(view, (state, values), of_channel, channel))
}

/// The same over values of a state that the view need not hold, one a row.
pub(super) fn binned_over(
    view: &View,
    (state, values): (Followed, &[f64]),
    of_channel: &[f64],
    channel: usize,
) -> Vec<Bin> {
    bins(&cut(view, state, values), of_channel, channel)
}

/// Mean residual of each bin with its band.
fn bins(cut: &Cut, residual: &[f64], channel: usize) -> Vec<Bin> {
    let mut sums = vec![(0.0, 0.0); cut.blocks * BINS];
    let mut centers = [(0.0, 0.0); BINS];
    for (row, (&bin, &block)) in cut.bin.iter().zip(cut.block).enumerate() {
        let cell = &mut sums[block * BINS + bin];
        cell.0 += residual[row];
        cell.1 += 1.0;
        centers[bin].0 += cut.values[row];
        centers[bin].1 += 1.0;
    }
    let stream = SEED ^ (channel as u64) << 8 ^ cut.values.len() as u64;
    let mut drawn: Vec<Vec<f64>> = vec![Vec::new(); BINS];
    for picks in resamples(cut.blocks, RESAMPLES, stream) {
        let mut totals = [(0.0, 0.0); BINS];
        for block in picks {
            for (total, cell) in totals.iter_mut().zip(&sums[block * BINS..(block + 1) * BINS]) {
                total.0 += cell.0;
                total.1 += cell.1;
            }
        }
        for (drawn, (sum, count)) in drawn.iter_mut().zip(totals).filter(|(_, total)| total.1 > 0.0) {
            drawn.push(sum / count);
        }
    }
    (0..BINS)
        .map(|bin| {
            let (sum, count) = (0..cut.blocks)
                .map(|block| sums[block * BINS + bin])
                .fold((0.0, 0.0), |a, b| (a.0 + b.0, a.1 + b.1));
            let drawn = &mut drawn[bin];
            drawn.sort_by(f64::total_cmp);
            let mean = sum / f64::max(count, 1.0);
            let at = |permille: usize| quantile(drawn, (permille, 1000)).unwrap_or(mean);
            let center = centers[bin].0 / f64::max(centers[bin].1, 1.0);
            Bin { center, mean, low: at(25), high: at(975) }
        })
        .collect()
}

/// State at which the mean is farthest from the bins' median.
fn peak(bins: &[Bin]) -> f64 {
    let mut means: Vec<f64> = bins.iter().map(|bin| bin.mean).collect();
    let median = median(&mut means);
    bins.iter()
        .max_by(|a, b| (a.mean - median).abs().total_cmp(&(b.mean - median).abs()))
        .map_or(0.0, |bin| bin.center)
}

#[cfg(test)]
mod tests {
    use super::super::view::tests::{synthetic, white};
    use super::*;

    #[test]
    fn the_state_that_is_followed_comes_first_and_takes_its_shadow_along() {
        let noise = white(2);
        let place = |t: f64| (0.9 * t).sin() + 0.3 * (0.4 * t).cos();
        let bump = |t: f64| (-0.5 * ((place(t) + 0.3) / 0.2).powi(2)).exp();
        let view = synthetic(|i, t| 2.0 * noise[i] + bump(t), None, (Followed::WorldX, &place));
        let follows = follow(&view);
        let first = follows.iter().find(|f| f.channel == 2 && f.entered == Some(0)).unwrap();
        assert_eq!(first.state, Followed::WorldX);
        assert!((first.peak_at + 0.3).abs() < 0.15, "{}", first.peak_at);
        assert!(first.partial_share > 0.3, "{}", first.partial_share);
        let at_peak = first.bins.iter().find(|bin| bin.center == first.peak_at).unwrap();
        assert!(at_peak.low < at_peak.mean && at_peak.mean < at_peak.high);
    }

    #[test]
    fn noise_follows_nothing() {
        let mut entered = 0;
        for seed in 0..10 {
            let noise = white(seed);
            let view = synthetic(|i, _| noise[i], None, (Followed::WorldX, &|t| (0.9 * t).sin()));
            entered += follow(&view).iter().filter(|f| f.entered.is_some()).count();
        }
        assert!(entered <= 1, "{entered}");
    }
}
