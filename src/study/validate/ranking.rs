//! Which model predicts best over half a second.

use super::error_table::ErrorTable;
use super::result::ValidateStudy;
use crate::compare::improvement_percent;
use crate::diagnose::holdout::HALF_S;

/// Error of one quantity over windows of 0.5 s, root mean square over all flights.
#[derive(Debug, Clone, PartialEq)]
pub struct Prediction {
    /// quantity
    pub name: String,
    /// of the errors
    pub unit: String,
    /// one a model; `None` where a flight has none
    pub rms: Vec<Option<f64>>,
}

/// Models that differ by less in the mean predict equally well, percent: rounded to whole percents their errors read alike.
const ALIKE_PERCENT: f64 = 0.5;

/// What the best model beside the first predicts against the first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rank {
    /// errors are smaller
    Better,
    /// there is no difference
    Alike,
    /// errors are larger
    Worse,
}

impl Prediction {
    /// Error of a model over that of the first; NaN where there is none.
    #[must_use]
    pub fn over_first(&self, model: usize) -> f64 {
        match (self.rms[0], self.rms[model]) {
            (Some(first), Some(rms)) if first > 0.0 => rms / first,
            _ => f64::NAN,
        }
    }
}

impl ValidateStudy {
    /// How a model predicts against the first, by [`Self::mean_gain`].
    #[must_use]
    pub fn rank(&self, model: usize) -> Rank {
        match self.mean_gain(model) {
            mean if mean < -ALIKE_PERCENT => Rank::Worse,
            mean if mean < ALIKE_PERCENT => Rank::Alike,
            _ => Rank::Better,
        }
    }

    /// Errors of all flights over windows of 0.5 s, one entry a quantity.
    #[must_use]
    pub fn half_second(&self) -> Vec<Prediction> {
        let tables: Vec<&ErrorTable> = self
            .flights
            .iter()
            .flat_map(|flight| &flight.tables)
            .filter(|table| table.window_s.is_some_and(|window_s| (window_s - HALF_S).abs() < 1e-9))
            .collect();
        let Some(first) = tables.first() else { return Vec::new() };
        let over_flights = |row: usize, model: usize| {
            let each: Option<Vec<f64>> =
                tables.iter().map(|table| table.rows.get(row)?.rms.get(model).copied().flatten()).collect();
            let each = each?;
            let squares: f64 = each.iter().map(|rms| rms * rms).sum();
            Some((squares / each.len() as f64).sqrt())
        };
        let quantity = |(row, of): (usize, &super::ErrorRow)| Prediction {
            name: of.name.clone(),
            unit: of.unit.clone(),
            rms: (0..self.models.len()).map(|model| over_flights(row, model)).collect(),
        };
        first.rows.iter().enumerate().map(quantity).collect()
    }

    /// By how much a model's errors are smaller than the first model's: quantity and percent.
    #[must_use]
    pub fn gains(&self, model: usize) -> Vec<(String, f64)> {
        let gain = |of: Prediction| Some((of.name, improvement_percent(of.rms[0]?, of.rms[model]?)));
        self.half_second().into_iter().filter_map(gain).collect()
    }

    /// Mean of [`Self::gains`], percent; 0 where there are none.
    #[must_use]
    pub fn mean_gain(&self, model: usize) -> f64 {
        let gains = self.gains(model);
        gains.iter().map(|(_, percent)| percent).sum::<f64>() / gains.len().max(1) as f64
    }

    /// The model with the largest mean gain beside the first; `None` where no other has errors.
    #[must_use]
    pub fn best(&self) -> Option<usize> {
        (1..self.models.len())
            .filter(|model| self.is_predicted(*model))
            .max_by(|a, b| self.mean_gain(*a).total_cmp(&self.mean_gain(*b)))
    }

    /// A model has an error of some quantity.
    #[must_use]
    pub fn is_predicted(&self, model: usize) -> bool {
        self.half_second().iter().any(|of| of.rms.get(model).copied().flatten().is_some())
    }
}
