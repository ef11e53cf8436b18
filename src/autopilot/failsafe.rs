//! Failsafes: parameter, value, and what the vehicle then does.

/// What a vehicle does by itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reaction {
    /// continues, perhaps with a warning
    Nothing,
    /// stops where it is
    Hold,
    /// flies home and lands
    Return,
    /// lands where it is
    Land,
    /// leaves the position to a pilot
    Position,
    /// leaves position and velocity to a pilot: it drifts
    Altitude,
    /// leaves the thrust to a pilot too
    Stabilized,
    /// rotors off in the air
    StopMotors,
}

impl Reaction {
    /// Whether a flight test wants it.
    #[must_use]
    pub fn is_safe(self) -> bool {
        matches!(self, Self::Hold | Self::Return | Self::Land)
    }
}

/// A value of a failsafe's parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Choice {
    /// the value
    pub value: i32,
    /// what the vehicle does, after `it`
    pub does: &'static str,
    /// the same
    pub reaction: Reaction,
}

/// A parameter that chooses what the vehicle does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Failsafe {
    /// its name, the older one where it was renamed
    pub parameter: &'static str,
    /// what its values mean
    pub choices: &'static [Choice],
}

impl Failsafe {
    /// What a value means; `None` for one that is not known here.
    #[must_use]
    pub fn choice(&self, value: f64) -> Option<&'static Choice> {
        self.choices.iter().find(|choice| (value - f64::from(choice.value)).abs() < 0.5)
    }
}

/// A row of a table.
pub(crate) const fn choice(value: i32, does: &'static str, reaction: Reaction) -> Choice {
    Choice { value, does, reaction }
}
