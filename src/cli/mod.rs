//! The command line: one struct a verb.

mod address;
mod compare;
mod convert;
mod csv_map;
mod effects;
mod fleet;
mod flight;
mod given;
mod installed;
mod live;
mod model;
mod onboard;
mod plan;
mod recording;
mod report;
mod run;
mod verb;
mod verbosity;

pub use compare::CompareArgs;
pub use convert::{ConvertArgs, ConvertForm};
pub use csv_map::CsvMapArgs;
pub use effects::EffectsArgs;
pub use fleet::{
    FleetArgs, FleetLogArgs, FleetReportArgs, FleetRowsArgs, FleetRunArgs, FleetStudyArgs, FleetVerb,
    FormName,
};
pub use flight::{CheckName, FlyArgs, OriginName};
pub use given::ShapeArgs;
pub use installed::{CompletionsArgs, ManArgs, SchemaArgs};
pub use live::{DemoArgs, RecordArgs, ReplayArgs, SitlArgs};
pub use model::{ExportArgs, ExportFormat, InitArgs, LoadArgs, SimulateArgs, VehicleArgs, VehicleVerb};
pub use onboard::{LogArgs, LogFetchArgs, LogListArgs, LogPrepareArgs, LogVerb, VehicleLinkArgs};
pub use plan::{CriterionName, PlanArgs};
pub use recording::{
    ExplainArgs, IdentifyArgs, InspectArgs, PageFormat, ProveArgs, RedactArgs, ValidateArgs,
};
pub use report::{ReportArgs, ReportFormat};
pub use run::RunArgs;
pub use verb::{Cli, Verb, color_of, is_json};
pub use verbosity::Verbosity;
