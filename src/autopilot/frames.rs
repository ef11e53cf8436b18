//! Where the motors of the standard airframes are, and how they turn.

/// One motor of a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrameMotor {
    /// from forward, clockwise as seen from above, degrees
    pub bearing_deg: f64,
    /// counter-clockwise as seen from above
    pub ccw: bool,
}

impl FrameMotor {
    /// Its place on the circle of radius 1: forward and to the left.
    #[must_use]
    pub fn place(&self) -> (f64, f64) {
        let bearing = self.bearing_deg.to_radians();
        (bearing.cos(), -bearing.sin())
    }
}

/// A frame whose motors stand on one circle about the centre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// ArduPilot's FRAME_CLASS
    pub class: u8,
    /// ArduPilot's FRAME_TYPEs that mean it; none: all of the class
    pub types: &'static [u8],
    /// in words
    pub name: &'static str,
    /// in the order of the motor numbers
    pub motors: &'static [FrameMotor],
}

const fn ccw(bearing_deg: f64) -> FrameMotor {
    FrameMotor { bearing_deg, ccw: true }
}

const fn cw(bearing_deg: f64) -> FrameMotor {
    FrameMotor { bearing_deg, ccw: false }
}

const fn frame(class: u8, types: &'static [u8], name: &'static str, motors: &'static [FrameMotor]) -> Frame {
    Frame { class, types, name, motors }
}

/// FRAME_CLASS of ArduPilot, as far as its motors stand on a circle.
pub mod class {
    pub const QUAD: u8 = 1;
    pub const HEXA: u8 = 2;
    pub const OCTA: u8 = 3;
    pub const OCTA_QUAD: u8 = 4;
    pub const Y6: u8 = 5;
    pub const DODECA_HEXA: u8 = 12;
    pub const DECA: u8 = 14;
}

/// FRAME_TYPE plus and X of ArduPilot.
pub const PLUS: u8 = 0;
/// See [`PLUS`].
pub const X: u8 = 1;

