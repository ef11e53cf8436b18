//! From a recording to conditioned signals on one clock.

mod filter;
mod grid;
mod weak;

pub use filter::{Butterworth, FilterPair, WindowedFir, central_difference};
pub use grid::{Grid, cubic_onto, hold_onto, linear_onto};
pub use weak::{MAX_ORDER, WeakKernel};
