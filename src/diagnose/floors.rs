//! Lower bounds of the standard errors: the accuracy of the laws themselves, which the statistics of one flight do not contain.

use super::base::{follows_force, turns_about_z};
use super::channels::{Channels, Nuisance};
use super::fit::Fitted;
use super::nuisances::BIAS_STD_M_S2;
use super::scale_error::{bend_of, of_scale};
use super::signature::EffectTerm;
use crate::estimate::INERTIA_ENTRIES;
use crate::physics::Parameter;
use crate::vehicle::{Guessed, Vehicle};
use nalgebra::DVectorView;

/// Relative standard error of the mass that the thrust law adds: of 20 flights of both autopilots' simulators 16 were within 0.2 %,
/// four within 0.4 %, and 93 flights along trajectories with a satellite receiver were right to 0.5 % rms.
pub const LAW_OF_THRUST: f64 = 0.005;
/// Relative standard errors that the torque law adds to the moments of inertia about x, y and z. About z they were right to 0.3 % where
/// statistics said 0.1 %. On 300 simulated flights with an estimator, moments about x and y were right to 2 % rms where statistics said 1 % and
/// less: a controller answers the estimator's errors with them.
pub const LAW_OF_TORQUE: [f64; 3] = [0.015, 0.015, 0.003];

/// Relative standard error that the form of an effect's law adds to its size: on ArduCopter's simulator, whose sensors are clean
/// and whose laws are others, sizes were right to 1 to 3 %.
pub(super) const FORM: f64 = 0.02;

/// Relative standard error of a drag along body z where the commands are too far apart to compare torques: what the thrust does between
/// two of them is in phase with the climb. On six flights of PX4's simulator of which every message was kept at 10 Hz it came out 13 to 57 %
/// too large, across it within 4 %. Commands that are rebuilt from the controller's torques have a thrust with the same gaps: on ten flights of
/// that simulator with its usual log it came out 1 to 62 % too large (in the mean 24 %), across it 3 % too small.
const SPARSE: f64 = 0.3;

/// Standard error of a vehicle's heading, rad. It is also one of the wind's direction: on ArduCopter's simulator, winds came out 1 to 2
/// degrees from where they blew.
const HEADING_STD_RAD: f64 = 0.02;

/// Standard error of moments of inertia by a bent thrust law, relative, over its curvature. Torques are differences of thrusts, so moments go
/// with the slope of the law, and a curve that has not quite the form of the law has another slope. A linear thrust that was
/// described with an exponent of 0.6 has a curvature of -0.3 at hover. Moments of a simulated flight up to full thrust were then 11 % too large
/// and those of a calm one 6 %: 0.4 and 0.2 of it.
const SLOPE: f64 = 0.3;

/// Relative standard error of a size by what the vehicle's description guesses of the torques: moments about z go with the torque per thrust,
/// the others and places with the arms.
fn guessed(vehicle: &Vehicle, parameter: &Parameter) -> f64 {
    let of = if turns_about_z(parameter.name, parameter.unit) {
        Guessed::TorqueRatio
    } else if parameter.unit.starts_with("N m") || parameter.unit == "m" {
        Guessed::Arms
    } else {
        return 0.0;
    };
    vehicle.guessed(of)
}

/// Adds the error of a bent thrust law's slope to those of a fit's moments of inertia.
pub(super) fn add_slope(fitted: &mut Fitted) {
    let share = SLOPE * bend_of(&fitted.base);
    for (index, column) in fitted.rows.nuisances.iter().enumerate() {
        let Nuisance::Inertia(entry @ (0 | 3 | 5)) = column.nuisance else { continue };
        let (row, of) = INERTIA_ENTRIES[entry];
        // what no row bears on stays undetermined
        if fitted.covariance[(index, index)] > 0.0 {
            let moment = fitted.base.vehicle.body.inertia_kg_m2[(row, of)];
            fitted.covariance[(index, index)] += (share * moment).powi(2);
        }
    }
}

