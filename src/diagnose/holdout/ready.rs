//! A held-out flight prepared for the comparison.

use super::carried::Pair;
use super::error::HoldoutError;
use super::settings::{HeldOut, HoldoutSettings};
use crate::diagnose::base::Base;
use crate::diagnose::trace::Trace;
use crate::physics::{Model, PhysicsError};
use crate::signals::OwnOfFlight;
use crate::vehicle::Vehicle;
use std::borrow::Cow;

/// A held-out flight prepared for the comparison.
pub(super) struct Ready<'a> {
    pub(super) flight: &'a HeldOut<'a>,
    pub(super) trace: Trace,
    pub(super) pair: Pair,
}

impl Ready<'_> {
    /// Time that can be used, s.
    pub(super) fn usable_s(&self) -> f64 {
        usable_s(self.flight, &self.trace)
    }

    /// The flight on which the models for predictions stand: they have in them what is its own.
    pub(super) fn predicted(&self) -> Cow<'_, Trace> {
        if self.pair.loaded.is_some() {
            Cow::Owned(self.trace.with_own(OwnOfFlight::default()))
        } else {
            Cow::Borrowed(&self.trace)
        }
    }
}

pub(super) fn trace_of(
    flight: &HeldOut,
    vehicle: &Vehicle,
    settings: &HoldoutSettings,
) -> Result<Trace, HoldoutError> {
    let trace = Trace::new(flight.signals, vehicle, settings.half_width_s)
        .map_err(|source| HoldoutError::Trace { flight: flight.name.to_owned(), source })?;
    let seconds = usable_s(flight, &trace);
    if seconds < LEAST_S {
        return Err(HoldoutError::TooShort { flight: flight.name.to_owned(), seconds, needed_s: LEAST_S });
    }
    Ok(trace)
}

fn usable_s(flight: &HeldOut, trace: &Trace) -> f64 {
    flight.signals.usable.iter().filter(|usable| **usable).count() as f64 * trace.grid.step_s
}

/// A base's model with its latency as effects.
pub(super) fn model_of(base: &Base) -> Result<Model, PhysicsError> {
    base.model(&base.latency_effects())
}

/// Least time of flight over which errors are averaged, s. They are six windows of half a second.
const LEAST_S: f64 = 3.0;
