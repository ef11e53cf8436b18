//! A rotor that is weak in one group of flights only, as the motion of each flight names it.
//!
//! The balance does not tell a rotor that became a little weak from a load that sits elsewhere. The motion does: a load moves the mean of
//! the commands, and a weak rotor gives less of every command.

use crate::change::{Groups, Moved, NAMED_SIGMAS};
use crate::diagnose::signatures::with_role;
use crate::diagnose::{Explanation, NAME_Z};
use crate::vehicle::Vehicle;

/// Standard error by which a rotor's thrust differs between flights of one vehicle: its propeller and the air at it are not alike. The same
/// difference is ordinary between two rotors.
const FLIGHTS_APART: f64 = 0.005;
/// Standard deviation of what is anywhere between two bounds, over half of their distance: the root of a third.
const OF_EVEN: f64 = 0.577_350_269_189_625_8;

/// What a flight by itself says of its rotors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WeakAlone {
    /// the rotor that it names, by its place in the vehicle's file, with the factor on its thrust and its standard error, `-`
    pub rotor: Option<(usize, (f64, f64))>,
    /// the factor of a rotor that it does not name is within so much of 1, `-`: it would have named one that is further off
    pub limit: f64,
}

impl WeakAlone {
    /// Of a flight's explanation; `None` where it says nothing of single rotors.
    pub(super) fn of(explanation: &Explanation, vehicle: &Vehicle) -> Option<Self> {
        let signature = with_role(|role| role.which.is_some())?;
        let (which, amount) = (signature.role.which?, *signature.amounts.first()?);
        let name = |slot: usize| signature.effect.parameters().get(slot).map(|parameter| parameter.name);
        let limit = explanation
            .limits
            .iter()
            .find(|limit| limit.id == signature.id() && Some(limit.parameter) == name(amount))
            .map(|limit| limit.limit);
        let named = explanation.named.iter().find(|named| named.id == signature.id());
        let rotor = named.and_then(|named| {
            let factor = named.get(name(amount)?)?;
            Some((vehicle.rotor_of(named.value(name(which)?))?, (factor.value, factor.std)))
        });
        let limit = match (rotor, limit) {
            (_, Some(limit)) => limit,
            // it is not told beside the rotor that has a name: what a name needs of that one
            (Some((_, (_, std))), None) => NAME_Z * std,
            (None, None) => return None,
        };
        Some(Self { rotor, limit })
    }

    /// Factor on the thrust of a rotor with its standard error, if it names that one.
    fn factor(&self, rotor: usize) -> Option<(f64, f64)> {
        self.rotor.filter(|(own, _)| *own == rotor).map(|(_, factor)| factor)
    }

    fn names(&self, rotor: usize) -> bool {
        self.factor(rotor).is_some()
    }
}

/// A rotor that changed.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct RotorMoved {
    /// its place in the vehicle's file
    pub(super) rotor: usize,
    /// its thrust for a command over that before
    pub(super) moved: Moved,
    /// later flights that name it
    pub(super) carried_by: Vec<usize>,
}

/// The rotor that every flight of one group names and none of the other does, where it differs by more than chance; `flights` are all of
/// them, and none of a group may say nothing.
pub(super) fn rotor_by_motion(flights: &[Option<WeakAlone>], groups: &Groups) -> Option<RotorMoved> {
    let of = |group: &[usize]| -> Option<Vec<WeakAlone>> {
        group.iter().map(|&flight| flights.get(flight).copied().flatten()).collect()
    };
    let (before, after) = (of(&groups.before)?, of(&groups.after)?);
    let (rotor, _) = before.iter().chain(&after).find_map(|flight| flight.rotor)?;
    let all = |group: &[WeakAlone]| group.iter().all(|flight| flight.names(rotor));
    let none = |group: &[WeakAlone]| !group.iter().any(|flight| flight.names(rotor));
    if !(all(&before) && none(&after) || none(&before) && all(&after)) {
        return None;
    }
    let (from, to) = (pooled(&before, rotor), pooled(&after, rotor));
    // as the balance has it: over the thrust before
    let moved = Moved::factor(to.0 / from.0, (from.1 / from.0).hypot(to.1 / to.0));
    let carried_by = groups.after.iter().zip(&after).filter(|(_, flight)| flight.names(rotor));
    (moved.sigmas().abs() > NAMED_SIGMAS).then(|| RotorMoved {
        rotor,
        moved,
        carried_by: carried_by.map(|(flight, _)| *flight).collect(),
    })
}

