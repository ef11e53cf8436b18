//! Parameters of a file beside those of a vehicle, and their setting.

use super::setting::{read, set};
use super::{OnboardError, Session};
use crate::fetch::{Known, Noted, Notes};

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

/// Notes what was found, sets what differs, and reads it back.
///
/// # Errors
/// The notes cannot be written, the vehicle does not take a value or says another one afterwards, it is armed, or those of
/// [`Session::talk`].
pub async fn load(session: &mut Session, loading: &Loading, notes: &Notes) -> Result<(), OnboardError> {
    let at = Some(session.moment().await?);
    let noted = |parameter: &ParameterComparison| {
        Some(Noted { name: parameter.name.clone(), found: parameter.found?, set: parameter.in_file, at })
    };
    let changes: Vec<Noted> =
        loading.parameters.iter().filter(|parameter| parameter.differs()).filter_map(noted).collect();
    set(session, &loading.known, &changes, notes).await?;
    let names: Vec<&str> = changes.iter().map(|change| change.name.as_str()).collect();
    let now = read(session, &names).await?;
    match changes.iter().find(|change| now.value(&change.name) != Some(change.set)) {
        None => Ok(()),
        Some(Noted { name, set, .. }) => Err(OnboardError::Refused(format!(
            "{name}: expected {set} when read back, the vehicle says {}",
            now.value(name).map_or_else(|| "nothing".to_owned(), |value| value.to_string())
        ))),
    }
}
