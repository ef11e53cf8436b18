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

/// What a flight by itself says of its rotors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WeakAlone {
    /// the rotor that it names, by its place in the vehicle's file, with the factor on its thrust and its standard error
    pub rotor: Option<(usize, (f64, f64))>,
    /// standard error of the factor of a rotor that it does not name
    pub std: f64,
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
        let std = match (rotor, limit) {
            (Some((_, (_, std))), _) => std,
            (None, Some(limit)) => limit / NAME_Z,
            (None, None) => return None,
        };
        Some(Self { rotor, std })
    }

    /// Factor on the thrust of a rotor.
    fn factor(&self, rotor: usize) -> (f64, f64) {
        match self.rotor {
            Some((own, factor)) if own == rotor => factor,
            _ => (1.0, self.std),
        }
    }

    fn names(&self, rotor: usize) -> bool {
        self.rotor.is_some_and(|(own, _)| own == rotor)
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
    let value = to.0 / from.0;
    let std = value * (from.1 / from.0).hypot(to.1 / to.0);
    let moved = Moved { before: (1.0, 0.0), after: (value, std), by: (value - 1.0, std) };
    let carried_by = groups.after.iter().zip(&after).filter(|(_, flight)| flight.names(rotor));
    (moved.sigmas().abs() > NAMED_SIGMAS).then(|| RotorMoved {
        rotor,
        moved,
        carried_by: carried_by.map(|(flight, _)| *flight).collect(),
    })
}

/// Mean factor of a rotor over the flights of a group, with its standard error.
fn pooled(group: &[WeakAlone], rotor: usize) -> (f64, f64) {
    let weighed = group.iter().map(|flight| {
        let (value, std) = flight.factor(rotor);
        (value, std.hypot(FLIGHTS_APART).powi(-2))
    });
    let (sum, information) =
        weighed.fold((0.0, 0.0), |(sum, all), (value, weight)| (sum + weight * value, all + weight));
    (sum / information, information.recip().sqrt())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test ends where it fails")]
    use super::*;

    const WHOLE: Option<WeakAlone> = Some(WeakAlone { rotor: None, std: 0.002 });

    fn weak(rotor: usize, factor: f64) -> Option<WeakAlone> {
        Some(WeakAlone { rotor: Some((rotor, (factor, 0.002))), std: 0.002 })
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
}
