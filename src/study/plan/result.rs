//! What a planned flight is.

use crate::config::{StoredTrajectory, StoredTransitions};
use crate::note::Note;
use crate::plan::{Assessment, Criterion, Extremes, HOVER_S, Margin, PARAMETERS};
use crate::trajectory::{FlightPath, FourierTrajectory};
use crate::units::deg_from_rad;
use crate::vehicle::{Limits, Vehicle};
use serde::Serialize;

/// What a planned flight is.
#[derive(Debug)]
pub struct PlanStudy {
    /// one period
    pub series: FourierTrajectory,
    /// how many periods are flown
    pub repeats: u32,
    /// what the flight is to keep
    pub limits: Limits,
    /// what it is worth
    pub assessment: Assessment,
    /// what was minimised
    pub criterion: Criterion,
    /// the criterion's value; `None` where nothing was searched
    pub criterion_value: Option<f64>,
    /// from takeoff to the series and back; `None` where no transition keeps the limits
    pub transitions: Option<StoredTransitions>,
    /// of the whole flight from takeoff to landing; `None` where no transition keeps the limits
    pub flown: Option<FlightExtremes>,
    /// the first bound that is broken
    pub first_violation: Option<String>,
    /// what is to be known of the files
    pub notes: Vec<Note>,
}

/// The box round a flight and its extremes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct FlightExtremes {
    /// least x, y, z
    pub low_m: [f64; 3],
    /// greatest x, y, z
    pub high_m: [f64; 3],
    /// along the ground
    pub horizontal_speed_m_s: f64,
    /// up or down
    pub vertical_speed_m_s: f64,
    /// from level
    pub tilt_deg: f64,
}

impl FlightExtremes {
    pub(super) fn of(path: &FlightPath, vehicle: &Vehicle) -> Self {
        let extremes = Extremes::of(path, vehicle);
        Self {
            low_m: extremes.low_m,
            high_m: extremes.high_m,
            horizontal_speed_m_s: extremes.horizontal_speed_m_s,
            vertical_speed_m_s: extremes.up_speed_m_s.max(extremes.down_speed_m_s),
            tilt_deg: deg_from_rad(extremes.tilt_rad),
        }
    }
}

impl PlanStudy {
    /// What is left to each bound on 2 ms samples, SI, by name.
    pub fn margins(&self) -> impl Iterator<Item = (String, f64)> {
        let name = |margin: &Margin| {
            format!("{}_{}", margin.quantity.name(), if margin.upper { "max" } else { "min" })
        };
        self.assessment.check.margins.iter().map(move |margin| (name(margin), margin.spare()))
    }

    /// s from the hover after takeoff to the one before landing, both with [`HOVER_S`], as `fly` flies it; `None` where no transition
    /// keeps the limits.
    #[must_use]
    pub fn hover_to_hover_s(&self) -> Option<f64> {
        let around = self.transitions?;
        let series_s = self.series.period_s * f64::from(self.repeats);
        Some(HOVER_S + around.to_start_s + series_s + around.to_landing_s + HOVER_S)
    }

    /// Relative standard errors of what the flight will determine, by parameter; `None` where it cannot determine all
    /// seven.
    #[must_use]
    pub fn standard_errors(&self) -> Option<Vec<(&'static str, f64)>> {
        Some(PARAMETERS.into_iter().zip(self.assessment.standard_errors?).collect())
    }

    /// As the file of a trajectory.
    #[must_use]
    pub fn stored(&self) -> StoredTrajectory {
        let errors = self.standard_errors().unwrap_or_default().into_iter();
        StoredTrajectory {
            series: self.series.clone(),
            repeats: self.repeats,
            limits: self.limits,
            criterion: self.criterion_value.map(|value| (self.criterion.name().to_owned(), value)),
            margins: self.margins().collect(),
            standard_errors: errors.map(|(name, value)| (name.to_owned(), value)).collect(),
            transitions: self.transitions,
        }
    }
}
