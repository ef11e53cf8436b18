//! What a study is doing, for whoever waits for it.

use std::fmt;

use crate::note::Note;

/// What a study is doing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// logs become recordings
    Reading,
    /// recordings become signals on one grid
    Conditioning,
    /// mass and inertia are estimated
    Identifying,
    /// effects are searched
    Explaining,
    /// once more on the whole flight, because something changes at its end
    ExplainingAgain,
    /// models play flights back
    Predicting,
    /// the next flight is designed
    Designing,
}

impl Stage {
    /// What the steps of the stage are, where it counts them ([`Progress::steps`]).
    #[must_use]
    pub fn counted(self) -> &'static str {
        match self {
            Self::Explaining | Self::ExplainingAgain | Self::Predicting => "flights",
            Self::Reading | Self::Conditioning | Self::Identifying | Self::Designing => "steps",
        }
    }
}

impl fmt::Display for Stage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Reading => "reading the logs",
            Self::Conditioning => "preparing the signals",
            Self::Identifying => "estimating mass and inertia, with a search for effects beside them",
            Self::Explaining => "searching for effects",
            Self::ExplainingAgain => "searching for effects in the whole flight",
            Self::Predicting => "predicting flights with each model",
            Self::Designing => "designing the next flight",
        })
    }
}

/// Told by a study what it does next. It may be told from several threads.
pub trait Progress: Sync {
    /// A stage begins.
    fn stage(&self, stage: Stage);

    /// Something is to be known before the result, of which it is a part as well: there may be no result.
    fn note(&self, note: &Note);

    /// The stage takes so many steps.
    fn steps(&self, _count: u64) {}

    /// One of them is done.
    fn step(&self) {}

    /// So much of the stage is done, of about so much: how much it is, is not known beforehand.
    fn about(&self, _done: u64, _of: u64) {}
}

/// Nobody waits.
#[derive(Debug, Clone, Copy, Default)]
pub struct Silent;

impl Progress for Silent {
    fn stage(&self, _: Stage) {}

    fn note(&self, _: &Note) {}
}
