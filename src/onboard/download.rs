//! The download of one log, from the list to the file.

use std::path::{Path, PathBuf};
use std::time::Duration;

use super::{Flow, OnboardError, Session};
use crate::autopilot::Autopilot;
use crate::fetch::{self, Begun, Checked, Chosen, List, LogSelection, Offer, Part, Protocol, RemoteLog};

/// How far a download is.
#[derive(Debug, Clone)]
pub struct Progress {
    /// bytes that there are
    pub bytes: u64,
    /// and of how many
    pub of: u64,
    /// bytes a second, once they were measured by the way that stays
    pub bytes_s: Option<f64>,
    /// which way stays and why, once, where there was a choice
    pub chosen: Option<Chosen>,
}

/// The logs of a vehicle.
#[derive(Debug)]
pub struct Listed {
    /// how they were listed
    pub protocol: Protocol,
    /// oldest first
    pub logs: Vec<RemoteLog>,
    /// entries whose names cannot be those of files
    pub left_out: usize,
}

/// A log that was fetched.
#[derive(Debug)]
pub struct Download {
    /// where it is
    pub path: PathBuf,
    /// how it was checked
    pub checked: Checked,
    /// bytes of it
    pub bytes: u64,
    /// bytes that an earlier download had brought
    pub resumed: u64,
    /// time of this download
    pub took: Duration,
    /// the way by which its end came
    pub protocol: Protocol,
}

/// The logs of a vehicle. Where the file transfer was not asked for by name and does not work, by log messages.
///
/// # Errors
/// Neither way works, or those of [`Session::talk`].
pub async fn list(
    session: &mut Session,
    (offer, asked): (&Offer, Option<Protocol>),
    selection: LogSelection,
) -> Result<Listed, OnboardError> {
    let protocol = asked.unwrap_or_else(|| offer.protocol());
    match listed(session, protocol, selection).await {
        Err(error)
            if asked.is_none() && protocol == Protocol::Ftp && !error.is_end() && !error.is_input() =>
        {
            session.warn(format!("no file transfer: {error}; asking by log messages"));
            listed(session, Protocol::Log, selection).await
        }
        done => done,
    }
}

async fn listed(
    session: &mut Session,
    protocol: Protocol,
    selection: LogSelection,
) -> Result<Listed, OnboardError> {
    let mut list = List::new(session.vehicle, protocol, selection)?;
    session.talk(&mut list, |_| Ok(Flow::On)).await?;
    Ok(Listed { protocol, logs: list.logs(), left_out: list.left_out() })
}

/// Ending of the logs of an autopilot.
fn ending(autopilot: Autopilot) -> &'static str {
    if autopilot == Autopilot::Px4 { ".ulg" } else { ".bin" }
}

/// The log of which the folder holds a part; the last of them.
#[must_use]
pub fn begun<'a>(session: &Session, logs: &'a [RemoteLog], folder: &Path) -> Option<&'a RemoteLog> {
    let ending = ending(session.vehicle.autopilot);
    logs.iter().rfind(|log| Part::is_begun(folder, log, ending))
}

/// Fetches a log into a folder, which is there: by the protocol that listed it if one was asked for, by the faster one
/// otherwise. `None` where `watch` had enough: what came stays beside its place.
///
/// # Errors
/// The file cannot be written, or those of [`Session::talk`]. What came is kept.
pub async fn fetch(
    session: &mut Session,
    (offer, asked): (&Offer, Option<Protocol>),
    log: &RemoteLog,
    (out, watch): (&Path, &mut dyn FnMut(Progress) -> Flow),
) -> Result<Option<Download>, OnboardError> {
    let vehicle = session.known_as(offer);
    let mut part = Part::open(out, &vehicle, log, ending(session.vehicle.autopilot))?;
    let resumed = match part.begun() {
        Begun::Anew => 0,
        Begun::After(bytes) => bytes,
    };
    let began = session.elapsed();
    let mut download = match asked {
        Some(_) => fetch::Download::new(session.vehicle, log, part.length())?,
        None => fetch::Download::by_the_faster(session.vehicle, log, part.length())?,
    };
    let ended = session
        .talk(&mut download, |download| {
            part.append(&download.ready())?;
            Ok(watch(Progress {
                bytes: part.length(),
                of: download.size().unwrap_or(log.size),
                bytes_s: download.bytes_s(),
                chosen: download.chosen(),
            }))
        })
        .await;
    let fetched = download.fetched().filter(|_| matches!(ended, Ok(Flow::On)));
    let Some(fetched) = fetched else {
        session.say(&download.farewell(session.elapsed())).await;
        let (kept, of) = (part.length(), download.size().unwrap_or(log.size));
        return match ended {
            Ok(_) => Ok(None),
            Err(OnboardError::Ended(signal)) => Err(OnboardError::DownloadEnded { signal, kept, of }),
            Err(error) => Err(error),
        };
    };
    let took = session.elapsed().saturating_sub(began);
    let checked = part.check(&fetched)?;
    let path = part.finish()?;
    let protocol = download.protocol();
    Ok(Some(Download { path, checked, bytes: fetched.size, resumed, took, protocol }))
}
