//! The areas of a vehicle's fence, as the mission protocol stores them and as they lie in the plane: for whoever
//! checks a flight against them, and for the vehicle that keeps them.

mod areas;
mod item;
mod zone;

pub use areas::Areas;
pub use item::{CIRCLE_INSIDE, CIRCLE_OUTSIDE, FenceItem, POLYGON_INSIDE, POLYGON_OUTSIDE};
pub use zone::Zone;
