//! Weighted columns over the rows of all channels, without the zeros around what they hold.
//!
//! The column of a knot has values in a short part of a flight only. A long flight has many of them, and products over all
//! rows would cost the square of its length.

use super::channels::{CHANNELS, Channels, NuisanceColumn};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use std::ops::Range;

/// Sums that [`dot`] runs side by side.
const LANES: usize = 8;
/// Places of a convolution whose sums run side by side.
const PLACES: usize = 16;

/// Columns over `channels` times `rows` values, channel after channel.
#[derive(Debug, Clone)]
pub(super) struct Columns {
    rows: usize,
    columns: Vec<Vec<Piece>>,
}

/// What a column holds in one channel; zero before and after.
#[derive(Debug, Clone)]
struct Piece {
    channel: usize,
    /// row of the first value
    first: usize,
    values: Vec<f64>,
}

impl Columns {
    /// Nuisances, then the effects of the base, each channel divided by its `sigma` (N, N m); `rows` rows a channel.
    pub(super) fn weighted(
        nuisances: &[NuisanceColumn],
        effects: &[Channels],
        sigma: &[f64; CHANNELS],
        rows: usize,
    ) -> Self {
        let of = |values: &Channels, first: usize| -> Vec<Piece> {
            let each = values.iter().zip(sigma).enumerate().filter(|(_, (_, sigma))| **sigma > 0.0);
            each.filter_map(|(channel, (values, sigma))| {
                let mut piece = Piece::trimmed(channel, first, values)?;
                let weight = 1.0 / sigma;
                piece.values.iter_mut().for_each(|value| *value *= weight);
                Some(piece)
            })
            .collect()
        };
        let nuisances = nuisances.par_iter().map(|column| of(&column.values, column.first_row));
        let columns = nuisances.chain(effects.par_iter().map(|column| of(column, 0))).collect();
        Self { rows, columns }
    }

    /// The columns of a matrix with `rows` rows a channel.
    pub(super) fn of(matrix: &DMatrix<f64>, rows: usize) -> Self {
        let pieces = |column: &[f64]| -> Vec<Piece> {
            let channels = column.chunks_exact(rows.max(1)).enumerate();
            channels.filter_map(|(channel, values)| Piece::trimmed(channel, 0, values)).collect()
        };
        Self { rows, columns: matrix.column_iter().map(|column| pieces(column.as_slice())).collect() }
    }

    /// Number of columns.
    pub(super) fn len(&self) -> usize {
        self.columns.len()
    }

    /// Sum of a column's squares.
    pub(super) fn norm_squared(&self, index: usize) -> f64 {
        self.columns[index].iter().map(|piece| dot(&piece.values, &piece.values)).sum()
    }

    /// The products of each two columns.
    pub(super) fn products(&self) -> Products {
        let of = |(index, column): (usize, &Vec<Piece>)| -> Vec<[f64; CHANNELS]> {
            self.columns[..=index].iter().map(|known| shared_by_channel(column, known)).collect()
        };
        Products(self.columns.par_iter().enumerate().map(of).collect())
    }

    /// Each channel times its factor.
    pub(super) fn scaled(mut self, factors: &[f64; CHANNELS]) -> Self {
        for piece in self.columns.iter_mut().flatten() {
            let factor = factors[piece.channel];
            piece.values.iter_mut().for_each(|value| *value *= factor);
        }
        self
    }

    /// `X' y`.
    pub(super) fn transposed_times(&self, y: &[f64]) -> DVector<f64> {
        let along = |piece: &Piece| {
            let first = piece.channel * self.rows + piece.first;
            dot(&piece.values, &y[first..first + piece.values.len()])
        };
        let each = self.columns.iter().map(|column| column.iter().map(along).sum());
        DVector::from_iterator(self.len(), each)
    }

    /// `X' Y`.
    pub(super) fn transposed_times_each(&self, columns: &DMatrix<f64>) -> DMatrix<f64> {
        let mut out = DMatrix::zeros(self.len(), columns.ncols());
        for (mut to, column) in out.column_iter_mut().zip(columns.column_iter()) {
            to.copy_from(&self.transposed_times(column.as_slice()));
        }
        out
    }

