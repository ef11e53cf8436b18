//! Where the autopilot's parameters say that the rotors are.

use super::frames::{Frame, FrameMotor, class, frame_of};
use super::outputs::Numbered;

/// Parameters that say where the rotors are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Geometry {
    /// a place and a turning direction for each rotor; before there were these, an airframe's number
    Rotors {
        /// how many
        count: &'static str,
        /// forward, to the right, down; numbered from 0
        place: [Numbered; 3],
        /// torque for each thrust, positive where a rotor turns counter-clockwise; numbered from 0
        turning: Numbered,
        /// number of the airframe
        airframe: &'static str,
        /// first and last airframe of each frame
        frames: &'static [(u32, u32, u8, u8)],
    },
    /// a class and a type of frame
    Class {
        /// class
        class: &'static str,
        /// type
        kind: &'static str,
        /// the type, in releases whose class was fixed when they were built
        former: &'static str,
    },
}

/// One rotor of a layout.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RotorPlace {
    /// forward, left, up
    pub place: [f64; 3],
    /// counter-clockwise as seen from above
    pub ccw: bool,
}

/// What the numbers of a layout mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LayoutUnit {
    /// metres
    Metres,
    /// shares: only ratios are known
    Shares,
}

/// Rotors as the parameters place them.
#[derive(Debug, Clone, PartialEq)]
pub struct Layout {
    /// which frame, in words
    pub name: String,
    /// the parameters that say so
    pub stated_by: &'static str,
    /// in the order of the motor numbers
    pub rotors: Vec<RotorPlace>,
    /// of the places
    pub unit: LayoutUnit,
}

impl Layout {
    /// Largest distance of a rotor from the centre, in the layout's unit.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.rotors.iter().map(|rotor| rotor.place[0].hypot(rotor.place[1])).fold(0.0, f64::max)
    }

    /// A frame on a circle of radius 1.
    #[must_use]
    pub fn of(frame: &Frame, stated_by: &'static str) -> Self {
        let rotor = |motor: &FrameMotor| {
            let (forward, left) = motor.place();
            RotorPlace { place: [forward, left, 0.0], ccw: motor.ccw }
        };
        let rotors = frame.motors.iter().map(rotor).collect();
        Self { name: frame.name.to_owned(), stated_by, rotors, unit: LayoutUnit::Shares }
    }
}

/// Why parameters give no layout.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum LayoutError {
    /// none of them is known
    #[error("expected {0} among the parameters, got none of them")]
    Missing(String),
    /// releases that state the frame without the number of motors
    #[error(
        "expected {class} among the parameters, got {former} = {frame} of an older release, which does not state how many motors \
         there are"
    )]
    Former {
        /// the parameter that states it since
        class: String,
        /// the older one
        former: String,
        /// what it is
        frame: f64,
    },
    /// a frame that is not known here
    #[error("expected a frame whose motors are known, got {0}")]
    Unknown(String),
    /// places that no vehicle has
    #[error("expected {expected}, got {came}")]
    Implausible {
        /// of the places
        expected: &'static str,
        /// what stands there
        came: String,
    },
}

/// Coordinates of PX4's generic airframes, which are ratios: quadrotors have 1 (0.15 in older releases), others a circle of
/// 0.5.
const GENERIC_COORDINATE: [f64; 2] = [1.0, 0.15];
/// See [`GENERIC_COORDINATE`].
const GENERIC_RADIUS: f64 = 0.5;
/// Largest arm that is taken for metres: a rotor further out is a ratio.
const ARM_MOST_M: f64 = 1.5;
/// Most rotors that are looked for.
const ROTORS_MOST: u8 = 16;

