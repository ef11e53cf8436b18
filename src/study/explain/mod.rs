//! Which physics the model left out: from logs to names, sizes, and the gain on what was not used.

mod along;
mod along_flights;
mod body;
mod doubts;
mod evidence;
mod figures;
mod hold_out;
mod left_out;
mod located;
mod meant;
mod next_flight;
mod not_determined;
mod path;
mod predicted;
mod prepared;
mod prospect;
mod readers;
mod refuted;
mod request;
mod result;
mod run;
mod short;
mod traces;
mod unshown;
mod validation_data;
mod worth;
mod worth_measured;

pub use along_flights::AlongFlights;
pub use body::{BodyParameter, Estimate};
pub use evidence::{Tried, TriedAs};
pub use figures::{AxisResidual, Figures, Followed, Harmonics, Heat, LeftAlongTime, RecordedAndSimulated};
pub use located::{AxisShare, Field, Located, StateShare};
pub use next_flight::stored_trajectory;
pub(super) use not_determined::{BY_CONTROL, KEPT};
pub use path::{FlownPath, PathResidual};
pub use predicted::{Predicted, QUANTITIES};
pub use readers::for_readers;
pub use refuted::Refuted;
pub use request::ExplainRequest;
pub use result::{AxisFit, ExplainStudy, Given};
pub use run::explain;
pub use validation_data::ValidationData;
pub use worth::Worth;

pub(super) use prepared::{Asked, explain_prepared};
pub(super) use request::check_transient;
