//! The autopilot's parameters, and how each autopilot puts them into PARAM_VALUE.

mod ardupilot;
mod parameter;
mod parameter_set;
mod pulses;
mod px4;
mod thrust;

pub(super) use parameter_set::Parameters;
pub(super) use pulses::Pulses;
pub(super) use thrust::hover_share;
