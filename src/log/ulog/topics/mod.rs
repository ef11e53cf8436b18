//! What PX4's topics mean: a table of streams, from the names of today back to those of 2016.

mod actuators;
mod motion;
mod row;
mod setpoints;
mod states;
mod table;
mod turns;

pub(super) use row::Bound;
pub(super) use table::{is_read, streams_of};
