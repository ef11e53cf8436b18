//! How far a vehicle is on its way out of our mode.

use std::time::Duration;

use crate::autopilot::Mode;
use crate::fly::safety::Sustained;

/// On the way out.
#[derive(Debug)]
pub(super) struct Leaving {
    pub(super) wish: Mode,
    /// the mode that it was in, by our doing, when that was wished for
    pub(super) from: Option<u32>,
    pub(super) wished: Duration,
    /// the command for it left: a mode that shows before is somebody else's choice
    pub(super) ordered: bool,
    /// when it was last asked for
    pub(super) asked: Duration,
    /// when the wished mode was first seen
    pub(super) reached: Option<Duration>,
    /// seen in another mode after that, and whether it ever was in the air
    pub(super) left: Sustained,
    pub(super) strayed: bool,
    /// somebody decides what follows a hold
    pub(super) by_operator: bool,
    /// the program ends by then
    pub(super) stop_by: Option<Duration>,
    pub(super) landed: Sustained,
    /// when it was last told to disarm
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

    /// The command for it left.
    pub(super) fn ordered(&mut self) {
        self.ordered = true;
    }

    pub(super) fn is_ordered(&self) -> bool {
        self.ordered
    }

    /// It was seen in another mode after the one that was wished for: somebody else flies it.
    pub(super) fn has_strayed(&self) -> bool {
        self.strayed
    }

    /// It was in this mode when it was told to leave it, and is not seen to have left it. Who shows it again afterwards is
    /// flown by somebody else.
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
