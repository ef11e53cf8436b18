//! Where the residual lives, before any name: which axis, when, along which state, at which frequency; and
//! tests for what no vehicle effect is: a force field of the room, and what never repeats.

mod aperiodic;
mod field;
mod frequency;
mod gust;
mod lateral_drag;
mod localisation;
mod redness;
mod spectrum;
mod states;
mod time;
mod view;

pub use aperiodic::{Aperiodic, StateLack, Trend, aperiodic, mass_step_std_kg};
pub use field::{FieldTest, Uneven, field_test};
pub use frequency::{Band, Coherence};
pub use gust::GustFound;
pub use localisation::{AxisShare, Localisation, localise};
pub use redness::{Quantity, Redness};
pub use states::{Bin, Follow};
pub use time::{Change, ChangeKind, Drift, Span};
pub use view::Followed;

#[cfg(test)]
mod tests;
