//! What every stage of a run is given.

use std::cell::RefCell;

use super::ask::Ask;
use super::folder::Folder;
use super::step::Step;
use crate::cli::RunArgs;
use crate::commands::live::Work;
use crate::commands::output;
use crate::commands::standard_error::StandardError;

/// How a run differs from the usual one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Recipe {
    /// a short flight, of which the radio's recording alone is explained, and no next flight is designed
    pub is_demo: bool,
}

/// What every stage of a run is given.
pub struct Context<'a> {
    /// as they were typed
    pub args: &'a RunArgs,
    /// and how it differs
    pub recipe: Recipe,
    /// where everything is
    pub folder: Folder,
    /// asks a person
    pub ask: Ask,
    /// for progress
    pub stderr: &'a StandardError,
    /// what a signal may do
    pub work: &'a Work,
    steps: RefCell<Vec<String>>,
}

impl<'a> Context<'a> {
    /// With no step done.
    pub fn new(
        (args, recipe): (&'a RunArgs, Recipe),
        (folder, ask): (Folder, Ask),
        (stderr, work): (&'a StandardError, &'a Work),
    ) -> Self {
        Self { args, recipe, folder, ask, stderr, work, steps: RefCell::default() }
    }

    /// Says a step before it is done, and remembers it.
    pub fn tell(&self, step: &Step) {
        step.tell();
        self.steps.borrow_mut().push(step.line());
    }

    /// The heading of a stage.
    pub fn stage(&self, text: &str) {
        self.work.waits();
        output::message("");
        output::message(text);
    }

    /// The steps so far, as they are typed.
    pub fn steps(&self) -> Vec<String> {
        self.steps.borrow().clone()
    }

    /// Flights at most.
    pub fn flights_max(&self) -> usize {
        let given = self.args.flights.and_then(|flights| usize::try_from(flights).ok());
        given.unwrap_or(if self.ask.is_person() { usize::MAX } else { 1 })
    }
}
