//! One flight of a log.

use super::{InputFile, StudyError};
use crate::draft::actuator_of;
use crate::log::{Details, ReadReport};
use crate::recording::Recording;
use crate::signals::{ConditionSettings, OffMixer, Signals, condition};
use crate::text;
use crate::vehicle::{Actuator, Vehicle};
use std::path::Path;

/// Who wrote a log.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum LoggedBy {
    /// the vehicle itself
    Vehicle,
    /// a ground station: what the radio brought
    GroundStation,
    /// a table does not say
    Unknown,
}

impl LoggedBy {
    pub(super) fn of(report: &ReadReport) -> Self {
        match report.details {
            Details::Onboard(_) => Self::Vehicle,
            Details::Telemetry(_) => Self::GroundStation,
            Details::Table(_) | Details::None => Self::Unknown,
        }
    }
}

/// A flight and the log that it came from.
#[derive(Debug, Clone)]
pub(super) struct Flight {
    pub(super) logged_by: LoggedBy,
    pub(super) recording: Recording,
    /// when it began, microseconds since 1970 UTC, where its log says so
    pub(super) start_utc_us: Option<u64>,
    /// name, hash, losses
    pub(super) input: InputFile,
    /// outputs that left the mixer: the recording ends where the first did
    pub(super) off_mixer: Vec<OffMixer>,
    /// what its commands mean, where the vehicle is drafted and not stated
    pub(super) actuator: Option<Actuator>,
}

impl Flight {
    /// Its commands are read in the unit of its own log.
    pub(super) fn read_in_own_unit(&mut self) {
        self.actuator = Some(actuator_of(&self.recording));
    }

    /// Conditioned for a vehicle of this file.
    pub(super) fn conditioned(
        &self,
        (vehicle, file): (&Vehicle, &Path),
        settings: &ConditionSettings,
    ) -> Result<Signals, StudyError> {
        let own = self.actuator.filter(|own| *own != vehicle.propulsion.actuator).map(|actuator| {
            let mut vehicle = vehicle.clone();
            vehicle.propulsion.actuator = actuator;
            vehicle
        });
        condition(&self.recording, own.as_ref().unwrap_or(vehicle), settings).map_err(|source| {
            StudyError::Flight {
                flight: self.input.path.clone(),
                vehicle: text::path(&file),
                source: Box::new(source),
                losses: self.input.losses(),
            }
        })
    }
}
