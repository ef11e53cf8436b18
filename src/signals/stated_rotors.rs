//! The rotors of a vehicle file against those that the autopilot's parameters state.

use std::collections::BTreeMap;
use std::fmt;

use crate::autopilot::{Autopilot, Layout, LayoutUnit, RotorPlace};
use crate::vehicle::{Rotor, Spin, Vehicle, direction_words};

/// Ratio of arm lengths from which they are told: arms are often stated by the class of the frame. Only a remark
/// depends on it.
pub const ARM_NOTABLE: f64 = 1.6;
/// Directions of one rotor that are further apart are of two, degrees: frames are not all as square as their
/// parameters say. Half of the angle between the arms of a hexarotor is 30 degrees.
const APART_DEG: f64 = 25.0;
/// The same as a share of the angle between neighbours, where these are close. Below half, or two neighbours would be
/// one.
const APART_SHARE: f64 = 0.4;

/// How the rotors of a vehicle file are others than those that the autopilot's parameters state.
#[derive(Debug, Clone, PartialEq)]
pub struct RotorDifference {
    /// what differs
    pub of: Differing,
    /// as the vehicle file has it
    pub file: String,
    /// as the parameters have it, with the name of the first
    pub stated: String,
}

/// What differs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Differing {
    /// how many there are
    Count,
    /// the same places in another order
    Order,
    /// where one of them is
    Place,
    /// which way one of them turns
    Spin,
    /// how far they are from the centre, by this factor, which is above 1
    Arms(f64),
}

impl fmt::Display for RotorDifference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { of, file, stated } = self;
        let what = match of {
            Differing::Count => "the number of rotors",
            Differing::Order => "the order of the rotors",
            Differing::Place => "the place of a rotor",
            Differing::Spin => "the turning direction of a rotor",
            Differing::Arms(_) => "the length of the arms",
        };
        let ask = match of {
            Differing::Order | Differing::Place | Differing::Spin => {
                "expected the file's rotors in the order of the autopilot's motors, at their places and turning their way"
            }
            Differing::Count | Differing::Arms(_) => "is it another vehicle's file?",
        };
        write!(
            f,
            "{what} contradicts the autopilot's parameters: {stated}, the vehicle file has {file}; {ask}"
        )
    }
}

/// The first difference that matters; `None` where they agree, or the parameters do not say. Lengths are compared where the
/// parameters are lengths and not ratios.
#[must_use]
pub fn rotor_difference(
    autopilot: Autopilot,
    parameters: &BTreeMap<String, f64>,
    vehicle: &Vehicle,
) -> Option<RotorDifference> {
    let stack = autopilot.stack()?;
    let parameter = |name: &str| parameters.get(name).copied();
    let layout = stack.geometry.layout(&parameter, stack.outputs.motors(&parameter)).ok()?;
    difference(&layout, &vehicle.rotors)
}

fn difference(layout: &Layout, file: &[Rotor]) -> Option<RotorDifference> {
    let by = layout.stated_by;
    if layout.rotors.len() != file.len() {
        return Some(RotorDifference {
            of: Differing::Count,
            file: file.len().to_string(),
            stated: format!("{} ({}, by {by})", layout.rotors.len(), layout.name),
        });
    }
    let apart_deg = APART_DEG.min(APART_SHARE * 360.0 / file.len() as f64);
    let is_at = |stated: &RotorPlace, rotor: &Rotor| {
        let (one, other) = (direction_deg(stated.place), direction_deg(rotor.position_m.into()));
        let turn = (one - other).rem_euclid(360.0);
        turn.min(360.0 - turn) < apart_deg
    };
    let turns = |stated: &RotorPlace, rotor: &Rotor| stated.ccw == (rotor.spin == Spin::Ccw);
    let pairs = || layout.rotors.iter().zip(file).enumerate();
    if let Some((index, (stated, rotor))) = pairs().find(|(_, (stated, rotor))| !is_at(stated, rotor)) {
        let elsewhere =
            |stated: &RotorPlace| file.iter().any(|rotor| is_at(stated, rotor) && turns(stated, rotor));
        let of = if layout.rotors.iter().all(elsewhere) { Differing::Order } else { Differing::Place };
        return Some(RotorDifference {
            of,
            file: format!(
                "its rotor {} ({}) {}",
                index + 1,
                rotor.name,
                direction_words(rotor.position_m.into())
            ),
            stated: format!(
                "motor {} is {} ({}, by {by})",
                index + 1,
                direction_words(stated.place),
                layout.name
            ),
        });
    }
    if let Some((index, (stated, rotor))) = pairs().find(|(_, (stated, rotor))| !turns(stated, rotor)) {
        let way = |ccw: bool| if ccw { "counter-clockwise" } else { "clockwise" };
        return Some(RotorDifference {
            of: Differing::Spin,
            file: format!("its rotor {} ({}) {}", index + 1, rotor.name, way(!stated.ccw)),
            stated: format!("motor {} turns {} ({}, by {by})", index + 1, way(stated.ccw), layout.name),
        });
    }
    if layout.unit == LayoutUnit::Shares {
        return None;
    }
    let mean = |sum_m: f64| sum_m / file.len() as f64;
    let file_m = mean(file.iter().map(|rotor| rotor.position_m.xy().norm()).sum());
    let stated_m = mean(layout.rotors.iter().map(|rotor| rotor.place[0].hypot(rotor.place[1])).sum());
    let factor = (file_m / stated_m).max(stated_m / file_m);
    (factor > ARM_NOTABLE).then(|| RotorDifference {
        of: Differing::Arms(factor),
        file: format!("{file_m:.3} m"),
        stated: format!("{stated_m:.3} m from the centre ({}, by {by})", layout.name),
    })
}