/// Factor of a rotor in the flights of a group, with its standard error: all of them name it, or none does.
fn pooled(group: &[WeakAlone], rotor: usize) -> (f64, f64) {
    let named: Vec<(f64, f64)> = group.iter().filter_map(|flight| flight.factor(rotor)).collect();
    if named.is_empty() { whole(group) } else { mean(&named) }
}

/// Of flights that do not name it: the factor is anywhere within the limit of 1, as likely here as there, and the same in all of them. So their
/// number tells nothing. The flight with the least limit tells the most, and has its own propeller and air as well.
fn whole(group: &[WeakAlone]) -> (f64, f64) {
    let least = group.iter().map(|flight| flight.limit).fold(f64::INFINITY, f64::min);
    (1.0, (least * OF_EVEN).hypot(FLIGHTS_APART))
}

/// Of flights that name it, by their information.
fn mean(named: &[(f64, f64)]) -> (f64, f64) {
    let weighed = named.iter().map(|(value, std)| (value, std.hypot(FLIGHTS_APART).powi(-2)));
    let (sum, information) =
        weighed.fold((0.0, 0.0), |(sum, all), (value, weight)| (sum + weight * value, all + weight));
    (sum / information, information.recip().sqrt())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test ends where it fails")]
    use super::*;

    const WHOLE: Option<WeakAlone> = Some(WeakAlone { rotor: None, limit: 0.008 });

    fn weak(rotor: usize, factor: f64) -> Option<WeakAlone> {
        Some(WeakAlone { rotor: Some((rotor, (factor, 0.002))), limit: 0.008 })
    }

    fn groups(before: &[usize], after: &[usize]) -> Groups {
        Groups { before: before.to_vec(), after: after.to_vec() }
    }

    #[test]
    fn a_rotor_that_one_group_names_and_the_other_does_not_has_changed() {
        let flights = [WHOLE, weak(1, 0.9), weak(1, 0.9)];
        let change = rotor_by_motion(&flights, &groups(&[0], &[1, 2])).unwrap();
        assert_eq!((change.rotor, change.carried_by.as_slice()), (1, &[1, 2][..]));
        let moved = change.moved;
        assert!((moved.after.0 - 0.9).abs() < 1e-12 && moved.after.1 > 0.005, "{moved:?}");
        // the other way round it became stronger
        let back = rotor_by_motion(&flights, &groups(&[1, 2], &[0])).unwrap();
        assert!((back.moved.after.0 - 1.0 / 0.9).abs() < 1e-12);
        assert!(back.carried_by.is_empty());
    }

    #[test]
    fn a_rotor_that_some_name_or_that_differs_by_chance_has_not() {
        let groups = groups(&[0], &[1, 2]);
        assert_eq!(rotor_by_motion(&[WHOLE, weak(1, 0.9), WHOLE], &groups), None);
        assert_eq!(rotor_by_motion(&[weak(1, 0.9), weak(1, 0.9), weak(1, 0.9)], &groups), None);
        assert_eq!(rotor_by_motion(&[None, weak(1, 0.9), weak(1, 0.9)], &groups), None);
        assert_eq!(rotor_by_motion(&[WHOLE, weak(1, 0.98), weak(1, 0.98)], &groups), None);
        assert_eq!(rotor_by_motion(&[WHOLE, WHOLE, WHOLE], &groups), None);
    }
    #[test]
    fn flights_that_name_no_rotor_tell_no_more_than_the_best_of_them() {
        let whole = |limit: f64| WeakAlone { rotor: None, limit };
        let (factor, one) = pooled(&[whole(0.006)], 0);
        // the root of 12 bounds apart, and the flight's own air
        assert!(factor == 1.0 && (one - (0.012 / 12.0_f64.sqrt()).hypot(0.005)).abs() < 1e-12);
        assert_eq!(pooled(&[whole(0.006); 9], 0), (1.0, one));
        assert_eq!(pooled(&[whole(0.05), whole(0.006)], 0), (1.0, one));
        // another rotor that has a name is not this one
        let other = WeakAlone { rotor: Some((1, (0.9, 0.001))), limit: 0.03 };
        assert_eq!(pooled(&[other, whole(0.006)], 0), (1.0, one));
        // those that name it scatter about what it is
        let named = WeakAlone { rotor: Some((0, (0.9, 0.002))), limit: 0.008 };
        let [(_, of_one), (factor, of_four)] = [1, 4].map(|count| pooled(&vec![named; count], 0));
        assert!((factor - 0.9).abs() < 1e-12 && (of_four - 0.5 * of_one).abs() < 1e-12);
    }
}
