//! Which modes a vehicle may be in by the program's doing.

use super::wire::Left;

/// What the laws have to know beside the trace.
#[derive(Debug, Clone, Copy)]
pub struct Given {
    pub px4: bool,
    /// |x|, |y|, least and greatest z, m
    pub room_m: [f64; 4],
    /// the plan's frame is where the vehicle stood, not the local one
    pub here: bool,
}

impl Given {
    pub fn external(&self) -> u32 {
        if self.px4 { 6 << 16 } else { 4 }
    }

    /// Modes in which a vehicle that nobody steers is safe: hold, land, return, brake, a pilot's.
    pub fn is_safe(&self, mode: u32) -> bool {
        let px4 = [4 << 16 | 3 << 24, 4 << 16 | 5 << 24, 4 << 16 | 6 << 24, 3 << 16, 2 << 16, 7 << 16];
        if self.px4 { px4.contains(&mode) } else { [5, 6, 9, 17, 2, 16, 0].contains(&mode) }
    }
}

/// Which modes the vehicle may be in by our doing: ours, then those that were asked for, in their order.
#[derive(Debug, Clone)]
pub struct Ours {
    /// something that steers or commands left: what was before is nobody's business
    begun: bool,
    /// the mode that was seen last
    shown: Option<u32>,
    wishes: Vec<u32>,
    /// of the latest that was seen; `None` before ours was
    at: Option<usize>,
    external: u32,
}

impl Ours {
    pub fn new(given: &Given) -> Self {
        Self {
            begun: false,
            shown: None,
            wishes: vec![given.external()],
            at: None,
            external: given.external(),
        }
    }

    pub fn left(&mut self, left: &Left) {
        let begins = left.commands() || matches!(left, Left::Setpoint(_));
        if begins && !self.begun {
            self.begun = true;
            self.at = (self.shown == Some(self.external)).then_some(0);
        }
        if let Left::Mode(mode) = left
            && *mode != self.external
            && self.wishes.last() != Some(mode)
        {
            self.wishes.push(*mode);
        }
    }

    /// Whether the mode is one of ours, or ours was not entered yet.
    pub fn admits(&mut self, mode: u32) -> bool {
        self.shown = Some(mode);
        if !self.begun {
            return true;
        }
        let from = self.at.unwrap_or(0);
        let found = self.wishes[from..].iter().position(|wish| *wish == mode).map(|at| from + at);
        match (self.at, found) {
            (None, Some(0)) | (Some(_), Some(_)) => {
                self.at = found;
                true
            }
            (None, _) => true,
            (Some(_), None) => false,
        }
    }
}
