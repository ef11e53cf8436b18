//! How an effect is said.

use super::named::Named;
use crate::vehicle::Vehicle;

/// An effect as a clause that begins with a capital and ends without a full stop.
#[derive(Debug, Clone, Copy)]
pub enum Clause {
    /// one number and the words about it
    OneNumber {
        /// parameter
        parameter: &'static str,
        /// brings it to the unit that is said
        factor: f64,
        /// words before the number
        before: &'static str,
        /// and after it
        after: &'static str,
    },
    /// in its own words
    Own(fn(&Named, &Vehicle) -> String),
    /// the effect's sentence with its values
    Sentence,
}

/// What a person reads.
#[derive(Debug, Clone, Copy)]
pub struct Words {
    /// how it is called in a list
    pub noun: &'static str,
    /// how one that was named is called in a list, where that says more
    pub noun_of: Option<fn(&Named, &Vehicle) -> String>,
    /// with its numbers
    pub clause: Clause,
    /// the number by which it is known, with its unit
    pub size: Size,
    /// the smallest size (in its unit) that would have been named, in words
    pub limit: Option<fn(f64) -> String>,
    /// place among the effects that are told first where nothing is missing
    pub told_if_absent: Option<usize>,
    /// place among the effects that everybody expects of a vehicle that moves
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

/// The number by which an effect is known.
#[derive(Debug, Clone, Copy)]
pub enum Size {
    /// the first parameter
    First,
    /// one for each axis: their common value, or their range
    Axes,
    /// norm of all parameters that have a unit, times a factor, with as many digits
    Norm {
        /// brings it to the unit that is said
        factor: f64,
        /// unit as it is said
        unit: &'static str,
        /// significant digits
        digits: i32,
    },
    /// one parameter
    Of {
        /// which
        parameter: &'static str,
        /// brings it to the unit that is said
        factor: f64,
        /// unit as it is said
        unit: &'static str,
    },
    /// in its own words
    Own(fn(&Named) -> Option<String>),
}
