//! The vehicle's own log of a flight that has just ended.

use std::path::{Path, PathBuf};
use std::time::Duration;

use mavid::fetch::Wanted;
use mavid::wire::SystemId;

use super::fetching::{self, words};
use super::session::{Flow, Session};
use super::{preparing, state};
use crate::cli::{FlyArgs, VehicleLinkArgs};
use crate::commands::words::Word;
use crate::commands::{CommandError, network};

/// A vehicle that has just flown is heard within this.
const HEARD_WITHIN: Duration = Duration::from_secs(8);
/// So long it is measured how fast the link is.
const MEASURED: Duration = Duration::from_secs(2);
/// A download that nobody asked for takes no longer.
const AT_MOST: Duration = Duration::from_secs(60);

/// How a log is fetched after a flight.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fetching {
    /// not at all
    Not,
    /// where the link is fast enough
    IfFast,
    /// however long it takes
    Always,
}

impl Fetching {
    /// By the arguments.
    pub fn of(args: &FlyArgs) -> Self {
        match (args.fetch_log, args.no_fetch_log) {
            (true, _) => Self::Always,
            (false, true) => Self::Not,
            (false, false) => Self::IfFast,
        }
    }
}

fn link(args: &FlyArgs, system: Option<SystemId>) -> VehicleLinkArgs {
    VehicleLinkArgs {
        connect: args.connect.clone(),
        system_id: system.map_or(args.system_id, |system| Some(system.0)),
        signing_key_file: args.signing_key_file.clone(),
    }
}

/// Sets what the vehicle logs, if that is asked for, and says what an earlier run has not put back. A change that counts only
/// after a restart of the autopilot ends the run: nothing restarts it unasked.
pub fn before_flight(args: &FlyArgs, tell: &mut impl FnMut(Word)) -> Result<(), CommandError> {
    if !args.set_logging {
        if state::has_notes() {
            let text = "an earlier run changed what a vehicle logs, and has not put it back: if it is this vehicle, it is put \
                        back after the flight";
            tell(Word::Message(text.to_owned()));
        }
        return Ok(());
    }
    network::block_on(set_logging(&link(args, None), tell))
}

async fn set_logging(link: &VehicleLinkArgs, tell: &mut impl FnMut(Word)) -> Result<(), CommandError> {
    let mut session = Session::open(link).await?;
    let offer = session.offer().await?;
    let notes = state::notes(&session.known_as(&offer))?;
    let prepared = preparing::look(&mut session).await?;
    let changes = &prepared.plan.changes;
    if changes.is_empty() {
        tell(Word::Message("the vehicle logs what an identification needs".to_owned()));
        return Ok(());
    }
    preparing::change(&mut session, &prepared, changes, &notes).await?;
    let set: Vec<String> = changes
        .iter()
        .map(|change| format!("{} from {} to {}", change.parameter, change.found, change.wanted))
        .collect();
    let place = mavid::text::path(&notes.path());
    let done =
        format!("set for the log of this flight: {}; what was found stands in {place}", set.join(", "));
    let names: Vec<&str> = changes.iter().map(|change| change.parameter).collect();
    if preparing::needs_restart(&session, &names) {
        return Err(CommandError::Failure(format!(
            "{done}. The autopilot takes it only when it starts: restart it, then give the same command again. Nothing was armed"
        )));
    }
    tell(Word::Message(done));
    Ok(())
}

/// Fetches the log of the flight into its folder, and puts back what was changed of the logging. Nothing of it makes a
/// flight a failure: why there is no log is told.
pub fn after_flight(
    args: &FlyArgs,
    system: Option<SystemId>,
    fetching: Fetching,
    tell: &mut impl FnMut(Word),
) -> Option<PathBuf> {
    let link = link(args, system);
    let path = match fetching {
        Fetching::Not => None,
        _ => network::block_on(fetched(&link, &args.out, fetching, tell)).unwrap_or_else(|error| {
            let later = later(&link);
            tell(Word::Warning(format!("the vehicle's own log is not fetched: {error}; {later}")));
            None
        }),
    };
    if state::has_notes() {
        network::block_on(put_back(&link, tell)).unwrap_or_else(|error| {
            let later = format!("later: mavid log prepare --connect {} --restore", link.connect);
            tell(Word::Warning(format!("what was changed of the logging is not put back: {error}; {later}")));
        });
    }
    path
}

/// Puts back what was changed of this vehicle's logging.
async fn put_back(link: &VehicleLinkArgs, tell: &mut impl FnMut(Word)) -> Result<(), CommandError> {
    let mut session = Session::open_within(link, HEARD_WITHIN).await?;
    let offer = session.offer().await?;
    let notes = state::notes(&session.known_as(&offer))?;
    let noted = notes.read().map_err(|error| CommandError::Input(error.to_string()))?;
    if noted.is_empty() {
        return Ok(());
    }
    let put_back = preparing::put_back(&mut session, &notes).await?;
    let names: Vec<&str> = put_back.done.iter().map(|noted| noted.name.as_str()).collect();
    let restart = preparing::needs_restart(&session, &names);
    for line in super::prepare::put_back_page(&put_back, restart).lines() {
        tell(Word::Message(line.to_owned()));
    }
    Ok(())
}

fn later(link: &VehicleLinkArgs) -> String {
    format!("later: mavid log fetch --connect {} --last", link.connect)
}

async fn fetched(
    link: &VehicleLinkArgs,
    folder: &Path,
    fetching: Fetching,
    tell: &mut impl FnMut(Word),
) -> Result<Option<PathBuf>, CommandError> {
    let mut session = Session::open_within(link, HEARD_WITHIN).await?;
    let offer = session.offer().await?;
    let (_, logs, _) = fetching::list(&mut session, (&offer, None), Wanted::Last).await?;
    let mut path = None;
    match logs.last() {
        None => tell(Word::Message("the vehicle wrote no log of its own".to_owned())),
        Some(log) => {
            let (began, mut first, mut told) = (session.elapsed(), None, false);
            let clock = session.clock();
            let mut watch = |bytes: u64, of: u64| {
                let now = clock.elapsed();
                let first = *first.get_or_insert(bytes);
                let passed = now.saturating_sub(began);
                if told || passed < MEASURED {
                    return Flow::On;
                }
                told = true;
                let rate = (bytes - first) as f64 / passed.as_secs_f64();
                let left_s = if rate > 0.0 { (of - bytes.min(of)) as f64 / rate } else { f64::INFINITY };
                let is_slow = fetching == Fetching::IfFast && left_s > AT_MOST.as_secs_f64();
                let size = format!("{:.1} MB at {:.0} kB/s", of as f64 / 1e6, rate / 1e3);
                if is_slow {
                    tell(Word::Message(format!(
                        "the vehicle's own log would take {left_s:.0} s ({size}): it is not fetched without --fetch-log; {}",
                        later(link)
                    )));
                    return Flow::Stop;
                }
                tell(Word::Message(format!("fetching the vehicle's own log, {size}: about {left_s:.0} s")));
                Flow::On
            };
            let done = fetching::fetch(&mut session, &offer, log, (folder, &mut watch)).await?;
            if let Some(done) = done {
                let took = done.took.as_secs_f64();
                tell(Word::Message(format!(
                    "the vehicle's own log: {}, {:.1} MB in {took:.1} s; {}",
                    mavid::text::path(&done.path),
                    done.bytes as f64 / 1e6,
                    words(done.checked)
                )));
                path = Some(done.path);
            }
        }
    }
    Ok(path)
}
