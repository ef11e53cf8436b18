//! The parameters of a vehicle that a first description of it needs.

use std::collections::{BTreeMap, BTreeSet};

use super::{Flow, OnboardError, Session};
use crate::autopilot::Stack;
use crate::fetch::ReadParameters;

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
        session.talk(&mut reading, |_| Ok(Flow::On)).await?;
        let came = reading.known();
        known.extend(more.iter().filter_map(|name| Some((name.clone(), came.value(name)?))));
        asked.extend(more);
    }
}
