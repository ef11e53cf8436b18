//! One parameter, and the tables of defaults.

/// One parameter.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Parameter {
    pub(super) name: String,
    pub(super) kind: ParameterType,
    pub(super) value: f64,
}

/// MAV_PARAM_TYPE of a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ParameterType {
    Int8,
    Int16,
    Int32,
    Real32,
}

impl ParameterType {
    pub(super) fn mav(self) -> u8 {
        match self {
            Self::Int8 => 2,
            Self::Int16 => 4,
            Self::Int32 => 6,
            Self::Real32 => 9,
        }
    }
}

/// A row of a table of defaults.
pub(super) type Row = (&'static str, ParameterType, f64);

/// Rows of a table as parameters.
pub(super) fn rows(table: &[Row]) -> impl Iterator<Item = Parameter> + '_ {
    table.iter().map(|(name, kind, value)| Parameter { name: (*name).to_owned(), kind: *kind, value: *value })
}

pub(super) fn parameter(name: String, kind: ParameterType, value: f64) -> Parameter {
    Parameter { name, kind, value }
}