    /// `X theta`.
    pub(super) fn times(&self, theta: &DVector<f64>) -> DVector<f64> {
        let mut out = DVector::zeros(CHANNELS * self.rows);
        let all = out.as_mut_slice();
        for (column, share) in self.columns.iter().zip(theta) {
            for piece in column {
                let first = piece.channel * self.rows + piece.first;
                let part = &mut all[first..first + piece.values.len()];
                part.iter_mut().zip(&piece.values).for_each(|(to, value)| *to += share * value);
            }
        }
        out
    }

    /// Score of each row: each column times the residual, summed over the channels. Columns of one channel.
    pub(super) fn scores(&self, residual: &[f64]) -> Self {
        let of = |column: &Vec<Piece>| -> Vec<Piece> {
            let first = column.iter().map(|piece| piece.first).min();
            let end = column.iter().map(Piece::end).max();
            let Some((first, end)) = first.zip(end) else { return Vec::new() };
            let mut values = vec![0.0; end - first];
            for piece in column {
                let left = &residual[piece.channel * self.rows + piece.first..];
                let to = &mut values[piece.first - first..];
                for ((to, value), left) in to.iter_mut().zip(&piece.values).zip(left) {
                    *to += value * left;
                }
            }
            vec![Piece { channel: 0, first, values }]
        };
        Self { rows: self.rows, columns: self.columns.iter().map(of).collect() }
    }

    /// One row a column, of its first channel.
    pub(super) fn transposed(&self) -> DMatrix<f64> {
        let mut out = DMatrix::zeros(self.len(), self.rows);
        for (index, column) in self.columns.iter().enumerate() {
            for piece in column.iter().filter(|piece| piece.channel == 0) {
                for (row, value) in (piece.first..).zip(&piece.values) {
                    out[(index, row)] = *value;
                }
            }
        }
        out
    }

    /// `sum_c sum_|l|<=L w_c(l) sum_t x_c(t) x_c(t+l)'`, where no pair of rows spans a break between the runs of the channel;
    /// `weights` has for each channel one weight a lag, from 0 to L.
    pub(super) fn correlated(&self, weights: &[Vec<f64>], runs: &[Vec<Range<usize>>]) -> DMatrix<f64> {
        let windows: Vec<Vec<f64>> = weights
            .iter()
            .map(|weights| weights.iter().skip(1).rev().chain(weights).copied().collect())
            .collect();
        self.with_smeared(|piece| {
            Some(piece.smeared(runs.get(piece.channel)?, windows.get(piece.channel)?.len() / 2, |values| {
                convolved(values, &windows[piece.channel])
            }))
        })
    }

    /// The same with Bartlett's weights, `1 - |l| / (L + 1)`, for columns of one channel.
    pub(super) fn correlated_by_bartlett(&self, lags: usize, runs: &[Range<usize>]) -> DMatrix<f64> {
        self.with_smeared(|piece| {
            Some(piece.smeared(runs, lags, |values| {
                // a triangle is a box along a box
                let mut twice = boxed(&boxed(values, lags + 1), lags + 1);
                twice.iter_mut().for_each(|value| *value /= lags as f64 + 1.0);
                twice
            }))
        })
    }

    /// Products of each column, smeared, with each other one.
    fn with_smeared(&self, smeared: impl Fn(&Piece) -> Option<Piece> + Sync) -> DMatrix<f64> {
        let along = |column: &Vec<Piece>| -> Vec<f64> {
            let smeared: Vec<Piece> = column.iter().filter_map(&smeared).collect();
            self.columns.iter().map(|other| shared(&smeared, other)).collect()
        };
        let parts: Vec<Vec<f64>> = self.columns.par_iter().map(along).collect();
        DMatrix::from_fn(self.len(), self.len(), |i, j| 0.5 * (parts[i][j] + parts[j][i]))
    }
}

/// Products of each two columns, of each channel by itself; of two the one with the greater index comes first.
pub(super) struct Products(Vec<Vec<[f64; CHANNELS]>>);

impl Products {
    /// `X' X` of columns of which each channel is the given ones' times its factor.
    pub(super) fn gram(&self, factors: &[f64; CHANNELS]) -> DMatrix<f64> {
        let Self(all) = self;
        let mut out = DMatrix::zeros(all.len(), all.len());
        for (index, row) in all.iter().enumerate() {
            for (other, by_channel) in row.iter().enumerate() {
                let each = by_channel.iter().zip(factors);
                let product: f64 = each.map(|(product, factor)| product * factor.powi(2)).sum();
                (out[(index, other)], out[(other, index)]) = (product, product);
            }
        }
        out
    }
}

