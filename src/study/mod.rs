//! A whole piece of work as one function with a typed result: what `mavid explain`, `identify` and their like do.
//!
//! A study reads files, calls the stages, and collects what they have to say. It prints nothing and writes nothing:
//! [`crate::report`] shows its result, and the caller decides where that goes. What it does meanwhile it tells a
//! [`Progress`].

mod after_flight;
mod alone;
mod both_logs;
mod compare;
mod correlation;
mod doubts;
mod effect_name;
mod effects;
mod error;
mod explain;
mod flight;
mod flights;
mod identify;
mod input;
mod known_effect;
mod one_vehicle;
mod plan;
mod progress;
mod prove;
mod same_flight;
mod track;
mod unflown;
mod validate;
mod vehicle;
mod vehicle_given;

pub use after_flight::{AfterFlight, FlightLogs, after_flight};
pub use alone::{AloneFlight, AloneRequest, AloneStudy, Depth, Explained, OwnWords, Whose, alone};
pub use compare::{
    Change, Changed, CompareRequest, CompareStudy, Compared, ComparedFlight, Judge, LeastChange, LeftOut,
    LiftsApart, LiftsOf, ScaleMoved, UndecidedAlong, WeakAlone, compare,
};
pub use correlation::Correlation;
pub use effects::{effects_file, with_further, with_stated_lag};
pub use error::StudyError;
pub use explain::{
    AlongFlights, AxisFit, AxisResidual, AxisShare, BodyParameter, Estimate, ExplainRequest, ExplainStudy,
    Field, Figures, FlightLimit, FlownPath, Followed, Given, Harmonics, Heat, LeftAlongTime, LeftOutForce,
    Located, PathResidual, Predicted, QUANTITIES, RecordedAndSimulated, Refuted, StateShare, Tried, TriedAs,
    ValidationData, Worth, explain, for_readers, no_model_in, stored_trajectory,
};
pub use flights::{ReadSettings, unread};
pub use identify::{
    COMPONENTS, IdentifyRequest, IdentifyStudy, Misfit, RotorsAndMotion, WithEffects, identify,
};
pub use input::{InputFile, lost, said_of};
pub use known_effect::{
    KnownConfusable, KnownEffect, KnownParameter, ParameterKind, UsualOfClass, known_effects,
};
pub use one_vehicle::{AIRFRAME, SERIAL};
pub use plan::{Circle, FlightExtremes, PlanStudy, PlannedSeries, PlanningRequest, plan_flight};
pub use progress::{Progress, Silent, Stage};
pub use prove::{
    CaseEffect, CaseParameter, CaseVerdict, Gain, Proof, ProofSummary, ScoredCase, SealedVerdicts, SizeError,
    case_folders, prove, seal, verdict,
};
pub use track::Track;
pub use validate::{
    Column, ErrorRow, ErrorTable, Prediction, Rank, ValidateRequest, ValidateStudy, ValidatedFlight,
    ValidatedModel, closed_loop_table, playback_table, prediction_table, validate,
};
pub use vehicle::{RotorSummary, VehicleSummary, vehicle_summary};
pub use vehicle_given::{
    VehicleGiven, check_given, draft_from_log, draft_from_parameters, draft_notes, draft_text, implausible,
    with_thrust_stand,
};
