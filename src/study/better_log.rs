//! Which of two logs of one flight says more: what the radio brought, or what the vehicle wrote itself.

use std::path::{Path, PathBuf};

use crate::log::{self, OpenOptions};
use crate::recording::{Quantity, Recording, Stream};

/// A log that says more has commands or body rates so many times as often, and neither so many times more seldom (-).
const MORE: f64 = 1.2;
/// Times for which the vehicle was armed in both logs of one flight differ by no more than this factor (-).
const SAME_FLIGHT: f64 = 1.25;

/// The log to use, and why.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BetterLog {
    /// which
    pub path: PathBuf,
    /// it is the one that the vehicle wrote
    pub is_onboard: bool,
    /// in a sentence without its end
    pub why: String,
}

/// What matters of a log.
struct Rates {
    commands_hz: f64,
    body_rates_hz: f64,
    armed_s: f64,
}

fn rate_hz(stream: &Stream) -> f64 {
    let (Some(first), Some(last)) = (stream.time_s.first(), stream.time_s.last()) else { return 0.0 };
    if last > first { (stream.len() - 1) as f64 / (last - first) } else { 0.0 }
}

impl Rates {
    fn of(recording: &Recording) -> Self {
        let best = |quantity: Quantity| {
            let of = recording.streams.iter().filter(|(key, _)| key.quantity == quantity);
            of.map(|(_, stream)| rate_hz(stream)).fold(0.0, f64::max)
        };
        // commands that are there at all are rebuilt at the rate of the torque that was asked for
        let commands = best(Quantity::ActuatorCommand).max(best(Quantity::RotorSpeed));
        let commands_hz = if commands > 0.0 { commands.max(best(Quantity::TorqueSetpoint)) } else { 0.0 };
        Self { commands_hz, body_rates_hz: best(Quantity::AngularRate), armed_s: armed_s(recording) }
    }
}

/// Time for which the vehicle was armed, s.
fn armed_s(recording: &Recording) -> f64 {
    let of = recording.streams.iter().filter(|(key, _)| key.quantity == Quantity::Armed);
    let armed = of.map(|(_, stream)| stream).max_by_key(|stream| stream.len());
    let Some(armed) = armed else { return 0.0 };
    let span = |pair: usize| {
        let is = armed.sample(pair).first().is_some_and(|armed| *armed > 0.5);
        if is { armed.time_s[pair + 1] - armed.time_s[pair] } else { 0.0 }
    };
    (0..armed.len().saturating_sub(1)).map(span).sum()
}

/// Compares the log that the radio brought with the one that the vehicle wrote.
#[must_use]
pub fn better_log(radio: &Path, onboard: &Path) -> BetterLog {
    let stays = |why: String| BetterLog { path: radio.to_owned(), is_onboard: false, why };
    let open =
        |path: &Path| log::open(path, &OpenOptions::default()).map(|opened| Rates::of(&opened.recording));
    let own = match open(onboard) {
        Ok(own) => own,
        Err(error) => return stays(format!("the vehicle's own log cannot be read: {error}")),
    };
    let heard = match open(radio) {
        Ok(heard) => heard,
        Err(error) => {
            let why =
                format!("the recording of the link cannot be read ({error}), the vehicle's own log can");
            return BetterLog { path: onboard.to_owned(), is_onboard: true, why };
        }
    };
    let shares = own.armed_s / heard.armed_s;
    if !(1.0 / SAME_FLIGHT..=SAME_FLIGHT).contains(&shares) {
        return stays(format!(
            "the vehicle's own log is armed for {:.0} s, the recording of the link for {:.0} s: it is not of the same flight",
            own.armed_s, heard.armed_s
        ));
    }
    let rates = format!(
        "the vehicle's own log has commands at {:.0} Hz and body rates at {:.0} Hz, the recording of the link {:.0} and {:.0}",
        own.commands_hz, own.body_rates_hz, heard.commands_hz, heard.body_rates_hz
    );
    let shares = [own.commands_hz / heard.commands_hz, own.body_rates_hz / heard.body_rates_hz];
    // neither comes more seldom by as much, and one of them more often
    let is_more =
        shares.iter().all(|share| *share >= 1.0 / MORE) && shares.iter().any(|share| *share >= MORE);
    if !is_more {
        return stays(rates);
    }
    BetterLog { path: onboard.to_owned(), is_onboard: true, why: rates }
}
