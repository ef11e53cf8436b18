//! What carries the bytes of a link.

mod backoff;
mod kind;
#[cfg(unix)]
mod pty;
mod resolver;
mod serial;
mod stream;
mod tcp;
mod threads;
mod udp;

pub(super) use kind::{Transport, open};
