//! State of a vehicle that leaves our mode.

use std::time::Duration;

use crate::autopilot::Mode;
use crate::fly::safety::Sustained;

/// State while our mode is left.
#[derive(Debug)]
pub(super) struct Leaving {
    pub(super) wish: Mode,
    /// the mode, ordered by us, in which it was when the new one was requested
    pub(super) from: Option<u32>,
    pub(super) wished: Duration,
    /// whether the command was sent: a change of mode before was somebody else's choice
    pub(super) ordered: bool,
    /// when it was last ordered
    pub(super) asked: Duration,
    /// when the requested mode was first reported
    pub(super) reached: Option<Duration>,
    /// reported in another mode after that, and whether it ever was in the air
    pub(super) left: Sustained,
    pub(super) strayed: bool,
    /// whether the operator decides what follows a hold
    pub(super) by_operator: bool,
    /// when the program ends at the latest
    pub(super) stop_by: Option<Duration>,
    pub(super) landed: Sustained,
    /// when it was last ordered to disarm
    pub(super) disarmed: Option<Duration>,
}

impl Leaving {
    pub(super) fn to(wish: Mode, from: Option<u32>, now: Duration) -> Self {
        Self {
            wish,
            from,
            wished: now,
            ordered: false,
            asked: now,
            reached: None,
            left: Sustained::default(),
            strayed: false,
            by_operator: false,
            stop_by: None,
            landed: Sustained::default(),
            disarmed: None,
        }
    }

    pub(super) fn wish(&self) -> Mode {
        self.wish
    }

    /// Notes that the command was sent.
    pub(super) fn ordered(&mut self) {
        self.ordered = true;
    }

    pub(super) fn is_ordered(&self) -> bool {
        self.ordered
    }

    /// Whether it was reported in another mode after the requested one: somebody else flies it.
    pub(super) fn has_strayed(&self) -> bool {
        self.strayed
    }

    /// Whether it was in this mode when it was ordered to leave it, and is not reported to have left it. If it reports
    /// the mode again later, somebody else flies it.
    pub(super) fn comes_from(&self, custom_mode: u32) -> bool {
        self.reached.is_none() && self.from == Some(custom_mode)
    }

    pub(super) fn name(&self) -> &'static str {
        match self.wish {
            Mode::External | Mode::Hold => "hold",
            Mode::Land => "land",
            Mode::Return => "return",
        }
    }
}
