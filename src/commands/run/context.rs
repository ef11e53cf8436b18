//! What every stage of a run is given.

use std::cell::RefCell;

use super::again::again;
use super::ask::Ask;
use super::folder::Folder;
use super::step::Step;
use crate::cli::RunArgs;
use crate::commands::fly::is_attended;
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

    /// Nothing is to be decided and nothing real is flown: all that stands before the answer is short.
    pub fn is_brief(&self) -> bool {
        self.args.yes && self.args.sitl
    }

    /// A person watches the flight in a view.
    pub fn is_drawn(&self) -> bool {
        !self.args.plain && !self.is_brief() && !self.stderr.is_quiet() && is_attended()
    }

    /// Says a step before it is done, and remembers it: in the folder too, so that it is known after a run that was ended.
    pub fn tell(&self, step: &Step) {
        let line = step.line();
        if self.is_brief() {
            tracing::info!(command = %line, "step");
        } else {
            step.tell();
        }
        if let Err(error) = self.folder.remember(&line) {
            output::warning(&error.to_string());
        }
        self.steps.borrow_mut().push(line);
    }

    /// Says the steps that a short run has kept to itself: it failed.
    pub fn tell_kept(&self) {
        if self.is_brief() {
            self.steps.borrow().iter().for_each(|line| output::message(&format!("$ {line}")));
        }
    }

    /// The command that takes this run up again.
    pub fn again(&self) -> String {
        again(std::env::args_os().skip(1), self.folder.path())
    }

    /// The heading of a stage.
    pub fn stage(&self, text: &str) {
        self.work.waits();
        if !self.is_brief() {
            output::message("");
        }
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
