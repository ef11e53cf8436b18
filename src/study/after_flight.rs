//! What follows every flight: its recording is identified and explained.

use std::path::{Path, PathBuf};

use crate::wire::SystemId;

use super::both_logs::each_flight_once;
use super::flights::{IDENTIFIED, load_all};
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

/// The logs of one flight, and why they are these.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FlightLogs {
    /// to be analysed together
    pub logs: Vec<PathBuf>,
    /// in a sentence without its end; `None` where there is only the recording of the link
    pub why: Option<String>,
}

impl FlightLogs {
    /// The recording of the link, together with the log that the vehicle wrote itself if they hold the same flight as
    /// [`identify`] and [`explain`] find it. Of both, each quantity comes from the better stream. If only one of them can be
    /// read, it is that one. Of long logs no more is held than for an identification.
    #[must_use]
    pub fn of(link: &Path, system: Option<SystemId>, onboard: Option<&Path>) -> Self {
        let alone = |path: &Path, why: Option<String>| Self { logs: vec![path.to_owned()], why };
        let Some(onboard) = onboard else { return alone(link, None) };
        let read = ReadSettings { csv_map: None, system };
        let flights = |path: &Path| load_all(&[path.to_owned()], &read, &IDENTIFIED);
        let own = match flights(onboard) {
            Ok(own) => own,
            Err(error) => {
                return alone(link, Some(format!("the vehicle's own log cannot be read: {error}")));
            }
        };
        let heard = match flights(link) {
            Ok(heard) => heard,
            Err(error) => {
                let why = format!(
                    "the recording of the link cannot be read ({error}), the vehicle's own log is analysed alone"
                );
                return alone(onboard, Some(why));
            }
        };
        let once = each_flight_once(own.into_iter().chain(heard).collect());
        if once.iter().flatten().all(|flight| flight.input.other_logs.is_empty()) {
            let why = "the vehicle's own log has another attitude than the recording of the link: it is not of this flight, and \
                       the recording is analysed alone";
            return alone(link, Some(why.to_owned()));
        }
        let why = "the recording of the link and the vehicle's own log are analysed together";
        Self { logs: vec![link.to_owned(), onboard.to_owned()], why: Some(why.to_owned()) }
    }
}

/// Identifies and explains the logs of one flight of the vehicle of this file, both with the settings that they have by
/// themselves. `system` is the vehicle's MAVLink system id; without it the only one of a recording that flew.
#[must_use]
pub fn after_flight(
    logs: &[PathBuf],
    vehicle: &Path,
    system: Option<SystemId>,
    progress: &dyn Progress,
) -> AfterFlight {
    let read = ReadSettings { csv_map: None, system };
    let to_identify = IdentifyRequest {
        logs: logs.to_vec(),
        vehicle: vehicle.to_owned().into(),
        read: read.clone(),
        ..IdentifyRequest::default()
    };
    let to_explain = ExplainRequest {
        logs: logs.to_vec(),
        vehicle: vehicle.to_owned().into(),
        read,
        transient_s: ExplainRequest::TRANSIENT_S,
        ..ExplainRequest::default()
    };
    AfterFlight { identified: identify(&to_identify, progress), explained: explain(&to_explain, progress) }
}
