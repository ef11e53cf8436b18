//! What follows every flight: its recording is identified and explained.

use std::path::{Path, PathBuf};

use crate::wire::SystemId;

use super::{
    ExplainRequest, ExplainStudy, IdentifyRequest, IdentifyStudy, Progress, ReadSettings, StudyError,
    explain, identify,
};

/// What a flight says; a part that it cannot say holds why.
#[derive(Debug)]
pub struct AfterFlight {
    /// mass and inertia
    pub identified: Result<IdentifyStudy, StudyError>,
    /// what the vehicle's file leaves out, shown on the end of the flight
    pub explained: Result<ExplainStudy, StudyError>,
}

/// Identifies and explains one recording of the vehicle of this file, both with the settings that they have by themselves.
/// `system` is the vehicle's MAVLink system id; without it the only one of the recording that flew.
#[must_use]
pub fn after_flight(
    recording: &Path,
    vehicle: &Path,
    system: Option<SystemId>,
    progress: &dyn Progress,
) -> AfterFlight {
    let logs: Vec<PathBuf> = vec![recording.to_owned()];
    let read = ReadSettings { csv_map: None, system };
    let to_identify = IdentifyRequest {
        logs: logs.clone(),
        vehicle: vehicle.to_owned().into(),
        read: read.clone(),
        ..IdentifyRequest::default()
    };
    let to_explain = ExplainRequest {
        logs,
        vehicle: vehicle.to_owned().into(),
        read,
        transient_s: ExplainRequest::TRANSIENT_S,
        ..ExplainRequest::default()
    };
    AfterFlight { identified: identify(&to_identify, progress), explained: explain(&to_explain, progress) }
}
