//! Which model predicts best over half a second.

use super::error_table::ErrorTable;
use super::result::ValidateStudy;
use crate::compare::improvement_percent;

/// Window of the errors that models are ranked by, s.
const WINDOW_S: f64 = 0.5;

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

impl ValidateStudy {
    /// Errors of all flights over windows of 0.5 s, one entry a quantity.
    #[must_use]
    pub fn half_second(&self) -> Vec<Prediction> {
        let tables: Vec<&ErrorTable> = self
            .flights
            .iter()
            .flat_map(|flight| &flight.tables)
            .filter(|table| table.window_s.is_some_and(|window_s| (window_s - WINDOW_S).abs() < 1e-9))
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