/// The frames that are known here. Source: ArduPilot, `AP_MotorsMatrix`; PX4's mixers of quadrotors, hexarotors and
/// octorotors (plus and X) have the same motors in the same order.
pub const FRAMES: &[Frame] = &[
    frame(class::QUAD, &[PLUS], "quadrotor +", &[ccw(90.0), ccw(-90.0), cw(0.0), cw(180.0)]),
    frame(class::QUAD, &[X], "quadrotor X", &[ccw(45.0), ccw(-135.0), cw(-45.0), cw(135.0)]),
    frame(class::QUAD, &[3], "quadrotor H", &[cw(45.0), cw(-135.0), ccw(-45.0), ccw(135.0)]),
    frame(class::QUAD, &[6], "quadrotor + reversed", &[cw(90.0), cw(-90.0), ccw(0.0), ccw(180.0)]),
    frame(class::QUAD, &[12], "quadrotor X (Betaflight)", &[cw(135.0), ccw(45.0), ccw(-135.0), cw(-45.0)]),
    frame(class::QUAD, &[13], "quadrotor X (DJI)", &[ccw(45.0), cw(-45.0), ccw(-135.0), cw(135.0)]),
    frame(class::QUAD, &[14], "quadrotor X (clockwise)", &[ccw(45.0), cw(135.0), ccw(-135.0), cw(-45.0)]),
    frame(
        class::QUAD,
        &[18],
        "quadrotor X (Betaflight, reversed)",
        &[ccw(135.0), cw(45.0), cw(-135.0), ccw(-45.0)],
    ),
    frame(
        class::HEXA,
        &[PLUS],
        "hexarotor +",
        &[cw(0.0), ccw(180.0), cw(-120.0), ccw(60.0), ccw(-60.0), cw(120.0)],
    ),
    frame(
        class::HEXA,
        &[X],
        "hexarotor X",
        &[cw(90.0), ccw(-90.0), cw(-30.0), ccw(150.0), ccw(30.0), cw(-150.0)],
    ),
    frame(
        class::HEXA,
        &[13],
        "hexarotor X (DJI)",
        &[ccw(30.0), cw(-30.0), ccw(-90.0), cw(-150.0), ccw(150.0), cw(90.0)],
    ),
    frame(
        class::HEXA,
        &[14],
        "hexarotor X (clockwise)",
        &[ccw(30.0), cw(90.0), ccw(150.0), cw(-150.0), ccw(-90.0), cw(-30.0)],
    ),
    frame(
        class::OCTA,
        &[PLUS],
        "octorotor +",
        &[cw(0.0), cw(180.0), ccw(45.0), ccw(135.0), ccw(-45.0), ccw(-135.0), cw(-90.0), cw(90.0)],
    ),
    frame(
        class::OCTA,
        &[X],
        "octorotor X",
        &[cw(22.5), cw(-157.5), ccw(67.5), ccw(157.5), ccw(-22.5), ccw(-112.5), cw(-67.5), cw(112.5)],
    ),
    frame(
        class::OCTA,
        &[13],
        "octorotor X (DJI)",
        &[ccw(22.5), cw(-22.5), ccw(-67.5), cw(-112.5), ccw(-157.5), cw(157.5), ccw(112.5), cw(67.5)],
    ),
    frame(
        class::OCTA,
        &[14],
        "octorotor X (clockwise)",
        &[ccw(22.5), cw(67.5), ccw(112.5), cw(157.5), ccw(-157.5), cw(-112.5), ccw(-67.5), cw(-22.5)],
    ),
    frame(
        class::OCTA_QUAD,
        &[PLUS],
        "coaxial octorotor +",
        &[ccw(0.0), cw(-90.0), ccw(180.0), cw(90.0), ccw(-90.0), cw(0.0), ccw(90.0), cw(180.0)],
    ),
    frame(
        class::OCTA_QUAD,
        &[X],
        "coaxial octorotor X",
        &[ccw(45.0), cw(-45.0), ccw(-135.0), cw(135.0), ccw(-45.0), cw(45.0), ccw(135.0), cw(-135.0)],
    ),
    frame(
        class::OCTA_QUAD,
        &[3],
        "coaxial octorotor H",
        &[cw(45.0), ccw(-45.0), cw(-135.0), ccw(135.0), cw(-45.0), ccw(45.0), cw(135.0), ccw(-135.0)],
    ),
    frame(
        class::OCTA_QUAD,
        &[12],
        "coaxial octorotor X (Betaflight)",
        &[cw(135.0), ccw(45.0), ccw(-135.0), cw(-45.0), ccw(135.0), cw(45.0), cw(-135.0), ccw(-45.0)],
    ),
    frame(
        class::OCTA_QUAD,
        &[14],
        "coaxial octorotor X (clockwise)",
        &[ccw(45.0), cw(45.0), cw(135.0), ccw(135.0), ccw(-135.0), cw(-135.0), cw(-45.0), ccw(-45.0)],
    ),
    frame(
        class::OCTA_QUAD,
        &[18],
        "coaxial octorotor X (Betaflight, reversed)",
        &[ccw(135.0), cw(45.0), cw(-135.0), ccw(-45.0), cw(135.0), ccw(45.0), ccw(-135.0), cw(-45.0)],
    ),
    frame(class::Y6, &[10], "Y6 (B)", &[cw(60.0), ccw(60.0), cw(180.0), ccw(180.0), cw(-60.0), ccw(-60.0)]),
    frame(class::Y6, &[11], "Y6 (F)", &[ccw(180.0), ccw(60.0), ccw(-60.0), cw(180.0), cw(60.0), cw(-60.0)]),
    frame(class::Y6, &[], "Y6", &[ccw(60.0), cw(-60.0), ccw(-60.0), cw(180.0), cw(60.0), ccw(180.0)]),
    frame(
        class::DODECA_HEXA,
        &[PLUS],
        "coaxial dodecarotor +",
        &[
            ccw(0.0),
            cw(0.0),
            cw(60.0),
            ccw(60.0),
            ccw(120.0),
            cw(120.0),
            cw(180.0),
            ccw(180.0),
            ccw(-120.0),
            cw(-120.0),
            cw(-60.0),
            ccw(-60.0),
        ],
    ),
    frame(
        class::DODECA_HEXA,
        &[X],
        "coaxial dodecarotor X",
        &[
            ccw(30.0),
            cw(30.0),
            cw(90.0),
            ccw(90.0),
            ccw(150.0),
            cw(150.0),
            cw(-150.0),
            ccw(-150.0),
            ccw(-90.0),
            cw(-90.0),
            cw(-30.0),
            ccw(-30.0),
        ],
    ),
    frame(
        class::DECA,
        &[PLUS],
        "decarotor +",
        &[
            ccw(0.0),
            cw(36.0),
            ccw(72.0),
            cw(108.0),
            ccw(144.0),
            cw(180.0),
            ccw(-144.0),
            cw(-108.0),
            ccw(-72.0),
            cw(-36.0),
        ],
    ),
    frame(
        class::DECA,
        &[X, 14],
        "decarotor X",
        &[
            ccw(18.0),
            cw(54.0),
            ccw(90.0),
            cw(126.0),
            ccw(162.0),
            cw(-162.0),
            ccw(-126.0),
            cw(-90.0),
            ccw(-54.0),
            cw(-18.0),
        ],
    ),
];

