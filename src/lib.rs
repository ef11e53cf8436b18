//! Identifies multirotors from recorded flights: mass and inertia, and the physical effects that a rigid body lacks.
//!
//! The program `mavid` plans a flight, flies it over MAVLink, records and analyses it. This library holds all of its
//! stages as functions from values to values.
//!
//! # A log that you have
//!
//! A log and a vehicle file with nominal values give mass and inertia with standard errors:
//!
//! ```
//! use mavid::config::load_vehicle;
//! use mavid::estimate::{Finding, IdentifySettings, identify};
//! use mavid::log::{self, OpenOptions};
//! use mavid::signals::{ConditionSettings, condition};
//! use std::path::Path;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures");
//! let log = log::open(&fixtures.join("p04_identify_10_22s.tlog"), &OpenOptions::default())?;
//! let vehicle = load_vehicle(&fixtures.join("p04_vehicle.toml"))?;
//!
//! let signals = condition(&log.recording, &vehicle, &ConditionSettings::default())?;
//! let identification = identify(&[signals], &vehicle, &IdentifySettings::default())?;
//!
//! // the file says 1.05 kg, the vehicle had 1.0 kg
//! let mass = &identification.best.result.parameters[0];
//! let Finding::Determined { value, std } = mass.finding else { panic!("{:?}", mass.finding) };
//! assert!((value - 1.0).abs() < 0.01 && std < 0.01);
//! # Ok(())
//! # }
//! ```
//!
//! # All stages
//!
//! | module | stage |
//! |---|---|
//! | [`config`], [`vehicle`] | what is known of a vehicle beforehand |
//! | [`plan`], [`trajectory`] | the excitation trajectory, and the standard errors that it will give |
//! | [`link`], [`wire`], [`fly`] | MAVLink, and the flight |
//! | [`fetch`], [`onboard`] | the logs that a vehicle keeps, fetched over MAVLink |
//! | [`log`], [`recording`] | from a file to a recording |
//! | [`signals`] | streams chosen, aligned in time and put on one grid |
//! | [`regression`], [`estimate`] | mass and inertia |
//! | [`diagnose`] | the effects that the model lacks |
//! | [`compare`] | models against recordings |
//! | [`trim`], [`change`] | the balance of a vehicle in flight, and what changed of it between flights |
//! | [`simulate`], [`physics`] | flights that never happened; the equations of motion and of the effects |
//! | [`sitl`] | a simulated vehicle that speaks MAVLink |
//! | [`fleet`], [`table`] | a log as rows of tables, and many vehicles along their flights |
//! | [`store`] | files in object stores |
//! | [`convert`] | the streams of a log for programs that plot |
//! | [`screen`] | the bytes of one log, and what is notable in it, within bounds |
//! | [`study`], [`report`], [`export`] | a whole piece of work as one function, its report, and its model for other simulators |
//!
//! The stages from a trajectory to an exported model, on a simulated flight in which drag is concealed:
//!
//! ```
//! use mavid::compare::{PlaybackSettings, playback};
//! use mavid::diagnose::{ExplainSettings, Verdict, clause, explain};
//! use mavid::estimate::{IdentifySettings, identify};
//! use mavid::export::{Format, export};
//! use mavid::physics::effects::LinearDrag;
//! use mavid::physics::{ActiveEffect, Model};
//! use mavid::plan::{PlanRequest, assess};
//! use mavid::signals::{ConditionSettings, condition};
//! use mavid::simulate::{FlightSettings, RandomTrajectory, Reference, Truth, random_vehicle, simulate_flight};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // plan: what a trajectory is worth, here one of the random ones that the tests fly
//! let pair = random_vehicle(11);
//! let nominal = &pair.nominal;
//! let trajectory = RandomTrajectory::default().draw(12)?;
//! let worth = assess(&trajectory, nominal, &[], &PlanRequest::default());
//! assert!(worth.standard_errors.is_some());
//!
//! // simulate: the true vehicle has a drag of which its file knows nothing
//! let mut truth = Truth::clean(pair.truth.clone());
//! truth.effects.push(ActiveEffect::new(&LinearDrag, &[0.4, 0.4, 0.0])?);
//! let reference = Reference { trajectory, hover_s: 4.0, ramp_s: 2.0 };
//! let settings = FlightSettings { duration_s: 34.0, ..FlightSettings::default() };
//! let flight = simulate_flight(truth, nominal, &reference, &settings)?;
//!
//! // signals: one clock, one grid
//! let signals = condition(&flight.recording, nominal, &ConditionSettings::default())?;
//!
//! // estimate: mass and inertia of a rigid body
//! let identification = identify(&[signals.clone()], nominal, &IdentifySettings::default())?;
//! let mass_kg = identification.best.result.estimated.theta[0];
//! assert!((mass_kg / pair.truth.body.mass_kg - 1.0).abs() < 0.02);
//!
//! // diagnose: what the rigid body lacks
//! let explanation = explain(&[signals.clone()], nominal, &ExplainSettings::default())?;
//! assert_eq!(explanation.verdict, Verdict::Explained);
//! let drag = &explanation.named[0];
//! assert_eq!(drag.id, "linear_drag");
//! assert!((drag.value("dx") - 0.4).abs() < 0.02, "{}", clause(drag, nominal));
//!
//! // compare: the velocity after 0.5 s is predicted better
//! let found = &explanation.search.after.base;
//! let errors = |model: &Model| playback((model, nominal), &signals, &PlaybackSettings::default());
//! let before = errors(&Model::new(nominal, Vec::new())?)?;
//! let after = errors(&found.model(&[])?)?;
//! assert!(after.velocity_m_s < before.velocity_m_s);
//!
//! // export: the same model for another simulator
//! let effects = [ActiveEffect::new(&LinearDrag, &[drag.value("dx"), drag.value("dy"), 0.0])?];
//! let gazebo = export(&found.vehicle, &effects, None, Format::Sdf)?;
//! assert!(gazebo.text.contains("<sdf"));
//! # Ok(())
//! # }
//! ```
//!
//! [`study`] does such a piece of work as the commands of `mavid` do it: it reads the files, holds data out, and
//! collects remarks. The folder `examples` has an effect that is defined outside of the library.
//!
//! # The rigid body
//!
//! Numbers in brackets are equations of "Experimental Parameter Identifications of a Quadrotor by Using an Optimized
//! Trajectory", IEEE Access 2020, 10.1109/ACCESS.2020.3023643.
//!
//! ```text
//! m v' + m S(w) v + m g R^T e_z = [0 0 Fz]     (1)   physics
//! I w' + S(w) I w = tau                        (2)   physics
//! Phi(v, w, eta, v', w') Theta = F             (11)  regression
//! Theta = [m Ixx Ixy Ixz Iyy Iyz Izz]                estimate
//! F = [Fz tau_phi tau_theta tau_psi]                 vehicle (from the actuators)
//! ```
//!
//! # Conventions
//!
//! The body frame is x forward, y left, z up. The world frame is north, west, up. Units are SI and radians. Times are
//! seconds of the vehicle's own clock from the start of the recording. Quaternions are w x y z, from body to world.
//! Files in other conventions are converted when they are read or written.
//!
//! Stages and flights are [`tracing`] spans; what happens in them are events. The library installs no subscriber.
//! [`fly::run`] needs a subscriber with [`fly::event_layer`], which writes the flight's log of events.

pub mod autopilot;
pub mod change;
pub mod compare;
pub mod config;
pub mod convert;
pub mod diagnose;
pub mod draft;
pub mod estimate;
pub mod export;
pub mod fence;
pub mod fetch;
pub mod files;
pub mod fleet;
pub mod fly;
pub mod frames;
pub mod inspect;
pub mod link;
pub mod log;
pub mod note;
pub mod onboard;
pub mod physics;
pub mod plan;
pub mod reconstruction;
pub mod recording;
pub mod redact;
pub mod regression;
pub mod replay;
pub mod report;
pub mod screen;
pub mod signals;
pub mod simulate;
pub mod sitl;
pub mod stand;
pub mod stats;
pub mod store;
pub mod study;
pub mod table;
pub mod text;
pub mod trajectory;
pub mod trim;
pub mod units;
pub mod vehicle;
pub mod wire;
