//! The vehicle that the arguments name, on its link.

use std::collections::{BTreeMap, BTreeSet};
use std::time::Duration;

use mavid::autopilot::{Autopilot, Stack};
use mavid::link::{LinkOptions, Signing};
use mavid::onboard::{Session, SessionRequest, read_as_needed};
use mavid::wire::SystemId;

use crate::cli::VehicleLinkArgs;
use crate::commands::{CommandError, network, output};

/// A vehicle that is not heard within this is not there.
pub const PATIENCE: Duration = Duration::from_secs(30);

/// Opens the link and waits for the vehicle; one that is armed is refused. A host that refuses is not waited for.
pub async fn open(args: &VehicleLinkArgs) -> Result<Session, CommandError> {
    begin(args, LinkOptions::default(), PATIENCE).await
}

/// The same for a vehicle that has to be heard within this time: its host may still refuse.
pub(super) async fn open_patiently(
    args: &VehicleLinkArgs,
    patience: Duration,
) -> Result<Session, CommandError> {
    begin(args, LinkOptions { patient: true, ..LinkOptions::default() }, patience).await
}

/// The same by this station, for a vehicle that has to be heard within this time: its host may still refuse.
pub(super) async fn open_as(
    args: &VehicleLinkArgs,
    station: SystemId,
    patience: Duration,
) -> Result<Session, CommandError> {
    begin(args, LinkOptions { system: station, patient: true, ..LinkOptions::default() }, patience).await
}

async fn begin(
    args: &VehicleLinkArgs,
    options: LinkOptions,
    patience: Duration,
) -> Result<Session, CommandError> {
    let address = network::address("--connect", &args.connect)?;
    let signing = args.signing_key_file.as_deref().map(Signing::open).transpose();
    let signing = signing.map_err(|error| CommandError::Input(error.to_string()))?;
    output::signing_warnings(signing.as_ref());
    let mut signals = network::Signals::new()?;
    let interrupt = async move { signals.next().await.map_or_else(|why| why.to_string(), str::to_owned) };
    let request = SessionRequest {
        address,
        options: LinkOptions { signing, ..options },
        system: args.system_id.map(SystemId),
        patience,
        interrupt: Box::pin(interrupt),
        tell: output::note,
    };
    Ok(Session::open(request).await?)
}

/// What a vehicle answered.
#[derive(Debug, Clone)]
pub struct Answered {
    /// its MAVLink system id
    pub system: u32,
    /// whose parameters they are
    pub autopilot: Autopilot,
    /// by name, in the autopilot's own unit
    pub parameters: BTreeMap<String, f64>,
}

/// What is `needed` of the vehicle's parameters, as [`read_as_needed`] asks for it. `found` is called before the first is read.
pub fn parameters_of_vehicle(
    link: &VehicleLinkArgs,
    found: impl FnOnce(SystemId, Autopilot),
    needed: impl Fn(&Stack, &BTreeMap<String, f64>) -> BTreeSet<String>,
) -> Result<Answered, CommandError> {
    network::block_on(async {
        let mut session = open(link).await?;
        found(session.vehicle.system, session.stack.autopilot);
        let parameters = read_as_needed(&mut session, needed).await?;
        let (system, autopilot) = (session.vehicle.system.0, session.stack.autopilot);
        Ok(Answered { system, autopilot, parameters })
    })
}
