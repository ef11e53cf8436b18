//! One parameter, and those of a table.

use crate::autopilot::{ParameterType, Release, Stack};

/// One parameter.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Parameter {
    pub(super) name: String,
    pub(super) kind: ParameterType,
    pub(super) value: f64,
}

pub(super) fn parameter(name: String, kind: ParameterType, value: f64) -> Parameter {
    Parameter { name, kind, value }
}

/// All that have a default in a release.
pub(super) fn defaults_of(stack: &Stack, release: Release) -> Vec<Parameter> {
    let defaults = stack.parameters.defaults(release);
    defaults.map(|(name, kind, value)| parameter(name.to_owned(), kind, value)).collect()
}

/// One that the vehicle decides; `None` where the autopilot has none of that name.
pub(super) fn decided(stack: &Stack, name: &str, value: f64) -> Option<Parameter> {
    stack.parameters.find(name).map(|entry| parameter(name.to_owned(), entry.kind, value))
}
