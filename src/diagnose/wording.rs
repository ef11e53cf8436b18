//! Words of an effect in reports.

use super::named::Named;
use crate::vehicle::Vehicle;

/// An effect as a clause that begins with a capital and ends without a full stop.
#[derive(Debug, Clone, Copy)]
pub enum Clause {
    /// one number and the words about it
    OneNumber {
        /// parameter
        parameter: &'static str,
        /// factor for the displayed unit
        factor: f64,
        /// words before the number
        before: &'static str,
        /// and after it
        after: &'static str,
    },
    /// text of its own
    Own(fn(&Named, &Vehicle) -> String),
    /// the effect's sentence with its values
    Sentence,
}

/// Words of an effect in reports.
#[derive(Debug, Clone, Copy)]
pub struct Words {
    /// its name in a list
    pub noun: &'static str,
    /// its name in a list once it is named, if that is more specific
    pub noun_of: Option<fn(&Named, &Vehicle) -> String>,
    /// with its numbers
    pub clause: Clause,
    /// its size with the unit
    pub size: Size,
    /// the smallest size (in its unit) that would have been named, in words
    pub limit: Option<fn(f64) -> String>,
    /// rank among the effects whose limits are reported first if nothing is missing
    pub told_if_absent: Option<usize>,
    /// rank among the effects that are expected of every vehicle in motion
    pub expected_in_motion: Option<usize>,
}

impl Words {
    /// A noun, the effect's own sentence and its first parameter.
    #[must_use]
    pub const fn of(noun: &'static str) -> Self {
        Self {
            noun,
            noun_of: None,
            clause: Clause::Sentence,
            size: Size::First,
            limit: None,
            told_if_absent: None,
            expected_in_motion: None,
        }
    }
}

/// The size of an effect.
#[derive(Debug, Clone, Copy)]
pub enum Size {
    /// the first parameter
    First,
    /// one for each axis: their common value, or their range
    Axes,
    /// the parameters for body x, y and z: the common value of x and y, and that of z beside it where it differs
    Across([&'static str; 3]),
    /// norm of all parameters that have a unit, times a factor, with its standard error
    Norm {
        /// factor for the displayed unit
        factor: f64,
        /// displayed unit
        unit: &'static str,
    },
    /// one parameter
    Of {
        /// which
        parameter: &'static str,
        /// factor for the displayed unit
        factor: f64,
        /// displayed unit
        unit: &'static str,
    },
    /// text of its own, and of the number in it the value and the standard error, where it has a unit
    Own(fn(&Named) -> Option<String>, fn(&Named) -> Option<(f64, f64)>),
}
