//! Torques of flights whose commands or body rates are logged too seldom to compare them row by row: averaged over seconds, they
//! still tell what acts always, such as a weak rotor or a centre of mass that is off.

use std::ops::Range;

/// Time over which torques are averaged, s: at least sixteen samples of commands that are just fast enough for forces. Chosen; not
/// measured.
const AVERAGED_S: f64 = 2.0;

/// Each row's mean with those of the run around it, N m, body. Rows are `apart_s` apart.
pub(super) fn averaged(torque: [Vec<f64>; 3], runs: &[Range<usize>], apart_s: f64) -> [Vec<f64>; 3] {
    let is_within = |rows: &i32| apart_s > 0.0 && f64::from(*rows) * apart_s <= 0.5 * AVERAGED_S;
    let half = (1..).take_while(is_within).count();
    torque.map(|axis| running_mean(&axis, runs, half))
}

/// Mean over `half` rows on each side, fewer where a run begins or ends.
fn running_mean(values: &[f64], runs: &[Range<usize>], half: usize) -> Vec<f64> {
    let mut out = vec![0.0; values.len()];
    for run in runs {
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
        assert_eq!(running_mean(&values, &[0..4, 4..6], 1), [1.5, 2.0, 3.0, 3.5, 75.0, 75.0]);
        // what belongs to no run is nothing
        assert_eq!(running_mean(&values, &[0..1, 1..2], 5), [1.0, 2.0, 0.0, 0.0, 0.0, 0.0]);
    }
}
