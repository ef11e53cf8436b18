//! Transitions from takeoff to the series' start, and from its end to the landing place, inside the limits.

use super::bounds::{Bound, Dynamics, Quantity};
use super::check::{Violation, check};
use crate::trajectory::{EndState, FlightPath, FourierTrajectory, Segment, Transition, at_rest, end_state};

/// Hover with which a flight along a trajectory begins, and the one with which it ends, s. The controller settles in it; more
/// costs battery.
pub const HOVER_S: f64 = 2.0;

/// Hovers, transitions and periods of a flight.
#[derive(Debug, Clone, PartialEq)]
pub struct FlightPlan {
    /// x, y, z (m) and psi (rad) where the vehicle hovers after takeoff
    pub takeoff: [f64; 4],
    /// where it hovers before it lands
    pub landing: [f64; 4],
    /// s of hover before and after
    pub hover_s: f64,
    /// periods of the series
    pub repeats: u32,
}

/// Errors of a transition.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("no transition {between} keeps the limits, the slowest tried takes {duration_s:.1} s: {violation}")]
pub struct TransitionError {
    /// which transition
    pub between: &'static str,
    /// the longest duration tried, s
    pub duration_s: f64,
    /// the violated bound
    pub violation: Violation,
}

/// Shortest and longest transition that is tried, s. Nothing is flown from rest in less, and a battery is too short
/// for more.
const DURATION_S: (f64, f64) = (1.0, 60.0);
/// Ratio of a tried duration to the one before. A finer ratio takes longer and saves less than 15 % of a transition.
const DURATION_RATIO: f64 = 1.15;

/// The path of hover, transition, series, transition and hover. The bounds of height hold for the series; a transition
/// may be below `z_min`, near takeoff and landing.
///
/// # Errors
/// If no transition inside the limits is found.
pub fn flight_path(
    series: &FourierTrajectory,
    flight: &FlightPlan,
    bounds: &[Bound],
    dynamics: &Dynamics,
) -> Result<FlightPath, TransitionError> {
    let bounds: Vec<Bound> = bounds.iter().map(without_floor).collect();
    let joint = end_state(&series.derivatives(0.0));
    let connect = |from: &EndState, to: &EndState, between| {
        shortest(from, to, &bounds, dynamics).map_err(|(duration_s, violation)| TransitionError {
            between,
            duration_s,
            violation,
        })
    };
    let climb = connect(&at_rest(flight.takeoff), &joint, "from takeoff to the start")?;
    let descent = connect(&joint, &at_rest(flight.landing), "from the end to the landing place")?;
    let flown_s = f64::from(flight.repeats) * series.period_s;
    Ok(FlightPath {
        segments: vec![
            (Segment::Hold(flight.takeoff), flight.hover_s),
            climb,
            (Segment::Fourier(series.clone()), flown_s),
            descent,
            (Segment::Hold(flight.landing), flight.hover_s),
        ],
    })
}

/// The lower bound of height does not hold where a flight begins and ends.
fn without_floor(bound: &Bound) -> Bound {
    let height = [Quantity::Path { axis: 2, order: 0 }, Quantity::Rest(2)].contains(&bound.quantity);
    Bound { min: bound.min.filter(|_| !height), ..*bound }
}

fn shortest(
    from: &EndState,
    to: &EndState,
    bounds: &[Bound],
    dynamics: &Dynamics,
) -> Result<(Segment, f64), (f64, Violation)> {
    let mut duration_s = DURATION_S.0;
    loop {
        let segment = Segment::Transition(Transition::new(from, to, duration_s));
        let report = check(|t| segment.derivatives(t), duration_s, bounds, dynamics);
        match report.first_violation {
            None => return Ok((segment, duration_s)),
            Some(violation) if duration_s >= DURATION_S.1 => return Err((duration_s, violation)),
            Some(_) => duration_s = (duration_s * DURATION_RATIO).min(DURATION_S.1),
        }
    }
}