impl Geometry {
    /// The layout that the parameters state. `motors`, where known, is the number of outputs that drive motors.
    ///
    /// # Errors
    /// [`LayoutError`] where parameters are missing, or state what is not known here or cannot be.
    pub fn layout(
        &self,
        parameter: &dyn Fn(&str) -> Option<f64>,
        motors: Option<usize>,
    ) -> Result<Layout, LayoutError> {
        match self {
            Self::Rotors { count, place, turning, airframe, frames } => {
                match parameter(count).filter(|count| *count >= 1.0) {
                    Some(rotors) => of_rotors(parameter, (count, rotors), place, turning),
                    None => of_airframe(parameter(airframe), airframe, frames, count),
                }
            }
            Self::Class { class: name, kind, former } => {
                let (class, stated_by) = match (parameter(name), motors) {
                    (Some(class), _) => (class, *name),
                    (None, Some(motors)) => (class_of(motors).map_or(-1.0, f64::from), *former),
                    (None, None) => {
                        return Err(match parameter(former) {
                            Some(frame) => LayoutError::Former {
                                class: (*name).to_owned(),
                                former: (*former).to_owned(),
                                frame,
                            },
                            None => LayoutError::Missing((*name).to_owned()),
                        });
                    }
                };
                let Some(kind_number) = parameter(kind).or_else(|| parameter(former)) else {
                    return Err(LayoutError::Missing(format!("{kind} or {former}")));
                };
                let found =
                    byte(class).zip(byte(kind_number)).and_then(|(class, kind)| frame_of(class, kind));
                found.map(|frame| Layout::of(frame, stated_by)).ok_or_else(|| {
                    LayoutError::Unknown(format!("{name} = {class} and {kind} = {kind_number}"))
                })
            }
        }
    }
}

/// The class with this many motors, each on an arm of its own.
fn class_of(motors: usize) -> Option<u8> {
    match motors {
        4 => Some(class::QUAD),
        6 => Some(class::HEXA),
        8 => Some(class::OCTA),
        _ => None,
    }
}

fn byte(value: f64) -> Option<u8> {
    (0..=u8::MAX).find(|byte| f64::from(*byte) == value)
}

fn of_airframe(
    number: Option<f64>,
    parameter: &'static str,
    frames: &[(u32, u32, u8, u8)],
    count: &str,
) -> Result<Layout, LayoutError> {
    let Some(number) = number else { return Err(LayoutError::Missing(format!("{count} or {parameter}"))) };
    let is_in =
        |(first, last, ..): &&(u32, u32, u8, u8)| (f64::from(*first)..=f64::from(*last)).contains(&number);
    let found = frames.iter().find(is_in).and_then(|(_, _, class, kind)| frame_of(*class, *kind));
    found
        .map(|frame| Layout::of(frame, parameter))
        .ok_or_else(|| LayoutError::Unknown(format!("{parameter} = {number}")))
}

