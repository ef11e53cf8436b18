//! What a log says of the vehicle that wrote it.

use super::message::Message;
use crate::autopilot::{Autopilot, VehicleKind};
use crate::text;
use crate::units::whole_unsigned;
use crate::wire::{ComponentId, SystemId, Vehicle};

/// MAVLink's number of an autopilot, where a log does not say it.
const AUTOPILOT_COMPONENT: u8 = 1;
/// `ver_sw` is a commit; so much of it tells it.
const COMMIT_LETTERS: usize = 8;

/// What a log says of the vehicle that wrote it.
#[derive(Debug, Clone, Default)]
pub(super) struct Craft {
    system_name: Option<String>,
    board: Option<String>,
    commit: Option<String>,
    release: Option<u32>,
    mav_type: Option<u8>,
    system: Option<u32>,
    component: Option<u8>,
}

impl Craft {
    /// Takes what a message says of it.
    pub(super) fn take(&mut self, message: &Message<'_>) {
        match message {
            Message::Info { kind, key, value } => self.info(kind, key, value),
            Message::Parameter { name, value } => self.parameter(name, *value),
            _ => {}
        }
    }

    fn info(&mut self, kind: &str, key: &str, value: &[u8]) {
        let words = || Some(text::clean(String::from_utf8_lossy(value).trim_end_matches('\0')));
        match key {
            "sys_name" => self.system_name = words(),
            "ver_hw" => self.board = words(),
            "ver_sw" => self.commit = words(),
            "ver_sw_release" if kind == "uint32_t" => {
                self.release = value.first_chunk().copied().map(u32::from_le_bytes);
            }
            _ => {}
        }
    }

    fn parameter(&mut self, name: &str, value: f64) {
        let byte = || u8::try_from(whole_unsigned(value)).ok();
        match name {
            "MAV_TYPE" => self.mav_type = byte(),
            "MAV_SYS_ID" => self.system = Some(whole_unsigned(value)),
            "MAV_COMP_ID" => self.component = byte(),
            _ => {}
        }
    }

    /// Its kind, where the log says it.
    pub(super) fn kind(&self) -> Option<VehicleKind> {
        VehicleKind::of_mav_type(self.mav_type?)
    }

    /// Its MAVLink numbers, where the log says them.
    pub(super) fn vehicle(&self, autopilot: Autopilot) -> Option<Vehicle> {
        let component = ComponentId(self.component.unwrap_or(AUTOPILOT_COMPONENT));
        Some(Vehicle { system: SystemId(self.system?), component, autopilot, kind: self.kind() })
    }

    /// The software: `PX4 1.15.0 (c78389a3) on CUBEPILOT_CUBEORANGE`, as far as the log says it.
    pub(super) fn firmware(&self) -> Option<String> {
        let mut words = self.system_name.clone()?;
        if let Some([_, patch, minor, major]) = self.release.map(u32::to_le_bytes) {
            words.push_str(&format!(" {major}.{minor}.{patch}"));
        }
        if let Some(commit) = &self.commit {
            words.push_str(&format!(" ({})", commit.chars().take(COMMIT_LETTERS).collect::<String>()));
        }
        if let Some(board) = &self.board {
            words.push_str(&format!(" on {board}"));
        }
        Some(words)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_vehicle_is_put_together_from_what_is_said() {
        let mut craft = Craft::default();
        assert_eq!((craft.firmware(), craft.kind()), (None, None));
        let info = |kind, key, value| Message::Info { kind, key, value };
        craft.take(&info("char[3]", "sys_name", b"PX4"));
        craft.take(&info("uint32_t", "ver_sw_release", &[255, 4, 15, 1]));
        craft.take(&info("char[12]", "ver_sw", b"abcdef012345"));
        craft.take(&info("char[2]", "ver_hw", b"X1"));
        craft.take(&Message::Parameter { name: "MAV_TYPE", value: 22.0 });
        craft.take(&Message::Parameter { name: "MAV_SYS_ID", value: 7.0 });
        assert_eq!(craft.firmware().as_deref(), Some("PX4 1.15.4 (abcdef01) on X1"));
        assert_eq!(craft.kind(), Some(VehicleKind::Vtol));
        assert_eq!(craft.vehicle(Autopilot::Px4).map(|vehicle| vehicle.system), Some(SystemId(7)));
    }
}
