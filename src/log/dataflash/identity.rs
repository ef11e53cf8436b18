//! Which vehicle wrote a log, by its own words.

use crate::autopilot::VehicleKind;

/// How the software begins to say its name. Rover was `APMrover2` and steers boats as well.
const SOFTWARE: &[(&str, VehicleKind)] = &[
    ("ArduCopter", VehicleKind::Multirotor),
    ("APM:Copter", VehicleKind::Multirotor),
    ("ArduPlane", VehicleKind::Plane),
    ("APM:Plane", VehicleKind::Plane),
    ("ArduRover", VehicleKind::Rover),
    ("APMrover2", VehicleKind::Rover),
    ("APM:Rover", VehicleKind::Rover),
    ("Rover", VehicleKind::Rover),
    ("ArduSub", VehicleKind::Submarine),
    ("Blimp", VehicleKind::Other),
    ("AntennaTracker", VehicleKind::Other),
];

/// Parameters that one software alone has, for logs that do not say which it was.
const OWN_PARAMETERS: &[(&str, VehicleKind)] = &[
    ("MOT_SPIN_ARM", VehicleKind::Multirotor),
    ("MOT_SPIN_ARMED", VehicleKind::Multirotor),
    ("MOT_TB_RATIO", VehicleKind::Multirotor),
    ("TRIM_ARSPD_CM", VehicleKind::Plane),
    ("AIRSPEED_CRUISE", VehicleKind::Plane),
    ("CRUISE_SPEED", VehicleKind::Rover),
    ("JS_GAIN_DEFAULT", VehicleKind::Submarine),
];

/// Values of FRAME_CLASS that are helicopters: one rotor, two in a row, four with pitch.
const HELICOPTERS: [f64; 3] = [6.0, 11.0, 13.0];

/// Which vehicle wrote a log, as far as it has said.
#[derive(Debug, Default)]
pub(super) struct Identity {
    firmware: Option<String>,
    software: Option<VehicleKind>,
    by_parameter: Option<VehicleKind>,
    is_helicopter: bool,
    is_vtol: bool,
}

impl Identity {
    /// Takes a text of the log.
    pub(super) fn text(&mut self, text: &str) {
        if self.software.is_none() {
            let found = SOFTWARE.iter().find(|(name, _)| text.starts_with(name));
            if let Some((_, kind)) = found.filter(|(name, _)| text.len() > name.len()) {
                self.software = Some(*kind);
                self.firmware = Some(text.to_owned());
            }
        }
        self.is_helicopter |= text.starts_with("Frame: HELI");
    }

    /// Takes a parameter.
    pub(super) fn parameter(&mut self, name: &str, value: f64) {
        match name {
            "FRAME_CLASS" => self.is_helicopter |= HELICOPTERS.contains(&value),
            // swash plates are of helicopters alone
            "H_SV_MAN" | "H_SWASH_TYPE" | "H_SW_TYPE" | "HSV_MAN" => self.is_helicopter = true,
            "Q_ENABLE" => self.is_vtol = value > 0.5,
            _ => {
                let own = OWN_PARAMETERS.iter().find(|(own, _)| *own == name);
                self.by_parameter = self.by_parameter.or(own.map(|(_, kind)| *kind));
            }
        }
    }

    /// What kind of vehicle it is; `None` where the log does not say.
    pub(super) fn kind(&self) -> Option<VehicleKind> {
        match self.software.or(self.by_parameter)? {
            VehicleKind::Multirotor if self.is_helicopter => Some(VehicleKind::Helicopter),
            VehicleKind::Plane if self.is_vtol => Some(VehicleKind::Vtol),
            kind => Some(kind),
        }
    }

    /// The software in its own words.
    pub(super) fn firmware(&self) -> Option<String> {
        self.firmware.clone()
    }
}