impl Piece {
    /// The values from the first to the last that is not zero; `None` where all are zero.
    fn trimmed(channel: usize, first: usize, values: &[f64]) -> Option<Self> {
        let from = values.iter().position(|value| *value != 0.0)?;
        let to = values.iter().rposition(|value| *value != 0.0)? + 1;
        Some(Self { channel, first: first + from, values: values[from..to].to_vec() })
    }

    fn end(&self) -> usize {
        self.first + self.values.len()
    }

    /// At each row the sum over the rows of its run that are at most `lags` away, weighted: `spread` has the whole convolution of
    /// some values with the weights, which begins `lags` rows before them.
    fn smeared(&self, runs: &[Range<usize>], lags: usize, spread: impl Fn(&[f64]) -> Vec<f64>) -> Self {
        let (from, to) = (self.first.saturating_sub(lags), self.end() + lags);
        let mut values = vec![0.0; to - from];
        for run in runs {
            let held = run.start.max(self.first)..run.end.min(self.end());
            if held.is_empty() {
                continue;
            }
            let spread = spread(&self.values[held.start - self.first..held.end - self.first]);
            let rows = run.start.max(held.start.saturating_sub(lags))..run.end.min(held.end + lags);
            let reached = &spread[rows.start + lags - held.start..rows.end + lags - held.start];
            values[rows.start - from..rows.end - from].copy_from_slice(reached);
        }
        Self { channel: self.channel, first: from, values }
    }
}

/// Convolution of values with a symmetric window of odd length: one value for each place at which they overlap.
fn convolved(values: &[f64], window: &[f64]) -> Vec<f64> {
    let reach = window.len() - 1;
    let count = values.len() + reach;
    // whole groups of places, with nothing before and after the values
    let groups = count.div_ceil(PLACES);
    let mut padded = vec![0.0; groups * PLACES + reach];
    padded[reach..reach + values.len()].copy_from_slice(values);
    let mut out = Vec::with_capacity(groups * PLACES);
    for group in 0..groups {
        let mut sums = [0.0; PLACES];
        for (weight, place) in window.iter().zip(group * PLACES..) {
            let Some(near) = padded[place..].first_chunk::<PLACES>() else { break };
            sums.iter_mut().zip(near).for_each(|(sum, value)| *sum += weight * value);
        }
        out.extend_from_slice(&sums);
    }
    out.truncate(count);
    out
}

/// Sums over `width` neighbouring values: one for each place at which they overlap.
fn boxed(values: &[f64], width: usize) -> Vec<f64> {
    let mut sums = Vec::with_capacity(values.len() + 1);
    let mut sum = 0.0;
    sums.push(sum);
    sums.extend(values.iter().map(|value| {
        sum += value;
        sum
    }));
    let until = |place: usize| sums[(place + 1).min(values.len())];
    let before = |place: usize| sums[(place + 1).saturating_sub(width)];
    (0..values.len() + width - 1).map(|place| until(place) - before(place)).collect()
}

/// Product of two columns.
fn shared(a: &[Piece], b: &[Piece]) -> f64 {
    shared_by_channel(a, b).iter().sum()
}

