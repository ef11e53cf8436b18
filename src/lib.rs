//! Learns a multirotor's parameters from a recorded flight.
//!
//! The rigid body that everything stands on (numbers in brackets are equations of
//! "Experimental Parameter Identifications of a Quadrotor by Using an Optimized Trajectory",
//! IEEE Access 2020, 10.1109/ACCESS.2020.3023643):
//!
//! ```text
//! m v' + m S(w) v + m g R^T e_z = [0 0 Fz]     (1)   physics
//! I w' + S(w) I w = tau                        (2)   physics
//! Phi(v, w, eta, v', w') Theta = F             (11)  regression
//! Theta = [m Ixx Ixy Ixz Iyy Iyz Izz]                estimate
//! F = [Fz tau_phi tau_theta tau_psi]                 vehicle (from the actuators)
//! ```
//!
//! Each module is one stage, made of functions from values to values:
//! `log -> recording -> signals -> regression -> estimate`, and `simulate`, which never sees an estimate.
//!
//! Inside: body x forward, y left, z up; world north, west, up; SI units, radians, seconds of the
//! vehicle's own clock from the recording's start; quaternions w x y z, body to world.

pub mod autopilot;
pub mod compare;
pub mod config;
pub mod diagnose;
pub mod estimate;
pub mod export;
pub mod fence;
pub mod files;
pub mod fly;
pub mod frames;
pub mod inspect;
pub mod link;
pub mod log;
pub mod note;
pub mod physics;
pub mod plan;
pub mod recording;
pub mod regression;
pub mod report;
pub mod signals;
pub mod simulate;
pub mod sitl;
pub mod stats;
pub mod study;
pub mod text;
pub mod trajectory;
pub mod units;
pub mod vehicle;
pub mod wire;
