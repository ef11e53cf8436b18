//! Parameters of a file beside those of a vehicle, and their setting.

use super::{Flow, OnboardError, Session};
use crate::fetch::{Known, Noted, Notes, ReadParameters, SetParameters};

/// One parameter of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Wanted {
    /// its name
    pub name: String,
    /// what the vehicle has; `None` where it does not answer
    pub found: Option<f64>,
    /// what the file has
    pub wanted: f64,
}

impl Wanted {
    /// Whether the vehicle has another value.
    #[must_use]
    pub fn differs(&self) -> bool {
        self.found.is_some_and(|found| found != self.wanted)
    }
}

/// A file beside a vehicle.
#[derive(Debug, Default)]
pub struct Loading {
    known: Known,
    /// every parameter of the file, in its order
    pub wanted: Vec<Wanted>,
}

/// Asks the vehicle for the parameters of a file. Nothing else is sent but heartbeats.
///
/// # Errors
/// A value with a fraction is wanted of a whole number, or those of [`Session::talk`].
pub async fn compare(session: &mut Session, file: &[(String, f64)]) -> Result<Loading, OnboardError> {
    let known = read(session, file.iter().map(|(name, _)| name.as_str())).await?;
    let mut wanted = Vec::new();
    for (name, value) in file {
        if known.is_whole(name) && value.fract() != 0.0 {
            return Err(OnboardError::Refused(format!(
                "{name}: expected a whole number, as the vehicle has it, got {value}"
            )));
        }
        wanted.push(Wanted { name: name.clone(), found: known.value(name), wanted: *value });
    }
    Ok(Loading { known, wanted })
}

/// Notes what was found, sets what differs, and reads it back.
///
/// # Errors
/// The notes cannot be written, the vehicle does not take a value or says another one afterwards, it is armed, or those of
/// [`Session::talk`].
pub async fn load(session: &mut Session, loading: &Loading, notes: &Notes) -> Result<(), OnboardError> {
    let differing: Vec<&Wanted> = loading.wanted.iter().filter(|wanted| wanted.differs()).collect();
    let at = Some(session.moment().await?);
    let noted = differing.iter().filter_map(|wanted| {
        Some(Noted { name: wanted.name.clone(), found: wanted.found?, set: wanted.wanted, at })
    });
    notes.add(&noted.collect::<Vec<_>>())?;
    let values: Vec<(&str, f64)> =
        differing.iter().map(|wanted| (wanted.name.as_str(), wanted.wanted)).collect();
    let mut setting = SetParameters::new(session.vehicle, &loading.known, &values)?;
    session.talk_disarmed(&mut setting).await?;
    let failures: Vec<_> = setting.failures().map(|(_, why)| why).collect();
    if !failures.is_empty() {
        return Err(OnboardError::NotSet(failures));
    }
    let now = read(session, values.iter().map(|(name, _)| *name)).await?;
    let other = |(name, value): &&(&str, f64)| now.value(name) != Some(*value);
    match values.iter().find(other) {
        None => Ok(()),
        Some((name, value)) => Err(OnboardError::Refused(format!(
            "{name}: expected {value} when read back, the vehicle says {}",
            now.value(name).map_or_else(|| "nothing".to_owned(), |value| value.to_string())
        ))),
    }
}

async fn read<'a>(
    session: &mut Session,
    names: impl Iterator<Item = &'a str>,
) -> Result<Known, OnboardError> {
    let names: Vec<&str> = names.collect();
    let mut reading = ReadParameters::new(session.vehicle, &names)?;
    session.talk(&mut reading, |_| Ok(Flow::On)).await?;
    Ok(reading.known())
}
