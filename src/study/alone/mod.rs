//! `alone`: one log by itself, which knows no other: what it holds, and what each of its flights shows of the vehicle.

mod request;
mod result;
mod run;
mod vibration;

pub use request::{AloneRequest, Depth, OwnWords, Whose};
pub use result::{AloneFlight, AloneStudy, Explained};
pub use run::alone;