/// From forward to the left, degrees.
fn direction_deg([forward, left, _]: [f64; 3]) -> f64 {
    left.atan2(forward).to_degrees()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::autopilot::ARDUPILOT;
    use nalgebra::Vector3;

    fn copter(class: f64) -> Layout {
        let stated: BTreeMap<&str, f64> = [("FRAME_CLASS", class), ("FRAME_TYPE", 1.0)].into();
        ARDUPILOT.geometry.layout(&|name| stated.get(name).copied(), None).unwrap()
    }

    /// As ArduPilot numbers a quadrotor X.
    fn quad() -> Vec<Rotor> {
        let rotor = |(x, y, spin): (f64, f64, Spin)| Rotor {
            name: format!("{x} {y}"),
            position_m: Vector3::new(x, y, 0.0),
            spin,
        };
        let side = 0.2;
        [(side, -side, Spin::Ccw), (-side, side, Spin::Ccw), (side, side, Spin::Cw), (-side, -side, Spin::Cw)]
            .map(rotor)
            .into()
    }

    #[test]
    fn a_file_as_the_parameters_state_it_is_not_doubted() {
        assert_eq!(difference(&copter(1.0), &quad()), None);
        // longer than wide
        let mut long = quad();
        long.iter_mut().for_each(|rotor| rotor.position_m.x *= 1.5);
        assert_eq!(difference(&copter(1.0), &long), None);
    }

    #[test]
    fn count_order_place_spin_and_arms_are_told_apart() {
        let of = |layout: &Layout, file: &[Rotor]| difference(layout, file).map(|found| found.of);
        assert_eq!(of(&copter(2.0), &quad()), Some(Differing::Count));
        let mut swapped = quad();
        swapped.swap(0, 1);
        assert_eq!(of(&copter(1.0), &swapped), Some(Differing::Order));
        let plus: Vec<Rotor> = quad()
            .into_iter()
            .map(|rotor| Rotor {
                position_m: nalgebra::Rotation3::from_axis_angle(&Vector3::z_axis(), 0.785)
                    * rotor.position_m,
                ..rotor
            })
            .collect();
        assert_eq!(of(&copter(1.0), &plus), Some(Differing::Place));
        let mut turned = quad();
        turned[2].spin = Spin::Ccw;
        let found = difference(&copter(1.0), &turned).unwrap();
        assert_eq!(found.of, Differing::Spin);
        let said = found.to_string();
        assert!(said.contains("motor 3 turns clockwise (quadrotor X, by FRAME_CLASS)"), "{said}");
        // ratios say nothing of lengths
        let mut small = quad();
        small.iter_mut().for_each(|rotor| rotor.position_m *= 0.1);
        assert_eq!(of(&copter(1.0), &small), None);
        let mut metres = copter(1.0);
        metres.unit = LayoutUnit::Metres;
        assert!(matches!(of(&metres, &quad()), Some(Differing::Arms(factor)) if factor > 3.0));
    }
}
