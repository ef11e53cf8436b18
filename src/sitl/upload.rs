//! A fence that comes in by the mission protocol.

use std::time::Duration;

use crate::fence::FenceItem;

/// An upload under way.
#[derive(Debug)]
pub(super) struct Upload {
    pub(super) link: usize,
    pub(super) sender: (u8, u8),
    pub(super) items: Vec<FenceItem>,
    pub(super) count: usize,
    pub(super) asked: Duration,
    pub(super) heard: Duration,
}
