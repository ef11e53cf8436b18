//! Torques of flights whose commands or body rates are logged too seldom to compare them row by row: averaged over seconds, they
//! still tell what acts always, such as a weak rotor or a centre of mass that is off.

use super::trace::Trace;
use std::ops::Range;

/// Time over which torques are averaged, s: at least sixteen samples of commands that are just fast enough for
/// forces.
const AVERAGED_S: f64 = 2.0;

/// Least number of such times in a flight, or torques are not compared at all. With fewer a mean torque is that of a
/// few gusts.
const LEAST_TIMES: f64 = 10.0;

impl Trace {
    /// Torques as they are compared, N m, body: row by row, or averaged where commands or body rates are slow.
    pub(super) fn torque_rows(&self, torque: [Vec<f64>; 3]) -> [Vec<f64>; 3] {
        match (self.torques, self.compares_torques()) {
            (true, _) => torque,
            (false, true) => averaged(torque, &self.runs, self.rows_apart_s()),
            (false, false) => torque.map(|axis| vec![0.0; axis.len()]),
        }
    }

    /// Whether torques are compared, row by row or averaged.
    pub(super) fn compares_torques(&self) -> bool {
        self.torques || is_long_enough(self.rows(), self.rows_apart_s())
    }

    fn rows_apart_s(&self) -> f64 {
        let apart = self.centers.windows(2).map(|pair| pair[1] - pair[0]).min();
        apart.unwrap_or_default() as f64 * self.grid.step_s
    }
}

/// Whether a flight of this many rows is long enough.
fn is_long_enough(rows: usize, apart_s: f64) -> bool {
    rows as f64 * apart_s >= LEAST_TIMES * AVERAGED_S
}

/// Each row's mean with those of the run around it, N m, body; nothing in runs that are shorter than the time. Rows are `apart_s` apart.
fn averaged(torque: [Vec<f64>; 3], runs: &[Range<usize>], apart_s: f64) -> [Vec<f64>; 3] {
    let is_within = |rows: &i32| apart_s > 0.0 && f64::from(*rows) * apart_s <= 0.5 * AVERAGED_S;
    let half = (1..).take_while(is_within).count();
    torque.map(|axis| running_mean(&axis, runs, half))
}

/// Mean over `half` rows on each side, fewer where a run begins or ends.
fn running_mean(values: &[f64], runs: &[Range<usize>], half: usize) -> Vec<f64> {
    let mut out = vec![0.0; values.len()];
    for run in runs.iter().filter(|run| run.len() > 2 * half) {
        let mut sums = vec![0.0];
        let mut sum = 0.0;
        for value in &values[run.clone()] {
            sum += value;
            sums.push(sum);
        }
        for row in 0..run.len() {
            let (from, to) = (row.saturating_sub(half), (row + half + 1).min(run.len()));
            out[run.start + row] = (sums[to] - sums[from]) / (to - from) as f64;
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mean_takes_as_many_rows_on_each_side_as_the_run_has() {
        let values = [1.0, 2.0, 3.0, 4.0, 100.0, 50.0];
        assert_eq!(running_mean(&values, &[0..4, 4..6], 0), values);
        // a run that is too short, or a row of none, is nothing
        assert_eq!(running_mean(&values, &[0..4, 4..6], 1), [1.5, 2.0, 3.0, 3.5, 0.0, 0.0]);
    }
}
