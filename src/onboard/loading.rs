//! Parameters of a file beside those of a vehicle, and their setting.

use std::time::Duration;

use super::setting::{read, rest, set};
use super::{OnboardError, Session};
use crate::autopilot::{TELLS_SIMULATED, is_simulated};
use crate::fetch::{Known, Noted, Notes};

/// Within this an autopilot has looked at parameters that were set: PX4's modules and ArduPilot's libraries read them several
/// times a second.
const SETTLING: Duration = Duration::from_millis(1500);

/// One parameter of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct ParameterComparison {
    /// its name
    pub name: String,
    /// what the vehicle has; `None` where it does not answer
    pub found: Option<f64>,
    /// what the file has
    pub in_file: f64,
}

impl ParameterComparison {
    /// Whether the vehicle has another value.
    #[must_use]
    pub fn differs(&self) -> bool {
        self.found.is_some_and(|found| found != self.in_file)
    }
}

/// A file beside a vehicle.
#[derive(Debug, Default)]
pub struct Loading {
    known: Known,
    /// every parameter of the file, in its order
    pub parameters: Vec<ParameterComparison>,
}

/// Asks the vehicle for the parameters of a file. Nothing else is sent but heartbeats.
///
/// # Errors
/// A value with a fraction is wanted of a whole number, or those of [`Session::talk`].
pub async fn compare(session: &mut Session, file: &[(String, f64)]) -> Result<Loading, OnboardError> {
    let names: Vec<&str> = file.iter().map(|(name, _)| name.as_str()).collect();
    let known = read(session, &names).await?;
    let mut parameters = Vec::new();
    for (name, value) in file {
        if known.is_whole(name) && value.fract() != 0.0 {
            return Err(OnboardError::Refused(format!(
                "{name}: expected a whole number, as the vehicle has it, got {value}"
            )));
        }
        parameters.push(ParameterComparison {
            name: name.clone(),
            found: known.value(name),
            in_file: *value,
        });
    }
    Ok(Loading { known, parameters })
}

/// Whether the vehicle's own parameters say that it is a simulator. Nothing else is sent but heartbeats.
///
/// # Errors
/// Those of [`Session::talk`].
pub async fn is_simulator(session: &mut Session) -> Result<bool, OnboardError> {
    let known = read(session, &TELLS_SIMULATED).await?;
    Ok(is_simulated(|name| known.value(name)))
}

/// What a vehicle made of the parameters that were set.
#[derive(Debug, Default)]
pub struct Loaded {
    /// those that are as they were set
    pub kept: Vec<Noted>,
    /// those that the vehicle changed by itself, or for which it does not answer any more: with what they are now
    pub differing: Vec<(Noted, Option<f64>)>,
}

/// Notes what was found, sets what differs, and reads it back when the vehicle had the time to look at it: an autopilot
/// constrains some values only after it has taken them. What it made of them is noted too.
///
/// # Errors
/// The notes cannot be written, the vehicle does not take a value, it is armed, or those of [`Session::talk`].
pub async fn load(session: &mut Session, loading: &Loading, notes: &Notes) -> Result<Loaded, OnboardError> {
    let at = Some(session.moment().await?);
    let noted = |parameter: &ParameterComparison| {
        let (name, set) = (parameter.name.clone(), parameter.in_file);
        Some(Noted { name, found: parameter.found?, set, became: None, at })
    };
    let changes: Vec<Noted> =
        loading.parameters.iter().filter(|parameter| parameter.differs()).filter_map(noted).collect();
    let refused = match set(session, &loading.known, &changes, notes).await {
        Err(OnboardError::NotSet(why)) => Some(why),
        done => done.map(|()| None)?,
    };
    rest(session, SETTLING).await?;
    let names: Vec<&str> = changes.iter().map(|change| change.name.as_str()).collect();
    let now = read(session, &names).await?;
    let mut loaded = Loaded::default();
    for mut change in changes {
        let value = now.value(&change.name);
        if value == Some(change.set) {
            loaded.kept.push(change);
            continue;
        }
        change.became = value.filter(|value| *value != change.found);
        loaded.differing.push((change, value));
    }
    let made: Vec<Noted> = loaded.differing.iter().map(|(change, _)| change.clone()).collect();
    notes.add(&made)?;
    match refused {
        // all that was refused is as it was before
        Some(why) if made.iter().all(|change| change.became.is_none()) => Err(OnboardError::NotSet(why)),
        _ => Ok(loaded),
    }
}