fn of_rotors(
    parameter: &dyn Fn(&str) -> Option<f64>,
    (count, rotors): (&'static str, f64),
    place: &[Numbered; 3],
    turning: &Numbered,
) -> Result<Layout, LayoutError> {
    let implausible = |expected, came: String| LayoutError::Implausible { expected, came };
    let Some(rotors) = byte(rotors).filter(|rotors| *rotors <= ROTORS_MOST) else {
        return Err(implausible("1 to 16 rotors", format!("{count} = {rotors}")));
    };
    let one = |number: usize| -> Result<RotorPlace, LayoutError> {
        let value = |of: &Numbered| {
            let name = of.name(number);
            parameter(&name).filter(|value| value.is_finite()).ok_or(LayoutError::Missing(name))
        };
        // forward, right, down become forward, left, up; older releases state no height
        let (forward, right) = (value(&place[0])?, value(&place[1])?);
        let down = value(&place[2]).unwrap_or(0.0);
        Ok(RotorPlace { place: [forward, -right, -down], ccw: value(turning)? > 0.0 })
    };
    let rotors: Vec<RotorPlace> = (0..usize::from(rotors)).map(one).collect::<Result<_, _>>()?;
    let layout = Layout {
        name: format!("{} rotors", rotors.len()),
        stated_by: count,
        rotors,
        unit: LayoutUnit::Metres,
    };
    if layout.radius() <= 0.0 {
        return Err(implausible("rotors away from the centre", format!("all {}.. at 0", place[0].name(0))));
    }
    let unit = if is_metres(&layout) { LayoutUnit::Metres } else { LayoutUnit::Shares };
    Ok(Layout { unit, ..layout })
}

/// The places are lengths, and not the ratios of a generic airframe.
fn is_metres(layout: &Layout) -> bool {
    let near = |a: f64, b: f64| (a - b).abs() < 0.01 * b;
    let side = layout.rotors.iter().flat_map(|rotor| [rotor.place[0].abs(), rotor.place[1].abs()]);
    let side = side.fold(0.0, f64::max);
    let radius = layout.radius();
    let generic = if layout.rotors.len() == 4 {
        GENERIC_COORDINATE.iter().any(|generic| near(side, *generic))
    } else {
        near(radius, GENERIC_RADIUS)
    };
    !generic && radius < ARM_MOST_M
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::autopilot::{ARDUPILOT, PX4};
    use std::collections::BTreeMap;

    fn layout(geometry: &Geometry, stated: &[(&str, f64)]) -> Result<Layout, LayoutError> {
        let stated: BTreeMap<&str, f64> = stated.iter().copied().collect();
        geometry.layout(&|name| stated.get(name).copied(), None)
    }

    fn px4_quad(side: f64) -> Vec<(&'static str, f64)> {
        vec![
            ("CA_ROTOR_COUNT", 4.0),
            ("CA_ROTOR0_PX", side),
            ("CA_ROTOR0_PY", side),
            ("CA_ROTOR0_KM", 0.05),
            ("CA_ROTOR1_PX", -side),
            ("CA_ROTOR1_PY", -side),
            ("CA_ROTOR1_KM", 0.05),
            ("CA_ROTOR2_PX", side),
            ("CA_ROTOR2_PY", -side),
            ("CA_ROTOR2_KM", -0.05),
            ("CA_ROTOR3_PX", -side),
            ("CA_ROTOR3_PY", side),
            ("CA_ROTOR3_KM", -0.05),
        ]
    }

    #[test]
    fn ratios_are_not_taken_for_metres() {
        for (side, unit) in
            [(1.0, LayoutUnit::Shares), (0.15, LayoutUnit::Shares), (0.174, LayoutUnit::Metres)]
        {
            let found = layout(&PX4.geometry, &px4_quad(side)).unwrap();
            assert_eq!(found.unit, unit, "{side}");
            // front right turns counter-clockwise; the body's y points to the left
            assert_eq!(found.rotors[0], RotorPlace { place: [side, -side, -0.0], ccw: true });
        }
    }

    #[test]
    fn a_class_and_a_type_say_the_frame() {
        let found = layout(&ARDUPILOT.geometry, &[("FRAME_CLASS", 2.0), ("FRAME_TYPE", 1.0)]).unwrap();
        assert_eq!((found.name.as_str(), found.rotors.len()), ("hexarotor X", 6));
        let heli = layout(&ARDUPILOT.geometry, &[("FRAME_CLASS", 6.0), ("FRAME_TYPE", 0.0)]);
        assert!(heli.unwrap_err().to_string().contains("FRAME_CLASS = 6"));
        assert!(matches!(layout(&ARDUPILOT.geometry, &[]), Err(LayoutError::Missing(_))));
    }

    #[test]
    fn an_airframe_of_old_says_the_frame() {
        let found = layout(&PX4.geometry, &[("SYS_AUTOSTART", 6001.0)]).unwrap();
        assert_eq!(found.name, "hexarotor X");
        assert!(layout(&PX4.geometry, &[("SYS_AUTOSTART", 2100.0)]).is_err());
    }

    #[test]
    fn a_missing_place_is_named() {
        let stated = px4_quad(0.2);
        let found = layout(&PX4.geometry, &stated[..stated.len() - 1]);
        assert_eq!(found, Err(LayoutError::Missing("CA_ROTOR3_KM".to_owned())));
        let at_centre = layout(&PX4.geometry, &px4_quad(0.0));
        assert!(matches!(at_centre, Err(LayoutError::Implausible { .. })));
    }
}
