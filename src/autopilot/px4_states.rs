//! PX4's internal number of a mode, as its own log holds it.

use super::px4::{ALTITUDE, LAND, LOITER, OFFBOARD, POSITION, RETURN, STABILIZED, TAKEOFF, number};

/// The first of eight modes of companions, and how many there are.
const EXTERNAL: (i32, u8) = (23, 8);

/// `custom_mode` of a `vehicle_status.nav_state`, as PX4 itself sends it; `None` for one that is not known here.
#[must_use]
pub fn px4_mode_of_state(nav_state: i32) -> Option<u32> {
    let (first, count) = EXTERNAL;
    let companion = u8::try_from(nav_state - first).ok().filter(|index| *index < count);
    Some(match nav_state {
        // one that was terminated is shown as MANUAL
        0 | 13 => number(1, 0),
        1 => ALTITUDE.number,
        2 => POSITION.number,
        3 => number(4, 4),
        4 => LOITER.number,
        5 => RETURN.number,
        6 => number(3, 2),
        10 => number(5, 0),
        // it descends without position, which is shown as landing
        12 | 18 => LAND.number,
        14 => OFFBOARD.number,
        15 => STABILIZED.number,
        16 => number(8, 0),
        17 => TAKEOFF.number,
        19 => number(4, 8),
        20 => number(4, 9),
        21 => number(3, 1),
        22 => number(4, 10),
        _ => number(4, 11 + companion?),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::autopilot::PX4;

    #[test]
    fn every_state_is_a_mode_that_is_known() {
        let numbers: Vec<u32> = (-5..60).filter_map(px4_mode_of_state).collect();
        assert_eq!(numbers.len(), 27);
        assert!(numbers.iter().all(|number| PX4.mode(*number).is_some()));
        assert_eq!(px4_mode_of_state(14), Some(OFFBOARD.number));
        assert_eq!(
            px4_mode_of_state(30).map(|number| PX4.mode_name(number)).as_deref(),
            Some("AUTO.EXTERNAL8")
        );
        assert_eq!(px4_mode_of_state(31), None);
    }
}
