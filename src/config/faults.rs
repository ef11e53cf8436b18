//! What is wrong with one file, collected so that all of it is told at once.

use std::collections::BTreeSet;

use super::ConfigError;
use super::form::is_at_or_below;

/// What is wrong with one file.
#[derive(Debug, Default)]
pub(super) struct Faults {
    errors: Vec<ConfigError>,
    /// keys at which nothing stands for what is at fault: what follows from that is not told
    stands_in: BTreeSet<String>,
}

impl Faults {
    /// What is wrong already, and where nothing stands for it.
    pub(super) fn new(errors: Vec<ConfigError>, stands_in: BTreeSet<String>) -> Self {
        Self { errors, stands_in }
    }

    /// The value, or what stands for it until the file is refused.
    pub(super) fn take<T>(&mut self, checked: Result<T, ConfigError>, instead: T) -> T {
        checked.unwrap_or_else(|error| {
            self.note(error);
            instead
        })
    }

    /// The same of a number.
    pub(super) fn number(&mut self, checked: Result<f64, ConfigError>) -> f64 {
        self.take(checked, f64::NAN)
    }

    /// The same of what may be left out.
    pub(super) fn optional<T>(&mut self, checked: Result<Option<T>, ConfigError>) -> Option<T> {
        self.take(checked, None)
    }

    /// A check alone.
    pub(super) fn check(&mut self, checked: Result<(), ConfigError>) {
        self.take(checked, ());
    }

    fn note(&mut self, error: ConfigError) {
        let follows = matches!(&error, ConfigError::Invalid { key, .. }
            if is_at_or_below(&self.stands_in, key) || self.stands_in.iter().any(|path| is_part_of(path, key)));
        if !follows {
            self.errors.push(error);
        }
    }

    /// Nothing stands for the value of this key: what depends on it cannot be checked.
    pub(super) fn stands_in(&self, key: &str) -> bool {
        is_at_or_below(&self.stands_in, key)
    }

    /// How many there are so far.
    pub(super) fn count(&self) -> usize {
        self.errors.len()
    }

    /// Refuses the file of this name where anything is wrong with it.
    pub(super) fn refuse(self, origin: &str) -> Result<(), ConfigError> {
        if self.errors.is_empty() { Ok(()) } else { Err(ConfigError::combined(origin, self.errors)) }
    }
}

/// Whether a path is that of an element or a key of a value.
fn is_part_of(path: &str, key: &str) -> bool {
    path.strip_prefix(key).is_some_and(|rest| rest.starts_with(['.', '[']))
}
