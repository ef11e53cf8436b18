//! Pruning after the search: superfluous effects are removed, and the latency is estimated again.

use super::base::Base;
use super::fit::{Fitted, Newton, fit};
use super::gates::NAME_Z;
use super::latency::{LatencyFinding, with_latency};
use super::latency_parts::is_delay;
use super::signature::EffectTerm;
use super::trace::Trace;
use crate::physics::PhysicsError;

/// A latency that moves by less than this when it is estimated with the effects has not changed, s. A tenth of the
/// period of a fast log.
pub(super) const UNCHANGED_S: f64 = 0.001;

/// Removes effects that later ones have made superfluous, and estimates the latency with the remaining ones. A `known` latency that
/// instruments confirmed stays where they confirm none beside these effects. Returns the fit, whether any effect was removed, the change of the
/// latency, s, and what is found of it.
pub(super) fn prune(
    flights: &[Trace],
    after: Fitted,
    known: LatencyFinding,
) -> Result<(Fitted, bool, f64, LatencyFinding), PhysicsError> {
    let mut index = after.rows.nuisances.len();
    let mut kept: Vec<EffectTerm> = Vec::new();
    // two laws of the drag hide each other: the stronger one is judged again without the other
    let mut law: Option<(f64, usize, &EffectTerm)> = None;
    let mut dropped = false;
    for present in &after.base.effects {
        let mut pruned = present.clone();
        let (mut strength, mut most) = (0.0, 0.0);
        for (place, &slot) in present.free.iter().enumerate() {
            let std = after.covariance[(index + place, index + place)].max(0.0).sqrt();
            let z = present.away_from_nothing(slot, std).abs();
            let amount = present.is_amount(slot);
            most = f64::max(most, if amount { z } else { 0.0 });
            if amount && z < PRUNED {
                pruned.values[slot] = present.nothing_at(slot);
                pruned.free.retain(|free| *free != slot);
                dropped = true;
            } else if amount {
                strength = f64::max(strength, z);
            }
        }
        index += present.free.len();
        if strength > KEPT {
            kept.push(pruned);
        } else if present.signature.is_drag() && law.is_none_or(|(other, ..)| most > other) {
            law = Some((most, kept.len(), present));
        }
    }
    let laws = after.base.effects.iter().filter(|term| term.signature.is_drag()).count();
    if let Some((_, place, law)) =
        law.filter(|_| laws > 1 && kept.iter().all(|term| !term.signature.is_drag()))
    {
        kept.insert(place, law.clone());
    }
    dropped |= kept.len() < after.base.effects.len();
    let before_s = after.base.latency.total_s();
    let mut base = Base { effects: kept, ..after.base.clone() };
    base.drop_wind_alone();
    // several of a long flight at a time take much memory
    drop(after);
    let newton = if is_delay(base.latency, &base.vehicle) { Newton::Delay } else { Newton::Free };
    let before = base.clone();
    let (mut fitted, mut finding) = with_latency(flights, base, newton)?;
    if known.is_confirmed && !finding.is_confirmed {
        // fed back, the noise moves least squares by more than it differs from instruments: neither is in the other's error
        let is_known = (before.latency.total_s() - known.total_s).abs() < UNCHANGED_S;
        let latency = if is_known { before.latency } else { known.parts };
        (fitted, finding) = (fit(flights, Base { latency, ..before }, Newton::Held)?, known);
    }
    let moved_s = (fitted.base.latency.total_s() - before_s).abs();
    Ok((fitted, dropped, moved_s, finding))
}

/// An accepted effect stays in the model if it is this many standard deviations from zero: the z of
/// [`Gates`](super::Gates).
const KEPT: f64 = NAME_Z;
/// A parameter of an accepted effect is set to zero if it is nearer to zero than this many standard deviations. Set
/// by judgement; measured only together with all conditions of a name (see `Gates`).
const PRUNED: f64 = 2.5;

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test ends where it fails")]
    use super::*;
    use crate::diagnose::ExplainSettings;
    use crate::diagnose::latency::finding_of;
    use crate::diagnose::made_flights::flown;
    use crate::physics::ActuationLatency;
    use crate::simulate::RandomTrajectory;

    /// Noise is fed back, and no instrument serves.
    #[test]
    fn a_latency_that_instruments_confirmed_stays_where_they_confirm_none() {
        let (signals, vehicle) = flown(23, &RandomTrajectory::default(), |_, _| ());
        let mut trace = Trace::new(&signals, &vehicle, ExplainSettings::default().half_width_s).unwrap();
        trace.gyro_noise_rad_s = 0.2;
        trace.instruments = None;
        let flights = [trace];
        let mut base = Base::anchored(&vehicle);
        base.latency.lag_s = 0.06;
        let held = || fit(&flights, base.clone(), Newton::Held).unwrap();
        let known = LatencyFinding { std_s: 0.008, ..finding_of(&held()) };
        let after = |known| prune(&flights, held(), known).unwrap();
        let (kept, _, moved_s, finding) = after(known);
        assert_eq!((kept.base.latency.total_s(), moved_s, finding.std_s), (0.06, 0.0, 0.008));
        let (other, _, moved_s, finding) = after(LatencyFinding { is_confirmed: false, ..known });
        assert!(other.base.latency.total_s() < 0.05 && moved_s > 0.01 && !finding.is_confirmed, "{moved_s}");
        // what a step of the search left does not stay for it
        let known =
            LatencyFinding { total_s: 0.03, parts: ActuationLatency { lag_s: 0.03, ..known.parts }, ..known };
        assert!((after(known).0.base.latency.total_s() - 0.03).abs() < 1e-12);
    }
}