/// The force of all laws of the drag along a body axis over that of one of them; 1 of any other effect. `place` is that of its
/// coefficient among those of all effects, `axis` its slot. What the form of the whole is wrong by, one of several laws takes: a linear
/// and a quadratic drag have nearly the same force at the speeds of one flight.
fn together(fitted: &Fitted, axis: usize, place: usize) -> f64 {
    let slots = fitted.base.effects.iter().flat_map(|term| term.free.iter().map(move |&slot| (term, slot)));
    // root of the sum of squares over the rows, N
    let force = |((term, slot), column): ((&EffectTerm, usize), &Channels)| {
        let is_along = slot == axis && axis < 3 && term.signature.is_drag();
        if is_along {
            term.values[slot].abs() * DVectorView::from_slice(&column[axis], column[axis].len()).norm()
        } else {
            0.0
        }
    };
    let forces: Vec<f64> = slots.zip(&fitted.rows.effects).map(force).collect();
    let own = forces.get(place).copied().unwrap_or(0.0);
    if own > 0.0 { forces.iter().sum::<f64>() / own } else { 1.0 }
}

/// Standard error of an amount by its law and by what the vehicle's description guesses: a share of the amount, so that it says nothing
/// against its being there; of a component of the wind, a share of the other one as well. Zero of what is no amount. `column` is that of
/// the value among the coefficients.
pub(super) fn of_law(fitted: &Fitted, term: &EffectTerm, (slot, column): (usize, usize)) -> f64 {
    let Some(parameter) = term.parameter(slot).filter(|_| term.is_amount(slot)) else { return 0.0 };
    let scale = if follows_force(parameter.unit) { of_scale(&fitted.base) } else { 0.0 };
    let signature = term.signature;
    let is_along_z = signature.is_drag() && slot == 2 || signature.role.axial_part_of.is_some();
    // what rebuilt torques are unsure by is known where commands were rebuilt, and not otherwise
    let is_sparse = !fitted.rows.compares_torques || fitted.rows.torque_error.rebuilt > 0.0;
    let sparse = if is_along_z && is_sparse { SPARSE } else { 0.0 };
    let guess = guessed(&fitted.base.vehicle, parameter);
    // what the whole drag is wrong by, one of its laws takes
    let form = FORM.hypot(sparse) * together(fitted, slot, column - fitted.rows.nuisances.len());
    // a heading that is wrong turns what blows along one axis into the other
    let turned = if signature.role.wind.is_some() { HEADING_STD_RAD * across(term, slot) } else { 0.0 };
    (form.hypot(scale).hypot(guess) * term.from_nothing(slot)).hypot(turned)
}

/// The horizontal component of a vector of the world that is not the one of `slot`; 0 of a vertical one.
fn across(term: &EffectTerm, slot: usize) -> f64 {
    if slot < 2 { term.values[1 - slot] } else { 0.0 }
}

/// Adds the errors of the laws to those of a fit's mass, moments of inertia and sizes of effects.
pub(super) fn add_floors(fitted: &mut Fitted) {
    add_slope(fitted);
    let body = &fitted.base.vehicle.body;
    let scale = of_scale(&fitted.base);
    // a bias that is not estimated is as unsure as one is
    let of_bias =
        if fitted.base.is_unbiased { BIAS_STD_M_S2 / fitted.base.vehicle.gravity_m_s2 } else { 0.0 };
    let mut index = fitted.rows.nuisances.len();
    for term in &fitted.base.effects {
        for &slot in &term.free {
            if fitted.covariance[(index, index)] > 0.0 {
                fitted.covariance[(index, index)] += of_law(fitted, term, (slot, index)).powi(2);
            }
            index += 1;
        }
    }
    for (index, column) in fitted.rows.nuisances.iter().enumerate() {
        let floor = match column.nuisance {
            Nuisance::Mass => LAW_OF_THRUST.hypot(scale).hypot(of_bias) * body.mass_kg,
            Nuisance::Inertia(0) => LAW_OF_TORQUE[0].hypot(scale) * body.inertia_kg_m2[(0, 0)],
            Nuisance::Inertia(3) => LAW_OF_TORQUE[1].hypot(scale) * body.inertia_kg_m2[(1, 1)],
            Nuisance::Inertia(5) => LAW_OF_TORQUE[2].hypot(scale) * body.inertia_kg_m2[(2, 2)],
            _ => continue,
        };
        // what no row bears on stays undetermined
        if fitted.covariance[(index, index)] > 0.0 {
            fitted.covariance[(index, index)] += floor.powi(2);
        }
    }
}
