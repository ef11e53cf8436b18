//! The parameters of a vehicle that a first description of it needs.

use std::collections::{BTreeMap, BTreeSet};

use mavid::autopilot::{Autopilot, Stack};
use mavid::fetch::ReadParameters;

use super::session::{Flow, Session};
use crate::cli::VehicleLinkArgs;
use crate::commands::{CommandError, network};

/// Asks the vehicle for what is `needed` of its parameters by what is known so far, until nothing more is. Nothing else is
/// sent but heartbeats.
pub fn of_vehicle(
    link: &VehicleLinkArgs,
    needed: impl Fn(&Stack, &BTreeMap<String, f64>) -> BTreeSet<String>,
) -> Result<(Autopilot, BTreeMap<String, f64>), CommandError> {
    network::block_on(async {
        let mut session = Session::open(link).await?;
        let (mut known, mut asked) = (BTreeMap::new(), BTreeSet::new());
        loop {
            let more: Vec<String> = needed(session.stack, &known).difference(&asked).cloned().collect();
            if more.is_empty() {
                return Ok((session.stack.autopilot, known));
            }
            let names: Vec<&str> = more.iter().map(String::as_str).collect();
            let mut reading = ReadParameters::new(session.vehicle, &names)
                .map_err(|error| CommandError::Failure(error.to_string()))?;
            session.talk(&mut reading, |_| Ok(Flow::On)).await?;
            let came = reading.known();
            known.extend(more.iter().filter_map(|name| Some((name.clone(), came.value(name)?))));
            asked.extend(more);
        }
    })
}
