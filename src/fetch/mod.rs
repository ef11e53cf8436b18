//! The logs that a vehicle keeps: listed and fetched over MAVLink.
//!
//! Dialogues do no I/O and have no clock: [`Dialogue::poll`] gives the messages that are due, [`Dialogue::take`] takes
//! what comes. Times are [`std::time::Duration`]s since any fixed start. Everything that a vehicle says of its files is
//! bounded and checked here; nothing on it is changed or erased.
//!
//! ```text
//! Survey -> List -> Download -> Part (a file beside its place) -> the log
//! ```

mod asked;
mod chosen;
mod dialogue;
mod download;
mod error;
mod faster;
mod fetched;
mod ftp;
mod ftp_list;
mod ftp_reading;
mod gauge;
mod list;
mod log_list;
mod log_reading;
mod moment;
mod name;
mod notes;
mod pace;
mod parameter_value;
mod parameters;
mod part;
mod peer;
mod remote;
mod restart;
mod survey;
mod uptime;
mod window;

pub use chosen::{Chosen, OtherWay};
pub use dialogue::Dialogue;
pub use download::Download;
pub use error::FetchError;
pub use fetched::{Fetched, Sum};
pub use list::List;
pub use moment::Moment;
pub use name::local_name;
pub use notes::{Noted, Notes, NotesError};
pub use parameters::{Known, ReadParameters, SetParameters};
pub use part::{Begun, Checked, Part, PartError};
pub use remote::{LogSelection, MOST_BYTES, Place, Protocol, RemoteLog};
pub use restart::Restart;
pub use survey::{Offer, Survey};
pub use uptime::Uptime;
