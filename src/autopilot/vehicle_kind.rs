//! What kind of vehicle an autopilot flies or steers.

use mavlink::dialects::ardupilotmega::MavType;

use super::vehicle_type::is_multirotor;

/// What kind of vehicle an autopilot flies or steers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VehicleKind {
    /// three rotors or more that hold it up
    Multirotor,
    /// one large rotor
    Helicopter,
    /// wings
    Plane,
    /// wings, and rotors to take off with
    Vtol,
    /// wheels, or a boat's hull
    Rover,
    /// under water
    Submarine,
    /// none of these
    Other,
}

const PLANES: [MavType; 3] =
    [MavType::MAV_TYPE_FIXED_WING, MavType::MAV_TYPE_FLAPPING_WING, MavType::MAV_TYPE_KITE];
const HELICOPTERS: [MavType; 1] = [MavType::MAV_TYPE_HELICOPTER];
const VTOLS: [MavType; 7] = [
    MavType::MAV_TYPE_VTOL_TAILSITTER_DUOROTOR,
    MavType::MAV_TYPE_VTOL_TAILSITTER_QUADROTOR,
    MavType::MAV_TYPE_VTOL_TILTROTOR,
    MavType::MAV_TYPE_VTOL_FIXEDROTOR,
    MavType::MAV_TYPE_VTOL_TAILSITTER,
    MavType::MAV_TYPE_VTOL_TILTWING,
    MavType::MAV_TYPE_VTOL_RESERVED5,
];
const ROVERS: [MavType; 2] = [MavType::MAV_TYPE_GROUND_ROVER, MavType::MAV_TYPE_SURFACE_BOAT];
const SUBMARINES: [MavType; 1] = [MavType::MAV_TYPE_SUBMARINE];

impl VehicleKind {
    /// Of a MAV_TYPE; `None` for 0, which is "not said".
    #[must_use]
    pub fn of_mav_type(mav_type: u8) -> Option<Self> {
        let among = |types: &[MavType]| types.iter().any(|known| *known as u32 == u32::from(mav_type));
        match mav_type {
            0 => None,
            _ if is_multirotor(mav_type) => Some(Self::Multirotor),
            _ if among(&HELICOPTERS) => Some(Self::Helicopter),
            _ if among(&PLANES) => Some(Self::Plane),
            _ if among(&VTOLS) => Some(Self::Vtol),
            _ if among(&ROVERS) => Some(Self::Rover),
            _ if among(&SUBMARINES) => Some(Self::Submarine),
            _ => Some(Self::Other),
        }
    }

    /// The same by the autopilot's parameters: a quadplane of ArduPilot says that it is a plane.
    #[must_use]
    pub fn by_parameters(self, parameter: impl Fn(&str) -> Option<f64>) -> Self {
        let has_rotors = || parameter("Q_ENABLE").is_some_and(|value| value > 0.5);
        if self == Self::Plane && has_rotors() { Self::Vtol } else { self }
    }

    /// It leaves the ground.
    #[must_use]
    pub fn flies(self) -> bool {
        !matches!(self, Self::Rover | Self::Submarine)
    }

    /// In words.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Multirotor => "multirotor",
            Self::Helicopter => "helicopter",
            Self::Plane => "plane",
            Self::Vtol => "VTOL plane",
            Self::Rover => "rover or boat",
            Self::Submarine => "submarine",
            Self::Other => "vehicle of another kind",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::VehicleKind;

    #[test]
    fn the_kind_follows_from_the_mav_type() {
        let kinds = [0, 1, 2, 4, 10, 11, 12, 14, 22, 35].map(VehicleKind::of_mav_type);
        let [unsaid, plane, quad, helicopter, rover, boat, submarine, octa, vtol, deca] = kinds;
        assert_eq!(unsaid, None);
        assert_eq!((plane, helicopter), (Some(VehicleKind::Plane), Some(VehicleKind::Helicopter)));
        assert_eq!([quad, octa, deca], [Some(VehicleKind::Multirotor); 3]);
        assert_eq!([rover, boat], [Some(VehicleKind::Rover); 2]);
        assert_eq!((submarine, vtol), (Some(VehicleKind::Submarine), Some(VehicleKind::Vtol)));
        let with = |value| move |name: &str| (name == "Q_ENABLE").then_some(value);
        assert_eq!(VehicleKind::Plane.by_parameters(with(1.0)), VehicleKind::Vtol);
        assert_eq!(VehicleKind::Plane.by_parameters(with(0.0)), VehicleKind::Plane);
        assert_eq!(VehicleKind::Multirotor.by_parameters(with(1.0)), VehicleKind::Multirotor);
        assert_eq!([VehicleKind::Vtol, VehicleKind::Submarine].map(VehicleKind::flies), [true, false]);
    }
}
