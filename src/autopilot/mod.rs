//! Autopilots as tables: their modes, parameters, failsafes and outputs.
//!
//! [`Autopilot`] says which software flies. [`Autopilot::stack`] gives its [`Stack`], all that is known of it, for those
//! that have a file here. Nothing else in the library holds a mode's number.

pub(crate) mod ardupilot;
mod failsafe;
mod frames;
mod geometry;
mod kind;
mod limits;
mod list;
mod log_bytes;
mod log_plan;
mod logging;
mod modes;
mod outputs;
mod parameters;
mod pilot;
pub(crate) mod px4;
mod px4_states;
mod release;
mod setpoints;
mod simulated;
mod stack;
mod vehicle_kind;
mod vehicle_type;

pub use ardupilot::ARDUPILOT;
pub use failsafe::{Choice, Failsafe, Reaction};
pub use frames::{FRAMES, Frame, FrameMotor};
pub use geometry::{Geometry, Layout, LayoutError, LayoutUnit, RotorPlace};
pub use kind::Autopilot;
pub use limits::{Bounded, Braking};
pub use list::STACKS;
pub use log_bytes::{DATAFLASH_MARKER, ULOG_DEEPEST, ULOG_FLAG_BYTES, ULOG_HEAD_BYTES, ULOG_MAGIC};
pub use log_plan::{LogAwaited, LogChange, LogPlan};
pub use logging::{LogNeed, LogOff, LogRate, LogSetting, LogSpeed, Logging, OldLogging};
pub use modes::{FlightMode, FlownBy, Mode, Numbering, Wishes};
pub use outputs::{MOST_OUTPUTS, Numbered, NumberedGroup, Outputs, PulseRange, ThrottleChannel};
pub use parameters::{Parameter, ParameterTable, ParameterType, Purpose, Renamed, Unit};
pub use pilot::{KillSwitch, POSITIONS, PilotSwitches};
pub use px4::PX4;
pub use px4_states::px4_mode_of_state;
pub use release::Release;
pub use setpoints::{LastSetpoint, SetpointRules, Takeoff};
pub use simulated::{TELLS_SIMULATED, is_simulated, of_simulator};
pub use stack::Stack;
pub use vehicle_kind::VehicleKind;
pub use vehicle_type::{is_multirotor, multirotor_type};
