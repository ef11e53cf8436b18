//! The parameters of a vehicle that a first description of it needs.

use std::collections::{BTreeMap, BTreeSet};
use std::time::{Duration, Instant};

use super::{Flow, OnboardError, Session};
use crate::autopilot::Stack;
use crate::fetch::ReadParameters;
use crate::note::Note;

/// Between two words about how many have answered.
const STILL_WAITING: Duration = Duration::from_secs(3);

/// Asks the vehicle for what is `needed` of its parameters by what is known so far, until nothing more is. Nothing else is
/// sent but heartbeats. What does not answer is missing.
///
/// # Errors
/// Those of [`Session::talk`].
pub async fn read_as_needed(
    session: &mut Session,
    needed: impl Fn(&Stack, &BTreeMap<String, f64>) -> BTreeSet<String>,
) -> Result<BTreeMap<String, f64>, OnboardError> {
    let (mut known, mut asked) = (BTreeMap::new(), BTreeSet::new());
    loop {
        let more: Vec<String> = needed(session.stack, &known).difference(&asked).cloned().collect();
        if more.is_empty() {
            return Ok(known);
        }
        let names: Vec<&str> = more.iter().map(String::as_str).collect();
        let mut reading = ReadParameters::new(session.vehicle, &names)?;
        let (tell, about) = session.teller();
        let mut told = Instant::now();
        let tell_progress = |reading: &mut ReadParameters| {
            if told.elapsed() >= STILL_WAITING {
                told = Instant::now();
                let (there, all) = reading.progress();
                tell(&Note::remark(about.clone(), read_so_far(there, all)));
            }
            Ok(Flow::On)
        };
        session.talk(&mut reading, tell_progress).await?;
        let came = reading.known();
        known.extend(more.iter().filter_map(|name| Some((name.clone(), came.value(name)?))));
        asked.extend(more);
    }
}

/// How many of the parameters that were asked for have come.
fn read_so_far(there: usize, all: usize) -> String {
    format!("{there} of {all} parameters are read; one that the vehicle does not have never comes")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_count_says_of_what_it_is() {
        assert!(read_so_far(25, 43).starts_with("25 of 43 parameters are read"));
    }
}
