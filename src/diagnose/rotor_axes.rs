//! A weak rotor shows about every axis at once: its thrust lacks about body x and y, its torque about z. What turns a vehicle about one axis
//! alone is another cause: a load beside the centre, arms that are not straight, motors that lean.

use super::base::Base;
use super::channels::{AXES, Channels};
use super::evidence::Weighted;
use super::fit::Fitted;
use super::signature::EffectTerm;
use crate::change::NAMED_SIGMAS;
use crate::estimate::{Finding, Nominal, finding, inertia_by_wider_window};
use crate::signals::Signals;
use crate::vehicle::Vehicle;

/// Share of what the other axes show that each axis has to show.
const SHOWN: f64 = 0.5;
/// Ixx and Iyy in `Theta`.
const ACROSS: [usize; 2] = [1, 4];
/// Standard errors from which on the torques about x and y alone show a rotor. The usual three.
const CERTAIN: f64 = 3.0;

/// Whether the axes exclude that this rotor is weak: one of them shows less than half of what the others do, certainly; or a centre of mass
/// that is off is in the model, and nothing but the torque about z, which has other causes too, tells the rotor beside it. Where the
/// torques answer the motion rather than causing it, they tell the balance alone, and a load beside the centre has the same. Of effects
/// that are no rotor's, nothing is excluded. The effect's first column in the model has the index `first`.
pub(super) fn is_refuted(
    (flights, stated): (&[Signals], &Vehicle),
    fitted: &Fitted,
    term: &EffectTerm,
    first: usize,
) -> bool {
    let amount = term.free.iter().position(|slot| term.is_amount(*slot));
    let Some(place) = amount.filter(|_| term.signature.role.which.is_some()) else { return false };
    let rows = &fitted.rows;
    let Some(column) = rows.effects.get(first + place - rows.nuisances.len()) else { return false };
    let size = term.from_nothing(term.free[place]);
    let shows_less = |axis: usize| {
        let mut alone: Channels = std::array::from_fn(|_| vec![0.0; rows.len()]);
        alone[3 + axis].clone_from(&column[3 + axis]);
        // what this axis shows less what the others show
        let Some(evidence) = fitted.weighted.test(&[alone]) else { return false };
        let (apart, std) = (evidence.theta[0] * size.signum(), evidence.std(0));
        apart < -SHOWN * size.abs() && apart < -NAMED_SIGMAS * std
    };
    if rows.compares_torques && (0..3).any(shows_less) {
        return true;
    }
    let told = || shows_across(fitted, first + place, size) && causes_motion(flights, stated, fitted);
    is_loaded_aside(&fitted.base) && rows.compares_torques && !told()
}

/// Whether the torque about x or y causes the motion about it: the flights determine the moment of inertia.
fn causes_motion(flights: &[Signals], stated: &Vehicle, fitted: &Fitted) -> bool {
    let estimated = fitted.rigid_body().with_wider_window(inertia_by_wider_window(flights, stated));
    // what is only guessed of the vehicle is no question of its motion
    let nominal = Nominal::of(&Vehicle { guesses: Vec::new(), ..stated.clone() });
    let determined = |index| matches!(finding(&estimated, &nominal, index), Finding::Determined { .. });
    determined(ACROSS[0]) || determined(ACROSS[1])
}

fn is_loaded_aside(base: &Base) -> bool {
    base.estimates(|term| term.signature.role.of_the_loading)
}

/// Whether all but the torque about z shows a size.
fn shows_across(fitted: &Fitted, index: usize, size: f64) -> bool {
    let across = Weighted::without(&fitted.rows, &fitted.weighted, AXES - 1);
    let (coefficients, covariance) = across.coefficients(&fitted.rows);
    let std = covariance[(index, index)].max(0.0).sqrt();
    let shown = (size + coefficients[index]) * size.signum();
    std > 0.0 && shown > CERTAIN * std && shown > SHOWN * size.abs()
}
