//! Rows of one state of the rotor, put together: what a stand writes many times a second is no independent measurement.

/// States that are told apart over the range of a test. More would split a state by its noise, fewer would merge two.
const STEPS: usize = 25;
/// Rows of a state that differ from its median by so many times their usual distance are outliers. Normal errors do
/// not reach it.
const OUTLYING: f64 = 6.0;

/// Means over rows of about the same state.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Steps {
    /// one a state and column
    pub means: Vec<Vec<f64>>,
    /// rows that were left out as outliers
    pub outliers: usize,
    /// rows that were used
    pub rows: usize,
}

impl Steps {
    /// Puts together the rows by their first column; the last is that whose outliers are left out. Rows with an empty cell are
    /// not used.
    pub(super) fn of(columns: &[&[f64]]) -> Self {
        let count = columns.first().map_or(0, |column| column.len());
        let row = |index: usize| -> Vec<f64> { columns.iter().map(|column| column[index]).collect() };
        let rows: Vec<Vec<f64>> =
            (0..count).map(row).filter(|row| row.iter().all(|value| value.is_finite())).collect();
        let by = |pick: fn(f64, f64) -> f64, start: f64| rows.iter().map(|row| row[0]).fold(start, pick);
        let (least, most) = (by(f64::min, f64::INFINITY), by(f64::max, f64::NEG_INFINITY));
        let width = (most - least) / STEPS as f64;
        let mut bins: Vec<Vec<&Vec<f64>>> = vec![Vec::new(); STEPS];
        for row in &rows {
            let place = if width > 0.0 { (row[0] - least) / width } else { 0.0 };
            let index = (0..STEPS).rev().find(|index| place >= *index as f64).unwrap_or(0);
            bins[index].push(row);
        }
        let mut steps = Self { means: vec![Vec::new(); columns.len()], ..Self::default() };
        for bin in bins.iter_mut().filter(|bin| !bin.is_empty()) {
            let before = bin.len();
            without_outliers(bin);
            steps.outliers += before - bin.len();
            steps.rows += bin.len();
            for (column, means) in steps.means.iter_mut().enumerate() {
                means.push(bin.iter().map(|row| row[column]).sum::<f64>() / bin.len() as f64);
            }
        }
        steps
    }

    pub(super) fn len(&self) -> usize {
        self.means.first().map_or(0, Vec::len)
    }
}

/// The last column of a state runs along with the first: outliers are those of their ratio.
fn without_outliers(bin: &mut Vec<&Vec<f64>>) {
    if bin.len() < 5 {
        return;
    }
    let ratio = |row: &Vec<f64>| row.last().copied().unwrap_or(0.0);
    let middle = median(bin.iter().map(|row| ratio(row)).collect());
    let usual = median(bin.iter().map(|row| (ratio(row) - middle).abs()).collect()) * 1.4826;
    // quantised values may all be one
    let most = OUTLYING * usual.max(0.01 * middle.abs());
    bin.retain(|row| (ratio(row) - middle).abs() <= most);
}

pub(super) fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_of_a_state_are_one_and_an_outlier_is_none() {
        let command: Vec<f64> = (0..100).map(|row| f64::from(row / 10)).collect();
        let mut thrust: Vec<f64> = command.iter().map(|command| 2.0 * command + 1.0).collect();
        thrust[55] = 900.0;
        thrust[3] = f64::NAN;
        let steps = Steps::of(&[&command, &thrust]);
        assert_eq!((steps.len(), steps.outliers, steps.rows), (10, 1, 98));
        assert_eq!(steps.means[1][5], 11.0);
        assert_eq!(Steps::of(&[&[], &[]]).len(), 0);
    }
}