impl Frame {
    /// As it is written on the command line: `quadrotor-x`.
    #[must_use]
    pub fn id(&self) -> String {
        let name = self.name.to_lowercase().replace('+', "plus");
        name.replace(' ', "-")
            .chars()
            .filter(|letter| letter.is_ascii_alphanumeric() || *letter == '-')
            .collect()
    }

    /// The frame of an id.
    #[must_use]
    pub fn of_id(id: &str) -> Option<&'static Self> {
        FRAMES.iter().find(|frame| frame.id() == id)
    }
}

/// The frame of ArduPilot's class and type; `None` where its motors are not known here.
#[must_use]
pub fn frame_of(class: u8, kind: u8) -> Option<&'static Frame> {
    let is_meant = |frame: &&Frame| frame.types.is_empty() || frame.types.contains(&kind);
    FRAMES.iter().filter(|frame| frame.class == class).find(is_meant)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Thrust alike of all motors turns a vehicle about no axis, and each axis can be turned about.
    #[test]
    fn motors_are_balanced() {
        for frame in FRAMES {
            let sum = frame.motors.iter().fold([0.0; 3], |sum, motor| {
                let (forward, left) = motor.place();
                let turn = if motor.ccw { 1.0 } else { -1.0 };
                [sum[0] + forward, sum[1] + left, sum[2] + turn]
            });
            assert!(sum.iter().all(|part| part.abs() < 1e-9), "{}: {sum:?}", frame.name);
            // yaw by spin must not roll or pitch: no moment of the spins about the centre
            let spin = |of: fn((f64, f64)) -> f64| -> f64 {
                frame.motors.iter().map(|m| of(m.place()) * if m.ccw { 1.0 } else { -1.0 }).sum()
            };
            assert!(spin(|(forward, _)| forward).abs() < 1e-9, "{}", frame.name);
            assert!(spin(|(_, left)| left).abs() < 1e-9, "{}", frame.name);
        }
    }

    #[test]
    fn each_frame_has_an_id_of_its_own() {
        for frame in FRAMES {
            assert_eq!(Frame::of_id(&frame.id()), Some(frame));
        }
        assert_eq!(FRAMES[1].id(), "quadrotor-x");
        assert_eq!(FRAMES[3].id(), "quadrotor-plus-reversed");
    }

    #[test]
    fn a_frame_is_found_by_class_and_type() {
        assert_eq!(frame_of(class::QUAD, X).unwrap().name, "quadrotor X");
        assert_eq!(frame_of(class::Y6, 99).unwrap().name, "Y6");
        assert!(frame_of(class::QUAD, 4).is_none() && frame_of(6, 0).is_none());
        let (forward, left) = frame_of(class::QUAD, X).unwrap().motors[0].place();
        assert!(forward > 0.0 && left < 0.0);
    }
}
