//! Localisation of the residual before any name: axis, time, state and frequency; and tests for causes that are not
//! vehicle effects: a force field of the room, and causes that do not repeat.

mod aperiodic;
mod field;
mod frequency;
mod gust;
mod lateral_drag;
mod localisation;
mod portrait;
mod redness;
mod spectrum;
mod states;
mod time;
mod view;
mod visits;

pub use super::followed::Followed;
pub use aperiodic::{
    Aperiodic, StateLack, StepBeside, Trend, aperiodic_of_each, mass_step_beside, mass_step_std_kg,
};
pub use field::{FieldTest, Uneven, field_test};
pub use frequency::{Band, Coherence};
pub use gust::GustFound;
pub use localisation::{AxisShare, Localisation, localise};
pub use portrait::{Portrait, portrait};
pub use redness::{Quantity, Redness};
pub use states::{Bin, Follow};
pub use time::{Change, ChangeKind, Drift, Span};

#[cfg(test)]
mod tests;
