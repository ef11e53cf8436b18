//! The columns of a table.

use serde::Serialize;

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// words
    Text,
    /// a number
    Number,
    /// a whole number
    Whole,
    /// yes or no
    Truth,
    /// several numbers
    Numbers,
}

impl Kind {
    /// As documents call it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Text => "text",
            Self::Number => "number",
            Self::Whole => "whole number",
            Self::Truth => "true or false",
            Self::Numbers => "list of numbers",
        }
    }
}

/// One column.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Column {
    /// name
    pub name: &'static str,
    /// what it holds
    pub kind: Kind,
    /// a row may have none
    pub may_be_empty: bool,
    /// SI; empty where it has none
    pub unit: &'static str,
    /// what it is, in a sentence
    pub words: &'static str,
}
