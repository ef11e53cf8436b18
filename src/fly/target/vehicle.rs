//! The vehicle that messages are for.

use crate::wire::{ComponentId, SystemId, Vehicle};

/// The one vehicle that is commanded. Zero, MAVLink's "everybody", cannot be one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Target {
    /// its system
    pub system: SystemId,
    /// its autopilot's component
    pub component: ComponentId,
}

impl Target {
    /// A vehicle; `None` for the broadcast id 0 and for ids that commands have no room for (above 255).
    #[must_use]
    pub fn new(system: SystemId, component: ComponentId) -> Option<Self> {
        (1..=255).contains(&system.0).then_some(Self { system, component })
    }

    /// The vehicle that was heard; `None` as in [`Target::new`].
    #[must_use]
    pub fn of(vehicle: &Vehicle) -> Option<Self> {
        Self::new(vehicle.system, vehicle.component)
    }

    /// The system id as messages carry it.
    #[must_use]
    pub fn system_byte(self) -> u8 {
        u8::try_from(self.system.0).unwrap_or(u8::MAX)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nobody_and_everybody_is_no_target() {
        assert!(Target::new(SystemId(0), ComponentId(1)).is_none());
        assert!(Target::new(SystemId(256), ComponentId(1)).is_none());
        assert!(Target::new(SystemId(255), ComponentId(0)).is_some());
    }
}
