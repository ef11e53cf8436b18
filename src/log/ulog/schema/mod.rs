//! What a log says of its own messages: definitions, and which topic's messages bear which number.

mod definition;
mod layout;
mod number;
mod subscriptions;

pub(super) use definition::is_name;
pub use layout::{Cell, Layout};
pub use number::NumberType;
pub(super) use subscriptions::Schema;
pub use subscriptions::Subscription;
