//! The logging of a vehicle before a flight: what is set for it, and what is put back after it.

use std::time::Duration;

use mavid::autopilot::LogAwaited;
use mavid::fetch::Noted;
use mavid::onboard::{self, ChangedSince};
use mavid::text::parameter_value;
use mavid::wire::SystemId;

use super::link::open_as;
use super::prepare::{agreed, changes_page, earlier, expect_rates, put_back_page, restart_now};
use super::{hint, state};
use crate::cli::{FlyArgs, VehicleLinkArgs};
use crate::commands::words::Word;
use crate::commands::{CommandError, network, output};

/// A vehicle is waited for as long before a flight.
const BEFORE: Duration = Duration::from_secs(30);
/// One that has just flown is heard within this. A vehicle that listens for datagrams may hold the flight's address for 8 s of
/// silence (`LinkOptions::peer_timeout`, which the embedded one has); a heartbeat then comes within 1 s, and as long again is allowed.
pub(super) const AFTER: Duration = Duration::from_secs(12);

/// What was found before a flight.
#[derive(Debug, Default)]
pub struct BeforeFlight {
    /// the vehicle, where it was spoken to: it alone is flown
    pub system: Option<u32>,
    /// what is to be put back after the flight
    pub noted: Vec<Noted>,
    /// what an earlier run set, and counts only after a restart that has not come
    pub awaited: Vec<LogAwaited>,
}

/// The link of a flight to this vehicle.
pub fn link_of(args: &FlyArgs, system: Option<u32>) -> VehicleLinkArgs {
    VehicleLinkArgs {
        connect: args.connect.clone(),
        system_id: system,
        signing_key_file: args.signing_key_file.clone(),
    }
}

/// With `--set-logging`, sets what an identification needs, as long as the vehicle is disarmed. Otherwise it reminds of what
/// an earlier run left, and at a terminal puts it back where the user agrees; where it was decided before, `asks` is false.
///
/// # Errors
/// With `--set-logging`: the vehicle does not answer or take the values, or has to be restarted for them.
pub fn before_flight(args: &FlyArgs, asks: bool) -> Result<BeforeFlight, CommandError> {
    if args.set_logging {
        return network::block_on(set(args));
    }
    if !state::has_notes() {
        return Ok(BeforeFlight::default());
    }
    match network::block_on(reminded(args, asks)) {
        Err(error @ CommandError::Ended(_)) => Err(error),
        Err(error) => {
            output::warning(&format!("what an earlier run changed of the logging is not looked at: {error}"));
            Ok(BeforeFlight::default())
        }
        done => done,
    }
}

fn failed(error: impl std::fmt::Display) -> CommandError {
    CommandError::Failure(error.to_string())
}

async fn set(args: &FlyArgs) -> Result<BeforeFlight, CommandError> {
    let link = link_of(args, args.system_id);
    let mut session = open_as(&link, SystemId(args.station_id), BEFORE).await?;
    let offer = session.offer().await?;
    let notes = state::notes(&session.known_as(&offer))?;
    let prepared = onboard::look(&mut session, &notes).await?;
    expect_rates(&session, &prepared)?;
    let changes = &prepared.plan.changes;
    let what = changes_page(changes);
    if !changes.is_empty() {
        onboard::change(&mut session, &prepared, changes, &notes).await?;
    }
    let names: Vec<&str> = changes.iter().map(|change| change.parameter).collect();
    if onboard::needs_restart(&session, &names) {
        return Err(CommandError::Failure(format!(
            "not flown: {what} is set and counts after a restart of the autopilot: restart it (or have it restarted by mavid \
             log prepare --set-logging --restart), then give the same command again. Without a flight, {} puts it back",
            hint::restore(&link)
        )));
    }
    if !prepared.awaited.is_empty() {
        return Err(CommandError::Failure(format!(
            "not flown: {}. Then give the same command again. Without a flight, {} puts it back",
            restart_now(&prepared.awaited),
            hint::restore(&link)
        )));
    }
    if !prepared.unsure.is_empty() {
        output::warning(&format!(
            "It is not known whether the autopilot was restarted after {} was set. Without a restart the old setting is in \
             effect.",
            prepared.unsure.join(", ")
        ));
    }
    if !changes.is_empty() {
        let after = if args.keep_logging {
            "it stays so after the flight"
        } else {
            "it is put back after the flight"
        };
        output::message(&format!("logging: {what}; {after}"));
    }
    let noted = notes.read().map_err(failed)?;
    Ok(BeforeFlight { system: Some(session.vehicle.system.0), noted, awaited: Vec::new() })
}

async fn reminded(args: &FlyArgs, asks: bool) -> Result<BeforeFlight, CommandError> {
    let link = link_of(args, args.system_id);
    let mut session = open_as(&link, SystemId(args.station_id), BEFORE).await?;
    let offer = session.offer().await?;
    let notes = state::notes(&session.known_as(&offer))?;
    let mut before = BeforeFlight { system: Some(session.vehicle.system.0), ..BeforeFlight::default() };
    let noted = notes.read().map_err(failed)?;
    if noted.is_empty() {
        return Ok(before);
    }
    output::message(&earlier(&link, &noted));
    if asks && agreed("restore", "put it back now, before the flight")? {
        let put_back = onboard::put_back(&mut session, &notes, ChangedSince::Forgotten).await?;
        put_back_page(&put_back).lines().for_each(output::message);
    } else {
        before.awaited = onboard::look(&mut session, &notes).await?.awaited;
    }
    Ok(before)
}

/// After the flight, however it ended: puts back what was set for it. What cannot be put back is told with its values.
pub fn put_back(args: &FlyArgs, before: &BeforeFlight, tell: &mut impl FnMut(Word)) {
    if before.noted.is_empty() {
        return;
    }
    let link = link_of(args, before.system);
    if args.keep_logging {
        let (restore, all) = (hint::restore(&link), &before.noted);
        let stays = all.iter().map(|noted| format!("{} stays {}", noted.name, noted.set)).collect::<Vec<_>>();
        tell(Word::Message(format!(
            "logging: {} for a further flight; {restore} puts it back",
            stays.join(", ")
        )));
        return;
    }
    let done = network::block_on(async {
        let mut session = open_as(&link, SystemId(args.station_id), AFTER).await?;
        let offer = session.offer().await?;
        let notes = state::notes(&session.known_as(&offer))?;
        let put_back = onboard::put_back(&mut session, &notes, ChangedSince::Forgotten).await?;
        Ok((put_back_page(&put_back), put_back.failed.is_empty()))
    });
    match done {
        Ok((page, whole)) => {
            let word = if whole { Word::Message } else { Word::Warning };
            page.lines().for_each(|line| tell(word(format!("logging: {line}"))));
            if !whole {
                tell(Word::Warning(format!("later: {}", hint::restore(&link))));
            }
        }
        Err(error) => {
            let values = before.noted.iter().map(|noted| {
                format!(
                    "{} is {} and was {} before",
                    noted.name,
                    parameter_value(noted.set),
                    parameter_value(noted.found)
                )
            });
            tell(Word::Warning(format!(
                "the logging is not put back: {error}; {}; later: {}",
                values.collect::<Vec<_>>().join(", "),
                hint::restore(&link)
            )));
        }
    }
}
