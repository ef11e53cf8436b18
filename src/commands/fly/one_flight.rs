//! The flight itself: from the arguments to the recording and the vehicle's own log, before anything is made of them.

use std::io::IsTerminal;
use std::path::PathBuf;
use std::sync::mpsc::Receiver;

use mavid::fly::view::ViewModel;
use mavid::fly::{Ending, Record};
use mavid::wire::{Nonce, SystemId};

use super::ride::{asks_for_the_word, is_drawn, ride};
use super::watch::{View, Watch, fly_it, watch};
use super::words::words;
use crate::cli::FlyArgs;
use crate::commands::CommandError;
use crate::commands::live::Work;
use crate::commands::log::{self, Fetching};
use crate::commands::standard_error::StandardError;
use crate::commands::words::{Word, Words};

/// Messages and log lines while the view is shown, in the folder of the flight.
pub const LOG: &str = "log.txt";

/// Who watches a flight in place of the view or the lines.
type Watches = Box<dyn FnOnce(&Receiver<ViewModel>) + Send>;

/// How a flight differs from that of a person's own vehicle.
#[derive(Default)]
pub struct Manner {
    /// the vehicle that this program started: it alone is armed, whatever the arguments say
    pub own: Option<Nonce>,
    /// watches in place of the view or the lines
    pub watches: Option<Watches>,
    /// it is the simulated twin of the vehicle, and so it is said
    pub is_twin: bool,
    /// what becomes of the logging was decided before
    pub decided: bool,
}

/// A flight that is over.
#[derive(Debug)]
pub struct FlightRun {
    /// what was flown
    pub record: Record,
    /// the vehicle's own log, where it was fetched
    pub onboard: Option<PathBuf>,
    /// says what is still to be said
    pub said: Words,
    /// what became of the view
    pub view: View,
}

/// Flies by these arguments: checks, sets the logging, flies, puts the logging back, and fetches the vehicle's own log.
///
/// # Errors
/// The arguments cannot be used, or the vehicle or the machine failed before the flight.
pub fn one_flight(
    (stderr, work): (&StandardError, &Work),
    args: &FlyArgs,
    manner: Manner,
) -> Result<FlightRun, CommandError> {
    let drawn = is_drawn(args);
    if stderr.is_quiet() && !drawn && asks_for_the_word(args) {
        let expected =
            "--quiet: expected --yes with --arm and --plain: with --quiet nothing asks for the word";
        return Err(CommandError::Input(expected.to_owned()));
    }
    let mut ride = ride(args)?;
    if manner.own.is_some() {
        (ride.sortie.own_vehicle, ride.sortie.may_arm) = (manner.own, false);
    }
    ride.sortie.settings.is_twin = manner.is_twin;
    if args.set_logging {
        // a signal ends the conversation with the vehicle
        work.ends_itself();
    }
    let before = log::before_flight(args, !manner.decided)?;
    // the vehicle that was spoken to, and no other
    ride.sortie.system = before.system.map(SystemId).or(ride.sortie.system);
    ride.sortie.settings.log_awaited.clone_from(&before.awaited);
    let how = Watch {
        drawn: drawn.then(|| stderr.clone()),
        log: args.out.join(LOG),
        // lines of a script that did not ask for it are the script's
        typed: args.plain || std::io::stdin().is_terminal(),
        has_page: ride.sortie.settings.await_word,
    };
    let watches = manner.watches;
    let flown = fly_it(ride, work, move |pictures, pressed| match watches {
        Some(watches) => watches(pictures),
        None => watch(&how, pictures, pressed),
    });
    let mut notes = Vec::new();
    if !before.noted.is_empty() {
        // not ended by a signal that ended the flight: what was set has to be put back
        work.flies();
        log::put_back(args, &before, &mut |note| notes.push(note));
        work.ends_itself();
    }
    let (record, view) = flown.inspect_err(|_| notes.iter().for_each(Word::say))?;
    let mut said = Words::new(view == View::Stuck);
    said.say(words(&record));
    said.say(notes);
    let fetching = if record.outcome.ending == Ending::Landed { Fetching::of(args) } else { Fetching::Not };
    // each line when it is due: how long a download takes is said before it
    let onboard = log::after_flight((args, work), record.system, fetching, &mut |note| said.say(vec![note]));
    Ok(FlightRun { record, onboard, said, view })
}
