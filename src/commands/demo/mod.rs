//! `mavid demo`: plans a flight, flies it with a simulated vehicle about which something is wrong, and says
//! what, without having been told.

mod concealed;
mod embedded;
mod progress;
mod verb;

pub use verb::run;
