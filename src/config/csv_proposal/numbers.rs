//! What the numbers of a table say of units and axes.

use crate::log::csv::TableHead;

use super::group::Group;

/// Values of some columns, row by row; NaN where a cell is empty.
pub(super) struct Numbers<'a> {
    head: &'a TableHead,
    columns: &'a [usize],
}

impl<'a> Numbers<'a> {
    /// Of a group's columns.
    pub fn of(head: &'a TableHead, group: &'a Group) -> Self {
        Self { head, columns: &group.columns }
    }

    /// Values of one of the columns.
    fn column(&self, slot: usize) -> impl Iterator<Item = f64> {
        let index = self.columns.get(slot).copied();
        self.head
            .rows
            .iter()
            .filter_map(move |row| row.get(index?).copied())
            .filter(|value| value.is_finite())
    }

    /// Mean of one of the columns; `None` without a value.
    pub fn mean(&self, slot: usize) -> Option<f64> {
        let (mut sum, mut count) = (0.0, 0.0);
        self.column(slot).for_each(|value| (sum, count) = (sum + value, count + 1.0));
        (count > 0.0).then(|| sum / count)
    }

    /// Mean magnitude of one of the columns.
    pub fn mean_size(&self, slot: usize) -> Option<f64> {
        let (mut sum, mut count) = (0.0, 0.0);
        self.column(slot).for_each(|value| (sum, count) = (sum + value.abs(), count + 1.0));
        (count > 0.0).then(|| sum / count)
    }

    /// Median over the rows of the norm over the columns.
    pub fn median_norm(&self) -> Option<f64> {
        let norm = |row: &Vec<f64>| {
            let squares: f64 =
                self.columns.iter().filter_map(|index| row.get(*index)).map(|value| value * value).sum();
            squares.sqrt()
        };
        median(self.head.rows.iter().map(norm).filter(|norm| norm.is_finite()).collect())
    }

    /// Greatest magnitude in any of the columns.
    pub fn greatest(&self) -> Option<f64> {
        let all = (0..self.columns.len()).flat_map(|slot| self.column(slot));
        all.map(f64::abs).reduce(f64::max)
    }

    /// Median of the steps of the first column from row to row.
    pub fn median_step(&self) -> Option<f64> {
        let values: Vec<f64> = self.column(0).collect();
        median(values.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| *step > 0.0).collect())
    }
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}