/// The same, of each channel.
fn shared_by_channel(a: &[Piece], b: &[Piece]) -> [f64; CHANNELS] {
    let mut sums = [0.0; CHANNELS];
    for one in a {
        for other in b.iter().filter(|other| other.channel == one.channel) {
            let (first, end) = (one.first.max(other.first), one.end().min(other.end()));
            if first < end {
                let (of_one, of_other) = (first - one.first, first - other.first);
                let length = end - first;
                sums[one.channel] +=
                    dot(&one.values[of_one..of_one + length], &other.values[of_other..of_other + length]);
            }
        }
    }
    sums
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; LANES];
    let (a, b) = (a.chunks_exact(LANES), b.chunks_exact(LANES));
    let rest: f64 = a.remainder().iter().zip(b.remainder()).map(|(a, b)| a * b).sum();
    for (a, b) in a.zip(b) {
        for (sum, (a, b)) in sums.iter_mut().zip(a.iter().zip(b)) {
            *sum += a * b;
        }
    }
    sums.iter().sum::<f64>() + rest
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test ends where it fails")]
    use super::*;

    const ROWS: usize = 60;

    /// Three columns over two channels; the second has values in a short part of one channel only.
    fn columns() -> DMatrix<f64> {
        DMatrix::from_fn(CHANNELS * ROWS, 3, |index, column| {
            let (channel, row) = (index / ROWS, index % ROWS);
            let value = ((7 * index + 13 * column) % 17) as f64 - 8.0;
            match (column, channel) {
                (1, 1) if (20..27).contains(&row) => value,
                (0, 0 | 1) | (2, 1) => value,
                _ => 0.0,
            }
        })
    }

    #[test]
    fn products_are_those_of_the_whole_matrix() {
        let matrix = columns();
        let short = Columns::of(&matrix, ROWS);
        assert_eq!(short.columns[1].iter().map(|piece| piece.values.len()).sum::<usize>(), 7);
        let theta = DVector::from_vec(vec![0.5, -2.0, 3.0]);
        let y = matrix.column(0) + matrix.column(2);
        assert!((short.products().gram(&[1.0; CHANNELS]) - matrix.tr_mul(&matrix)).amax() < 1e-9);
        let factors = [2.0; CHANNELS];
        let scaled = short.clone().scaled(&factors);
        assert!((short.products().gram(&factors) - scaled.products().gram(&[1.0; CHANNELS])).amax() < 1e-9);
        assert!((short.times(&theta) - &matrix * &theta).amax() < 1e-9);
        assert!((short.transposed_times(y.as_slice()) - matrix.tr_mul(&y)).amax() < 1e-9);
        assert!((short.transposed_times_each(&matrix) - matrix.tr_mul(&matrix)).amax() < 1e-9);
        assert!((short.norm_squared(1) - matrix.column(1).norm_squared()).abs() < 1e-9);
    }

    #[test]
    fn pairs_of_rows_within_reach_count_unless_a_break_is_between() {
        let matrix = columns();
        let (runs, weights) = (vec![0..24, 24..60], vec![vec![1.0, 0.5, 0.25]; CHANNELS]);
        let mut expected = DMatrix::<f64>::zeros(3, 3);
        for (channel, run) in (0..CHANNELS).flat_map(|channel| runs.iter().map(move |run| (channel, run))) {
            for (t, s) in run.clone().flat_map(|t: usize| run.clone().map(move |s| (t, s))) {
                let Some(weight) = weights[channel].get(t.abs_diff(s)) else { continue };
                let (a, b) = (matrix.row(channel * ROWS + t), matrix.row(channel * ROWS + s));
                expected += a.transpose() * b * *weight;
            }
        }
        let found = Columns::of(&matrix, ROWS).correlated(&weights, &vec![runs; CHANNELS]);
        assert!((&found - &expected).amax() < 1e-9, "{found} {expected}");
    }

    #[test]
    fn bartletts_weights_fall_along_a_line() {
        let matrix = columns();
        let one_channel = DMatrix::from_fn(CHANNELS * ROWS, 3, |index, column| {
            if index < ROWS { matrix[(index, 0)] * (1.0 + column as f64) + column as f64 } else { 0.0 }
        });
        let (columns, runs) = (Columns::of(&one_channel, ROWS), vec![0..24, 24..60]);
        for lags in [1, 5, 40, 100] {
            let weights = (0..=lags).map(|lag| 1.0 - f64::from(lag) / (f64::from(lags) + 1.0)).collect();
            let expected = columns.correlated(&[weights], std::slice::from_ref(&runs));
            let found = columns.correlated_by_bartlett(usize::try_from(lags).unwrap(), &runs);
            assert!((&found - &expected).amax() < 1e-9 * expected.amax(), "{found} {expected}");
        }
    }

    #[test]
    fn scores_are_summed_over_the_channels() {
        let matrix = columns();
        let residual = DVector::from_fn(CHANNELS * ROWS, |index, _| (index % 5) as f64);
        let found = Columns::of(&matrix, ROWS).scores(residual.as_slice()).transposed();
        for (column, row) in [(0, 3), (1, 22), (2, 59)] {
            let expected: f64 = (0..CHANNELS)
                .map(|channel| matrix[(channel * ROWS + row, column)] * residual[channel * ROWS + row])
                .sum();
            assert!((found[(column, row)] - expected).abs() < 1e-12);
        }
    }
}
