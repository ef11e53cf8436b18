//! The balance of one flight: where the thrust that the controllers command acts.

use super::finding::{Amount, Finding, Gravity};
use crate::signals::Signals;
use crate::text::with_error;
use crate::trim::{TrimError, balance, legs};
use crate::vehicle::Vehicle;

/// Standard deviations from zero from which on a balance is off. A flight has three components, and a service sees many thousand
/// flights: as for changes between flights.
const OFF_SIGMAS: f64 = 4.5;
/// Share of an arm, or of the torque about the vertical, below which it is not told. 15 flights of one vehicle outdoors, with whole and
/// with cut propellers, lie within 0.06: what is less is told only by comparing flights.
const OFF: f64 = 0.1;
/// What is called off, in the order of [`crate::trim::Leg::lean`].
const NAMES: [&str; 3] = ["thrust_forward", "thrust_left", "turning_left"];

/// The finding that the balance is off, where it is.
pub(super) fn off_balance(signals: &Signals, vehicle: &Vehicle) -> Result<Option<Finding>, TrimError> {
    let balance = balance(&[legs(signals, vehicle)?]);
    let components: Vec<(f64, f64)> = (0..NAMES.len()).map(|axis| balance.lean(0, axis)).collect();
    let is_off = |(value, std): &(f64, f64)| value.abs() > OFF && value.abs() > OFF_SIGMAS * std;
    if !components.iter().any(is_off) {
        return Ok(None);
    }
    let shares = &balance.flights[0].shares;
    let said: Vec<String> = components.iter().map(|(value, std)| with_error(*value, *std)).collect();
    let most = (1..).zip(shares).max_by(|(_, one), (_, other)| one.total_cmp(other));
    let most = most.map_or_else(String::new, |(rotor, share)| {
        format!(" Motor {rotor} is commanded the most: {:.0} % of the thrust.", 100.0 * share)
    });
    let named = NAMES.iter().zip(&components).map(|(name, (value, std))| Amount {
        name: (*name).to_owned(),
        value: *value,
        std: Some(*std),
        unit: "1",
    });
    let rotors = (1..).zip(shares).map(|(rotor, share)| Amount {
        name: format!("share_of_rotor_{rotor}"),
        value: *share,
        std: None,
        unit: "1",
    });
    let span = signals.quality.airborne_s.first().zip(signals.quality.airborne_s.last());
    Ok(Some(Finding {
        id: "off_balance",
        gravity: Gravity::Warning,
        sentence: format!(
            "In still air the controllers command thrust that acts {} of an arm forward and {} of an arm to the left of the centre, and \
             turns left by {} of what all rotors of one direction would.{most} A rotor that gives less for its command, or a centre of \
             mass that is off, takes that; one flight does not tell which.",
            said[0], said[1], said[2]
        ),
        span_s: span.map(|(first, last)| (first.0, last.1)),
        at: None,
        amounts: named.chain(rotors).collect(),
        may_be: vec!["weak_rotor".to_owned(), "center_of_mass".to_owned()],
    }))
}
