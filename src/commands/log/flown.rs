//! The vehicle's own log of a flight that has just ended.

use std::path::{Path, PathBuf};
use std::time::Duration;

use mavid::fetch::Wanted;
use mavid::wire::SystemId;

use super::before::{AFTER, link_of};
use super::fetching::{self, words};
use super::session::{Flow, Session};
use crate::cli::{FlyArgs, VehicleLinkArgs};
use crate::commands::words::Word;
use crate::commands::{CommandError, network};

/// The speed of the link is measured for this long.
const MEASURED: Duration = Duration::from_secs(2);
/// A download without `--fetch-log` is made only if it takes no longer than this.
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

/// Fetches the log of the flight into its folder. Nothing of it makes a flight a failure: why there is no log is told.
pub fn after_flight(
    args: &FlyArgs,
    system: Option<SystemId>,
    fetching: Fetching,
    tell: &mut impl FnMut(Word),
) -> Option<PathBuf> {
    if fetching == Fetching::Not {
        return None;
    }
    let link = link_of(args, system.map(|system| system.0));
    let station = SystemId(args.station_id);
    let fetched = network::block_on(fetched((&link, station), &args.out, fetching, tell));
    fetched.unwrap_or_else(|error| {
        let why = format!("the vehicle's own log is not fetched: {error}; {}", later(&link));
        tell(if fetching == Fetching::Always { Word::Warning(why) } else { Word::Message(why) });
        None
    })
}

fn later(link: &VehicleLinkArgs) -> String {
    format!("later: mavid log fetch --connect {} --last", link.connect)
}

async fn fetched(
    (link, station): (&VehicleLinkArgs, SystemId),
    folder: &Path,
    fetching: Fetching,
    tell: &mut impl FnMut(Word),
) -> Result<Option<PathBuf>, CommandError> {
    let mut session = Session::open_as(link, station, AFTER).await?;
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
