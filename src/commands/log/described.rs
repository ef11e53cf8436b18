//! A first description of a vehicle on a link.

use mavid::draft::{Draft, Given};
use mavid::fetch::ReadParameters;
use mavid::study::draft_from_parameters;

use super::session::{Flow, Session};
use crate::cli::VehicleLinkArgs;
use crate::commands::{CommandError, network};

/// By its parameters; nothing but requests for these and heartbeats is sent.
pub fn drafted(link: &VehicleLinkArgs, given: &Given) -> Result<Draft, CommandError> {
    let parameters = network::block_on(async {
        let mut session = Session::open(link).await?;
        let names = session.stack.describing_parameters();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let failed = |error: mavid::fetch::FetchError| CommandError::Failure(error.to_string());
        let mut reading = ReadParameters::new(session.vehicle, &names).map_err(failed)?;
        session.talk(&mut reading, |_| Ok(Flow::On)).await?;
        Ok((session.vehicle.autopilot, reading.known().values()))
    });
    let (autopilot, values) = parameters?;
    if values.is_empty() {
        return Err(CommandError::Failure(format!(
            "{}: expected the vehicle's parameters, it answered for none",
            link.connect
        )));
    }
    Ok(draft_from_parameters(autopilot, values, given, &link.connect)?)
}
