//! The autopilots for whose parameters a model is written, one table each.

use crate::autopilot::Autopilot;
use crate::vehicle::Vehicle;

/// An autopilot's parameters that can follow from a model.
pub(super) struct Table {
    pub(super) autopilot: Autopilot,
    /// as in messages
    pub(super) name: &'static str,
    /// name of the file's format
    pub(super) format: &'static str,
    pub(super) thrust: ThrustNames,
    pub(super) drag: DragNames,
    /// what does not follow from any model
    pub(super) never: &'static str,
}

/// Names and documented bounds of the thrust law's parameters.
pub(super) struct ThrustNames {
    pub(super) curve: &'static str,
    pub(super) curve_bounds: (f64, f64),
    pub(super) hover: &'static str,
    pub(super) hover_bounds: (f64, f64),
    /// the autopilot divides the throttle by the density of the air over that at sea level, and holds what is before that
    pub(super) by_density: bool,
}

/// Names of the parameters of the estimator's drag, and its law.
pub(super) struct DragNames {
    pub(super) control: Option<&'static str>,
    pub(super) momentum: &'static str,
    pub(super) ballistic: [&'static str; 2],
    /// largest ballistic coefficient that the autopilot documents, kg/m^2
    pub(super) most_ballistic: f64,
    /// its quadratic drag goes with the airspeed along each axis alone (1), or with the whole airspeed (0)
    pub(super) by_face: f64,
    /// the same in words
    pub(super) law: &'static str,
}

static TABLES: [Table; 2] = [
    Table {
        autopilot: Autopilot::Px4,
        name: "PX4",
        format: "px4-params",
        thrust: ThrustNames {
            curve: "THR_MDL_FAC",
            curve_bounds: (0.0, 1.0),
            hover: "MPC_THR_HOVER",
            hover_bounds: (0.1, 0.8),
            by_density: false,
        },
        drag: DragNames {
            control: Some("EKF2_DRAG_CTRL"),
            momentum: "EKF2_MCOEF",
            ballistic: ["EKF2_BCOEF_X", "EKF2_BCOEF_Y"],
            most_ballistic: 200.0,
            by_face: 0.0,
            law: "the whole airspeed, with an elliptic mean of the coefficients between the axes",
        },
        never: "CA_ROTORn_KM does not follow from the model: the torque of a rotor is the vehicle file's",
    },
    Table {
        autopilot: Autopilot::ArduPilot,
        name: "ArduPilot",
        format: "ardupilot-params",
        thrust: ThrustNames {
            curve: "MOT_THST_EXPO",
            curve_bounds: (-1.0, 1.0),
            hover: "MOT_THST_HOVER",
            hover_bounds: (0.125, 0.6875),
            by_density: true,
        },
        drag: DragNames {
            control: None,
            momentum: "EK3_DRAG_MCOEF",
            ballistic: ["EK3_DRAG_BCOEF_X", "EK3_DRAG_BCOEF_Y"],
            most_ballistic: 1000.0,
            by_face: 1.0,
            law: "the airspeed along that axis alone",
        },
        never: "MOT_SPIN_ARM, MOT_SPIN_MIN and MOT_SPIN_MAX do not follow from the model: a flight does not show where motors stop",
    },
];

impl Table {
    /// The table of an autopilot; `None` of one whose parameters are not known.
    pub(super) fn of(autopilot: Autopilot) -> Option<&'static Self> {
        TABLES.iter().find(|table| table.autopilot == autopilot)
    }

    /// The autopilot whose parameter the vehicle's guesses name, where it is another one than this: its name, and that parameter.
    pub(super) fn other_of(&self, vehicle: &Vehicle) -> Option<(&'static str, &'static str)> {
        let others = TABLES.iter().filter(|table| table.autopilot != self.autopilot);
        let named = |name: &str| vehicle.guesses.iter().any(|guess| guess.why.contains(name));
        let mut each =
            others.flat_map(|table| [table.thrust.curve, table.thrust.hover].map(|name| (table.name, name)));
        each.find(|(_, name)| named(name))
    }

    /// PX4: its allocation holds places and coefficients of the rotors, and its file types.
    pub(super) fn is_px4(&self) -> bool {
        self.autopilot == Autopilot::Px4
    }
}
