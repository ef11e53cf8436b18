//! From a recording to conditioned signals on one clock.
//!
//! Time first ([`align`](self::StreamOffset)), then a uniform grid, filters without phase, and a mask
//! that keeps what is airborne, exciting and not saturated.

mod actuation;
mod actuators;
mod align;
mod allocation;
mod changed;
mod chosen;
mod condition;
mod error;
mod filter;
mod flight;
mod grid;
mod height;
mod hover;
mod lifts;
mod motion;
mod noise;
mod off_ground;
mod off_mixer;
mod one_flight;
mod own;
mod part;
mod plausible;
mod rebuilt;
mod reference;
mod reported_state;
mod resolution;
mod rotor_count;
mod rotor_thrusts;
mod select;
mod slow_velocity;
mod spectrum;
mod stated_rotors;
mod sufficient;
mod torque_error;
mod usable;
mod voltage;
mod weak;

pub use actuation::ThrustPreference;
pub use actuators::{
    bus_range, holds_fractions, motor_channels, propulsion_from_log, thrusts_from_commands,
    thrusts_from_speeds,
};
pub use align::StreamOffset;
pub use changed::{
    adopt_in_flight_parameters, changes_in_the_air, in_flight_parameters, other_settings, resting_on_defaults,
};
pub use condition::{ConditionSettings, STEP_FOR_EFFECTS_S, WEAK_HALF_WIDTH_S, condition, stride};
pub use error::SignalsError;
pub use filter::{Butterworth, ButterworthMemory, FilterPair, PairMemory, WindowedFir, central_difference};
pub use flight::{AsRecorded, Quality, Reference, Series, Signals};
pub use grid::{Grid, cubic_onto, hold_onto, linear_onto};
pub use height::VelocityHeldBy;
pub use hover::hover_command;
pub use noise::white_level;
pub use off_ground::{SHORTEST_FLIGHT_S, off_ground, spans, until_down, within};
pub use off_mixer::{OffMixer, outputs_off_mixer};
pub use one_flight::{ClockOffset, clock_offset};
pub use own::{Lacking, OwnOfFlight};
pub use reported_state::{LEAST_FREE_S, ReportedState};
pub use rotor_thrusts::{RotorThrusts, ThrustSource};
pub use select::{best, best_rank, is_live, mean_rate_hz, median_period_s};
pub use spectrum::highest_harmonic_hz;
pub use stated_rotors::{ARM_NOTABLE, Differing, RotorDifference, rotor_difference};
pub use sufficient::{
    LEAST_ACTUATOR_HZ, LEAST_BODY_RATE_HZ, LEAST_FORCE_HZ, LEAST_TORQUE_HZ, flowing_rate_within_hz,
};
pub use torque_error::TorqueError;
pub use usable::{Evidence, FLYING_SHARE, Usable, usable};
pub use voltage::airborne_voltage_v;
pub use weak::{MAX_ORDER, WeakKernel};
