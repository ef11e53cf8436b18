//! Test whether held-out flights contain what the identified ones do not, by what their own fit leaves.

use super::difference::{Difference, OtherVehicle};
use super::weak::Weak;
use crate::diagnose::channels::{CHANNEL_NAMES, CHANNELS, Nuisance, NuisanceColumn};
use crate::diagnose::fit::Fitted;
use crate::estimate::MOMENTS;

/// Least ratio of the residual of the held-out flight's own fit to that of the identified flights. A rotor 10 % weak, a
/// centre of mass 10 mm off and a bent thrust curve in the hold-out alone gave 4.4 to 25 in simulated flights.
const LEFT_RATIO: f64 = 4.0;
/// Ratio of the held-out flights' mean speed to the mean airspeed of the flights explained. From it on, what is left of the forces across the
/// body tells of no other vehicle: the air's forces rise with the speed, and slow flights do not show them. Set by judgement.
const FASTER: f64 = 3.0;
/// Least mean speed of the held-out flights for that, m/s. Set by judgement: hovers stay below.
const MOVES_M_S: f64 = 0.3;

/// Whether flights with this mean airspeed, m/s, show the air's forces that flights feel which are `faster` by this ratio.
pub(super) fn shows_air_of(faster: f64, airspeed_m_s: f64) -> bool {
    faster < FASTER || faster * airspeed_m_s < MOVES_M_S
}

/// A difference that no parameter of the model explains: the residual of these flights is far larger than that of the
/// identified ones. They are `faster` by this ratio; whether the identified ones show the air's forces across the body is `shows_air`.
pub(super) fn by_what_is_left(
    identified: &Fitted,
    (weak, torques_alike): (&Weak, bool),
    (faster, shows_air): (f64, bool),
    whose: &str,
) -> Option<OtherVehicle> {
    // averaged torques leave less than those of each row, and what a flight's own rigid body does not explain tells of no other one
    let is_told = |axis: usize| {
        let explains = |own: &Fitted| !own.rows.compares_torques || own.rigid_body().explains(MOMENTS[axis]);
        weak.own.iter().any(explains)
    };
    let compared = |channel: &usize| match torque_axis(*channel) {
        Some(axis) => torques_alike && is_told(axis),
        None => shows_air || channel % 3 == 2,
    };
    // a flight that turns more leaves more of its torque, a faster one more of the air's force, and one that changes its thrust more of that
    let moves = |channel: usize| {
        let Some(axis) = torque_axis(channel) else {
            let there = weak.own.iter().map(|own| change_of_force(own, channel)).fold(0.0, f64::max);
            let here = change_of_force(identified, channel);
            let livelier = if here > 0.0 { there / here } else { 1.0 };
            return faster.powi(2).max(livelier).max(1.0);
        };
        let here = identified.rows.torque_rms[axis];
        let there = weak.own.iter().map(|own| own.rows.torque_rms[axis]).fold(0.0, f64::max);
        if here > 0.0 { (there / here).max(1.0) } else { 1.0 }
    };
    let ratios = (0..CHANNELS).filter(compared).filter_map(|channel| {
        let ratio = weak.own_rms[channel] / (identified.weighted.sigma[channel] * moves(channel));
        (ratio.is_finite() && ratio > LEFT_RATIO).then_some((channel, ratio))
    });
    let (channel, ratio) = ratios.max_by(|a, b| a.1.total_cmp(&b.1))?;
    let channel = CHANNEL_NAMES[channel];
    let reason = format!(
        "{whose}, or it contains something that the others do not: even after its own fit, the residual of {channel} is \
         {ratio:.1} times the one here"
    );
    let by = Difference::Residual { channel, ratio };
    Some(OtherVehicle { by, reason })
}

/// The axis of a channel of torques; `None` for forces, whose axis is the remainder by three.
fn torque_axis(channel: usize) -> Option<usize> {
    channel.checked_sub(3).filter(|axis| *axis < 3)
}

/// By how much a force channel changes along the flights: the standard deviation of the specific force that it compares, m/s^2.
fn change_of_force(of: &Fitted, channel: usize) -> f64 {
    let is_mass = |column: &&NuisanceColumn| column.nuisance == Nuisance::Mass;
    let Some(mass) = of.rows.nuisances.iter().find(is_mass) else { return 0.0 };
    let of_rows = || of.rows.measured[channel].iter().flat_map(Clone::clone);
    let count = of_rows().count().max(1) as f64;
    let mean = of_rows().map(|row| mass.at(channel, row)).sum::<f64>() / count;
    (of_rows().map(|row| (mass.at(channel, row) - mean).powi(2)).sum::<f64>() / count).sqrt()
}
